"""The fastest law of growth over all directions, and the largest growth where that is bounded."""

import math
from fractions import Fraction

import mpmath as mp
import numpy as np

from primer.analysis.directions import MaxGrowth, max_growth
from primer.analysis.drift import BEYOND, worst_law
from primer.analysis.factors import factors
from primer.analysis.poles import of_law, on_curves
from primer.analysis.puiseux import branches
from primer.analysis.roots import DIGITS
from primer.analysis.scales import homogeneity, scales
from primer.analysis.supremum import along_line, exact_growth, in_plane, rate, ray


def law_along_line(symbol, signs):
    """(law, direction, drift, doubt) in one space variable; ``signs`` are the half lines that differ."""
    found = []
    for sign in signs:
        found += [(branches(P)[0].law, sign) for P in _on_line(symbol, sign)]
    law, sign = max(found, key=lambda item: (item[0], item[1]))
    return law, (float(sign),), Fraction(0), ""


def _on_line(symbol, sign):
    """The factors of det M as polynomials in lambda and k = xi > 0, or -xi."""
    with mp.workdps(DIGITS):
        return [{(n, a): c * sign**a for (n, a, _), c in part.items()} for part in factors(symbol.determinant)]


def supremum_of(symbol, law, real, signs):
    """(sup Re lambda, |xi| where), given that the fastest ``law`` is bounded."""
    D = symbol.determinant
    known = []
    with mp.workdps(DIGITS):  # at xi = 0, where P(lambda, 0) may say less than the limit
        P = {(n, 0): c for (n, a, b), c in D.items() if a == b == 0}
        if max(P, default=(0, 0))[0] == max(D)[0]:
            known.append((float(rate(P, mp.mpf(0))), 0.0))
    known.append((of_law(law), math.inf))
    if symbol.dim == 2 and (power := homogeneity(D)) is not None and power > 0:
        return 0.0, 0.0  # growth is |xi|^power times that of the direction, which is not positive: 0 as |xi| -> 0
    if symbol.dim == 1:
        lines = [P for sign in signs for P in _on_line(symbol, sign)]
        found = [along_line(P, real, known) for P in lines]
        return max(found, key=lambda item: item[0])
    known.insert(0, (of_law(worst_law(D, real, inward=True).law), 0.0))
    known.append(on_curves(D))
    return in_plane(symbol, real, known)


def law_in_plane(symbol, real):
    """The fastest law, found exactly, and whether the largest growth at two large wavenumbers exceeds it."""
    D, pencil = symbol.determinant, symbol.pencil()
    far = [math.exp(s) for angle in (0.3, 1.9) for s, _, _ in scales(ray(D, angle))]  # past all scales of the equations
    k = max([1.0, *far]) * np.array([1e5, 1e7])
    if homogeneity(D) is not None:  # the same directions are the fastest at each |xi|
        angle = float(max_growth(pencil, k[:1]).angle[0])
        best = MaxGrowth(k, k, np.outer([math.cos(angle), math.sin(angle)], [1, 1]))
    else:
        best = max_growth(pencil, k)
    worst = worst_law(D, real, best.angle)
    seen = [max(exact_growth(symbol, xi), 0.0) for xi in (k * best.direction).T]  # without rounding errors
    law = worst.law
    allowed = 2 * seen[0]
    if not law.is_bounded and law.exponent < BEYOND / 20:
        allowed = 1.2 * law.coefficient * k[1] ** float(law.exponent)
    doubt = ""
    if seen[1] > allowed and seen[1] > 2 * seen[0]:
        doubt = f", but growth of {seen[0]:.4g} at |xi| = {k[0]:g} and {seen[1]:.4g} at {k[1]:g} was computed"
    return law, worst.direction, worst.drift, doubt


def is_real(D):
    """Whether growth is the same at xi and -xi: det M(conj lambda, -xi) is conj det M(lambda, xi) up to a factor."""
    top = max(D)
    with mp.workdps(DIGITS):
        ratio = D[top].conjugate() * (-1) ** sum(top[1:]) / D[top]
        return all(abs(c.conjugate() * (-1) ** (a + b) - ratio * c) <= 1e-30 * abs(c) for (_, a, b), c in D.items())
