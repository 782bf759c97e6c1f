"""Guards the largest growth over all wavevectors: its value and its place, and each step by which it is sought.

Second routes: closed forms of growth rates whose maximum is known by hand.
"""

import math

import mpmath as mp
import numpy as np
import pytest

import primer.analysis.supremum as supremum
from primer import Pencil
from primer.analysis.laws import exact_symbol
from primer.analysis.puiseux import Law
from primer.analysis.symbol import Symbol
from primer.analysis.verdict import _along_line, _in_plane, _is_real

BILAPLACIAN = "u_xxxx - 2*u_xxyy - u_yyyy"


def largest(text, **parameters):
    symbol = exact_symbol(text, **parameters)
    real = _is_real(symbol.determinant)
    law = (_along_line if symbol.dim == 1 else _in_plane)(symbol, real)[0]
    return supremum.supremum(symbol, law, real)


@pytest.mark.parametrize(
    ("text", "bound", "k"),
    [
        ("u_t = i*u_x + u_xx", 0.25, 0.5),  # -xi - xi^2: on the negative side
        ("u_t = -i*u_x + u_xx", 0.25, 0.5),
        ("u_t = -1e5*u_xx - u_xxxx", 2.5e9, math.sqrt(5e4)),
        ("u_t = -1e-6*u_xx - 1e-12*u_xxxx - u/7", 0.25 - 1 / 7, math.sqrt(5e5)),
        ("u_t - u_xxt = 2*u - 3*u_xx", 3, math.inf),  # 3 - 1/(1 + xi^2)
        ("u_t - u_xxt = -u", 0, math.inf),  # -1/(1 + xi^2)
        ("u_t = 3*u + u_xx", 3, 0),
        ("u_t = u_xxx", 0, 0),
        ("u_tt = u_xx - 4*u", 0, 0),
        ("u_tt = u_xx + 4*u", 2, 0),
        ("u_t = v + u_xx; v_t = -i*u_x", None, None),
    ],
)
def test_the_supremum_and_its_place_along_a_line(text, bound, k):
    if bound is None:  # lambda (lambda + xi^2) = xi
        xi = np.linspace(0.01, 3, 200_001)
        rate = (np.sqrt(xi**4 + 4 * xi) - xi**2) / 2
        bound, k = rate.max(), xi[rate.argmax()]
        assert largest(text) == (pytest.approx(bound, rel=1e-9), pytest.approx(k, rel=1e-3))
    else:
        assert largest(text) == (pytest.approx(bound, rel=1e-13, abs=0), pytest.approx(k, rel=1e-6, abs=0))


@pytest.mark.parametrize("angle", [0.0, 0.4, 2.0])
def test_the_supremum_and_its_place_in_the_plane(angle):
    """Growth (xi . d)^2 - |xi|^4, which is largest, 1/4, at xi = d/sqrt 2."""
    c, s = math.cos(angle), math.sin(angle)
    text = f"u_t = -({c**2})*u_xx - ({2 * c * s})*u_xy - ({s**2})*u_yy - {BILAPLACIAN}"
    assert largest(text) == (pytest.approx(0.25, rel=1e-13), pytest.approx(math.sqrt(0.5), rel=1e-4))


@pytest.mark.parametrize("angle", [0.4, 4.0])
def test_growth_on_one_side_in_the_plane(angle):
    """Growth xi . d - |xi|^2, which is largest, 1/4, at xi = d/2 and negative at -d/2."""
    text = f"u_t = -i*({math.cos(angle)})*u_x - i*({math.sin(angle)})*u_y + u_xx + u_yy"
    assert largest(text) == (pytest.approx(0.25, rel=1e-13), pytest.approx(0.5, rel=1e-4))


def test_where_an_unknown_is_undetermined_at_zero_the_limit_counts():
    """Growth a - nu |xi|^2 of an incompressible flow, whose pressure nothing determines at xi = 0."""
    flow = "u_t + p_x = a*u + u_xx + u_yy; v_t + p_y = a*v + v_xx + v_yy; u_x + v_y = 0"
    assert largest(flow, a=0.7) == (pytest.approx(0.7, rel=1e-13), 0)


def test_wavevectors_of_a_length_and_a_direction():
    np.testing.assert_allclose(supremum._wavevector(1, np.array([[2.0], [-3.0]]), np.array([0, np.pi])),
                               [[100, -100], [1e-3, -1e-3]])  # fmt: skip
    np.testing.assert_allclose(supremum._wavevector(2, 1.0, np.pi / 6), [75**0.5, 5])
    assert supremum._wavevector(2, np.zeros((4, 3)), np.zeros((4, 3))).shape == (2, 4, 3)


def test_rates_at_rounding_level_are_zero_and_undetermined_ones_lowest():
    entries = np.array([1e-12, 1e-10, -1e-12, -1e-10]) + 1j
    pencil = Pencil(-np.diag(entries), np.eye(4), dim=1)
    assert supremum._rates(pencil, np.zeros(1), np.zeros(1)).item() == pytest.approx(1e-10)
    for real, rate in ((9e-12, 0), (1.1e-11, 1.1e-11), (-9e-12, 0), (-1.1e-11, -1.1e-11)):
        one = Pencil([[-7j - 7 * real]], [[1]], dim=1)
        assert supremum._rates(one, np.zeros(2), np.zeros(2)).tolist() == pytest.approx([7 * rate] * 2, rel=1e-12)
    at_one = Pencil(lambda xi: np.diag([xi - 1, 2 + 0 * xi]), np.diag([0, 1]), dim=1)
    assert supremum._rates(at_one, np.array([0.0, 1.0]), np.zeros(2)).tolist() == [-np.inf, -2]
    nothing = Pencil([[1]], [[0]], dim=1)
    assert supremum._rates(nothing, np.zeros(2), np.zeros(2)).tolist() == [-np.inf] * 2


def test_peaks_are_the_places_that_none_of_four_neighbours_exceeds():
    """Angles go round; beyond the first and the last length there is nothing."""
    random = np.random.default_rng(21)
    for shape in ((6, 5), (4, 2), (5, 1), (1, 4), (2, 3)) * 4:
        rate = random.integers(0, 6, shape).astype(float)
        lengths, angles = shape
        for n, m in np.ndindex(shape):
            beside = [rate[n, m - 1], rate[n, (m + 1) % angles]] + [
                rate[i, m] for i in (n - 1, n + 1) if 0 <= i < lengths
            ]
            assert supremum._peaks(rate)[n, m] == (rate[n, m] if rate[n, m] >= max(beside) else -np.inf)


def test_a_maximum_is_followed_uphill():
    """u_t of (xi . d)^2 - |xi|^4 from a place of the scan; a place that is the top already stays."""
    line = Pencil(lambda xi: [[xi**4 - xi**2]], [[1]], dim=1)
    s, angle = supremum._followed(line, -0.16, 0.0, 0.02, 0.3)
    assert (s, angle) == (pytest.approx(math.log10(0.5) / 2, abs=1e-7), 0)
    s, angle = supremum._followed(line, -0.14, np.pi, 0.02, 0.3)
    assert (s, angle) == (pytest.approx(math.log10(0.5) / 2, abs=1e-7), np.pi)
    c, d = math.cos(0.4), math.sin(0.4)
    plane = Pencil(lambda xi: [[(xi[0] ** 2 + xi[1] ** 2) ** 2 - (c * xi[0] + d * xi[1]) ** 2]], [[1]], dim=2)
    for start in ((-0.2, 0.38), (-0.1, 0.42)):
        s, angle = supremum._followed(plane, *start, 0.1, 0.05)
        assert (s, angle) == (pytest.approx(math.log10(0.5) / 2, abs=1e-7), pytest.approx(0.4, abs=1e-7))
    level = Pencil([[-1]], [[1]], dim=2)
    assert supremum._followed(level, 0.3, 0.7, 0.1, 0.1) == (0.3, 0.7)


@pytest.mark.parametrize("off", [-8e-5, -2e-5, 0, 4e-5, 9e-5])
def test_a_parabola_sharpens_a_maximum_and_its_place(off):
    symbol, top = exact_symbol("u_t = -u_xx - u_xxxx"), math.log10(0.5) / 2
    found = supremum._sharpened(symbol, top + off, 0.0)
    assert [value for value, _ in found] == pytest.approx([0.25] * 3, abs=1e-6)
    assert found[0] == (pytest.approx(0.25 * (1 - (2 * off * math.log(10)) ** 2), abs=3e-11), 10 ** (top + off))
    assert found[-1] == (pytest.approx(0.25, rel=1e-15), pytest.approx(math.sqrt(0.5), rel=1e-7))
    assert max(found)[0] == pytest.approx(0.25, rel=1e-15)


def test_a_parabola_takes_no_step_uphill_of_its_own_width_and_none_where_it_bends_upwards():
    rising = exact_symbol("u_t = -u_xx + 0*u_xxxx")  # k^2 bends upwards in log k
    assert {place for _, place in supremum._sharpened(rising, 0.0, 0.0)} == {1.0}
    falling = exact_symbol("u_t = -1e4*u_xxxx - u_xx")  # far beyond its top, bending downwards
    places = [math.log10(place) for _, place in supremum._sharpened(falling, 0.0, 0.0)]
    assert places == pytest.approx([0, -1e-4, -1e-4 - 1e-7], abs=1e-12)


@pytest.mark.parametrize(
    ("text", "xi", "rate"),
    [
        ("u_t = -u_xx", 3.0, 9),
        ("u_t = u_xxx", 3.0, 0),
        ("u_t = u_xxx", -3e10, 0),
        ("u_t = u_xxx - 1e-40*u_xx", 1.0, 1e-40),
        ("u_t = u_xxx - 1e-60*u_xx", 1.0, 0),
        ("u_tt = -u_xx - u", 2.0, math.sqrt(3)),
        ("u_t = v + u_xx; v_t = 1e-30*u", 1e10, 1e-50),
        ("u_t = -i*u_x", 2.0, 2),
        ("u_t = -i*u_x", -2.0, -2),
        ("u_t = u_x + 2*u_yy - u_xxy + 5*u", [3.0, 2.0], -3),
        ("u_t = -i*u_xxy + 3*u_yy", [3.0, 2.0], -12 - 18),
        ("u_t = u + 0*u_yy", [0.0, 0.0], 1),
        ("u_t + p_x = 0; v_t + p_y = 0; u_x + v_y = 0", [0.0, 0.0], -math.inf),
        ("u_t + u_xxt = u", 1.0, -math.inf),
    ],
)
def test_growth_at_one_wavevector_to_all_digits(text, xi, rate):
    assert supremum.exact_growth(exact_symbol(text), xi) == pytest.approx(rate, rel=1e-14, abs=0)


def test_poles_of_growth_at_a_wavenumber():
    """Where the coefficient of the highest time derivative vanishes, growth beside it is infinite, or a number."""

    def poles(text):
        return sorted((value, round(k, 12)) for value, k in supremum._poles(exact_symbol(text)))

    assert poles("u_t = u_xx") == poles("u_t - u_xxt = u_xx") == []
    both = poles("u_t + u_xxt/4 = u_xx")  # lambda = -xi^2/(1 - xi^2/4), at xi = 2 and -2
    assert both[2:] == [(math.inf, 2)] * 2
    assert [k for _, k in both[:2]] == [2, 2]
    assert [value for value, _ in both[:2]] == pytest.approx([-2e12] * 2, rel=1e-6)
    double = poles("u_t + 2*u_xxt + u_xxxxt = u_xx")  # -xi^2/(1 - xi^2)^2
    assert [value for value, _ in double] == pytest.approx([-2.5e23] * 4, rel=1e-6)
    assert [value for value, _ in poles("u_t + u_xxt = 3*u + 3*u_xx")] == pytest.approx([3] * 4)
    assert poles("u_xt = u_x") == []  # at xi = 0 alone
    second = poles("u_tt + u_xxtt = -u_xx - u")  # lambda^2 = -1 (xi^2 - 1)/(1 - xi^2): a common factor
    assert [value for value, _ in second] == [0] * 4
    assert [k for _, k in second] == [1] * 4


def test_a_bound_at_rounding_level_is_zero():
    """1e-15 beside eigenvalues of size one is rounding; 1e-13 is not."""
    for real, bound in ((1e-15, 0), (-1e-13, -1e-13)):
        symbol = Symbol((({(1, 0, 0): mp.mpf(1), (0, 1, 0): mp.mpf(-1), (0, 0, 0): -mp.mpf(real)},),))
        assert supremum.supremum(symbol, Law(0, real), True)[0] == pytest.approx(bound, rel=1e-9, abs=0)
