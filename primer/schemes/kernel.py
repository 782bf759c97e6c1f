"""The compiled time loop of :func:`primer.ftcs` for the toy system. Importing this module imports numba.

Ghost cells instead of wrap-around indices, so that the loop over the grid becomes vector instructions; no fastmath
and no contraction, so that the bits are those of the NumPy transcription.
"""

import zlib

import numba
import numpy as np

from primer.problems.toy import tendency

_tendency = numba.njit(tendency, inline="always")
# Numba's disk cache watches this file only. A changed equation changes this number, hence the cache's key.
_EQUATION = zlib.crc32(tendency.__code__.co_code + repr(tendency.__code__.co_consts).encode())


def _compile(equation):
    @numba.njit(cache=True)
    def march(w, sin_x, u_inf, r1, r2, dt, eps, limit, clock, until, every, dist2, u_min, shot_steps, shots):
        """Advance from step clock[0] to step ``until``, or to the first step at which Dist^2 > limit.

        w            (2, 2, n + 2) two buffers of (u, v) with ghost cells; step k is in buffer k % 2
        sin_x, u_inf (n + 2,) sin x and the steady u (the steady v is 0)
        r1, r2       1/(2h) and 1/h^2
        clock        [step, first step with u <= 0 or -1, 1 once blown up, snapshots taken]
        dist2, u_min records of Dist^2 and min u at every ``every``-th step
        shots        (s, 2, n) states at shot_steps
        """
        _ = equation  # a part of the cache's key, and nothing else
        n = w.shape[2] - 2
        step = clock[0]
        u, v = w[step % 2, 0], w[step % 2, 1]
        u_new, v_new = w[1 - step % 2, 0], w[1 - step % 2, 1]
        while step < until and clock[2] == 0:
            u[0], u[n + 1], v[0], v[n + 1] = u[n], u[1], v[n], v[1]
            touches, escapes = 0, 0
            for j in range(1, n + 1):
                u_x = (u[j + 1] - u[j - 1]) * r1
                v_x = (v[j + 1] - v[j - 1]) * r1
                v_xx = (v[j + 1] - (v[j] + v[j]) + v[j - 1]) * r2
                u_t, v_t = _tendency(u[j], v[j], u_x, v_x, v_xx, sin_x[j], eps)
                u_j, v_j = u[j] + dt * u_t, v[j] + dt * v_t
                u_new[j], v_new[j] = u_j, v_j
                du = u_j - u_inf[j]
                touches |= u_j <= 0
                escapes |= not (du * du + v_j * v_j <= limit)
            step += 1
            u, u_new = u_new, u
            v, v_new = v_new, v
            if touches and clock[1] < 0:
                clock[1] = step
            if escapes:
                clock[2] = 1
            if step % every == 0:
                largest, least = dist2[0] * 0, u[1]
                for j in range(1, n + 1):
                    du = u[j] - u_inf[j]
                    largest = max(largest, du * du + v[j] * v[j])
                    least = min(least, u[j])
                dist2[step // every], u_min[step // every] = largest, least
            while clock[3] < shot_steps.size and shot_steps[clock[3]] == step:
                shots[clock[3], 0], shots[clock[3], 1] = u[1 : n + 1], v[1 : n + 1]
                clock[3] += 1
        clock[0] = step

    return march


march = _compile(np.int64(_EQUATION))
