"""Guards the constitutive laws: mu(I), Lemma 1 by three routes, partial derivatives, base states, bad input."""

import math

import mpmath
import numpy as np
import pytest

from primer.granular import (
    CIDR,
    CSSM,
    DISCS_2011,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    GLASS_BEADS_2015,
    GLASS_BEADS_2017,
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
