"""Growth measured in a marched wave, mode by mode, beside the growth rate of its symbol."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.checks import instance, real
from primer.granular.march import WaveRun
from primer.schemes.grid import CENTRAL


@dataclass(frozen=True, eq=False)
class ModeGrowth:
    """The fastest growth of each mode of a run; arrays have one entry a mode.

    Attributes
    ----------
    mode         waves in the period, 1, 2, ...
    xi           their wavenumber
    measured     d log|a|/dt, a the part of the mode along its fastest eigenvector, over the time that was used; nan
                 where a is in the noise of the integrator
    symbol       the growth rate of the symbol with the multiplier of the grid's derivative: sin(xi h)/h for ``CENTRAL``
    continuum    the growth rate of the symbol at xi itself
    t            (first, last) time used
    """

    mode: np.ndarray
    xi: np.ndarray
    measured: np.ndarray
    symbol: np.ndarray
    continuum: np.ndarray
    t: tuple[float, float]

    @property
    def error(self) -> float:
        """The largest of |measured - symbol| over the larger of |symbol| and one e-folding in the time used."""
        floor = 1 / (self.t[1] - self.t[0])
        known = np.isfinite(self.measured)
        gap = np.abs(self.measured - self.symbol) / np.maximum(np.abs(self.symbol), floor)
        return float(gap[known].max(initial=0.0))


def mode_growth(run: WaveRun, space: Any = CENTRAL, small: float = 1e-4) -> ModeGrowth:
    """The ``ModeGrowth`` of a run while it is small: as long as no field is further than ``small`` from the base state.

    Each mode is projected on the left eigenvector of its symbol, so that the other two waves of the same length are not
    in it. A mode that is below 1e-9 of the run's first size, or 1e-10, whichever is smaller, is left out.

    Parameters
    ----------
    run      a ``WaveRun`` with at least two recorded times at which it is small
    space    the derivatives with which it was marched
    small    in ||D|| d for velocities and in 1/1000 for phi

    Raises
    ------
    ValueError    if fewer than two recorded times are small

    The growth rates are those of eq. (e33).

    >>> from primer.granular import CIDR, EXAMPLE_COMPACTION, GLASS_BEADS, BaseState, PlaneWave, march_waves
    >>> law = CIDR(GLASS_BEADS.friction, EXAMPLE_COMPACTION)
    >>> wave = PlaneWave(law, BaseState(p=0.2, phi=0.55, I=0.1), amplitude=1e-5)
    >>> found = mode_growth(march_waves(wave, 32, 2.0, times=3))
    >>> print(found.error < 0.01, np.isfinite(found.measured).sum())  # eight waves were put in
    True 8
    """
    instance("run", run, WaveRun)
    small = real("small", small, above=0)
    large = np.flatnonzero(~(run.size <= small))
    used = large[0] if large.size else run.t.size
    if used < 2:
        raise ValueError(f"run must have two recorded times at which it is smaller than small = {small:g}, got {used}")
    problem, n = run.problem, run.n
    k = np.arange(1, (n - 1) // 2 + 1)
    h = problem.period / n
    unit = np.zeros(n)
    unit[0] = 1.0
    multiplier = np.fft.fft(space[1](unit, h))[k]
    gone = (run.states[:used] - problem.base[:, None]) / problem.scale[:, None]
    waves = np.fft.fft(gone, axis=-1)[..., k] / n  # (times, fields, modes)
    scale = problem.scale
    A = problem.symbol(multiplier) * (scale / scale[:, None])
    lam, right = np.linalg.eig(A)
    best = lam.real.argmax(axis=-1)
    left = np.take_along_axis(np.linalg.inv(right), best[:, None, None], axis=1)[:, 0]
    part = np.abs(np.einsum("kf,tfk->tk", left, waves))
    seen = np.linalg.norm(left, axis=1)
    noise = min(1e-9 * run.size[0], 1e-10) * seen
    with np.errstate(divide="ignore", invalid="ignore"):
        measured = np.log(part[-1] / part[0]) / (run.t[used - 1] - run.t[0])
    measured[(part[0] < noise) | (part[-1] < noise)] = np.nan
    xi = 2 * np.pi / problem.period * k
    symbol = np.take_along_axis(lam.real, best[:, None], axis=1)[:, 0]
    return ModeGrowth(k, xi, measured, symbol, problem.growth(xi), (float(run.t[0]), float(run.t[used - 1])))
