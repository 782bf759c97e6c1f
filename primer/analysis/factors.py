"""det M in factors: each has its own branches, fewer of them, and none twice.

Real equations have a determinant with real coefficients in lambda, d/dx and d/dy, and where their numbers are given as
decimals or fractions the coefficients are rational: it then has one factorisation over the rational numbers, which is
found exactly. In a mean flow the entropy, the vorticity and the sound waves of a gas are three of them.
"""

from __future__ import annotations

from fractions import Fraction

import mpmath as mp

from primer.analysis.roots import DIGITS

LARGEST = 10**45  # denominators up to this are looked for: any two such numbers differ by 1e-90
NEAR = DIGITS - 25  # digits to which a coefficient must agree with a rational number
LIMITS = (14, 60)  # degree in lambda, and number of terms, beyond which factors may take long to find

_known: dict = {}  # the last determinants asked for


def factors(D):
    """The distinct factors of a polynomial {(n, a, b): c} in lambda and xi that contain lambda, [D] if not known.

    Powers of xi may also be one or three. A factor's coefficients are determined up to one common factor.
    """
    if len(_known) > 50:
        _known.clear()
    key = tuple(sorted(D.items(), key=lambda item: item[0]))
    if key not in _known:
        _known[key] = _factors(D)
    return _known[key]


def _factors(D):
    if max(D)[0] < 2 or max(D)[0] > LIMITS[0] or len(D) > LIMITS[1]:
        return [D]
    with mp.workdps(DIGITS):
        whole = _rational(D)
        if whole is None:
            return [D]
        import sympy as sp

        names = sp.symbols(f"x:{len(max(D))}")
        P = sp.Poly.from_dict({p: sp.Rational(c.numerator, c.denominator) for p, c in whole.items()}, *names)
        found = [factor for factor, _ in P.factor_list()[1] if factor.degree(names[0])]
        if len(found) == 1 and found[0].degree(names[0]) == max(D)[0]:
            return [D]
        return [
            {p: mp.mpf(c.p) / c.q * mp.mpc(0, 1) ** sum(p[1:]) for p, c in factor.as_dict().items()} for factor in found
        ]


def _rational(D):
    """The coefficients as a polynomial in lambda and (d/dx, d/dy) = i xi, if they are rational but for one factor."""
    unit = D[max(D)] / mp.mpc(0, 1) ** sum(max(D)[1:])
    found = {}
    for powers, c in D.items():
        value = c / mp.mpc(0, 1) ** sum(powers[1:]) / unit
        size = abs(value)
        if abs(value.imag) > size * mp.mpf(10) ** -NEAR:
            return None
        man, exponent = mp.frexp(value.real)  # value = man 2^exponent
        number = Fraction(int(mp.ldexp(man, 600)), 2**600) * Fraction(2) ** int(exponent)
        near = number.limit_denominator(LARGEST)
        if not near or abs(number - near) > abs(number) / 10**NEAR:
            return None
        found[powers] = near
    return found
