"""The paper's scheme without round-off: it blows up too, the sooner the finer the grid, towards the first u = 0.

a = 0.5, eps = 0.01, dt = 0.001, in whole numbers of 126 to 280 digits with the mirror symmetry exact. (a) Dist(t): the
decay, and then the smooth solution itself is lost. (b) The time at which Dist passes 1, beside that in 64 bits, which
round-off makes earlier. A second number of digits gives the same step. Runs and times were computed once, by
tests/benchmarks/exact.py, and are read from exact.measured.json; two of them are computed again by --check.
"""

import json
from pathlib import Path

import numpy as np
from sidecar import close, same, within

from primer import Toy, exact_march, ftcs, reference
from primer.view.style import STEADY, U, V, new_figure, ticks

MEASURED = Path(__file__).with_suffix(".measured.json")
QUICK = (300, 600)  # grids that are marched again
TOY, DT = Toy(0.5), 1e-3
LOST = 1.01  # Dist begins at 1


def march(n, digits, t_end):
    return exact_march(TOY, n, DT, t_end, digits, blow_up_at=LOST)


def compute():
    rows = json.loads(MEASURED.read_text(encoding="utf-8"))
    usual = {row["n"]: ftcs(TOY, row["n"], DT, 20.0, blow_up_at=LOST).t_stop for row in rows}
    return rows, usual, reference(TOY, 0.1).horizon


def numbers(result):
    rows, usual, first = result
    claims = {"first_u_equal_to_0": close(first, rtol=1e-9, why="the reference, less its error bar")}
    for row in rows:
        n, t = row["n"], row["t"]
        if n in QUICK:
            t = march(n, row["digits"], 1.2 * t).t_stop
        claims[f"exact_{n}"] = close(t, atol=0.002, why="whole numbers: a step or two")
        claims[f"again_{n}"] = same(row["again"] == row["t"], "a second number of digits gives the same step")
        claims[f"double_{n}"] = within(usual[n], 0.85 * usual[n], 1.2 * usual[n], "seeded by round-off")
    return claims


def draw(result):
    rows, usual, first = result
    figure, (left, right) = new_figure(
        title="The paper's scheme without round-off: a = 0.5, ε = 0.01, Δt = 0.001   (system (toy-pde))"
    )
    for row, ls in zip(rows, ("-", "--", "-.", ":", "-", "--"), strict=True):
        left.loglog(row["times"], row["dist"], ls=ls, label=f"N = {row['n']}")
    left.set(xlabel="t", ylabel="Dist", xlim=(0.3, 120), ylim=(3e-4, 3), title="(a) distance from the steady state")
    ticks(left.xaxis, [0.3, 1, 3, 10, 30, 100])
    left.legend(loc="lower left", ncols=2)
    n = [row["n"] for row in rows]
    right.loglog(n, [row["t"] for row in rows], "o-", color=U, label="no round-off")
    right.loglog(n, [usual[k] for k in n], "s--", color=V, label="64 bits: from round-off")
    right.set(xlabel="N", ylabel="t at which Dist passes 1", ylim=(0.5, 150), title="(b) when it is lost")
    ticks(right.xaxis, n)
    ticks(right.yaxis, [1, 3, 10, 30, 100])
    right.legend(loc="upper right")
    for ax, line in ((left, left.axvline), (right, right.axhline)):
        line(first, color=STEADY, ls=":", lw=1.2)
        place = {"xy": (first, 0.94), "xycoords": ("data", "axes fraction"), "xytext": (4, 0)}
        if ax is right:
            place = {"xy": (0.02, first), "xycoords": ("axes fraction", "data"), "xytext": (0, 4)}
        ax.annotate(f"first u = 0: t = {first:.3f}", textcoords="offset points", fontsize=8.5, color=STEADY, **place)
    return figure


def kept(run):
    """(times, dist) of a run as it is drawn: some two hundred points, closer together at first, and the last ones."""
    last = run.t.size - 1
    pick = np.unique(np.r_[0, np.geomspace(1, last, 200), np.arange(last - 20, last + 1)].astype(int))
    return [round(float(t), 3) for t in run.t[pick]], [float(f"{d:.4g}") for d in run.dist[pick]]
