"""Case by case in symbols: for which values of its open names a polynomial P(lambda, k) has branches that grow.

A polynomial is a dict {(i, j): a} standing for the sum of a lambda^i k^j, k -> infinity; the a are sympy's,
of real names.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import comb
from typing import NamedTuple

import sympy as sp

from primer.analysis.puiseux import hull_of

DEPTH = 6  # of cases within cases, and of orders below the leading one
TERMS = 400  # operations in a coefficient: with more sympy can take minutes
C = sp.Symbol("c")


class Found(NamedTuple):
    """Where ``condition`` holds there is a branch Re lambda ~ growth |xi|^exponent; growth None: nothing is known."""

    condition: sp.Basic
    growth: sp.Expr | None
    exponent: Fraction


def cases(P, given=sp.true, above=None, depth=DEPTH):
    """A list of ``Found``: wherever none holds, no branch lambda = o(k^above) of P grows without bound.

    ``given`` is what is known, a condition on the names. Coefficients that vanish make cases of their own: the
    vanishing factor is solved for one name, in which it is linear, and the case is what is left with it replaced.
    """
    P = {place: tidy for place, a in P.items() if (tidy := _tidied(a)) != 0}
    if not P or given == sp.false:
        return []
    if depth == 0 or any(a.count_ops() > TERMS for a in P.values()):
        return [Found(given, None, Fraction(0))]
    hull, found = hull_of(P), []
    used = [(e, e2) for e, e2 in pairwise(hull) if _slope(e, e2) > 0 and (above is None or _slope(e, e2) < above)]
    if not used:
        return _special(P, [hull[-1]], given, above, depth)[0] if hull[-1][0] else []
    ends = list(dict.fromkeys(end for edge in used for end in edge))
    found, beside = _special(P, ends, given, above, depth)
    for (i, j), (i2, j2) in used:
        q = _slope((i, j), (i2, j2))
        edge = sum(P.get((i + m, j - q * m), 0) * C**m for m in range(i2 - i + 1))
        for factor, many in _irreducible(edge):
            found += _of_factor(P, factor, many, q, beside, depth)
    return found


def _slope(a, b):
    return Fraction(a[1] - b[1]) / (b[0] - a[0])


def _irreducible(edge):
    """[(factor, multiplicity), ...] of an edge's polynomial in C; with roots in its coefficients it is left whole."""
    top = sp.fraction(sp.together(sp.expand(edge)))[0]
    whole = sp.Poly(top, C)
    if whole.degree() == 1 or any(not p.exp.is_Integer for p in top.atoms(sp.Pow)):
        return [(whole, 1)]
    found = sp.factor_list(top, gaussian=True)[1] if top.has(sp.I) else sp.factor_list(top)[1]
    return [(sp.Poly(factor, C), many) for factor, many in found if factor.has(C)]


def _tidied(a):
    a = sp.expand(a)
    if a.is_Add and a.has(sp.Pow):
        a = sp.expand(sp.cancel(sp.together(a))) if not a.has(sp.sqrt) else sp.simplify(a)
    return a


def _special(P, ends, given, above, depth):
    """(cases where a vertex of the polygon vanishes, the condition that none does)."""
    found, conditions = [], [given]
    for end in ends:
        real, imaginary = (sp.factor(part) for part in sp.expand(P[end]).as_real_imag())
        if not P[end].free_symbols:
            continue
        if real != 0 and imaginary != 0:  # both must vanish
            if not real.free_symbols or not imaginary.free_symbols:
                continue
            conditions.append(sp.Ne(real**2 + imaginary**2, 0))
            found.append(Found(sp.And(given, sp.Eq(real, 0), sp.Eq(imaginary, 0)), None, Fraction(0)))
            continue
        for factor in _factors(real + imaginary):
            conditions.append(sp.Ne(factor, 0))
            found += where_zero(P, factor, given, above, depth)
    return found, sp.And(*conditions)


def _factors(expression):
    """The factors with names of a real expression, those of the numerator, that can vanish."""
    top = sp.fraction(sp.together(expression))[0]
    found = [factor for factor, _ in sp.factor_list(top)[1] if factor.free_symbols]
    return [factor for factor in found if not (factor.is_positive or factor.is_negative)]


def where_zero(P, factor, given, above, depth):
    """The cases of P where a factor is 0, by what it makes of one name; unknown where it is linear in none."""
    here = sp.And(given, sp.Eq(factor, 0))
    if here == sp.false:
        return []
    for name in sorted(factor.free_symbols, key=str):
        if not factor.is_polynomial(name) or sp.degree(factor, name) != 1:
            continue
        slope = sp.diff(factor, name)
        value = sp.cancel(name - factor / slope)
        here = sp.And(here, sp.Ne(slope, 0))
        unknown = (
            [Found(sp.And(given, sp.Eq(factor, 0), sp.Eq(slope, 0)), None, Fraction(0))] if slope.free_symbols else []
        )
        try:
            left = {place: a.subs(name, value) for place, a in P.items()}
            if any(a.has(sp.zoo, sp.nan, sp.oo) for a in left.values()):
                return unknown  # no linearisation there
            return unknown + [
                Found(sp.And(here, one.condition), one.growth, one.exponent)
                for one in cases(left, given.subs(name, value), above, depth - 1)
            ]
        except TypeError:
            break
    return [Found(here, None, Fraction(0))]


def _of_factor(P, factor, many, q, beside, depth):
    """The cases of the roots c k^q of one irreducible factor of an edge's polynomial."""
    coefficients = [sp.factor(a) for a in factor.all_coeffs()]  # the highest first
    real = [sp.factor(a) for a in (sp.expand(c / coefficients[0]) for c in coefficients)]
    if factor.degree() == 1:
        return _of_root(P, sp.expand(-real[1]), many, q, beside, depth)
    parts = [sp.expand(sp.together(a)).as_real_imag() for a in real]
    if factor.degree() == 2:
        (p1, q1), (p0, q0) = parts[1:]
        p1, q1, p0, q0 = map(sp.simplify, (p1, q1, p0, q0))
        if p1 == q1 == q0 == 0 or (p1 == 0 and q0 == 0):  # c = i s, s^2 + q1 s - p0 = 0, of real coefficients
            D = sp.factor(q1**2 + 4 * p0)
            grows = Found(sp.And(beside, D < 0), sp.sqrt(-D) / 2, q)
            roots = [sp.I * (-q1 + sign * sp.sqrt(D)) / 2 for sign in (1, -1)]
            found = [grows, *_meeting(P, D, beside, depth, q)]
            if not _conservative(P) or many > 1:
                for root in roots:
                    found += _below(P, root, q, sp.And(beside, D > 0), depth)
            return found
        if q1 == q0 == 0:  # Routh and Hurwitz
            D = sp.factor(p1**2 - 4 * p0)
            return [
                Found(sp.And(beside, sp.Or(p1 < 0, p0 < 0)), (-p1 + sp.sqrt(sp.Max(D, 0))) / 2, q),
                *_meeting(P, p1, sp.And(beside, p0 > 0), depth, q),
            ]
        hurwitz = sp.factor(p1**2 * p0 + p1 * q1 * q0 - q0**2)
        return [
            Found(sp.And(beside, sp.Or(p1 < 0, hurwitz < 0)), _largest(factor), q),
            *_meeting(P, hurwitz, sp.And(beside, sp.Ge(p1, 0)), depth, q),
        ]
    if factor.degree() == 3 and all(sp.simplify(part[1]) == 0 for part in parts):
        a2, a1, a0 = (sp.factor(part[0]) for part in parts[1:])
        hurwitz = sp.factor(a2 * a1 - a0)
        if a2 == a1 == 0:
            return [Found(beside, sp.Abs(a0) ** sp.Rational(1, 3) * sp.Piecewise((1, a0 < 0), (sp.S.Half, True)), q)]
        return [
            Found(sp.And(beside, sp.Or(a2 < 0, a0 < 0, hurwitz < 0)), None, q)._replace(growth=sp.nan),
            *_meeting(P, hurwitz, sp.And(beside, a2 > 0, a0 > 0), depth, q),
        ]
    turned = [
        sp.simplify(a * sp.I ** (m - factor.degree()))
        for m, a in zip(range(factor.degree(), -1, -1), real, strict=True)
    ]
    turned = [sp.expand(t / turned[0]) for t in turned]
    if factor.degree() == 3 and all(t.as_real_imag()[1] == 0 for t in turned) and _conservative(P) and many == 1:
        D = sp.factor(sp.discriminant(sp.Poly(turned, C)))
        return [Found(sp.And(beside, D < 0), sp.nan, q), *_meeting(P, D, beside, depth, q)]
    if factor.degree() > 2 and all(a == 0 for a in real[1:-1]):  # three or more roots on a circle: one grows
        return [Found(beside, sp.nan, q)]
    return [Found(beside, None, q)]


def _largest(factor):
    top, p, r = factor.all_coeffs()
    if p == 0:  # the square roots of one number
        real, imaginary = sp.expand(-r / top).as_real_imag()
        return sp.sqrt((sp.sqrt(sp.expand(real**2 + imaginary**2)) + real) / 2)
    return sp.Max(*(sp.re(z) for z in sp.roots(factor, multiple=True)))


def _meeting(P, D, beside, depth, q):
    """The cases where D = 0, on which an edge's roots meet, or the axis: from the beginning, with less freedom."""
    found = []
    for factor in _factors(D):
        found += where_zero(P, factor, beside, None, depth)
    return found


def _of_root(P, root, many, q, beside, depth):
    """The cases of one simple root c k^q, c in symbols."""
    rate = sp.factor(sp.re(root) if root.has(sp.sqrt) else root.as_real_imag()[0])
    if rate != 0:
        found = [Found(sp.And(beside, rate > 0), rate, q)] if (rate > 0) != sp.false else []
        if rate.free_symbols and root.as_real_imag()[1] != 0:
            found += _meeting(P, rate, beside, depth, q)
        return found
    if many == 1 and _conservative(P):
        return []
    return _below(P, root, q, beside, depth)


def _below(P, root, q, beside, depth):
    """The cases of what follows root k^q, which does not grow itself."""
    shifted: dict = {}
    for (i, j), a in P.items():
        for m in range(i + 1):
            place = (m, Fraction(j) + q * (i - m))
            shifted[place] = shifted.get(place, 0) + a * comb(i, m) * root ** (i - m)
    return cases(shifted, beside, q, depth - 1)


def _conservative(P):
    """Whether the roots of P(., k) are symmetric about the imaginary axis for every real k, whatever the names are."""
    top = max(P)
    ratio = sp.conjugate(P[top]) * (-1) ** top[0] / P[top]
    return all(sp.simplify(sp.conjugate(a) * (-1) ** i - ratio * a) == 0 for (i, _), a in P.items())
