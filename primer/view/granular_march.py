"""Pictures of granular waves that are marched: on three grids, in time, mode by mode; stress paths and bands."""

import numpy as np

from primer.view.style import STEADY, U, V, legend_below

_STYLES = (("#E69F00", ":"), ("#0072B2", "--"), ("#000000", "-"))  # coarse, middle, fine


def draw_wave(ax, found):
    """The velocity along the fronts at the last time that all grids reached, one line a grid."""
    wave = found.problem
    for run, (color, ls) in zip(found.runs, _STYLES, strict=True):
        states = run.states[found.strain.size - 1]
        along = states[0] if wave.incompressible else wave.frame.m @ states[:2]
        ax.plot(run.x / wave.state.d, along / wave.scale[0], color=color, ls=ls, label=f"{run.n} points")
    ax.set(xlabel="$s/d$, along the wave", ylabel=r"$u_m\,/\,\|D\|d$")


def draw_sizes(ax, found):
    """The largest distance from the base flow against strain, one line a grid; a cross where a march ended early."""
    D, end = float(found.problem.state.D), max(run.t_stop for run in found.runs)
    for run, (color, ls) in zip(found.runs, _STYLES, strict=True):
        ax.semilogy(run.t * D, run.size, color=color, ls=ls, label=f"{run.n} points")
        if run.outcome != "reached the end" and run.t_stop <= end:
            ax.plot(run.t_stop * D, run.size[-1], "x", color=color, ms=8, mew=2)
    ax.set(xlabel=r"strain $\|D\|t$", ylabel="size of the wave")


def draw_mode_growth(ax, found):
    """Growth of each mode: measured (markers, one shape a grid) and the symbol in the continuum (line)."""
    wave, D = found.problem, float(found.problem.state.D)
    xi = np.geomspace(found.growth[-1].xi[0], found.growth[-1].xi[-1], 200)
    ax.plot(xi * wave.state.d, wave.growth(xi) / D, color=STEADY, lw=1, label="symbol")
    for each, run, marker, (color, _) in zip(found.growth, found.runs, "os^", _STYLES, strict=True):
        pick = np.unique(np.geomspace(1, each.mode.size, 14).astype(int)) - 1
        ax.plot(each.xi[pick] * wave.state.d, each.measured[pick] / D, marker, ms=4.5, mfc="none", color=color,
                label=f"{run.n} points")  # fmt: skip
    ax.set_xscale("log")
    ax.set_yscale("asinh", linear_width=10)
    ax.set(xlabel=r"$|\xi|\,d$", ylabel=r"growth rate$\,/\,\|D\|$")
    top = ax.get_ylim()[1]
    ax.set_yticks([v for v in (0, 10, 100, 1e3, 1e4, 1e5) if v < top])
    ax.set_ylim(-5, top)
    ax.minorticks_off()


def draw_path(ax, law, paths, bands=()):
    """Stress paths (lines with arrows) over the yield loci at their start and end, and bands' mean stress (dots)."""
    scale = law.compaction.C0
    for name, path, color in zip("BA", paths, (V, U), strict=True):
        for phi in (path.phi[0], path.phi[-1]):
            I = path.I[-1]
            p = np.linspace(0, law.p_max(phi, I), 200)[:-1]
            ax.plot(p / scale, law.Y(p, phi, I) / scale, color="black", lw=0.8)
        ax.plot(path.p / scale, path.tau / scale, color=color, lw=2.2, label=f"from {name}")
        ax.plot(path.p[0] / scale, path.tau[0] / scale, "o", color=color)
        ax.annotate(name, (path.p[0] / scale, path.tau[0] / scale), xytext=(-12, 5), textcoords="offset points",
                    color=color, fontweight="bold")  # fmt: skip
        ax.plot(path.p[-1] / scale, path.tau[-1] / scale, "s", color=color, mfc="none")
    for band, marker, color in bands:
        ax.plot(band.p / scale, band.tau / scale, marker, color=color, ms=4, mfc="none")
    top = 1.15 * max(path.p.max() for path in paths)
    slope = paths[0].tau[-1] / paths[0].p[-1]
    ax.plot([0, top / scale], [0, slope * top / scale], color=STEADY, ls="--", label=r"critical states, $\tau = \mu p$")
    ax.set(xlabel="$p/C_0$", ylabel=r"$\|\tau\|/C_0$", xlim=(0, None), ylim=(0, None))
    legend_below(ax)


def draw_bands(ax, bands):
    """The local rate of shear across the layer at the end, over its mean, one line a grid."""
    for band, (color, ls) in zip(bands, _STYLES, strict=True):
        ax.plot(np.arange(band.n) / band.n, band.shear[-1], color=color, ls=ls, label=f"{band.n} points")
    ax.set(xlabel="place across the layer, over its height", ylabel="rate of shear over its mean")
    ax.set_ylim(top=1.2 * max(band.shear[-1].max() for band in bands))
    ax.legend(fontsize=8, ncols=3, loc="upper center", columnspacing=1, handlelength=1.5)
