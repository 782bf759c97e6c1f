"""Which base states blow up on which grids: 36 x 40 cells to t = 100, over the thresholds from the Jacobian.

Left: the colour is the measured time of the blow-up; white cells live to t = 100. A dot marks cells that only round-off
makes blow up (a seed of 10^-12 brings it forward); on grids of an odd number of
points and a < 0 the threshold is lower. The dashed line is where the frozen sawtooth begins to grow, the
full one the first unstable grid. Right: the mode that grows first at a = 0.5, on 64 points.
"""

import numpy as np
from sidecar import close, within

from primer import blow_up_map, grid_threshold
from primer.view.grid_dependence import draw_map, draw_mode
from primer.view.style import legend_below, new_figure


def compute():
    return {
        "map": blow_up_map(np.linspace(-1, 1.5, 36), np.arange(10, 130, 3), progress=False),
        "thresholds": [grid_threshold(a, 0.01) for a in np.linspace(-1, 0.94, 39)],
        "paper": grid_threshold(0.5, 0.01),
    }


def numbers(result):
    cells, paper = result["map"], result["paper"]
    lost = np.isfinite(cells.t_blow_up)
    return {
        "n_threshold": close(paper.n, why="an integer, from eigenvalues known to ten digits"),
        "frozen": close(paper.frozen, rtol=1e-12, why="pi/sqrt(eps (1 - a))"),
        "growth": close(paper.mode.lam.real, rtol=1e-6, why="an eigenvalue of a well-conditioned problem"),
        "cells": close(lost.size, why="as asked for"),
        "blown_up": within(lost.sum(), 0.98 * lost.sum(), 1.02 * lost.sum(), "cells at the edge hang on round-off"),
        "from_round_off": within(cells.from_round_off.sum(), 0.9 * lost.sum(), 1.02 * lost.sum(), "nearly all of them"),
        "lost_below_frozen": close(
            sum(lost[i, cells.n < np.pi / np.sqrt(0.01 * (1 - a)) - 1].sum() for i, a in enumerate(cells.a) if a < 1),
            why="nothing grows below the frozen estimate",
        ),
    }


def draw(result):
    figure, (left, right) = new_figure(
        width=10.0, height=4.8, width_ratios=(1.5, 1),
        title="Grid dependence of the toy system, ε = 0.01: blow-up by t = 100",
    )  # fmt: skip
    image = draw_map(left, result["map"], result["thresholds"])
    left.set(title="(a) measured, and the thresholds")
    legend_below(left, fontsize=8)
    figure.colorbar(image, ax=left, label="time of the blow-up")
    mode = result["paper"].mode
    draw_mode(right, mode)
    right.set(title=f"(b) a = 0.5, N = {mode.n}:\nthe mode, {mode.parity}")
    return figure
