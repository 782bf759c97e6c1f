"""The explorer of refinement: three grids side by side, and whether the finest of them is the best."""

import math
from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from matplotlib.axes import Axes

from primer.scenes.refinement import T_END, RefinementAnswer, refinement
from primer.view.explorers.controls import Number
from primer.view.explorers.explorer import Explorer
from primer.view.growth import draw_growth, shade_growing
from primer.view.runs import draw_dist, draw_u
from primer.view.style import STEADY, legend_below

_LINES = ("-", "--", "-.")


def draw_refinement(axes: Sequence[Axes], answer: RefinementAnswer, t: float) -> None:
    """(Dist, u, growth) of a ``RefinementAnswer`` on three axes, u at time t or where each run stopped."""
    dist, u, growth = axes
    coarsest = answer.runs[0]
    for i, (run, ls) in enumerate(zip(answer.runs, _LINES, strict=True)):
        lost = answer.measured[i] < math.inf
        label = f"N = {run.n}" + (f", to t = {run.t_stop:.3g}" if lost else "")
        draw_dist(dist, run, label=label, color=f"C{i}", ls=ls, mark=run is coarsest)
        dist.axhline(answer.floor[i], color=f"C{i}", ls=":", lw=1.2)
        draw_growth(growth, answer.xi[i], answer.rate[i], color=f"C{i}", ls=ls)
    dist.plot([], [], color=STEADY, ls=":", lw=1.2, label="floors h/sin h $-$ 1")
    now = min(t, max(run.t_stop for run in answer.runs))
    dist.axvline(now, color=STEADY, lw=0.8)
    dist.set(title="distance to the steady state", xlim=(0, T_END), ylim=(1e-5, 1e7))
    legend_below(dist)
    draw_u(u, answer.runs, [_u(run, t) for run in answer.runs], colors=[f"C{i}" for i in range(3)])
    top = 4.0 if -1 <= coarsest.problem.a <= 2 else coarsest.problem.a + 3
    u.set(ylim=(top - 7, top + 1.5), title=f"u at t = {now:.4g}, or where it stopped")
    growth.set(title=f"growth in steps of dt = {coarsest.dt:.2g}", xlim=(0, 128), ylim=(-2, 300))
    growth.set_yscale("asinh", linear_width=1)
    growth.set_yticks([-1, 0, 1, 10, 100])
    shade_growing(growth, 300)


def _u(run, t):
    """u nearest to t, or where the run stopped."""
    times = np.array(list(run.snapshots))
    if t >= run.t_stop or not times.size:
        return run.final[0]
    return run.snapshots[times[np.argmin(np.abs(times - t))]][0]


def _until(answer: RefinementAnswer) -> float:
    return max(run.t_stop for run in answer.runs)


class RefinementExplorer(Explorer):
    """Refine the grid: where the equations are well posed it helps, where they are not finer is sooner."""

    answer = staticmethod(refinement)
    draw = staticmethod(draw_refinement)
    layout: ClassVar = {"columns": 3, "width": 11.0, "height": 3.9}
    controls = (
        Number("a", "base state a", 0.5, -1.0, 2.0, 0.05),
        Number("n", "N of the coarsest", 50, 12, 64, 2),
        Number("dt", "time step dt", 1e-3, 1e-4, 3e-2, 0.05, log=True),
    )
    looks = (Number("t", "time t", T_END, 0.0, T_END, 0.5, play=250),)
    until = staticmethod(_until)
    presets: ClassVar = {
        "well posed": "a=1.5",
        "marginal": "a=1.05,n=64",
        "ill posed": "a=0,n=60",
        "ill posed, and the coarse grid looks fine": "a=0.5,n=15",
        "the step is too large": "a=1.5,dt=0.02",
        "the step is not to blame": "a=0.5,dt=0.0001",
    }
