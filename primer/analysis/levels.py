"""Where growth crosses a level: the real k at which a root of P(lambda, k) has the real part L, all of them, exactly.

There A(omega, k) + i B(omega, k) = P(L + i omega, k) has a real root omega in common, so that the resultant of A and B
in omega, a polynomial in k, vanishes. Between two of its real zeros as many roots lie to the right of L at one k as at
the next: one place from each gap tells whether any growth exceeds L, and where to climb from. (Boyd & Balakrishnan
1990 and Bruinsma & Steinbuch 1990 find the norm of a transfer function so.) Whole numbers throughout: nothing is lost.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise, product
from math import ceil

import mpmath as mp

from primer.analysis.isolation import between, square_root
from primer.analysis.puiseux import hull_of

DIGITS = 100  # kept of the coefficients of P
LARGEST = 160  # degree of the resultant beyond which it takes too long


def gaps(P, level, even):
    """Places k > 0 (Fractions), one from each interval in which P has the same number of roots right of the level.

    ``even``: growth at k and -k is the same. None where the resultant vanishes identically or its degree is too high.
    """
    height = degree(P)
    if height > LARGEST:
        return None
    shift = _exponent(P)
    rows = _shifted({power: c * mp.mpf(2) ** int(shift * power[1]) for power, c in P.items()}, level)
    R = _resultant(rows, height, even)
    if R is None:
        return None
    while R and R[0] == 0:
        R.pop(0)
    if len(R) < 2:
        return [Fraction(2) ** shift]
    places = between(R)
    if even:
        places = [square_root(x) for x in places]
    return [x * Fraction(2) ** shift for x in places]


def degree(P):
    """A bound of the degree of the resultant: of lc^2n times the product of all lambda_i + conj lambda_j - 2 L."""
    hull = hull_of(P)
    slopes = [max((j - j2) / Fraction(i2 - i), 0) for (i, j), (i2, j2) in pairwise(hull) for _ in range(i2 - i)]
    n, top = hull[-1]
    slopes += [Fraction(0)] * (n - len(slopes))
    return ceil(2 * n * top + sum(max(p, q) for p, q in product(slopes, repeat=2)))


def _exponent(P):
    """An exponent e such that the coefficients of P(lambda, 2^e k) are of moderate size: the mean of their slopes."""
    found = []
    for n in {n for n, _ in P}:
        column = sorted((a, mp.log(abs(c), 2)) for (m, a), c in P.items() if m == n)
        found += [(h - h2) / int(b - a) for (a, h), (b, h2) in pairwise(column)]
    return round(float(sum(found) / len(found))) if found else 0


def _shifted(P, level):
    """[(A_j, B_j)]: whole numbers {power of k: coefficient} with P(level + i omega, k) = sum (A_j + i B_j) omega^j."""
    n = max(P)[0]
    with mp.workdps(DIGITS):
        parts: list[dict] = [{} for _ in range(n + 1)]
        for (m, a), c in P.items():
            for j in range(m + 1):
                term = c * mp.binomial(m, j) * mp.mpf(level) ** (m - j) * mp.mpc(0, 1) ** j
                parts[j][a] = parts[j].get(a, 0) + term
        # Powers of omega are scaled so that the first and the last coefficient are alike.
        least = min(abs(c) for part in parts for c in part.values() if c)
        bits = int(DIGITS * 3.33) - int(mp.log(least, 2))
        scaled = []
        for part in parts:
            whole: tuple[dict, dict] = ({}, {})
            for a, c in part.items():
                for side, value in zip(whole, (mp.re(c), mp.im(c)), strict=True):
                    if number := int(mp.nint(mp.ldexp(value, bits))):
                        side[int(a)] = number
            scaled.append(whole)
    return scaled


def _resultant(rows, height, even):
    """The determinant of the Bezout matrix of A and B, as whole coefficients from the constant one upwards.

    By interpolation at whole k; of an even one, as a polynomial in k^2.
    """
    n = len(rows) - 1
    half = (height + 1) // 2
    nodes = list(range(half + 1)) if even else list(range(height + 1))
    values = []
    for k in nodes:
        a, b = ([sum(c * k**p for p, c in row[side].items()) for row in rows] for side in (0, 1))
        values.append(_bezout(a, b, n))
    if not any(values):
        return None
    if even:
        nodes, values = [-k for k in nodes[:0:-1]] + nodes, values[:0:-1] + values
    found = _interpolated(nodes[0], values)
    if even:
        found = found[::2]
    while found and found[-1] == 0:
        found.pop()
    return found


def _bezout(a, b, n):
    table = [[a[i] * b[j] - a[j] * b[i] for j in range(n + 1)] for i in range(n + 1)]
    rows = [[0] * n for _ in range(n)]
    for i in range(n):
        for j in range(n):
            rows[i][j] = sum(table[m][i + j + 1 - m] for m in range(max(i, j) + 1, min(n, i + j + 1) + 1))
    return _determinant(rows)


def _determinant(rows):
    """Of whole numbers, by Bareiss' elimination: every division leaves no remainder."""
    sign, last = 1, 1
    for step in range(len(rows) - 1):
        pivot = next((r for r in range(step, len(rows)) if rows[r][step]), None)
        if pivot is None:
            return 0
        if pivot != step:
            rows[step], rows[pivot], sign = rows[pivot], rows[step], -sign
        top = rows[step]
        for r in range(step + 1, len(rows)):
            row = rows[r]
            for c in range(step + 1, len(rows)):
                row[c] = (row[c] * top[step] - row[step] * top[c]) // last
        last = top[step]
    return sign * rows[-1][-1]


def _interpolated(first, values):
    """A multiple of the polynomial with these values at first, first + 1, ..., by Newton's forward differences."""
    table, size = list(values), len(values)
    for level in range(1, size):
        for m in range(size - 1, level - 1, -1):
            table[m] -= table[m - 1]
    found, factor = [table[-1]], 1  # sum of table[m] (x - first) ... (x - first - m + 1)/m!, times (size - 1)!
    for m in range(size - 2, -1, -1):
        factor *= m + 1
        node = first + m
        found = [low - node * high for low, high in zip([0, *found], [*found, 0], strict=True)]
        found[0] += table[m] * factor
    return found
