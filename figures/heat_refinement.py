"""Refining the grid of the backward heat equation, eq. (backward-heat): nothing to hide behind.

From sin x the solution is e^t sin x, and every grid follows it until the shortest wave it can hold has grown from
round-off (10^-17 or so) to the size of the solution. That wave grows like e^{4t/h^2}, so the time at which the
picture is lost is divided by four each time h is halved. With a stated sawtooth of 10^-12 the time is known
beforehand.
"""

import numpy as np
from sidecar import close, within

from primer.study.refinement import heat_onset
from primer.view.style import STEADY, legend_below, new_figure, ticks

GRIDS = (16, 32, 64, 128)


def compute():
    return heat_onset(GRIDS), heat_onset(GRIDS, sawtooth=1e-12)


def numbers(result):
    free, seeded = result
    claims = {}
    for n, t, t_seeded, predicted in zip(GRIDS, free.t, seeded.t, seeded.predicted, strict=True):
        claims[f"onset_{n}"] = within(t, 0.85 * t, 1.15 * t, "seeded by round-off: ln(tol/seed) is 35, give or take 5")
        claims[f"onset_seeded_{n}"] = close(
            t_seeded, rtol=0.01, why="a stated sawtooth; read to a step, 0.4 % of the time"
        )
        claims[f"onset_predicted_{n}"] = close(predicted, rtol=1e-12, why="dt ln(tol/s)/ln(1 + 4 dt/h^2)")
    for coarse, fine, ratio in zip(GRIDS, GRIDS[1:], free.t[:-1] / free.t[1:], strict=False):
        claims[f"ratio_{coarse}_{fine}"] = within(ratio, 3.5, 4.6, "halving h divides the onset by four")
    return claims


def draw(result):
    free, seeded = result
    figure, (left, right) = new_figure(
        title="Backward heat equation $u_t = -u_{xx}$ from sin x, Δt = 0.02 h² (eq. (backward-heat))"
    )
    t = np.geomspace(1e-3, 2)
    left.loglog(t, np.exp(t), color=STEADY, ls=":", label="exact: $e^t$")
    for run, ls in zip(free.refinement.runs, ("-", "--", "-.", (0, (1, 1))), strict=True):
        left.loglog(run.t[1:], run.dist[1:], ls=ls, label=f"N = {run.n}")
    left.set(
        title="(a) every grid holds on, then lets go", xlabel="t", ylabel="max |u|", xlim=(5e-3, 2), ylim=(0.5, 100)
    )
    legend_below(left, ncols=3)
    h = free.refinement.h
    right.loglog(h, free.t, "o", label="from round-off")
    right.loglog(h, seeded.t, "s", mfc="none", label="from a sawtooth of 10⁻¹²")
    right.loglog(h, seeded.predicted, color=STEADY, lw=1, label=r"predicted for the sawtooth, $\propto h^2$")
    for n, spacing, onset in zip(GRIDS, h, free.t, strict=True):
        right.annotate(
            f"N = {n}", (spacing, onset), xytext=(-7, 3), textcoords="offset points", ha="right", fontsize=8.5
        )
    right.set(title="(b) half the spacing, a quarter of the time", xlabel="h", ylabel="t when the error is 0.01")
    right.set_xlim(h.min() / 1.8, h.max() * 1.3)
    ticks(right.xaxis, [0.05, 0.1, 0.2, 0.4])
    right.set_ylim(0.01, 8)
    legend_below(right, ncols=1)
    return figure
