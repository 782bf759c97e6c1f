"""The paper's scheme: central differences in space, forward Euler in time."""

import sys
import warnings
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType

import numpy as np

from primer.arithmetic import arithmetic
from primer.checks import integer, real, shown
from primer.problems.toy import Toy
from primer.schemes.grid import CENTRAL, Grid
from primer.schemes.run import Run, Seed, Stop

MAX_BYTES = 2**31  # a run that would record more than this is refused before it starts
_CHUNK = 2**25  # grid points marched between two looks at the keyboard: about 0.03 s compiled
_SHORT = 2**19  # grid points below which starting the compiler costs more than it saves


def ftcs(
    problem,
    n=100,
    dt=1e-3,
    t_end=100.0,
    record_every=None,
    snapshots=(),
    seed=None,
    blow_up_at=1e3,
    dtype=np.float64,
    digits=None,
):
    """March ``problem`` by the paper's central-space forward-time scheme (section A2.2.2) on n periodic points.

    One step is ``f + dt * rhs(f)`` for every field f, with the derivatives of ``CENTRAL``::

        f_x  ~ (f[j+1] - f[j-1]) * (1/(2h))
        f_xx ~ (f[j+1] - 2 f[j] + f[j-1]) * (1/h^2)

    in just this order of operations, compiled or not: the error is of first order in dt and of second order in h = 2
    pi/n.

    Parameters
    ----------
    problem              a ``Toy``, a ``BackwardHeat``, or any object with their methods
    n : int              grid points, n >= 4
    dt, t_end : float    step > 0 and end >= 0; the run takes round(t_end/dt) steps
    record_every : int   steps between records of Dist and min u (default: about a thousand records in all)
    snapshots            times in [0, t_end] at which the fields are kept, each at the nearest step
    seed                 a ``Seed`` (or its arguments as a tuple) that perturbs the initial data; with None round-off is
                         the only perturbation
    blow_up_at : float   the run stops when Dist exceeds this or is no longer a number
    dtype, digits        float32, float64, longdouble, or a number of decimal digits (slow: arbitrary precision)

    Returns
    -------
    Run, also when the solution blows up or the run is interrupted (Ctrl-C): ``run.stop`` says which

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not allowed
    """
    if not all(hasattr(problem, part) for part in ("fields", "initial", "steady", "forcing", "rhs")):
        raise TypeError(f"problem must be a Toy, a BackwardHeat or an object with their methods, got {shown(problem)}")
    grid, numbers = Grid(n), arithmetic(dtype, digits)
    seed = _seed(problem, grid, seed)
    blow_up_at = real("blow_up_at", blow_up_at, above=0, most=numbers.largest**0.5)
    plan = _plan(problem, grid.n, dt, t_end, record_every, snapshots)
    h, x = numbers.grid(grid.n)
    state = [numbers.array(f) for f in problem.initial(x)]
    if seed is not None:
        state[problem.fields.index(seed.field)] += numbers.array(seed(x))
    log = _Log(plan, numbers.array(problem.steady(x)), numbers.number(blow_up_at))
    log.watch(0, np.array(state))
    march = _compiled if _compiles(problem, numbers, plan.steps * grid.n) else _interpreted
    state, interrupted = march(problem, h, x, np.array(state), numbers.number(plan.dt), plan, log)
    return _run(problem, grid, plan, log, state, interrupted, seed, blow_up_at)


@dataclass(frozen=True)
class _Plan:
    """A run in whole steps."""

    dt: float
    steps: int
    every: int
    times: tuple[float, ...]  # of the snapshots, in ascending order
    shot_steps: np.ndarray


class _Log:
    """What a run keeps while it marches: clock, records, snapshots. The kernel writes into the same arrays."""

    def __init__(self, plan, steady, limit):
        self.every, self.shot_steps, self.steady, self.limit = plan.every, plan.shot_steps, steady, limit * limit
        records = plan.steps // plan.every + 1
        self.clock = np.array([0, -1, 0, 0])  # step, first step with u <= 0, blown up?, snapshots taken
        self.dist2, self.u_min = np.zeros((2, records), dtype=steady.dtype)
        self.shots = np.zeros((len(plan.shot_steps), *steady.shape), dtype=steady.dtype)

    def watch(self, step, state):
        """Look at the state after ``step``; True once it has blown up."""
        dist2, u_min = self.measure(state)
        if u_min <= 0 and self.clock[1] < 0:
            self.clock[1] = step
        self.clock[0], self.clock[2] = step, not dist2 <= self.limit
        if step % self.every == 0:
            self.dist2[step // self.every], self.u_min[step // self.every] = dist2, u_min
        while self.clock[3] < len(self.shot_steps) and self.shot_steps[self.clock[3]] == step:
            self.shots[self.clock[3]] = state
            self.clock[3] += 1
        return self.clock[2]

    def measure(self, state):
        """(Dist^2, min u) of a state."""
        deviation = state - self.steady
        return (deviation * deviation).sum(axis=0).max(), state[0].min()


def _interpreted(problem, h, x, state, dt, plan, log):
    """The time loop in NumPy, for any problem and any numbers."""

    def derivative(f, m):
        return CENTRAL[m](f, h)

    forcing = problem.forcing(x)
    try:
        # One step may carry a blow-up from below the stated amplitude to beyond the largest number.
        with np.errstate(over="ignore", invalid="ignore"):
            while log.clock[0] < plan.steps and not log.clock[2]:
                state = state + dt * np.array(problem.rhs(x, state, derivative, forcing))
                log.watch(log.clock[0] + 1, state)
    except KeyboardInterrupt:
        return state, True
    return state, False


def _compiled(problem, h, x, state, dt, plan, log):
    """The same time loop, to the bit, in machine code: for the toy system in float32 or float64."""

    def with_ghosts(f):
        return np.pad(f, [(0, 0)] * (f.ndim - 1) + [(1, 1)])

    number, march = x.dtype.type, _kernel()
    w = with_ghosts(np.stack([state, state]))
    fixed = (
        with_ghosts(problem.forcing(x)),
        with_ghosts(log.steady[0]),
        number(CENTRAL[1].scale(h)),
        number(CENTRAL[2].scale(h)),
        dt,
        number(problem.eps),
        log.limit,
    )
    interrupted = False
    try:
        while log.clock[0] < plan.steps and not log.clock[2]:
            until = min(log.clock[0] + _CHUNK // x.size + 1, plan.steps)
            march(w, *fixed, log.clock, until, plan.every, log.dist2, log.u_min, plan.shot_steps, log.shots)
    except KeyboardInterrupt:
        interrupted = True
    return w[log.clock[0] % 2, :, 1:-1].copy(), interrupted


def _compiles(problem, numbers, points):
    """Whether a run of so many grid points in all is for the compiled loop. The bits are the same either way."""
    worthwhile = points > _SHORT or "primer.schemes.kernel" in sys.modules
    return type(problem) is Toy and numbers.dtype in (np.float32, np.float64) and worthwhile and _kernel() is not None


@cache
def _kernel():
    """The compiled time loop, or None where numba cannot be imported, which is said once."""
    try:
        from primer.schemes.kernel import march
    except ImportError as missing:
        warnings.warn(
            f"numba is not here ({missing}): runs give the same bits, but slower", RuntimeWarning, stacklevel=5
        )
        return None
    return march


def _plan(problem, n, dt, t_end, record_every, snapshots):
    dt, t_end = real("dt", dt, above=0), real("t_end", t_end, least=0)
    if not t_end / dt < 2**53:
        raise ValueError(f"dt must be more than t_end/2^53, got {dt!r} with t_end {t_end!r}")
    steps = round(t_end / dt)
    every = max(1, steps // 1000) if record_every is None else integer("record_every", record_every, least=1)
    if isinstance(snapshots, str) or not np.iterable(snapshots):
        raise TypeError(f"snapshots must be a sequence of times, got {shown(snapshots)}")
    times = tuple(sorted({real("snapshots", time, least=0, most=t_end) for time in snapshots}))
    kept = 16 * (3 * (steps // every + 1) + (len(times) + 12) * len(problem.fields) * n)
    if kept > MAX_BYTES:
        raise ValueError(
            f"record_every, snapshots and n must let a run fit into {MAX_BYTES / 2**30:.0f} GiB, got "
            f"{steps // every + 1} records, {len(times)} snapshots and n = {n}"
        )
    shot_steps = np.array([min(round(time / dt), steps) for time in times], dtype=np.int64)
    return _Plan(dt, steps, every, times, shot_steps)


def _seed(problem, grid, seed):
    if seed is None:
        return None
    if isinstance(seed, tuple):
        seed = Seed(*seed)
    if not isinstance(seed, Seed):
        raise TypeError(f"seed must be a Seed, or its (mode, amplitude, field) as a tuple, or None, got {shown(seed)}")
    if seed.field not in problem.fields:
        raise ValueError(f"seed field must be one of {', '.join(problem.fields)}, got {shown(seed.field)}")
    integer("seed mode", seed.mode, most=grid.n // 2)  # the grid sees a higher one as a lower one
    return seed


def _run(problem, grid, plan, log, state, interrupted, seed, blow_up_at):
    step, first_negative, blown_up, taken = (int(k) for k in log.clock)
    recorded = np.arange(0, step + 1, plan.every)
    dist2, u_min = log.dist2[: recorded.size], log.u_min[: recorded.size]
    if recorded[-1] != step:  # the last state is always recorded
        last_dist2, last_u_min = log.measure(state)
        recorded, dist2, u_min = np.append(recorded, step), np.append(dist2, last_dist2), np.append(u_min, last_u_min)
    return Run(
        problem=problem,
        n=grid.n,
        dt=plan.dt,
        x=grid.x,
        t=recorded * plan.dt,
        dist=dist2**0.5 if dist2.dtype == object else np.sqrt(dist2),
        u_min=u_min,
        snapshots=MappingProxyType({t: tuple(shot) for t, shot in zip(plan.times, log.shots[:taken], strict=False)}),
        final=tuple(state),
        t_first_negative=None if first_negative < 0 else first_negative * plan.dt,
        stop=Stop.BLEW_UP if blown_up else Stop.INTERRUPTED if interrupted else Stop.REACHED_END,
        t_stop=step * plan.dt,
        seed=seed,
        blow_up_at=blow_up_at,
    )
