"""Grid refinement: the same problem on finer and finer grids."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from primer.checks import real, sequence, shown
from primer.problems.heat import BackwardHeat
from primer.schemes.discrete import amplification
from primer.schemes.ftcs import ftcs
from primer.schemes.grid import Grid, grids
from primer.schemes.limit import NEUTRAL
from primer.schemes.marching import grid_of
from primer.schemes.run import Run, Seed, Stop
from primer.study.stability import all_rates, tame_dt
from primer.types import Problem


@dataclass(frozen=True, eq=False)
class Refinement:
    """Runs of one problem on several grids: ``runs[i]`` has ``n[i]`` points of spacing ``h[i]``."""

    runs: tuple[Run, ...]

    @property
    def n(self) -> np.ndarray:
        """(k,) grid points."""
        return np.array([run.n for run in self.runs])

    @property
    def h(self) -> np.ndarray:
        """(k,) spacings: the period, 2 pi if nothing else is said, over n."""
        return np.array([grid_of(run.problem, run.n).h for run in self.runs])

    @property
    def dt(self) -> np.ndarray:
        """(k,) the steps."""
        return np.array([run.dt for run in self.runs])

    @property
    def dist_end(self) -> np.ndarray:
        """(k,) Dist of eq. (toy-err) where each run stopped."""
        return np.array([run.dist[-1] for run in self.runs], dtype=float)

    @property
    def t_blow_up(self) -> np.ndarray:
        """(k,) blow-up times; infinite where a run did not blow up."""
        return np.array([run.t_stop if run.stop is Stop.BLEW_UP else math.inf for run in self.runs])

    @cached_property
    def lost_by_scheme(self) -> np.ndarray:
        """(k,) True where the step is too large: what does not grow of itself is amplified tenfold, and most of all.

        In the linearised scheme about the initial data and about the steady state, if there is one. Where it is False a
        blow-up is of the equations on that grid, or of a solution that has left both states far behind.
        """
        return np.array([_lost(run) for run in self.runs])


def refine(
    problem: Problem,
    ns: Iterable[int],
    dt: float | str | Callable[[int], float] = 1e-3,
    seed: Seed | tuple | Callable[[int], Seed | None] | None = None,
    **options: Any,
) -> Refinement:
    """March ``problem`` on each of the grids ``ns`` by :func:`primer.ftcs`.

    ``dt`` and ``seed`` may also be functions of n; the other options are those of ``ftcs``. ``dt = "stable"`` takes on
    each grid the step with which nothing that does not grow of itself gains more than 1 % by the end, and at least a
    hundred steps.

    With one dt for all grids, the finer ones may blow up for want of a smaller step, which looks like ill-posedness and
    is none. So where a run blows up the steps are checked, and a warning names the grids that the scheme has lost
    (:attr:`Refinement.lost_by_scheme`).

    The end of section A2.2.2.

    >>> from primer import Toy
    >>> found = refine(Toy(1.5), [25, 50], t_end=40.0)
    >>> print(f"{found.dist_end[0] / found.dist_end[1]:.1f}")  # second order
    4.0
    """
    ns = _grids(ns)
    if isinstance(dt, str):
        if dt != "stable":
            raise ValueError(f'dt must be a number, a function of n or "stable", got {shown(dt)}')
        end = real("t_end", options.get("t_end", 100.0), least=0)
        steps = {n: tame_dt(problem, n, end) for n in ns}
        dt = steps.__getitem__

    def at(n, value):
        return value(n) if callable(value) and not isinstance(value, Seed | type) else value

    found = Refinement(tuple(ftcs(problem, n, at(n, dt), seed=at(n, seed), **options) for n in ns))
    if np.isfinite(found.t_blow_up).any() and found.lost_by_scheme.any():
        lost = ", ".join(str(run.n) for run, lost in zip(found.runs, found.lost_by_scheme, strict=True) if lost)
        warnings.warn(
            f'the step is too large for n = {lost}: what these runs show is the scheme; try dt="stable"',
            RuntimeWarning,
            stacklevel=2,
        )
    return found


def _lost(run):
    """Whether the scheme, and not the equations, has the last word in a run."""
    if not run.t_stop:
        return False
    for lam in all_rates(run.problem, run.n):
        growth = np.log(np.maximum(np.abs(1 + run.dt * lam), 1e-300)) / run.dt
        of_itself = lam.real > NEUTRAL * np.abs(lam).max(initial=0.0)
        scheme = growth[~of_itself].max(initial=0.0)
        if scheme > growth[of_itself].max(initial=0.0) and scheme * run.t_stop > math.log(10):
            return True
    return False


def _grids(ns):
    return grids("ns", sequence("ns", ns, "grids, such as [50, 100]"))


@dataclass(frozen=True, eq=False)
class HeatOnset:
    """When round-off, or a stated sawtooth, takes over the backward heat equation on finer and finer grids."""

    refinement: Refinement
    departure: tuple[np.ndarray, ...]  # for each run: |Dist - the scheme's own solution from exact arithmetic|
    tolerance: float
    t: np.ndarray  # (k,) first time at which the departure exceeds the tolerance; infinite if never
    predicted: np.ndarray  # (k,) the same for the stated sawtooth, in closed form; infinite without one


def heat_onset(
    ns: Iterable[int],
    courant: float = 0.02,
    tolerance: float = 1e-2,
    sawtooth: float = 0.0,
    t_end: float | None = None,
    snapshots: Iterable[float] = (),
) -> HeatOnset:
    """March u_t = -u_xx from sin x on grids ``ns`` with dt = courant h^2 and see when the grid takes over.

    In exact arithmetic each step multiplies sin x by 1 + dt (4/h^2) sin^2(h/2). Whatever lives at the grid's own
    wavenumber pi/h is multiplied by 1 + 4 courant, so that a seed of size s reaches ``tolerance`` at::

        t = dt ln(tolerance/s)/ln(1 + 4 courant),   near ln(tolerance/s) h^2/4 for small dt

    Halving h divides it by four.

    Parameters
    ----------
    ns               grids, of multiples of four points (so that pi/2, where sin x is largest, is a grid point)
    courant          dt/h^2, from 1e-6 (millions of steps) to 1e6
    tolerance        the departure that counts as visible, where |u| is about 1
    sawtooth         amplitude of a stated seed (-1)^j; with 0 round-off is the only seed
    t_end            where the runs end, if they have not blown up; left out, when each grid has surely taken over
    snapshots        times in [0, t_end] at which the fields are kept

    Eq. (backward-heat).

    >>> t = heat_onset([16, 32], sawtooth=1e-12).t
    >>> print(f"{t[0] / t[1]:.1f}")
    4.0
    """
    ns, courant = _grids(ns), real("courant", courant, least=1e-6, most=1e6)
    tolerance = real("tolerance", tolerance, least=1e-15, most=1)
    sawtooth = real("sawtooth", sawtooth, least=0, below=tolerance)
    for n in ns:
        if n % 4:
            raise ValueError(f"ns must be multiples of four points, got {n}")
    rate = math.log1p(4 * courant)
    steps = round(math.log(1e4 * tolerance / (sawtooth or 1e-18)) / rate)  # round-off starts near 1e-17
    runs, departures, times = [], [], []
    for n in ns:
        grid = Grid(n)
        dt = courant * grid.h**2
        seed = Seed(n // 2, sawtooth, phase=0.0) if sawtooth else None
        end = steps * dt if t_end is None else t_end
        run = ftcs(BackwardHeat(), n, dt, end, record_every=1, snapshots=snapshots, seed=seed, blow_up_at=100)
        factor = amplification(BackwardHeat().symbol(1.0, grid.multiplier), dt)[0].real
        departure = np.abs(run.dist - factor ** np.arange(run.t.size))
        late = np.flatnonzero(departure > tolerance)
        runs.append(run)
        departures.append(departure)
        times.append(run.t[late[0]] if late.size else math.inf)
    steps_taken = courant * Refinement(tuple(runs)).h ** 2
    predicted = steps_taken * math.log(tolerance / sawtooth) / rate if sawtooth else np.full(len(runs), math.inf)
    return HeatOnset(Refinement(tuple(runs)), tuple(departures), tolerance, np.array(times), predicted)
