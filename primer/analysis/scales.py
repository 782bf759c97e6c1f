"""The sizes of k at which a polynomial P(lambda, k) changes its character, and the sizes of lambda there.

On logarithmic axes |lambda| as a function of k is a chain of straight pieces, the slopes of the Newton polygon; they
meet where three terms balance. Nothing else has a size: not |xi| = 1, nor any number of digits.
"""

from fractions import Fraction
from itertools import combinations, pairwise

import mpmath as mp


def scales(P):
    """[(log k, smallest log |lambda|, largest)] where the pieces meet, k ascending: natural logarithms."""
    columns: dict = {}
    for (n, a), c in P.items():
        columns.setdefault(n, []).append((float(a), float(mp.log(abs(c)))))
    places = set()
    for column in columns.values():
        for (a, h), (b, h2) in combinations(column, 2):
            places.add((h - h2) / (b - a))
    lines = [(n, a, h) for n, column in columns.items() for a, h in column]
    if len(columns) > 2 and len(lines) <= 60:
        for (n, a, h), (m, b, g), (o, c, f) in combinations(lines, 3):
            # heights at n, m, o on one straight line
            u, v, w = m - o, o - n, n - m
            slope = u * a + v * b + w * c
            if len({n, m, o}) == 3 and slope:
                places.add(-(u * h + v * g + w * f) / slope)
    found = []
    for s in sorted(places):
        heights = sorted((n, max(a * s + h for a, h in column)) for n, column in columns.items())
        hull = _hull(heights)
        sizes = [(y - y2) / (x2 - x) for (x, y), (x2, y2) in pairwise(hull)]
        if sizes and _meets(columns, heights, hull, s):
            found.append((s, min(sizes), max(sizes)))
    return found


def homogeneity(D):
    """q if lambda(k xi) = k^q lambda(xi) for all k > 0 on every branch of det M = D(lambda, xi); None if there is none.

    Where all terms c lambda^n xi_1^a xi_2^b have the same n q + a + b.
    """
    (n, *powers), *others = D
    slopes = {(sum(powers) - sum(rest), m - n) for m, *rest in others if (m, sum(rest)) != (n, sum(powers))}
    if not slopes or any(not width for _, width in slopes):
        return Fraction(0) if not slopes else None
    found = {Fraction(rise, width) for rise, width in slopes}
    return found.pop() if len(found) == 1 else None


def _hull(points):
    hull: list = []
    for x, y in points:
        while len(hull) > 1 and (hull[-1][1] - hull[-2][1]) * (x - hull[-1][0]) <= (y - hull[-1][1]) * (
            hull[-1][0] - hull[-2][0]
        ):
            hull.pop()
        hull.append((x, y))
    return hull


def _meets(columns, heights, hull, s):
    """Whether more terms than two lie on one edge of the hull at log k = s, or two at one vertex."""
    for (x, y), (x2, y2) in pairwise(hull):
        count = 0
        for n, _ in heights:
            if x <= n <= x2:
                edge = y + (y2 - y) * (n - x) / (x2 - x)
                count += sum(abs(a * s + h - edge) <= 1e-9 * (1 + abs(edge)) for a, h in columns[n])
        if count > 2:
            return True
    return False
