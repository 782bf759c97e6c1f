"""Pictures of growth rates against wavenumber."""

from itertools import cycle

from primer.view.style import ILL, STEADY


def draw_growth(ax, xi, rate, label=None, cut_off=None, **line):
    """max Re lambda against xi; on a grid the curve ends in a dot at the cut-off pi/h, its shortest wave.

    Returns the line.
    """
    (curve,) = ax.plot(xi, rate, label=label, **line)
    if cut_off is not None:
        ax.plot(xi[-1], rate[-1], "o", color=curve.get_color())
        ax.axvline(cut_off, color=curve.get_color(), ls=":", lw=1, zorder=0)
    ax.set(xlabel=r"wavenumber $\xi$", ylabel=r"growth rate $\max\,\mathrm{Re}\,\lambda$")
    return curve


def draw_rates(ax, xi, rates, reach):
    """max Re lambda of several equations, ``rates[name]`` of the shape of xi, between -reach and reach; log scales."""
    for (name, rate), ls in zip(rates.items(), cycle(("-", "--", "-.", ":"))):
        draw_growth(ax, xi, rate, label=name, ls=ls)
    ax.set_xscale("log")
    ax.set_yscale("symlog", linthresh=1)
    ax.set(xlim=(xi[0], xi[-1]), ylim=(-reach, reach))
    shade_growing(ax, reach)
    ax.legend(loc="upper left")


def shade_growing(ax, top, text="perturbations grow"):
    """Shade the part of the picture, up to ``top``, where the growth rate is positive."""
    ax.axhspan(0, top, color=ILL, lw=0, zorder=-1)
    ax.axhline(0, color=STEADY, lw=1, zorder=0)
    ax.annotate(
        text,
        (1, 0),
        xycoords=("axes fraction", "data"),
        xytext=(-4, 4),
        textcoords="offset points",
        ha="right",
        fontsize=8.5,
    )
