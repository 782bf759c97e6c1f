"""The toy system on Fourier points where diffusion is strong: scipy's LSODA, which changes to implicit steps by itself.

An explicit step is held to 1/(eps u n^2) for ever, an implicit one grows as the solution settles. What LSODA is given
is one product with a matrix for all derivatives, and the Jacobian in closed form; and u - a in the place of u, so that
its tolerance is not lost in a large a.
"""

from __future__ import annotations

import warnings
from functools import lru_cache

import numpy as np

from primer.problems.toy import Toy
from primer.schemes.fourier import FOURIER, transfer
from primer.schemes.grid import Grid

_TOL, _LEAST = 3e-12, 5e-13  # no tighter is asked of LSODA: its rounding is too near
_SAFETY = 4  # by which the difference of two marches is multiplied: its error is no regular function of its tolerance
_STEPS = 10**6  # from one output to the next, at most
_SAMPLES = 16  # per unit of time, of u < 0; but
_MOST = 4096  # no more than these in all


@lru_cache(maxsize=16)
def _matrix(n):
    """(3n, 2n): from (u - a, v) to v_x, u_x - v and v_xx."""
    h = Grid(n).h
    first, second = (FOURIER[m](np.eye(n), h).T for m in (1, 2))
    zero = np.zeros_like(first)
    return np.block([[zero, first], [first, -np.eye(n)], [zero, second]])


def stiff_attempt(toy: Toy, n: int, finer: int, times: np.ndarray, tol: float) -> tuple | None:
    """(states (m, 2, n), error (m,), whether u < 0): the march twice, as ``reference`` has it; None if that cannot be.

    The second march has more points, and a third of the tolerance. The error is never less than the tolerance of the
    first, since two marches may agree by chance.
    """
    asked = max(tol / 30, 2 * _LEAST)
    if tol < _TOL or (loose := stiff_trace(toy, n, times, asked)) is None:
        return None
    tight = stiff_trace(toy, finer, times, max(tol / 100, _LEAST))
    if tight is None:
        return None
    apart = np.abs(loose[0] @ transfer(n, finer) - tight[0]).max(axis=(1, 2))
    return loose[0], _SAFETY * apart + np.where(times > 0, asked, 0), tight[1]


def stiff_trace(toy: Toy, n: int, times: np.ndarray, tol: float) -> tuple[np.ndarray, bool] | None:
    """(states (m, 2, n), whether u < 0 was met) at ascending times >= 0; None if LSODA gave up.

    ``tol`` is LSODA's, of each step: the error in the end is larger, and it is the caller's to find out.
    """
    from scipy.integrate import odeint

    grid = Grid(n)
    D, eps, a, sin_x = _matrix(n), toy.eps, toy.a, toy.forcing(grid.x)
    out, second = np.empty(3 * n), D[2 * n :, n:]
    top, diagonal = D[: 2 * n].copy(), np.arange(n)

    def slope(y, t):
        np.dot(D, y, out)
        rate = out[: 2 * n].copy()
        rate[n:] += eps * (y[:n] + a) * out[2 * n :] - sin_x
        return rate

    def jacobian(y, t):
        J = top.copy()
        J[n:, n:] += (eps * (y[:n] + a))[:, None] * second
        J[n + diagonal, diagonal] += eps * (second @ y[n:])
        return J

    u, v = toy.initial(grid.x)
    samples = np.linspace(0, times[-1], min(_MOST, 2 + int(_SAMPLES * times[-1])))
    asked = np.unique(np.concatenate([[0.0], times, samples]))
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        y, told = odeint(
            slope, np.concatenate([u - a, v]), asked, Dfun=jacobian, rtol=tol, atol=tol, mxstep=_STEPS, full_output=True
        )
    if told["message"] != "Integration successful." or not np.isfinite(y).all():
        return None
    below = bool((y[:, :n].min(axis=1) + a < 0).any())
    states = y[np.searchsorted(asked, times)].reshape(-1, 2, n)
    states[:, 0] += a
    return states, below
