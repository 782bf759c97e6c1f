"""Hadamard's third condition fails: the scaled modes |xi|^-p sin(xi x) e^{xi^2 t} of eq. (backward-heat-blow-up).

At t = 0 (dotted) the modes tend to zero as xi grows, with p > k derivatives as well; at any t > 0, however small,
they tend to infinity. Each curve turns at xi = sqrt(p/(2t)): a later wavenumber for an earlier time, but always a
finite one. So an arbitrarily small perturbation makes an arbitrarily large difference after an arbitrarily short
time.
"""

import numpy as np
from sidecar import close

from primer.problems.heat import scaled_amplitude
from primer.view.heat import draw_modes
from primer.view.style import new_figure

POWERS, TIMES = (2, 6), (0.1, 0.01, 0.001)
XI = np.geomspace(1, 400, 2000)


def compute():
    # Beyond exponents of 50, far above the picture, the curves end.
    return {(p, t): scaled_amplitude(XI[XI**2 * t < 50], t, p) for p in POWERS for t in (0.0, *TIMES)}


def numbers(sizes):
    claims = {}
    for p in POWERS:
        claims[f"p{p}_t0_xi400"] = close(sizes[p, 0.0][-1], rtol=1e-9, why="|xi|^-p: small data")
        for t in TIMES:
            turn = XI[np.argmin(sizes[p, t])]
            claims[f"p{p}_t{t:g}_turns_at"] = close(turn, rtol=0.004, why="sqrt(p/(2t)), to the spacing of xi")
    return claims


def draw(sizes):
    figure, axes = new_figure(
        title=r"Small data, large solutions: $\sup_x\,|\xi|^{-p}\,|\sin(\xi x)|\,e^{\xi^2 t}$", sharey=True
    )
    for ax, p, letter in zip(axes, POWERS, "ab", strict=True):
        draw_modes(ax, XI, {t: sizes[p, t] for t in (0.0, *TIMES)}, p, legend=ax is axes[0])
        ax.set(title=f"({letter}) p = {p}")
        ax.label_outer()
    axes[0].set_ylabel("size of the mode")
    return figure
