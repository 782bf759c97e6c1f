"""The method of lines: any stencil in space, any Runge-Kutta step in time, on the same right-hand side as ``ftcs``."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np

from primer.checks import affordable, instance, real, shown
from primer.compiled import able
from primer.problems.toy import Toy
from primer.schemes.block import of_text
from primer.schemes.by_transforms import slope_by_transforms, step_by_products
from primer.schemes.exponential import Exponential, exponential_march
from primer.schemes.fourier import MATRIX_UP_TO, Fourier
from primer.schemes.grid import CENTRAL, Grid, Stencil
from primer.schemes.lines_block import compilable, marched
from primer.schemes.marching import a_problem, fields_of, grid_of, orders_of, slope_of
from primer.schemes.progress import step_bar
from primer.schemes.runge_kutta import RK4, RungeKutta
from primer.types import Problem

MAX_STEPS = 10**7  # a march of more steps than this (some minutes) is refused before it starts
MAX_WORK = 10**12  # and one of more points times steps, which takes hours
Space: TypeAlias = Mapping[int, Stencil] | Mapping[int, Fourier]  # derivative -> stencil
_TELL = 64  # steps in NumPy between two looks up
_BLOWN_UP = 1e100  # growth over the initial data at which a march is given up, at whatever stage of a step


@dataclass(frozen=True, eq=False)
class Lines:
    """The outcome of :func:`march_lines`; arrays are read-only, everything is dimensionless.

    Attributes
    ----------
    problem, n, dt, t    what was marched, on how many points, with which step, to which time
    space, time          the derivatives and the step
    x                    (n,) the grid
    final                the fields at t, each of shape (n,); NaN where the march blew up

    It serves the equations of Appendix 2; the paper itself uses ``ftcs``.

    >>> from primer import FOURIER, RK8, Toy, march_lines
    >>> end = march_lines(Toy(1.5), 16, 0.1, 5.0, FOURIER, RK8)
    >>> print(end.t, end.blew_up, [f.shape for f in end.final])
    5.0 False [(16,), (16,)]
    """

    problem: Any
    n: int
    dt: float
    t: float
    space: Space = field(repr=False)
    time: RungeKutta | Exponential
    x: np.ndarray = field(repr=False)
    final: tuple[np.ndarray, ...] = field(repr=False)

    def __post_init__(self) -> None:
        for array in (self.x, *self.final):
            array.flags.writeable = False

    @property
    def blew_up(self) -> bool:
        """Whether the march was given up, at 1e100 times the size of its initial data."""
        return not np.isfinite(self.final).all()


def march_lines(
    problem: Problem,
    n: int,
    dt: float,
    t_end: float,
    space: Space = CENTRAL,
    time: RungeKutta | Exponential = RK4,
    progress: bool = True,
) -> Lines:
    """March ``problem`` to t_end on n periodic points, with the derivatives ``space`` and the step ``time``.

    Parameters
    ----------
    problem      a ``Toy``, a ``BackwardHeat``, or any object with their methods
    n : int      grid points, n >= 4
    dt : float   the largest step; the march takes ceil(t_end/dt) equal ones and so ends at t_end itself
    t_end        the end, t_end >= 0
    space        derivative -> stencil: ``CENTRAL``, ``CENTRAL_4``, ``CENTRAL_6`` or ``FOURIER``
    time         ``RK4`` or ``RK8``; or ``ETDRK4``, whose step may be far longer where the equation is stiff, for a
                 problem with a text and ``FOURIER``
    progress     whether to show a progress bar for a march of more than two seconds, on a terminal

    Returns
    -------
    Lines; its fields are NaN if the march blew up, as it does where dt is beyond the limit of stability

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not allowed

    For eqs. (toy-pde) and (backward-heat), with other schemes than the paper's.

    >>> from primer import FOURIER, RK8
    >>> toy = Toy(1.5, eps=0)
    >>> end = march_lines(toy, 16, 0.1, 5.0, FOURIER, RK8)
    >>> bool(np.abs(end.final[0] - toy.exact(end.x, 5.0)[0]).max() < 1e-9)  # eq. (toy-sln)
    True
    """
    a_problem("problem", problem, ("initial", "forcing", "rhs"))
    grid, dt, t_end = grid_of(problem, n), real("dt", dt, above=0), real("t_end", t_end, least=0)
    _check(space, time, orders_of(problem))
    if isinstance(time, Exponential) and not (of_text(problem) and all(type(d) is Fourier for d in space.values())):
        raise ValueError(
            f"time must be a Runge-Kutta step such as RK4, or with space FOURIER and a problem that is a text "
            f"{time.name}, got {time.name} with {shown(problem)}"
        )
    if not t_end / dt <= MAX_STEPS:
        raise ValueError(
            f"dt must be >= t_end/{MAX_STEPS:.0e} (more steps take too long), got {dt!r} with t_end {t_end!r}"
        )
    affordable("n: the march", 16 * grid.n * (_stages(time) + 8), f"n = {grid.n}")
    if not grid.n * t_end / dt <= MAX_WORK:
        raise ValueError(f"n and dt must be such that n t_end/dt <= {MAX_WORK:.0e}, got n = {grid.n} and dt = {dt!r}")
    # A quotient that rounding leaves a little above a whole number is that number.
    steps = math.ceil(t_end / dt * (1 - 1e-12))
    step = t_end / steps if steps else dt
    (final,), _ = trace(problem, grid.n, space, time, np.array([step]), np.array([steps]), progress)
    return Lines(problem, grid.n, step, t_end, space, time, grid.x, tuple(final))


def _check(space, time, orders=(1, 2)):
    if not isinstance(time, Exponential):
        instance("time", time, RungeKutta, "RungeKutta step such as RK4 or RK8, or ETDRK4")
    if not isinstance(space, dict) or not all(isinstance(d, Stencil | Fourier) for d in space.values()):
        raise TypeError(f"space must be a table of derivatives such as CENTRAL or FOURIER, got {shown(space)}")
    missing = [m for m in orders if m not in space]
    if missing:
        raise TypeError(
            f"space must be a table of derivatives such as CENTRAL or FOURIER, got one without order {missing[0]}"
        )


def _stages(time):
    return len(time.b) if isinstance(time, RungeKutta) else 80  # circles of 64 points about each mode


def stable_step(toy: Toy, n: int, space: Space, time: RungeKutta) -> float:
    """Nine tenths of the step up to which ``time`` is stable for the toy system on n points.

    Frozen at a point, the eigenvalues lam of eq. (toy-mat) satisfy lam^2 + (1 + eps u d2) lam + d1^2 = 0 with the
    derivatives' multipliers i d1 and -d2, and lie within max(d1, 1 + eps u d2). That is put into the half disc of
    ``time.reach``. The largest u there is: u = a - cos x (1 - e^{-t/2} cos wt) <= a + 1.2 for eps = 0, and diffusion
    lowers it.
    """
    instance("toy", toy, Toy)
    _check(space, time)
    n = Grid(n).n
    d1, d2 = _largest(n, space[1], space[2])
    return 0.9 * time.reach / max(d1, 1 + toy.eps * (abs(toy.a) + 1.25) * d2)


@lru_cache(maxsize=64)
def _largest(n, *derivatives):
    xi = np.arange(n // 2 + 1)
    return [float(np.abs(d.multiplier(xi, 2 * math.pi / n)).max()) for d in derivatives]


def trace(problem, n, space, time, dt, counts, progress=False):
    """The states on n points after counts[0] steps of dt[0], then counts[1] of dt[1], and so on: (m, fields, n).

    With ``progress`` there is a bar, as ``march_lines`` has it.

    Returns
    -------
    (states, depth); states that a blow-up kept from being reached are NaN, and depth (m,) is the integral over time of
    max(0, -min of the first field) up to there, infinite where not reached
    """
    start = _start if of_text(problem) else _start.__wrapped__  # problems of one's own need not be hashable
    x, y, limit = start(problem, n)
    states, depth = np.full((len(dt), *y.shape), np.nan, dtype=y.dtype), np.full(len(dt), np.inf)
    begin = np.concatenate([[0.0], np.cumsum(np.multiply(dt, counts))[:-1]])
    fast = isinstance(time, RungeKutta) and compilable(problem, n, space) and able()
    march = exponential_march if isinstance(time, Exponential) else marched if fast else _interpreted
    with step_bar(int(np.sum(counts)), progress) as tell:
        march(problem, x, y, space, time, dt, begin, counts, limit, states, depth, tell)
    return states, depth


def _interpreted(problem, x, y, space, time, dt, begin, counts, limit, states, depth, tell):
    """The same march in NumPy, for any problem."""
    h, deep, lost, made = grid_of(problem, x.size).h, 0.0, np.zeros_like(y), 0
    if of_text(problem) and x.size > MATRIX_UP_TO and all(isinstance(d, Fourier) for d in space.values()):
        tendency = slope_by_transforms(problem, x, space, y.dtype.kind == "c")
        exact_step = step_by_products(time, y)
    else:
        exact_step = time.exact_step
        tendency = slope_of(problem, x, lambda f, m: space[m](f, h))

    def slope(y, t):
        if not _within(y, limit):
            return np.full_like(y, np.nan)
        return tendency(y, t)

    # One step may carry a blow-up from below the stated size to beyond the largest number.
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        for m, count in enumerate(counts):
            for step in range(count):
                deep -= dt[m] * min(0.0, y[0].real.min())
                y, lost = exact_step(slope, y, lost, dt[m], begin[m] + step * dt[m])
                if not _within(y, limit):
                    return
                if (made := made + 1) % _TELL == 0:
                    tell(made)
            states[m], depth[m] = y, deep


def _within(y, limit):
    """Whether every |number| is <= limit: surely, if the root of the sum of their squares is."""
    return np.vdot(y, y).real <= limit * limit < math.inf or np.abs(y).max() <= limit


@lru_cache(maxsize=64)
def _start(problem, n):
    """(x, state at t = 0, size at which a march is given up)."""
    x = grid_of(problem, n).x
    y = np.array(fields_of(problem, "initial", x), dtype=complex if getattr(problem, "is_complex", False) else None)
    return x, y, _BLOWN_UP * (1 + float(np.abs(y).max()))
