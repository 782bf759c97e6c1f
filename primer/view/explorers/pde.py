"""The explorer of any PDE: its symbol, the growth of its waves with and without a grid, and the verdict."""

from collections.abc import Sequence
from fractions import Fraction
from typing import ClassVar

import numpy as np
from matplotlib.axes import Axes

from primer.analysis.puiseux import Law
from primer.scenes.at_work import AtWork, at_work, until
from primer.scenes.pde import TOY, XI, PDEAnswer
from primer.view.explorers.controls import Choice, Line, Number
from primer.view.explorers.explorer import Explorer
from primer.view.explorers.switch import Switch
from primer.view.grid_comparison import draw_apart, draw_on_grids
from primer.view.growth import draw_growth, shade_growing
from primer.view.style import STEADY, V, legend_below

_LAYERS = "h_t + (h*u)_x = 0; k_t + (k*w)_x = 0; u_t + u*u_x + (h + k)_x = 0; w_t + w*w_x + (r*h + k)_x = 0"
_WIDE, _TALL = 42, 20  # characters and lines of the symbol that fit beside the picture


def draw_pde(axes: Sequence[Axes], answer: PDEAnswer) -> None:
    """(growth, symbol as text) of a ``PDEAnswer`` on two axes."""
    growth, beside = axes
    draw_growth(growth, answer.xi, answer.rate, label="the equations", color="black")
    cut_off = answer.cut_off
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


def draw_at_work(axes: Sequence[Axes], answer: AtWork, when: float) -> None:
    """(growth, symbol as text, fields, distances) of an ``AtWork`` on four axes; fields at this share of the time."""
    draw_pde(axes[:2], answer.frozen)
    fields, apart = axes[2:]
    if answer.marched is None:
        for ax in (fields, apart):
            ax.set_axis_off()
            ax.text(0.5, 0.5, "not marched: the words below say why", ha="center", transform=ax.transAxes)
        return
    m = round(when * (answer.marched.t.size - 1))
    draw_on_grids(fields, answer.marched, m)
    draw_apart(apart, answer.marched, m)


class PDEExplorer(Explorer):
    """Type a PDE: do its short waves grow, frozen at a base state, and what does it do itself on three grids?"""

    answer = staticmethod(at_work)
    draw = staticmethod(draw_at_work)
    layout: ClassVar = {"rows": 2, "columns": 2, "width": 10.0, "height": 8.2, "width_ratios": (1.5, 1)}
    controls = (
        Line("pde", "equations", TOY, rows=2),
        Line("at", "base state", "u=-0.5 v_xx=0.3 eps=0.01"),
        Switch("uniform", "uniform base state"),
        Choice("order", "terms kept", "full", ("full", "maximal")),
        Line("initial", "data at t = 0", "u = 0.5; v = -sin(x)/2"),
        Line("period", "period in x", "2*pi"),
        Number("t_end", "march to t", 8.0, 0.1, 1000.0, 0.05, log=True),
        Number("n", "grid points N", 64, 8, 512, 8),
    )
    looks = (Number("when", "time shown / end", 1.0, 0.0, 1.0, 0.025, play=250),)
    until = staticmethod(until)
    presets: ClassVar = {
        "toy, u < 0": "",
        "toy, u > 0": "at=u=0.5 v_xx=0.3 eps=0.01,initial=u = 1.5; v = -sin(x)/2",
        "heat": "pde=u_t = u_xx,initial=u = exp(cos(x)),t_end=1,n=16",
        "backward heat": "pde=u_t = -u_xx,initial=u = exp(cos(x)),t_end=2,n=16",
        "lower-order terms matter": "pde=u_t = u_xxx - u_xx,initial=u = exp(cos(x)),t_end=1,n=16",
        "the same without them": "pde=u_t = u_xxx - u_xx,order=maximal",
        "waves": "pde=u_tt = u_xx,initial=u = exp(cos(x)); u_t = 0,n=32",
        "Laplace's equation, marched": "pde=u_tt = -u_xx,initial=u = exp(cos(x)); u_t = 0,n=16,t_end=5",
        "Kuramoto-Sivashinsky": "pde=u_t = -(u^2/2)_x - u_xx - u_xxxx,at=u=0,uniform=yes,"
        "initial=u = cos(x/8)*(1 + sin(x/8)),period=16*pi,t_end=30,n=32",
        "Cahn-Hilliard": "pde=c_t = (c^3 - c - g*c_xx)_xx,at=c=0 g=0.02,uniform=yes,"
        "initial=c = 0.1*cos(x) + 0.05*sin(2*x),t_end=1,n=32",
        "Burgers, viscosity > 0": "pde=u_t = nu*u_xx - (u^2/2)_x,at=u=1 nu=0.1,uniform=yes,initial=u = -sin(x),t_end=3",
        "Burgers, viscosity < 0": "pde=u_t = nu*u_xx - (u^2/2)_x,at=u=1 nu=-0.1,uniform=yes,initial=u = -sin(x),"
        "t_end=3,n=32",
        "good Boussinesq": "pde=u_tt = u_xx - u_xxxx + (u^2)_xx,at=u=0,uniform=yes,initial=u = 0.2*cos(x); u_t = 0,"
        "t_end=5,n=32",
        "bad Boussinesq": "pde=u_tt = u_xx + u_xxxx + (u^2)_xx,at=u=0,uniform=yes,initial=u = 0.2*cos(x); u_t = 0,"
        "t_end=2,n=16",
        "two layers, slow shear": f"pde={_LAYERS},at=h=1 k=1 u=0.05 w=-0.05 r=0.9,uniform=yes,"
        "initial=h = 1 + 0.01*cos(x); k = 1 - 0.01*cos(x); u = 0.05; w = -0.05,t_end=10,n=32",
        "two layers, fast shear": f"pde={_LAYERS},at=h=1 k=1 u=0.4 w=-0.4 r=0.9,uniform=yes,"
        "initial=h = 1 + 0.01*cos(x); k = 1 - 0.01*cos(x); u = 0.4; w = -0.4,t_end=10,n=32",
        # The four of primer.scenes.whose_fault; the last one is the equation that the program really solves.
        "whose fault: a mixture": "pde=u_t = (u^3 - u - 0.01*u_xx)_xx,at=u=0.1,uniform=yes,"
        "initial=u = 0.1 + 0.01*cos(3*x),t_end=0.2,n=32",
        "whose fault: two layers": "pde=h_t = -(h*(1 - h)*s)_x; s_t = -(s^2*(1 - 2*h)/2 + h)_x,at=h=0.5 s=1.5,"
        "uniform=yes,initial=h = 0.5 + 0.01*cos(x); s = 1.5,t_end=8,n=32",
        "whose fault: a flame": "pde=u_t = -u*u_x - u_xx - u_xxxx,at=u=0,uniform=yes,"
        "initial=u = cos(x/16)*(1 + sin(x/16)),period=32*pi,t_end=60,n=96",
        "whose fault: the stranger": "pde=u_t = -u_x - 0.01*u_xx,at=u=1,uniform=yes,initial=u = 1 + 0.01*cos(x),"
        "t_end=8,n=32",
        "Perona-Malik": "pde=u_t = (u_x/(1 + u_x^2))_x,at=u_x=2 u_xx=0,initial=u = 2*sin(x),t_end=1,n=32",
        "Schrödinger": "pde=i*a_t = -a_xx,initial=a = exp(cos(x)),t_end=1,n=32",
        "ill posed across": "pde=u_t = u_xx - u_yy",
        "Stokes": "pde=u_t = -p_x + nu*(u_xx + u_yy); v_t = -p_y + nu*(v_xx + v_yy); u_x + v_y = 0,at=nu=0.01",
    }

    @staticmethod
    def _completed(values):
        """Another PDE starts clean, not at the base state of the toy system, nor from its data."""
        return {"at": "", "initial": "", **values} if values.get("pde", TOY) != TOY else values
