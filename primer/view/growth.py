"""Pictures of growth rates against wavenumber."""

from primer.view.style import ILL, STEADY, legend_below

_LINES = ("-", "--", "-.", ":")


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


def draw_growths(ax, xi, rates, linthresh=1.0, **options):
    """Growth rates against xi, one curve for each of ``rates`` (label -> array), linear within +-``linthresh``.

    ``options`` are set on the axes. Returns the lines.
    """
    curves = [
        draw_growth(ax, xi, rate, label=label, ls=_LINES[i % len(_LINES)])
        for i, (label, rate) in enumerate(rates.items())
    ]
    ax.set_yscale("asinh", linear_width=linthresh)
    ax.set(**options)
    shade_growing(ax, ax.get_ylim()[1])
    legend_below(ax)
    return curves


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
