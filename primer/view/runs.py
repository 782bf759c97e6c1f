"""Pictures of a run of the toy system: Dist(t), and the fields at one time."""

import numpy as np

from primer.view.style import ILL, STEADY, U, V, legend_below


def draw_dist(ax, run, floor=None, label=None, color="black", mark=True, **line):
    """Dist(t) of eq. (toy-err) on a log axis; the dashed line is the first u = 0, the dotted one the scheme's floor.

    With several runs in one picture ``mark`` the first u = 0 of one of them: they are next to each other.
    """
    ax.semilogy(run.t, run.dist, color=color, label=label, **line)
    if mark and run.t_first_negative is not None:
        ax.axvline(run.t_first_negative, color=STEADY, ls="--", lw=1)
        ax.annotate(
            f"first u = 0: t = {run.t_first_negative:.3g}",
            (run.t_first_negative, 0.02),
            xycoords=("data", "axes fraction"),
            xytext=(4, 0),
            textcoords="offset points",
            fontsize=8.5,
            color=STEADY,
        )
    if floor is not None:
        ax.axhline(floor, color=STEADY, ls=":", lw=1.2)
        ax.annotate(
            f"floor h/sin h $-$ 1 = {floor:.4e}",
            (0.98, floor),
            xycoords=("axes fraction", "data"),
            xytext=(0, 4),
            textcoords="offset points",
            ha="right",
            fontsize=8.5,
            color=STEADY,
        )
    ax.set(xlabel="t", ylabel="Dist")


def draw_u(ax, runs, fields, colors, styles=("-", "--", "-.")):
    """u of several grids, ``fields`` of shape (n,) each, over the steady state; where that is negative it is shaded.

    Colours and styles tell the grids apart, as in the picture of their Dist.
    """
    x = np.linspace(-np.pi, np.pi, 257)
    steady, _ = runs[0].problem.steady(x)
    shade_negative(ax, x, steady)
    ax.plot(x, steady, color=STEADY, ls=":", lw=1.4, label=r"$a - \cos x$")
    for run, u, color, ls in zip(runs, fields, colors, styles, strict=True):
        ax.plot(np.append(run.x, np.pi), np.append(u, u[0]), color=color, ls=ls)
    ax.set(xlabel="x", ylabel="u", xlim=(-np.pi, np.pi))
    ax.set_xticks([-np.pi, 0, np.pi], [r"$-\pi$", "0", r"$\pi$"])
    legend_below(ax)


def draw_against(ax, x, u, exact, label="u"):
    """u on the grid x of the circle, dot by dot, over ``exact(x)``."""
    line = np.linspace(-np.pi, np.pi, 257)
    ax.plot(line, exact(line), color=STEADY, ls=":", lw=1.4, label="exact")
    ax.plot(np.append(x, np.pi), np.append(u, u[0]), "o-", color=U, ms=3, lw=1, label=label)
    ax.set(xlabel="x", ylabel="u", xlim=(-np.pi, np.pi))
    ax.set_xticks([-np.pi, 0, np.pi], [r"$-\pi$", "0", r"$\pi$"])
    legend_below(ax)


def draw_fields(ax, run, state, time):
    """u and v at one time over the steady state, eq. (toy-steady); where u < 0 the strip behind is shaded."""
    x = np.append(run.x, np.pi)  # the period closed
    u, v = (np.append(f, f[0]) for f in state)
    steady, _ = run.problem.steady(x)
    shade_negative(ax, x, u)
    ax.plot(x, steady, color=STEADY, ls=":", lw=1.4, label=r"$u(x,\infty) = a - \cos x$")
    ax.plot(x, u, color=U, label="u")
    ax.plot(x, v, color=V, ls="--", label="v")
    ax.set(xlabel="x", ylabel="u, v", xlim=(-np.pi, np.pi), title=f"(b) fields at t = {time:g}")
    ax.set_xticks([-np.pi, 0, np.pi], [r"$-\pi$", "0", r"$\pi$"])
    legend_below(ax)


def shade_negative(ax, x, u):
    """Shade the part of the picture where u < 0: there the equations are ill posed."""
    if (u < 0).any():
        ax.fill_between(
            x,
            0,
            1,
            where=u < 0,
            transform=ax.get_xaxis_transform(),
            color=ILL,
            lw=0,
            zorder=0,
            label="u < 0: ill posed",
        )
