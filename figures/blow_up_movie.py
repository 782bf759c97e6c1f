"""A movie: the ill-posed toy system on three grids, the same data, one clock (end of A2.2.2).

With a = 0.5 the data of eq. (toy-initial) are marched on 30, 100 and 200 points with one time step. The finest grid is
the first to go, the paper's grid of Figure 5 follows, and the coarsest, that of Figure 6, looks fine to the end. Above
u(x) over the steady state, shaded where u < 0; below, Dist(t) of eq. (toy-err). Nothing but round-off seeds the
blow-ups, so that their times are claimed as intervals.
"""

import numpy as np
from sidecar import close, same, within

from primer import Stop, Toy
from primer.schemes.discrete import dist_floor
from primer.study.refinement import refine
from primer.view.movie import Movie
from primer.view.style import ILL, STEADY, legend_below, new_figure

GRIDS, T_END = (30, 100, 200), 17.0
FRAMES = np.round(np.arange(0, T_END + 0.05, 0.1), 1)
COLOURS, STYLES = ("#009E73", "#0072B2", "#D55E00"), (":", "--", "-")


def compute():
    return refine(Toy(a=0.5, eps=0.01), GRIDS, dt=5e-4, t_end=T_END, record_every=20, snapshots=tuple(FRAMES))


def numbers(result):
    coarse, _, fine = result.runs
    claims = {f"stop_{run.n}": same(run.stop, "only the coarse grid hides it") for run in result.runs}
    claims["t_blow_up_100"] = within(result.t_blow_up[1], 12, 16, "seeded by round-off")
    claims["t_blow_up_200"] = within(fine.t_stop, 0.85 * fine.t_stop, 1.15 * fine.t_stop, "seeded by round-off")
    claims["dist_end_30"] = close(coarse.dist[-1], rtol=1e-6, why="the smooth solution, near its floor")
    claims["floor_30"] = close(dist_floor(30), rtol=1e-12, why="h/sin h - 1")
    return claims


def draw(result):
    figure, axes = new_figure(2, 3, width=8, height=4.6, title="One ill-posed problem, one clock, three grids: a = 0.5")
    dist = figure.add_subplot(axes[1, 0].get_gridspec()[1, :])
    for ax in axes[1]:
        ax.remove()
    lines = [_panel(*each) for each in zip(axes[0], result.runs, COLOURS, strict=True)]
    curves = [
        dist.semilogy([], [], color=colour, ls=ls, lw=1.8, label=f"N = {run.n}")[0]
        for run, colour, ls in zip(result.runs, COLOURS, STYLES, strict=True)
    ]
    dist.set(xlabel="t", ylabel="Dist", xlim=(0, T_END), ylim=(1e-3, 1e3))
    legend_below(dist)
    clock = dist.axvline(0, color=STEADY, lw=1)
    axes[0, 0].set_title(f"N = {GRIDS[0]}, t = 0.0")
    figure.canvas.draw()
    figure.set_layout_engine("none")  # laid out once: nothing moves, and a frame takes a fraction of the time

    def update(t):
        clock.set_xdata([t, t])
        for run, line, curve in zip(result.runs, lines, curves, strict=True):
            gone = run.stop is Stop.BLEW_UP and run.t_stop <= t
            state = run.final if gone else run.snapshots[t]
            line.set_ydata(np.append(state[0], state[0][0]))
            now = run.t <= t + 1e-9
            curve.set_data(run.t[now], run.dist[now])
            says = f"blew up at t = {run.t_stop:.2f}" if gone else f"t = {t:.1f}"
            line.axes.set_title(f"N = {run.n}, {says}", fontsize=9.5, color="#B00020" if gone else "black")

    return Movie(figure, update, tuple(FRAMES), fps=10)


def _panel(ax, run, colour):
    """The line of u, which moves; the rest stands still."""
    x = np.append(run.x, np.pi)  # the period closed
    ax.axhspan(-3, 0, color=ILL, lw=0, zorder=0)
    ax.plot(x, run.problem.steady(x)[0], color=STEADY, lw=1)
    (line,) = ax.plot(x, x, color=colour, lw=1.6)
    ax.set(xlim=(-np.pi, np.pi), ylim=(-1.6, 2.4), xlabel="x")
    ax.set_xticks([-np.pi, 0, np.pi], [r"$-\pi$", "0", r"$\pi$"])
    if run.n == GRIDS[0]:
        ax.set_ylabel("u")
        ax.text(0, -1.45, "u < 0: ill posed", ha="center", fontsize=8.5)
        ax.text(0, 2.05, "grey: $a - \\cos x$", ha="center", fontsize=8.5, color=STEADY)
    return line
