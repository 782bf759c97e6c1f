"""One equation of the second order in any number of variables: lambda = -xi'A xi + i b.xi + c, exactly.

Convection-diffusion, or a price that depends on several factors: well posed if and only if A has no negative
eigenvalue. Then the supremum is Re c, at xi = 0.
"""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath as mp

from primer.analysis.outcome import Kind, Verdict
from primer.analysis.puiseux import Law
from primer.analysis.roots import DIGITS, ZERO


def quadratic(symbol) -> Verdict | None:
    """The verdict on a symbol whose determinant is linear in lambda and of the second order in xi; None on others."""
    with mp.workdps(DIGITS):
        found = _form(symbol)
        if found is None:
            return None
        A, c = found
        values, vectors = mp.eigsy(A)
        low = min(range(A.rows), key=lambda j: values[j])
        size = max(abs(v) for v in values)
        least = values[low] if abs(values[low]) > ZERO * size else mp.mpf(0)
        direction = tuple(float(x) + 0.0 for x in vectors[:, low])
        least, c = float(least), float(c)
    law = Law(Fraction(2), -least) if least else Law(Fraction(0), c)
    if least < 0:
        where = f"in the direction ({', '.join(f'{x:.4g}' for x in direction)})"
        reason = f"{law} as |xi| -> infinity {where}: the shorter the wave the faster it grows, without bound."
        return Verdict(Kind.ILL_POSED, law.exponent, law.coefficient, direction, math.inf, True, reason, math.inf)
    what = "Growth is bounded by" if c > 0 else "No perturbation grows: Re lambda <="
    reason = f"{what} {c:.6g} (for short waves {law}): the form of second derivatives has no negative eigenvalue."
    return Verdict(Kind.WELL_POSED, law.exponent, law.coefficient, direction, c, c > 0, reason, Fraction(0))


def _form(symbol):
    """(A, Re c), real, or None where the determinant is no such form."""
    D = symbol.determinant
    top = {powers: a for powers, a in D.items() if powers[0]}
    zero = (0,) * symbol.dim
    if set(top) != {(1, *zero)} or max(sum(powers[1:]) for powers in D) != 2 or len(symbol.entries) > 1:
        return None
    A, c = mp.matrix(symbol.dim, symbol.dim), mp.mpf(0)
    for (n, *orders), a in D.items():
        rate = -a / top[1, *zero]  # lambda = the sum of rate xi^orders
        if n or (sum(orders) == 1 and abs(mp.re(rate)) <= ZERO * abs(rate)):
            continue
        if not sum(orders):
            c = mp.re(rate)
        elif sum(orders) == 1:
            return None
        else:
            p, q = [j for j, m in enumerate(orders) for _ in range(m)]
            A[p, q] -= mp.re(rate) / 2
            A[q, p] -= mp.re(rate) / 2
    return A, c
