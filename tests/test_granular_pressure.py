"""Guards the evolution form: its pressure, by roots found without it, and its linearisation."""

import math
import warnings

import mpmath as mp
import numpy as np
import pytest
from scipy.optimize import brentq

from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    Ansatz,
    BaseState,
    Coulomb,
    Friction,
    MuI,
    coefficients,
    pressure,
    stress,
)
from primer.granular.linearisation import reduced

BEADS, PACKING = GLASS_BEADS.friction, EXAMPLE_COMPACTION
LAWS = [CIDR(BEADS, PACKING), CSSM(0.4, PACKING), CIDR(Friction(BEADS.mu, BEADS.dmu), PACKING)]
EVERY_LAW = pytest.mark.parametrize("law", LAWS, ids=["CIDR", "CSSM", "CIDR by quadrature"])


class Own:
    """A law of one's own: no compaction, B != C."""

    def Y(self, p, phi, I):
        return (0.4 + 0.2 * I) * p * (1 + 0 * phi)

    def Y_p(self, p, phi, I):
        return 0.4 + 0.2 * I + 0 * p

    def Y_phi(self, p, phi, I):
        return 0 * p

    def Y_I(self, p, phi, I):
        return 0.2 * p

    def f(self, p, phi, I):
        return 0.3 * np.arctan(I) - (phi - 0.5) * np.log1p(p)

    def f_p(self, p, phi, I):
        return -(phi - 0.5) / (1 + p)

    def f_phi(self, p, phi, I):
        return -np.log1p(p)

    def f_I(self, p, phi, I):
        return 0.3 / (1 + I**2)


def states(law, n, seed):
    rng = np.random.default_rng(seed)
    phi, I = rng.uniform(0.5001, 0.5999, n), 10 ** rng.uniform(-8, 5, n)
    p = law.p_max(phi, I) * 10 ** rng.uniform(-6, -1e-4, n)
    return BaseState(p, phi, I, 10 ** rng.uniform(-3, 3, n), 10 ** rng.uniform(-3, 3, n))


@EVERY_LAW
def test_a_flow_made_from_a_state_has_its_pressure_to_the_last_bits_of_f(law):
    state = states(law, 300 if isinstance(getattr(law, "friction", None), Friction) else 5000, 1)
    found = stress(law, state.div_u(law), state.D, state.phi, state.d, state.rho)
    assert set(found.reason) == {"none"}
    p, phi, I = state.p, state.phi, state.I
    slope = np.abs(p * law.f_p(p, phi, I) - I / 2 * law.f_I(p, phi, I))
    size = np.abs(law.f(p, phi, I)) + np.abs(law.b(I)) + 2 * p / PACKING.C(phi)
    assert (np.abs(found.p - p) / p * slope / size).max() < (4e-15 if law is LAWS[2] else 1e-15)
    good = slope > 0.01 * size
    np.testing.assert_allclose(found.T[good], state.tau(law)[good], rtol=1e-12)
    np.testing.assert_allclose(found.I[good], I[good], rtol=1e-12)


def test_in_many_digits_it_is_the_same_pressure():
    """beta by mpmath's own quadrature of Lemma 1, and a bisection: no line of it is the package's."""
    mu = lambda I: BEADS.mu1 + (mp.mpf(BEADS.mu2) - BEADS.mu1) / (BEADS.I0 / I + 1)  # noqa: E731
    div, D, phi, d, rho = -0.011, 0.07, 0.57, 1.3, 0.8
    with mp.workdps(25):
        z = (mp.mpf(phi) - 0.5) / mp.mpf(0.1)

        def g(p):
            I = 2 * d * D / mp.sqrt(p / rho)
            # (26): beta = -2/5 mu + 24/25 I^(-2/5) int_0^I s^(-3/5) mu(s) ds, with s = I y^(5/2)
            mean = mp.mpf(5) / 2 * mp.quad(lambda y: mu(I * y ** mp.mpf(2.5)), [0, 1])
            return -mp.mpf(2) / 5 * mu(I) + mp.mpf(24) / 25 * mean - 2 * p * (1 - z) / z - mp.mpf(div) / (2 * D)

        exact = mp.findroot(g, (mp.mpf("0.1"), mp.mpf("2")), solver="anderson", tol=1e-40)
    assert pressure(LAWS[0], div, D, phi, d, rho) == pytest.approx(float(exact), rel=1e-14)


@pytest.mark.parametrize("law", [LAWS[0], Own()], ids=["CIDR", "own"])
def test_arrays_numbers_and_a_root_finder_agree(law):
    div, D, phi = np.array([-0.01, 0.0, 0.002])[:, None], np.array([0.01, 0.3]), 0.56
    found = pressure(law, div, D, phi)
    assert found.shape == (3, 2)
    for i in range(3):
        for j in range(2):
            X = div[i, 0] / (2 * D[j])
            root = brentq(
                lambda p, X=X, j=j: law.f(p, phi, 2 * D[j] / math.sqrt(p)) - X, 1e-9, 1e9, xtol=1e-300, rtol=1e-14
            )
            assert found[i, j] == pytest.approx(root, rel=1e-12)
            one = pressure(law, div[i, 0], D[j], phi)
            assert isinstance(one, float)
            assert one == found[i, j]


@pytest.mark.parametrize("law", [LAWS[0], LAWS[1], Own()], ids=["CIDR", "CSSM", "own"])
def test_its_linearisation_by_differences_is_the_reduced_system(law):
    """(22) about a uniform flow, differenced in its gradient and phi, is (56) (e33), of which the package has P(xi)."""
    state = BaseState(0.2, 0.56, 0.15, 1.2, 1.7)
    shear, spread = float(state.D), float(state.div_u(law)) / 2

    def force(grad, phi):  # T D/||D|| - P as a matrix
        sym = (grad + grad.T) / 2
        dev = sym - np.eye(2) * np.trace(sym) / 2
        norm = math.sqrt((dev * dev).sum() / 2)
        found = stress(law, np.trace(grad), norm, phi, state.d, state.rho)
        return found.T * dev / norm - found.p * np.eye(2)

    base, xi, h = np.diag([spread - shear, spread + shear]), np.array([0.7, -1.1]), 1e-5
    A = np.zeros((3, 3), dtype=complex)  # lambda q = A q, orders of the paper's Table 1
    for j in range(2):
        change = np.zeros((2, 2))
        change[j] = xi  # grad u_j = i xi u_j: the factor i is put back below
        slope = (force(base + h * shear * change, state.phi) - force(base - h * shear * change, state.phi)) / (
            2 * h * shear
        )
        A[:2, j] = -(slope @ xi) / (state.rho * state.phi)
        A[2, j] = -1j * state.phi * xi[j]
    slope = (force(base, state.phi + 1e-6) - force(base, state.phi - 1e-6)) / 2e-6
    A[:2, 2] = 1j * (slope @ xi) / (state.rho * state.phi)
    np.testing.assert_allclose(A, -reduced(coefficients(law, state), xi), rtol=2e-7, atol=1e-8)


def test_where_there_is_no_pressure_there_is_a_reason():
    law = LAWS[0]
    cases = {
        "not finite": (math.nan, 0.1, 0.55),
        "no shear": (0.0, 0.0, 0.55),
        "phi out of range": (0.0, 0.1, 0.6),
        "expands too fast": (2 * 0.1 * 2 * BEADS.mu2, 0.1, 0.55),  # f < beta < 2 mu2
        "no yield stress": (-2 * 0.1 * 2 * BEADS.mu2, 0.1, 0.55),  # p = alpha C is passed: see (23)
    }
    for reason, flow in cases.items():
        found = stress(law, *flow)
        assert found.reason == reason
        assert np.isnan([found.p, found.T, found.I]).all()
        assert math.isnan(pressure(law, *flow))
    together = stress(law, *np.array([*cases.values(), (0.0, 0.1, 0.55)]).T)
    assert [*together.reason] == [*cases, "none"]
    assert np.isfinite(together.p).tolist() == [False] * 5 + [True]
    assert stress(law, [], [], []).p.shape == (0,)


def test_edges_of_the_range_of_contraction_are_those_of_the_law():
    """Y > 0 is p < alpha C, and f there is beta - 2 alpha = -2 mu(I); the largest f is 2 mu2, at p -> 0."""
    soil, D, phi = LAWS[1], 0.3, 0.55
    assert stress(soil, -4 * 0.4 * D * (1 - 1e-12), D, phi).reason == "none"
    assert stress(soil, -4 * 0.4 * D * (1 + 1e-12), D, phi).reason == "no yield stress"
    assert stress(soil, 4 * 0.4 * D * (1 - 1e-12), D, phi).reason == "none"
    assert stress(soil, 4 * 0.4 * D * (1 + 1e-12), D, phi).reason == "expands too fast"


def test_a_law_without_hypothesis_b_is_not_given_a_pressure_of_many():
    """b = beta + K/I rises with p at fixed ||D|| before 2 p/C wins: two pressures, of which none is the pressure."""
    drop = Ansatz(
        BEADS.alpha, BEADS.dalpha, lambda I: BEADS.beta(I) + 1 / I, lambda I: BEADS.dbeta(I) - 1 / I**2, PACKING
    )
    X = 0.5 * (drop.f(0.0001, 0.55, 0.1) + drop.f(0.01, 0.55, 0.01))
    found = stress(drop, 2 * X * 5e-4, 5e-4, 0.55)
    assert found.reason == "not one pressure"
    assert math.isnan(found.p)


@pytest.mark.parametrize(
    ("change", "kind", "words"),
    [
        ({"law": Coulomb(0.4)}, ValueError, "law must be compressible"),
        ({"law": 3}, TypeError, "law must have the functions"),
        ({"D": -1.0}, ValueError, "D must be >= 0"),
        ({"d": 0.0}, ValueError, "d must be > 0"),
        ({"rho": [1.0, -1.0]}, ValueError, "rho must be > 0 everywhere"),
        ({"rho": math.nan}, ValueError, "rho must be finite"),
        ({"div": "fast"}, TypeError, "div must be a number"),
        ({"phi": [0.55, 0.56], "D": [1.0, 1.0, 1.0]}, ValueError, "must broadcast"),
    ],
)
def test_bad_input_is_one_sentence(change, kind, words):
    given = {"law": LAWS[1], "div": 0.0, "D": 1.0, "phi": 0.55} | change
    with pytest.raises(kind, match=words) as caught:
        pressure(**given)
    assert "\n" not in str(caught.value)


def test_jamming_and_extremes_are_no_warnings():
    law = CIDR(MuI(0.3, 0.7, 1.0), PACKING)
    found = stress(law, 0.0, [1e-200, 1e-12, 1e12, 1e155], [0.6 - 1e-15, 0.5 + 1e-15, 0.55, 0.55])
    for p, reason in zip(found.p, found.reason, strict=True):
        assert np.isfinite(p) == (reason == "none")


@pytest.mark.parametrize("law", LAWS[:2], ids=["CIDR", "CSSM"])
@pytest.mark.parametrize(("d", "rho"), [(1.0, 1.0), (1e-150, 1e150), (1e150, 1e-300)])
def test_hostile_flows_have_a_pressure_or_a_reason_and_no_warning(law, d, rho):
    rng = np.random.default_rng(3)
    some = np.array([0, 1e-320, 1e-160, 1e-30, 1.0, -1.0, -1e-30, 1e30, 1e160, 1e300, np.inf, -np.inf, np.nan])
    div, D = rng.choice(some, 1000), np.abs(rng.choice(some, 1000))
    phi = rng.choice([0.5, 0.55, 0.6, 0.6 - 1e-16, 0.5 + 1e-16, 0.4, 1e300, np.nan, -1.0, 0.599999999], 1000)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = stress(law, div, D, phi, d, rho)
    good = found.reason == "none"
    assert good.any()
    for values in (found.p, found.T, found.I):
        assert (np.isfinite(values) == good).all()
        assert (values[good] > 0).all()
