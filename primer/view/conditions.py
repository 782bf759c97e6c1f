"""Pictures of Hadamard's conditions, and of where freezing lies."""

import numpy as np

from primer.study.bounded import log_hadamard
from primer.study.tychonoff import tychonoff
from primer.view.style import STEADY, legend_below

_DASHES = ("-", "--", "-.", ":")


def draw_tychonoff(ax, times):
    """u(x, t) of Tychonoff's solution over x at some times, linear within 0.001 of 0, logarithmic beyond."""
    x = np.linspace(-2.2, 2.2, 301)
    for t, ls in zip(times, _DASHES, strict=False):
        ax.plot(x, tychonoff(x, t), ls=ls, label=f"t = {t:g}")
    ax.axhline(0, color=STEADY, lw=0.8)
    ax.set_yscale("symlog", linthresh=1e-3)
    ax.set(xlabel="x", ylabel="u, linear below 0.001", xlim=(-2.2, 2.2), ylim=(-3e-4, 5))
    legend_below(ax)


def draw_norms(ax, orders, t):
    """log10 of BC^k norms of e^{-sqrt n} sin(n x) over n, and of the largest value at time t under u_t = -u_xx."""
    n = np.arange(1.0, 1001)
    for k, ls in zip(orders, _DASHES, strict=False):
        ax.semilogx(n, log_hadamard(n, k) / np.log(10), ls=ls, label=f"data in $BC^{{{k}}}$")
    ax.semilogx(n, log_hadamard(n, 0, t) / np.log(10), color="black", lw=2, label=f"solution, t = {t:g}")
    ax.set(xlabel="n", ylabel="log₁₀ of the norm", xlim=(1, 1000), ylim=(-14, 14))
    legend_below(ax)


def draw_rates(ax, n, rates):
    """The fastest growth on grids of n, name -> rates, in a picture where 0 and large numbers have room."""
    for (name, values), marker, ls in zip(rates.items(), "os^", _DASHES, strict=False):
        ax.plot(n, values, marker=marker, ls=ls, ms=5, label=name)
    ax.set_xscale("log", base=2)
    ax.set_xticks(n, [str(k) for k in n])
    ax.set(xlabel="points, or waves", ylabel="fastest growth rate")
    legend_below(ax, ncols=1)


def draw_powers(ax, norms):
    """Norms of the powers of amplification matrices over the number of steps, name -> norms."""
    for (name, values), ls in zip(norms.items(), _DASHES, strict=False):
        ax.loglog(np.arange(1, len(values) + 1), values, ls=ls, label=name)
    ax.set(xlabel="steps m", ylabel="largest ‖Gᵐ‖ over all waves")
    legend_below(ax, ncols=1)
