"""Plane waves marched implicitly: viscosity is stiff on a fine grid, and scipy's steps do not mind."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np

from primer.checks import affordable, instance, integer, real, real_array, shown
from primer.granular.flow_rule import NoPressure
from primer.granular.system import System
from primer.granular.waves import PlaneWave
from primer.schemes.grid import CENTRAL, Grid
from primer.types import ArrayLike

RIGID_BELOW = 1e-3  # of ||D|| over that of the base flow; there steps shrink for ever, and nothing more is learnt
MAX_STEPS = 20_000  # of a march, some minutes on the finest grids


class Outcome(StrEnum):
    """How the march of a wave ended. None is an error."""

    REACHED_END = "reached the end"
    NO_PRESSURE = "no pressure"  # somewhere the flow has none: the law does not say how to go on
    PHI = "phi out of range"  # phi has left (phi0, phi0 + eps): too loose to carry stress, or jammed
    RIGID = "shear stops"  # ||D|| falls to 1/1000 of the base flow's: a yield stress has no direction where D = 0
    GAVE_UP = "gave up"  # the steps became too small or too many


@dataclass(frozen=True, eq=False)
class WaveRun:
    """A marched ``PlaneWave``.

    Attributes
    ----------
    problem, n, x   what was marched, on how many points, and these
    t               (r,) times, the last one t_stop
    states          (r, fields, n) the fields then
    outcome         an ``Outcome``, and ``reason``, one sentence
    steps           how many the integrator took
    """

    problem: PlaneWave
    n: int
    x: np.ndarray = field(repr=False)
    t: np.ndarray = field(repr=False)
    states: np.ndarray = field(repr=False)
    outcome: Outcome
    reason: str
    steps: int

    @property
    def t_stop(self) -> float:
        """When the march ended."""
        return float(self.t[-1])

    @property
    def mass_drift(self) -> float:
        """The largest change of the mean of phi, over phi; 0 for an incompressible law."""
        if self.problem.incompressible:
            return 0.0
        mass = self.states[:, 2].mean(axis=1)
        return float(np.abs(mass / mass[0] - 1).max())

    @property
    def size(self) -> np.ndarray:
        """(r,) the largest distance from the base state, in ||D|| d for velocities and in 1/1000 for phi."""
        gone = (self.states - self.problem.base[:, None]) / self.problem.scale[:, None]
        return np.abs(gone).max(axis=(1, 2))


def march_waves(
    problem: PlaneWave,
    n: int,
    t_end: float,
    space: Any = CENTRAL,
    rtol: float = 1e-6,
    times: int | ArrayLike = 40,
    source: Any = None,
    start: ArrayLike | None = None,
) -> WaveRun:
    """March a ``PlaneWave`` on n points to t_end, by the backward differentiation formulae of scipy (orders 1 to 5).

    Eqs. (cons-mom-no-expl-stress) and (c-mass) for a plane wave. The right-hand side is the problem's own, as for
    ``march_lines``; its Jacobian is made of slopes at each point.

    Parameters
    ----------
    problem     the wave
    n, t_end    grid points >= 4, and the end > 0
    space       derivative -> stencil: ``CENTRAL``, ``CENTRAL_4``, ``CENTRAL_6`` or ``FOURIER``
    rtol        tolerance of a step, relative to ||D|| d and 1/1000, and to the amplitude of the wave if it has one
    times       how many times are recorded, or which
    source      ``source(x, t)``, of shape (fields, n), is added to the time derivatives: for manufactured solutions
    start       the fields at t = 0, of shape (fields, n); left out, ``problem.initial(x)``

    Returns
    -------
    WaveRun. A wave that leaves what the law can say is an ``Outcome``, and the run ends there.

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not as above

    >>> from primer.granular import CSSM, EXAMPLE_COMPACTION, BaseState
    >>> law = CSSM(0.4, EXAMPLE_COMPACTION)
    >>> wave = PlaneWave(law, BaseState(p=0.5, phi=0.55, I=0.1), amplitude=1e-3)  # it contracts
    >>> run = march_waves(wave, 32, 100.0)
    >>> print(run.outcome, run.mass_drift < 1e-13)
    reached the end True
    """
    instance("problem", problem, PlaneWave)
    grid, t_end = Grid(integer("n", n, least=4), problem.period), real("t_end", t_end, above=0)
    rtol = real("rtol", rtol, above=1e-14, below=1)
    if not isinstance(space, dict) or 1 not in space:
        raise TypeError(f"space must be a table of derivatives such as CENTRAL or FOURIER, got {shown(space)}")
    asked = (
        np.linspace(0, t_end, integer("times", times, least=2)) if np.ndim(times) == 0 else real_array("times", times)
    )
    if np.any(np.diff(asked) <= 0) or asked[0] < 0 or asked[-1] > t_end:
        raise ValueError(f"times must rise from 0 to t_end = {t_end:g}, got {shown(times)}")
    fields = len(problem.fields)
    affordable("n: the march", 8 * (fields * grid.n) ** 2 * 3 if grid.n < 400 else 2e4 * grid.n, f"n = {grid.n}")
    x = grid.x
    state = np.array(problem.initial(x) if start is None else real_array("start", start), dtype=float)
    if state.shape != (fields, grid.n):
        raise ValueError(f"start must have shape ({fields}, {grid.n}), got {state.shape}")
    system = System(problem, x, lambda f, m: space[m](f, grid.h), source)
    small = min(max(problem.amplitude, 1e-6), 1.0)  # what is smaller yet is in the rounding of the stress
    return _marched(system, state, t_end, rtol, rtol * small, asked)


def _marched(system, state, t_end, rtol, small, asked):
    from scipy.integrate import BDF

    unit = np.repeat(system.problem.scale, system.x.size)
    t, states, steps = [0.0], [state], 0
    waiting = list(asked[asked > 0])
    begin = state.ravel() - system.base
    start = system.rhs(0.0, begin)
    outcome: Outcome | None = None
    reason = ""
    if not np.isfinite(start).all():
        outcome, reason = _named(system)
        waiting = []
    else:
        solver = BDF(system.rhs, 0.0, begin, t_end, rtol=rtol, atol=small * unit, jac=system.jacobian)
    while outcome is None:
        system.lack = None
        try:
            with np.errstate(all="ignore"):
                solver.step()
            failed = solver.status == "failed"
        except (ValueError, RuntimeError, np.linalg.LinAlgError):  # a matrix with nan, or a singular one
            failed = True
        steps += 1
        if failed or steps > MAX_STEPS:
            outcome, reason = _named(system, failed)
            if solver.t > t[-1]:
                t.append(float(solver.t))
                states.append(system.state(solver.y))
            break
        inside = [time for time in waiting if time <= solver.t]
        if inside:
            dense = solver.dense_output()
            for time in inside:
                t.append(float(time))
                states.append(system.state(dense(time)))
            waiting = waiting[len(inside) :]
        if system.least_shear(system.state(solver.y)) < RIGID_BELOW:
            outcome, reason = (
                Outcome.RIGID,
                f"Near t = {solver.t:.6g} the shear stops at a point: ||D|| = 0 has no stress.",
            )
            if solver.t > t[-1]:
                t.append(float(solver.t))
                states.append(system.state(solver.y))
        elif solver.status == "finished":
            outcome, reason = Outcome.REACHED_END, f"The march reached its end, t = {t_end:g}."
    return WaveRun(system.problem, system.x.size, system.x, np.array(t), np.array(states), outcome, reason, steps)


def _named(system, failed=True):
    """(outcome, reason) of a step that could not be done."""
    if not failed:
        return Outcome.GAVE_UP, f"The march took {MAX_STEPS} steps and was not at its end."
    if system.lack is None or not system.lack[1]:
        return (
            Outcome.GAVE_UP,
            "The steps became too small: the solution is no longer one of these equations on the grid.",
        )
    when, lacking = system.lack
    kinds = sorted(set(lacking), key=lacking.count)
    kind = Outcome.PHI if kinds[-1] == NoPressure.PHI else Outcome.NO_PRESSURE
    where = f"at {len(lacking)} of {system.x.size} points" if len(lacking) > 1 else "at one point"
    return kind, f"Near t = {when:.6g} the flow has no pressure {where}: {' and '.join(kinds)}."
