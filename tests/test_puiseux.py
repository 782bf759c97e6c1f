"""Guards the growth laws: the Newton polygon against closed forms and against multiprecision roots up to |xi| = 1e8."""

import random
from fractions import Fraction
from itertools import combinations

import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from primer import Pencil, growth_laws
from primer.analysis.puiseux import (
    Branch,
    Law,
    branches,
    collected,
    far_enough,
    hull_of,
    is_conservative,
    shifted_by,
)
from primer.analysis.roots import ZERO
from primer.analysis.symbol import Symbol
from primer.analysis.symbolic import symbol as symbol_of
from primer.equations.text import PDEError

WAVES = Pencil(lambda xi: np.array([[0, -2j * xi], [-2j * xi, 0]]), np.eye(2))
SINE = Pencil(lambda xi: [[np.sin(xi)]], [[1]])
DIGITS = 200  # of the second route: enough that a double root, or roots 70 decades apart, come out


def roots_at(P, k):
    """The roots of P(., k) by a library's solver; where that fails, at multiple ones, of its squarefree factors."""
    whole = {(i, j): (int(a.real), int(a.imag)) for (i, j), a in P.items()}
    degree = max(P)[0]
    p = [
        [sum(a[part] * k**j for (i, j), a in whole.items() if i == n) for part in (0, 1)] for n in range(degree, -1, -1)
    ]
    try:
        return mp.polyroots([mp.mpc(*c) for c in p], maxsteps=150, extraprec=mp.mp.prec)
    except mp.mp.NoConvergence:
        poly = sp.Poly([c[0] + sp.I * c[1] for c in p], sp.Symbol("lam"), extension=sp.I)
        factors = [([mp.mpmathify(c.evalf(DIGITS)) for c in f.all_coeffs()], m) for f, m in poly.sqf_list()[1]]
        return [z for f, m in factors for z in m * mp.polyroots(f, maxsteps=2000, extraprec=4 * mp.mp.prec)]


def value(branch, k):
    """The partial sum of a branch that is known."""
    return mp.fsum(c * mp.power(k, mp.mpf(q.numerator) / q.denominator) for q, c in branch.terms)


numbers = st.sampled_from([-3, -2, -1, 1, 2, 3])
complex_numbers = st.one_of(numbers, numbers, numbers.map(lambda n: n * 1j))


@st.composite
def symbols(draw):
    """Random pencils in one space variable: 1 to 3 fields, derivatives up to the third, some with constraints."""
    size = draw(st.integers(1, 3))
    entries = []
    for r in range(size):
        row = []
        for c in range(size):
            orders = draw(st.sets(st.integers(0, 3), max_size=2))
            entry = {(0, a, 0): mp.mpc(draw(complex_numbers)) for a in sorted(orders)}
            if (r == c and draw(st.integers(0, 5))) or (r != c and not draw(st.integers(0, 9))):
                entry[1, draw(st.sampled_from([0, 0, 0, 0, 2])), 0] = mp.mpc(draw(numbers))
            row.append(entry)
        entries.append(tuple(row))
    return Symbol(tuple(entries))


@settings(max_examples=25, deadline=None)
@given(symbols())
def test_laws_agree_with_multiprecision_eigenvalues(symbol):
    check_laws(symbol)


@pytest.mark.slow
@settings(max_examples=300, deadline=None)
@given(symbols())
def test_laws_agree_with_multiprecision_eigenvalues_at_length(symbol):
    check_laws(symbol)


def check_laws(symbol):
    """At |xi| = 1e2 ... 1e16 every branch is met by an eigenvalue, ever more closely, and so is the largest growth."""
    P = {(n, a): c for (n, a, _), c in symbol.determinant.items()}
    assume(P and max(P)[0] > 0)
    found = branches(P)
    assert sum(branch.multiplicity for branch in found) == max(P)[0]
    with mp.workdps(DIGITS):
        gaps, rates = [], []
        for k in (10**2, 10**5, 10**8, 10**16):
            left, gap = roots_at(P, k), mp.mpf(0)
            law, rate = found[0].law, max(z.real for z in left)
            for branch in sorted(found, key=lambda branch: -branch.exponent):
                for _ in range(branch.multiplicity):
                    nearest = min(left, key=lambda z, branch=branch, k=k: abs(z - value(branch, k)))
                    left.remove(nearest)
                    if branch.terms:
                        gap = max(gap, abs(nearest - value(branch, k)) / abs(value(branch, k)))
                    else:
                        assert abs(nearest) < mp.mpf(10) ** -100
            gaps.append(gap)
            size = mp.power(k, mp.mpf(law.exponent.numerator) / law.exponent.denominator)
            rates.append(abs(rate / size - law.coefficient) if law.coefficient else max(rate, 0))
        # The next term is smaller by k^(-1/6) at the least for these sizes and orders (usually by a whole power).
        assert gaps[2] < 0.3
        assert gaps[3] < max(1e-2 * gaps[1], mp.mpf(10) ** -60)
        assert rates[3] < max(0.05 * abs(found[0].law.coefficient), mp.mpf(10) ** -12)


HALF, THIRD = (1 + 1j) / 2**0.5, (1 + 3**0.5 * 1j) / 2


@pytest.mark.parametrize(
    ("text", "q", "coefficients"),  # all branches are c |xi|^q to leading order
    [
        ("u_t = u_xx", 2, [-1]),
        ("u_t = u_xxx - u_xx", 3, [-1j]),
        ("u_tt = u_xx", 1, [1j, -1j]),
        ("u_t = v; v_t = u_x", Fraction(1, 2), [HALF, -HALF]),
        ("u_t = v; v_t = w; w_t = u_xx", Fraction(2, 3), [THIRD, THIRD.conjugate(), -1]),
        ("u_t = 0*u_x", 0, [0]),
    ],
)
def test_leading_terms(text, q, coefficients):
    found = growth_laws(text)
    assert [branch.exponent for branch in found] == [q] * len(coefficients)
    for c in coefficients:
        assert min(abs(branch.coefficient - c) for branch in found) < 1e-15


@pytest.mark.parametrize("u", [1.5, -0.5, 2.0])
def test_toy_branches(u):
    """Eq. (toy-eig): lambda_1 ~ -eps u xi^2 and lambda_2 -> -1/(eps u)."""
    laws = growth_laws("u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)", at={"u": u, "v_xx": 0.3}, eps=0.01)
    laws = {branch.exponent: branch.coefficient for branch in laws}
    assert laws == {2: pytest.approx(-0.01 * u), 0: pytest.approx(-1 / (0.01 * u))}


def test_the_real_part_may_come_at_a_lower_order():
    (branch,) = growth_laws("u_t = u_xxx - u_xx")
    assert (branch.law.exponent, branch.law.coefficient) == (2, 1)
    assert [(q, complex(c)) for q, c in branch.terms] == [(3, -1j), (2, 1)]
    hidden = {(2, 0): 1, (1, 2): -2j, (0, 4): -1, (0, 1): -1}  # (lambda - i k^2)^2 = k
    assert [(b.law.exponent, b.law.coefficient) for b in branches(hidden)] == [
        (Fraction(1, 2), 1),
        (Fraction(1, 2), -1),
    ]


def test_conservative_systems_are_known_as_such():
    """The roots of lambda^2 + k^2 + k^4 - 1 are imaginary for every large k, though their expansion never ends."""
    P = {(2, 0): 1, (0, 2): 1, (0, 4): 1, (0, 0): -1}
    assert is_conservative(P)
    assert all(b.law.coefficient == 0 and b.multiplicity == 1 for b in branches(P))
    assert not is_conservative({**P, (1, 0): 1})
    assert [b.law.coefficient for b in branches({**P, (1, 0): 1})] == [-0.5, -0.5]


def test_no_polynomial_has_no_branches():
    assert branches({}) == []


def test_multiple_branches():
    (twice,) = branches({(2, 0): 1, (1, 2): 2, (0, 4): 1})  # (lambda + k^2)^2
    assert (twice.multiplicity, twice.exponent, twice.coefficient) == (2, 2, -1)
    waves = branches({(4, 0): 1, (2, 2): 2, (0, 4): 1})  # (lambda^2 + k^2)^2
    assert [(b.multiplicity, b.is_exact, b.law.coefficient) for b in waves] == [(2, True, 0), (2, True, 0)]
    split = branches({(2, 0): 1, (1, 2): 2, (0, 4): 1, (0, 3): -1})  # (lambda + k^2)^2 = k^3
    assert [(b.multiplicity, b.law.exponent) for b in split] == [(2, 2)]


@pytest.mark.parametrize("direction", [(0, 0), (1, 2, 3), "x", 1.0, (float("nan"), 1)])
def test_bad_directions(direction):
    with pytest.raises((ValueError, TypeError), match="direction"):
        growth_laws("u_t = u_xx + u_yy", direction)


TEXT_ONLY = " go with equations as text only"


@pytest.mark.parametrize(
    ("pde", "arguments", "error", "sentence"),
    [
        ("u_t = u_xx", {"direction": 0}, ValueError, "direction must be 1 number(s), not all zero, got 0"),
        ("u_t = u_xx", {"direction": (1, 2)}, ValueError, "direction must be 1 number(s), not all zero, got (1, 2)"),
        ("u_t = u_yy", {"direction": 1}, ValueError, "direction must be 2 number(s), not all zero, got 1"),
        (
            3, {}, TypeError,
            "the equations must be a string such as 'u_t = u_xx', a list of them or of sympy's Eq, got int",
        ),
        (WAVES, {"at": {"u": 1}}, TypeError, "base-state values, order and parameters" + TEXT_ONLY),
        (WAVES, {"order": "maximal"}, TypeError, "base-state values, order and parameters" + TEXT_ONLY),
        (WAVES, {"a": 1}, TypeError, "base-state values, order and parameters" + TEXT_ONLY),
        (SINE, {}, ValueError, "the entries of the pencil are not polynomials in xi of degree 8 or less"),
        (
            "u_t + v_t = u_x; u_t + v_t = u_x", {}, PDEError,
            "the linearised equations do not determine the unknowns: det(lambda E + S) vanishes identically",
        ),
        ("u_t = v_x; u_x = 0", {}, PDEError,
         "the constraints leave nothing that evolves: no perturbation has a growth rate"),
    ],
)  # fmt: skip
def test_what_has_no_laws_is_said(pde, arguments, error, sentence):
    with pytest.raises(error) as caught:
        growth_laws(pde, **arguments)
    assert str(caught.value) == sentence


def test_the_same_laws_from_a_text_a_symbol_and_a_pencil():
    for pde in ("u_tt = 4*u_xx", symbol_of("u_tt = 4*u_xx"), WAVES):
        assert sorted(b.coefficient.imag for b in growth_laws(pde)) == [-2, 2]
        assert {b.exponent for b in growth_laws(pde)} == {1}


def test_only_the_direction_of_a_direction_counts():
    """lambda = a - 2 b + 3 a b - 5 a b^2 for xi = (a, b): odd powers change sign with it, and 0.1 is a tenth."""
    text = "u_t = -i*u_x + 2i*u_y - 3*u_xy - 5i*u_xyy"
    for a, b in ((0.6, 0.8), (-0.6, 0.8), (0.6, -0.8), (-0.6, -0.8)):
        for length in (1, 10, 0.125):
            (law,) = growth_laws(text, (a * length, b * length))
            assert law.coefficient == pytest.approx(-5 * a * b**2, rel=1e-14)
    assert growth_laws(text)[0].coefficient == 1  # along (1, 0)
    assert growth_laws(text, (0, -2))[0].coefficient == 2
    assert growth_laws("u_t = i*u_x", -3)[0].coefficient == 1
    (tenths,) = growth_laws("u_t = -3i*u_x + i*u_y - u_xxxx*0", (0.1, 0.3))  # 3 a - b, exactly zero there
    assert (tenths.law.coefficient, tenths.is_exact) == (0, True)


def test_laws_along_a_direction():
    (law,) = growth_laws("u_t = u_xx + 3*u_xy + u_yy", (1, -1))
    assert (law.exponent, law.coefficient) == (2, pytest.approx(0.5))
    (law,) = growth_laws("u_t = u_xx + 3*u_xy + u_yy", (3, 4))
    assert law.coefficient == pytest.approx(-(9 + 36 + 16) / 25)


# ---------------------------------------------------------------- laws


HALVES = [Fraction(n, 2) for n in range(-4, 5)]


def test_laws_are_ordered_by_size_for_large_k():
    laws = [Law(q, c) for q in HALVES for c in (-2.0, -1.0, 0.0, 1.0, 3.0)]
    for one in laws:
        for other in laws:
            sizes = [law.coefficient * 1e60 ** float(law.exponent) for law in (one, other)]
            assert (one < other) == (sizes[0] < sizes[1])
            assert (one > other) == (sizes[0] > sizes[1])
    assert Law(Fraction(2), 0.0).key == (0, 0, 0)
    assert Law(Fraction(2), -3.0).key == (-1, -2, -3)
    assert Law(Fraction(1, 2), 3.0).key == (1, Fraction(1, 2), 3)


def test_a_law_is_bounded_unless_its_coefficient_and_exponent_are_positive():
    for q in HALVES:
        for c in (-0.5, 0.0, 0.5):
            assert Law(q, c).is_bounded is (not (q > 0 and c > 0))


@pytest.mark.parametrize(
    ("exponent", "coefficient", "text"),
    [
        (0, 0.0, "Re lambda -> 0"),
        (2, 0.0, "Re lambda -> 0"),
        (0, -1 / 3, "Re lambda -> -0.333333"),
        (1, 2.5, "Re lambda ~ 2.5 |xi|"),
        (2, 1.0, "Re lambda ~ 1 |xi|^2"),
        (-1, 1.0, "Re lambda ~ 1 |xi|^(-1)"),
        (Fraction(2, 3), -1.0, "Re lambda ~ -1 |xi|^(2/3)"),
        (Fraction(-1, 2), 1.0, "Re lambda ~ 1 |xi|^(-1/2)"),
    ],
)
def test_a_law_in_words(exponent, coefficient, text):
    assert str(Law(Fraction(exponent), coefficient)) == text


def test_laws_are_near_when_only_rounding_tells_them_apart():
    law = Law(Fraction(2), -3.0)
    assert law.is_near(Law(Fraction(2), -3.0 * (1 + 0.9e-12)))
    assert not law.is_near(Law(Fraction(2), -3.0 * (1 + 1.1e-12)))
    assert not Law(Fraction(2), 3.0).is_near(Law(Fraction(2), 2.9))
    assert not law.is_near(Law(Fraction(1), -3.0))
    assert not law.is_near(Law(Fraction(2), 3.0))
    assert Law(Fraction(2), 1e-9).is_near(Law(Fraction(2), 1e-9 * (1 + 0.9e-12)))
    assert not Law(Fraction(2), 1e-9).is_near(Law(Fraction(2), 1e-9 * (1 + 1.1e-12)))
    assert Law(Fraction(2), 0.0).is_near(Law(Fraction(1), 0.0))  # no growth is no growth
    assert Law(Fraction(0), -np.inf).is_near(Law(Fraction(0), -np.inf))
    assert not Law(Fraction(0), -np.inf).is_near(law)


def test_a_branch_without_terms_is_zero():
    zero = Branch((), 2, True, Law(Fraction(0), 0.0))
    assert (zero.exponent, zero.coefficient) == (0, 0)
    assert isinstance(zero.exponent, Fraction)
    longer = Branch(((Fraction(2), mp.mpc(1, 2)), (Fraction(1), mp.mpc(3))), 1, False, Law(Fraction(2), 1.0))
    assert (longer.exponent, longer.coefficient) == (2, 1 + 2j)


# ---------------------------------------------------------------- the Newton polygon


def test_the_hull_has_the_points_that_no_chord_reaches():
    """Brute force: in each column the highest point, unless a chord between two others is as high there."""
    rng = random.Random(0)
    for _ in range(300):
        points = {
            (rng.randint(0, 6), Fraction(rng.randint(-6, 6), rng.choice((1, 2)))) for _ in range(rng.randint(1, 9))
        }
        columns = {i: max(j for n, j in points if n == i) for i, _ in points}
        chords = [((i, columns[i]), (n, columns[n])) for i, n in combinations(sorted(columns), 2)]
        expected = [
            (i, j)
            for i, j in sorted(columns.items())
            if not any(a < i < b and y + (z - y) * (i - a) / (b - a) >= j for (a, y), (b, z) in chords)
        ]
        assert hull_of(dict.fromkeys(points, 1)) == expected


def evaluate(P, point):
    """The sum of a times the powers of the numbers of a point."""
    return mp.fsum(
        a * mp.fprod(mp.mpf(1) * z**p for z, p in zip(point, powers, strict=True)) for powers, a in P.items()
    )


@pytest.mark.parametrize("place", [0, 2])
def test_a_shifted_polynomial_has_the_values_of_the_first_one_beside(place):
    rng = np.random.default_rng(1)
    with mp.workdps(40):
        for _ in range(30):
            P = {tuple(map(int, rng.integers(0, 4, 3))): mp.mpc(*rng.normal(size=2)) for _ in range(5)}
            c, q = mp.mpc(*rng.normal(size=2)), int(rng.integers(-2, 3))
            point = [mp.mpf(x) for x in rng.uniform(0.5, 2, 3)]
            moved = list(point)
            moved[place] += c * point[1] ** q
            found = evaluate(shifted_by(P, c, q, place), point)
            assert abs(found - evaluate(P, moved)) <= mp.mpf(10) ** -33 * (1 + abs(found))
            assert shifted_by(P, mp.mpc(0), q, place) == P


def test_sums_that_cancel_are_left_out_and_small_ones_are_not():
    tiny = mp.mpf(10) ** -80
    found = collected([((1,), 2), ((2,), mp.mpc(0, 1)), ((1,), 3), ((3,), tiny), ((4,), 0), ((5,), 1), ((5,), -1)])
    assert found == {(1,): 5, (2,): 1j, (3,): tiny}
    with mp.workdps(100):
        for part, kept in ((0.9, False), (1.1, True)):  # against the size of what is summed
            assert bool(collected([((0,), -tiny), ((0,), tiny * (1 + 2 * part * ZERO))])) is kept


@pytest.mark.parametrize(
    ("P", "power"),
    [
        ({(2, 3): 1, (0, 5): 1}, -(2 * 2 * 3 + 3 * 1)),
        ({(2, 2): 1, (0, 0): 1}, -(2 * 2 * 2)),  # roots that vanish: products of others may be of order one
        ({(2, 3): 1}, -(2 * 2 * 3)),
        ({(3, 1): 1, (2, 3): 1, (0, 4): 1}, -(2 * 3 * 1 + 8 * 2)),
        ({(2, 0): 1, (0, 1): 1}, -(3 * Fraction(1, 2))),
        ({(1, 0): 1, (0, 9): 1}, 0),  # one root, whose real part is a polynomial
    ],
)
def test_how_far_an_expansion_goes_to_be_sure(P, power):
    """n^2 - 1 differences of roots, each of the order of the largest at most, and the leading coefficient 2 n times."""
    assert far_enough({(i, Fraction(j)): a for (i, j), a in P.items()}) == power


def test_symmetry_about_the_imaginary_axis():
    """Products of lambda - z and lambda + conj z have it, whatever factor and power of k they carry; no others do."""
    rng = np.random.default_rng(2)
    with mp.workdps(60):
        for n in range(40):
            found = [mp.mpc(*map(int, rng.integers(1, 9, 2))) for _ in range(3)]
            found += [-mp.conj(z) for z in found]
            found += [mp.mpc(0, int(rng.integers(-3, 4)))] * (n % 2)
            p, factor = [mp.mpc(1)], mp.mpc(*map(int, rng.integers(1, 9, 2))) * mp.mpf(10) ** int(rng.integers(-60, 60))
            for z in found:
                p = [b - z * a for a, b in zip([*p, mp.mpc(0)], [mp.mpc(0), *p], strict=True)]
            P = {(i, n % 5): factor * a for i, a in enumerate(p) if a != 0}
            assert is_conservative(P)
            for powers, a in P.items():
                spoiled = P | {powers: a * (1 + mp.mpc(1, 1) * mp.mpf(10) ** -40)}
                assert not is_conservative(spoiled) or len(P) == 1


def test_an_expansion_goes_on_until_the_real_part_or_the_order_asked_for():
    """lambda = i k^2 + i k^-1 + 2 k^-3, written as k^3 lambda = ..."""
    P = {(1, 3): 1, (0, 5): -1j, (0, 2): -1j, (0, 0): -2}
    assert not is_conservative(P)
    terms = [(2, 1j), (-1, 1j), (-3, 2)]
    for last, number in ((None, 3), (-3, 3), (-2, 3), (-1, 3), (0, 2), (2, 2), (3, 1)):
        (branch,) = branches(P, last)
        assert [(q, complex(c)) for q, c in branch.terms] == terms[:number]
        assert branch.law == (Law(Fraction(-3), 2.0) if number == 3 else Law(Fraction(0), 0.0))
        assert (branch.multiplicity, branch.is_exact) == (1, False)
    (alone,) = branches({(1, 3): 1, (0, 5): -1j, (0, 2): -1j})
    assert (len(alone.terms), alone.is_exact, alone.law) == (1, False, Law(Fraction(0), 0.0))  # symmetric: no need
    whole, other = branches({(2, 0): 1, (1, 2): -2j, (1, 0): 1, (0, 2): -2j})  # (lambda - 2i k^2)(lambda + 1)
    assert (whole.terms, whole.is_exact, whole.law) == (((2, 2j),), True, Law(Fraction(0), 0.0))
    assert (other.terms, other.is_exact, other.law) == (((0, -1),), False, Law(Fraction(0), -1.0))
    assert (whole.multiplicity, other.multiplicity) == (1, 1)


@pytest.mark.parametrize("size", [1e-60, 1e60])
def test_the_size_of_a_coefficient_does_not_hide_its_real_part(size):
    ((branch,), (turning,)) = (branches({(1, 0): 1, (0, 2): -c * size}) for c in (3, 3 + 4j))
    assert (branch.law.exponent, branch.law.coefficient) == (2, pytest.approx(3 * size, rel=1e-15))
    assert (turning.law, turning.coefficient) == (branch.law, pytest.approx((3 + 4j) * size, rel=1e-15))
