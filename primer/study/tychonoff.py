"""Tychonoff's solution: the heat equation on the whole line from u = 0, and not 0. Hadamard's second condition, broken.

With g(t) = exp(-1/t^2)::

    u(x, t) = sum over k of g^(k)(t) x^(2k) / (2k)!

solves u_t = u_xx for all real x and t > 0, term by term, and tends to 0 as t -> 0+ at every x. No M e^{a x^2} bounds it
for all x and 0 < t < T: among solutions that have such a bound, as on a circle or in BC^k, there is one only.
Source: A. Tychonoff, Mat. Sbornik 42 (1935); F. John, *Partial Differential Equations*, section 7.1.
"""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
from numpy.typing import ArrayLike

from primer.checks import broadcast, real_array

_TOLERANCE = 1e-17  # of the sum, absolutely
_MOST = 300.0  # of 2 x^2/t: beyond it the sum takes too long


def tychonoff(x: ArrayLike, t: ArrayLike) -> np.ndarray:
    """u(x, t), of the broadcast shape of x and t > 0, summed in as many digits as its terms need.

    The k-th term is at most y^k/k! e^{-1/(2 t^2)}, y = 2 x^2/t, by Cauchy's estimate of g^(k) on |z - t| = t/4.

    Raises
    ------
    ValueError    if t is not > 0, or 2 x^2/t is beyond 300

    >>> print(f"{tychonoff(0.0, 0.5):.6f} {math.exp(-4):.6f}")
    0.018316 0.018316
    """
    x, t = broadcast(x=real_array("x", x), t=real_array("t", t))
    if not (t > 0).all():
        raise ValueError(f"t must be > 0, got {float(t.min()):g}")
    worst = float((2 * x**2 / t).max(initial=0.0))
    if not worst <= _MOST:
        raise ValueError(f"x and t must be such that 2 x^2/t <= {_MOST:g}, got {worst:g}")
    return np.vectorize(_one, otypes=[float])(x, t)


def _one(x, t):
    y = 2 * x * x / t
    terms = max(8, math.ceil(2 * y))
    while terms * math.log(max(y, 1e-300)) - math.lgamma(terms + 1) > math.log(_TOLERANCE / 2) + 0.5 / t**2:
        terms += 8
    with mp.workdps(30 + math.ceil(2 * y)):
        square, s, total, power = mp.mpf(x) ** 2, 1 / mp.mpf(t), mp.mpf(0), mp.mpf(1)
        for k, coefficients in enumerate(_derivatives(terms)):
            total += mp.polyval(coefficients[::-1], s) * power
            power *= square / ((2 * k + 1) * (2 * k + 2))
        return float(total * mp.exp(-s * s))


_KNOWN = [[1]]


def _derivatives(count):
    """P_0, P_1, ..., whole coefficients from the lowest on: g^(k)(t) = P_k(1/t) g(t), P' being taken in s = 1/t.

    dt = -ds/s^2 and g' = 2 s^3 g, so P_{k+1} = 2 s^3 P_k - s^2 P_k'.
    """
    while len(_KNOWN) < count:
        last = _KNOWN[-1]
        new = [0] * (len(last) + 3)
        for power, c in enumerate(last):
            new[power + 3] += 2 * c
            new[power + 1] -= power * c
        _KNOWN.append(new)
    return _KNOWN[:count]
