"""Weights of central differences of any order, exactly (Fornberg, Math. Comp. 51 (1988) 699)."""

from fractions import Fraction
from functools import cache
from math import factorial, lcm, prod


def central(m, order):
    """(offsets, weights, denominator) of the shortest central difference of order ``order`` for the m-th derivative.

    The weights are whole numbers over one denominator: m! times the coefficients of x^m in Lagrange's polynomials on
    the points -r ... r, r = (m + 1) // 2 - 1 + order // 2. Offsets run outwards: 0, 1, -1, 2, -2, ...

    >>> central(4, 2)
    ((0, 1, -1, 2, -2), (6, -4, -4, 1, 1), 1)
    """
    reach = (m + 1) // 2 - 1 + order // 2
    found = {k: coefficients[m] * factorial(m) for k, coefficients in _lagrange(reach).items() if coefficients[m]}
    offsets = tuple(sorted(found, key=lambda k: (abs(k), -k)))
    denominator = lcm(*(weight.denominator for weight in found.values()))
    return offsets, tuple(int(found[k] * denominator) for k in offsets), denominator


@cache
def _lagrange(reach):
    """{k: the coefficients, from x^0 on, of the polynomial that is 1 at k and 0 at the others of -reach ... reach}."""
    points = range(-reach, reach + 1)
    found = {}
    for k in points:
        others = [j for j in points if j != k]
        polynomial = [1]
        for j in others:  # times x - j
            polynomial = [a - j * b for a, b in zip([0, *polynomial], [*polynomial, 0], strict=True)]
        found[k] = [Fraction(c, prod(k - j for j in others)) for c in polynomial]
    return found
