"""The compiled time loops of the toy system. Importing this module imports numba.

Ghost cells instead of wrap-around indices, so that the loops over the grid become vector instructions; no fastmath and
no contraction, so that the bits are those of the NumPy transcription.

A run must know the first step with u <= 0 and the first with Dist > blow_up_at, but looking at every point of every
step would cost as much as a third of the step. So a look at the whole state (``_look``) says for how many steps
neither can happen as long as |v| stays under a ceiling, since a step moves u by dt |v_x| <= dt |v|/h; the sweep
watches that ceiling alone.
"""

import zlib

import numba
import numpy as np

from primer.compiled import jit
from primer.problems.toy import tendency

_tendency = numba.njit(tendency, inline="always")
# Numba's disk cache watches this file only. A changed equation changes this number, hence the cache's key.
_EQUATION = np.int64(zlib.crc32(tendency.__code__.co_code + repr(tendency.__code__.co_consts).encode()))


@numba.njit(inline="always")
def _step(u_left, u, u_right, v_left, v, v_right, sin_x, r1, r2, dt, eps):
    """(u, v) one step later at one point, in the order of operations of ``primer.ftcs``."""
    u_x = (u_right - u_left) * r1
    v_x = (v_right - v_left) * r1
    v_xx = (v_right - (v + v) + v_left) * r2
    u_t, v_t = _tendency(u, v, u_x, v_x, v_xx, sin_x, eps)
    return u + dt * u_t, v + dt * v_t


@numba.njit(inline="always")
def _look(u, v, u_inf, m, r1, dt, far, drift, step, every, clock, dist2, u_min, shot_steps, shots):
    """Bring member m's clock, records and snapshots up to ``step``; return (the step to look at next, ceiling of |v|).

    u, v, u_inf are the member's own (n,) points; a member that has blown up leaves its state in ``shots[-1]``.
    """
    largest, least, top_u, top_v, away, inside = far - far, u[0], far - far, far - far, True, True
    for j in range(u.size):
        du = u[j] - u_inf[j]
        d2 = du * du + v[j] * v[j]
        largest, least = max(largest, d2), min(least, u[j])
        top_u, top_v = max(top_u, abs(du)), max(top_v, abs(v[j]))
        away &= u[j] > 0
        inside &= d2 <= far * far
    clock[0, m] = step
    if not away and clock[1, m] < 0:
        clock[1, m] = step
    if step % every == 0:
        dist2[step // every, m], u_min[step // every, m] = largest, least
    while clock[3, m] < shot_steps.size and shot_steps[clock[3, m]] == step:
        shots[clock[3, m], 0, :, m], shots[clock[3, m], 1, :, m] = u, v
        clock[3, m] += 1
    if not inside:
        clock[2, m] = 1
        shots[-1, 0, :, m], shots[-1, 1, :, m] = u, v
    ceiling = top_v + top_v + drift
    room = far / 2 - top_u if 2 * ceiling < far else far - far
    if clock[1, m] < 0:
        room = min(room, least)
    # Rounding at most doubles a step of dt |v_x| <= 2 r1 dt ceiling: 0.4 of the room is safe.
    look_at = min(step + 1 + int(min(0.4 * max(room, 0) / (2 * r1 * dt * ceiling), 1e9)), step - step % every + every)
    if clock[3, m] < shot_steps.size:
        look_at = min(look_at, shot_steps[clock[3, m]])
    return look_at, ceiling


def _compile(equation, members):
    @jit
    def march(w, sin_x, u_inf, r1, r2, dt, eps, far, drift, clock, until, every, dist2, u_min, shot_steps, shots):
        """Advance ``members`` systems side by side to step ``until``, or until all have blown up (Dist > far).

        Members are innermost: neighbours in x are ``members`` cells apart. They differ in their data and their eps.

        w                (2, 2, (n + 2) * members) two buffers of (u, v) with ghost cells; step k is in buffer k % 2
        sin_x, u_inf     ((n + 2) * members,) sin x and the steady u (the steady v is 0)
        eps              ((n + 2) * members,)
        r1, r2           1/(2h) and 1/h^2
        drift            some |v| far below ``far``, so that noise about 0 is not looked at each time it doubles
        clock            (4, members): step, first step with u <= 0 or -1, 1 once blown up, snapshots taken
        dist2, u_min     (records, members) Dist^2 and min u at every ``every``-th step
        shots            (s + 1, 2, n, members) states at shot_steps, and behind them those of members that blew up
        """
        _ = equation  # a part of the cache's key, and nothing else
        cells = w.shape[2] - 2 * members
        step = clock[0].max()
        eps_0 = eps[0]
        look_at, ceiling = step, far - far
        running = clock[2].min() == 0
        while step < until and running:
            # Taken from w anew each step: swapped names would keep the sweep from becoming vector instructions.
            u, v = w[step % 2, 0], w[step % 2, 1]
            u_new, v_new = w[1 - step % 2, 0], w[1 - step % 2, 1]
            for m in range(members):
                u[m], u[cells + members + m] = u[cells + m], u[members + m]
                v[m], v[cells + members + m] = v[cells + m], v[members + m]
            calm = True
            for i in range(cells):
                k = i + members  # an index k - members, which might be negative, would do the same harm
                u_k, v_k = _step(
                    u[i], u[k], u[k + members], v[i], v[k], v[k + members],
                    sin_x[k], r1, r2, dt, eps_0 if members == 1 else eps[k],
                )  # fmt: skip
                u_new[k], v_new[k] = u_k, v_k
                calm &= abs(v_k) <= ceiling
            step += 1
            if calm and step < look_at:
                continue
            look_at, ceiling, running = until, far - far, False
            for m in range(members):
                mine = slice(members + m, cells + members, members)
                u_m, v_m = u_new[mine], v_new[mine]
                if clock[2, m] == 0:
                    then, top_v = _look(
                        u_m, v_m, u_inf[mine], m, r1, dt, far, drift, step,
                        every, clock, dist2, u_min, shot_steps, shots,
                    )  # fmt: skip
                    look_at, ceiling = min(look_at, then), max(ceiling, top_v)
                if clock[2, m] == 0:
                    running = True
                else:  # put to rest, at its steady state with eps = 0
                    u_m[:], v_m[:], eps[mine] = u_inf[mine], far - far, far - far

    return march


#: The loop for one system and for a block of eight: the neighbours' distance must be known to the compiler.
MARCH = {members: _compile(_EQUATION, members) for members in (1, 8)}
