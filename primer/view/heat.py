"""Pictures of the backward heat equation: small data with large solutions, and data with none."""

from itertools import cycle

import numpy as np

from primer.view.style import STEADY, legend_below


def draw_modes(ax, xi, sizes, p, legend=True):
    """Sizes of the scaled modes of eq. (backward-heat-blow-up) against xi; ``sizes[t]`` may end before xi does.

    The dot on each curve is where it turns, at xi = sqrt(p/(2t)).
    """
    styles = cycle(("-", "--", "-."))
    for t, size in sizes.items():
        if t == 0:
            ax.loglog(xi, size, color=STEADY, ls=":", label="t = 0")
            continue
        (line,) = ax.loglog(xi[: size.size], size, ls=next(styles), label=f"t = {t:g}")
        turn = np.sqrt(p / (2 * t))
        ax.plot(turn, turn**-p * np.exp(p / 2), "o", color=line.get_color())
    ax.set(title=f"p = {p}", xlabel=r"wavenumber $\xi$", xlim=(xi[0], xi[-1]), ylim=(1e-16, 1e8))
    if legend:
        legend_below(ax, title="dots: turn at $\\sqrt{p/2t}$")


def draw_coefficients(ax, powers, coefficients):
    """|c_n| of |sin x|^p, for each p an array (c_0, c_2, ...): points where the series ends, else a line."""
    for p, c, ls, marker in zip(powers, coefficients, ("-", "--", "-.", ":"), "os^D", strict=True):
        n = 2 * np.arange(c.size)
        shown = (n > 0) & (c != 0)
        ends = p % 2 == 0  # and then it is a point or two, perhaps on the frame
        look = {"ms": 9, "ls": "", "clip_on": False, "zorder": 3} if ends else {"ms": 3.5, "ls": ls}
        ax.loglog(n[shown], np.abs(c[shown]), marker=marker, label=f"p = {p}", **look)
    ax.set(xlabel="n", ylabel="$|c_n|$")
    legend_below(ax)


def draw_log_norms(ax, powers, log_norms):
    """log10 of the partial sums of eq. (L2norm-sln) for |sin x|^p, cut at n; for each p an array of their ln."""
    for p, log_norm, ls in zip(powers, log_norms, ("-", "--", "-.", ":"), strict=True):
        verdict = "ends, a solution" if p % 2 == 0 else "diverges, no solution"
        ax.plot(2 * np.arange(log_norm.size), log_norm / np.log(10), ls=ls, label=f"p = {p}: {verdict}")
    ax.set(xlabel="n", ylabel=r"$\log_{10}\ \sum e^{2n^2t}\,|c_n|^2$")
    legend_below(ax)
