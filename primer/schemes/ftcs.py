"""The paper's scheme: central differences in space, forward Euler in time."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from primer.compiled import able, started
from primer.schemes.block import Block, compilable, tally
from primer.schemes.grid import CENTRAL
from primer.schemes.marching import slope_of
from primer.schemes.progress import step_bar
from primer.schemes.record import plan
from primer.schemes.run import Run, Seed
from primer.types import DTypeLike, Problem

# Steps of one text from which on it is compiled: in NumPy each takes some 30 microseconds, while compiling takes 0.05 s
# and loading the compiler before that another 0.1 s.
_SOON, _LATER = 1500, 4000
_TELL = 256  # steps between two looks at the clock


def ftcs(
    problem: Problem,
    n: int = 100,
    dt: float = 1e-3,
    t_end: float = 100.0,
    record_every: int | None = None,
    snapshots: Iterable[float] = (),
    seed: Seed | tuple | None = None,
    blow_up_at: float = 1e3,
    dtype: DTypeLike = np.float64,
    digits: int | None = None,
    progress: bool = True,
) -> Run:
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
    progress             whether to show a progress bar for a run of more than two seconds, on a terminal

    Returns
    -------
    Run, also when the solution blows up or the run is interrupted (Ctrl-C): ``run.stop`` says which

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not allowed

    >>> from primer import Toy
    >>> run = ftcs(Toy(a=1.5), n=100, t_end=100)  # the paper's Figure 4
    >>> print(run.stop, f"{run.dist[-1]:.4e}")  # h/sin h - 1
    reached_end 6.5828e-04
    """
    asked = plan(n, dt, t_end, record_every, snapshots, seed, blow_up_at, dtype, digits)
    march = _compiled if _compiles(problem, asked) else _interpreted
    with step_bar(asked.steps, progress) as tell:
        return march(asked, problem, tell)


def _interpreted(asked, problem, tell):
    """The time loop in NumPy, for any problem and any numbers."""
    h, x, state, log = asked.start(problem)
    slope, dt, interrupted = slope_of(problem, x, lambda f, m: CENTRAL[m](f, h)), asked.numbers.number(asked.dt), False
    try:
        # One step may carry a blow-up from below the stated amplitude to beyond the largest number.
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            while log.running:
                state = stepped(state, dt, slope(state, asked.numbers.number(int(log.clock[0])) * dt))
                log.watch(log.clock[0] + 1, state)
                if log.clock[0] % _TELL == 0:
                    tell(log.clock[0])
    except KeyboardInterrupt:
        interrupted = True
    return log.run(problem, state, interrupted)


def stepped(state, dt, slopes):
    """state + dt slopes; of complex fields both parts for themselves."""
    if state.dtype.kind != "c":
        return state + dt * slopes
    new = np.empty_like(state)
    new.real, new.imag = state.real + dt * slopes.real, state.imag + dt * slopes.imag
    return new


def _compiled(asked, problem, tell):
    """The same time loop, to the bit, in machine code: for a problem made from a text, in float32 or float64."""
    block, interrupted = Block(asked, [problem]), False
    try:
        block.march(tell)
    except KeyboardInterrupt:
        interrupted = True
    (run,) = block.runs(interrupted)
    return run


def _compiles(problem, asked):
    """Whether a run is for the compiled loop. The bits are the same either way."""
    if asked.numbers.dtype not in (np.float32, np.float64) or not compilable(problem, asked.grid.n):
        return False
    work = tally(problem.evolution)
    work.steps += asked.steps
    return work.steps > (_SOON if started() else _LATER) and able()
