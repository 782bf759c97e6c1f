"""The scene of a plane wave under a granular law, marched on finer and finer grids: do they come to agree?"""

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from primer.granular.march import WaveRun, march_waves
from primer.granular.mode_growth import ModeGrowth, mode_growth
from primer.granular.state import BaseState
from primer.granular.waves import PlaneWave
from primer.schemes.grid import CENTRAL, grids

_AGREE = 0.02  # of the wave's size: grids that are nearer than this have not parted
_TIMES = 61


@dataclass(frozen=True, eq=False)
class RefinedWave:
    """One wave on N, 2 N, 4 N points.

    Attributes
    ----------
    problem    the ``PlaneWave``
    runs       a ``WaveRun`` for each grid
    growth     a ``ModeGrowth`` for each grid, from shorter runs in which the wave is small
    strain     (r,) recorded ||D|| t that all grids reached
    gap        (2, r) how far N is from 2 N, and 2 N from 4 N, on the points of N, over the size of the wave
    order      log2 of their quotient at the end; nan where the grids have parted
    parted     the strain at which 2 N and 4 N are a fiftieth of the wave apart, and not even twice as near as N and
               2 N; inf if they never are
    verdict    in words
    """

    problem: PlaneWave
    runs: tuple[WaveRun, ...]
    growth: tuple[ModeGrowth, ...]
    strain: np.ndarray = field(repr=False)
    gap: np.ndarray = field(repr=False)
    order: float
    parted: float
    verdict: str


def refine_wave(
    law: Any, state: BaseState, n: int = 64, strain: float = 0.15, period: float = 60.0, amplitude: float = 1e-3
) -> RefinedWave:
    """March a wave of six modes in the law's worst direction on n, 2 n and 4 n points, to ||D|| t = strain.

    Base flow and direction are held, as the dispersion analysis holds them, and the wave is nonlinear: see
    ``primer.granular.PlaneWave``. The derivatives are central differences of second order.
    """
    ns, D = grids("n", [n, 2 * n, 4 * n]), float(state.D)
    wave = PlaneWave(law, state, period=period * float(state.d), amplitude=amplitude, modes=6)
    runs = tuple(march_waves(wave, each, strain / D, times=_TIMES) for each in ns)
    last = min(run.t_stop for run in runs)
    common = np.flatnonzero(runs[0].t <= last * (1 + 1e-12))
    common = common[common < min(run.t.size for run in runs)]
    on = [run.states[common][..., :: run.n // n] / wave.scale[:, None] for run in runs]
    size = runs[-1].size[common]
    gap = np.array([np.abs(a - b).max(axis=(1, 2)) for a, b in pairwise(on)]) / size
    with np.errstate(divide="ignore"):
        apart = np.flatnonzero((gap[1] > _AGREE) & (gap[1] > gap[0] / 2))
        order = float(np.log2(gap[0, -1] / gap[1, -1])) if not apart.size else np.nan
    parted = float(runs[0].t[common[apart[0]]] * D) if apart.size else np.inf
    lost = not all(run.outcome == "reached the end" for run in runs)
    if parted == np.inf and lost:  # the finer ones ended before they could be compared
        parted, order = last * D, np.nan
    return RefinedWave(
        wave, runs, tuple(_grown(wave, each) for each in ns), runs[0].t[common] * D, gap, order, parted,
        _words(runs, order, parted, strain, D),
    )  # fmt: skip


def _grown(wave, n):
    """The growth of every mode of a grid, measured over three e-foldings of the fastest (or a strain of 3)."""
    h = wave.period / n
    unit = np.zeros(n)
    unit[0] = 1.0
    rates = np.linalg.eigvals(wave.symbol(np.fft.fft(CENTRAL[1](unit, h)))).real.max()
    small = wave.replace(amplitude=1e-5, modes=(n - 1) // 2)
    run = march_waves(small, n, 3 / max(float(rates), float(wave.state.D)), times=3)
    return mode_growth(run, small=0.1)


def _words(runs, order, parted, strain, D):
    ns = ", ".join(str(run.n) for run in runs)
    if np.isfinite(order):
        return f"On {ns} points the wave is the same, ever more closely: the grids converge with order {order:.1f}."
    text = f"On {ns} points it is not the same wave: the grids part at a strain of {parted:.2g}"
    ended = [run for run in runs if run.t_stop * D < strain * (1 - 1e-9)]
    if not ended:
        return text + ", and each goes its own way."
    when = ", ".join(f"{run.t_stop * D:.2g} on {run.n}" for run in ended)
    why = " and ".join(sorted({run.outcome.value for run in ended}))
    return f"{text}, and marches end ({why}) at {when} points."
