"""Guards the slopes at a kink: |z| z has the slope 0 at z = 0 and |z| has none, whatever form they are written in.

Second route: the slope of each case by hand, and difference quotients in double precision.
"""

import numpy as np
import pytest
import sympy as sp

from primer import growth_rates, linearise, verdict
from primer.equations.text import PDEError

FLAT = {"u_x": 0, "u_xx": 0}
P = 2.5

# The flux or source g(z), and its slope at z = 0.
SMOOTH_ENOUGH = {
    "abs({z})*{z}": 0,
    "{z}*sqrt({z}^2)": 0,
    "abs({z})^p*{z}": 0,
    "abs({z})^0.5*{z}": 0,
    "abs({z})^3": 0,
    "abs({z})^(3/2)": 0,
    "({z}^2)^(3/2)": 0,
    "({z}^2)^0.75": 0,
    "abs({z}^3)": 0,
    "sin({z})*abs({z})": 0,
    "3*{z} + abs({z})*{z}": 3,
    "-2*{z} - abs({z})^3/7": -2,
    "abs({z} + {z}^3)*{z}": 0,
    "exp(2*{z}) + abs({z})^3": 2,
}


@pytest.mark.parametrize("g", SMOOTH_ENOUGH)
def test_a_source_has_the_slope_that_it_has(g):
    text, kw = f"u_t = {g.format(z='u')} + u_xx", {"p": P} if "p" in g.replace("exp", "") else {}
    slope = SMOOTH_ENOUGH[g]
    assert growth_rates(text, [0.0, 3.0], at={"u": 0}, **kw).ravel().tolist() == [slope, slope - 9]
    assert verdict(text, at={"u": 0}, **kw).bound == slope
    assert linearise(text, at={"u": 0}, **kw) == sp.Matrix([[slope - sp.Symbol("xi") ** 2]])


@pytest.mark.parametrize("g", SMOOTH_ENOUGH)
def test_a_flux_has_the_slope_that_it_has(g):
    """u_t = g(u_x)_x = g'(u_x) u_xx: at a flat state lambda = -g'(0) xi^2, and nothing of g''."""
    text, kw = f"u_t = ({g.format(z='u_x')})_x", {"p": P} if "p" in g.replace("exp", "") else {}
    slope = SMOOTH_ENOUGH[g]
    found = growth_rates(text, [1.0, 3.0], at=FLAT, **kw)
    assert found.ravel().tolist() == [-slope, -9 * slope]
    assert linearise(text, at=FLAT, **kw) == sp.Matrix([[-slope * sp.Symbol("xi") ** 2]])
    outcome = verdict(text, at=FLAT, **kw)
    assert str(outcome.kind) == ("ill-posed" if slope < 0 else "well-posed")
    assert outcome.coefficient == -slope


def test_the_row_of_the_false_refusal():
    outcome = verdict("u_t = (abs(u_x)*u_x)_x", at=FLAT)
    assert (str(outcome.kind), outcome.exponent, outcome.coefficient, outcome.bound) == ("well-posed", 0, 0, 0)


def test_in_two_variables_and_in_systems():
    """The flux |grad u| grad u has no slope at grad u = 0 but 0; nor has what is added to a known one."""
    at = {name: 0 for name in ("u_x", "u_y", "u_xx", "u_xy", "u_yy")}
    flux = "(sqrt(u_x^2 + u_y^2)*u_x)_x + (sqrt(u_x^2 + u_y^2)*u_y)_y"
    xi = np.array([[1.0, 2.0], [2.0, 3.0]])
    assert growth_rates(f"u_t = {flux}", xi, at=at).ravel().tolist() == [0, 0]
    assert growth_rates(f"u_t = {flux} - u_xx + 2*u_yy - c*u", xi, at=at, c=3).ravel().tolist() == [
        1 - 8 - 3,
        4 - 18 - 3,
    ]
    system = "u_t = abs(u + v)*(u - v) + v_x; v_t = u_x + abs(u - v)^3"
    found = growth_rates(system, [2.0], at={"u": 0, "v": 0})
    assert found.ravel() == pytest.approx([2j, -2j]) or found.ravel() == pytest.approx([-2j, 2j])


@pytest.mark.parametrize(
    ("text", "at"),
    [
        ("u_t = abs(u) + u_xx", {"u": 0}),
        ("u_t = sqrt(u^2) + u_xx", {"u": 0}),
        ("u_t = abs(u)^0.9 + u_xx", {"u": 0}),
        ("u_t = u_x^2/u", {"u": 0, "u_x": 0}),
        ("u_t = (abs(u_x)/u_x)*u_xx", FLAT),
        ("u_t = (abs(u_x)*u_x)_x", {"u_x": 0, "u_xx": 1}),  # it is 2 |u_x| u_xx, with a kink where u_xx is not 0
        ("u_t = abs(u_x)*u_xx", {"u_x": 0, "u_xx": -1}),
        ("u_t = (abs(u_x))_x", FLAT),
        ("u_t = u_xx/u", {"u": 0, "u_xx": 0}),
        ("u_t = u_x/u", {"u": 0, "u_x": 0}),
        ("u_t = u*u_x/sqrt(u^2 + u_x^2) + u_xx", {"u": 0, "u_x": 0}),
        # Its slopes along the axes are 0, and it is min(|u|, |u_x|): not differentiable.
        ("u_t = abs(u) + abs(u_x) - abs(abs(u) - abs(u_x)) + u_xx", {"u": 0, "u_x": 0}),
        ("u_t = (u^1.5)_x", {"u": 0, "u_x": 1}),
        ("u_t = (u^1.5)_x", {"u": 0, "u_x": 0}),  # not real on one side
        ("u_t = u*log(u) + u_xx", {"u": 0}),
    ],
)
def test_what_has_no_slope_is_refused(text, at):
    for ask in (verdict, linearise, lambda text, at: growth_rates(text, 1.0, at=at)):
        with pytest.raises(PDEError, match=r"the base state makes .*(divide by zero|not a number to work with)"):
            ask(text, at=at)


@pytest.mark.parametrize("shift", [1e-30, 1e-9, 0.3])
def test_near_a_kink_the_formula_says_the_same_as_before(shift):
    found = growth_rates("u_t = (abs(u_x)*u_x)_x", [2.0], at={"u_x": -shift, "u_xx": 0})
    assert found[0, 0] == pytest.approx(-2 * shift * 4, rel=1e-14)


def test_slopes_agree_with_difference_quotients():
    draw = np.random.default_rng(3)
    for _ in range(6):
        p, c = draw.uniform(1.2, 4), draw.uniform(-2, 2)
        text = "u_t = c*u + abs(u)^p - u*abs(u)^(p - 1)/2 + sin(u)"
        rate = growth_rates(text, [0.0], at={"u": 0}, p=p, c=c)[0, 0].real
        h = 1e-80
        assert rate == pytest.approx((c * h + h**p - h * h ** (p - 1) / 2 + np.sin(h)) / h, abs=1e-9)
