"""An answer with an error bar for any equation that is well posed along the way, or a refusal."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from primer.checks import real_array
from primer.equations.evaluate import known
from primer.equations.slopes import linearised
from primer.schemes.fourier import FOURIER, interpolate, transfer
from primer.schemes.horizon import PastHorizon
from primer.schemes.jacobian import rates
from primer.schemes.limit import largest_step
from primer.schemes.lines import trace
from primer.schemes.marching import grid_of
from primer.schemes.runge_kutta import RK8
from primer.types import ArrayLike

_POINTS = (16, 32, 64, 128, 256, 512)  # tried in turn, each the judge of the one before
_SAFETY = 3  # by which their difference is multiplied: enough where doubling the points gains a factor of 1.5
_ROUND_OFF = 64 * np.finfo(float).eps  # of the size of the fields
_LOOKS = 16  # times along the way, beside those asked for, at which the equations are tested
_OCTAVES = 12  # above the grid's own shortest wave, over which growth must not go on
_MOST = 3 * 10**5  # steps of one march: some minutes


@dataclass(frozen=True, eq=False)
class Solution:
    """What :func:`primer.reference` stands behind for a ``PDE``. Dimensionless; arrays are read-only.

    Attributes
    ----------
    problem, tol    the problem and the tolerance asked for
    x               (n,) the grid
    t               (m,) the times, as they were given
    fields          for each field an array (m, n)
    error           (m,) estimates of the largest error of any field at each time
    """

    problem: Any
    tol: float
    x: np.ndarray = field(repr=False)
    t: np.ndarray = field(repr=False)
    fields: tuple[np.ndarray, ...] = field(repr=False)
    error: np.ndarray = field(repr=False)

    def __post_init__(self) -> None:
        for array in (self.x, self.t, *self.fields, self.error):
            array.flags.writeable = False

    def at(self, x: ArrayLike) -> tuple[np.ndarray, ...]:
        """The fields at any x, by trigonometric interpolation, each of shape (m,) + the shape of x."""
        angle = real_array("x", x) * (2 * math.pi / grid_of(self.problem, self.x.size).period)
        return tuple(
            interpolate(f.real, angle) + 1j * interpolate(f.imag, angle)
            if f.dtype.kind == "c"
            else interpolate(f, angle)
            for f in self.fields
        )


def solve(problem: Any, t: np.ndarray, tol: float, progress: bool = False) -> Solution:
    """The :class:`Solution` at the times t >= 0; with ``progress`` each march of over two seconds has a bar.

    Fourier collocation and ``RK8`` on 16, 32, ... 512 points with at most 0.7 of the stable step, until 3 times the
    difference of two successive grids is below tol; the finer one is the answer. Before that the frozen equations about
    the answer, at all times asked for and 16 between, must have growth rates that stay bounded as the wavenumber grows.

    Raises
    ------
    PastHorizon   if they do not, or if 512 points are not enough
    ValueError    if a march would take more than 300,000 steps, or the equations cannot be linearised
    """
    end = float(t.max())
    times = np.unique(np.concatenate([t, np.linspace(0, end, _LOOKS + 1)]))
    coarse, horizon = _march(problem, _POINTS[0], times, progress), 0.0
    for n in _POINTS[1:]:
        fine = _march(problem, n, times, progress)
        apart = np.abs(coarse @ transfer(coarse.shape[-1], n) - fine).max(axis=(1, 2))
        size = 1 + np.abs(fine).max(axis=(1, 2))
        error = _SAFETY * apart + _ROUND_OFF * size
        good = ~(np.cumsum(~(error <= tol)) > 0)  # up to the first that is not
        ill = [g and _ill_posed(problem, f, s) for g, f, s in zip(good, fine, times, strict=True)]
        sound = good & ~(np.cumsum(ill) > 0)
        if not sound[good].all():
            raise _past(
                times, tol, max(times[sound], default=0.0), "frozen about the solution, the equations are ill posed"
            )
        horizon = max(horizon, float(max(times[good], default=0.0)))
        if good.all():
            place = np.searchsorted(times, t)
            fields = tuple(np.ascontiguousarray(fine[place, f]) for f in range(fine.shape[1]))
            return Solution(problem, tol, grid_of(problem, n).x, t, fields, error[place])
        coarse = fine
    raise _past(times, tol, horizon, f"{_POINTS[-1]} points are not enough")


def _past(times, tol, until, why):
    return PastHorizon(
        f"t must be <= {until:.6g} for this PDE at tol = {tol:g}, got {times[-1]:g}: after that {why}", float(until)
    )


def _march(problem, n, times, progress):
    """(m, fields, n) the states at ascending times on n points; not a number where the march is lost."""
    end = times[-1]
    # Half the step for twice the points, at least, so that the difference of two grids shows the error in time too.
    step = min(0.7 * largest_step(rates(problem, n, space=FOURIER), RK8), max(end, 1e-300) * 4 / n)
    gaps = np.diff(times, prepend=0.0)
    if not (gaps / step).sum() <= _MOST:
        raise ValueError(f"t must be <= {_MOST * step:.3g}, {_MOST} steps on {n} points, got {end:g}")
    counts = np.ceil(gaps / step * (1 - 1e-12)).astype(np.int64)
    states, _ = trace(problem, n, FOURIER, RK8, gaps / np.maximum(counts, 1), counts, progress)
    return states


def _ill_posed(problem, state, t):
    """Whether growth rates go on growing with the wavenumber, with coefficients frozen at some point of the state."""
    if not problem.evolution.orders:
        return False
    n = state.shape[-1]
    grid = grid_of(problem, n)

    def derivative(f, m):
        return FOURIER[m](f, grid.h)

    given = known(problem.evolution, grid.x, problem.parameters)
    with np.errstate(all="ignore"):
        about = linearised(problem.evolution, problem.parameters, state, derivative, given, t)
        xi = math.pi / grid.h * 2.0 ** np.arange(_OCTAVES + 1)[:, None]
        lam = np.linalg.eigvals(np.nan_to_num(about.symbol(lambda m: (1j * xi) ** m, derivative)))
    growth, size = lam.real.reshape(len(xi), -1).max(axis=1), np.abs(lam).reshape(len(xi), -1).max(axis=1)
    last, middle = growth[-1], growth[len(xi) // 2]
    return last > 1e-8 * size[-1] and last > 2 * max(middle, 0.0) + 1e-6
