"""Guards the constitutive laws: mu(I), Lemma 1 by three routes, partial derivatives, base states, bad input."""

import math
import re

import mpmath
import numpy as np
import pytest

import primer.granular
from primer.granular import (
    CIDR,
    CSSM,
    DISCS_2011,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    GLASS_BEADS_2015,
    GLASS_BEADS_2017,
    Ansatz,
    BaseState,
    Compaction,
    Coulomb,
    Friction,
    IncompressibleMuI,
    MuI,
)
from primer.granular.friction import as_friction
from primer.granular.state import admit

BEADS = GLASS_BEADS.friction
LAWS = [Coulomb(0.4), IncompressibleMuI(BEADS), CSSM(0.4, EXAMPLE_COMPACTION), CIDR(BEADS, EXAMPLE_COMPACTION)]
ALL_I = np.logspace(-12, 12, 241)


def test_mu_is_the_papers_formula_and_its_limits():
    I = np.array([1e-3, 0.279, 5.0])
    assert BEADS.mu(I) == pytest.approx(BEADS.mu1 + (BEADS.mu2 - BEADS.mu1) / (BEADS.I0 / I + 1), rel=1e-15)
    assert BEADS.mu(0) == BEADS.mu1
    assert BEADS.mu(1e300) == pytest.approx(BEADS.mu2, rel=1e-15)


@pytest.mark.parametrize("I", [1e-12, 1e-6, 0.01, 0.2789, 0.2791, 1.0, 1e3, 1e6, 1e12])
def test_lemma_1_in_closed_form_agrees_with_the_hypergeometric_function_to_the_last_digits(I):
    with mpmath.workdps(40):
        f, i = BEADS, mpmath.mpf(I)
        m1, dm, I0 = mpmath.mpf(f.mu1), mpmath.mpf(f.mu2) - mpmath.mpf(f.mu1), mpmath.mpf(f.I0)

        def mu(i):
            return m1 + dm * i / (I0 + i)

        def F(i):
            return i / I0 * mpmath.hyp2f1(1, mpmath.mpf(7) / 5, mpmath.mpf(12) / 5, -i / I0)

        def alpha(i):
            return mu(i) * 4 / 5 + m1 * 6 / 5 + dm * F(i) * 12 / 35

        def beta(i):
            return -mu(i) * 2 / 5 + m1 * 12 / 5 + dm * F(i) * 24 / 35

        assert f.alpha(I) == pytest.approx(float(alpha(i)), rel=1e-15)
        assert f.beta(I) == pytest.approx(float(beta(i)), rel=1e-15)
        assert f.dalpha(I) == pytest.approx(float(mpmath.diff(alpha, i, h=i * mpmath.mpf("1e-15"))), rel=1e-13)
        assert f.dbeta(I) == pytest.approx(float(mpmath.diff(beta, i, h=i * mpmath.mpf("1e-15"))), rel=1e-13)


def test_lemma_1_by_quadrature_agrees_with_the_closed_form_over_24_decades():
    plain = Friction(BEADS.mu, BEADS.dmu)
    for name in ("alpha", "beta", "dalpha", "dbeta"):
        assert getattr(plain, name)(ALL_I) == pytest.approx(getattr(BEADS, name)(ALL_I), rel=2e-14), name


def test_the_quadrature_serves_a_law_that_is_not_mu_of_I():
    power = Friction(lambda I: 0.4 + 0.1 * np.sqrt(I), lambda I: 0.05 / np.sqrt(I))
    I = np.logspace(-6, 2, 9)
    # I^{-2/5} int_0^I s^{-3/5} (c + e s^{1/2}) ds = (5/2) c + e I^{1/2}/(9/10)
    K = 1.0 + 0.1 * np.sqrt(I) / 0.9
    assert power.alpha(I) == pytest.approx(0.8 * power.mu(I) + 0.48 * K, rel=1e-13)
    assert power.beta(I) == pytest.approx(-0.4 * power.mu(I) + 0.96 * K, rel=1e-13)
    assert power.dbeta(I) == pytest.approx(-0.4 * power.dmu(I) + 0.96 * 0.05 / np.sqrt(I) / 0.9, rel=1e-13)


def test_alpha_and_beta_satisfy_the_ordinary_differential_equations_they_come_from():
    f, I = BEADS, ALL_I
    assert 2.5 * I * f.dalpha(I) + f.alpha(I) == pytest.approx(2 * f.mu(I) + 2 * I * f.dmu(I), rel=1e-14)
    assert f.alpha(I) - f.beta(I) / 2 == pytest.approx(f.mu(I), rel=1e-14)


def test_the_ends_of_lemma_1():
    f = BEADS
    assert [f.alpha(0), f.beta(0)] == pytest.approx([2 * f.mu1] * 2, rel=1e-15)
    assert f.dalpha(0) == pytest.approx(8 / 7 * f.dmu(0), rel=1e-15)
    assert f.dbeta(0) == pytest.approx(2 / 7 * f.dmu(0), rel=1e-14)
    tail = 12 / 25 * (f.mu2 - f.mu1) * math.pi / math.sin(2 * math.pi / 5) * (1e30 / f.I0) ** -0.4
    assert f.alpha(1e30) == pytest.approx(2 * f.mu2 - tail, rel=1e-15)


def test_derivatives_of_mu():
    I, h = np.array([1e-3, 0.279, 5.0]), 1e-5
    for f, slope in ((BEADS.mu, BEADS.dmu), (BEADS.dmu, BEADS.ddmu)):
        assert slope(I) == pytest.approx((f(I * (1 + h)) - f(I * (1 - h))) / (2 * h * I), rel=1e-8)


def test_any_object_with_mu_and_its_slope_is_a_friction_law():
    class Bare:
        mu, dmu = staticmethod(BEADS.mu), staticmethod(BEADS.dmu)

    assert as_friction(BEADS) is BEADS
    assert as_friction(Bare()).alpha(0.2) == pytest.approx(BEADS.alpha(0.2), rel=1e-13)
    with pytest.raises(TypeError, match="friction must have the functions"):
        as_friction(3)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_partial_derivatives_are_those_of_Y_and_f(law):
    here = {"p": 0.3, "phi": 0.556, "I": 0.17}
    for name in ("Y", "f"):
        for variable, value in here.items():
            h = 1e-6 * value

            def at(shift, name=name, variable=variable, value=value):
                return getattr(law, name)(**{**here, variable: value + shift})

            slope = (at(h) - at(-h)) / (2 * h)  # error h^2 f'''/6 ~ 1e-11, rounding 1e-16/h ~ 1e-9
            assert getattr(law, f"{name}_{variable}")(**here) == pytest.approx(slope, rel=2e-8, abs=1e-8)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_laws_broadcast(law):
    p, phi, I = np.full((3, 1), 0.2), 0.55, np.array([0.1, 0.2])
    for name in ("Y", "Y_p", "Y_phi", "Y_I", "f", "f_p", "f_phi", "f_I"):
        value = np.broadcast_to(getattr(law, name)(p, phi, I), (3, 2))
        assert value[2, 1] == pytest.approx(getattr(law, name)(0.2, 0.55, 0.2), rel=1e-15)


def test_at_the_critical_pressure_the_yield_stress_is_mu_p():
    I, phi = np.array([1e-3, 0.1, 10.0]), 0.57
    law = LAWS[3]
    p = law.p_critical(phi, I)
    assert law.f(p, phi, I) == pytest.approx(0, abs=1e-15)
    assert law.Y(p, phi, I) == pytest.approx(BEADS.mu(I) * p, rel=1e-14)
    assert LAWS[2].Y(LAWS[2].p_critical(phi, 1.0), phi, 1.0) == pytest.approx(0.4 * LAWS[2].p_critical(phi, 1.0))


def test_compaction_and_its_inverse():
    c = Compaction(0.5, 0.1, 3.0)
    assert c.C(0.55) == pytest.approx(3.0, rel=1e-14)
    assert c.C(0.5) == 0
    phi = np.linspace(0.5, 0.5999, 50)
    assert c.phi(c.C(phi)) == pytest.approx(phi, rel=1e-14)
    assert c.dC(0.55) == pytest.approx(3.0 / 0.1 * 4, rel=1e-13)


def test_base_state_in_units_and_without():
    s = BaseState(p=200.0, phi=0.55, I=0.1, d=0.5e-3, rho=2500.0)
    assert 2 * s.d * s.D / math.sqrt(s.p / s.rho) == pytest.approx(0.1, rel=1e-15)  # (dfn-I)
    one = BaseState(p=0.2, phi=0.55, I=0.1)
    assert math.isclose(one.D, 0.05 * math.sqrt(0.2), rel_tol=1e-15)
    law = LAWS[3]
    assert one.tau(law) == law.Y(0.2, 0.55, 0.1)
    assert one.div_u(law) == pytest.approx(2 * law.f(0.2, 0.55, 0.1) * one.D)
    assert BaseState([0.1, 0.2], 0.55, [[0.1], [1.0]]).shape == (2, 2)


def test_literature_values_are_ordinary_materials():
    for material in (GLASS_BEADS, GLASS_BEADS_2015, GLASS_BEADS_2017, DISCS_2011):
        assert 0 < material.friction.mu1 < material.friction.mu2 < 1
        assert material.source
    assert BEADS.mu1 == pytest.approx(GLASS_BEADS_2015.friction.mu1, abs=1e-3)
    assert BEADS.mu2 == pytest.approx(GLASS_BEADS_2015.friction.mu2, abs=1e-2)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: MuI(0.6, 0.3, 0.279), "mu2 must be > mu1"),
        (lambda: MuI(0.3, 0.3, 0.279), "mu2 must be > mu1"),
        (lambda: MuI(0.3, 0.6, 0), "I0 must be"),
        (lambda: MuI(float("nan"), 0.6, 0.1), "mu1 must be"),
        (lambda: MuI(-0.1, 0.6, 0.1), "mu1 must be"),
        (lambda: BEADS.mu(-1), "I must be >= 0"),
        (lambda: BEADS.alpha([0.1, float("nan")]), "I must be finite"),
        (lambda: Coulomb(0), "mu must be"),
        (lambda: Compaction(0.5, 0.6, 1), "eps must be"),
        (lambda: Compaction(0.5, 0.1, -1), "C0 must be"),
        (lambda: Compaction(0.5, 0.1, 1).C(0.6), "phi must satisfy"),
        (lambda: Compaction(0.5, 0.1, 1).C([0.55, 0.49]), "phi must satisfy"),
        (lambda: BaseState(0, 0.55, 0.1), "p must be > 0"),
        (lambda: BaseState(-1.0, 0.55, 0.1), "p must be > 0"),
        (lambda: BaseState(1.0, 0.55, 0), "I must be > 0"),
        (lambda: BaseState(1.0, 1.2, 0.1), "phi must be <= 1"),
        (lambda: BaseState(float("nan"), 0.55, 0.1), "p must be finite"),
        (lambda: BaseState([1, 2, -3], 0.55, 0.1), "p must be > 0 everywhere"),
        (lambda: BaseState([1, 2], 0.55, [0.1, 0.2, 0.3]), "must broadcast"),
        (lambda: admit(LAWS[3], BaseState(2.0, 0.55, 0.1)), r"p must be < 0\.85"),
        (lambda: admit(LAWS[2], BaseState(0.81, 0.55, 0.1)), r"p must be < 0\.8"),
        (lambda: admit(LAWS[3], BaseState(0.1, 0.5, 0.1)), "no pressure can be carried"),
        (lambda: admit(LAWS[3], BaseState(0.1, 0.61, 0.1)), "phi must satisfy"),
    ],
)
def test_what_is_not_physical_is_refused_in_one_sentence(make, says):
    with pytest.raises(ValueError, match=says) as error:
        make()
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "make",
    [
        lambda: MuI("a", 0.6, 0.1),
        lambda: CIDR(0.4, EXAMPLE_COMPACTION),
        lambda: CIDR(BEADS, 0.1),
        lambda: Friction(0.4, 0.0),
        lambda: BaseState("p", 0.5, 0.1),
        lambda: IncompressibleMuI(lambda I: 0.4),
        lambda: admit(LAWS[0], (1, 2, 3)),
    ],
)
def test_what_is_not_a_number_or_a_law_is_a_type_error(make):
    with pytest.raises(TypeError):
        make()


@pytest.mark.parametrize("law", [3, "CIDR", MuI(0.3, 0.6, 0.3), type(LAWS[3])])
def test_what_is_no_law_is_named(law):
    with pytest.raises(TypeError, match="law must have the functions Y, Y_p, "):
        admit(law, BaseState(0.2, 0.55, 0.1))


FUNCTIONS = ("Y", "Y_p", "Y_phi", "Y_I", "f", "f_p", "f_phi", "f_I")


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_at_rest_and_without_pressure_a_law_is_finite_and_every_value_of_the_full_shape(law):
    p, phi, I = np.array([[0.0], [0.2]]), np.array([0.52, 0.55, 0.58]), np.zeros((2, 1, 1))
    for name in FUNCTIONS:
        value = getattr(law, name)(p, phi, I)
        assert np.shape(value) == (2, 2, 3), name
        assert np.isfinite(value).all(), name
        one = getattr(law, name)(0.2, 0.55, 0.0)
        assert np.shape(one) == ()
        assert value[1, 1, 1] == one
    assert np.all(law.Y(0.0, phi, I) == 0)


def test_the_pressures_of_a_law_have_the_shape_of_phi_and_I():
    phi, I = np.array([[0.52], [0.55]]), np.array([0.0, 0.1, 2.0])
    for law in LAWS[2:]:
        a, b = (2 * law.mu, 2 * law.mu) if law is LAWS[2] else (BEADS.alpha(I), BEADS.beta(I))
        C = EXAMPLE_COMPACTION.C(phi)
        np.testing.assert_allclose(law.p_max(phi, I), a * C * np.ones(3), rtol=1e-15)
        np.testing.assert_allclose(law.p_critical(phi, I), b * C / 2 * np.ones(3), rtol=1e-15)
        assert np.abs(law.Y(law.p_max(phi, I), phi, I)).max() < 1e-15
        with pytest.raises(ValueError, match="I must be >= 0"):
            law.p_max(0.55, -1.0)


def test_an_ansatz_takes_any_a_and_b_and_refuses_what_is_no_function():
    parts = (lambda I: 0.5 + I, lambda I: 1 + 0 * I, lambda I: 0.3 - I, lambda I: -1 + 0 * I)
    law = Ansatz(*parts, EXAMPLE_COMPACTION)
    assert law.Y(0.2, 0.55, 0.1) == pytest.approx(0.6 * 0.2 - 0.04, rel=1e-14)
    assert law.f(0.2, 0.55, 0.1) == pytest.approx(0.2 - 0.4, rel=1e-14)
    for j, name in enumerate(("a", "da", "b", "db")):
        with pytest.raises(TypeError, match=f"^{name} must be a function of I, got 3$"):
            Ansatz(*parts[:j], 3, *parts[j + 1 :], EXAMPLE_COMPACTION)
    with pytest.raises(TypeError, match=r"^compaction must be a Compaction\(phi0, eps, C0\), got 3$"):
        Ansatz(*parts, 3)


def test_no_pressure_is_carried_at_random_loose_packing():
    with pytest.raises(ValueError, match="there C") as error:
        LAWS[3].Y(0.1, [0.5, 0.55], 0.1)
    said = "phi must be > phi0 = 0.5: there C(phi) = 0 and no pressure can be carried, got array([0.5 , 0.55])"
    assert str(error.value) == said
    assert LAWS[3].p_max(0.5, 0.1) == 0


def test_the_range_of_the_solids_fraction_ends_at_1_and_at_jamming():
    assert Compaction(0.75, 0.25, 1.0).C(0.9375) == 3.0
    with pytest.raises(ValueError, match=r"eps must be <= 1 - phi0 .a solids fraction is at most 1., got 0.2500001"):
        Compaction(0.75, 0.2500001, 1.0)
    assert Compaction(0.5, 0.1, 2.0).phi(0) == 0.5
    with pytest.raises(ValueError, match="C must be >= 0 everywhere, got -1"):
        Compaction(0.5, 0.1, 2.0).phi(-1)
    rng, refused = np.random.default_rng(0), 0
    for phi0, eps in rng.uniform(0.01, 0.5, (2000, 2)):
        packing, below = Compaction(phi0, eps, 1.0), np.nextafter(phi0 + eps, 0)
        said = f"phi must satisfy phi0 = {phi0:g} <= phi < phi0 + eps = {phi0 + eps:g}, got "
        if (below - phi0) / eps < 1:
            assert 1e12 < packing.C(below) < np.inf
        else:  # by rounding
            refused += 1
            with pytest.raises(ValueError, match=re.escape(said)):
                packing.C(below)
        with pytest.raises(ValueError, match=re.escape(said)):
            packing.C(phi0 + eps)
    assert 0 < refused < 1000


def test_a_compaction_is_an_object_with_C_and_its_slope():
    class Half:
        C = staticmethod(lambda phi: phi)

    for wrong in (Compaction, Half(), 3, None):
        with pytest.raises(TypeError, match="compaction must be a Compaction"):
            CSSM(0.4, wrong)
    Half.dC = staticmethod(lambda phi: 1 + 0 * phi)
    assert CSSM(0.4, Half()).Y(0.1, 0.5, 0.1) == pytest.approx(0.08 - 0.02)


def test_the_quadrature_serves_arrays_of_any_shape_in_parts():
    slow = Friction(BEADS.mu, BEADS.dmu)
    assert slow.alpha(np.zeros((0, 2))).shape == (0, 2)
    assert np.shape(slow.alpha(0.1)) == ()
    I = np.geomspace(1e-3, 10, 9000).reshape(3, 3000)
    many = slow.dalpha(I)
    assert many.shape == I.shape
    np.testing.assert_allclose(many, BEADS.dalpha(I), rtol=2e-14)
    flat = Friction(lambda I: 0.4, lambda I: 0.0)  # a constant need not be an array
    np.testing.assert_allclose(flat.alpha(I), 0.8, rtol=1e-14)
    with pytest.raises(ValueError, match=r"^I: the quadrature at all inertial numbers must fit into 2 GiB of memory"):
        slow.alpha(np.broadcast_to(0.1, 2**21 + 1))
    with pytest.raises(ValueError, match="I must be >= 0 everywhere, got -1"):
        slow.alpha(-1)


def test_what_is_a_friction_law():
    class Half:
        mu = staticmethod(BEADS.mu)

    for wrong in (Half(), 3):
        with pytest.raises(TypeError, match=r"friction must have the functions mu.I. and dmu.I., as MuI or Friction"):
            as_friction(wrong)
    for j, name in enumerate(("mu", "dmu")):
        with pytest.raises(TypeError, match=f"^{name} must be a function of I, got 3$"):
            Friction(*[3 if k == j else BEADS.mu for k in range(2)])
    with pytest.raises(ValueError, match=r"mu2 must be > mu1 = 0.5 so that friction rises with I, got 0.5"):
        MuI(0.5, 0.5, 0.1)


def test_parameters_are_those_of_the_literature():
    """Angles of 21 and 33 degrees, d and rho of glass beads; and what the later papers print."""
    table = {
        "GLASS_BEADS": (math.tan(math.pi * 21 / 180), math.tan(math.pi * 33 / 180), 0.279, 0.53e-3, 2450),
        "GLASS_BEADS_2015": (0.383, 0.643, 0.279, 0.53e-3, 2450),
        "GLASS_BEADS_2017": (0.342, 0.557, 0.069, 0.5e-3, 2500),
        "DISCS_2011": (0.32, 0.60, 0.4, None, None),
    }
    for name, (mu1, mu2, I0, d, rho) in table.items():
        material = getattr(primer.granular, name)
        f = material.friction
        assert (f.mu1, f.mu2, f.I0) == pytest.approx((mu1, mu2, I0), rel=1e-15)
        assert (material.d, material.rho) == (d, rho)
    assert (EXAMPLE_COMPACTION.phi0, EXAMPLE_COMPACTION.eps, EXAMPLE_COMPACTION.C0) == (0.5, 0.1, 1.0)


def test_a_base_state_says_what_is_wrong_with_it():
    state = BaseState(p=0.2, phi=1, I=[0.1, 0.2])  # a solids fraction of 1 is the last one allowed
    assert (state.d, state.rho, state.shape) == (1.0, 1.0, (2,))
    assert isinstance(state.phi, float)
    for numbers, said in (
        ((0.2, 1.01, 0.1), "phi must be <= 1, being a solids fraction, got 1.01"),
        ((0.2, [0.5, 1.01], 0.1), "phi must be <= 1 everywhere, being a solids fraction, got array([0.5 , 1.01])"),
        ((0.2, 0.5, 0.1, 0.0), "d must be > 0, got 0.0"),
        ((0.2, 0.5, 0.1, 1.0, [-1.0, 1]), "rho must be > 0 everywhere, got [-1.0, 1]"),
        (
            ([1, 2], 0.5, [1, 2, 3]),
            "the shapes of p, phi, I, d and rho must broadcast, got p (2,), phi (), I (3,), d (), rho ()",
        ),
    ):
        with pytest.raises(ValueError, match="must") as error:
            BaseState(*numbers)
        assert str(error.value) == said


def test_a_state_is_admitted_with_its_yield_stress_or_refused_with_the_numbers():
    law, state = LAWS[3], BaseState([[0.1], [0.2]], [0.55, 0.56], 0.1)
    np.testing.assert_array_equal(admit(law, state), law.Y(state.p, state.phi, state.I))
    assert np.shape(admit(LAWS[0], state)) == (2, 2)
    assert np.shape(admit(law, BaseState(0.2, 0.55, 0.1))) == ()
    top = law.p_max(0.55, 0.1)
    said = f"p must be < {top:g} for the yield stress to be positive, got p = 2, phi = 0.55, I = 0.1"
    with pytest.raises(ValueError, match="p must be") as error:
        admit(law, BaseState([0.1, 2.0, 3.0], 0.55, 0.1))  # the first that is wrong is named
    assert str(error.value) == said
    cohesionless = Friction(lambda I: 0.5 - I, lambda I: -1 + 0 * I)
    for I, Y in ((0.5, "0"), (0.75, "-0.5")):
        with pytest.raises(ValueError, match="yield") as error:
            admit(IncompressibleMuI(cohesionless), BaseState(2.0, 0.55, [0.1, I, 0.9]))
        told = f"the yield stress Y(p, phi, I) must be positive and finite, got {Y} at p = 2, phi = 0.55, I = {I}"
        assert str(error.value) == told
    with pytest.raises(ValueError, match=r"positive and finite, got inf at p = 1e\+308, phi = 0.55, I = 0.1"):
        admit(Coulomb(1e10), BaseState(1e308, 0.55, 0.1))
    for call in (state.tau, state.div_u):
        with pytest.raises(TypeError, match="law must have the functions Y, Y_p, Y_phi, Y_I, f, f_p, f_phi, f_I of"):
            call(3)
    with pytest.raises(TypeError, match="state must be a BaseState, got 3"):
        admit(law, 3)


@pytest.mark.parametrize("phi0", [0.0, 1.0, 1.5])
def test_a_compaction_begins_below_one(phi0):
    with pytest.raises(ValueError, match="phi0 must be a finite number > 0 and < 1"):
        Compaction(phi0, 0.1, 1.0)
