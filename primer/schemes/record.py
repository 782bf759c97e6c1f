"""A run in the making: its plan in whole steps, the log it keeps while it marches, and the ``Run`` made of both."""

import math
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from primer.arithmetic import Arithmetic, arithmetic
from primer.checks import MAX_BYTES, integer, real, sequence, shown
from primer.schemes.grid import Grid
from primer.schemes.marching import a_problem, fields_of, grid_of
from primer.schemes.run import Run, Seed, Stop

_SMALLEST = float(np.finfo(np.float32).tiny)  # a smaller step would be 0 in single precision
MAX_WORK = 10**13  # grid points times steps: a run of more, which takes hours, is refused before it starts


@dataclass(frozen=True, eq=False)
class Plan:
    """What :func:`primer.ftcs` was asked for, checked, in whole steps; see there for the arguments."""

    grid: Grid
    numbers: Arithmetic
    dt: float
    steps: int
    every: int
    times: tuple[float, ...]  # of the snapshots, in ascending order
    shot_steps: np.ndarray
    seed: Seed | None
    blow_up_at: float

    def refuse_if_large(self, fields, members=1):
        """Raise ValueError if so many runs of so many fields would keep too much in memory, or march too long."""
        n, records, shots = self.grid.n, self.steps // self.every + 1, len(self.times)
        number = 16 if self.numbers.dtype != object else 128 - int(math.log2(max(self.numbers.epsilon, 1e-300)))
        size = number * members * (3 * records + (shots + 12) * fields * n)
        if size > MAX_BYTES:
            raise ValueError(
                f"record_every, snapshots and n must let all runs fit into {MAX_BYTES / 2**30:.0f} GiB, "
                f"got {members} with {records} records, {shots} snapshots and n = {n}"
            )
        if self.steps * n > MAX_WORK:
            raise ValueError(
                f"dt, t_end and n must be such that n t_end/dt <= {MAX_WORK:.0e} (more takes too long), "
                f"got dt = {self.dt:g}, {self.steps} steps and n = {n}"
            )

    def start(self, problem):
        """(h, x, state, log) before the first step: state of shape (fields, n)."""
        a_problem("problem", problem)
        period, complex_ = getattr(problem, "period", 2 * math.pi), getattr(problem, "is_complex", False)
        numbers = self.numbers.complex if complex_ else self.numbers
        if self.seed and self.seed.field not in problem.fields:
            raise ValueError(f"seed field must be one of {', '.join(problem.fields)}, got {shown(self.seed.field)}")
        self.refuse_if_large(len(problem.fields))
        h, x = self.numbers.grid(self.grid.n, period)
        with np.errstate(over="ignore", invalid="ignore"):  # data beyond the largest number are a blow-up at t = 0
            state = [numbers.array(f) for f in fields_of(problem, "initial", x)]
            if self.seed:
                angle = x if period == 2 * math.pi else x * (2 * self.numbers.pi / (h * self.grid.n))
                state[problem.fields.index(self.seed.field)] += numbers.array(self.seed(angle))
            log = Log(self, numbers.array(fields_of(problem, "steady", x)))
            log.watch(0, np.array(state))
        return h, x, np.array(state), log


def plan(n, dt, t_end, record_every, snapshots, seed, blow_up_at, dtype, digits) -> Plan:
    """Check the arguments of :func:`primer.ftcs` and count the steps."""
    grid, numbers = Grid(n), arithmetic(dtype, digits)
    dt, t_end = real("dt", dt, above=0), real("t_end", t_end, least=0)
    if not t_end / dt < 2**53:
        raise ValueError(f"dt must be more than t_end/2^53, got {dt!r} with t_end {t_end!r}")
    if dt < _SMALLEST:
        raise ValueError(f"dt must be >= {_SMALLEST:.2g}, got {dt!r}")
    steps = round(t_end / dt)
    every = (
        max(1, steps // 1000)
        if record_every is None
        else min(integer("record_every", record_every, least=1), steps + 1)
    )
    snapshots = sequence("snapshots", snapshots, "times")
    times = tuple(sorted({real("snapshots", time, least=0, most=t_end) for time in snapshots}))
    shot_steps = np.array([round(time / dt) for time in times], dtype=np.int64)
    blow_up_at = real("blow_up_at", blow_up_at, above=0, most=numbers.largest**0.5)
    return Plan(grid, numbers, dt, steps, every, times, shot_steps, _seed(grid, seed), blow_up_at)


def _seed(grid, seed):
    if isinstance(seed, tuple) and 2 <= len(seed) <= 4:
        seed = Seed(*seed)
    if seed is not None and not isinstance(seed, Seed):
        raise TypeError(f"seed must be a Seed, or its (mode, amplitude, field) as a tuple, or None, got {shown(seed)}")
    if seed is not None:
        integer("seed mode", seed.mode, most=grid.n // 2)  # the grid sees a higher one as a lower one
    return seed


class Log:
    """What a run keeps while it marches: clock, records, snapshots. The compiled loops write into the same arrays."""

    def __init__(self, plan, steady):
        self.plan, self.steady = plan, steady
        self.real = steady.dtype == plan.numbers.dtype and not hasattr(steady.flat[0], "_mpc_")
        limit = plan.numbers.number(plan.blow_up_at)
        self.limit = limit * limit
        records = plan.steps // plan.every + 1
        self.clock = np.array([0, -1, 0, 0])  # step, first step with u <= 0, blown up?, snapshots taken
        self.dist2, self.u_min = np.zeros((2, records), dtype=plan.numbers.dtype)
        self.shots = np.zeros((len(plan.times), *steady.shape), dtype=steady.dtype)

    @property
    def running(self):
        """Whether there are steps left to do."""
        return self.clock[0] < self.plan.steps and not self.clock[2]

    def watch(self, step, state):
        """Look at the state after ``step``."""
        clock, every, shot_steps = self.clock, self.plan.every, self.plan.shot_steps
        dist2, u_min = self.measure(state)
        if not u_min > 0 and clock[1] < 0:
            clock[1] = step
        clock[0], clock[2] = step, not dist2 <= self.limit
        if step % every == 0:
            self.dist2[step // every], self.u_min[step // every] = dist2, u_min
        while clock[3] < len(shot_steps) and shot_steps[clock[3]] == step:
            self.shots[clock[3]] = state
            clock[3] += 1

    def measure(self, state):
        """(Dist^2, min u) of a state; of complex fields, with their moduli and the real part of the first."""
        deviation = state - self.steady
        if self.real:
            return (deviation * deviation).sum(axis=0).max(), state[0].min()
        re, im = real_and_imaginary(deviation)
        return (re * re + im * im).sum(axis=0).max(), real_and_imaginary(state[0])[0].min()

    def run(self, problem, state, interrupted):
        """The finished :class:`Run`, whose last record is the last state."""
        plan, (step, first_negative, blown_up, taken) = self.plan, (int(k) for k in self.clock)
        recorded = np.arange(0, step + 1, plan.every)
        dist2, u_min = self.dist2[: recorded.size], self.u_min[: recorded.size]
        if recorded[-1] != step:
            last = self.measure(state)
            recorded, dist2, u_min = np.append(recorded, step), np.append(dist2, last[0]), np.append(u_min, last[1])
        shots = zip(plan.times, self.shots[:taken], strict=False)
        return Run(
            problem=problem,
            n=plan.grid.n,
            dt=plan.dt,
            x=grid_of(problem, plan.grid.n).x,
            t=recorded * plan.dt,
            dist=dist2**0.5 if dist2.dtype == object else np.sqrt(dist2),
            u_min=u_min,
            snapshots=MappingProxyType({time: tuple(shot) for time, shot in shots}),
            final=tuple(state),
            t_first_negative=None if first_negative < 0 else first_negative * plan.dt,
            stop=Stop.BLEW_UP if blown_up else Stop.INTERRUPTED if interrupted else Stop.REACHED_END,
            t_stop=step * plan.dt,
            seed=plan.seed,
            blow_up_at=plan.blow_up_at,
        )


def real_and_imaginary(f):
    """The two parts of an array of complex numbers, also of multiprecision ones."""
    if f.dtype != object:
        return f.real, f.imag
    return tuple(np.frompyfunc(lambda z, part=part: getattr(z, part), 1, 1)(f) for part in ("real", "imag"))
