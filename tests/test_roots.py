"""Guards polynomials in multiprecision: roots and multiplicities, common factors, resultants; against sympy."""

import random
from fractions import Fraction
from math import prod

import mpmath as mp
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from primer.analysis.roots import (
    DIGITS,
    ZERO,
    _sylvester,
    common,
    derivative,
    divided,
    interpolated,
    resultant,
    roots,
    trimmed,
)

z, s = sp.symbols("z s")
gaussian = st.tuples(st.integers(-3, 3), st.integers(-3, 3)).map(lambda p: p[0] + sp.I * p[1])


def coefficients(polynomial):
    """Lowest power first, in multiprecision."""
    return [mp.mpmathify(c) for c in sp.Poly(polynomial, z).all_coeffs()[::-1]]


@settings(max_examples=40, deadline=None)
@given(st.lists(gaussian, min_size=1, max_size=7), st.sampled_from([1, -3, sp.I]), st.sampled_from([-30, 0, 30]))
def test_roots_and_their_multiplicities(places, factor, power):
    scale = sp.Integer(2) ** power  # which double precision holds exactly
    with mp.workdps(DIGITS):
        p = coefficients(sp.expand(factor * sp.prod(z - scale * place for place in places)))
        found = roots(p)
        expected = {place: places.count(place) for place in places}
        assert sum(multiplicity for _, multiplicity in found) == len(places)
        for value, multiplicity in found:
            nearest = min(expected, key=lambda place: abs(complex(place) - complex(value / mp.mpf(2) ** power)))
            assert abs(value - mp.mpmathify(scale * nearest)) <= mp.mpf(10) ** -25 * (abs(value) + mp.mpf(2) ** power)
            assert multiplicity == expected.pop(nearest)
        assert not expected


@pytest.mark.slow
@settings(max_examples=20, deadline=None)
@given(*[st.lists(gaussian, max_size=3)] * 3)
def test_common_factors(shared, one, two):
    with mp.workdps(DIGITS):
        p, q = (coefficients(sp.expand(7 * sp.prod(z - place for place in [*shared, *own]))) for own in (one, two))
        expected = sp.gcd(*(sp.prod(z - place for place in [*shared, *own]) for own in (one, two)), extension=sp.I)
        expected = coefficients(sp.Poly(expected, z).monic())
        found = common(p, q, ZERO)
        assert len(found) == len(expected)
        assert max(abs(a - b) for a, b in zip(found, expected, strict=True)) < mp.mpf(10) ** -25
        quotient, rest = divided(p, found)
        assert len(quotient) == len(p) - len(found) + 1
        assert max((abs(a) for a in rest), default=0) < mp.mpf(10) ** -25 * max(map(abs, p))


@pytest.mark.parametrize(
    ("p", "q"),
    [
        (z**2 + s * z + 1, z - s),
        (z**3 + (s**2 - 1) * z + s, z**2 - s * z + 2),
        (s * z**2 + 1, (s - 1) * z**2 + z * s**2),
        (z**2 + 1, z**2 + s * z + 1 + sp.I * s),
        (s * z + 1, z + s),  # both of odd degree: the sign too
        (z**3 + s, 2 * z - s + 1),
        ((z - s) * (z + 1), (z - s) * (z - 2)),  # a common root for every s: the resultant vanishes
        (10**30 * (z**2 + 1), 10**30 * (z**2 + s * z + 1 + sp.I * s)),
        (sp.Integer(2) ** -200 * (z**2 + 1), sp.Integer(2) ** -200 * (z**2 + s * z + 2)),
        (sp.I * z**4 + s * z, 3 * z**3 - s**3),
        (s**3 * z**2 + s * z + 1, z**3 - 2),  # the parameter in one of them only
        (z**3 - 2, s**3 * z**2 + s * z + 1),
        *((2**m * (z + s), 2**n * (z - 2 * s)) for m, n in ((300, 0), (0, 300))),  # of very different sizes
        *((sp.Integer(2) ** -m * (z**2 + s), sp.Integer(2) ** -n * (z - 2 * s)) for m, n in ((300, 0), (0, 300))),
        ((s - 1) * (z + 1), (z + 1) * (z + 2)),  # a common root, and a polynomial that vanishes for s = 1
    ],
)
def test_resultants_against_sympy(p, q):
    def table(f):
        return [[mp.mpmathify(c) for c in sp.Poly(a, s).all_coeffs()[::-1]] for a in sp.Poly(f, z).all_coeffs()[::-1]]

    exact = sp.Poly(sp.resultant(p, q, z), s)
    with mp.workdps(DIGITS):
        found = resultant(table(p), table(q))
        expected = [] if exact.is_zero else [mp.mpmathify(c) for c in exact.all_coeffs()[::-1]]
        assert len(found) == len(expected)
        for a, b in zip(found, expected, strict=True):
            assert abs(a - b) <= mp.mpf(10) ** -25 * max(abs(b) for b in expected)


def from_roots(places, factor=1):
    """The coefficients of factor times the product of all z - place, lowest power first."""
    p = [factor]
    for place in places:
        p = [a - place * b for a, b in zip([0, *p], [*p, 0], strict=True)]
    return p


def product(p, q):
    return [
        sum(p[m] * q[n - m] for m in range(max(0, n - len(q) + 1), min(n + 1, len(p)))) for n in range(len(p + q) - 1)
    ]


def test_leading_coefficients_up_to_a_size_are_trimmed():
    assert trimmed((1, 2, 0, 0), 0) == [1, 2]
    assert trimmed([5, 3, -2, 2], 2) == [5, 3]
    assert trimmed([0, -1], 1) == trimmed([], 0) == []


def test_derivatives_of_powers():
    assert derivative([7, 5, 3, 1]) == [5, 6, 3]
    assert derivative([7]) == []


def test_division_with_remainder_is_exact_in_fractions():
    """p = q d + r with r of lower degree than d, which no other q and r fulfil."""
    draw = random.Random(21)
    for _ in range(60):
        quotient, d = ([Fraction(draw.randint(-9, 9)) for _ in range(draw.randint(0, 5))] + [Fraction(3)] for _ in "qd")
        rest = [Fraction(draw.randint(-9, 9)) for _ in d[1:]]
        p = product(quotient, d)
        p = [a + b for a, b in zip(p, rest + [0] * (len(p) - len(rest)), strict=True)]
        assert divided(p, d) == (quotient, rest)
    assert divided([1, 2], [4, 5, 6]) == ([], [1, 2])


def test_the_common_factor_of_known_products_in_fractions():
    draw = random.Random(22)
    for _ in range(60):
        places = draw.sample(range(-9, 10), 9)
        shared, one, two = places[: draw.randint(0, 3)], places[3 : draw.randint(3, 6)], places[6 : draw.randint(6, 9)]
        p, q = from_roots(shared + one, Fraction(5, 7)), from_roots(shared + two, Fraction(-11, 3))
        assert common(p, q, 0) == from_roots(shared)


@pytest.mark.parametrize("scale", [1, Fraction(1, 10**30), 10**30])
@pytest.mark.parametrize("a", [Fraction(1, 4), 1, 4])
def test_a_remainder_is_zero_relative_to_the_largest_number_of_the_division(scale, a):
    """z^2 - a^2 + d leaves d when divided by z - a, after intermediate numbers up to max(1, a^2) max(1, a)."""
    largest = max(1, a**2) * max(1, a)
    for d, factor in ((Fraction(9, 10), [-a, 1]), (Fraction(11, 10), [1])):
        p = [-scale * (a**2 - d * largest / 10**6), Fraction(0), Fraction(scale)]
        assert common(p, [-7 * a, Fraction(7)], Fraction(1, 10**6)) == factor
        assert common(p, [-a / 7, Fraction(1, 7)], Fraction(1, 10**6)) == factor


def test_few_roots_and_roots_at_zero():
    with mp.workdps(DIGITS):
        five, six = mp.mpf(5), mp.mpc(0, 6)
        assert roots([five]) == []
        assert roots([0 * five, 0 * five, five]) == [(0, 2)]
        assert roots([five, six]) == [(-five / six, 1)]
        assert roots([0 * five, five, six]) == [(0, 1), (-five / six, 1)]


@pytest.mark.parametrize("power", [-300, 0, 300])
@pytest.mark.parametrize("places", [[1, 2, 3], [1, -1, 2, 2, 5, 5], [3, 3, 3], [1, 2], [0, 0, 1, 1, 4, 7]])
def test_roots_far_from_one_in_size(places, power):
    with mp.workdps(DIGITS):
        scale, factor = mp.mpf(10) ** power, mp.mpf(10) ** (3 * power) / 3
        found = sorted(roots(from_roots([place * scale for place in places], factor)), key=lambda pair: pair[0].real)
        assert [multiplicity for _, multiplicity in found] == [places.count(place) for place in sorted(set(places))]
        for (value, _), place in zip(found, sorted(set(places)), strict=True):
            assert abs(value - place * scale) <= mp.mpf(10) ** -60 * scale


def test_the_sylvester_determinant_is_the_product_of_all_differences_of_roots():
    draw = random.Random(23)
    with mp.workdps(40):
        for _ in range(30):
            x, y = ([mp.mpc(draw.gauss(0, 1), draw.gauss(0, 1)) for _ in range(draw.randint(1, 4))] for _ in "pq")
            p, q = from_roots(x, 2)[::-1], from_roots(y, -3)[::-1]
            expected = mp.mpf(2) ** len(y) * mp.mpf(-3) ** len(x) * prod(a - b for a in x for b in y)
            assert abs(_sylvester(p, q) - expected) < mp.mpf(10) ** -25 * abs(expected)
            assert abs(_sylvester(p, from_roots([*y[1:], x[0]])[::-1])) < mp.mpf(10) ** -25
        assert _sylvester([mp.mpf(0), mp.mpf(1)], [mp.mpf(0), mp.mpf(1)]) == 0
        assert _sylvester([mp.mpf(5)], [mp.mpf(2), mp.mpf(1), mp.mpf(1)]) == 25


def test_interpolation_finds_the_polynomial():
    draw = random.Random(24)
    with mp.workdps(60):
        for length in range(1, 9):
            p = [mp.mpc(draw.gauss(0, 1), draw.gauss(0, 1)) for _ in range(length)]
            nodes = range(-2, length - 2)
            found = interpolated(nodes, [mp.polyval(p[::-1], s) for s in nodes])
            assert len(found) == length
            assert max(abs(a - b) for a, b in zip(found, p, strict=True)) < mp.mpf(10) ** -50


@pytest.mark.parametrize("scale", [-100, 0, 100])
def test_coefficients_of_a_resultant_below_the_rounding_of_the_data_are_zero(scale):
    """The resultant of z and z + c(s) is c(s); of a polynomial with its multiple, nothing."""
    with mp.workdps(DIGITS):
        size, kept, lost = mp.mpf(10) ** scale, mp.mpf(10) ** -48, mp.mpf(10) ** -52
        c = [size, kept * size, lost * size, 2 * size, lost * size]
        found = resultant([[mp.mpf(0)], [size]], [c, [size]])
        assert (len(found), found[2]) == (4, 0)
        assert abs(found[1] / size - c[1]) < mp.mpf(10) ** -60 * c[1]
        third = size / 3
        p = [[third, 3 * third], [size, third, size]]
        for eps, length in ((lost, 0), (kept, 3)):  # eps third (size + third s + size s^2), up to a factor
            q = [[mp.sqrt(2) * third * (1 + eps), mp.sqrt(18) * third], [mp.sqrt(2) * a for a in p[1]]]
            assert len(resultant(p, q)) == length
