"""Where four granular laws are well posed: maps over (I, p/C) from eigenvalues, neutral curves in closed form."""

import numpy as np
from matplotlib.patches import Patch
from sidecar import close

from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    Coulomb,
    IncompressibleMuI,
    neutral_inertial_numbers,
)
from primer.granular.maps import growth_map, neutral_stress_ratio
from primer.view.granular_growth import KINDS, classify, draw_map, look
from primer.view.style import new_figure

PHI, K = 0.55, (1e4, 1e6)
I, RATIO = np.geomspace(1e-4, 10, 200), np.linspace(0.005, 1, 200)


def compute():
    friction, packing = GLASS_BEADS.friction, EXAMPLE_COMPACTION
    laws = Coulomb(friction.mu1), IncompressibleMuI(friction), CSSM(friction.mu1, packing), CIDR(friction, packing)
    return [(law, classify(*(growth_map(law, I, RATIO, packing, PHI, k) for k in K))) for law in laws]


def numbers(maps):
    out = {}
    for law, kind in maps:
        for j, (text, _, _) in enumerate(KINDS):
            share = (kind == j).sum() / np.isfinite(kind).sum()
            out[f"{type(law).__name__}, {text}"] = close(
                share, atol=2e-3, why="share of the admissible states on the map"
            )
    low, high = neutral_inertial_numbers(GLASS_BEADS.friction)
    out["neutral_low"] = close(low, rtol=1e-12, why="closed form")
    out["neutral_high"] = close(high, rtol=1e-12, why="closed form")
    return out


def draw(maps):
    figure, axes = new_figure(
        columns=4,
        width=12.5,
        height=4.4,
        sharey=True,
        title="Short waves under four laws: colours from eigenvalues at |ξ|d = $10^4$ and $10^6$, best direction; "
        f"lines in closed form (glass beads, φ = {PHI:g})",
    )
    friction = GLASS_BEADS.friction
    for ax, (law, kind) in zip(axes, maps, strict=True):
        draw_map(ax, I, RATIO, kind)
        ax.set_title(look(law)[0])
    line = {"color": "black", "lw": 1.6, "ls": "--"}
    for value in neutral_inertial_numbers(friction):
        axes[1].axvline(value, **line)
    axes[2].axhline(friction.mu1, **line)
    axes[3].plot(I, friction.alpha(I) - neutral_stress_ratio(friction, I), **line)
    notes = (
        ("everywhere ill posed", 0.03),
        (r"neutral $I$ = 0.0194, 0.840", 0.03),
        (r"$p = \mu C$: critical, ill posed" "\n" r"like $|\xi|^{2/3}$ on the line", 0.28),
        (r"$\tau/p = T(\mu, I\mu')$", 0.28),
    )
    for ax, (text, y) in zip(axes, notes, strict=True):
        ax.text(0.03, y, text, transform=ax.transAxes, fontsize=8.5, bbox={"facecolor": "white", "edgecolor": "none"})
    for ax, law in zip(axes[2:], [m[0] for m in maps[2:]], strict=True):
        top = law.p_max(PHI, I) / law.compaction.C(PHI)
        ax.plot(I, top, color="black", lw=1)
        ax.text(0.03, 0.9, "no such state: Y ≤ 0", transform=ax.transAxes, fontsize=8.5)
    axes[0].set_ylabel(r"$p/C(\phi)$")
    handles = [
        Patch(facecolor=colour, hatch=hatch, edgecolor="0.2", lw=0.4, label=text) for text, colour, hatch in KINDS
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=4, fontsize=9)
    return figure
