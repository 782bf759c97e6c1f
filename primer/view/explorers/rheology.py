"""The explorer of the granular laws: growth over direction and over |xi|, and the map of the states, linked."""

from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from matplotlib.axes import Axes
from scipy.ndimage import distance_transform_edt, label

from primer.granular.fastest import fastest
from primer.scenes.rheology import LAWS, Kind, RheologyAnswer, rheology
from primer.view.explorers.controls import Choice, Number
from primer.view.explorers.explorer import Explorer
from primer.view.granular_growth import KINDS, draw_growth, draw_map, draw_polar, frame_polar, look
from primer.view.style import STEADY, legend_below

K = np.geomspace(1e-2, 1e4, 61)
DECADES = 8  # of growth that the polar panel shows
_PAPER = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.5}


def draw_rheology(axes: Sequence[Axes], answer: RheologyAnswer, k: float) -> None:
    """(polar, growth, map) of a ``RheologyAnswer`` on three axes, the first polar, at |xi| d = k."""
    polar, growth, states = axes
    name, color, ls = look(answer.law)
    if answer.coefficients is None:
        frame_polar(polar, DECADES)
        for ax in (polar, growth):
            ax.text(0.5, 0.5, "no such flow", transform=ax.transAxes, ha="center", va="center", fontsize=12)
    else:
        c = answer.coefficients
        draw_polar(polar, c, k, DECADES, "", color, ls)
        polar.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=2, fontsize=8)
        draw_growth(growth, c, K, name, color, ls)
        _draw_law(growth, answer)
        growth.plot(k, fastest(c, k)[0] / c.D, "o", color=color, mec="black")
        growth.axvline(k, color=STEADY, lw=0.8, ls=":")
        legend_below(growth)
    polar.set_title(rf"growth over direction at $|\xi|\,d = {k:.3g}$", loc="center", pad=22)
    _frame(polar, growth)
    draw_map(states, answer.map.I, answer.map.ratio, answer.map.kind)
    for I, ratio in answer.map.edges:
        states.plot(I, ratio, color="black", ls="--", lw=1.4)
    states.plot(answer.map.I, answer.map.top, color="black", lw=1)
    x, y = np.clip(answer.state.I, *answer.map.I[[0, -1]]), np.clip(answer.ratio, *answer.map.ratio[[0, -1]])
    states.plot(x, y, "o", ms=10, mfc="white", mec="black", mew=2, clip_on=False, zorder=5)
    states.plot(x, y, "o", ms=4, color="black", clip_on=False, zorder=6)
    _name_regions(states, answer.map)
    states.set(ylabel=r"$p/C(\phi)$", title=f"{name}: what short waves do")


def _name_regions(ax, states):
    """What each region of the map is, in words, where it is widest."""
    kinds = np.nan_to_num(states.kind, nan=len(KINDS))
    for j, text in enumerate([*(text for text, _, _ in KINDS), "no such\nflow"]):
        regions, number = label(kinds == j)
        for region in range(1, number + 1):
            inside = regions == region
            if inside.mean() > 0.06:
                depth = distance_transform_edt(np.pad(inside, 1))[1:-1, 1:-1]
                widest = np.argwhere(depth == depth.max())
                row, column = widest[np.argmin(np.abs(widest - np.divide(depth.shape, 2)).sum(axis=1))]
                place = {"ha": "center", "va": "center", "fontsize": 8.5, "bbox": _PAPER}
                ax.text(states.I[column], states.ratio[row], text.replace(", ", ",\n"), **place)


def _draw_law(ax, answer):
    """What the growth becomes as |xi| -> infinity, in closed form, over the last three decades."""
    far, found = K[K >= 10], answer.found
    if answer.kind is Kind.ILL_POSED:
        power = float(found.exponent)
        rate = found.coefficient / answer.state.D * far**power
        name = r"$\propto |\xi|$" if power == 1 else rf"$\propto |\xi|^{{{found.exponent}}}$"
    elif np.isfinite(answer.limit):
        rate, name = np.full(far.shape, answer.limit), rf"limit ${answer.limit:.3g}\,\|D\|$"
    else:
        return
    ax.plot(far, rate, color="black", ls=":", lw=1.2, label=name)


def _frame(polar, growth):
    """Limits that stay, so that nothing jumps when a slider moves."""
    growth.set_xscale("log")
    growth.set_yscale("asinh", linear_width=1)
    growth.set(xlim=(K[0], K[-1]), title="largest growth over all directions")
    growth.set(yticks=[-1e3, 0, 1e3, 1e6, 1e9, 1e12], ylim=(-1e3, 1e13))
    growth.set(xlabel=r"$|\xi|\, d$", ylabel=r"largest growth rate$\,/\,\|D\|$")
    polar.set(xlim=(0, 2 * np.pi), ylim=(0, DECADES))


class RheologyExplorer(Explorer):
    """Four granular laws: at which states do short waves grow, in which direction, and does the growth have an end?"""

    answer = staticmethod(rheology)
    draw = staticmethod(draw_rheology)
    layout: ClassVar = {
        "columns": 3,
        "width": 11.0,
        "height": 4.3,
        "width_ratios": (1, 1.15, 1.15),
        "per_subplot_kw": {0: {"projection": "polar"}},
    }
    controls = (
        Choice("law", "law", "mu(I)", LAWS),
        Number("I", "inertial number I", 0.1, 1e-3, 10.0, 0.05, log=True),
        Number("ratio", "pressure p/C(φ)", 0.3, 0.02, 1.0, 0.01),
        Number("angle", "friction angle (°)", 21.0, 10.0, 32.0, 0.5),
    )
    looks = (Number("k", "wavenumber |ξ| d", 1.0, 1e-2, 10.0, 0.1, log=True),)
    presets: ClassVar = {
        "mu(I), well posed": "law=mu(I),I=0.1",
        "mu(I), marginal": "law=mu(I),I=0.02",
        "mu(I), ill posed": "law=mu(I),I=0.01",
        "Coulomb": "law=Coulomb",
        "CSSM, expanding": "law=CSSM",
        "CSSM, shrinking": "law=CSSM,ratio=0.5",
        "CIDR": "law=CIDR,ratio=0.5",
        "CIDR, growth, but bounded": "law=CIDR",
        "no such flow": "law=CIDR,ratio=0.95",
    }
