"""Conditions over all directions of the plane, for symbols whose leading part is a quadratic form, or two of them.

lambda ~ F(xi), a form of the second order, or a quotient of forms in X = xi_1^2 and Y = xi_2^2; or the two roots of
lambda^2 + T lambda + D, of which T and D are such forms, as the trace and determinant of M + N in eq. (matrix).
"""

from __future__ import annotations

from fractions import Fraction

import sympy as sp

from primer.analysis.cases import Found


def cases_all_around(D):
    """A list of ``Found`` as of :func:`primer.analysis.cases.cases`, over all directions; None for other symbols."""
    top = max(n for n, *_ in D)
    forms = [{(a, b): c for (n, a, b), c in D.items() if n == m} for m in range(top + 1)]
    if top == 1:
        return _of_one(*forms)
    if top == 2 and set(forms[2]) == {(0, 0)}:
        T, det = _form(_divided(forms[1], forms[2][0, 0]), 2), _form(_divided(forms[0], forms[2][0, 0]), 4)
        if T and det:
            ill = sp.Or(_negative(*T), _negative(*det))
            edge = sp.And(sp.Not(ill), sp.Or(_touches(*T), _touches(*det)))
            return [Found(ill, sp.nan, Fraction(2)), Found(edge, None, Fraction(0))]
    return None


def _divided(form, number):
    return {place: sp.expand(c / number) for place, c in form.items()}


def _form(terms, degree):
    """(a, b, c, whether in squares): the leading part as a form of xi_1, xi_2, or of their squares; else None."""
    high = max((a + b for a, b in terms), default=-1)
    if high != degree or any(c.as_real_imag()[1] != 0 for (a, b), c in terms.items() if a + b == high):
        return None
    parts = {place: c for place, c in terms.items() if sum(place) == high}
    if degree == 2:
        squares = (1, 1) not in parts
        middle = parts.get((1, 1), sp.S.Zero)
        return parts.get((2, 0), sp.S.Zero), middle, parts.get((0, 2), sp.S.Zero), squares and None
    if any(a % 2 for a, _ in parts):
        return None
    return (*(parts.get(place, sp.S.Zero) for place in ((4, 0), (2, 2), (0, 4))), True)


def _negative(a, b, c, squares):
    """Whether a x^2 + b x y + c y^2 is negative anywhere; in squares, for any x, y >= 0."""
    mixed = sp.factor(b**2 - 4 * a * c)
    inside = mixed > 0 if not squares else sp.And(b < 0, mixed > 0)
    return sp.Or(a < 0, c < 0, inside)


def _touches(a, b, c, squares):
    """Whether it vanishes somewhere, where it is nowhere negative."""
    mixed = sp.Eq(sp.factor(b**2 - 4 * a * c), 0)
    return sp.Or(sp.Eq(a, 0), sp.Eq(c, 0), mixed if not squares else sp.And(b <= 0, mixed))


def _of_one(bottom, top):
    """lambda = -bottom/top."""
    if set(top) == {(0, 0)}:
        rate = _divided(bottom, top[0, 0])
        form = _form(rate, 2)
        if not form:
            return None
        ill = _negative(*form)
        a, b, c, _ = form
        growth = (-a - c + sp.sqrt((a - c) ** 2 + b**2)) / 2  # the largest of the form over unit vectors
        lower = any(a + b == 1 and sp.expand(r).as_real_imag()[0] != 0 for (a, b), r in rate.items())
        edge = [Found(sp.And(sp.Not(ill), _touches(*form)), None, Fraction(0))] if lower else []
        return [Found(ill, sp.simplify(growth), Fraction(2)), *edge]
    L, F = _form(top, 2), _form(bottom, 4)
    if not L or not F or L[1] != 0:
        return None
    a, _, c, _ = L
    found = []
    for sign in (1, -1):
        there = sp.And(sign * a > 0, sign * c > 0)
        ill = _negative(sign * F[0], sign * F[1], sign * F[2], True)
        found.append(Found(sp.And(there, ill), sp.nan, Fraction(2)))
        found.append(Found(sp.And(there, sp.Not(ill), _touches(*F)), None, Fraction(0)))
    return [*found, Found(sp.Not(a * c > 0), None, Fraction(0))]
