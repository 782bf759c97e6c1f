"""Guards the verdicts: kind, exponent and coefficient of every class of system against closed forms, and their bounds.

Second routes: the growth of the same text's pencil, computed in double precision over many wavenumbers.
"""

import math
import time
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_pencil import critical_state, granular, navier_stokes

import primer.analysis.extremes as extremes
import primer.analysis.supremum as supremum
from primer import Pencil, Verdict, growth_rates, max_growth, verdict
from primer.analysis.extremes import is_real, law_along_line, supremum_of
from primer.analysis.laws import exact_symbol
from primer.equations.text import PDEError

ILL, WELL = "ill-posed", "well-posed"
TOY = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"
FLOW = "u_t + U*u_x + p_x = nu*(u_xx + u_yy); v_t + U*v_x + p_y = nu*(v_xx + v_yy); u_x + v_y = 0"
SHALLOW = "h_t + (h*u)_x = 0; u_t + u*u_x + g*h_x = 0"
REST = {"h_x": 0, "u_x": 0}
TURING = "u_t = a*u - b*v + u_xx; v_t = c*u - d*v + D*v_xx"
CAHN_HILLIARD = "u_t = (u^3 - u - g*u_xx)_xx"

# (text, at, parameters, kind, exponent, coefficient, bound)
CASES = {
    "heat": ("u_t = u_xx", {}, {}, WELL, 2, -1, 0),
    "backward heat": ("u_t = -u_xx", {}, {}, ILL, 2, 1, math.inf),
    "wave": ("u_tt = c^2*u_xx", {}, {"c": 3}, WELL, 0, 0, 0),
    "wave, first order": ("u_t = v_x; v_t = u_x", {}, {}, WELL, 0, 0, 0),
    "Laplace": ("u_t = v; v_t = -u_xx", {}, {}, ILL, 1, 1, math.inf),
    "Laplace, second order": ("u_tt = -u_xx", {}, {}, ILL, 1, 1, math.inf),
    "Cauchy-Riemann": ("u_t = v_x; v_t = -u_x", {}, {}, ILL, 1, 1, math.inf),
    "KdV": ("u_t + 6*u*u_x + u_xxx = 0", {"u": 2, "u_x": 0}, {}, WELL, 0, 0, 0),
    "KdV on a slope": ("u_t + 6*u*u_x + u_xxx = 0", {"u": 2, "u_x": -0.5}, {}, WELL, 0, 3, 3),
    "lower order decides": ("u_t = u_xxx - u_xx", {}, {}, ILL, 2, 1, math.inf),
    "Kuramoto-Sivashinsky": ("u_t = -u*u_x - u_xx - u_xxxx", {"u": 1, "u_x": 0}, {}, WELL, 4, -1, 0.25),
    "Cahn-Hilliard, spinodal": (
        CAHN_HILLIARD, {"u": 0.2, "u_x": 0, "u_xx": 0}, {"g": 0.01}, WELL, 4, -0.01, 0.88**2 / 0.04,
    ),
    "Cahn-Hilliard, stable": (CAHN_HILLIARD, {"u": 0.9, "u_x": 0, "u_xx": 0}, {"g": 0.01}, WELL, 4, -0.01, 0),
    "toy, u > 0": (TOY, {"u": 1.5, "v_xx": 0.3}, {"eps": 0.01}, WELL, 0, -1 / 0.015, 0),
    "toy, u < 0": (TOY, {"u": -0.5, "v_xx": 0.3}, {"eps": 0.01}, ILL, 2, 0.005, math.inf),
    "toy, u = 0": (TOY, {"u": 0, "v_xx": 0.3}, {"eps": 0.01}, WELL, 0, -0.5 + 0.0015, 0),
    "toy, u = 0, much curvature": (TOY, {"u": 0, "v_xx": -300}, {"eps": 0.01}, WELL, 0, 1, 1),
    "shallow water": (SHALLOW, {"h": 2, "u": 0.3, **REST}, {"g": 9.81}, WELL, 0, 0, 0),
    "shallow water, heavy above": (SHALLOW, {"h": 2, "u": 0.3, **REST}, {"g": -9}, ILL, 1, 18**0.5, math.inf),
    "Turing": (TURING, {}, {"a": 1, "b": 2, "c": 2, "d": 3, "D": 30}, WELL, 2, -1, None),
    "beam": ("u_tt = -u_xxxx", {}, {}, WELL, 0, 0, 0),
    "beam of negative stiffness": ("u_tt = u_xxxx", {}, {}, ILL, 2, 1, math.inf),
    "damped beam": ("u_tt = -u_xxxx - 2*u_t", {}, {}, WELL, 0, -1, 0),
    "multiple roots": ("u_t = u_xx + v; v_t = v_xx", {}, {}, WELL, 2, -1, 0),
    "split multiple roots": ("u_t = v_x + u_xx; v_t = u_xx + v_xx", {}, {}, WELL, 2, -1, None),
    "nilpotent": ("u_t = v; v_t = w; w_t = 0", {}, {}, WELL, 0, 0, 0),
    "exponent 1/2": ("u_t = v; v_t = u_x", {}, {}, ILL, Fraction(1, 2), 0.5**0.5, math.inf),
    "exponent 1/3": ("u_t = v_x; v_t = w; w_t = -u", {}, {}, ILL, Fraction(1, 3), 0.75**0.5, math.inf),
    "exponent 2/3": ("u_t = v; v_t = w; w_t = u_xx", {}, {}, ILL, Fraction(2, 3), 0.5, math.inf),
    "exponent 4/3": ("u_t = v; v_t = w; w_t = u_xxxx", {}, {}, ILL, Fraction(4, 3), 1, math.inf),
    "hidden exponent 1/2": ("u_t = i*u_xx + v; v_t = i*v_xx + u_x", {}, {}, ILL, Fraction(1, 2), 0.5**0.5, math.inf),
    "Schroedinger": ("u_t = i*u_xx", {}, {}, WELL, 0, 0, 0),
    "Schroedinger, wrong-signed diffusion": ("u_t = i*u_xx - 0.1*u_xx", {}, {}, ILL, 2, 0.1, math.inf),
    "Schroedinger, diffusion": ("u_t = i*u_xx + 0.1*u_xx", {}, {}, WELL, 2, -0.1, 0),
    "one-sided": ("u_t = -i*u_x", {}, {}, ILL, 1, 1, math.inf),
    "Benjamin-Bona-Mahony": ("u_t - u_xxt + u_x = 0", {}, {}, WELL, 0, 0, 0),
    "diffusion in a pseudo-parabolic": ("u_t - u_xxt = u_xx", {}, {}, WELL, 0, -1, 0),
    "growth": ("u_t = u_xxx + u", {}, {}, WELL, 0, 1, 1),
    "constraint": ("u_t = -w; w = u_xx", {}, {}, ILL, 2, 1, math.inf),
    # two space variables
    "heat 2-D": ("u_t = u_xx + u_yy", {}, {}, WELL, 2, -1, 0),
    "heat along x": ("u_t = u_xx + 0*u_yy", {}, {}, WELL, 0, 0, 0),
    "forward-backward": ("u_t = u_xx - u_yy", {}, {}, ILL, 2, 1, math.inf),
    "mixed derivative": ("u_t = u_xx + 3*u_xy + u_yy", {}, {}, ILL, 2, 0.5, math.inf),
    "mixed derivative, milder": ("u_t = u_xx + u_xy + u_yy", {}, {}, WELL, 2, -0.5, 0),
    "wave 2-D": ("u_tt = u_xx + u_yy", {}, {}, WELL, 0, 0, 0),
    "ultrahyperbolic": ("u_tt = u_xx - u_yy", {}, {}, ILL, 1, 1, math.inf),
    "Navier-Stokes": (FLOW, {"u": 1, "v": 0}, {"U": 0.3, "nu": 0.1}, WELL, 2, -0.1, 0),
    "Euler": (FLOW, {}, {"U": 0.3, "nu": 0}, WELL, 0, 0, 0),
    "negative viscosity": (FLOW, {}, {"U": 0.3, "nu": -0.1}, ILL, 2, 0.1, math.inf),
    "drifting: (d_y)^4 against d_x": ("u_t = v + u_x; v_t = -u_yyyy - u_xx + v_x", {}, {}, ILL, 1, 1, math.inf),
}  # fmt: skip

# Base states that are not uniform and steady: growth there is not instability of the state.
VARYING = {"KdV on a slope", *(name for name in CASES if name.startswith("toy"))}


@pytest.mark.parametrize("name", CASES)
def test_verdict(name):
    text, at, parameters, kind, exponent, coefficient, bound = CASES[name]
    found = verdict(text, at=at, **parameters)
    assert isinstance(found, Verdict)
    assert found.kind == kind
    assert found.exponent == exponent
    assert found.coefficient == pytest.approx(coefficient, rel=1e-12, abs=1e-14)
    if bound is not None:
        assert found.bound == pytest.approx(bound, rel=1e-13, abs=1e-15)
    assert found.grows == (found.bound > 0)
    assert found.unstable == (found.grows and name not in VARYING)
    assert ("at a point" in found.reason) == (name in VARYING)
    assert math.hypot(*found.direction) == pytest.approx(1)
    assert found.reason.endswith(".")


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case[3] == WELL and "_y" not in case[0]])
def test_no_computed_growth_exceeds_the_bound(name):
    text, at, parameters, *_ = CASES[name]
    k = np.geomspace(1e-4, 1e4, 1500)
    rates = growth_rates(text, np.concatenate([-k, k]), at=at, **parameters)
    bound = verdict(text, at=at, **parameters).bound
    real = np.where(np.abs(rates.real) < 1e-7 * np.abs(rates), 0, rates.real)  # double roots have half the digits
    assert np.nanmax(real) <= bound + 1e-9
    if bound > 0:
        assert np.nanmax(real) > 0.999 * bound


def test_turing_bound():
    """The largest growth of the Turing system where d(lambda)/d(xi^2) = 0, from its quadratic by hand."""
    a, b, c, d, D = 1, 2, 2, 3, 30
    q = np.linspace(0, 2, 2_000_001)  # xi^2
    trace, det = a - d - (1 + D) * q, (a - q) * (-d - D * q) + b * c
    best = np.max((trace + np.sqrt(np.maximum(trace**2 - 4 * det, 0))) / 2)
    assert verdict(TURING, a=a, b=b, c=c, d=d, D=D).bound == pytest.approx(best, rel=1e-9)


@pytest.mark.parametrize(("text", "k"), [("u_t = u + u_xx", 0), ("u_t = -u_xx - u_xxxx", 0.5**0.5)])
def test_the_supremum_says_at_which_wavenumber(text, k):
    """Re lambda = 1 - xi^2 is largest at 0; xi^2 - xi^4 at xi^2 = 1/2. Flat tops keep half the digits of the place."""
    symbol = exact_symbol(text)
    _, where = supremum_of(symbol, law_along_line(symbol, (1,))[0], real=True, signs=(1,))
    assert where == pytest.approx(k, rel=1e-7)


def test_the_best_of_many_maxima_is_found():
    """Six bumps h (2 q - q^2), q = (xi/K)^2, each of height h at xi = K and -K, over five decades: twelve maxima."""
    heights = 1 + 0.01 * np.array([2, 0, 5, 1, 4, 3])
    text = "; ".join(
        f"w{n}_t = -{h}*(2*10^(-{2 * n})*w{n}_xx + 10^(-{4 * n})*w{n}_xxxx)" for n, h in enumerate(heights)
    )
    assert verdict(text).bound == pytest.approx(1.05, rel=1e-12)


def test_a_plateau_is_a_peak_and_a_step_on_a_slope_is_none():
    low = -np.inf
    rate = np.array([[0.0, 2.0, 2.0, 1.0, 1.0, 3.0]]).T
    np.testing.assert_array_equal(supremum._peaks(rate), np.array([[low, 2, 2, low, low, 3]]).T)
    around = np.array([[5.0, 5.0, 4.0, 3.0]])  # angles go round
    np.testing.assert_array_equal(supremum._peaks(around), [[5, 5, low, low]])


def test_a_maximum_beside_a_rate_of_exactly_one_is_followed():
    """a xi^2 - b xi^4 with a - b = 1, which is 1 at xi = 1, a place of the scan; its largest value is a^2/(4 b)."""
    a, b = 2.03125, 1.03125
    assert verdict(f"u_t = -{a}*u_xx - {b}*u_xxxx").bound == pytest.approx(a**2 / (4 * b), rel=1e-13)


def test_kelvin_helmholtz():
    """A vortex sheet's interface in its two potentials, reduced: growth |xi| U/2 without, bounded with surface tension.

    lambda^2 = (U xi/2)^2 - s xi^4 for the long-wave (shallow-layer) form of the two-stream problem.
    """
    text = "h_t = q; q_t = -(U/2)^2*h_xx - s*h_xxxx"
    sheet = verdict(text, U=3, s=0)
    assert (sheet.kind, sheet.exponent, sheet.coefficient) == (ILL, 1, pytest.approx(1.5))
    tense = verdict(text, U=3, s=0.1)
    assert (tense.kind, tense.unstable) == (WELL, True)
    assert tense.bound == pytest.approx(1.5**2 / (2 * 0.1**0.5), rel=1e-13)
    two_layers = "a_t + (a*u)_x = 0; u_t + u*u_x + p_x + g*a_x = 0; v_t + v*v_x + p_x = 0; (a*u + (1 - a)*v)_x = 0"
    at = {"a": 0.5, "u": 1, "v": -1, "a_x": 0, "u_x": 0, "v_x": 0}
    for g, kind in ((1, ILL), (3, ILL), (5, WELL)):  # hyperbolic once g > (u - v)^2, Long (1956)
        assert verdict(two_layers, at=at, g=g).kind == kind
    assert verdict(two_layers, at=at, g=0).coefficient == pytest.approx(1)


def test_maximal_order_can_mislead():
    assert verdict("u_t = u_xxx - u_xx").kind == ILL
    assert verdict("u_t = u_xxx - u_xx", order="maximal").kind == WELL
    full, maximal = (verdict(TOY, at={"u": -0.5, "v_xx": 0.3}, eps=0.01, order=o) for o in ("full", "maximal"))
    assert (full.exponent, full.coefficient) == (maximal.exponent, maximal.coefficient)  # eq. (toy-pde-lin)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("p", "kind", "exponent", "coefficient"),
    [(0.3, ILL, 1, 0.6), (0.5, ILL, Fraction(2, 3), None), (0.7, WELL, 0, -5.6)],
)
def test_critical_state_soil(p, kind, exponent, coefficient):
    """Dilating: |xi| sqrt(Y_p Y_phi/rho*). Critical: |xi|^{2/3} in a drifting direction. Contracting: bounded."""
    pencil = critical_state(p)
    found = verdict(pencil)
    assert (found.kind, found.exponent) == (kind, exponent)
    if coefficient is None:
        computed = max_growth(pencil, 1e7).growth / 1e7 ** (2 / 3)
        assert found.coefficient == pytest.approx(computed, rel=1e-3)
        assert found.direction == pytest.approx((0.5**0.5, math.copysign(0.5**0.5, found.direction[1])))
        assert "approached like |xi|^-2/3" in found.reason
    else:
        assert found.coefficient == pytest.approx(coefficient, rel=1e-9)


@pytest.mark.slow
def test_pencils_of_numbers():
    assert verdict(navier_stokes(0.1)).coefficient == pytest.approx(-0.1)
    compressible = verdict(granular(0.3, 0.2, 0.2, 0.7, 0.4, 0.6, -0.8))
    assert (compressible.kind, compressible.exponent) == (WELL, 0)
    assert compressible.bound == pytest.approx(1.2)
    with pytest.raises(TypeError, match="text only"):
        verdict(navier_stokes(), at={"u": 1})
    with pytest.raises(TypeError, match="the equations must be"):
        verdict(3)


def test_growth_that_is_unbounded_at_a_finite_wavenumber_is_not_judged():
    found = verdict("u_t + u_xxt = u_xx")  # lambda = -xi^2/(1 - xi^2)
    assert found.kind == "undecided"
    assert math.isnan(found.bound)
    assert "near |xi| = 1" in found.reason


@pytest.mark.parametrize(("sign", "direction"), [("-", (1, 0)), ("", (-1, 0))])
def test_growth_on_one_side_only_is_found_there(sign, direction):
    """u_t = s i u_x grows like -s xi_1: a complex equation, for which xi and -xi differ."""
    assert verdict(f"u_t = {sign}i*u_x").direction == direction[:1]
    found = verdict(f"u_t = {sign}i*u_x + 0*u_yy")
    assert (found.kind, found.exponent, found.coefficient, found.direction) == (ILL, 1, pytest.approx(1), direction)


@settings(max_examples=12, deadline=None)
@given(*[st.integers(-3, 3)] * 3, st.integers(-3, 3))
def test_anisotropic_quadratic_forms(a, b, c, d):
    """u_t = a u_xx + b u_xy + c u_yy + d u_xxx: the largest eigenvalue of minus the form, d whatever it is."""
    found = verdict(f"u_t = ({a})*u_xx + ({b})*u_xy + ({c})*u_yy + ({d})*u_xxx")
    largest = -np.linalg.eigvalsh([[a, b / 2], [b / 2, c]])[0]
    assert found.kind == (ILL if largest > 1e-12 else WELL)
    if abs(largest) > 1e-12:
        assert (found.exponent, found.coefficient) == (2, pytest.approx(largest, rel=1e-7))
    else:
        assert found.bound == 0


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("u_t = u_xx; u_x + v_x = 0; v_t = 0", "3 equations for 2 unknowns"),
        ("u_t + v_t = u_x; u_t + v_t = u_x", "do not determine the unknowns"),
        ("u_x = 0", "no equation contains a time derivative"),
        ("u_t = v_x; u_x = 0", "nothing that evolves"),
    ],
)
def test_systems_without_an_answer(text, word):
    with pytest.raises(PDEError, match=word):
        verdict(text)


@pytest.mark.parametrize("size", ["1e-60", "1e60"])
def test_the_size_of_an_equation_does_not_matter(size):
    found = verdict(f"{size}*u_t = {size}*v_x; v_t = {size}*u - v", at={})
    plain = verdict("u_t = v_x; v_t = w - v; w = 1e-60*u" if size == "1e-60" else "u_t = v_x; v_t = w - v; w = 1e60*u")
    assert (found.kind, found.exponent, found.coefficient) == (plain.kind, plain.exponent, plain.coefficient)
    assert found.kind == ILL


WITHOUT_BOUND = ": the shorter the wave the faster it grows, without bound"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("u_t = -u_xx", f"Re lambda ~ 1 |xi|^2 as |xi| -> infinity{WITHOUT_BOUND}."),
        (
            "u_t = u_xx - 2*u_yy",
            f"Re lambda ~ 2 |xi|^2 as |xi| -> infinity in the direction (0, 1){WITHOUT_BOUND}.",
        ),
        (
            "u_t = u_yy - u_xxxx - 2i*u_xxy - i*u_x",  # growth xi_1 on xi_2 = -xi_1^2, as in test_drift
            "Re lambda ~ 1 |xi|^(1/2) as |xi| -> infinity in the direction (0, -1), approached like |xi|^-1/2"
            f"{WITHOUT_BOUND}.",
        ),
        (
            "u_t = i*u_x + 0*u_yy",
            f"Re lambda ~ 1 |xi| as |xi| -> infinity in the direction (-1, 0){WITHOUT_BOUND}.",
        ),
        (
            "u_t = -u_xx - u_xxxx",
            "Growth is bounded by 0.25, reached near |xi| = 0.7071 (for short waves Re lambda ~ -1 |xi|^4): "
            "an instability, but not ill-posedness.",
        ),
        (
            "u_t = v_x + u; v_t = u_x + v",  # at every wavenumber alike; the first of equal ones is at 0
            "Growth is bounded by 1, reached near |xi| = 0 (for short waves Re lambda -> 1): "
            "an instability, but not ill-posedness.",
        ),
        (
            "u_t - u_xxt = -2*u_xx",  # 2 xi^2/(1 + xi^2)
            "Growth is bounded by 2, reached as |xi| -> infinity (for short waves Re lambda -> 2): "
            "an instability, but not ill-posedness.",
        ),
        ("u_t = u_x", "No perturbation grows: Re lambda <= 0 (for short waves Re lambda vanishes)."),
        ("u_t = u_xx - u", "No perturbation grows: Re lambda <= -1 (for short waves Re lambda ~ -1 |xi|^2)."),
        (
            "u_t + u_xxt = u_xx",
            "Growth is unbounded near |xi| = 1, where a time derivative drops out (for short waves Re lambda -> 1).",
        ),
    ],
)
def test_the_reason_in_full(text, reason):
    assert verdict(text).reason == reason


def test_an_undecided_verdict_claims_nothing():
    found = verdict(Pencil(lambda xi: [[xi**2 * np.sin(xi)]], [[1]]))
    assert found.reason.startswith("The largest growth does not settle to a power of |xi|, as far as computed")
    assert (found.kind, found.direction, found.unstable) == ("undecided", (), False)
    assert all(map(math.isnan, (found.exponent, found.coefficient, found.bound)))


@pytest.mark.parametrize(
    ("text", "seen", "doubt"),  # growth seen at |xi| = 1e5 and 1e7; the laws' own are 0, and 1e14 at 1e7
    [
        ("u_t = u_xx + u_yy", (1.0, 2.0), False),
        ("u_t = u_xx + u_yy", (1.0, 2.1), True),
        ("u_t = u_xx + u_yy", (-5.0, -1.0), False),
        ("u_t = u_xx + u_yy", (-5.0, 1.0), True),
        ("u_t = -u_xx - u_yy", (1.0, 1.2 * 1e7**2.0), False),  # a fifth more than the law is allowed
        ("u_t = -u_xx - u_yy", (1.0, 1.21e14), True),
        ("u_t = -u_xx - u_yy", (1e14, 2e14), False),  # twice as much at a hundred times the wavenumber
        ("u_t = -u_xx - u_yy", (1e14, 2.1e14), True),
    ],
)
def test_computed_growth_beyond_the_law_is_said(text, seen, doubt, monkeypatch):
    asked = []
    monkeypatch.setattr(extremes, "exact_growth", lambda symbol, xi: asked.append(xi) or seen[len(asked) - 1])
    found = verdict(text)
    assert [math.hypot(*xi) for xi in asked] == pytest.approx([1e5, 1e7], rel=1e-14)
    said = [f"{max(rate, 0.0):.4g}" for rate in seen]
    words = f", but growth of {said[0]} at |xi| = 100000 and {said[1]} at 1e+07 was computed" if doubt else ""
    if "-" in text:
        direction = "in the direction (1, 0)"
        assert found.reason == f"Re lambda ~ 1 |xi|^2 as |xi| -> infinity {direction}{WITHOUT_BOUND}{words}."
    elif doubt:
        assert found.reason == f"The Newton polygon gives Re lambda ~ -1 |xi|^2{words}."
    assert found.kind == (ILL if "-" in text else "undecided" if doubt else WELL)


def test_whether_xi_and_minus_xi_grow_alike():
    """Coefficients c of lambda^n xi^(a+b): i^(a+b) c is real, but for a common factor and a power of xi."""
    rng = np.random.default_rng(4)
    with mp.workdps(60):
        for _ in range(60):
            powers = {tuple(map(int, rng.integers(0, 4, 3))) for _ in range(5)}
            factor, odd = (
                mp.mpc(*rng.normal(size=2)) * mp.mpf(10) ** int(rng.integers(-60, 60)),
                int(rng.integers(0, 2)),
            )
            D = {(n, a + odd, b): factor * mp.mpc(0, 1) ** (a + b) * rng.normal() for n, a, b in powers}
            assert is_real(D)
            for power, c in D.items():
                for part, real in ((0.1, False), (1e-29, False), (1e-31, True)):
                    assert is_real(D | {power: c * (1 + part * mp.mpc(0, 1))}) is (real or len(D) == 1)


@pytest.mark.parametrize(
    ("text", "direction"),
    [("u_t = -u_xx + i*u", 1), ("u_t = -u_xx + u", 1), ("u_t = i*u_xxx", 1), ("u_t = -i*u_xxx", -1)],
)
def test_the_positive_side_is_named_where_both_grow_alike(text, direction):
    """Growth xi^2 is the same on both sides, whether the equation is real or not; i (i xi)^3 = xi^3 is not."""
    assert verdict(text).direction == (direction,)


def test_a_verdict_takes_moments():
    verdict("u_t = u_xx")  # imports
    for name in ("toy, u > 0", "toy, u < 0", "toy, u = 0", "Turing", "shallow water", "wave"):
        text, at, parameters, *_ = CASES[name]
        start = time.process_time()
        verdict(text, at=at, **parameters)
        assert time.process_time() - start < 5  # a tenth is usual; the rest is for slow machines


@pytest.mark.parametrize(
    ("text", "at", "direction"),
    [
        ("u_xt - u_x = y", {"u": 1, "u_x": 2, "x": 1j, "y": -0.5}, (0, 1)),
        ("u_xt - u_x = 0*u_y", {}, (0, 1)),
        ("u_yt = u_xy", {}, (1, 0)),
        ("u_xt - 2*u_yt = u_xx - 4*u_yy", {}, (0.8944, 0.4472)),
    ],
)
def test_waves_that_the_equations_leave_free_leave_the_verdict_open(text, at, direction):
    """There every lambda is a root of the determinant: 0 = 0."""
    found = verdict(text, at=at) if at else verdict(text)
    assert found.kind == "undecided"
    assert f"the direction ({direction[0]:.4g}, {direction[1]:.4g}) are left free" in found.reason


def test_what_is_ill_posed_elsewhere_is_so_whatever_is_left_free():
    assert verdict("u_xt = -u_xxx + 0*u_y").kind == "ill-posed"  # -xi_2 alone is free
    assert verdict("u_xxt + u_yyt = u_xx + u_yy").kind == "well-posed"  # a factor without real directions
