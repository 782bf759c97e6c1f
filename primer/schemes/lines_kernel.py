"""The compiled time loop of the method of lines for the toy system. Importing this module imports numba.

One loop serves every stencil and every Runge-Kutta table: they are its arguments. No fastmath, no contraction.
"""

import zlib

import numba
import numpy as np

from primer.compiled import jit
from primer.problems.toy import tendency

_tendency = numba.njit(tendency, inline="always")


@numba.njit
def _within(limit, u, v):
    beyond = 0  # a count, since vector instructions can add up comparisons
    for i in range(u.size):
        beyond += (not abs(u[i]) <= limit) + (not abs(v[i]) <= limit)
    return beyond == 0


# Numba's disk cache watches this file only. A changed equation changes this number, hence the cache's key.
_EQUATION = zlib.crc32(tendency.__code__.co_code + repr(tendency.__code__.co_consts).encode())


def _compile(equation):
    @jit
    def march(y, sin_x, eps, d1, d2, A, b, dt, counts, limit, states, depth):
        """Take counts[m] steps dt[m] for m = 0, 1, ..., as long as |u|, |v| <= limit at each stage of each step,
        so that no product is beyond the largest number.

        y       (2, n) the state (u, v), overwritten
        d1, d2  the derivatives: (n, n) matrices, f'_i = sum_o d[o, i] f_o, or (2 reach + 1, 1) stencils on samples g
                with ghosts, f'_i = sum_o d[o] g[o + i]
        A, b    the Runge-Kutta table
        states  (m, 2, n) filled with the states after each run of steps; those not reached are left alone
        depth   (m,) filled with the integral of max(0, -min u) to those times, by the rectangle rule
        """
        _ = equation  # a part of the cache's key, and nothing else
        stages, n = b.size, y.shape[1]
        dense = d1.shape[1] > 1
        reach = 0 if dense else d1.shape[0] // 2
        k = np.empty((stages, 2, n))
        u_ghosted, v_ghosted = np.empty(n + 2 * reach), np.empty(n + 2 * reach)
        u, v = u_ghosted[reach : reach + n], v_ghosted[reach : reach + n]
        u_x, v_x, v_xx = np.empty(n), np.empty(n), np.empty(n)
        change = np.zeros((2, n))
        deep = 0.0
        for m in range(counts.size):
            for _step in range(counts[m]):
                least = 0.0
                for i in range(n):
                    least = min(least, y[0, i])
                deep -= dt[m] * least
                for s in range(stages):
                    for i in range(n):
                        u[i], v[i] = y[0, i], y[1, i]
                        u_x[i], v_x[i], v_xx[i] = 0, 0, 0
                    for j in range(s):
                        if A[s, j] != 0:
                            c = dt[m] * A[s, j]
                            for i in range(n):
                                u[i] += c * k[j, 0, i]
                                v[i] += c * k[j, 1, i]
                    if not _within(limit, u, v):
                        return
                    if dense:
                        for o in range(n):
                            u_o, v_o = u[o] - u[0], v[o] - v[0]  # rounding leaves the rows of d1, d2 a sum of 1e-14
                            for i in range(n):
                                u_x[i] += d1[o, i] * u_o
                                v_x[i] += d1[o, i] * v_o
                                v_xx[i] += d2[o, i] * v_o
                    else:
                        u_ghosted[:reach], v_ghosted[:reach] = u[n - reach :], v[n - reach :]
                        u_ghosted[n + reach :], v_ghosted[n + reach :] = u[:reach], v[:reach]
                        for o in range(d1.shape[0]):
                            u_o, v_o, d1_o, d2_o = u_ghosted[o : o + n], v_ghosted[o : o + n], d1[o, 0], d2[o, 0]
                            for i in range(n):
                                u_x[i] += d1_o * u_o[i]
                                v_x[i] += d1_o * v_o[i]
                                v_xx[i] += d2_o * v_o[i]
                    for i in range(n):
                        k[s, 0, i], k[s, 1, i] = _tendency(u[i], v[i], u_x[i], v_x[i], v_xx[i], sin_x[i], eps)
                for s in range(stages):
                    c = dt[m] * b[s]
                    for i in range(n):
                        change[0, i] += c * k[s, 0, i]
                        change[1, i] += c * k[s, 1, i]
                # Kahan's sum: what rounding takes from y goes into the next change, so that it does not pile up in a
                # hundred thousand steps.
                for f in range(2):
                    for i in range(n):
                        was = y[f, i]
                        y[f, i] = was + change[f, i]
                        change[f, i] -= y[f, i] - was
                if not _within(limit, y[0], y[1]):
                    return
            states[m], depth[m] = y, deep

    return march


march = _compile(np.int64(_EQUATION))
