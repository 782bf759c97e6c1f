"""Pictures of an equation on several grids: its fields at a time, and how far the grids are apart."""

import numpy as np

from primer.view.style import STEADY, legend_below

_LINES = ("-", "--", "-.", ":")


def draw_on_grids(ax, found, m=None, name=None):
    """One field of a ``GridComparison`` on every grid at its m-th time, by default the last that all grids reached.

    A grid that was lost before is shown at its last state. ``name`` is the field, by default the first; of a complex
    one it is the real part.
    """
    fields = found.problem.fields
    name = name or fields[0]
    m = found.last_shared if m is None else m
    for i, (x, states, n) in enumerate(zip(found.x, found.states, found.n, strict=True)):
        last = min(m, int(np.flatnonzero(np.isfinite(states[:, 0, 0]))[-1]))
        f = states[last, fields.index(name)].real
        label = f"N = {n}" + (f", lost after t = {found.t[last]:.3g}" if last < m else "")
        half = found.problem.period / 2
        ax.plot(np.append(x, half), np.append(f, f[0]), color=f"C{i % 10}", ls=_LINES[i % 4], label=label)
    ax.set(xlabel="x", ylabel=name, xlim=(-half, half), title=f"{name} at t = {found.t[m]:.3g}")
    legend_below(ax)


def draw_apart(ax, found, m=None):
    """Dist of every grid over time, and how far successive grids are apart; a cross is the end of a grid that was lost.

    The vertical line is the m-th time.
    """
    for i, (dist, n) in enumerate(zip(found.dist, found.n, strict=True)):
        ax.plot(found.t, dist, color=f"C{i % 10}", ls=_LINES[i % 4], label=f"Dist, N = {n}")
        if np.isfinite(found.lost[i]):  # a cross where the grid had its last state
            last = int(np.flatnonzero(np.isfinite(dist))[-1])
            ax.plot(found.t[last], dist[last], color=f"C{i % 10}", marker="X", ms=9, ls="")
    for i, (gap, n) in enumerate(zip(found.gap, found.n[1:], strict=True)):
        label = f"between {found.n[i]} and {n}"
        ax.plot(found.t, gap, color=f"C{(i + 1) % 10}", ls="", marker=".", ms=4, label=label)
    if m is not None:
        ax.axvline(found.t[m], color=STEADY, lw=0.8)
    ax.set_yscale("log")
    whence = "steady state" if found.problem.dist_from == "steady" else "data"
    ax.set(xlabel="t", xlim=(0, found.t[-1]), title=f"distance to the {whence}, and between grids")
    legend_below(ax)
