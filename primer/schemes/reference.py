"""The accurate reference for the toy system: an answer with an error bar, or a refusal."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from decimal import ROUND_FLOOR, Context
from functools import lru_cache, partial
from typing import Any

import numpy as np

from primer.checks import instance, real, real_array, shown
from primer.problems.pde import PDE
from primer.problems.toy import Toy
from primer.schemes.fourier import FOURIER, interpolate, transfer
from primer.schemes.grid import Grid
from primer.schemes.horizon import PastHorizon
from primer.schemes.lines import MAX_STEPS, stable_step, trace
from primer.schemes.positive import certain, least
from primer.schemes.runge_kutta import RK8
from primer.schemes.solution import solve
from primer.schemes.stiff import stiff_attempt
from primer.types import ArrayLike

# Points tried in turn, each judged by the next. Multiples of 8 fill vector registers.
_POINTS = (8, 16, 24, 32, 48, 64, 96, 128)
# Measured at eps = 0: a step of 0.4 costs an error of at most 3.2e-11, which goes with the eighth power of the step.
_STEP, _STEP_TOL = 0.4, 1e-10
_MORE_STEPS = 1.3  # of the second march: an eighth of the first one's error in time
_SAFETY = 2  # by which the difference of the two marches is multiplied
_ROUND_OFF = 32 * np.finfo(float).eps  # times |a| + 2: about four times the largest error that was all round-off
_STIFF, _OVERHEAD, _FAR = 1e7, 300, 1e3  # steps times (points squared and a bit), some 30 ms: then LSODA, up to t, |a|
_ROUGH, _ROUGH_TOL = 3, 1e-9  # a rung of 32 points
_TIMES = 10**5  # at which the fields of both marches fit into a gigabyte
_PATIENCE = 1e8  # steps times points squared, some seconds: past this the first u = 0 is not asked for more exactly
_LOOK_AHEAD = 4.0  # time up to which it is asked when u first touches 0: it swings lowest at t = 3
_NEVER = 1.25  # u >= a - 1.1911 at eps = 0, and diffusion takes from the swing: from this a on it is not asked


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
    horizon     the time up to which there is an answer: the last of t; or, where u comes to touch 0 (looked for up to
                t = 4, or the last of t if that is later), that time, less its error bar

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


def reference(toy: Toy | PDE, t: ArrayLike, tol: float = 1e-10, progress: bool = True) -> Any:
    """The solution of the toy system at the times t with an error of at most about ``tol``, or a refusal.

    Fourier collocation in space and the step ``RK8`` in time; or LSODA, where diffusion makes explicit steps many. The
    march is made twice, the second time with at least a third more points and three tenths more steps (LSODA: a third
    of the tolerance); their difference, times 2 (4, and the tolerance with it), estimates the error of the first, which
    is the answer. Round-off adds 32 units in the last place of |a| + 2. Points are added until this is below tol.

    For eps > 0 all this is for times up to which u >= 0 everywhere, and no longer. As soon as u < 0 somewhere, wave k
    grows there like e^{eps k^2 |u| t}, while the solution's coefficients fall only exponentially with k: for k large
    enough the growth wins, however soon after. Two grids too coarse to hold such waves agree as well as ever, on
    something that is no solution: the paper's scheme without any round-off (``exact_march``) blows up, the sooner the
    finer the grid. At eps = 0 there is no such limit; the solution is eq. (toy-sln).

    Parameters
    ----------
    toy : Toy      the problem; or a ``PDE``, for which the answer is a ``Solution`` of :mod:`primer.schemes.solution`:
                   two grids in agreement, and growth rates that stay bounded along the way, or a refusal
    t              a time or a sequence of times >= 0, in any order, repeated or not
    tol : float    the largest error of u and v asked for, 128 units in the last place of |a| + 2 at least, below 1
    progress       whether to show a progress bar for each march of more than two seconds, on a terminal

    Returns
    -------
    Reference

    Raises
    ------
    PastHorizon              if one of the times lies past the first u = 0 (less the error bar of that time), or if no
                             answer within tol can be had; at ``.horizon`` one can
    TypeError, ValueError    in one sentence, for an argument that is not allowed, or a march of more than 10^7 steps

    >>> toy = Toy(1.5, eps=0)
    >>> truth = reference(toy, 2.0)
    >>> bool(np.abs(truth.u - toy.exact(truth.x, 2.0)[0]).max() < 1e-10)  # eq. (toy-sln)
    True
    """
    if isinstance(toy, PDE):
        return solve(toy, _times(t), real("tol", tol, above=0, below=1), progress)
    instance("toy", toy, Toy)
    t = _times(t)
    tol = real("tol", tol, above=0, below=1)
    if tol < 4 * _round_off(toy):
        raise ValueError(f"tol must be >= {4 * _round_off(toy):.1e} for a = {toy.a:g} in double precision, got {tol!r}")
    times, place = (t, slice(None)) if t.size == 1 else np.unique(t, return_inverse=True)
    end, touch = times[-1], math.inf
    if toy.eps > 0 and toy.a < _NEVER:
        touch = _touch(toy, max(_LOOK_AHEAD, end))
        if end > touch:
            raise _past(toy, end, tol, touch, _WHY)
    states, error, good, below = _best(toy, times, tol, progress)
    if below and toy.eps > 0 and toy.a >= _NEVER and end > (touch := _touch(toy, end)):
        raise _past(toy, end, tol, touch, _WHY)
    if good < len(times):
        raise _past(toy, end, tol, times[good - 1] if good else 0.0, "the spectrum is too long for 128 points")
    u, v = states[:, 0][place], states[:, 1][place]
    return Reference(toy, tol, Grid(u.shape[-1]).x, t, u, v, error[place], float(touch if touch < math.inf else end))


_WHY = (
    "u first touches 0, where the equations become ill posed: past that time it is not known that there is a solution"
)


def _times(t: ArrayLike) -> np.ndarray:
    times = np.atleast_1d(real_array("t", t)).astype(float)  # a copy
    if times.size > _TIMES:
        raise ValueError(f"t must be at most {_TIMES} times, got {times.size}")
    if times.ndim != 1 or times.size == 0 or times.min() < 0:
        raise ValueError(f"t must be a time >= 0 or a non-empty sequence of them, got {shown(times)}")
    return times


def _past(toy, t, tol, candidate, why):
    """The refusal, whose horizon is rounded down to what is printed and then held to be accepted itself."""
    horizon = float(Context(prec=6, rounding=ROUND_FLOOR).create_decimal(float(candidate)))
    while horizon > 0 and _best(toy, np.array([horizon]), tol)[2] != 1:
        horizon *= 0.9
    return PastHorizon(
        f"t must be <= {horizon!r}, the horizon of {toy} at tol = {tol:g}, got {t:.6g}: there {why}", horizon
    )


@lru_cache(maxsize=256)
def _touch(toy, until):
    """The time up to which u > 0 for certain, by the grid that can tell longest; infinite if that is ``until``."""
    if toy.a <= 0:
        return 0.0
    reached, tol = 0.0, 4 * _round_off(toy)

    def margin(times, rung, tol=tol):
        states, error, _ = _attempt(toy, times, tol, rung)
        return np.nan_to_num(least(states[:, 0]) - error, nan=-1.0, posinf=-1.0, neginf=-1.0)

    if certain(partial(margin, rung=_ROUGH, tol=_ROUGH_TOL), until) == until:  # far from 0 there is no need for digits
        return math.inf
    for rung in range(1, len(_POINTS) - 1):
        before, reached = reached, max(reached, certain(partial(margin, rung=rung), until))
        if reached == until:
            return math.inf
        n = _POINTS[min(rung + 2, len(_POINTS) - 1)]
        if 0 < before >= reached * (1 - 1e-8) or reached / _step(toy, tol, n) * n * n > _PATIENCE:
            break
    return reached


def _best(toy, times, tol, progress=False):
    """(states, error, how many times are good, whether u < 0 was met), with as many points as it takes."""
    most, first = 0, _first(tol)
    for way in ({}, {"stiff": False}):  # what LSODA cannot do is left to short steps
        for rung in range(first, len(_POINTS) - 1):
            states, error, below = _attempt(toy, times, tol / 4 ** (rung - first), rung, progress, **way)
            most = max(most, _good(error, tol))
            if most == len(times):
                return states, error, most, below
        if _work(toy, times[-1], tol, first) <= _STIFF:
            break
    return states, error, most, below


def _first(tol):
    """The rung to begin with: 8 points hold a spectrum that decays to 1e-6 or so, 16 points one to 1e-10 and beyond."""
    return 0 if tol >= 1e-7 else 1


def _good(error, tol):
    """How many times from the first on have an error of at most tol."""
    bad = np.flatnonzero(~(error <= tol))
    return bad[0] if bad.size else error.size


def _round_off(toy):
    return _ROUND_OFF * (abs(toy.a) + 2)


def _attempt(toy, times, tol, rung, progress=False, stiff=True):
    """(states (m, 2, n), error (m,), whether u < 0) at ascending times, on a rung's n points, judged by the next."""
    n, finer = _POINTS[rung], _POINTS[rung + 1]
    step, finer_step = _step(toy, tol, n), _step(toy, tol, finer)
    stiff = stiff and max(times[-1], abs(toy.a)) <= _FAR and _work(toy, times[-1], tol, rung) > _STIFF
    if stiff and (found := stiff_attempt(toy, n, finer, times, tol)):
        return found[0], found[1] + _round_off(toy), found[2]
    if times[-1] > MAX_STEPS * finer_step:
        raise ValueError(f"t must be <= {MAX_STEPS * finer_step:.3g}, {MAX_STEPS} steps for {toy}, got {times[-1]:g}")
    gaps = times.copy()
    gaps[1:] -= times[:-1]
    few = np.ceil(gaps / step)
    many = np.maximum(np.ceil(_MORE_STEPS * few), np.ceil(gaps / finer_step))
    states, _ = _trace(toy, n, gaps, few, progress)
    judge, depth = _trace(toy, finer, gaps, many, progress)
    apart = np.abs(states @ transfer(n, finer) - judge).max(axis=(1, 2))
    return states, _SAFETY * apart + _round_off(toy), depth[-1] != 0


def _work(toy, t, tol, rung):
    """Of the two explicit marches to time t: steps times points squared, and a bit."""
    return sum(t / _step(toy, tol, n) * (n * n + _OVERHEAD) for n in _POINTS[rung : rung + 2])


def _trace(toy, n, gaps, counts, progress):
    return trace(toy, n, FOURIER, RK8, gaps / np.maximum(counts, 1), counts.astype(np.int64), progress)


def _step(toy, tol, n):
    """The step for n points: within the region of stability, and accurate to tol."""
    return min(stable_step(toy, n, FOURIER, RK8), _STEP * (tol / _STEP_TOL) ** (1 / RK8.order))
