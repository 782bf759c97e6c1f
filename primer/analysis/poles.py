"""Where growth may be unbounded at a finite wavenumber: where the highest time derivative drops out.

The leading coefficient of det M in lambda vanishes there, and a root goes to infinity. Whether its real part does so
too is decided by its expansion in the distance, as at |xi| -> infinity; so it is for the way to xi = 0.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import comb

import mpmath as mp

from primer.analysis.puiseux import Law, branches, collected
from primer.analysis.roots import DIGITS, ZERO, resultant, roots

INFINITE = float("inf")


def limits(P):
    """[(limit, k)]: the largest growth as k > 0 tends to a pole of P(lambda, k), from either side, and to 0.

    inf where it is unbounded there; -inf where every branch decays without bound.
    """
    with mp.workdps(DIGITS):
        found = [(limit(inverted(P)), 0.0)]
        for z in positive_roots(leading(P)):
            found += [(limit(near(P, z, side)), float(z)) for side in (1, -1)]
    return found


def leading(P):
    """The coefficient of the highest power of lambda, a list from the constant one upwards."""
    top = max(n for n, _ in P)
    column = {int(a): c for (n, a), c in P.items() if n == top}
    return [column.get(a, mp.mpc(0)) for a in range(max(column) + 1)]


def positive_roots(p):
    """The distinct positive roots of a polynomial in one variable."""
    near_zero = mp.sqrt(ZERO)
    return sorted(z.real for z, _ in roots(p) if z.real > 0 and abs(z.imag) <= near_zero * abs(z))


def inverted(P):
    """P(lambda, 1/k)."""
    return {(n, -Fraction(a)): c for (n, a), c in P.items()}


def near(P, z, side):
    """P(lambda, z (1 + side/K)) as a polynomial in lambda and K -> infinity."""
    return collected(
        ((n, -Fraction(m)), c * z ** int(a) * comb(int(a), m) * side**m)
        for (n, a), c in P.items()
        for m in range(int(a) + 1)
    )


def limit(P):
    """The limit of the largest growth as k -> infinity: +-inf, or a number."""
    found = branches(P)
    return of_law(found[0].law) if found else -INFINITE


def of_law(law: Law):
    """The limit of coefficient k^exponent as k -> infinity."""
    if not law.coefficient or law.exponent < 0:
        return 0.0
    if not law.exponent:
        return law.coefficient
    return INFINITE if law.coefficient > 0 else -INFINITE


def on_curves(D):
    """(limit, |xi|): the largest limit of growth at poles on curves, or at points, at finite |xi| > 0 in the plane.

    On rays in directions between those in which the curves begin, end, touch or cross, and in these. (-inf, nan) if
    there are no such poles. Poles in a direction, at every |xi|, are found where directions are searched.
    """
    top = max(n for n, _, _ in D)
    if len({a + b for n, a, b in D if n == top}) == 1:
        return -INFINITE, float("nan")
    found = [(-INFINITE, float("nan"))]
    with mp.workdps(DIGITS):
        for second in (2, 1):
            for sign in (1, -1):
                F = {(p[0], Fraction(p[1] + p[2]), p[second]): c * sign ** (p[1] + p[2]) for p, c in D.items()}
                for slope in _slopes({p[1:]: c for p, c in F.items() if p[0] == top}):
                    P = collected(((n, j), c * slope**b) for (n, j, b), c in F.items())
                    if not P or max(n for n, _ in P) < top:
                        continue
                    stretch = mp.sqrt(1 + slope**2)
                    for z in positive_roots(leading(P)):
                        found += [(limit(near(P, z, side)), float(z * stretch)) for side in (1, -1)]
                        found += [(limit(_beside(F, z, slope, side)), float(z * stretch)) for side in (1, -1)]
    return max(found, key=lambda item: item[0])


def undetermined(D):
    """A direction (x, y) in which det M vanishes at every |xi| whatever lambda: a wave there may do anything; or None.

    det M is a sum of homogeneous polynomials in xi, one for each power of lambda and each degree: all must vanish.
    """
    parts: dict = {}
    for (n, a, b), c in D.items():
        parts.setdefault((n, a + b), {})[b] = c
    if all(a for _, a, _ in D):
        return 0.0, 1.0
    with mp.workdps(DIGITS):
        shortest = min(parts.values(), key=max)
        slopes = [z.real for z, _ in roots([shortest.get(b, mp.mpc(0)) for b in range(max(shortest) + 1)])
                  if abs(z.imag) <= mp.sqrt(ZERO) * (1 + abs(z))]  # fmt: skip
        for slope in slopes:
            if all(_vanishes(part, slope) for part in parts.values()):
                return float(1 / mp.sqrt(1 + slope**2)), float(slope / mp.sqrt(1 + slope**2))
    return None


def _vanishes(part, slope):
    terms = [c * slope**b for b, c in part.items()]
    return abs(sum(terms)) <= mp.sqrt(ZERO) * max(map(abs, terms))


def _beside(F, z, slope, side):
    """F at k = z and the slope + side/K as a polynomial in lambda and K."""
    return collected(
        ((n, -Fraction(m)), c * z ** int(j) * comb(b, m) * slope ** (b - m) * side**m)
        for (n, j, b), c in F.items()
        for m in range(b + 1)
    )


def _slopes(column):
    """Slopes t in [-1, 1] at which the positive zeros k of sum c k^j t^b change their number, and ones between."""
    width = {int(j): max(b for i, b in column if i == j) for j, _ in column}
    low, high = min(width), max(width)
    p = [[column.get((j, b), mp.mpc(0)) for b in range(width.get(j, 0) + 1)] for j in range(low, high + 1)]
    special = [mp.mpf(-1), mp.mpf(1), mp.mpf(0)]
    tests = [p[0], p[-1]]
    if len(p) > 1:
        tests.append(resultant(p, [[n * c for c in q] for n, q in enumerate(p)][1:]))
        mirror = [[mp.conj(c) for c in q] for q in p]
        tests.append(resultant(p, mirror))
    near_zero = mp.sqrt(ZERO)
    for q in tests:
        if any(q):
            while not q[-1]:
                q = q[:-1]
            special += [z.real for z, _ in roots(q) if abs(z.imag) <= near_zero * (1 + abs(z)) and abs(z.real) < 1]
    special = sorted(special)
    return [*special, *((a + b) / 2 + (b - a) * mp.mpf("0.0618") for a, b in pairwise(special) if b > a)]
