"""What an equation does on finer and finer grids, with a step that is not to blame.

Refinement alone reads like ill-posedness when only the step is too large for the finer grids. So each grid is marched
by RK4 with a step taken from the equations frozen at what the run visits, and a run that is lost is marched again with
half of it: only what stays lost is laid to the equations on that grid.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from primer.checks import instance, real, sequence, shown
from primer.problems.pde import PDE
from primer.schemes.fourier import interpolate
from primer.schemes.grid import CENTRAL, grids
from primer.schemes.lines import trace
from primer.schemes.marching import grid_of
from primer.schemes.runge_kutta import RK4

FRAMES = 40  # times at which the grids are compared, after t = 0
WORK = 10**10  # points times steps on the finest grid: some minutes
LOST = 1e3  # times the size of the data: growth at which a run counts as lost
_SHARE = 0.4  # of the half disc in which RK4 is stable, for the fastest frozen wave
_WAVES, _POINTS = 16, 16  # about so many wavenumbers and points are frozen; _SHARE leaves room between them
_ALIKE = 0.1  # relative difference of the times of two losses, below which half the step changed nothing
_HALVINGS = 3


@dataclass(frozen=True, eq=False)
class GridComparison:
    """The outcome of :func:`compare_grids` on k grids, the coarsest first; everything is dimensionless.

    Attributes
    ----------
    problem
    n, dt         (k,) points and steps
    t             (m,) times, t[0] = 0
    x             k grids, each (n,)
    states        k arrays (m, fields, n); NaN from where a run was lost
    dist          (k, m) Dist of eq. (90) (toy-err), from the steady state or the initial data (``problem.dist_from``)
    gap           (k - 1, m) largest difference of successive grids, on the points of the coarser one
    lost          (k,) the first of t by which a run has grown to 1000 times its data and more; infinite if none
    by_scheme     (k,) whether half the step, and half again, kept moving that time: then the step is to blame after all
    """

    problem: PDE
    n: np.ndarray
    dt: np.ndarray
    t: np.ndarray = field(repr=False)
    x: tuple[np.ndarray, ...] = field(repr=False)
    states: tuple[np.ndarray, ...] = field(repr=False)
    dist: np.ndarray = field(repr=False)
    gap: np.ndarray = field(repr=False)
    lost: np.ndarray
    by_scheme: np.ndarray

    @property
    def last_shared(self) -> int:
        """The last of the times at which all grids have a state."""
        return int(np.flatnonzero(np.isfinite(self.dist).all(axis=0))[-1])

    @property
    def order(self) -> float:
        """With which power of the spacing the last two gaps fall, at ``last_shared``: 2 where the grids converge.

        nan where that cannot be told: fewer than three grids, or not each as many times as fine as the one before, or
        differences at rounding level.
        """
        if len(self.n) < 3 or self.n[-1] * self.n[-3] != self.n[-2] ** 2:
            return math.nan
        coarse, fine = self.gap[-2:, self.last_shared]
        size = 1 + max(np.abs(states[self.last_shared]).max() for states in self.states)
        return math.log(coarse / fine) / math.log(self.n[-1] / self.n[-2]) if fine > 1e-12 * size else math.nan


def compare_grids(problem: PDE, ns: Iterable[int], t_end: float, work: float = WORK) -> GridComparison:
    """March ``problem`` to t_end on each of the grids ``ns`` by central differences of second order and RK4.

    Parameters
    ----------
    problem       a ``PDE``
    ns            grids of at least 4 points, each finer than the one before, such as [64, 128, 256]
    t_end         the end, t_end > 0
    work          points times steps that a grid may take; where t_end would take more, that is said at once

    Raises
    ------
    TypeError, ValueError    in one sentence

    The refinement at the end of section A2.2.2, for any equation.

    >>> heat = PDE("u_t = u_xx", {"u": "sin(x)"})
    >>> found = compare_grids(heat, [16, 32, 64], 1.0)
    >>> print(f"{found.order:.1f}", found.lost)
    2.0 [inf inf inf]
    >>> back = compare_grids(PDE("u_t = -u_xx", {"u": "exp(cos(x))"}), [16, 32, 64], 2.0)
    >>> print(back.lost[0] > back.lost[1] > back.lost[2], back.by_scheme.any())  # the finer the sooner
    True False
    """
    instance("problem", problem, PDE)
    ns, t_end = grids("ns", sequence("ns", ns, "grids, such as [64, 128, 256]")), real("t_end", t_end, above=0)
    if not ns or any(fine <= coarse for coarse, fine in pairwise(ns)):
        raise ValueError(f"ns must be one grid or more, each finer than the one before, got {shown(ns)}")
    t = np.linspace(0.0, t_end, FRAMES + 1)
    states, dt, lost, by_scheme = zip(*(_march(problem, n, t, work) for n in ns), strict=True)
    return GridComparison(
        problem=problem,
        n=np.array(ns),
        dt=np.array(dt),
        t=t,
        x=tuple(grid_of(problem, n).x for n in ns),
        states=states,
        dist=np.array([_dist(problem, fields) for fields in states]),
        gap=np.array([_gap(coarse, fine) for coarse, fine in pairwise(states)]).reshape(-1, t.size),
        lost=np.array(lost),
        by_scheme=np.array(by_scheme),
    )


def _gap(coarse, fine):
    """(m,) the largest difference on the points of the coarser grid, where the finer one is interpolated if need be."""
    n, times = coarse.shape[-1], fine.shape[-1] // coarse.shape[-1]
    if times * n == fine.shape[-1]:
        seen = fine[..., ::times]
    else:
        x = 2 * np.pi * np.arange(n) / n - np.pi
        seen = interpolate(fine.real, x) + (1j * interpolate(fine.imag, x) if np.iscomplexobj(fine) else 0)
    return np.abs(coarse - seen).max(axis=(1, 2))


def _march(problem, n, t, work):
    """(states, dt, time of loss, whether the step is to blame) on one grid."""
    x = grid_of(problem, n).x
    start = np.array(problem.initial(x))
    dt = _SHARE * RK4.reach / _fastest(problem, x, start, 0.0)
    states, dt = _to_the_end(problem, n, t, dt, work)
    lost = _lost(states, t)
    for _ in range(_HALVINGS):
        # What was visited may be faster than the data. Near a blow-up everything is: there half the step decides.
        good = np.flatnonzero(t < lost)
        visited = max(_fastest(problem, x, states[m], t[m]) for m in good[:: max(1, good.size // 3)])
        fits = dt * visited <= RK4.reach
        if lost == math.inf and fits:
            return states, dt, lost, False
        states, dt = _to_the_end(problem, n, t, min(dt / 2, _SHARE * RK4.reach / visited), work)
        before, lost = lost, _lost(states, t)
        if lost == before or abs(lost - before) <= _ALIKE * before:
            return states, dt, lost, False
    return states, dt, lost, lost < math.inf


def _to_the_end(problem, n, t, dt, work):
    each = max(1, math.ceil(t[1] / dt))
    if each * (t.size - 1) * n > work:
        longest = work * dt / n
        raise ValueError(
            f"t_end must be at most {longest:.2g} with {n} points "
            f"(the step that the equations allow there is {dt:.2g}, and more steps take too long), "
            f"got {shown(float(t[-1]))}"
        )
    counts = np.full(t.size - 1, each)
    steps = np.full(t.size - 1, t[1] / each)
    states, _ = trace(problem, n, CENTRAL, RK4, steps, counts)
    first = np.array(problem.initial(grid_of(problem, n).x), dtype=states.dtype)
    states = np.concatenate([first[None], states])
    size = 1 + np.abs(first).max()
    with np.errstate(invalid="ignore"):
        states[~(np.abs(states).max(axis=(1, 2)) <= LOST * size)] = np.nan
    gone = np.flatnonzero(np.isnan(states[:, 0, 0]))
    if gone.size:
        states[gone[0] :] = np.nan
    return states, t[1] / each


def _lost(states, t):
    gone = np.flatnonzero(np.isnan(states[:, 0, 0]))
    return float(t[gone[0]]) if gone.size else math.inf


def _fastest(problem, x, state, t):
    """The largest |lambda| of waves on the equations frozen at points of a state."""
    h, n = x[1] - x[0], x.size
    k = np.unique(np.linspace(0, n // 2, _WAVES).round())
    xi = 2 * math.pi / (n * h) * (np.concatenate([k, -k[1:]]) if problem.is_complex else k)

    def derivative(f, m):
        return CENTRAL[m](f, h)

    with np.errstate(all="ignore"):
        about = problem.linearised(x, state, derivative, None, t)
        matrix = about.symbol(lambda m: CENTRAL[m].multiplier(xi, h)[:, None], derivative)
    matrix = matrix[:, :: max(1, matrix.shape[1] // _POINTS)]
    if not np.isfinite(matrix).all():
        raise ValueError(
            "initial must be a state about which the equations can be linearised; here a slope is infinite"
        )
    return max(float(np.abs(np.linalg.eigvals(matrix)).max()), 1e-300)


def _dist(problem, states):
    n = states.shape[-1]
    away = states - np.array(problem.steady(grid_of(problem, n).x))
    return np.sqrt((np.abs(away) ** 2).sum(axis=1).max(axis=-1))
