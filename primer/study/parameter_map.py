"""Which parameters of an equation blow up, and when: measured over any two of them, one of which may be the grid."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.checks import instance, integer, real, shown
from primer.problems.pde import PDE
from primer.schemes.ensemble import ftcs_ensemble
from primer.schemes.record import plan
from primer.schemes.run import Seed, Stop
from primer.study.stability import tame_dt


@dataclass(frozen=True, eq=False)
class ParameterMap:
    """Measured blow-up times of a ``PDE`` over two of its parameters, rows and columns.

    Attributes
    ----------
    problem, t_end    what was marched, to when
    names             of the parameters of rows and columns; "n" is the grid
    rows, columns     (R,) and (C,) their values
    dt                (R, C) the steps
    seed              amplitude of the stated seed of ``t_seeded``, in the mode n//2 - 1 of the first field
    t_blow_up         (R, C) of the plain runs, infinite for a run that lives
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
    def from_round_off(self) -> np.ndarray:
        """(R, C) True where the plain run blows up and only round-off makes it: the stated seed overtakes it."""
        return np.isfinite(self.t_blow_up) & (self.t_seeded < 0.98 * self.t_blow_up)


def parameter_map(
    problem: PDE,
    vary: Mapping[str, Any],
    n: int = 100,
    t_end: float = 100.0,
    dt: float = 1e-3,
    seed: float = 1e-12,
) -> ParameterMap:
    """March a ``PDE`` by :func:`primer.ftcs` for all values of two of its parameters, as ``blow_up_map`` calls it.

    Parameters
    ----------
    problem    a complete ``PDE``, of which values are replaced
    vary       {name: values} of two parameters; "n" is the grid
    n          the grid, where it is not varied
    t_end      the end of all runs
    dt         the longest step; a cell in which the scheme itself needs less (:func:`tame_dt`) takes that
    seed       amplitude of the seed from which what blows up is marched once more

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not allowed
    """
    instance("problem", problem, PDE)
    if not isinstance(vary, Mapping) or len(vary) != 2:
        raise ValueError(f"vary must be a dict of two names, such as {{'a': [1, 2], 'n': [30]}}, got {shown(vary)}")
    for name in vary:
        if name != "n" and name not in problem.parameters:
            raise ValueError(f"vary must name parameters of the PDE, or n, got {shown(name)}")
    names = first, second = tuple(vary)
    n, t_end = integer("n", n, least=4), real("t_end", t_end, least=0)
    dt, seed = real("dt", dt, above=0), real("seed", seed, above=0)
    rows, columns = ([_value(name, v) for v in np.ravel(vary[name]).tolist()] for name in names)
    cells: dict = {}
    for i, row in enumerate(rows):
        for j, column in enumerate(columns):
            chosen = dict(zip(names, (row, column), strict=True))
            points = chosen.pop("n", n)
            pde = problem.replace(**chosen)
            step = min(dt, tame_dt(pde, points, t_end))
            plan(points, step, t_end, 10**9, (), None, 1e3, np.float64, None).refuse_if_large(len(pde.fields))
            cells[i, j] = pde, points, step
    shape = len(rows), len(columns)
    steps, plain, seeded = (np.full(shape, math.inf) for _ in range(3))
    groups: dict = {}
    for place, (pde, points, step) in cells.items():
        steps[place] = step
        groups.setdefault((points, step), []).append((place, pde))
    for (points, step), members in groups.items():
        _march(members, points, step, t_end, None, plain)
        lost = [(place, pde) for place, pde in members if plain[place] < math.inf]
        if lost:
            bump = Seed(points // 2 - 1, seed, problem.fields[0])
            _march(lost, points, step, max(plain[place] for place, _ in lost), bump, seeded)
    return ParameterMap(problem, t_end, (first, second), np.array(rows), np.array(columns), steps, seed, plain, seeded)


def _value(name, value):
    return integer("vary n", value, least=4) if name == "n" else real(f"vary {name}", value)


def _march(members, n, dt, t_end, seed, times):
    runs = ftcs_ensemble([pde for _, pde in members], n, dt, t_end, record_every=10**9, seed=seed)
    for (place, _), run in zip(members, runs, strict=True):
        if run.stop is Stop.INTERRUPTED:
            raise KeyboardInterrupt
        times[place] = run.t_stop if run.stop is Stop.BLEW_UP else math.inf
