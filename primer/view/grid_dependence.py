"""Pictures of grid dependence: the map of blow-ups over its thresholds, ladders of precision and seeds, the cure."""

import numpy as np
from matplotlib.colors import LogNorm

from primer.view.style import ILL, STEADY, U, V, legend_below


def draw_map(ax, result, thresholds=()):
    """Blow-up times over a and n, with the thresholds (``GridThreshold``) over them; dots: only round-off makes it."""
    times = np.where(np.isfinite(result.t_blow_up), result.t_blow_up, np.nan)
    image = ax.pcolormesh(result.n, result.a, times, norm=LogNorm(1, 100), cmap="viridis_r", shading="nearest")
    i, j = np.nonzero(result.from_round_off)
    ax.plot(result.n[j], result.a[i], ".", color="black", ms=1.5, label="only round-off makes it")
    smooth = np.isfinite(result.t_blow_up) & ~result.from_round_off
    if smooth.any():
        i, j = np.nonzero(smooth)
        ax.plot(result.n[j], result.a[i], "x", color=V, ms=4, label="the smooth solution runs away")
    a = [found.a for found in thresholds]
    ax.plot([found.n for found in thresholds], a, color=V, lw=2, label="first unstable grid (Jacobian)")
    ax.plot([found.frozen for found in thresholds], a, color=V, ls="--", lw=1.4, label="frozen coefficients")
    ax.axhline(1, color=STEADY, ls=":", lw=1.2)
    ax.set(xlabel="N", ylabel="a", xlim=(result.n.min(), result.n.max()), ylim=(result.a.min(), result.a.max()))
    return image


def draw_mode(ax, mode):
    """The real part of a mode's u and v; where it lives is where the steady u is least."""
    ax.plot(mode.x, mode.v.real, color=V, ls="--", lw=1, label="v")
    ax.plot(mode.x, mode.u.real, color=U, lw=1, label="u")
    ax.set(xlabel="x", xlim=(-np.pi, np.pi), ylim=(-1.1, 1.35))
    ax.set_xticks([-np.pi, 0, np.pi], [r"$-\pi$", "0", r"$\pi$"])
    legend_below(ax)


def draw_seeds(ax, ladder):
    """Blow-up times against the seed, and the line of slope 1/growth through them."""
    amplitudes = ladder.amplitudes
    ax.semilogx(amplitudes, ladder.times, "o", color=U, label="measured")
    ax.semilogx(
        amplitudes,
        ladder.c + ladder.slope * np.log(1 / amplitudes),
        color=STEADY,
        label=f"slope {ladder.slope:.3f};  1/growth = {1 / ladder.rate:.3f}",
    )
    ax.set(xlabel="amplitude δ of the seed", ylabel="blow-up time")
    legend_below(ax, ncols=1)


def draw_ladder(ax, measured, foreseen):
    """Blow-up times of one run in several arithmetics, name -> time, over the bars that ``diagnose`` foresees."""
    names = list(measured)
    for i, name in enumerate(names):
        low, high = foreseen[name].blow_up or (np.nan, np.nan)
        ax.plot([low, high], [i, i], color=STEADY, lw=6, alpha=0.35, label="foreseen" if i == 0 else None)
    ax.plot(list(measured.values()), range(len(names)), "o", color=U, label="measured")
    ax.set_yticks(range(len(names)), names)
    ax.set(xlabel="blow-up time", xlim=(0, None))
    legend_below(ax)


def draw_last_bit(ax, plain, ulps, mirror):
    """Blow-up times: as the paper's order of operations has it, after moving one last bit, and with mirror symmetry."""
    rows = [
        ("as the paper", [plain], "o", U),
        ("one ulp", ulps, "|", U),
        ("mirrored", [mirror], "s", V),
    ]
    for i, (_, times, marker, color) in enumerate(rows):
        ax.plot(times, np.full(len(times), i), marker, color=color, ms=9 if marker == "|" else 6)
    ax.set_yticks(range(len(rows)), [name for name, *_ in rows])
    ax.set(xlabel="blow-up time", xlim=(0, 60), ylim=(-0.6, 2.6))


def draw_recovery(ax, result, parameter, **options):
    """Error against the cut-off or beta, one curve a level of noise; thin: expected; grey: without noise.

    ``options`` are set on the axes.
    """
    for noise, error, expected, marker in zip(result.noise, result.error, result.expected, "osv^D", strict=False):
        (line,) = ax.plot(result.parameters, error, marker, ms=3.5, label=f"noise {noise:.0e}")
        ax.plot(result.parameters, expected, color=line.get_color(), lw=1)
    ax.plot(result.parameters, result.bias, color=STEADY, ls=":", label="no noise")
    ax.set(xlabel=parameter, ylabel="rms error", yscale="log", **options)
    legend_below(ax)


def draw_answers(ax, x, profile, answers):
    """What is recovered with each parameter, over the true profile; ``answers`` maps labels to samples."""
    ax.axhline(0, color=ILL, lw=0.8)
    ax.plot(x, profile, color=STEADY, ls=":", lw=2, label="true")
    for (label, samples), ls in zip(answers.items(), ("-", "--", "-."), strict=False):
        ax.plot(x, samples, ls=ls, lw=1.3, label=label)
    ax.set(xlabel="x", xlim=(-np.pi, np.pi), ylim=(-2.6, 3.8))
    ax.set_xticks([-np.pi, 0, np.pi], [r"$-\pi$", "0", r"$\pi$"])
    legend_below(ax)
