"""The erratum in (42b): as printed, without its factor A, it would prove critical state soil mechanics well posed."""

import numpy as np
from sidecar import close

from primer.granular import CIDR, CSSM, EXAMPLE_COMPACTION, GLASS_BEADS, BaseState, coefficients
from primer.granular.proof import chi, chi_as_printed, det_MN
from primer.view.granular import draw_cross_terms, draw_determinants
from primer.view.style import new_figure

I, PHI, RATIO = 0.1, 0.55, 0.2


def compute():
    state = BaseState(RATIO * EXAMPLE_COMPACTION.C(PHI), PHI, I)
    friction = GLASS_BEADS.friction
    laws = CSSM(friction.mu1, EXAMPLE_COMPACTION), CIDR(friction, EXAMPLE_COMPACTION)
    return [coefficients(law, state) for law in laws]


def numbers(pair):
    x = np.linspace(-1, 1, 2001)
    out = {}
    for name, c in zip(("CSSM", "CIDR"), pair, strict=True):
        out[f"{name}_A_over_t"] = close(c.A / c.t, rtol=1e-12, atol=1e-300, why="closed form")
        out[f"{name}_chi_least"] = close(chi(c, x).min() / c.t**2, rtol=1e-12, why="closed form, at the ends")
        out[f"{name}_printed_least"] = close(chi_as_printed(c, x).min() / c.t, rtol=1e-12, why="closed form")
        out[f"{name}_det_least"] = close(det_MN(c, x).min() * c.Gamma / c.t, rtol=1e-6, atol=1e-6, why="a scan of x")
    return out


def draw(pair):
    figure, (left, right) = new_figure(
        width=10.5,
        height=4.2,
        title=f"Equation (42b) and its factor A   (I = {I:g}, φ = {PHI:g}, p/C = {RATIO:g}; glass beads)",
    )
    looks = ("CSSM, A = 0", "#CC79A7", "-."), ("CIDR", "#0072B2", "-")
    rows = [(c, *look) for c, look in zip(pair, looks, strict=True)]
    draw_cross_terms(left, rows)
    draw_determinants(right, rows)
    return figure
