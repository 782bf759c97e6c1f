"""The same small noise under four granular laws on three grids: where ill posed, the picture is the grid's."""

from sidecar import close

from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    BaseState,
    Coulomb,
    IncompressibleMuI,
    coefficients,
)
from primer.granular.noise import noise_after
from primer.view.granular_growth import draw_measured, draw_noise, look
from primer.view.style import new_figure

I, PHI, RATIO = 0.01, 0.55, 0.37
GRIDS, SIDE, STRAIN = (32, 64, 128), 200.0, 0.06


def compute():
    friction, packing = GLASS_BEADS.friction, EXAMPLE_COMPACTION
    laws = Coulomb(friction.mu1), IncompressibleMuI(friction), CSSM(friction.mu1, packing), CIDR(friction, packing)
    state = BaseState(RATIO * packing.C(PHI), PHI, I)
    t = STRAIN / state.D
    return [(law, coefficients(law, state), [noise_after(law, state, n, t, SIDE) for n in GRIDS]) for law in laws]


def numbers(rows):
    out = {}
    for law, c, noises in rows:
        name = type(law).__name__
        for noise in noises:
            out[f"{name}_{noise.n}_gain"] = close(noise.gain, rtol=1e-6, why="linear, no time stepping: rounding only")
            out[f"{name}_{noise.n}_symbol"] = close(noise.predicted.max() / c.D, rtol=1e-8, why="the symbol, in ||D||")
            out[f"{name}_{noise.n}_measured"] = close(
                noise.measured.max() / c.D, rtol=1e-6, why="in the noise, in ||D||"
            )
    return out


def draw(rows):
    figure, axes = new_figure(
        rows=4,
        columns=4,
        width=10.5,
        height=10.4,
        title=f"$u_1$ of the same noise after a strain $\\|D\\| t$ = {STRAIN:g}, frozen coefficients "
        f"(I = {I:g}, φ = {PHI:g}, p/C = {RATIO:g}; side {SIDE:g} d)",
    )
    for row, (law, c, noises) in zip(axes, rows, strict=True):
        name, color, ls = look(law)
        for ax, noise in zip(row, noises, strict=False):
            image = draw_noise(ax, noise)
        row[0].set_ylabel(name, fontsize=12)
        draw_measured(row[3], noises, c, color, ls)
        row[3].set_ylabel(r"growth rate$\,/\,\|D\|$", fontsize=8.5)
    figure.colorbar(
        image, ax=axes, location="bottom", fraction=0.02, aspect=50, label="$u_1$ over its largest value in the picture"
    )
    axes[0, 3].set_title("measured (markers), symbol (line)", fontsize=9.5)
    axes[0, 3].legend(loc="upper left", fontsize=8, handletextpad=0.2)
    text = "$|\\xi|\\, d$; dotted: where each\ngrid ends. Below the line: no\nmode in the best direction"
    axes[3, 3].set_xlabel(text, fontsize=8.5)
    return figure
