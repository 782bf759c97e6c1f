"""Guards against verdicts that were false once: one case at least of each kind of fault, with its truth by hand."""

import math
from fractions import Fraction

import pytest

from primer import verdict
from primer.analysis.laws import exact_symbol
from primer.analysis.poles import on_curves

GAS = "r_t + (r*u)_x = 0; u_t + u*u_x = 0"


@pytest.mark.parametrize(
    "text",
    [
        "u_tt + 2/3*u_tx + u_xx/9 = 0",
        "u_t + u_x/3 + v = 0; v_t + v_x/3 = 0",
        "u_t = u_x/7 + v; v_t = v_x/7 + w; w_t = w_x/7",
        "u_ttt + 3/7*u_ttx + 3/49*u_txx + u_xxx/343 = 0",
        "u_tt + 2/3*u_tx + u_xx/9 = 0*u_yy",
        "u_tt = 2*i/3*u_txx + u_xxxx/9",
    ],
)
def test_a_multiple_root_is_not_split_by_rounding(text):
    found = verdict(text)
    assert (found.kind, found.exponent, found.coefficient, found.bound) == ("well-posed", 0, 0, 0)


def test_pressureless_gas_at_any_speed():
    for k in range(1, 100, 7):
        found = verdict(GAS, at={"r": 1, "u": k / 100, "u_x": 0, "r_x": 0})
        assert (found.kind, found.bound) == ("well-posed", 0)


@pytest.mark.parametrize(
    ("text", "direction"),
    [
        ("u_yt = u_x", (1, 0)),  # lambda = xi_1/xi_2
        ("u_t + v = 0; u_x + v_y = 0", (1, 0)),
        ("u_t = p; p_xx - p_yy = u_xx", (1, 1)),  # lambda = xi_1^2/(xi_1^2 - xi_2^2)
        ("u_ty = -u_xxx", (1, 0)),  # xi_1^3/xi_2
        ("u_t + U*u_x + s*v = u_yy; u_x + v_y = 0", (1, 0)),
        ("u_xt + 2*u_yt = i*u_yyy + i*u", (2, -1)),
    ],
)
def test_growth_unbounded_at_every_wavenumber_has_neither_power_nor_bound(text, direction):
    parameters = {"U": 1, "s": 1} if "U*" in text else {}
    found = verdict(text, **parameters)
    assert (found.kind, found.exponent, found.coefficient, found.bound) == ("ill-posed", *[math.inf] * 3)
    length = math.hypot(*direction)
    assert abs(sum(a * b for a, b in zip(found.direction, direction, strict=True))) == pytest.approx(length)
    assert "unbounded at every |xi|" in found.reason


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("u_t + u_xxt + u_yyt = u_xx + u_yy", "near |xi| = 1,"),
        ("u_t - u_xxt + u_yyt = u", "on a curve"),  # a hyperbola
        ("u_t + u_xxt + u_yyt/4 = u_xx", "on a curve"),  # an ellipse
        ("u_t + 4*u_xxt + 4*u_xxxxt - u_yyt = -u_xx", "near |xi| = 0.7071,"),  # two points: (1 - 2 xi_1^2)^2 + xi_2^2
        ("u_t = i*u_yt + u", "on a curve"),  # the line xi_2 = -1
        ("u_t + u_xxt = u_xx", "near |xi| = 1,"),
        ("u_xxt = -u", "as |xi| -> 0"),  # lambda = 1/xi^2
        ("u_xxt + u_yyt = -u_xx - u", "as |xi| -> 0"),
    ],
)
def test_growth_unbounded_at_a_finite_wavenumber_is_undecided(text, place):
    found = verdict(text)
    assert found.kind == "undecided"
    assert place in found.reason
    assert math.isnan(found.bound)


@pytest.mark.parametrize(
    ("text", "exponent", "coefficient", "bound"),
    [
        ("u_tx = u_yy + u_xxx", 0, 0, 0),  # lambda = i xi_2^2/xi_1 - xi_1^2
        ("u_tx = u_yy + u_xxx + 3*u_x", 0, 3, 3),
        ("u_xt = u", 0, 0, 0),  # 1/(i xi)
        ("u_t + u_xxt + u_yyt = u_x", 0, 0, 0),  # i xi_1/(1 - xi^2)
        ("u_xxt + u_yyt = u_xx - u_yy", 0, 1, 1),  # cos of twice the angle, at every |xi|
        ("u_xxt + u_yyt = u", -2, -1, 0),  # -1/xi^2
    ],
)
def test_poles_near_which_growth_is_bounded_are_judged(text, exponent, coefficient, bound):
    found = verdict(text)
    assert (found.kind, found.exponent) == ("well-posed", exponent)
    assert (found.coefficient, found.bound) == pytest.approx((coefficient, bound), abs=1e-15)


def test_poles_at_points_and_curves():
    def poles(text):
        return on_curves(exact_symbol(text).determinant)

    assert poles("u_t + u_xxt + u_yyt = u_xx + u_yy") == (math.inf, pytest.approx(1))
    assert poles("u_t = u_xx + u_yy")[0] == poles("u_t - u_xxt - u_yyt = u_xx")[0] == -math.inf
    limit, k = poles("u_t + u_xxt/4 + u_yyt/4 = 3*u + 3/4*u_xx + 3/4*u_yy")  # lambda = 3, though it is 0/0 at |xi| = 2
    assert (limit, k) == (pytest.approx(3), pytest.approx(2))


def test_a_steady_uniform_state_is_unstable_and_one_that_varies_is_not_judged():
    """Allen-Cahn: u = 0 is steady and unstable; u = 0.2 is not steady, and u with a slope is not uniform."""
    text = "u_t = u_xx + u - u^3"
    assert verdict(text, at={"u": 0}).unstable
    for at in ({"u": 0.2}, {"u": 0, "u_x": 1}):
        found = verdict(text, at=at)
        assert found.grows
        assert not found.unstable
        assert "instab" not in found.reason
        assert found.reason.endswith("this is about short waves at a point.")
    shear = "u_t + u*u_x + v*u_y + p_x = nu*(u_xx + u_yy); v_t + u*v_x + v*v_y + p_y = nu*(v_xx + v_yy); u_x + v_y = 0"
    at = {"u": 0, "v": 0, "u_x": 0, "u_y": 1, "v_x": 0, "v_y": 0}
    found = verdict(shear, at=at, nu=0.1)
    assert (found.kind, found.bound, found.unstable) == ("well-posed", pytest.approx(0.5), False)
    assert not verdict("u_t = u_xx + u + sin(x)").unstable
    assert verdict("u_t = u_xx + u + 1", at={"u": -1}).unstable


def test_the_exponent_is_a_fraction_wherever_there_is_one():
    for text in ("u_t = u_xx", "u_tx = u_yy + u_xxx", "u_t = v; v_t = u_x"):
        assert isinstance(verdict(text).exponent, Fraction)
