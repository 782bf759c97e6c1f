"""Guards the search over directions: laws attained in one direction only, along a curve, and along a curve's curve.

Second route: the symbols are polynomials whose growth can be maximised by hand.
"""

from fractions import Fraction

import numpy as np
import pytest

from primer import growth_rates, verdict

# -(xi_1 + xi_2^2 + c xi_2)^2 + xi_2, from L = -i d/dx - d/dyy - c i d/dy with this first bracket as its symbol.
PARABOLA = "u_t = u_xx - u_yyyy + c^2*u_yy - 2i*u_xyy + 2*c*u_xy - 2i*c*u_yyy - i*u_y"


@pytest.mark.parametrize("c", [0, 3, -0.5])
def test_growth_along_a_parabola(c):
    """Growth xi_2 on xi_1 = -xi_2^2 - c xi_2, and decay off it: like |xi|^{1/2}, in the direction (-1, 0).

    There xi_2/k = k^{-1/2} - (c/2) k^{-1} + ...: with c not 0, a drift within a drift.
    """
    found = verdict(PARABOLA, c=c)
    assert (found.kind, found.exponent) == ("ill-posed", Fraction(1, 2))
    assert found.coefficient == pytest.approx(1, rel=1e-6)
    assert found.direction == (-1, 0)
    y = 1e4
    on = growth_rates(PARABOLA, [-(y**2) - c * y, y], c=c).real
    off = growth_rates(PARABOLA, [-(y**2) - (c + 1) * y, y], c=c).real
    assert on == pytest.approx(y, rel=1e-2)
    assert off < 0


@pytest.mark.parametrize(("s", "direction"), [(2, (2, 1)), (-3, (3, -1)), (1, (1, 1)), (-1, (1, -1))])
def test_growth_where_two_waves_keep_pace(s, direction):
    """(lambda - i xi_1)(lambda - i s xi_2) = i xi_1: bounded, but for xi_1 = s xi_2: lambda - i xi_1 = sqrt(i xi_1).

    Both waves are neutral in every direction, so that nothing but their meeting tells where to look.
    """
    found = verdict(f"u_t = u_x + v; v_t = {s}*v_y + u_x")
    length = np.hypot(*direction)
    assert (found.kind, found.exponent) == ("ill-posed", Fraction(1, 2))
    assert found.direction == pytest.approx(np.array(direction) / length, abs=1e-12)
    assert found.coefficient == pytest.approx((direction[0] / length / 2) ** 0.5, rel=1e-9)


@pytest.mark.parametrize(
    ("text", "direction", "coefficient"),
    [
        ("u_t = -u_xx - u_yy", (1, 0), 1),  # all directions alike: the plainest is named
        ("u_t = u_xx - 2*u_yy", (0, 1), 2),
        ("u_t = -2*u_xx + u_yy", (1, 0), 2),
        ("u_t = -u_xy", (0.5**0.5, 0.5**0.5), 0.5),
        ("u_t = u_xy", (0.5**0.5, -(0.5**0.5)), 0.5),
        ("u_t = -i*u_x + 0*u_yy", (1, 0), 1),
        ("u_t = i*u_y + 0*u_xx", (0, -1), 1),
    ],
)
def test_a_plain_direction_is_named_exactly(text, direction, coefficient):
    found = verdict(text)
    assert found.direction == pytest.approx(direction, abs=1e-15)
    assert found.coefficient == pytest.approx(coefficient, rel=1e-14)


@pytest.mark.parametrize(("a", "b", "c"), [(1, 3, -2), (2, -5, 2), (-4, 1, 3)])
def test_a_maximum_between_special_directions_is_found(a, b, c):
    """The largest eigenvalue of a quadratic form and its eigenvector, which no special value of the slope gives."""
    found = verdict(f"u_t = ({a})*u_xx + ({b})*u_xy + ({c})*u_yy")
    values, vectors = np.linalg.eigh([[-a, -b / 2], [-b / 2, -c]])
    assert found.coefficient == pytest.approx(values[1], rel=1e-12)
    assert abs(vectors[:, 1] @ found.direction) == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_the_exponent_of_the_drift(m):
    """lambda = xi_1 - xi_2^(2m+2): growth in the direction (1, 0) and a window about it |xi|^(1/(2m+2) - 1) wide."""
    order = 2 * m + 2
    sign = "-" if m % 2 else "+"  # (i xi_2)^(2m+2) = (-1)^(m+1) xi_2^(2m+2)
    found = verdict(f"u_t = -i*u_x {sign} u_{'y' * order}")
    assert (found.exponent, found.coefficient, found.direction) == (1, pytest.approx(1), (1, 0))


def test_growth_along_a_curve_of_more_terms_than_are_followed_is_not_denied():
    """Growth xi_2 on xi_1 = -xi_2^3 - xi_2^2 - xi_2: three drifts, one within another. Computed growth raises doubt."""
    bracket = "i*{0}_yyy - {0}_yy - i*{0}_y - i*{0}_x"
    found = verdict(f"u_t = -w2 - i*u_y; w2 = {bracket.format('w')}; w = {bracket.format('u')}")
    assert found.kind == "undecided"
    assert "was computed" in found.reason
