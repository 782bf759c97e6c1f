"""The compiled loop of :mod:`primer.study.exact`. Importing this module imports numba.

A whole number is a column of limbs, the least first: each from 0 to 2^bits - 1, but for the last, which has the sign.
The bits are those of Python's whole numbers.
"""

import numba
import numpy as np

from primer.compiled import jit


@numba.njit
def _top(value):
    """The last limb, kept within what it can hold: what is beyond is beyond any bound on Dist as well."""
    return min(max(value, -(2**28)), 2**28)


def _march(U, V, K, T, S, odd, bent, bits, steps, steady, scale_u, scale_v, limit):
    """Up to ``steps`` steps, fewer if Dist^2 exceeds ``limit``; return (steps done, the first with u <= 0 or -1).

    U, V       (limbs, points) of the half grid, overwritten
    K, T       (limbs,) c^2 and dt
    S          (limbs, points) s c dt sin x
    odd        whether n is odd, so that the last point is half a step short of x = 0
    bent       whether there is a second derivative at all
    bits       of a limb
    steady     (points,) u at rest
    scale_u, scale_v    what the leading limb is worth
    """
    limbs, points = U.shape
    last, one_back = points - 1, points - 1 if odd else points - 2
    dU, dV, d2 = np.empty_like(U), np.empty_like(U), np.empty_like(U)
    rows = np.empty((2 * limbs - 1, points), dtype=np.int64)
    carry = np.empty(points, dtype=np.int64)
    mask, unit = (1 << bits) - 1, 2.0**bits
    negative = -1
    F = limbs - 1
    for step in range(steps):
        for i in range(limbs):
            u, v, du, dv, dd = U[i], V[i], dU[i], dV[i], d2[i]
            for p in range(1, last):
                du[p] = u[p + 1] - u[p - 1]
                dv[p] = v[p + 1] - v[p - 1]
                dd[p] = v[p + 1] + v[p - 1] - 2 * v[p]
            du[0], dv[0], dd[0] = 0, 2 * v[1], -2 * v[0]
            du[last] = u[one_back] - u[last - 1]
            dv[last] = -v[one_back] - v[last - 1]
            dd[last] = v[last - 1] - v[one_back] - 2 * v[last]
        rows[:] = 0
        for i in range(limbs):
            k, t, u = np.int64(K[i]), np.int64(T[i]), U[i]
            for j in range(limbs):
                row, du, v, dd = rows[i + j], dU[j], V[j], d2[j]
                if bent:
                    for p in range(points):
                        row[p] += np.int64(u[p]) * np.int64(dd[p]) + k * np.int64(du[p])
                elif k:
                    for p in range(points):
                        row[p] += k * np.int64(du[p])
                if t:
                    for p in range(points):
                        row[p] -= t * np.int64(v[p])
        carry[:] = 0
        for i in range(F):
            row = rows[i]
            for p in range(points):
                carry[p] = (row[p] + carry[p]) >> bits
        for i in range(F):
            row, v, s = rows[F + i], V[i], S[i]
            for p in range(points):
                total = row[p] + carry[p] + v[p] - s[p]
                v[p] = total & mask
                carry[p] = total >> bits
        for p in range(points):
            V[F, p] = _top(rows[2 * F, p] + carry[p] + V[F, p] - S[F, p])
        carry[:] = 0
        for i in range(F):
            u, dv = U[i], dV[i]
            for p in range(points):
                total = u[p] + dv[p] + carry[p]
                u[p] = total & mask
                carry[p] = total >> bits
        for p in range(points):
            U[F, p] = _top(carry[p] + U[F, p] + dV[F, p])
        worst, least = 0.0, np.inf
        for p in range(points):
            u, v = 0.0, 0.0
            for i in range(max(0, F - 5), F + 1):
                u, v = U[i, p] + u / unit, V[i, p] + v / unit
            u, v = u * scale_u, v * scale_v
            worst = max(worst, (u - steady[p]) ** 2 + v**2)
            least = min(least, u)
        if least <= 0 and negative < 0:
            negative = step + 1
        if not worst <= limit:
            return step + 1, negative
    return steps, negative


march = jit(_march)
