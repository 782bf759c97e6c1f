"""Growth over direction and over |xi| under the four granular laws, at one state they share."""

import numpy as np
from sidecar import close, same

from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    BaseState,
    Coulomb,
    IncompressibleMuI,
    coefficients,
    growth_limit,
    verdict,
)
from primer.granular.fastest import fastest
from primer.view.granular_growth import draw_laws, draw_polar, look
from primer.view.style import STEADY, new_figure

I, PHI, RATIO = 0.01, 0.55, 0.37
K = np.geomspace(1e-3, 1e4, 141)
K_POLAR = 1.0


def compute():
    friction = GLASS_BEADS.friction
    mu = friction.mu1  # that of slow flow, as everywhere
    laws = Coulomb(mu), IncompressibleMuI(friction), CSSM(mu, EXAMPLE_COMPACTION), CIDR(friction, EXAMPLE_COMPACTION)
    state = BaseState(RATIO * EXAMPLE_COMPACTION.C(PHI), PHI, I)
    return [(law, coefficients(law, state), verdict(law, state), growth_limit(law, state) / state.D) for law in laws]


def numbers(rows):
    out = {}
    for law, c, v, limit in rows:
        name = type(law).__name__
        out[f"{name}_kind"] = same(str(v.kind), "the verdict")
        out[f"{name}_coefficient"] = close(v.coefficient, rtol=1e-9, why="closed form")
        out[f"{name}_growth"] = close(fastest(c, 1e3)[0] / c.D, rtol=1e-8, why="eigenvalues at |xi| d = 1000, in ||D||")
        if v.kind == "well-posed":
            out[f"{name}_limit"] = close(limit, rtol=1e-9, why="closed form: the cap, in ||D||")
    return out


def draw(rows):
    figure, axes = new_figure(
        rows=2,
        columns=4,
        width=11.5,
        height=7.4,
        title=f"Four laws at one state: I = {I:g}, φ = {PHI:g}, p/C = {RATIO:g}, glass beads; the symbol (e26). "
        f"Above: over direction at |ξ|d = {K_POLAR:g}, growth rate / ||D|| outwards",
        subplot_kw={"projection": "polar"},
    )
    for ax, (law, c, _, _) in zip(axes[0], rows, strict=True):
        draw_polar(ax, c, K_POLAR, 5, *look(law))
    axes[0, 0].legend(loc="upper left", bbox_to_anchor=(-0.35, 1.22), fontsize=8)
    for ax in axes[1]:
        ax.remove()
    ax = figure.add_subplot(2, 1, 2)
    draw_laws(ax, rows, K)
    ax.axvline(2 * np.pi, color=STEADY, lw=1, ls=":")
    ax.annotate("wavelength = one grain", (2 * np.pi, 0.03), xycoords=("data", "axes fraction"), xytext=(4, 0),
                textcoords="offset points", fontsize=8.5, color=STEADY)  # fmt: skip
    return figure
