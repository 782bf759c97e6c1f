"""The run itself, and companions with other steps and grids: where running is as cheap as foretelling, run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.schemes.ftcs import ftcs
from primer.schemes.grid import CENTRAL, Grid
from primer.schemes.lines import trace
from primer.schemes.marching import fields_of, grid_of
from primer.schemes.run import Stop

MOST = 3e9  # points times steps of the runs together: some seconds
_LOOKS = 24  # states looked at
_CHECKS = 200  # times at which a march by another step than Euler's is looked at


@dataclass(frozen=True, eq=False)
class Fate:
    """What became of a run.

    Attributes
    ----------
    n, dt       its grid and step
    t_lost      when it blew up, infinite if it did not
    t           times of the states
    states      (s, fields, n): those that it visited
    """

    n: int
    dt: float
    t_lost: float
    t: np.ndarray
    states: np.ndarray


def march(problem: Any, n: int, dt: float, t_end: float, seed, dtype, time) -> Fate:
    """Run it: forward Euler by ``ftcs``, other steps on the same differences."""
    steps = max(round(t_end / dt), 0)
    looks = np.unique(np.round(np.concatenate([np.linspace(0, steps, _LOOKS // 2), steps / 2.0 ** np.arange(12)])))
    if time.order == 1:
        run = ftcs(
            problem, n, dt, t_end, snapshots=np.minimum(looks * dt, t_end), seed=seed, dtype=dtype, progress=False
        )
        kept = {t: np.array(s) for t, s in run.snapshots.items() if np.isfinite(np.array(s)).all()}
        times = np.array(sorted(kept))
        return Fate(
            n, dt, run.t_stop if run.stop is Stop.BLEW_UP else np.inf, times, np.array([kept[t] for t in times])
        )
    if seed is not None:
        problem = _seeded(problem, n, seed)
    checks = np.unique(np.concatenate([looks, np.round(np.linspace(0, steps, _CHECKS))])).astype(int)
    counts = np.diff(checks, prepend=0)
    states, _ = trace(problem, n, CENTRAL, time, np.full(counts.size, dt), counts)
    first = np.array(fields_of(problem, "initial", grid_of(problem, n).x))
    fine = np.isfinite(states).all(axis=(1, 2)) & (
        np.abs(states).max(axis=(1, 2)) < 1e3 * max(np.abs(first).max(), 1.0)
    )
    lost = int(np.argmax(~fine)) if not fine.all() else checks.size
    t = checks * dt
    return Fate(n, dt, float(t[lost]) if lost < checks.size else np.inf, t[:lost:8], states[:lost:8])


def _seeded(problem, n, seed):
    x, angle = grid_of(problem, n).x, Grid(n).x
    fields = dict(zip(problem.fields, fields_of(problem, "initial", x), strict=True))
    fields[seed.field] = fields[seed.field] + seed(angle)
    return problem.replace(initial={name: np.asarray(f).tolist() for name, f in fields.items()})
