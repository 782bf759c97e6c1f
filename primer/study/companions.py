"""The run itself, and companions with other steps and grids: where running is as cheap as foretelling, run."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.schemes.ftcs import ftcs
from primer.schemes.grid import CENTRAL, Grid
from primer.schemes.jacobian import rates
from primer.schemes.limit import largest_step
from primer.schemes.lines import trace
from primer.schemes.marching import fields_of, grid_of
from primer.schemes.run import Stop

MOST = 3e9  # points times steps of the runs together: some seconds
BELOW = 0.8  # of the largest step that the scheme allows
_TENFOLD = 10.0  # a rise of the short waves: more than what the data had
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


def alive(main):
    """(states, their times) before the blow-up has a hand in them."""
    good = main.t <= 0.8 * main.t_lost if math.isfinite(main.t_lost) else main.t >= 0
    good[0] = True
    return main.states[good], main.t[good]


def a_few(main):
    """[(state, time)] of those alive: at the beginning, at a quarter of their time, half, three quarters, the end."""
    states, times = alive(main)
    places = {int(np.argmin(np.abs(times - part * times[-1]))) for part in (0, 0.25, 0.5, 0.75, 1)}
    return [(states[i], float(times[i])) for i in sorted(places)]


def on_grid(state, m):
    """A state on another grid, by its trigonometric interpolant."""
    n = state.shape[1]
    if n == m:
        return state
    waves = np.fft.fft(state, axis=1) / n
    new = np.zeros((len(state), m), dtype=complex)
    k = (min(n, m) - 1) // 2
    new[:, : k + 1] = waves[:, : k + 1]
    new[:, m - k :] = waves[:, n - k :]
    found = np.fft.ifft(new * m, axis=1)
    return found if np.iscomplexobj(state) else found.real


def finer(problem, main, times, dt, t_end, seed, dtype, time):
    """The run on so many times the points, with a step that the scheme allows there; None if it takes too long."""
    n = times * main.n
    limit = min(largest_step(rates(problem, n, on_grid(state, n), t), time) for state, t in a_few(main))
    if 0 < limit < math.inf:
        dt = min(dt, BELOW * limit)
    return march(problem, n, dt, t_end, seed, dtype, time) if n * t_end / dt <= MOST else None


def short_waves(main):
    """The share of waves of two to four spacings in a state, where it has risen tenfold on the way; else 0.

    Of the largest deviation from the mean that there was.
    """
    strength = np.abs(np.fft.fft(main.states, axis=2)) ** 2
    k = np.minimum(np.arange(main.n), main.n - np.arange(main.n))
    whole = np.sqrt(strength[:, :, k > 0].sum(axis=(1, 2)).max())
    share = np.sqrt(strength[:, :, k >= main.n / 4].sum(axis=(1, 2))) / max(whole, 1e-300)
    return float(share.max()) if share.max() > _TENFOLD * share[0] else 0.0


def _seeded(problem, n, seed):
    x, angle = grid_of(problem, n).x, Grid(n).x
    fields = dict(zip(problem.fields, fields_of(problem, "initial", x), strict=True))
    fields[seed.field] = fields[seed.field] + seed(angle)
    return problem.replace(initial={name: np.asarray(f).tolist() for name, f in fields.items()})
