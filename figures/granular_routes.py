"""The numerical trap: how many digits of the bounded growth rate each eigenvalue route keeps as |xi| grows."""

import numpy as np
from sidecar import close, within

from primer.granular import CIDR, EXAMPLE_COMPACTION, GLASS_BEADS, BaseState, coefficients
from primer.granular.routes import compare
from primer.view.granular_growth import draw_routes
from primer.view.style import STEADY, new_figure

STATE = BaseState(p=0.2, phi=0.55, I=1e-3)


def compute():
    c = coefficients(CIDR(GLASS_BEADS.friction, EXAMPLE_COMPACTION), STATE)
    return compare(c, np.geomspace(1, 1e6, 13), np.cos(2 * np.radians(np.linspace(0.5, 89.5, 60))))


def numbers(routes):
    out = {}
    for name, error in zip(routes.names, routes.errors, strict=True):
        if name.startswith("closed"):
            out[f"{name}: at 1e3"] = close(error[6], rtol=1e-3, why="truncation, falling like |xi|^-2")
        elif name.startswith("QZ"):
            out[f"{name}: worst"] = within(error.max(), 1e-9, 1, "rounding: up to 2 log10 |xi| digits are lost")
        else:
            out[f"{name}: worst"] = within(error.max(), 0, 1e-9, "rounding: graded and balanced, or polished, or exact")
    return out


def draw(routes):
    figure, ax = new_figure(
        columns=1,
        width=7.2,
        height=4.6,
        title=f"CIDR at p = {STATE.p:g}, φ = {STATE.phi:g}, I = {STATE.I:g}: error of λ₃, worst of 60 directions",
    )
    draw_routes(ax, routes)
    ax.loglog(routes.k, 2e-16 * routes.k**2, color=STEADY, lw=1)
    ax.annotate(r"$\epsilon\,(|\xi| d)^2$", (3e3, 6e-9), color=STEADY, fontsize=9, rotation=30)
    figure.legend(loc="outside lower center", fontsize=8.5, ncols=3)
    return figure
