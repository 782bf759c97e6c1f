"""Pictures of what can be saved: the convex logarithm, the error against the noise, and the profiles themselves."""

import numpy as np

from primer.study.cure import march_back
from primer.study.discrepancy import diffuse, log_convex, rms
from primer.view.style import STEADY, legend_below

_DASHES = ("-", "--", "-.", ":")


def draw_log_convexity(ax, profiles, T):
    """||w(s)||/||w(0)|| of each of the ``profiles``, name -> samples, and the chord of its logarithm, thin."""
    s = np.linspace(0, T, 201)
    for (name, w), ls in zip(profiles.items(), _DASHES, strict=False):
        size = np.array([rms(march_back(w, diffuse(time))) for time in s]) / rms(w)
        (line,) = ax.semilogy(s / T, size, ls=ls, label=name)
        ax.semilogy(s / T, log_convex(1.0, size[-1], s / T), color=line.get_color(), lw=0.8)
    ax.set(xlabel="s/T", ylabel="‖w(s)‖ / ‖w(0)‖")
    legend_below(ax)


def draw_saved(ax, saved):
    """Measured error against the noise, a curve a time s, over the bound of that s in the same colour, thin."""
    for j, (s, marker) in enumerate(zip(saved.s, "osv^D", strict=False)):
        (line,) = ax.loglog(saved.noise, saved.error[:, j], marker, ms=4, label=f"s = {s / saved.T:g} T")
        ax.loglog(saved.noise, saved.bound[:, j], color=line.get_color(), lw=1, ls=_DASHES[j % 4])
    ax.set(xlabel="rms of the noise, δ", ylabel="rms error at s, below its bound (line)")
    legend_below(ax)


def draw_error(ax, x, errors):
    """Answers less the truth, name -> samples."""
    ax.axhline(0, color=STEADY, lw=0.8)
    for (name, error), ls in zip(errors.items(), _DASHES, strict=False):
        ax.plot(x, error, ls=ls, lw=1.3, label=name)
    ax.set(xlabel="x", ylabel="answer - truth", xlim=(-np.pi, np.pi))
    ax.set_xticks([-np.pi, 0, np.pi], [r"$-\pi$", "0", r"$\pi$"])
    legend_below(ax)
