"""The positive zeros of a polynomial with whole coefficients (a list, the constant one first), apart and all of them.

By Descartes' rule of signs: in whole numbers, so that nothing is lost, however many decades the zeros are apart.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import gcd, isqrt

CLOSE = 120  # bits: zeros closer than that count as one
PRIME = 2**61 - 1


def between(R):
    """Positive Fractions, one between each two neighbouring positive zeros of R, one below and one above them all."""
    if not _squarefree(R):
        R = _squarefree_part(R)
    found = isolated(R)
    if not found:
        return [Fraction(1)]
    middle = [_middle(b, a) for (_, b), (a, _) in pairwise(found)]
    return [found[0][0], *middle, found[-1][1]]


def isolated(R):
    """Disjoint intervals (a, b), ascending, each with one positive zero of R, or with a cluster within 2^-CLOSE.

    By Descartes' rule of signs, in intervals that are halved: between far ends at the geometric mean.
    """
    size = [abs(c).bit_length() for c in R]
    n = len(R) - 1
    high = 2 + max((size[m] - size[n] + 1) // (n - m) + 1 for m in range(n) if R[m])
    low = -2 - max((size[m] - size[0] + 1) // m + 1 for m in range(1, n + 1) if R[m])
    found, todo = [], [(Fraction(2) ** low, Fraction(2) ** high)]
    while todo:
        a, b = todo.pop()
        changes = _changes(R, a, b)
        if changes == 1 or (changes and (b - a) * 2**CLOSE < b):
            found.append((a, b))
        elif changes:
            middle = _halfway(a, b)
            while _value(R, middle) == 0:
                middle = (a + 2 * middle) / 3
            todo += [(middle, b), (a, middle)]
    return found


def _halfway(a, b):
    if b <= 4 * a:
        return (a + b) / 2
    return Fraction(2) ** ((_log2(a) + _log2(b)) // 2)


def _log2(x):
    return x.numerator.bit_length() - x.denominator.bit_length()


def _value(R, x):
    p, q = x.numerator, x.denominator
    total, power = 0, 1
    for c in reversed(R):
        total = total * p + c * power
        power *= q
    return total


def _changes(R, a, b):
    """Sign changes of the coefficients of (1 + y)^n R((a + b y)/(1 + y)): zeros in (a, b), or an even number more."""
    scale = a.denominator * b.denominator // gcd(a.denominator, b.denominator)
    a, width = int(a * scale), int((b - a) * scale)
    n = len(R) - 1
    p, power = [], 1
    for c in reversed(R):  # R(x/scale) scale^n, from the highest coefficient down
        p.append(c * power)
        power *= scale
    p.reverse()
    power = 1
    for m in range(n + 1):
        p[m] *= power
        power *= a
    p = _moved(p)  # of R(a (1 + z)), z = width y/(a (1 + y))
    up, down = 1, a**n
    for m in range(n + 1):
        p[m] = p[m] * up * down
        up *= width
        down //= a
    p = _moved(p[::-1])
    signs = [c > 0 for c in p if c]
    return sum(one != other for one, other in pairwise(signs))


def _moved(p):
    """The coefficients of p(z + 1)."""
    p = list(p)
    for start in range(len(p) - 1):
        for m in range(len(p) - 2, start - 1, -1):
            p[m] += p[m + 1]
    return p


def _middle(a, b):
    """Between a and b, near their geometric mean."""
    x = square_root(a * b)
    return x if a < x < b else (a + b) / 2


def square_root(x):
    """The square root of a positive Fraction, to some twelve digits."""
    return Fraction(isqrt(x.numerator * x.denominator << 80), x.denominator << 40)


def _squarefree_part(R):
    import sympy as sp

    return [int(c) for c in sp.Poly(R[::-1], sp.Symbol("x"), domain=sp.ZZ).sqf_part().all_coeffs()[::-1]]


def _squarefree(R):
    """Whether R is certainly squarefree: it is if it is so modulo a prime that its leading coefficient survives."""
    f = [c % PRIME for c in reversed(R)]
    if not f[0]:
        return False
    g = [c * (len(f) - 1 - m) % PRIME for m, c in enumerate(f[:-1])]
    while g:
        inverse = pow(g[0], -1, PRIME)
        rest = list(f)
        for m in range(len(f) - len(g) + 1):
            if factor := rest[m] * inverse % PRIME:
                for j, c in enumerate(g):
                    rest[m + j] = (rest[m + j] - factor * c) % PRIME
        rest = rest[len(f) - len(g) + 1 :]
        while rest and not rest[0]:
            rest.pop(0)
        f, g = g, rest
    return len(f) == 1
