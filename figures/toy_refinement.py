"""Refine the grid: the well-posed run gets better, the ill-posed one blows up sooner (end of A2.2.2).

Top: Dist(t) on grids of 25 to 200 points with a = 1.5, and where each comes to rest: on h/sin h - 1, that is h^2/6,
the second order of the scheme. Bottom: a = 0.5. Circles blow up from round-off alone; squares from a stated seed,
10^-6 of the mode just below the grid's shortest, which makes the number reproducible. Grids below 64 points never
blow up: they hide it.
"""

import numpy as np
from sidecar import close, within

from primer import Seed, Toy
from primer.study.refinement import refine
from primer.view.runs import draw_dist
from primer.view.style import legend_below, new_figure, ticks

WELL, ILL = (25, 50, 100, 200), (60, 80, 100, 120, 150, 200, 300)


def step(n):
    return min(1e-3, 0.9 * (2 * np.pi / n) ** 2)  # at eps = 0 the scheme itself needs dt < h^2


def compute():
    return {
        "well": refine(Toy(1.5), WELL, step),
        "ill": refine(Toy(0.5), ILL, step),
        "seeded": refine(Toy(0.5), ILL, step, seed=lambda n: Seed(n // 2 - 1, 1e-6)),
    }


def numbers(result):
    well, ill, seeded = result["well"], result["ill"], result["seeded"]
    claims = {
        f"dist_end_{n}": close(d, rtol=1e-9, why="h/sin h - 1") for n, d in zip(well.n, well.dist_end, strict=True)
    }
    order = np.polyfit(np.log(well.h), np.log(well.dist_end), 1)[0]
    claims["order"] = within(order, 1.9, 2.1, "second order in space")
    for n, t, t_seeded in zip(ill.n, ill.t_blow_up, seeded.t_blow_up, strict=True):
        if np.isfinite(t):
            claims[f"t_blow_up_{n}"] = within(t, 0.85 * t, 1.15 * t, "seeded by round-off")
            claims[f"t_blow_up_seeded_{n}"] = close(t_seeded, rtol=0.01, why="seeded by 1e-6, growth fixed by the grid")
    claims["blown_up"] = close(np.isfinite(ill.t_blow_up).sum(), why="60 points hide it, all finer grids do not")
    return claims


def draw(result):
    well, ill, seeded = result["well"], result["ill"], result["seeded"]
    figure, axes = new_figure(2, 2, height=7.4, title="Refining the grid of the toy system, ε = 0.01 (section A2.2.2)")
    (well_dist, well_floor), (ill_dist, ill_time) = axes
    styles = ("-", "--", "-.", ":")
    for run, ls in zip(well.runs, styles, strict=True):
        draw_dist(well_dist, run, label=f"N = {run.n}", color=None, ls=ls)
    well_dist.set(title="(a) well posed, a = 1.5: each grid to its floor", xlim=(0, 40), ylim=(3e-5, 2))
    legend_below(well_dist, ncols=4)
    h = np.geomspace(well.h.min() / 1.6, well.h.max() * 1.3)
    well_floor.loglog(h, h / np.sin(h) - 1, color="0.4", lw=1, label="h/sin h $-$ 1 ≈ h²/6")
    well_floor.loglog(well.h, well.dist_end, "o", label="Dist at t = 100")
    for n, d in zip(well.n, well.dist_end, strict=True):
        well_floor.annotate(
            f"N = {n}", (2 * np.pi / n, d), xytext=(-8, 4), textcoords="offset points", ha="right", fontsize=8.5
        )
    well_floor.set(title="(b) the error falls as h²", xlabel="h", ylabel="Dist at the end")
    legend_below(well_floor)
    ticks(well_floor.xaxis, [0.03, 0.1, 0.3])
    for run, ls in zip([run for run in ill.runs if run.n in (60, 80, 100, 200)], styles, strict=True):
        ill_dist.semilogy(run.t, run.dist, ls=ls, label=f"N = {run.n}")
    ill_dist.axvline(ill.runs[2].t_first_negative, color="0.4", ls="--", lw=1)
    ill_dist.set(
        title="(c) ill posed, a = 0.5: finer is sooner", xlabel="t", ylabel="Dist", xlim=(0, 70), ylim=(3e-4, 1e3)
    )
    legend_below(ill_dist, ncols=4)
    ill_time.loglog(ill.n, ill.t_blow_up, "o", label="from round-off")
    ill_time.loglog(seeded.n, seeded.t_blow_up, "s", mfc="none", label="from a seed of 10⁻⁶")
    ill_time.axvspan(50, 64, color="0.93", lw=0)
    ill_time.text(56.5, 2, "N < 64: hidden", fontsize=8.5, rotation=90, ha="center")
    ill_time.set(title="(d) time of the blow-up", xlabel="N", ylabel="t", xlim=(50, 400))
    ticks(ill_time.xaxis, [60, 100, 200, 300])
    ticks(ill_time.yaxis, [2, 5, 10, 20, 50])
    legend_below(ill_time)
    return figure
