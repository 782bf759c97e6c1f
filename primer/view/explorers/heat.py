"""The explorer of the backward heat equation: how soon a grid takes over, and from how little."""

import math
from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from matplotlib.axes import Axes

from primer.scenes.heat import T_END, TOLERANCE, HeatAnswer, heat
from primer.schemes.run import Stop
from primer.view.explorers.controls import Number
from primer.view.explorers.explorer import Explorer
from primer.view.growth import draw_growth
from primer.view.runs import draw_against
from primer.view.style import STEADY, legend_below

_LINES = ("-", "--")


def draw_heat(axes: Sequence[Axes], answer: HeatAnswer, t: float) -> None:
    """(solution, departure, growth) of a ``HeatAnswer`` on three axes, the solution at time t or where it stopped."""
    solution, departure, growth = axes
    run = answer.onset.refinement.runs[0]
    now, u = _u(run, t)
    draw_against(solution, run.x, u, lambda x: run.problem.exact(x, now)[0], label=f"N = {run.n}")
    stopped = ", where it stopped" if now < t and run.stop is Stop.BLEW_UP else ""
    solution.set(title=f"u at t = {now:.3g}{stopped}", ylim=(-8, 12))
    growth.loglog(answer.xi, answer.rate, color="black", ls=":", label=r"the equation: $\xi^2$")
    runs, measured = answer.onset.refinement.runs, answer.onset.t
    for i, (one, ls) in enumerate(zip(runs, _LINES, strict=True)):
        look = {"color": f"C{i}", "ls": ls}
        size = np.maximum(answer.onset.departure[i], 1e-30)
        seen = f": seen at t = {measured[i]:.3g}" if measured[i] < math.inf else ": not seen"
        departure.semilogy(one.t, size, label=f"N = {one.n}{seen}", **look)
        departure.plot([0, answer.predicted[i]], [answer.size, TOLERANCE], color=STEADY, ls=":", lw=1.4)
        departure.plot(answer.predicted[i], TOLERANCE, "o", mfc="none", color=f"C{i}")
        cut_off = answer.grid_xi[i][-1]
        draw_growth(growth, answer.grid_xi[i], answer.grid_rate[i], label=f"on N = {one.n}", cut_off=cut_off, **look)
    departure.plot([], [], "o", color=STEADY, ls=":", mfc="none", lw=1.4, label="foretold")
    departure.axhline(TOLERANCE, color=STEADY, ls="--", lw=1)
    departure.axvline(now, color=STEADY, lw=0.8)
    departure.set(title="what grows beside sin x", xlabel="t", ylabel="size", xlim=(0, T_END), ylim=(1e-17, 1e9))
    legend_below(departure, ncols=1)
    growth.set(title="growth rate of each wave", xlim=(1, 128), ylim=(0.5, 1e5))
    legend_below(growth)


def _u(run, t):
    """(time, u) nearest to t, or where the run stopped."""
    times = np.array(list(run.snapshots))
    if t >= run.t_stop or not times.size:
        return run.t_stop, run.final[0]
    time = times[np.argmin(np.abs(times - t))]
    return time, run.snapshots[time][0]


def _until(answer: HeatAnswer) -> float:
    return answer.onset.refinement.runs[0].t_stop


class HeatExplorer(Explorer):
    """Shrink the seed, the step or the spacing: the grid takes over all the same, and sooner the finer it is."""

    answer = staticmethod(heat)
    draw = staticmethod(draw_heat)
    layout: ClassVar = {"columns": 3, "width": 11.0, "height": 4.1}
    controls = (
        Number("n", "grid points N", 24, 12, 64, 4),
        Number("courant", "courant = dt/h²", 0.05, 0.01, 1.0, 0.1, log=True),
        Number("seed", "sawtooth in the data", 1e-12, 1e-16, 1e-2, 0.5, log=True),
    )
    looks = (Number("t", "time t", 0.5, 0.0, T_END, 0.01, play=100),)
    until = staticmethod(_until)
    presets: ClassVar = {
        "a sawtooth of 1e-12": "seed=1e-12",
        "the last bit is enough": "seed=0,t=0.7",
        "finer is sooner": "n=48,t=0.13",
        "smaller steps do not help": "courant=0.01,t=0.46",
        "the coarse grid looks fine": "n=12,seed=0,t=1.5",
    }
