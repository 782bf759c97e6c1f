"""The step with which a method is set against others: stable, and with an error in time about that of space."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from primer.problems.toy import Toy
from primer.schemes.fourier import FOURIER
from primer.schemes.grid import CENTRAL, CENTRAL_4, CENTRAL_6, Grid
from primer.schemes.jacobian import rates
from primer.schemes.limit import largest_step
from primer.schemes.lines import Space, stable_step
from primer.schemes.marching import grid_of
from primer.schemes.runge_kutta import RungeKutta
from primer.study.stability import tame_dt

# At t = 5, a = 1.5, eps = 0.01 the toy system's error in space is c h^order or, for Fourier, 10^(-1 - 0.8 n) down to
# round-off, with h = 2 pi/n; and in time 6e-3 dt^4 or 5e-8 dt^8. Of others no more is known than that the end to
# which they are compared, t_end, sets the unit of time, and that twice the Fourier points gain a factor of 2^8.
_SPACE = ((CENTRAL, 2, 0.25), (CENTRAL_4, 4, 0.05), (CENTRAL_6, 6, 0.012))
_TIME = {4: 6e-3, 8: 5e-8}
_LONGEST = 0.6
_T_END = 5.0
_SHARE = 0.7  # of the stable step about the initial data: later states may be faster


def euler_step(problem: Any, n: int, t_end: float) -> float:
    """For the paper's scheme: h^2/4, at which the errors of space and time fall together at N = 100.

    Of another problem than the toy system t_end/5 is the unit of time, and it is no more than lets the scheme amplify
    by 1 % what does not grow of itself (:func:`primer.study.stability.tame_dt`).
    """
    dt = Grid(n).h ** 2 / 4
    return dt if isinstance(problem, Toy) else min(dt * t_end / _T_END, _kept(_tame, problem, n, t_end))


def lines_step(problem: Any, n: int, t_end: float, space: Space, time: RungeKutta) -> float:
    """For derivatives ``space`` and a step ``time`` of order 4 or 8."""
    own = isinstance(problem, Toy)
    if space is not FOURIER:
        error = next(c * Grid(n).h ** order for table, order, c in _SPACE if table is space)
    else:
        error = max(10 ** (-1 - 0.8 * n), 1e-14) if own else (4 / n) ** 8
    accurate = min(_LONGEST, (error / _TIME[time.order]) ** (1 / time.order))
    if own:
        return min(accurate, stable_step(problem, n, space, time))
    return min(accurate * t_end / _T_END, _kept(_stable, problem, n, _Table(space), time))


def _kept(function, problem, *arguments):
    """function(problem, *arguments), computed once for a problem that can be told from others."""
    try:
        hash(problem)
    except TypeError:
        function = function.__wrapped__
    return function(problem, *arguments)


@lru_cache(maxsize=256)
def _tame(problem, n, t_end):
    return tame_dt(problem, n, t_end)


@lru_cache(maxsize=256)
def _stable(problem, n, table, time):
    states = [problem.initial(grid_of(problem, n).x)]
    if getattr(problem, "dist_from", "steady") == "steady":
        states.append(problem.steady(grid_of(problem, n).x))
    return _SHARE * min(largest_step(rates(problem, n, state, space=table.space), time) for state in states)


class _Table:
    """A table of derivatives, told from others by being another one: a dict has no hash."""

    def __init__(self, space):
        self.space = space

    def __eq__(self, other):
        return self.space is other.space

    def __hash__(self):
        return id(self.space)
