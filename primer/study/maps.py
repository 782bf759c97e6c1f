"""Which base states blow up on which grids: measured, cell by cell, in a table that a sweep can resume."""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, as_completed
from dataclasses import dataclass
from multiprocessing import current_process
from os import PathLike
from typing import Any

import numpy as np

from primer.checks import real, real_array, sequence, shown
from primer.problems.pde import PDE
from primer.problems.toy import Toy
from primer.schemes.ensemble import ftcs_ensemble
from primer.schemes.grid import grids
from primer.schemes.record import plan
from primer.schemes.run import Seed, Stop
from primer.study.parameter_map import parameter_map
from primer.study.stability import OVERSHOOT, stable_dt
from primer.study.table import Table
from primer.types import ArrayLike


@dataclass(frozen=True, eq=False)
class BlowUpMap:
    """Measured blow-up times of the toy system over base states a (rows) and grids n (columns).

    Attributes
    ----------
    a, n           (A,) base states and (N,) grids, as asked for
    eps, t_end     of every run
    dt             (N,) the step on each grid
    seed           amplitude of the stated seed of ``t_seeded``, in the mode n//2 - 1 of u, next to the sawtooth
    t_blow_up      (A, N) blow-up times of the plain runs, perturbed by round-off alone: infinite for a run that lives,
                   not a number for one not made
    t_seeded       (A, N) the same with the stated seed, for the plain runs that blow up; infinite for the others
    """

    a: np.ndarray
    n: np.ndarray
    eps: float
    t_end: float
    dt: np.ndarray
    seed: float
    t_blow_up: np.ndarray
    t_seeded: np.ndarray

    @property
    def done(self) -> np.ndarray:
        """(N,) whether all base states have been marched on the grid."""
        return ~np.isnan(self.t_blow_up).any(axis=0)

    @property
    def from_round_off(self) -> np.ndarray:
        """(A, N) True where the plain run blows up and only round-off makes it.

        The seed is a little above round-off: growth from round-off is overtaken by it, and the blow-up comes sooner. A
        smooth solution that runs away by itself has long left both behind.
        """
        return np.isfinite(self.t_blow_up) & (self.t_seeded < 0.98 * self.t_blow_up)


def blow_up_map(
    a_values: ArrayLike | PDE,
    n_values: Iterable[int] = (),
    eps: float = 0.01,
    t_end: float = 100.0,
    dt: float = 1e-3,
    seed: float = 1e-12,
    table: str | PathLike | None = None,
    executor: Executor | None = None,
    progress: bool = True,
    vary: Mapping[str, Any] | None = None,
    n: int = 100,
) -> Any:
    """March the toy system for every base state on every grid, and what blows up once more from a stated seed.

    Parameters
    ----------
    a_values, n_values    base states, and grids of at least 4 points; each without repeats
    eps, t_end            coefficient and end of all runs
    dt                    the longest step; a grid on which the scheme itself would need less takes that
                          (:func:`map_step`)
    seed                  amplitude of the seed
    table                 a CSV file that keeps the cells; those it holds already are not marched again. It is written
                          after each grid, so that after Ctrl-C, which returns the map as far as it has come, or a
                          crash, the same call goes on. A grid whose worker fails is named in a warning
    executor              any ``concurrent.futures.Executor``, such as a process pool or
                          ``dask.distributed.Client.get_executor()``; left out, all cores of this machine
    progress              whether to show a progress bar, on a terminal
    vary, n               with a ``PDE`` in the place of a_values: the values of any two of its parameters, such as
                          ``vary={"a": [0.5, 1.5], "eps": [0.01, 0.1]}``, one of which may be "n", the grid; and the
                          grid otherwise (:func:`primer.study.parameter_map.parameter_map`, on this machine's cores)

    Returns
    -------
    :class:`BlowUpMap`, or a ``ParameterMap``

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not allowed
    RuntimeError             if no worker of the executor lived to march a grid

    Where processes are spawned (Windows, macOS), what a script does with a process pool must stand under
    ``if __name__ == "__main__":``. Section A2.2.2.

    >>> found = blow_up_map([0.5, 1.5], [30, 100], t_end=20.0, progress=False)  # Figures 4 to 6, and one more
    >>> np.isfinite(found.t_blow_up)
    array([[False,  True],
           [False, False]])
    """
    if isinstance(a_values, PDE):
        return parameter_map(a_values, vary or {}, n, t_end, dt, seed)
    if vary is not None:
        raise ValueError(f"vary goes with a PDE, got it with {shown(a_values)}")
    a = _without_repeats("a_values", [real("a_values", x) for x in real_array("a_values", a_values).ravel().tolist()])
    ns = _without_repeats("n_values", grids("n_values", _listed(n_values)))
    eps, t_end, dt = Toy(0, eps).eps, real("t_end", t_end, least=0), real("dt", dt, above=0)
    seed = real("seed", seed, above=0)
    if executor is not None and not isinstance(executor, Executor):
        raise TypeError(f"executor must be a concurrent.futures.Executor or None, got {shown(executor)}")
    for k in ns:  # all is known to fit before anything is marched
        plan(k, dt, t_end, 10**9, (), None, 1e3, np.float64, None).refuse_if_large(fields=2, members=len(a))
    steps = [map_step(a, k, eps, dt) for k in ns]
    store = Table(table, {"eps": eps, "t_end": t_end, "seed": seed}, ("n", "dt", "a"), ("t_blow_up", "t_seeded"))
    columns = []
    for k, step in zip(ns, steps, strict=True):
        missing = [x for x in a if (k, step, x) not in store.rows]
        if missing:
            columns.append((missing, k, eps, step, t_end, seed))
    _march(columns, executor, store, progress)
    nothing = math.nan, math.nan
    cells = np.array([[store.rows.get((k, step, x), nothing) for k, step in zip(ns, steps, strict=True)] for x in a])
    cells = cells.reshape(len(a), len(ns), 2)
    return BlowUpMap(np.array(a), np.array(ns), eps, t_end, np.array(steps), seed, cells[..., 0], cells[..., 1])


def map_step(a_values: Sequence[float], n: int, eps: float, most: float = 1e-3) -> float:
    """A step small enough for no cell of a column to be the scheme's doing: ``most``, or 0.9 of the limit if less.

    Where u is large that limit is the stiffest mode's, and where u < 0 at least h^2/4; see ``stability``.
    """
    top = max(max(a_values, default=0.0) + OVERSHOOT, 0.0)
    return min(most, 0.9 * (math.pi / n) ** 2, 0.9 * stable_dt(Toy(0, eps), n, top))


def _listed(values):
    return sequence("n_values", values.ravel().tolist() if isinstance(values, np.ndarray) else values, "grids")


def _without_repeats(name, values):
    if len(set(values)) < len(values):
        raise ValueError(f"{name} must be without repeats, got {shown(values)}")
    return values


def _march(columns, executor, store, progress):
    from tqdm import tqdm

    if executor is not None and getattr(current_process(), "_inheriting", False):
        sys.exit(1)  # a spawned worker that reads a script without a main guard: its parent says so, once
    with tqdm(total=sum(len(column[0]) for column in columns), unit="cell", disable=None if progress else True) as bar:

        def keep(rows):
            store.add(rows)
            bar.update(len(rows))

        waiting: dict[Future, tuple] = {}
        lost: dict[int, BaseException] = {}
        try:
            if executor is None:  # each column takes all cores
                for column in columns:
                    keep(_column(*column))
            else:
                for column in columns:
                    try:
                        waiting[executor.submit(_column, *column)] = column
                    except BrokenExecutor as broken:  # a worker has died already
                        lost[column[1]] = broken
                for done in as_completed(waiting):
                    _, n, *_ = waiting[done]
                    if (error := done.exception()) is None or isinstance(error, KeyboardInterrupt):
                        keep(done.result())
                    else:  # one grid's worker died, or ran out of memory: the others are worth keeping
                        lost[n] = error
        except KeyboardInterrupt:
            bar.set_postfix_str("interrupted")
        finally:
            for future in waiting:
                future.cancel()
    if lost and len(lost) == len(columns) and all(isinstance(error, BrokenExecutor) for error in lost.values()):
        raise RuntimeError(
            "no worker lived to march a grid. In a script, what uses a process pool must stand under "
            'if __name__ == "__main__":, since spawned workers read the script again'
        )
    if lost:
        why = "; ".join(f"n = {n} ({type(error).__name__}: {error})" for n, error in sorted(lost.items()))
        warnings.warn(f"not marched, and not a number in the map: {why}", RuntimeWarning, stacklevel=3)


def _column(a, n, eps, dt, t_end, seed):
    """{(n, dt, a): (t_blow_up, t_seeded)} of all base states on one grid; module-level, for other processes."""
    plain = _times(a, n, eps, dt, t_end, None)
    lost = [x for x, t in zip(a, plain, strict=True) if t < math.inf]
    last = max((t for t in plain if t < math.inf), default=0.0)
    seeded = dict(zip(lost, _times(lost, n, eps, dt, last, Seed(n // 2 - 1, seed)), strict=True))
    return {(n, dt, x): (t, seeded.get(x, math.inf)) for x, t in zip(a, plain, strict=True)}


def _times(a, n, eps, dt, t_end, seed):
    runs = ftcs_ensemble([Toy(x, eps) for x in a], n, dt, t_end, record_every=10**9, seed=seed)
    if any(run.stop is Stop.INTERRUPTED for run in runs):
        raise KeyboardInterrupt
    return [run.t_stop if run.stop is Stop.BLEW_UP else math.inf for run in runs]
