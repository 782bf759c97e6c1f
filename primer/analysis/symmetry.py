"""Three space variables: fewer of them tell all where growth is the same in all directions, or about an axis.

det M(lambda, xi) is invariant under a rotation about w, seen from a frame that moves (lambda -> lambda + i v.xi leaves
growth as it is), if the vector field (w x xi).grad_xi + i v.xi d/dlambda leaves nothing of it. All such (w, v) are the
solutions of linear equations. If the axes w span all of space, one direction stands for every one; if there is a single
w, the plane through it does, in which all that is known of two space variables holds exactly.
"""

from __future__ import annotations

from dataclasses import replace
from math import comb

import mpmath as mp

from primer.analysis.puiseux import collected
from primer.analysis.roots import DIGITS

CANCELLED = mp.mpf(10) ** -60  # relative size of what is only rounding: coefficients have 160 digits
TURNS = ((1, 2), (2, 0), (0, 1))  # w x xi along each axis turns one component into another


def reduced(symbol):
    """(symbol, basis): one in one or two space variables with the same growth, at xi = sum of basis[j] eta_j; or None.

    The wavevectors are in general position among those that the symmetry makes equal: for the determinant any will do,
    but for resolvents, which may know of more directions than eigenvalues do, a special one may be too good.
    """
    with mp.workdps(DIGITS):
        axes = axes_of_rotation(symbol.determinant)
        if len(axes) > 1:
            size = mp.sqrt(83)
            return restricted(symbol, [[3 / size, 5 / size, 7 / size]]), [[mp.mpf(1), mp.mpf(0), mp.mpf(0)]]
        if not axes:
            return None
        axis, across = axes[0], _across(axes[0])
        third = [axis[p] * across[q] - axis[q] * across[p] for p, q in TURNS]
        turned = [mp.cos(1) * a + mp.sin(1) * b for a, b in zip(across, third, strict=True)]
        return restricted(symbol, [axis, turned]), [axis, across]


def restricted(symbol, basis):
    """The :class:`Symbol` on the wavevectors sum of basis[j] eta_j, in as many space variables as there are vectors."""
    columns = list(zip(*basis, strict=True))  # of each component of xi, its part along each basis vector

    def entry(p):
        terms = []
        for (n, *orders), c in p.items():
            product = {(0,) * len(basis): c}
            for order, column in zip(orders, columns, strict=True):
                product = _times(product, _power(column, order))
            terms += [((n, *powers, *[0] * (2 - len(powers))), a) for powers, a in product.items()]
        return collected(terms)

    with mp.workdps(DIGITS):
        entries = tuple(tuple(entry(p) for p in row) for row in symbol.entries)
        return replace(symbol, entries=entries, dim=len(basis))


def _power(column, order):
    """(sum of column[j] d_j)^order as a polynomial in the d_j, of which there are one or two."""
    if len(column) == 1:
        return {(order,): column[0] ** order}
    x, y = column
    return {(order - m, m): comb(order, m) * x ** (order - m) * y**m for m in range(order + 1)}


def _times(p, q):
    return collected(
        (tuple(m + n for m, n in zip(a, b, strict=True)), c * d) for a, c in p.items() for b, d in q.items() if c and d
    )


def axes_of_rotation(D):
    """Unit vectors that span the axes w about which D(lambda, xi_1, xi_2, xi_3) is invariant, in some moving frame."""
    rows: dict = {}
    zeros = min(n for n, *_ in D)  # roots lambda = 0, as of div B, that need not move with the frame
    for (n, *orders), c in D.items():
        n -= zeros
        for w, (p, q) in enumerate(TURNS):
            for up, down, sign in ((p, q, 1), (q, p, -1)):
                if orders[down]:
                    powers = list(orders)
                    powers[up], powers[down] = powers[up] + 1, powers[down] - 1
                    rows.setdefault((n, *powers), [mp.mpc(0)] * 6)[w] += sign * c * orders[down]
        for j in range(3):
            if n:
                powers = list(orders)
                powers[j] += 1
                rows.setdefault((n - 1, *powers), [mp.mpc(0)] * 6)[3 + j] += 1j * n * c
    matrix = [[part(x) for x in row] for row in rows.values() for part in (mp.re, mp.im)]
    axes = [solution[:3] for solution in _null(matrix, 6)]
    axes = [[x if abs(x) > CANCELLED * max(map(abs, w)) else mp.mpf(0) for x in w] for w in axes if any(w)]
    return [[x / mp.sqrt(sum(y**2 for y in w)) for x in w] for w in axes]


def _null(matrix, width):
    """A basis of the solutions x of matrix x = 0, by elimination with full pivoting, each row scaled to one."""
    rows = [[x / max(map(abs, row)) for x in row] for row in matrix if any(row)]
    pivots: list[tuple] = []
    while rows:
        r, c = max(
            ((r, c) for r in range(len(rows)) for c in range(width)),
            key=lambda place: abs(rows[place[0]][place[1]]),
        )
        top = rows.pop(r)
        if abs(top[c]) <= CANCELLED:
            break
        top = [x / top[c] for x in top]
        rows = [[a - row[c] * b for a, b in zip(row, top, strict=True)] for row in rows]
        pivots = [(p, [a - old[c] * b for a, b in zip(old, top, strict=True)]) for p, old in pivots]
        pivots.append((c, top))
    found = []
    for free in set(range(width)) - {p for p, _ in pivots}:
        x = [mp.mpf(0)] * width
        x[free] = mp.mpf(1)
        for p, row in pivots:
            x[p] = -row[free]
        found.append(x)
    return found


def _across(w):
    """A unit vector at right angles to w."""
    least = min(range(3), key=lambda j: (abs(w[j]) > CANCELLED, j))
    e = [mp.mpf(j == least) for j in range(3)]
    across = [e[j] - w[least] * w[j] for j in range(3)]
    size = mp.sqrt(sum(x**2 for x in across))
    return [x / size for x in across]
