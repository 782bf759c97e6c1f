"""The explorer of any PDE: its symbol, the growth of its waves with and without a grid, and the verdict."""

from collections.abc import Sequence
from fractions import Fraction
from typing import ClassVar

import numpy as np
from matplotlib.axes import Axes

from primer.analysis.puiseux import Law
from primer.scenes.pde import TOY, XI, PDEAnswer, pde
from primer.view.explorers.controls import Choice, Line, Number
from primer.view.explorers.explorer import Explorer
from primer.view.explorers.switch import Switch
from primer.view.growth import draw_growth, shade_growing
from primer.view.style import STEADY, V, legend_below

_WIDE, _TALL = 42, 20  # characters and lines of the symbol that fit beside the picture


def draw_pde(axes: Sequence[Axes], answer: PDEAnswer) -> None:
    """(growth, symbol as text) of a ``PDEAnswer`` on two axes."""
    growth, beside = axes
    draw_growth(growth, answer.xi, answer.rate, label="the equations", color="black")
    cut_off = answer.n / 2
    draw_growth(growth, answer.grid_xi, answer.grid_rate, label=f"on N = {answer.n}", cut_off=cut_off, ls="--", color=V)
    found = answer.found
    if np.isfinite(float(found.exponent)) and found.coefficient:
        far = XI[XI >= 10]
        law = Law(Fraction(found.exponent), found.coefficient)
        name = str(law).replace("lambda", "λ").replace("xi", "ξ").replace("->", "→")
        growth.plot(far, found.coefficient * far ** float(found.exponent), color=STEADY, ls=":", lw=2.5, label=name)
    top, bottom = _decades(np.nanmax(answer.rate)), min(_decades(-np.nanmin(answer.rate)), 3)
    growth.set_xscale("log")
    growth.set_yscale("asinh", linear_width=0.1)
    step = -(-max(top, bottom) // 4)
    powers = [-(10.0**j) for j in range(0, bottom + 1, step)] + [0.0] + [10.0**j for j in range(0, top + 1, step)]
    growth.set(xlim=(XI[0], XI[-1]), yticks=powers, ylim=(-2 * 10.0**bottom, 2 * 10.0**top))
    growth.set(xlabel=r"wavenumber $|\xi|$", title="growth of the frozen equations")
    shade_growing(growth, 2 * 10.0**top)
    legend_below(growth, ncols=3)
    beside.set_axis_off()
    beside.text(0, 1, _symbol_text(answer), va="top", family="monospace", fontsize=9, parse_math=False)
    beside.set(xlim=(0, 1), ylim=(0, 1), title="waves q e^(iξx + λt) obey")


def _decades(rate):
    """The power of ten that a rate stays below, at least 1."""
    return int(np.ceil(np.log10(max(rate, 10.0))))


def _symbol_text(answer):
    """The matrix as lines: row by row in columns, or entry by entry where these are too wide."""
    head = "M q = 0, M =" if answer.has_lambda else "λ q = A q, A ="
    widths = [max(len(entry) for entry in column) for column in zip(*answer.matrix, strict=True)]
    lines = [" ".join(e.rjust(w + 2) for e, w in zip(row, widths, strict=True)) for row in answer.matrix]
    if sum(widths) + 3 * len(widths) > _WIDE:
        entries = ((i, j, e) for i, row in enumerate(answer.matrix, 1) for j, e in enumerate(row, 1))
        lines = [f"({i},{j})  {entry}" for i, j, entry in entries if entry != "0"]
    lines = [line if len(line) <= _WIDE else line[: _WIDE - 3] + "..." for line in lines]
    return "\n\n".join([head, *(lines if len(lines) <= _TALL // 2 else [*lines[: _TALL // 2 - 1], "..."])])


class PDEExplorer(Explorer):
    """Type a PDE and a base state: do its short waves grow, how fast, and would a grid show it?"""

    answer = staticmethod(pde)
    draw = staticmethod(draw_pde)
    layout: ClassVar = {"columns": 2, "width": 10.0, "height": 3.9, "width_ratios": (1.5, 1)}
    controls = (
        Line("pde", "equations", TOY, rows=2),
        Line("at", "base state", "u=-0.5 v_xx=0.3 eps=0.01"),
        Switch("uniform", "uniform base state"),
        Choice("order", "terms kept", "full", ("full", "maximal")),
        Number("n", "grid points N", 64, 8, 512, 8),
    )
    presets: ClassVar = {
        "toy, u < 0": "",
        "toy, u > 0": "at=u=0.5 v_xx=0.3 eps=0.01",
        "heat": "pde=u_t = u_xx",
        "backward heat": "pde=u_t = -u_xx",
        "lower-order terms matter": "pde=u_t = u_xxx - u_xx",
        "the same without them": "pde=u_t = u_xxx - u_xx,order=maximal",
        "waves": "pde=u_tt = u_xx",
        "Laplace's equation, marched": "pde=u_tt = -u_xx",
        "Kuramoto-Sivashinsky": "pde=u_t = -u u_x - u_xx - u_xxxx,at=u=0,uniform=yes",
        "Schrödinger": "pde=a_t = -b_xx; b_t = a_xx",
        "ill posed across": "pde=u_t = u_xx - u_yy",
        "Stokes": "pde=u_t = -p_x + nu*(u_xx + u_yy); v_t = -p_y + nu*(v_xx + v_yy); u_x + v_y = 0,at=nu=0.01",
    }

    @staticmethod
    def _completed(values):
        """Another PDE starts clean, not at the base state of the toy system."""
        return {"at": "", **values} if values.get("pde", TOY) != TOY else values
