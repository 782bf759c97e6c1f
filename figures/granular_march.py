"""Four granular laws marched on three grids, and stress paths: CIDR converges, where ill posed the grid decides."""

from sidecar import close, same, within

from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    BaseState,
    Coulomb,
    IncompressibleMuI,
    localise,
    stress_path,
)
from primer.scenes.granular_march import refine_wave
from primer.view.granular_growth import look
from primer.view.granular_march import draw_bands, draw_mode_growth, draw_path, draw_sizes, draw_wave
from primer.view.style import new_figure

I, PHI, RATIO, GRIDS = 0.01, 0.55, 0.37, (64, 128, 256)
B, A = 0.62, 1.42  # pressures of Figure 2(b) over the critical one
NOISE = {"strain": 0.2, "amplitude": 1e-3, "modes": 4, "points": 11}


def compute():
    friction, packing = GLASS_BEADS.friction, EXAMPLE_COMPACTION
    soil = CSSM(friction.mu1, packing)
    laws = Coulomb(friction.mu1), IncompressibleMuI(friction), soil, CIDR(friction, packing)
    state = BaseState(RATIO * packing.C(PHI), PHI, I)
    waves = [refine_wave(law, state, GRIDS[0]) for law in laws]
    starts = [BaseState(factor * soil.p_critical(PHI, I), PHI, I) for factor in (B, A)]
    paths = [stress_path(soil, start, strain=1.0) for start in starts]
    bands = [[localise(soil, start, n, **NOISE) for n in GRIDS] for start in starts]
    cidr = [localise(laws[3], starts[0], n, **NOISE) for n in GRIDS]
    return waves, soil, paths, bands, cidr


def numbers(found):
    waves, _, paths, bands, cidr = found
    out = {}
    for wave in waves:
        name = type(wave.problem.law).__name__
        for run, growth in zip(wave.runs, wave.growth, strict=True):
            out[f"{name}_{run.n}_error_of_growth"] = within(growth.error, 0, 0.01, "measured against the symbol: 1 %")
            out[f"{name}_{run.n}_mass_drift"] = within(run.mass_drift, 0, 1e-13, "conserved to rounding")
            out[f"{name}_{run.n}_outcome"] = same(run.outcome.value, "a stated wave, resolved in time")
    cssm, fine = waves[2], waves[3]
    out["CIDR_order"] = close(fine.order, atol=0.1, why="central differences of second order")
    for run in cssm.runs[1:]:
        strain = run.t_stop * float(run.problem.state.D)
        out[f"CSSM_{run.n}_strain"] = close(strain, rtol=0.1, why="from a stated wave, and the finest from round-off")
    for name, path in zip("BA", paths, strict=True):
        out[f"{name}_p_end"] = close(path.p[-1], rtol=1e-6, why="the load, eq. (crit-state-line)")
    for name, row in (("B", bands[0]), ("A", bands[1]), ("CIDR_B", cidr)):
        for band in row:
            label = f"{name}_{band.n}_width"
            if name == "B":
                out[label] = within(band.width[-1], 0.005, 0.3, "of the grid's making; 1/2 where the layer is uniform")
            else:
                out[label] = close(band.width[-1], rtol=0.01, why="1/2 where the layer is uniform")
    return out


def draw(found):
    waves, soil, paths, bands, cidr = found
    figure, axes = new_figure(
        rows=5,
        columns=3,
        width=11.5,
        height=15.5,
        title=f"Plane waves marched in the worst direction of each law, nonlinear; base flow and direction held "
        f"(I = {I:g}, φ = {PHI:g}, p/C = {RATIO:g})",
    )
    for row, wave in zip(axes, waves, strict=False):
        name = look(wave.problem.law)[0]
        draw_wave(row[0], wave)
        draw_sizes(row[1], wave)
        draw_mode_growth(row[2], wave)
        row[0].set_title(rf"{name}, at strain $\|D\|t$ = {wave.strain[-1]:.3g}", fontsize=10)
        lost = [run for run in wave.runs if run.outcome != "reached the end"]
        said = f"converges, order {wave.order:.2f}" if wave.order == wave.order else f"parts at {wave.parted:.2g}"
        row[1].set_title(f"{name}: {said}" + (f"; × {lost[0].outcome.value}" if lost else ""), fontsize=10)
        row[2].set_title(f"{name}: growth of each mode", fontsize=10)
    axes[3, 0].legend(fontsize=8)
    axes[0, 2].legend(fontsize=8)
    draw_path(axes[4, 0], soil, paths, [(bands[0][-1], "^", "#D55E00"), (bands[1][-1], "v", "#0072B2")])
    axes[4, 0].set_title("A1.2: CSSM to the critical state", fontsize=10)
    draw_bands(axes[4, 1], bands[0])
    widths = ", ".join(f"{band.width[-1]:.2f}" for band in bands[0])
    axes[4, 1].set_title(f"CSSM, B: half the shear in {widths}", fontsize=10)
    draw_bands(axes[4, 2], cidr)
    widths = ", ".join(f"{band.width[-1]:.2f}" for band in cidr)
    axes[4, 2].set_title(f"CIDR from B: in {widths}", fontsize=10)
    return figure
