"""How many derivatives a well-posed problem may lose: by which power of |xi| bounded data grow in a time of order one.

Eigenvalues do not tell: u_t = u_x + v_x, v_t = v_x has none that grows, and |exp(t A)| ~ |xi| t. By Kreiss' matrix
theorem the supremum of |exp(t A)| over a time of order one is that of Re s |(s - A)^-1| over Re s > 1, but for a factor
that depends on the size of A alone. As s moves away from the imaginary part of an eigenvalue, the resolvent changes
its power of |xi| at the distances of the other eigenvalues only: these places are enough.
"""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import combinations, pairwise

import mpmath as mp

from primer.analysis.factors import factors
from primer.analysis.puiseux import branches, collected
from primer.analysis.roots import interpolated, roots, sylvester_interpolated, trimmed
from primer.analysis.scales import scales

FAR = (9, 12)  # decades beyond all scales of the equations at which the power is read off
DENOMINATOR = 12  # the largest of a power
NEAR = 4e-3  # how near to such a fraction it must be: two of them are 1/132 apart
SAME = mp.mpf(10) ** -100  # relative size of what is only rounding: coefficients have 160 digits
GENERIC = (0.31, -0.83, 1.7, -2.9)  # slopes in general position


def loss(symbol, half=False):
    """The power (a Fraction) for a :class:`Symbol` whose growth is bounded; nan where it was not decided.

    ``half``: only xi > 0 counts, in one space variable.

    Every unknown counts alike, its j-th time derivative divided by |xi|^(jq), q the power of the fastest branch.
    Unknowns without a time derivative are no data and are left out; data obey the constraints.
    """
    with mp.workdps(100):
        rays = [(1, 0), (-1, 0)][: 2 - half] if symbol.dim == 1 else [(1, mp.mpf(t)) for t in GENERIC]
        on_rays = [_on_ray(symbol.determinant, *d) for d in rays]
        q = max(branch.exponent for P in on_rays for branch in branches(P, 0))
        furthest = max([0.0, *(s for P in on_rays for s, _, _ in scales(P))]) / math.log(10)
        sizes = [(n, a + b) for row in symbol.entries for entry in row for n, a, b in entry]
        order = max(a for _, a in sizes) + max(n for n, _ in sizes) * max(q, 1)
    found: list = []
    slopes, same = None, len({n * q + a + b for n, a, b in symbol.determinant}) == 1
    decades = [max(furthest, 0) + far for far in FAR]
    digits = 80 + int(decades[-1] * order * len(symbol.entries))
    if digits > 4000:
        return math.nan
    with mp.workdps(digits):
        for decade in decades:
            k = mp.mpf(10) ** mp.mpf(decade)
            if symbol.dim == 2 and not (found and same):  # of a homogeneous determinant they are the same at every k
                slopes = _slopes(symbol.determinant, k)
            if symbol.dim == 2 and slopes is None:
                return math.nan
            vectors = [(x * k, y * k) for x, y in (rays if slopes is None else [(0, 1), *((1, t) for t in slopes)])]
            values = [_resolvent(symbol, xi, max(q, 0), same) for xi in vectors]
            if None in values or not values:
                return math.nan
            found.append(mp.log(max(values), 10))
        power = float((found[1] - found[0]) / (FAR[1] - FAR[0]))
    fraction = Fraction(max(power, 0)).limit_denominator(DENOMINATOR)
    return fraction if abs(power - fraction) <= NEAR else math.nan


def _on_ray(D, x, y):
    length = mp.sqrt(x**2 + y**2)
    x, y = x / length, y / length
    return collected((((n, Fraction(a + b)), c * x**a * y**b) for (n, a, b), c in D.items()))


def _resolvent(symbol, xi, q, same):
    """The largest Re s |(s - A)^-1| at one wavevector over the places s that matter, None where data are not states.

    ``same``: ratios of eigenvalues are the same at every |xi|, so that of distances of one size one will do.
    """
    p = [mp.mpc(0)] * (1 + max(n for n, _, _ in symbol.determinant))
    size = [mp.mpf(0)] * len(p)
    for (n, a, b), c in symbol.determinant.items():
        term = c * xi[0] ** a * xi[1] ** b
        p[n], size[n] = p[n] + term, size[n] + abs(term)
    top = len(p) - 1
    if abs(p[top]) <= SAME * size[top]:
        return mp.mpf(0)  # a direction in which a time derivative drops out has no states of its own
    with mp.workdps(160):
        eigenvalues = _distinct(p, size)
    right = max([mp.mpf(0), *(z.real for z in eigenvalues)])
    least = 1 + 2 * right
    E, S, counted = _first_order(symbol, xi, mp.sqrt(xi[0] ** 2 + xi[1] ** 2) ** q)
    V = _states(E, S, top, counted, least)
    if V is None:
        return None
    best = mp.mpf(0)
    for z in eigenvalues:
        distances = {mp.mpf(least), *(max(least, abs(w - 1j * z.imag)) for w in eigenvalues)}
        for distance in _of_each_size(distances) if same else distances:
            X = _solved(E, S, mp.mpc(distance, z.imag), V)
            best = max(best, distance * mp.mnorm(_counted(X, counted), "f"))
    return best


def _of_each_size(distances):
    """The smallest of each group of distances that are within a decade of the next."""
    ascending = sorted(distances)
    return [ascending[0], *(far for near, far in pairwise(ascending) if far > 10 * near)]


def _first_order(symbol, xi, unit):
    """E, S of E z_t + S z = 0 for the unknowns and, divided by powers of ``unit``, their time derivatives; and which
    rows of z count."""
    orders = [max((n for row in symbol.entries for n, _, _ in row[c]), default=0) for c in range(len(symbol.entries))]
    place = {(c, 0): c for c in range(len(orders))}
    for c, order in enumerate(orders):
        for n in range(1, order):
            place[c, n] = len(place)
    E, S = mp.zeros(len(place)), mp.zeros(len(place))
    for r, row in enumerate(symbol.entries):
        for c, entry in enumerate(row):
            for (n, a, b), value in entry.items():
                term = value * mp.mpc(0, 1) ** (a + b) * xi[0] ** a * xi[1] ** b
                if n and n == orders[c]:
                    E[r, place[c, n - 1]] += term * unit ** (n - 1)
                else:
                    S[r, place[c, n]] += term * unit**n
    for (c, n), row in place.items():
        if n:
            E[row, place[c, n - 1]] += 1
            S[row, row] -= unit
    return E, S, [row for (c, _), row in place.items() if orders[c]]


def _solved(E, S, s, V):
    """(s E + S)^-1 E V, by elimination with the largest pivots of rows that are scaled."""
    size, right = E.rows, E * V
    rows = [[s * E[i, j] + S[i, j] for j in range(size)] + [right[i, j] for j in range(V.cols)] for i in range(size)]
    for i, row in enumerate(rows):
        scale = max(map(abs, row[:size]))
        rows[i] = [x / scale for x in row] if scale else row
    for step in range(size):
        best = max(range(step, size), key=lambda r: abs(rows[r][step]))
        rows[step], rows[best] = rows[best], rows[step]
        top = rows[step]
        for r in range(size):
            if r != step and rows[r][step]:
                factor = rows[r][step] / top[step]
                pairs = enumerate(zip(rows[r], top, strict=True))
                rows[r] = [x - factor * y if c > step and y else x for c, (x, y) in pairs]
    return mp.matrix([[x / row[i] for x in row[size:]] for i, row in enumerate(rows)])


def _states(E, S, number, counted, least):
    """Columns that span the states which obey the constraints, orthonormal in the rows that count; None if they do not.

    They are the range of a high power of (s E + S)^-1 E, whatever s.
    """
    size = E.rows
    V = mp.eye(size)
    if number < size:
        for _ in range(size):
            V = _solved(E, S, mp.mpc(3 * least, least), V)
            V = V / mp.mnorm(V, "f")
        V = _independent(V, number, list(range(size)))
    return None if V is None else _independent(V, number, counted)


def _independent(V, number, rows):
    """``number`` combinations of the columns of V, orthonormal in these rows: Gram-Schmidt, the longest first."""
    columns = [V[:, j] for j in range(V.cols)]
    kept: list = []
    first = None
    for _ in range(number):
        lengths = [mp.sqrt(mp.fsum(abs(column[r]) ** 2 for r in rows)) for column in columns]
        best = max(range(len(columns)), key=lengths.__getitem__)
        first = first or lengths[best]
        if lengths[best] <= first * mp.mpf(10) ** (-mp.mp.dps * 2 // 3):
            return None
        column = columns.pop(best) / lengths[best]
        kept.append(column)
        for _ in range(2):
            columns = [other - column * mp.fsum(mp.conj(column[r]) * other[r] for r in rows) for other in columns]
    found = mp.zeros(V.rows, number)
    for j, column in enumerate(kept):
        found[:, j] = column
    return found


def _counted(X, rows):
    found = mp.zeros(len(rows), X.cols)
    for i, r in enumerate(rows):
        found[i, :] = X[r, :]
    return found


def _slopes(D, k):
    """Slopes xi_2/xi_1 at xi_1 = k: those at which branches meet, and some in general position; or None."""
    parts = [_at_slope(part, k) for part in factors(D)]
    found = [mp.mpf(0), mp.mpf(1), mp.mpf(-1), *map(mp.mpf, GENERIC)]
    meetings = [sylvester_interpolated(p, q) for p, q in combinations(parts, 2)]
    for p in parts:
        if len(p) > 2:
            meeting = sylvester_interpolated(p, [[n * c for c in column] for n, column in enumerate(p)][1:])
            if meeting is None:  # some are one everywhere: each once
                p = _simple(p)
                if p is None:
                    return None
                meeting = sylvester_interpolated(p, [[n * c for c in column] for n, column in enumerate(p)][1:])
            meetings.append(meeting)
    for meeting in meetings:
        if meeting is None:
            return None
        found += [z.real for z, _ in roots(meeting) if abs(z.imag) <= (1 + abs(z)) / 10]
    return found


def _at_slope(part, k):
    """A polynomial at xi_1 = k: for each power of lambda the coefficients, a polynomial in the slope xi_2/xi_1."""
    columns: list[dict] = [{} for _ in range(1 + max(n for n, _, _ in part))]
    for (n, a, b), c in part.items():
        columns[n][b] = columns[n].get(b, 0) + c * k ** (a + b)
    return [[column.get(b, mp.mpc(0)) for b in range(max(column, default=0) + 1)] for column in columns]


def _simple(p):
    """Coefficients, as p's polynomials in a slope, of the polynomial in lambda whose roots are those of p, each once.

    None if the leading coefficient is not constant.
    """
    if any(p[-1][1:]):
        return None
    nodes = range(1, max(map(len, p)) + 1)
    values = []
    for t in nodes:
        simple = [mp.mpc(1)]
        for z, _ in roots([mp.polyval(column[::-1], t) for column in p]):
            simple = [low - z * high for low, high in zip([0, *simple], [*simple, 0], strict=True)]
        values.append(simple)
    if len({len(simple) for simple in values}) > 1:
        return None
    columns = [interpolated(nodes, list(column)) for column in zip(*values, strict=True)]
    largest = [max(map(abs, column)) for column in columns]
    small = mp.mpf(10) ** (-mp.mp.dps * 2 // 3)
    return [trimmed(column, small * size) or [mp.mpc(0)] for column, size in zip(columns, largest, strict=True)]


def _distinct(p, size):
    """The distinct roots of p, whose coefficients are sums of terms of this size."""
    small = SAME * mp.mpf(10) ** -40
    p = [mp.mpc(0) if abs(c) <= small * most else +c for c, most in zip(p, size, strict=True)]
    return [z for z, _ in roots(p, SAME)]
