"""Guards polynomials in multiprecision: roots and multiplicities, common factors, resultants; against sympy."""

import mpmath as mp
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from primer.analysis.roots import DIGITS, ZERO, common, divided, resultant, roots

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
        ((z - s) * (z + 1), (z - s) * (z - 2)),  # a common root for every s: the resultant vanishes
        (10**30 * (z**2 + 1), 10**30 * (z**2 + s * z + 1 + sp.I * s)),
        (sp.Integer(2) ** -200 * (z**2 + 1), sp.Integer(2) ** -200 * (z**2 + s * z + 2)),
        (sp.I * z**4 + s * z, 3 * z**3 - s**3),
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
