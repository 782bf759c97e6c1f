"""The accurate reference for the toy system: an answer with an error bar, or a refusal."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import numpy as np

from primer.checks import instance, real, real_array, shown
from primer.problems.pde import PDE
from primer.problems.toy import Toy
from primer.schemes.fourier import FOURIER, interpolate, transfer
from primer.schemes.grid import Grid
from primer.schemes.lines import MAX_STEPS, stable_step, trace
from primer.schemes.runge_kutta import RK8
from primer.schemes.solution import NoAnswer, solve
from primer.types import ArrayLike

# Grid points tried in turn, each judged by the next. Multiples of 8 fill a processor's vector registers.
_POINTS = (8, 16, 24, 32, 48, 64, 96, 128)
# Measured at eps = 0: a step of 0.4 costs an error of at most 3.2e-11, which goes with the eighth power of the step.
_STEP, _STEP_TOL = 0.4, 1e-10
_MORE_STEPS = 1.3  # of the second march: an eighth of the first one's error in time
_SAFETY = 2  # by which the difference of the two marches is multiplied
_ROUND_OFF = 32 * np.finfo(float).eps  # times |a| + 2: about four times the largest error that was all round-off
_TIMES = 10**5  # at which the fields of both marches fit into a gigabyte
_LOOK_AHEAD = 100.0  # time (the paper's longest) up to which an ill-posed case is searched for its horizon


class PastHorizon(ArithmeticError):
    """There is no trustworthy answer at the time asked for; ``horizon`` is the time up to which there is one.

    Where u < 0 in eq. (toy-pde) the answer is lost sooner or later, Hadamard's third condition (A2.1).

    >>> from primer import Toy, reference
    >>> try:
    ...     reference(Toy(-1.0), 50.0)
    ... except PastHorizon as refusal:
    ...     print(refusal.horizon < 50)
    True
    """

    def __init__(self, message: str, horizon: float) -> None:
        super().__init__(message, horizon)
        self.horizon = horizon

    def __str__(self) -> str:
        return self.args[0]


@dataclass(frozen=True, eq=False)
class Reference:
    """What :func:`reference` stands behind. Everything is dimensionless; arrays are read-only.

    Attributes
    ----------
    toy, tol    the problem and the tolerance asked for
    x           (n,) the grid -pi + 2 pi j/n
    t           (m,) the times, as they were given
    u, v        (m, n) the fields
    error       (m,) estimates of the largest error of u and v at each time
    horizon     the time up to which the answer was found to hold: the last of t; or, where u < 0 makes the equations
                ill posed, as far as it goes (looked for up to t = 100, or the last of t if that is later)

    The solution of eq. (toy-pde), with an error bar.

    >>> from primer import Toy, reference
    >>> truth = reference(Toy(1.5), [1.0, 5.0])
    >>> u, v = truth.at(0.0)
    >>> print(u.round(6), bool((truth.error < truth.tol).all()))
    [0.895594 0.468617] True
    """

    toy: Toy
    tol: float
    x: np.ndarray = field(repr=False)
    t: np.ndarray = field(repr=False)
    u: np.ndarray = field(repr=False)
    v: np.ndarray = field(repr=False)
    error: np.ndarray = field(repr=False)
    horizon: float

    def __post_init__(self) -> None:
        for array in (self.x, self.t, self.u, self.v, self.error):
            array.flags.writeable = False

    def at(self, x: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """(u, v) at any x, by trigonometric interpolation, each of shape (m,) + the shape of x."""
        x = real_array("x", x)
        return interpolate(self.u, x), interpolate(self.v, x)


def reference(toy: Toy | PDE, t: ArrayLike, tol: float = 1e-10) -> Any:
    """The solution of the toy system at the times t with an error of at most about ``tol``, or a refusal.

    Fourier collocation in space and the fixed step ``RK8`` in time. The march is made twice, the second time with at
    least a third more points and three tenths more steps; their difference, times 2, estimates the error of the first,
    which is the answer. Round-off adds 32 units in the last place of |a| + 2, times e^{eps k^2 S}: k = m/2 is the top
    wavenumber on the second march's m points and S(t) the integral of max(0, -min u), so that the factor is what the
    principal part of eq. (toy-mat) makes of that wave where u < 0. Points are added until the estimate is below tol,
    that is until the spectrum has decayed.

    In a well-posed case that is soon. Where u < 0, e^{eps k^2 S} grows without bound in time and, what is worse, in k:
    more points come to cost more than they bring, and there is a horizon. Past it, no array is returned.

    Parameters
    ----------
    toy : Toy      the problem; or a ``PDE``, for which the answer is a ``Solution`` of :mod:`primer.schemes.solution`:
                   two grids in agreement, and growth rates that stay bounded along the way, or a refusal
    t              a time or a sequence of times >= 0, in any order, repeated or not
    tol : float    the largest error of u and v asked for, 128 units in the last place of |a| + 2 at least, below 1

    Returns
    -------
    Reference

    Raises
    ------
    PastHorizon              if no answer within tol can be had at one of the times; ``.horizon`` says up to when it can
    TypeError, ValueError    in one sentence, for an argument that is not allowed, or a march of more than 10^7 steps

    >>> toy = Toy(1.5, eps=0)
    >>> truth = reference(toy, 2.0)
    >>> bool(np.abs(truth.u - toy.exact(truth.x, 2.0)[0]).max() < 1e-10)  # eq. (toy-sln)
    True
    """
    if isinstance(toy, PDE):
        return _of_any(toy, _times(t), real("tol", tol, above=0, below=1))
    instance("toy", toy, Toy)
    t = _times(t)
    tol = real("tol", tol, above=0, below=1)
    if tol < 4 * _round_off(toy):
        raise ValueError(f"tol must be >= {4 * _round_off(toy):.1e} for a = {toy.a:g} in double precision, got {tol!r}")
    times, place = (t, slice(None)) if t.size == 1 else np.unique(t, return_inverse=True)
    ill_posed = toy.eps > 0 and toy.a < 1  # now or later: the steady state is negative somewhere
    rung, horizon = _first(tol), 0.0
    while not ill_posed:
        states, error, depth = _attempt(toy, times, tol / 4 ** (rung - _first(tol)), rung)
        good = _good(error, tol)
        horizon = max(horizon, times[good - 1] if good else 0.0)
        ill_posed = toy.eps > 0 and depth[-1] != 0
        if good == len(times) or ill_posed:
            break
        rung += 1
        if rung == len(_POINTS) - 1:
            raise _past(toy, times[-1], tol, horizon)
    if ill_posed:
        rung, horizon = _farthest(toy, tol, max(_LOOK_AHEAD, times[-1]))
        if times[-1] > horizon:
            raise _past(toy, times[-1], tol, horizon)
        states, error, _ = _attempt(toy, times, tol / 16, rung)
    u, v = states[:, 0][place], states[:, 1][place]
    return Reference(toy, tol, Grid(u.shape[-1]).x, t, u, v, error[place], float(horizon))


def _of_any(problem, t, tol):
    try:
        return solve(problem, t, tol)
    except NoAnswer as none:
        raise PastHorizon(
            f"t must be <= {none.until:.6g} for this PDE at tol = {tol:g}, got {t.max():.6g}: {none.why}", none.until
        ) from None


def _times(t: ArrayLike) -> np.ndarray:
    times = np.atleast_1d(real_array("t", t)).astype(float)  # a copy
    if times.size > _TIMES:
        raise ValueError(f"t must be at most {_TIMES} times, got {times.size}")
    if times.ndim != 1 or times.size == 0 or times.min() < 0:
        raise ValueError(f"t must be a time >= 0 or a non-empty sequence of them, got {shown(times)}")
    return times


def _past(toy, t, tol, horizon):
    return PastHorizon(
        f"t must be <= {horizon:.6g}, the horizon of {toy} at tol = {tol:g}, got {t:.6g}: past it neither more "
        "points nor fewer give an answer to stand behind",
        float(horizon),
    )


def _first(tol):
    """The rung to begin with: 8 points hold a spectrum that decays to 1e-6 or so, 16 points one to 1e-10 and beyond."""
    return 0 if tol >= 1e-7 else 1


def _good(error, tol):
    """How many times from the first on have an error of at most tol."""
    bad = np.flatnonzero(~(error <= tol))
    return bad[0] if bad.size else error.size


def _round_off(toy):
    return _ROUND_OFF * (abs(toy.a) + 2)


def _attempt(toy, times, tol, rung):
    """(states (m, 2, n), error (m,), depth (m,)) at ascending times, on the n points of a rung, judged by the next."""
    n, finer = _POINTS[rung], _POINTS[rung + 1]
    step, finer_step = _step(toy, tol, n), _step(toy, tol, finer)
    if times[-1] > MAX_STEPS * finer_step:
        raise ValueError(f"t must be <= {MAX_STEPS * finer_step:.3g}, {MAX_STEPS} steps for {toy}, got {times[-1]:g}")
    gaps = times.copy()
    gaps[1:] -= times[:-1]
    few = np.ceil(gaps / step)
    many = np.maximum(np.ceil(_MORE_STEPS * few), np.ceil(gaps / finer_step))
    states, _ = _trace(toy, n, gaps, few)
    judge, depth = _trace(toy, finer, gaps, many)
    apart = np.abs(states @ transfer(n, finer) - judge).max(axis=(1, 2))
    hadamard = np.exp(np.minimum(toy.eps * (finer / 2) ** 2 * depth, 700.0))
    return states, _SAFETY * apart + _round_off(toy) * hadamard, depth


def _trace(toy, n, gaps, counts):
    return trace(toy, n, FOURIER, RK8, gaps / np.maximum(counts, 1), counts.astype(np.int64))


def _step(toy, tol, n):
    """The step for n points: within the region of stability, and accurate to tol."""
    return min(stable_step(toy, n, FOURIER, RK8), _STEP * (tol / _STEP_TOL) ** (1 / RK8.order))


@lru_cache(maxsize=256)
def _farthest(toy, tol, until):
    """(rung, horizon): the resolution whose answer holds longest, and how long; looked for up to ``until``."""
    best, reached = _first(tol), -1.0
    for rung in range(_first(tol), len(_POINTS) - 1):
        horizon = _holds(toy, tol, until, rung)
        if horizon > reached:
            best, reached = rung, horizon
        if horizon < reached or horizon >= until:
            break
    return best, reached


def _holds(toy, tol, until, rung):
    """Up to which time the answer of one resolution holds, to about one part in 64."""
    span = _step(toy, tol, _POINTS[rung])
    while True:
        times = np.linspace(0, span, 65)
        _, error, _ = _attempt(toy, times, tol / 16, rung)  # the step apart, which is cheap, should not decide
        good = _good(error, tol)
        if good < len(times) or span >= until:
            return float(min(times[max(good, 1) - 1], until))
        span *= 2
