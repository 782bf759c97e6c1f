"""Which parameters of an equation blow up, and when: measured over any two of them, one of which may be the grid."""

from __future__ import annotations

import hashlib
import math
import os
from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from os import PathLike
from typing import Any

import numpy as np

from primer.checks import instance, real, shown
from primer.problems.pde import PDE
from primer.schemes.block import MEMBERS
from primer.schemes.grid import Grid, grids
from primer.schemes.record import plan
from primer.study.stability import tame_dt
from primer.study.sweep import Job, an_executor, blow_up_times, overtaken, sweep, without_repeats
from primer.study.table import Table

_CELLS = 10**5  # of a map: the steps alone of so many take an hour


@dataclass(frozen=True, eq=False)
class ParameterMap:
    """Measured blow-up times of a ``PDE`` over two of its parameters, rows and columns.

    Attributes
    ----------
    problem, t_end    what was marched, to when
    names             of the parameters of rows and columns; "n" is the grid
    rows, columns     (R,) and (C,) their values
    dt                (R, C) the steps; not a number where no run has been made
    seed              amplitude of the stated seed of ``t_seeded``, in the mode n//2 - 1 of the first field
    t_blow_up         (R, C) of the plain runs, infinite for a run that lives, not a number for one not made
    t_seeded          (R, C) the same with the stated seed, for the plain runs that blow up; infinite for the others
    """

    problem: PDE
    t_end: float
    names: tuple[str, str]
    rows: np.ndarray
    columns: np.ndarray
    dt: np.ndarray
    seed: float
    t_blow_up: np.ndarray
    t_seeded: np.ndarray

    @property
    def done(self) -> np.ndarray:
        """(R, C) whether the run has been made."""
        return ~np.isnan(self.t_blow_up)

    @property
    def from_round_off(self) -> np.ndarray:
        """(R, C) True where the plain run blows up and only round-off makes it: the stated seed overtakes it."""
        return overtaken(self.t_blow_up, self.t_seeded)


def parameter_map(
    problem: PDE,
    vary: Mapping[str, Any],
    n: int = 100,
    t_end: float = 100.0,
    dt: float = 1e-3,
    seed: float = 1e-12,
    table: str | PathLike | None = None,
    executor: Executor | None = None,
    progress: bool = True,
) -> ParameterMap:
    """March a ``PDE`` by :func:`primer.ftcs` for all values of two of its parameters, as ``blow_up_map`` calls it.

    Parameters
    ----------
    problem    a complete ``PDE``, of which values are replaced
    vary       {name: values} of two parameters, without repeats; "n" is the grid
    n          the grid, where it is not varied
    t_end      the end of all runs
    dt         the longest step; a cell in which the scheme itself needs less (:func:`tame_dt`) takes that
    seed       amplitude of the seed from which what blows up is marched once more

    ``table``, ``executor`` and ``progress`` are those of :func:`primer.blow_up_map`. The table belongs to the text, the
    data and the values that are not varied; it grows by at most eight cells for each core at a time.

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not allowed
    RuntimeError             if no worker of the executor lived to march a cell
    """
    instance("problem", problem, PDE)
    names = first, second = _names(problem, vary)
    n, t_end = Grid(n).n, real("t_end", t_end, least=0)
    dt, seed = real("dt", dt, above=0), real("seed", seed, above=0)
    rows, columns = (without_repeats(f"vary {name}", _values(name, vary[name])) for name in names)
    if len(rows) * len(columns) > _CELLS:
        raise ValueError(f"vary must make at most {_CELLS} cells, got {len(rows)} x {len(columns)}")
    an_executor(executor)
    keys = [(row, column) for row in rows for column in columns]
    settings = _settings(problem, names, {"n": n, "dt": dt, "t_end": t_end, "seed": seed})
    store = Table(table, settings, names, ("dt", "t_blow_up", "t_seeded"))
    try:
        jobs = _jobs(problem, names, [key for key in keys if key not in store.rows], n, dt, t_end, seed, executor)
        sweep(jobs, executor, store, progress, stacklevel=3)
    except KeyboardInterrupt:  # before the first run
        pass
    cells = np.array([store.rows.get(key, (math.nan,) * 3) for key in keys]).reshape(len(rows), len(columns), 3)
    steps, plain, seeded = np.moveaxis(cells, -1, 0)
    return ParameterMap(problem, t_end, (first, second), np.array(rows), np.array(columns), steps, seed, plain, seeded)


def _names(problem, vary):
    if not isinstance(vary, Mapping) or len(vary) != 2:
        raise ValueError(f"vary must be a dict of two names, such as {{'a': [1, 2], 'n': [30]}}, got {shown(vary)}")
    for name in vary:
        if name != "n" and name not in problem.parameters:
            raise ValueError(f"vary must name parameters of the PDE, or n, got {shown(name)}")
    return tuple(vary)


def _values(name, given):
    values = np.ravel(given).tolist()
    return list(grids("vary n", values)) if name == "n" else [real(f"vary {name}", value) for value in values]


def _settings(problem, names, options):
    """What all cells have in common; samples and functions as a digest of their values."""
    x = Grid(64, problem.period).x

    def told(data, made):
        return {
            field: datum if isinstance(datum, str | float | complex) else hashlib.sha256(row.tobytes()).hexdigest()[:16]
            for (field, datum), row in zip(data, made, strict=True)
        }

    kept = {"text": problem.text, "initial": told(problem.start, problem.initial(x)), "period": problem.period}
    if problem.end is not None:
        kept["steady"] = told(problem.end, problem.steady(x))
    kept["parameters"] = {name: value for name, value in problem.parameters.items() if name not in names}
    return kept | {name: value for name, value in options.items() if name != "n" or "n" not in names}


def _jobs(problem, names, keys, n, dt, t_end, seed, executor):
    """The cells that are missing, by grid and step, at most eight together for each core that marches them."""
    groups: dict = {}
    for key in keys:
        chosen = dict(zip(names, key, strict=True))
        points = chosen.pop("n", n)
        pde = problem.replace(**chosen)
        step = min(dt, tame_dt(pde, points, t_end))
        groups.setdefault((points, step), []).append((key, pde))
    together = MEMBERS * ((os.cpu_count() or 1) if executor is None else 1)
    jobs = []
    for (points, step), cells in groups.items():
        asked = plan(points, step, t_end, 10**9, (), None, 1e3, np.float64, None)
        asked.refuse_if_large(len(problem.fields), members=together)  # before anything is marched
        for k in range(0, len(cells), together):
            some = cells[k : k + together]
            name = ", ".join(f"{name} = {value:g}" for name, value in zip(names, some[0][0], strict=True))
            name += f" and {len(some) - 1} more" if len(some) > 1 else ""
            jobs.append(Job(name, _march, (some, points, step, t_end, seed)))
    return jobs


def _march(cells, n, dt, t_end, seed):
    """{key: (dt, t_blow_up, t_seeded)}; module-level, for other processes."""
    times = blow_up_times([pde for _, pde in cells], n, dt, t_end, seed)
    return {key: (dt, *pair) for (key, _), pair in zip(cells, times, strict=True)}
