"""Guards the largest growth over all wavevectors: its value and its place, and each step by which it is sought.

Second routes: closed forms of growth rates whose maximum is known by hand.
"""

import math

import mpmath as mp
import numpy as np
import pytest

import primer.analysis.supremum as supremum
from primer import Pencil
from primer.analysis.extremes import is_real, law_along_line, law_in_plane, supremum_of
from primer.analysis.laws import exact_symbol

BILAPLACIAN = "u_xxxx - 2*u_xxyy - u_yyyy"


def largest(text, **parameters):
    symbol = exact_symbol(text, **parameters)
    real = is_real(symbol.determinant)
    signs = (1,) if real else (1, -1)
    law = (law_along_line(symbol, signs) if symbol.dim == 1 else law_in_plane(symbol, real))[0]
    return supremum_of(symbol, law, real, signs)


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
    c, d = math.cos(0.4), math.sin(0.4)
    plane = Pencil(lambda xi: [[(xi[0] ** 2 + xi[1] ** 2) ** 2 - (c * xi[0] + d * xi[1]) ** 2]], [[1]], dim=2)
    for start in ((-0.2, 0.38), (-0.1, 0.42)):
        s, angle = supremum._followed(plane, *start, 0.1, 0.05)
        assert (s, angle) == (pytest.approx(math.log10(0.5) / 2, abs=1e-7), pytest.approx(0.4, abs=1e-7))
    level = Pencil([[-1]], [[1]], dim=2)
    assert supremum._followed(level, 0.3, 0.7, 0.1, 0.1) == (0.3, 0.7)


@pytest.mark.parametrize("off", [-8e-5, -2e-5, 0, 4e-5, 9e-5])
def test_a_parabola_sharpens_a_maximum(off):
    D, top = exact_symbol("u_t = -u_xx - u_xxxx + 0*u_yy").determinant, math.log10(0.5) / 2
    found = supremum._sharpened(D, top + off, 0.0)
    assert [value for value, _ in found] == pytest.approx([0.25] * 3, abs=1e-6)
    assert found[0] == (pytest.approx(0.25 * (1 - (2 * off * math.log(10)) ** 2), abs=3e-11), 10 ** (top + off))
    assert found[-1] == (pytest.approx(0.25, rel=1e-15), pytest.approx(math.sqrt(0.5), rel=1e-7))


@pytest.mark.parametrize("top", [-0.93, 0.0, 1e-7, 0.5, 0.999, 1.0])
def test_a_climb_ends_at_the_top(top):
    """Of a parabola, of a peak with a corner, and of one a millionth wide."""
    with mp.workdps(50):
        for f in (lambda x: -((x - top) ** 2), lambda x: -abs(x - top), lambda x: 1 / (1 + (x - top) ** 2 * 10**12)):
            value, place = supremum.climbed(f, mp.mpf(-1), mp.mpf("0.1"), mp.mpf(1), f(mp.mpf("0.1")))
            assert abs(value - f(mp.mpf(top))) < 1e-11
            assert abs(place - top) < 1e-9


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


def test_growth_fainter_than_thirty_digits_beside_all_scales_is_none():
    for e, bound in (("1e-40", 0), ("1e-20", 1e-20)):
        text = f"u_t = i*u_xx + {e}*v; v_t = -i*v_xx - 1.7*i*v + {e}*u"
        assert largest(text)[0] == pytest.approx(bound, rel=1e-6, abs=0)


@pytest.mark.parametrize("e", [1e-1, 1e-3, 1e-6, 1e-9])
def test_a_resonance_however_narrow(e):
    """lambda + 0.85 i = +-sqrt(e^2 - (xi^2 - 0.85)^2): a band of width e."""
    value, k = largest("u_t = i*u_xx + e*v; v_t = -i*v_xx - 1.7*i*v + e*u", e=e)
    assert (value, k) == (pytest.approx(e, rel=1e-9, abs=0), pytest.approx(0.85**0.5, rel=e))


@pytest.mark.parametrize("e", [1e-2, 1e-5])
def test_a_resonance_on_a_curve_in_the_plane(e):
    """The same in two variables, on a ring, where growth is e |cos|: the ring is found, and the best place on it."""
    text = "u_t = i*(u_xx + u_yy) + e*v_x; v_t = -i*(v_xx + v_yy) - 1.7*i*v + e*u_x"
    # (lambda + 0.85 i)^2 = -(e xi_1)^2 - (xi^2 - 0.85)^2: no growth; with the other sign of the coupling there is
    assert largest(text, e=e)[0] == pytest.approx(0, abs=e**3)
    value, _ = largest(text.replace("e*u_x", "-e*u_x"), e=e)
    assert value == pytest.approx(e * 0.85**0.5, rel=10 * e)


@pytest.mark.parametrize(("r0", "c", "g"), [(1e-20, 200, 8.4e-10), (1, 1, 1), (1e12, 3e8, 1e-30)])
def test_jeans_in_any_units(r0, c, g):
    """lambda^2 = g r0 - c^2 xi^2 has its largest growth sqrt(g r0) as xi -> 0, whatever the units."""
    text = "r_t + r0*u_x = 0; u_t + c^2/r0*r_x = f_x; f_xx = -g*r"
    assert largest(text, r0=r0, c=c, g=g) == (pytest.approx(math.sqrt(g * r0), rel=1e-12, abs=0), 0)


@pytest.mark.parametrize(("D", "K"), [(1e-14, 1e-28), (1, 1), (1e20, 1e45), (3e-200, 1e-250)])
@pytest.mark.parametrize("plane", [False, True])
def test_growth_at_any_scale(D, K, plane):
    """D xi^2 - K xi^4 is largest, D^2/(4 K), at xi^2 = D/(2 K)."""
    text = "u_t = -D*(u_xx + u_yy) - K*(u_xxxx + 2*u_xxyy + u_yyyy)" if plane else "u_t = -D*u_xx - K*u_xxxx"
    value, k = largest(text, D=D, K=K)
    assert value == pytest.approx(D / (4 * K / D), rel=1e-12, abs=0)
    assert k == pytest.approx(math.sqrt(D / K / 2), rel=1e-5)
