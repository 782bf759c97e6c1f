"""Pictures of error against wall time, and of wall time against N."""

import numpy as np
from matplotlib.lines import Line2D

from primer.view.style import legend_below

_COLOURS = {
    "FTCS": "black",
    "central 2": "#E69F00",
    "central 4": "#009E73",
    "central 6": "#0072B2",
    "Fourier": "#CC79A7",
    "reference": "#D55E00",
    "solve_ivp": "#777777",
    "py-pde": "#56B4E9",
}
_MARKERS = {  # RK45 before RK4: the first name that fits decides
    "FTCS": "s",
    "RK45": "P",
    "RK4": "o",
    "RK8": "^",
    "reference": "*",
    "LSODA": "X",
    "DOP853": "D",
    "py-pde": "v",
}


def _look(method):
    """Colour by what is done in space, marker and line by what is done in time: never by colour alone."""
    colour = next(colour for name, colour in _COLOURS.items() if method.startswith(name))
    marker = next(marker for name, marker in _MARKERS.items() if name in method)
    line = "--" if "RK4" in method and "RK45" not in method else ":" if method.startswith("solve_ivp") else "-"
    return {"color": colour, "marker": marker, "ls": line, "ms": 9 if method == "reference" else 4.5, "lw": 1.2}


def draw_work_precision(ax, study):
    """Max-norm error at t_end over wall time, one line a method; points on the Pareto front are ringed."""
    artists = []
    for method in study.methods:
        points = [p for p in study.of(method) if np.isfinite(p.error)]
        artists += ax.loglog([p.seconds for p in points], [p.error for p in points], label=method, **_look(method))
    front = [p for p in study.points if p.on_front]
    artists += ax.loglog(
        [p.seconds for p in front],
        [p.error for p in front],
        ls="",
        marker="o",
        ms=13,
        mfc="none",
        mec="black",
        mew=0.9,
        label="nothing as quick is as accurate",
    )
    ax.set(xlabel="wall time (s)", ylabel=f"largest error of u and v at t = {study.t_end:g}")
    return artists


_NAMED = {"FTCS": (6, 10), "reference": (22, -9), "py-pde": (-24, 0)}  # points beside the last of the method


def name_alone(ax, study):
    """Write at their last points the names of the methods that share neither colour nor marker with another."""
    for name, beside in _NAMED.items():
        points = [p for p in study.of(name) if np.isfinite(p.error)]
        if points:
            place = {"xytext": beside, "textcoords": "offset points", "ha": "center", "va": "center"}
            ax.annotate(name, (points[-1].seconds, points[-1].error), fontsize=8.5, color=_look(name)["color"], **place)


def keys(methods):
    """(handles of the colours, handles of the markers): what is done in space, and what in time."""
    spaces = [Line2D([], [], color=_COLOURS[name], lw=3, label=name) for name in _COLOURS if f"{name} + RK4" in methods]
    times = [Line2D([], [], label=name, **_look(f"Fourier + {name}") | {"color": "0.3"}) for name in ("RK4", "RK8")]
    return spaces, times + [Line2D([], [], label=m, **_look(m)) for m in methods if m.startswith("solve_ivp")]


def draw_effort(ax, efforts, top=10.0, ylabel="largest error of u and v"):
    """Max-norm error at t_end over work, one line an ``Effort``; a run that blew up is a cross at the upper edge."""
    for effort in efforts:
        lives = np.isfinite(effort.error)
        ax.loglog(effort.work[lives], effort.error[lives], label=effort.method, **_look(effort.method))
        lost = effort.work[~lives]
        ax.loglog(lost, np.full(lost.size, top), "x", color=_look(effort.method)["color"], ms=7, clip_on=False)
    ax.set(xlabel="work: points times evaluations", ylabel=ylabel, ylim=(1e-18, top))
    legend_below(ax)


def draw_cost(ax, cost):
    """Wall time to t_end over N, one line a method, and the slope of explicit steps that diffusion limits."""
    artists = []
    for method in dict.fromkeys(p.method for p in cost):
        points = [p for p in cost if p.method == method]
        artists += ax.loglog([p.n for p in points], [p.seconds for p in points], label=method, **_look(method))
    n = np.array(sorted({p.n for p in cost})[-3:])
    artists += ax.loglog(n, min(p.seconds for p in cost if p.n == n[0]) / 4 * (n / n[0]) ** 3, color="0.5", lw=0.8)
    ax.annotate("$N^3$", (n[1], artists[-1].get_ydata()[1]), xytext=(6, -10), textcoords="offset points", color="0.4")
    ax.set(xlabel="N", ylabel="wall time (s)")
    return artists
