"""The picture of an examination: growth against the grid, with the step asked about and as dt -> 0."""

import numpy as np

from primer.view.style import STEADY, U, V, ticks

_STEPS = (("dt", "o", "--"), ("dt/2", "s", "-."), ("dt/4", "^", ":"))


def draw_examination(ax, found):
    """The fastest growth on each grid, for dt, dt/2, dt/4 and dt -> 0; where it rises, the power of n through it.

    ``found`` is a :class:`primer.Examination`; the title is its verdict. What is scheme's goes away with dt, what is
    ill posed rises with n, what is neither stays. Returns the artists; where nothing could be measured, a text.
    """
    n = np.array(found.n, dtype=float)
    ax.set(xscale="log", xlabel="grid points n", ylabel="fastest growth per unit time")
    ticks(ax.xaxis, found.n)
    ax.set_title(f"{found.kind}, dt = {found.dt:g}")
    if not np.isfinite(found.growths).any():
        return [ax.text(0.5, 0.5, "cannot tell", transform=ax.transAxes, ha="center", color=STEADY)]
    shades = np.linspace(0.35, 0.75, len(_STEPS))
    artists = [
        *(
            ax.plot(n, growth, marker=marker, ls=ls, ms=5, color=str(shade), label=label)[0]
            for growth, shade, (label, marker, ls) in zip(found.growths.T, shades, _STEPS, strict=True)
        ),
        ax.errorbar(n, found.growth, yerr=found.error, fmt="D-", ms=7, mfc="none", color=U, capsize=3, label="dt → 0"),
    ]
    if found.kind == "ill-posed":
        fine = np.geomspace(n[0], n[-1], 50)
        law = found.growth[-1] * (fine / n[-1]) ** found.exponent
        artists += ax.plot(fine, law, color=V, lw=1, label=f"$n^{{{found.exponent:.2f}}}$")
    sizes = np.abs(np.concatenate([found.growths.ravel(), found.growth]))
    top = sizes[np.isfinite(sizes)].max()
    ax.set_yscale("symlog", linthresh=max(top * 1e-3, 1e-9))
    ax.axhline(0, color=STEADY, lw=1, zorder=0)
    ax.legend()
    return artists
