"""Guards the search over directions: laws attained in one direction only, along a curve, and along a curve's curve.

Second route: the symbols are polynomials whose growth can be maximised by hand.
"""

import random
from fractions import Fraction
from itertools import combinations

import mpmath as mp
import numpy as np
import pytest

from primer import growth_rates, verdict
from primer.analysis.drift import REAL, _facets, _highest, _plainness, _real_roots, _Search, worst_law
from primer.analysis.puiseux import Law
from primer.analysis.roots import DIGITS

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


@pytest.mark.parametrize(("a", "b"), [(2, 3), (0.5, 1.5), (-7, -6.9)])
def test_growth_confined_between_two_curves(a, b):
    """lambda^2 = (xi_2^2 - a xi_1)(b xi_1 - xi_2^2): growth (b - a) |xi_1|/2 midway between two parabolas."""
    found = verdict(f"u_tt = (({a}) + ({b}))*i*u_xyy - u_yyyy + ({a})*({b})*u_xx")
    assert (found.kind, found.exponent, found.coefficient) == ("ill-posed", 1, pytest.approx((b - a) / 2, rel=1e-9))
    assert found.direction == (np.sign(a), 0)


# ---------------------------------------------------------------- the steps of the search, one by one


@pytest.fixture
def many_digits():
    with mp.workdps(DIGITS):
        yield


def polynomial(terms):
    return {(i, Fraction(j), l): mp.mpc(c) for (i, j, l), c in terms.items()}


FALLING = polynomial(
    {(1, 0, 0): 1, (0, 1, 0): -1, (0, 2, 2): 1}
)  # lambda = k - k^2 t^2 = k (1 - tau^2), t = tau k^-1/2
HALF = Fraction(1, 2)


def waves(s):
    """(lambda - i k)(lambda - i s t k)."""
    return polynomial({(2, 0, 0): 1, (1, 1, 0): -1j, (1, 1, 1): -1j * s, (0, 2, 1): -s})


def test_facets_by_solving_for_their_normals():
    """Brute force: through each three points j + q i - r l = d, exactly; r > 0, and no other point beyond."""
    rng = random.Random(3)
    for _ in range(150):
        size = rng.randint(1, 7)
        F = {
            (rng.randint(0, 3), Fraction(rng.randint(0, 6), rng.choice((1, 2, 3))), rng.randint(0, 4))
            for _ in range(size)
        }
        expected = set()
        for (i, j, l), (a, b, c), (d, e, f) in combinations(F, 3):
            # q (i - a) - r (l - c) = b - j, and likewise for the third point: by Cramer's rule
            det = -(i - a) * (l - f) + (i - d) * (l - c)
            if det:
                q = Fraction(-(b - j) * (l - f) + (e - j) * (l - c)) / det
                r = Fraction((i - a) * (e - j) - (i - d) * (b - j)) / det
                if r > 0 and all(y + q * x - r * z <= j + q * i - r * l for x, y, z in F):
                    expected.add(r)
        assert _facets(dict.fromkeys(F, 1)) == expected


def test_real_roots(many_digits):
    def found(*p):
        return sorted(map(float, _real_roots([mp.mpc(c) for c in p])))

    assert found() == found(5) == found(1, 0, 1) == found(1j, 1) == []
    assert found(0, 0, 3) == [0]
    assert found(0, -4, 0, 1) == [-2, 0, 2]
    assert found(-2, 1, -2, 1) == [2]  # (z - 2)(z^2 + 1)
    assert found(1, -2, 1) == [1]
    for size in (mp.mpf(10) ** -40, mp.mpf(1), mp.mpf(10) ** 40):
        allowed = REAL * (1 + size)
        for part, real in ((0.9, True), (1.1, False)):
            assert bool(_real_roots([-(size + 1j * part * allowed), mp.mpc(1)])) is real


def test_special_directions(many_digits):
    """Where a vertex vanishes, where a root touches the imaginary axis, and where imaginary roots meet."""
    search, slow = _Search(()), Law(Fraction(0), 0.0)

    def special(terms, r=Fraction(0), best=slow):
        return search.special(polynomial(terms), r, best)

    assert special(FALLING, HALF) == pytest.approx([-1, 1], abs=1e-30)
    assert special(FALLING, Fraction(0)) == [0]
    for s in (2, -3):
        assert special(waves(s)) == pytest.approx(sorted([0, 1 / mp.mpf(s)]), abs=1e-25)
        for best, slower in ((Law(Fraction(1), 1.0), True), (Law(HALF, 9.0), False), (Law(Fraction(1), -1.0), False)):
            assert len(special(waves(s), best=best)) == 2 - slower  # what is no faster need not be looked at
    # lambda^2 - t k lambda + k^2: damped or not
    assert special({(2, 0, 0): 1, (1, 1, 1): -1, (0, 2, 0): 1}) == [0]
    # lambda^2 = (t - 1) k^2 and lambda^2 = (t - 1)(t - 3)^2 k^2 + i k, of which the lower orders do not matter
    assert special({(2, 0, 0): 1, (0, 2, 1): -1, (0, 2, 0): 1}) == pytest.approx([1], abs=1e-25)
    cubic = {(0, 2, 3): -1, (0, 2, 2): 7, (0, 2, 1): -15, (0, 2, 0): 9, (0, 1, 0): -1j}
    assert special({(2, 0, 0): 1, **cubic}) == pytest.approx([1, 3], abs=1e-12)
    # (t^2 - 4) lambda = i k: the leading coefficient's; (t + 2i) lambda = (t - 5) i k: the last one's
    assert special({(1, 0, 2): 1, (1, 0, 0): -4, (0, 1, 0): -1j}) == pytest.approx([-2, 2], abs=1e-30)
    assert special({(1, 0, 1): 1, (1, 0, 0): 2j, (0, 1, 1): -1j, (0, 1, 0): 5j}) == pytest.approx([5], abs=1e-25)


def test_the_law_on_a_curve(many_digits):
    search = _Search(())
    found = search.law(FALLING, HALF, mp.mpf("0.5"))
    assert (found.exponent, found.coefficient) == (1, 0.75)
    assert search.law(FALLING, Fraction(0), mp.mpf(2)) == Law(Fraction(2), -4.0)
    assert search.law(polynomial({(1, 0, 1): 1, (0, 1, 1): 1}), HALF, 0) == Law(
        Fraction(0), -np.inf
    )  # anything solves it
    late = polynomial({(1, 0, 0): 1, (0, 1, 0): -1j, (0, -2, 0): -5})  # lambda = i k + 5 k^-2
    for best, law in ((None, Law(Fraction(-2), 5.0)), (Law(Fraction(2), 1.0), Law(Fraction(0), 0.0))):
        search.found = [(best, 0, 0)] if best else []
        assert search.law(late, Fraction(0), mp.mpf(0)) == law


def test_how_far_branches_are_carried():
    """To k^-3, or no further than the fastest growth found."""
    for laws, last in (
        ([], -3),
        ([Law(HALF, 1.0)], HALF),
        ([Law(Fraction(2), -1.0)], -3),
        ([Law(Fraction(0), 0.0)], -3),
        ([Law(Fraction(-4), 1.0)], -3),
        ([Law(Fraction(1), 1e-9), Law(HALF, 1.0), Law(Fraction(2), -1.0)], 1),
    ):
        search = _Search(())
        search.found = [(law, 0, 0) for law in laws]
        assert search.last() == last


def test_a_law_is_kept_with_its_distance_along_the_axis_turned_into_the_wavenumber():
    search = _Search(())
    search.add(Law(Fraction(2), 3.0), mp.mpf(2), HALF)
    search.add(Law(Fraction(2), 3.0), mp.inf, HALF)
    search.add(Law(Fraction(-1), -3.0), mp.mpf(-0.75), 0)
    (one, two, three) = search.found
    assert one[0].coefficient == pytest.approx(3 / 5, rel=1e-15)
    assert three[0].coefficient == pytest.approx(-3 * 1.25, rel=1e-15)
    assert (one[0].exponent, *one[1:]) == (2, 2, HALF)
    assert two == (Law(Fraction(2), 3.0), mp.inf, HALF)
    assert search.best() == two[0]


def test_the_imaginary_terms_with_which_branches_begin(many_digits):
    search = _Search(())

    def found(P):
        return {tuple((q, complex(c)) for q, c in terms) for terms in search._imaginary(P)}

    assert found({(1, 0): 1, (0, 2): -1j, (0, 1): -2j, (0, 0): -3}) == {((2, 1j), (1, 2j))}
    assert found({(1, 0): 1, (0, 2): -1j, (0, 1): 2j, (0, 0): -1j, (0, -1): 3}) == {((2, 1j), (1, -2j))}  # two at most
    assert found({(1, 0): 1, (0, 2): 3j, (0, 1): 1}) == {((2, -3j),)}
    assert found({(1, 0): 1, (0, 2): -1 - 1j}) == {()}
    assert found({(2, 0): 1, (1, 1): -1j, (1, 0): 1, (0, 1): -1j}) == {((1, 1j),), ()}  # (lambda - i k)(lambda + 1)


class Follower(_Search):
    """Notes what would be looked at near a special direction, or along a curve, and looks no further."""

    def __init__(self):
        super().__init__(())
        self.seen = []

    def near(self, F, r, depth, slope):
        self.seen.append((F, r, depth, slope))


def test_a_family_is_followed_up_where_it_is_special(many_digits):
    """t = tau k^-1/2 about the slope 3: lambda = k (1 - tau^2), special at tau = 1 and -1, and shifted there."""
    search = Follower()
    search.found = [(Law(Fraction(0), 0.0), 0, 0)]
    search.family(FALLING, HALF, 2, mp.mpf(3))
    assert len(search.found) == 3
    for (law, slope, r), allowed in zip(search.found[1:], (1e-3, 1e-14), strict=True):  # by the scan; midway
        assert (law.exponent, slope, r) == (1, 3, HALF)
        assert law.coefficient == pytest.approx(10**-0.5, rel=allowed)
    for (F, r, depth, towards), tau in zip(search.seen, (-1, 1), strict=True):
        assert (r, depth, towards) == (HALF, 1, 3)
        # lambda - k + k^2 (tau k^-1/2 + t)^2
        assert F.keys() == {(1, 0, 0), (0, Fraction(3, 2), 1), (0, 2, 2)}
        assert F[0, Fraction(3, 2), 1] == pytest.approx(2 * tau, abs=1e-30)
    search.found, search.seen = [(Law(Fraction(0), 0.0), 0, 0)], []
    search.family(FALLING, HALF, 0, mp.mpf(3))  # no deeper: the special values themselves
    assert search.seen == []
    assert [(law.coefficient, slope, r) for law, slope, r in search.found[3:]] == [(0, 3, HALF)] * 2


def test_the_family_of_directions_themselves(many_digits):
    """lambda = (2 t - t^2) k^2: |xi|^2 (2 t - t^2)/(1 + t^2), largest at the golden mean; special at 0 and 2."""
    search = Follower()
    F = polynomial({(1, 0, 0): 1, (0, 2, 1): -2, (0, 2, 2): 1})
    search.family(F, Fraction(0), 1, None)
    ((law, slope, r),) = search.found
    golden = (5**0.5 - 1) / 2
    assert (law.exponent, r) == (2, 0)
    assert law.coefficient == pytest.approx(golden, rel=1e-13)
    assert float(slope) == pytest.approx(golden, rel=1e-6)
    assert [(r, depth) for _, r, depth, _ in search.seen] == [(0, 0)] * 2
    assert [towards for *_, towards in search.seen] == pytest.approx([0, 2], abs=1e-25)
    search.found, search.seen, search.hints = [], [], (0.5, 0.5 + np.pi)
    search.family(F, Fraction(0), 0, None)
    assert len(search.found) == 5
    for hinted, slope, _ in search.found[1:3]:  # the hints, and about them 1e-4: uphill of both
        assert np.tan(0.5 + 0.9e-4) < slope < np.tan(0.5 + 3e-4)
        assert hinted.coefficient < golden
    assert search.seen == []


def test_near_a_direction_the_facets_say_which_curves_to_try(many_digits):
    class Noting(_Search):
        def family(self, F, r, depth, slope):
            curves.append((r, depth, slope))

    for F, r, expected in (
        (FALLING, 0, [HALF]),
        (FALLING, HALF, []),
        # the same in a flow: lambda = i k^3 + k - k^2 t^2, whose first term hides it
        (FALLING | polynomial({(0, 3, 0): -1j}), 0, [HALF]),
        (FALLING | polynomial({(0, 4, 0): -2j, (0, 3, 0): -1j}), 0, [HALF]),
    ):
        search, curves = Noting(()), []
        search.near(F, r, 1, mp.mpf(3))
        assert curves == [(r2, 1, 3) for r2 in expected]
        ((law, slope, at),) = search.found
        assert (law.exponent, law.coefficient, slope, at) == (1, pytest.approx(10**-0.5, rel=1e-14), 3, r)


def peak(f, exponent=2):
    """A law whose coefficient is f, and the list of the places where it was asked for."""
    asked = []
    return lambda x: asked.append(x) or Law(Fraction(exponent), float(f(x))), asked


def test_the_highest_place_is_sought_ever_more_finely():
    s = np.linspace(-1, 1, 9)
    for top in (-0.6, 0.3, 0.35, 1.05, -1.1):
        law, _ = peak(lambda x, top=top: 3 - abs(x - top))
        assert abs(_highest(law, s, None) - top) < 2e-8
        assert abs(_highest(law, s, Law(Fraction(2), 100.0)) - top) < 2e-8  # as fast: there is a chance
        assert abs(_highest(law, s, Law(Fraction(1), 100.0)) - top) < 2e-8
        nearest = s[np.argmin(abs(s - top))]
        assert _highest(law, s, Law(Fraction(3), 0.1)) == nearest  # there is none
    uneven, _ = peak(lambda x: 3 - abs(x - 5))  # the best of the four is zero
    assert abs(_highest(uneven, np.array([0.0, 1.0, 2.0, 9.0]), None) - 5) < 2e-8


def test_on_a_plateau_nothing_moves():
    flat, asked = peak(lambda x: 2)
    assert _highest(flat, np.array([3.0, 4.0, 5.0]), None) == 3
    assert len(asked) == 3
    step, _ = peak(lambda x: abs(x) < 0.6)
    assert _highest(step, np.array([-1.0, 0.0, 1.0]), None) == 0


def test_a_pole_is_not_followed_for_ever():
    """It is a special direction, found exactly: ten thousand times the first value is enough."""
    law, asked = peak(lambda x: 1 / abs(x - 0.301))
    _highest(law, np.linspace(-1, 1, 9), None)
    sizes = [law(x).coefficient for x in tuple(asked)]
    enough = 1e4 * max(sizes[:9])
    assert max(sizes[:-2]) < enough <= max(sizes[-2:])


def test_the_plainest_direction():
    assert _plainness((None, 1, 0, HALF)) == (HALF, 0, -1)
    assert [_plainness((None, -1, slope, 0)) for slope in (0, mp.inf, 1, -1, 2)] == [(0, n, 1) for n in range(5)]


@pytest.mark.parametrize("r", [1, 2])
def test_the_worst_law_of_a_window_along_a_slope(r, many_digits):
    """lambda = xi_1 + xi_2 - (xi_2 - xi_1)^(2r+2): in the direction (1, 1), and within |xi|^(1/(2r+2) - 1) of it."""
    order = 2 * r + 2
    D = {(1, 0, 0): mp.mpc(1), (0, 1, 0): mp.mpc(-1), (0, 0, 1): mp.mpc(-1)}
    D |= {(0, order - n, n): mp.binomial(order, n) * (-1) ** n * mp.mpc(1) for n in range(order + 1)}
    found = worst_law(D, real=False)
    assert (found.law.exponent, found.law.coefficient, found.drift) == (1, pytest.approx(2**0.5, rel=1e-12), 0)
    assert found.direction == pytest.approx((0.5**0.5, 0.5**0.5), abs=1e-15)
