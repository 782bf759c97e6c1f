"""Guards the verdicts: reference numbers, growth laws against eigenvalues, criteria, the theorem on random states."""

import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

from primer import max_growth
from primer.analysis.verdict import verdict as general_verdict
from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    GLASS_BEADS_2015,
    BaseState,
    Coulomb,
    Friction,
    IncompressibleMuI,
    MuI,
    coefficients,
    conditions,
    critical_state,
    growth_limit,
    incompressible_criterion,
    largest_growth,
    linearise,
    neutral_inertial_numbers,
    verdict,
)
from primer.granular.criteria import Conditions, _dips
from primer.granular.dispersion import Delta, at, dispersion, growth_rate
from primer.granular.fastest import fastest
from primer.granular.limits import leading, least_Delta, quotient_maximum
from primer.granular.linearisation import Coefficients
from primer.granular.posedness import _with_long_waves
from primer.granular.violations import cases, table

BEADS, PACKING = GLASS_BEADS.friction, EXAMPLE_COMPACTION
CIDR_BEADS = CIDR(BEADS, PACKING)


class Ansatz:
    """Y = a(I) p - p^2/C, f = b(I) - 2p/C with any a and b: each hypothesis can be broken alone."""

    def __init__(self, a, da, b, db):
        self.a, self.da, self.b, self.db = a, da, b, db

    def Y(self, p, phi, I):
        return self.a(I) * p - p**2 / PACKING.C(phi)

    def Y_p(self, p, phi, I):
        return self.a(I) - 2 * p / PACKING.C(phi)

    def Y_phi(self, p, phi, I):
        return p**2 * PACKING.dC(phi) / PACKING.C(phi) ** 2

    def Y_I(self, p, phi, I):
        return self.da(I) * p

    def f(self, p, phi, I):
        return self.b(I) - 2 * p / PACKING.C(phi)

    def f_p(self, p, phi, I):
        return -2 / PACKING.C(phi)

    def f_phi(self, p, phi, I):
        return 2 * p * PACKING.dC(phi) / PACKING.C(phi) ** 2

    def f_I(self, p, phi, I):
        return self.db(I)


def random_states(law, n, seed, low=-5, high=3):
    rng = np.random.default_rng(seed)
    phi, I = rng.uniform(0.501, 0.599, n), 10 ** rng.uniform(low, high, n)
    return BaseState(law.p_max(phi, I) * rng.uniform(1e-3, 0.999, n), phi, I)


def test_cidr_reference_states():
    at_critical = BaseState(BEADS.beta(0.1) / 2, 0.55, 0.1)
    assert growth_limit(CIDR_BEADS, at_critical) == pytest.approx(-0.2793069001157936, rel=1e-12)
    assert not verdict(CIDR_BEADS, at_critical).unstable
    unstable = verdict(CIDR_BEADS, BaseState(0.2, 0.55, 0.1))
    assert (unstable.kind, unstable.unstable, unstable.exponent) == ("well-posed", True, 0)
    assert unstable.bound == unstable.coefficient == pytest.approx(1.000069799646291, rel=1e-12)


def test_the_limit_is_the_papers_closed_form_in_r_and_I():
    """physics.md: lambda_3/||D|| = -2 r (phi C'/C)[...]/[...], which knows nothing of dispersion.py."""
    states = random_states(CIDR_BEADS, 200, seed=0)
    f, I, C = BEADS, states.I, PACKING.C(states.phi)
    a, r = I * f.dalpha(I), states.p / C
    T, g, B = f.alpha(I) - r, 2 * r + I * f.dbeta(I) / 2, f.alpha(I) - 2 * r - a / 2
    x = np.cos(np.linspace(0, np.pi, 20001))[:, None]
    top = (2 * a - B) + T * (2 * B + g) * x + (B + 2 * T - 2 * a) * x**2
    ratio = -2 * r * states.phi * PACKING.dC(states.phi) / C * top / (T * (x + B) ** 2 + a * (1 - x**2) + a * T * g)
    limit = growth_limit(CIDR_BEADS, states) / states.D
    # the scan misses the peak by at most half its spacing
    np.testing.assert_allclose(ratio.max(axis=0), limit, rtol=1e-3, atol=1e-9)
    assert (ratio.max(axis=0) <= limit + 1e-9 * np.abs(limit)).all()


def test_the_limit_is_approached_by_the_eigenvalues():
    states = random_states(CIDR_BEADS, 50, seed=1, low=-3, high=1)
    rate, _ = fastest(coefficients(CIDR_BEADS, states), 1e7)
    limit = growth_limit(CIDR_BEADS, states)
    np.testing.assert_allclose(rate, limit, rtol=1e-6, atol=1e-7 * np.abs(limit).max())


def test_cssm_dilating_is_ill_posed_with_the_growth_of_its_closed_form():
    law = CSSM(0.4, PACKING)
    p = np.array([0.05, 0.2, 0.35, 0.39])
    v = verdict(law, BaseState(p, 0.55, 0.1, rho=2.5))
    assert (v.kind == "ill-posed").all()
    assert (v.exponent == 1).all()
    exact = np.sqrt(law.Y_p(p, 0.55, 0.1) * law.Y_phi(p, 0.55, 0.1) / 2.5)
    np.testing.assert_allclose(v.coefficient, exact, rtol=1e-12)
    B = law.Y_p(p, 0.55, 0.1)
    np.testing.assert_allclose(v.direction[0] / v.direction[1], np.sqrt((1 - B) / (1 + B)), rtol=1e-12)  # (e44)
    rate, direction = largest_growth(law, BaseState(p, 0.55, 0.1, rho=2.5), 1e8)
    np.testing.assert_allclose(rate / 1e8, exact, rtol=1e-6)
    np.testing.assert_allclose(direction, v.direction, rtol=1e-4)


def test_cssm_at_its_critical_state_is_ill_posed_in_a_direction_that_drifts():
    law = CSSM(0.4, PACKING)
    state = critical_state(law, 0.55)
    v = verdict(law, state)
    assert (v.kind, v.exponent) == ("ill-posed", Fraction(2, 3))
    k = np.array([1e4, 1e6, 1e8])
    rate, x = fastest(coefficients(law, state), k)
    assert np.log10(rate[2] / rate[1]) / 2 == pytest.approx(2 / 3, abs=1e-4)
    assert rate[2] / k[2] ** (2 / 3) == pytest.approx(v.coefficient, rel=1e-4)
    assert np.log10(x[2] / x[1]) / 2 == pytest.approx(-2 / 3, abs=1e-4)
    scan = growth_rate(coefficients(law, state), 1e8, np.cos(np.linspace(0, np.pi, 361)))
    assert scan.max() < 0.01 * rate[2]  # half-degree steps see nothing of it


def test_what_is_left_of_a_cancelling_sum_counts_as_zero_beside_its_terms():
    """A = 0 and B = C: Delta = t (x + B)^2. N(-B) is of the order of Y_phi: a trace of it leaves the drifting case."""
    one = np.ones(())
    for trace, exponent in ((0.0, 2 / 3), (1e-14, 2 / 3), (1e-6, 1.0), (-1e-6, 0.0)):
        c = Coefficients(0 * one, 0.999 * one, 0.999 * one, one, one, one, trace * one, one, one, one, one)
        assert leading(c).exponent == exponent


def test_a_dilatancy_that_phi_does_not_change_has_a_growth_at_infinity_too():
    """f_phi = Y_phi = 0 leaves N = 0 and, at k = 1, the leading growth: T lam + Delta k^2/R = 0 where Gamma = 0."""
    one, none = np.ones(()), np.zeros(())
    c = Coefficients(0.1 * one, 0.5 * one, -0.5 * one, none, one, one, none, none, one, 0.6 * one, one)
    x = np.linspace(-1, 1, 200_001)
    found = leading(c)
    assert found.exponent == 2
    assert found.coefficient == pytest.approx((-Delta(c, x) / 0.6 / at(dispersion(c).T, x)).max(), rel=1e-8)


def test_cssm_contracting_is_well_posed_with_a_bound_that_diverges():
    law, rel = CSSM(0.4, PACKING), np.array([1e-1, 1e-2, 1e-3, 1e-4])
    state = BaseState(law.p_critical(0.55, 0.1) * (1 + rel), 0.55, 0.1)
    v = verdict(law, state)
    assert (v.kind == "well-posed").all()
    assert (np.diff(v.bound) > 0).all()
    assert v.bound[3] / v.bound[2] == pytest.approx(10, rel=0.05)  # like 1/(p - mu C)
    rate, _ = fastest(coefficients(law, state), 1e10)
    np.testing.assert_allclose(rate, growth_limit(law, state), rtol=1e-6)


def test_cssm_deep_in_contraction_the_bound_is_the_real_part_of_a_pair():
    """At x = -B, where det(M + N) = 0, two eigenvalues are +-i omega |xi| + a constant; it counts too."""
    law = CSSM(0.4, PACKING)
    for p in (0.45, 0.6, 0.79):
        state = BaseState(p, 0.55, 0.1)
        c = coefficients(law, state)
        assert growth_limit(law, state) == pytest.approx(fastest(c, 1e7)[0], rel=1e-7)
        assert Delta(c, -c.B) == 0


def test_coulomb_is_ill_posed_at_every_state():
    rng = np.random.default_rng(4)
    for mu in (0.05, 0.4, 0.95):
        state = BaseState(10 ** rng.uniform(-3, 3, 50), rng.uniform(0.1, 0.9, 50), 10 ** rng.uniform(-6, 3, 50))
        v = verdict(Coulomb(mu), state)
        assert (v.kind == "ill-posed").all()
        assert (v.exponent == 2).all()
        T = math.tan(math.asin(mu) / 2)
        np.testing.assert_allclose(v.coefficient, mu * state.p / (2 * state.D) / state.phi * T**2, rtol=1e-12)


def test_friction_above_one_grows_without_bound_at_finite_wavenumber():
    v = verdict(Coulomb(1.2), BaseState(1.0, 0.6, 0.1))
    assert (v.kind, v.coefficient) == ("ill-posed", math.inf)
    c = coefficients(Coulomb(1.2), BaseState(1.0, 0.6, 0.1))
    assert growth_rate(c, 1.0, -1 / 1.2 + 1e-9) > 1e6


def test_neutral_inertial_numbers():
    np.testing.assert_allclose(neutral_inertial_numbers(BEADS), [0.0194016579336, 0.8402720681500], rtol=3e-12)
    expected = [0.0197126685040, 0.8457827757581]
    np.testing.assert_allclose(neutral_inertial_numbers(GLASS_BEADS_2015.friction), expected, rtol=3e-12)
    assert neutral_inertial_numbers(MuI(0.3, 0.31, 0.279)).size == 0
    by_functions = neutral_inertial_numbers(Friction(BEADS.mu, BEADS.dmu))
    np.testing.assert_allclose(by_functions, neutral_inertial_numbers(BEADS), rtol=1e-13)
    for root in neutral_inertial_numbers(BEADS):
        assert abs(incompressible_criterion(BEADS, root).C) < 1e-13


def test_neutral_inertial_numbers_are_looked_for_between_the_ends_and_nowhere_else():
    first, second = neutral_inertial_numbers(BEADS)
    np.testing.assert_allclose(neutral_inertial_numbers(BEADS, high=0.1), [first], rtol=1e-13)
    np.testing.assert_allclose(neutral_inertial_numbers(BEADS, 0.1), [second], rtol=1e-13)
    np.testing.assert_allclose(neutral_inertial_numbers(BEADS, first * 0.9999, first * 1.0001), [first], rtol=1e-13)
    assert neutral_inertial_numbers(BEADS, 0.1, 0.8).size == 0
    assert neutral_inertial_numbers(BEADS, first, first).size == 0  # a single number is no interval to change in
    with pytest.raises(ValueError, match=r"^low must be <= high, got low = 0.2 and high = 0.1$"):
        neutral_inertial_numbers(BEADS, 0.2, 0.1)
    for ends in ((0, 1), (1, 0)):
        with pytest.raises(ValueError, match="must be a finite number > 0, got 0"):
            neutral_inertial_numbers(BEADS, *ends)


def test_dips_are_the_minima_between_0_and_1_and_nothing_else():
    s = np.linspace(-10, 10, 401)
    bottom = np.array([-7.513, -2.231, 3.117, 8.009])
    height = np.array([0.3, -0.1, 0.95, 1.1])  # the second is below zero without help, the last too high to matter

    def growth(s):
        return np.minimum((np.abs(np.subtract.outer(s, bottom)) + height).min(axis=-1), 5)

    np.testing.assert_allclose(_dips(growth, s), bottom[[0, 2]], rtol=1e-11)
    (found,) = _dips(lambda s: 0.5 + (s - 0.025) ** 2, s)  # half way between two points of equal height
    assert found == pytest.approx(0.025, abs=1e-7)
    assert _dips(lambda s: 0.5 + 0.01 * s, s).size == 0  # no minimum but at the end


def test_a_window_of_well_posedness_narrower_than_the_scan_is_found():
    """mu2 such that the least growth rate over I is barely below zero: two neutral numbers side by side."""

    def least(mu2):
        law = MuI(0.3, mu2, 0.3)
        found = minimize_scalar(
            lambda s: float(incompressible_criterion(law, np.exp(s)).growth),
            bounds=(-4, 1), method="bounded", options={"xatol": 1e-10},
        )  # fmt: skip
        return found.fun, np.exp(found.x)

    mu2 = brentq(lambda mu2: least(mu2)[0] + 1e-9, 0.31, 0.6, xtol=1e-14)
    roots = neutral_inertial_numbers(MuI(0.3, mu2, 0.3))
    assert len(roots) == 2
    assert roots[0] < least(mu2)[1] < roots[1] < 1.005 * roots[0]
    assert neutral_inertial_numbers(MuI(0.3, mu2 - 1e-6, 0.3)).size == 0


def test_friction_above_one_is_beyond_the_incompressible_criterion():
    steep = incompressible_criterion(MuI(1.1, 1.5, 0.3), np.array([1e-9, 0.3]))
    assert steep.growth[0] == np.inf
    assert not steep.well_posed[0]


def test_the_incompressible_criterion_at_its_edges():
    """At |B| = 1 the growth is unbounded already; where it is nought the rheology counts as well posed."""
    one = incompressible_criterion(Friction(lambda I: 1 + 0 * I, lambda I: 0 * I), 0.3)
    assert (one.n, one.B, one.C, one.growth, one.well_posed) == (0, 1, 1, np.inf, False)
    minus = incompressible_criterion(Friction(lambda I: 1 + 0 * I, lambda I: 4 + 0 * I), 1.0)
    assert (minus.n, minus.B, minus.growth, minus.well_posed) == (4, -1, np.inf, False)
    beyond = incompressible_criterion(Friction(lambda I: 1.25 + 0 * I, lambda I: 5 + 0 * I), 1.0)
    assert (beyond.B, beyond.growth, beyond.well_posed) == (-1.25, np.inf, False)
    steep = incompressible_criterion(Friction(lambda I: 0.4 * I**3, lambda I: 1.2 * I**2), 1.0)  # n = 3
    assert pytest.approx(-0.2, rel=1e-14) == steep.B
    assert steep.growth == pytest.approx(-2 * np.tan(np.arcsin(0.2) / 2) ** 2 - 3, rel=1e-14)
    neutral = 0
    for mu in 0.8 / 0.9 + np.spacing(0.5) * np.arange(-8, 9):  # n = 0.2, B = 0.8, 4n(1 - n) = B^2
        says = incompressible_criterion(Friction(lambda I, mu=mu: mu, lambda I, mu=mu: 0.2 * mu), 1.0)
        neutral += says.C == 0
        assert says.well_posed == (says.C <= 0)
        assert says.growth == pytest.approx(0, abs=1e-14)
    assert neutral


def test_the_incompressible_criterion_agrees_with_the_eigenvalues_with_its_clause():
    steep = MuI(0.01, 0.9, 0.3)  # n > 1/2 for a range of I, where C can be positive
    for friction in (BEADS, steep, MuI(0.001, 0.2, 1.0), Friction(lambda I: I**0.9 / 2, lambda I: 0.45 * I**-0.1)):
        I = np.logspace(-6, 0.3, 200)
        I = I[friction.mu(I) < 1]
        says = incompressible_criterion(friction, I)
        law = IncompressibleMuI(friction)
        state = BaseState(0.3, 0.6, I)
        c = coefficients(law, state)
        rate, x = fastest(c, 1.0)
        np.testing.assert_allclose(rate / (c.t / c.density), says.growth, rtol=1e-8, atol=1e-13)
        np.testing.assert_array_equal(says.well_posed, rate <= 0)
        np.testing.assert_array_equal(verdict(law, state).kind == "well-posed", says.well_posed)
        from_pencil = linearise(law, BaseState(0.3, 0.6, I[20]))
        angle = np.arccos(x[20]) / 2
        lam = from_pencil.eigenvalues(np.array([np.cos(angle), np.sin(angle)]))[0]
        assert lam.real == pytest.approx(rate[20], rel=1e-9)


def test_the_clause_is_needed():
    """mu = 1.5 I^0.9 at I = 1: n = 0.9, B = 0.825 and C > 0, yet every direction is damped."""
    power = Friction(lambda I: 1.5 * I**0.9, lambda I: 1.35 * I**-0.1)
    says = incompressible_criterion(power, 1.0)
    assert says.n == pytest.approx(0.9)
    assert pytest.approx(0.825) == says.B
    assert pytest.approx(0.825**2 - 0.36) == says.C
    assert says.well_posed
    law, state = IncompressibleMuI(power), BaseState(0.3, 0.6, 1.0)
    assert verdict(law, state).kind == "well-posed"
    angle = np.linspace(0, np.pi, 181)
    lam = linearise(law, state).eigenvalues(1e3 * np.stack([np.cos(angle), np.sin(angle)]))
    assert lam.real.max() < 0


def test_conditions_report_which_hypothesis_holds():
    state = random_states(CIDR_BEADS, 100, seed=6)
    holds = conditions(CIDR_BEADS, state)
    assert holds.theorem.all()
    f, I = BEADS, state.I
    np.testing.assert_allclose(holds.Y_I, f.dalpha(I) * state.p, rtol=1e-12)
    np.testing.assert_allclose(holds.slope, -2 / PACKING.C(state.phi) - I * f.dbeta(I) / (2 * state.p), rtol=1e-12)
    soil = conditions(CSSM(0.4, PACKING), BaseState(0.2, 0.55, 0.1))
    assert (bool(soil.equality), bool(soil.a), bool(soil.b)) == (True, False, True)
    dry = conditions(Coulomb(0.4), BaseState(0.2, 0.55, 0.1))
    assert (bool(dry.equality), bool(dry.a), bool(dry.b)) == (False, False, False)


@pytest.mark.parametrize("p", [0.05, 0.15, 0.35])
def test_the_equality_holds_to_a_billionth_of_its_terms(p):
    """With constant a and b the two sides are a - 2p/C and b - 2p/C, of either sign: their difference is a - b."""
    C = PACKING.C(0.55)
    a = 0.4
    size = abs(a - 2 * p / C) + abs(a - 2 * p / C) + (a * p - p * p / C) / p
    for share, holds in ((0.99, True), (1.01, False), (-0.99, True), (-1.01, False)):
        b = a + share * 1e-9 * size
        law = Ansatz(lambda I: a + 0 * I, lambda I: 0 * I, lambda I, b=b: b + 0 * I, lambda I: 0 * I)
        says = conditions(law, BaseState(p, 0.55, 0.3))
        assert says.equality == holds
        np.testing.assert_allclose([says.B, says.C], [a - 2 * p / C, b - 2 * p / C], rtol=1e-13)
        assert (says.Y_I, says.slope, bool(says.theorem)) == (0, pytest.approx(-2 / C, rel=1e-14), False)


def test_the_theorem_needs_all_three():
    yes, no = np.array(True), np.array(False)
    for equality, a, b in np.ndindex(2, 2, 2):
        holds = Conditions(*np.zeros(2), (no, yes)[equality], 0.0, (no, yes)[a], 0.0, (no, yes)[b])
        assert holds.theorem == (equality + a + b == 3)


def test_a_critical_state_is_where_f_vanishes():
    for law in (CSSM(0.4, PACKING), CIDR_BEADS):
        state = critical_state(law, 0.57)
        assert (state.I, state.d, state.rho) == (0.1, 1.0, 1.0)
        assert law.f(state.p, 0.57, 0.1) == pytest.approx(0, abs=1e-15)
        other = critical_state(law, [0.55, 0.57], 2.0, 0.5, 3.0)
        assert (other.I, other.d, other.rho, other.shape) == (2.0, 0.5, 3.0, (2,))
        assert law.f(other.p, other.phi, 2.0) == pytest.approx(0, abs=1e-15)
    for wrong in (Coulomb(0.4), CSSM, 3):
        with pytest.raises(TypeError, match="law must have a critical state, as CSSM and CIDR do, got"):
            critical_state(wrong, 0.55)


def test_each_hypothesis_violated_alone():
    mu, dmu = BEADS.mu, BEADS.dmu
    # (a) alone: alpha and beta of a *falling* friction law satisfy the equality and (b) but not Y_I > 0
    falling = Friction(lambda I: mu(0) + 0.1 / (1 + I), lambda I: -0.1 / (1 + I) ** 2)
    law, state = CIDR(falling, PACKING), BaseState(0.3, 0.55, 0.5)
    says = conditions(law, state)
    assert (bool(says.equality), bool(says.a), bool(says.b)) == (True, False, True)
    assert verdict(law, state).kind == "ill-posed"
    assert verdict(law, state).exponent == 2

    # the equality alone: flow rule by normality, f = dY/dp with alpha = beta = 2 mu(I): still well posed
    normality = Ansatz(lambda I: 2 * mu(I), lambda I: 2 * dmu(I), lambda I: 2 * mu(I), lambda I: 2 * dmu(I))
    says = conditions(normality, BaseState(0.2, 0.55, 0.1))
    assert (bool(says.equality), bool(says.a), bool(says.b)) == (False, True, True)
    assert verdict(normality, BaseState(0.2, 0.55, 0.1)).kind == "well-posed"

    # the equality alone, strongly: ill posed
    strong = Ansatz(lambda I: mu(I) + 0.05, dmu, lambda I: 0.1 + 0 * I, lambda I: 0 * I)
    v = verdict(strong, BaseState(0.05, 0.55, 0.001))
    assert (v.kind, v.exponent) == ("ill-posed", 2)
    assert v.coefficient == pytest.approx(4.0535145316, rel=1e-10)

    # (b) alone: beta falling so fast that the pressure no longer rises with compression
    def beta(I):
        return BEADS.alpha(I) * 2 - 2 * mu(I)

    steep = Ansatz(BEADS.alpha, BEADS.dalpha, lambda I: beta(0.1) - 60 * (I - 0.1), lambda I: -60 + 0 * I)
    says = conditions(steep, BaseState(0.2, 0.55, 0.1))
    assert not says.b
    assert verdict(steep, BaseState(0.2, 0.55, 0.1)).kind == "ill-posed"


def test_the_least_determinant_and_its_direction_against_a_scan():
    law, scan = CIDR_BEADS, np.linspace(-1, 1, 20001)
    seen = set()
    for state in (BaseState(p, phi, I) for p in (0.05, 0.4, 1.5) for phi in (0.52, 0.57) for I in (1e-3, 0.1, 3.0)):
        if state.p < law.p_max(state.phi, state.I):
            c = coefficients(law, state)
            for sign in (1, -1):
                least, x = least_Delta(c, sign)
                values = sign * Delta(c, scan)
                assert least == pytest.approx(values.min(), rel=1e-5)
                assert x == pytest.approx(scan[np.argmin(values)], abs=1e-3)
                seen.add(round(float(x)) if abs(x) == 1 else 0)
    assert seen == {-1, 0, 1}


def test_friction_too_steep_grows_without_bound_where_the_determinant_vanishes():
    """1 + B x = 0 at x = cos 2 theta = -1/B, for |B| >= 1."""
    law, state = IncompressibleMuI(MuI(1.4, 1.9, 0.3)), BaseState(1.0, 0.55, 1e-3)
    x, y = verdict(law, state).direction
    assert x**2 - y**2 == pytest.approx(-1 / float(coefficients(law, state).B), rel=1e-9)


def test_long_waves_decay_as_slowly_as_one_likes():
    """lambda ~ -|xi|^2 as xi -> 0, so that no bound on all waves is below zero, whatever the short ones do."""
    one = np.ones(())
    numbers = (0.87, -0.139, -0.139, 0.13, 0.564, 0.564, -0.619, 6.58, 1.0, 0.6, 1.0)
    c = Coefficients(*(v * one for v in numbers))
    limit = leading(c).limit
    assert limit < -1
    assert -1e-6 < _with_long_waves(c, limit) <= 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("a", "da", "b", "db", "p", "phi", "I"),
    [(1.995, 3.646, 1.901, 5.25, 0.7638, 0.5295, 1.672)],
)
def test_long_waves_that_grow_where_short_ones_decay_set_the_bound(a, da, b, db, p, phi, I):
    """A law of one's own: growth at a finite |xi| above the limit. Second route: the pencil, scanned over |xi|."""
    law, state = Ansatz(lambda I: a, lambda I: da, lambda I: b, lambda I: db), BaseState(p, phi, I)
    found = verdict(law, state)
    assert (found.kind, found.unstable) == ("well-posed", True)
    assert growth_limit(law, state) < 0
    pencil, k = linearise(law, state), np.geomspace(1e-3, 1e3, 13)
    for _ in range(4):
        rates = max_growth(pencil, k).growth
        best = np.argmax(rates)
        k = np.geomspace(k[max(best - 1, 0)], k[min(best + 1, len(k) - 1)], 5)
    assert found.bound == pytest.approx(rates.max(), rel=0.01)


def test_ill_posed_growth_at_infinity_agrees_with_the_pencil():
    strong = Ansatz(lambda I: BEADS.mu(I) + 0.05, BEADS.dmu, lambda I: 0.1 + 0 * I, lambda I: 0 * I)
    state = BaseState(0.05, 0.55, 0.001)
    v = verdict(strong, state)
    lam = linearise(strong, state).eigenvalues(1e6 * np.array(v.direction))[0]
    assert lam.real / 1e12 == pytest.approx(v.coefficient, rel=1e-8)


def test_quotient_maximum_against_a_fine_scan():
    rng = np.random.default_rng(8)
    n = rng.normal(size=(3, 300))
    d = rng.normal(size=(3, 300))
    d[0] = np.abs(d[0]) + np.abs(d[1]) + np.abs(d[2])  # positive on [-1, 1]
    value, x = quotient_maximum(n, d)
    s = np.linspace(-1, 1, 20001)[:, None]
    scan = ((n[0] + s * (n[1] + s * n[2])) / (d[0] + s * (d[1] + s * d[2]))).max(axis=0)
    assert (value >= scan - 1e-12 * np.abs(scan)).all()
    np.testing.assert_allclose(value, scan, rtol=1e-4, atol=1e-6)
    assert (np.abs(x) <= 1).all()


def test_verdicts_of_many_states_are_those_of_each():
    states = random_states(CIDR_BEADS, 12, seed=9)
    many = verdict(CIDR_BEADS, states)
    for j, numbers in enumerate(zip(states.p, states.phi, states.I, strict=True)):
        one = verdict(CIDR_BEADS, BaseState(*numbers))
        assert (one.kind, one.reason) == (many.kind[j], many.reason[j])
        assert one.bound == pytest.approx(many.bound[j], rel=1e-12)


@pytest.mark.slow
def test_the_theorem_on_100_000_random_states():
    n = 100_000
    for friction in (BEADS, MuI(0.2, 1.4, 3e-3)):
        law = CIDR(friction, PACKING)
        states = random_states(law, n, seed=10)
        assert conditions(law, states).theorem.all()
        c = coefficients(law, states)
        limit = growth_limit(law, states)
        assert np.isfinite(limit).all()
        scale = states.D * states.phi * PACKING.dC(states.phi) / PACKING.C(states.phi)
        k = 1e6 * np.sqrt(c.density * c.Gamma * c.D)  # far beyond every scale of the problem
        rate, _ = fastest(c, k)
        assert (rate <= limit + 1e-4 * (np.abs(limit) + scale)).all()
    rng = np.random.default_rng(11)
    state = BaseState(10 ** rng.uniform(-3, 3, n), rng.uniform(0.1, 0.9, n), 10 ** rng.uniform(-6, 3, n))
    assert (growth_limit(Coulomb(0.3), state) == np.inf).all()
    assert (fastest(coefficients(Coulomb(0.3), state), 1.0)[0] > 0).all()


def test_the_slopes_of_the_violations_are_those_of_their_laws():
    for row in cases():
        p, phi, I = row.state.p, row.state.phi, row.state.I
        h = 1e-5 * I
        for value, slope in ((row.law.Y, row.law.Y_I), (row.law.f, row.law.f_I)):
            difference = (value(p, phi, I + h) - value(p, phi, I - h)) / (2 * h)
            assert slope(p, phi, I) == pytest.approx(difference, rel=1e-6, abs=1e-8), row.name


def test_the_violations_one_by_one_in_words_and_numbers():
    """Each law from its a(I), b(I) at its state: which hypotheses hold, and whether the growth is bounded."""
    rows = cases()
    C = PACKING.C(0.55)
    assert [(row.state.p, row.state.phi, row.state.I) for row in rows] == [
        (0.2 * C, 0.55, 0.1),
        (0.2 * C, 0.55, 0.1),
        (0.5 * C, 0.55, 0.1),
        (0.3 * C, 0.55, 0.5),
        (0.2 * C, 0.55, 0.1),
        (0.05 * C, 0.55, 0.001),
        (0.2 * C, 0.55, 0.1),
    ]
    made = {
        "all hold: CIDR": (BEADS.alpha, BEADS.beta),
        "(a) fails, Y_I = 0: CSSM, dilating": (lambda I: 2 * BEADS.mu1, lambda I: 2 * BEADS.mu1),
        "(a) fails, Y_I = 0: CSSM, contracting": (lambda I: 2 * BEADS.mu1, lambda I: 2 * BEADS.mu1),
        "(a) fails, Y_I < 0: friction falls with I": None,
        "equality fails: normality, f = Y_p": (lambda I: 2 * BEADS.mu(I), lambda I: 2 * BEADS.mu(I)),
        "equality fails: constant dilatancy": (lambda I: BEADS.mu(I) + 0.05, lambda I: 0.1),
        "(b) fails: f_p - I/(2p) f_I > 0": (BEADS.alpha, lambda I: BEADS.beta(I) + 0.1 / I),
    }
    assert [row.name for row in rows] == list(made)
    for row in rows:
        p, I = row.state.p, row.state.I
        if made[row.name]:
            a, b = (part(I) for part in made[row.name])
            assert row.law.Y(p, 0.55, I) == pytest.approx(a * p - p * p / C, rel=1e-13)
            assert row.law.f(p, 0.55, I) == pytest.approx(b - 2 * p / C, rel=1e-13)
        else:  # Lemma 1 of the falling law
            mu, K = BEADS.mu1 + 0.1 / (1 + I), quad(lambda s, I=I: s**-0.6 * (BEADS.mu1 + 0.1 / (1 + s * I)), 0, 1)[0]
            assert row.law.a(I) == pytest.approx(0.8 * mu + 0.48 * K, rel=1e-8)
        assert row.verdict.kind == verdict(row.law, row.state).kind
        assert row.conditions.theorem == (row.name == "all hold: CIDR")
    lines = table(rows).splitlines()
    assert lines[0] == f"{'case':44s} {'B = C':>6s} {'(a)':>4s} {'(b)':>4s}  {'verdict':11s} growth"
    for line, row in zip(lines[1:], rows, strict=True):
        mark = [
            {True: "yes", False: "no"}[bool(v)] for v in (row.conditions.equality, row.conditions.a, row.conditions.b)
        ]
        v = row.verdict
        power = {2: "2", 1: "1"}.get(v.exponent)
        growth = f"{v.coefficient:.5g} |xi|^{power}" if v.kind == "ill-posed" else f"at most {v.bound:.5g}"
        assert line == f"{row.name:44s} {mark[0]:>6s} {mark[1]:>4s} {mark[2]:>4s}  {v.kind:11s} {growth}"


@pytest.mark.slow
def test_the_table_of_violations_breaks_what_it_says():
    rows = {row.name.split(":")[0]: row for row in cases()}
    held = {name: tuple(map(bool, (r.conditions.equality, r.conditions.a, r.conditions.b))) for name, r in rows.items()}
    assert held == {
        "all hold": (True, True, True),
        "(a) fails, Y_I = 0": (True, False, True),
        "(a) fails, Y_I < 0": (True, False, True),
        "equality fails": (False, True, True),
        "(b) fails": (True, True, False),
    }
    kinds = [row.verdict.kind for row in cases()]
    assert kinds == ["well-posed", "ill-posed", "well-posed", "ill-posed", "well-posed", "ill-posed", "ill-posed"]
    for row in cases():  # each verdict against the eigenvalues of the pencil, far out
        k = 1e6
        rate = float(max_growth(linearise(row.law, row.state), k).growth)
        if row.verdict.kind == "ill-posed":
            assert rate / k**row.verdict.exponent == pytest.approx(row.verdict.coefficient, rel=1e-3)
        else:
            assert rate <= row.verdict.bound + 1e-6
    assert len(table(cases()).splitlines()) == 8


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "state"),
    [
        (Coulomb(0.4), BaseState(0.3, 0.55, 0.1)),
        (IncompressibleMuI(BEADS), BaseState(0.3, 0.55, 0.1)),
        (IncompressibleMuI(BEADS), BaseState(0.3, 0.55, 0.01)),
        (CSSM(0.4, PACKING), BaseState(0.2, 0.55, 0.1)),
        (CSSM(0.4, PACKING), critical_state(CSSM(0.4, PACKING), 0.55)),
        (CIDR_BEADS, BaseState(0.2, 0.55, 0.1)),
        (CIDR_BEADS, BaseState(0.5, 0.55, 0.1)),
    ],
)
def test_the_general_test_for_ill_posedness_says_the_same(law, state):
    ours, general = verdict(law, state), general_verdict(linearise(law, state))
    assert (ours.kind, ours.exponent, ours.unstable) == (general.kind, general.exponent, general.unstable)
    assert ours.coefficient == pytest.approx(general.coefficient, rel=1e-6)
    assert ours.bound == pytest.approx(general.bound, rel=1e-6, abs=1e-9)
    np.testing.assert_allclose(np.abs(general.direction), ours.direction, atol=1e-6)


def test_cssm_dilating_so_fast_that_it_has_no_bad_direction_is_well_posed():
    """|B| > 1 needs mu > 1/2: the directions (e44) do not exist, and the growth is bounded."""
    law, state = CSSM(0.8, PACKING), BaseState(0.05, 0.55, 0.1)
    c = coefficients(law, state)
    assert c.B > 1
    v = verdict(law, state)
    assert (v.kind, v.unstable) == ("well-posed", True)
    assert fastest(c, 1e7)[0] == pytest.approx(v.bound, rel=1e-9)
