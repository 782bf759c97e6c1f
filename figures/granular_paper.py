"""The paper's Figures 1 to 3 (fig01, fig02, fig03): stress and deformation, C(phi) and yield loci, the base flow."""

from sidecar import close

from primer.granular import CSSM, EXAMPLE_COMPACTION, GLASS_BEADS
from primer.view.granular import draw_base_flow, draw_compaction, draw_deformation, draw_loci, draw_stress_axes
from primer.view.style import new_figure

I = 0.1  # of no consequence: CSSM does not depend on the rate
MARKED = 0.53, 0.55, 0.5675  # phi_1 < phi_2 < phi_3


def compute():
    return CSSM(GLASS_BEADS.friction.mu1, EXAMPLE_COMPACTION)


def numbers(law):
    p = law.p_critical(MARKED[1], I)
    return {
        "p_critical": close(p, rtol=1e-12, why="closed form: mu C(phi_2)"),
        "slope": close(law.Y(p, MARKED[1], I) / p, rtol=1e-12, why="mu, eq. (crit-state-line)"),
    }


def draw(law):
    figure, axes = new_figure(
        rows=2,
        columns=3,
        width=11.5,
        height=7.2,
        title=f"The constitutive relations in pictures   (paper: Figures 1 to 3; CSSM, $\\mu = {law.mu:.3f}$)\n",
    )
    draw_stress_axes(axes[0, 0])
    axes[0, 0].set_title("(1a) stress axes, compression inwards", pad=18)
    draw_deformation(axes[0, 1])
    axes[0, 1].set_title("(1b) a deformation aligned with it")
    draw_base_flow(axes[0, 2])
    axes[0, 2].set_title(r"(3) base flow, $\partial_1 u_1 = -1$, $\partial_2 u_2 = 1/2$")
    draw_compaction(axes[1, 0], law.compaction, MARKED)
    axes[1, 0].set_title(r"(2a) strength $C(\phi) = C_0\, z/(1-z)$")
    draw_loci(axes[1, 1], law, MARKED, I)
    axes[1, 1].set_title(r"(2b) yield loci $Y = 2\mu p - p^2/C$, $\phi_1 < \phi_2 < \phi_3$")
    axes[1, 2].set_axis_off()
    axes[1, 2].text(
        0,
        0.95,
        "Before its top a yield locus rises, f > 0:\nstate B dilates, weakens, and moves to\n"
        "a smaller locus. Beyond it, f < 0:\nstate A contracts, strengthens, and\n"
        "moves to a larger one. Both head for\nthe critical states, where "
        r"$\|\tau\| = \mu p$"
        "\nand the volume stays as it is.\n\n"
        "Uniform flow would get there; but where\nmaterial weakens as it deforms,\ndeformation localises, and without\n"
        "rate dependence (CSSM) the equations\nare ill posed.",
        va="top",
        fontsize=10,
        linespacing=1.5,
    )
    return figure
