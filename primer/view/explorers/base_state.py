"""The explorer of the base state: growth curve, Dist(t) and fields of the toy system, linked."""

from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from matplotlib.axes import Axes

from primer.scenes.base_state import T_END, BaseStateAnswer, base_state
from primer.view.explorers.controls import Number
from primer.view.explorers.explorer import Explorer
from primer.view.growth import draw_growth, shade_growing
from primer.view.runs import draw_dist, draw_fields
from primer.view.style import STEADY, V, legend_below


def draw_base_state(axes: Sequence[Axes], answer: BaseStateAnswer, t: float) -> None:
    """(growth, Dist, fields) of a ``BaseStateAnswer`` on three axes, the fields at time t or where the run stopped."""
    growth, dist, fields = axes
    run = answer.run
    draw_growth(growth, answer.xi, answer.rate, label="the equations", color="black")
    draw_growth(growth, answer.grid_xi, answer.grid_rate, label=f"on N = {run.n}", cut_off=run.n / 2, ls="--", color=V)
    if answer.growth > 0:
        growth.axhline(answer.growth, color=V, ls="-.", lw=1, label=f"of the whole grid: {answer.growth:.3g}")
    shade_growing(growth, 6)
    growth.set(title="growth frozen at x = 0, (toy-mat)", xlim=(0, 128), ylim=(-2, 6))
    legend_below(growth)
    draw_dist(dist, run, label=f"Dist on N = {run.n}")
    for time, name, ls, top in ((answer.measured, "blow-up", "-", 1), (answer.predicted, "foretold", ":", 0.4)):
        if time <= T_END:  # often at one time, and so not of one height
            dist.axvline(time, ymax=top, color=V, ls=ls, lw=1.4 / top, label=f"{name}: t = {time:.3g}")
    legend_below(dist)
    dist.set(title="distance to the steady state", xlim=(0, T_END), ylim=(1e-5, 1e3))
    now = min(t, run.t_stop)
    dist.axvline(now, color=STEADY, lw=0.8)
    draw_fields(fields, run, _fields(run, now), now)
    top = 4.0 if -1 <= run.problem.a <= 2 else run.problem.a + 3
    fields.set(ylim=(top - 7, top), title=f"fields at t = {now:.4g}")


def _fields(run, t):
    """The snapshot nearest to t, or the last state where the run stopped."""
    times = np.array(list(run.snapshots))
    if t == run.t_stop or not times.size:
        return run.final
    return run.snapshots[times[np.argmin(np.abs(times - t))]]


def _until(answer: BaseStateAnswer) -> float:
    return answer.run.t_stop


class BaseStateExplorer(Explorer):
    """Move the base state a: the growth curve crosses zero, and a fine grid blows up where a coarse one looks fine."""

    answer = staticmethod(base_state)
    draw = staticmethod(draw_base_state)
    layout: ClassVar = {"columns": 3, "width": 11.0, "height": 3.9}
    controls = (
        Number("a", "base state a", 1.5, -1.0, 2.0, 0.05),
        Number("eps", "coefficient ε", 0.01, 0.001, 0.1, 0.1, log=True),
        Number("n", "grid points N", 100, 16, 256, 2),
    )
    looks = (Number("t", "time t", T_END, 0.0, T_END, 0.5, play=250),)
    until = staticmethod(_until)
    presets: ClassVar = {
        "well posed": "a=1.5",
        "marginal": "a=1.1",
        "ill posed": "a=0.5",
        "ill posed, and the coarse grid looks fine": "a=0.5,n=30",
    }
