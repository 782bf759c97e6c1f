"""What growth can depend on at a point, in numbers, for many points at once: the signature of the Newton polygon.

Which coefficients of det M vanish, and on each edge of the Newton polygon how many roots lie on which side of the
imaginary axis, or on it, and how many of them meet. Within a connected set of one signature the fastest law keeps its
form, unless it is decided below the leading order; so whoever fills such a set from some of its points says so.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from primer.analysis.family import numbers
from primer.analysis.puiseux import hull_of

NOUGHT = 1e-13  # of the sum of sizes of its terms: a coefficient smaller than that has cancelled
ROUNDING = 1e-14  # of a root of a polynomial in double precision, before what its condition number makes of it


def signatures(family, values, numbered):
    """(labels, growth): an integer for each point, equal for equal signatures; and the coefficient of the leading law.

    ``values`` are arrays (m,) of the family's open names, one space variable. growth (m,) is the largest real part on
    the first edge of the polygon where it is positive; elsewhere nan. ``numbered`` is a dict in which the labels are
    kept, so that they mean the same in the next call with it; -1 where a coefficient has no value.
    """
    powers = list(family.determinant)
    c, most = numbers([family.determinant[p] for p in powers], family.symbols, values)
    lost = ~np.isfinite(c).all(axis=0)
    there = np.abs(c) > NOUGHT * most
    size = c.shape[1]
    growth = np.full(size, np.nan)
    rows: list[tuple] = [()] * size
    masks, which = np.unique(there, axis=1, return_inverse=True)
    which = np.ravel(which)
    for g in range(masks.shape[1]):
        points = np.flatnonzero((which == g) & ~lost)
        P = {(p[0], p[1]): c[k, points] for k, p in enumerate(powers) if masks[k, g]}
        if not len(points) or not P:
            continue
        marks, rate = _edges(P, len(points))
        growth[points] = rate
        for j, point in enumerate(points):
            rows[point] = (masks[:, g].tobytes(), *marks[j])
    labels = np.array([numbered.setdefault(row, len(numbered)) for row in rows])
    labels[lost] = -1
    return labels, growth


def _edges(P, size):
    """Per point the counts of roots by edge, and the growth of the fastest law that the leading order shows."""
    hull = hull_of(P)
    marks, growth = [np.full((size, 1), hull[0][0])], np.full(size, np.nan)
    for (i, j), (i2, j2) in pairwise(hull):
        terms = [P.get((i + m, j + (j2 - j) * m / (i2 - i)), 0) for m in range(i2 - i + 1)]
        edge = np.array([np.broadcast_to(a, size) for a in terms], dtype=complex)
        z, noise = _roots(edge)
        side = np.where(np.abs(z.real) <= noise * np.abs(z), 0, np.sign(z.real))
        if j > j2:
            top = np.where(side > 0, z.real, -np.inf).max(axis=1)
            growth = np.where(np.isnan(growth) & np.isfinite(top), top, growth)
        marks.append(np.stack([(side > 0).sum(1), (side < 0).sum(1), (noise > 1e-8).sum(1)], axis=1))
    return np.concatenate(marks, axis=1).tolist(), growth


def _roots(edge):
    """Roots (m, degree) of polynomials (degree + 1, m), the constants first, and the relative errors to expect."""
    degree = len(edge) - 1
    size = np.abs(edge[0] / edge[-1]) ** (1 / degree)  # the geometric mean of the roots
    monic = np.array([a / edge[-1] * size ** (n - degree) for n, a in enumerate(edge)])
    companion = np.zeros((edge.shape[1], degree, degree), dtype=complex)
    companion[:, np.arange(1, degree), np.arange(degree - 1)] = 1
    companion[:, :, -1] = -monic[:-1].T
    z = np.linalg.eigvals(companion) if degree > 1 else companion[:, 0]
    powers = z[None] ** np.arange(degree + 1)[:, None, None]
    sums = (np.abs(monic)[:, :, None] * np.abs(powers)).sum(axis=0)
    slope = (np.arange(1, degree + 1)[:, None, None] * monic[1:, :, None] * powers[:-1]).sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        noise = np.fmin(ROUNDING * sums / np.abs(slope * z), 1e-4)
    return z * size[:, None], noise
