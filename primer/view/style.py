"""The look of every figure, and figures that are nobody's global state."""

import io
from contextlib import contextmanager
from html import escape
from pathlib import Path

import matplotlib.style
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.transforms import ScaledTranslation

_STYLE = Path(__file__).with_name("primer.mplstyle")
U, V, STEADY, ILL = "#0072B2", "#D55E00", "#666666", "#FBE3D9"  # the colours of u, v, the steady state, and u < 0

# Without dates and version numbers the same figure is the same bytes.
_METADATA = {
    "svg": {"Date": None, "Creator": None},
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
FORMATS = tuple(_METADATA)
_UNDER = 36  # points below the axes: the ticks and the label of x


@contextmanager
def styled():
    """The package's style sheet, for as long as the block lasts: make, draw and save figures inside."""
    with matplotlib.style.context(["default", _STYLE]):
        yield


def use_style():
    """Let all that matplotlib draws from now on look like this package's pictures: for a notebook, called by hand."""
    matplotlib.style.use(["default", _STYLE])


def new_figure(rows=1, columns=2, width=9.0, height=3.4, title=None, per_subplot_kw=None, **options):
    """(figure, axes): a matplotlib figure of its own, outside pyplot, with a grid of axes (sizes in inches).

    ``per_subplot_kw`` are options of single axes, by their number: {0: {"projection": "polar"}}.
    """
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    if per_subplot_kw:
        places = np.arange(rows * columns).reshape(rows, columns)
        named = figure.subplot_mosaic(places.tolist(), per_subplot_kw=per_subplot_kw, **options)
        axes = np.array([named[place] for place in places.flat]).reshape(places.shape)
    else:
        axes = figure.subplots(rows, columns, **options)
    if title:
        figure.suptitle(title, x=0.01, ha="left", fontsize=11)
    return figure, axes


def legend_below(ax, ncols=2, **options):
    """The legend under the axes, where it hides nothing, however the data move."""
    below = ax.transAxes + ScaledTranslation(0, -_UNDER / 72, ax.figure.dpi_scale_trans)
    options = {"fontsize": 8.5, "columnspacing": 1.2} | options
    return ax.legend(
        loc="upper center", bbox_to_anchor=(0.5, 0), bbox_transform=below, ncols=ncols, borderaxespad=0, **options
    )


def ticks(axis, values):
    """Label a logarithmic axis at just these values, as plain numbers."""
    axis.set_ticks(values, [f"{value:g}" for value in values])
    axis.set_ticks([], minor=True)


def save(figure, path, words=""):
    """Write ``figure`` to ``path`` as svg, png or pdf, by its ending.

    ``words`` say what it shows, in the first line and in full, to those who do not see it: an SVG has them as its
    title and its description.
    """
    ending = Path(path).suffix[1:]
    if ending != "svg" or not words:
        figure.savefig(path, format=ending, metadata=_METADATA[ending])
        return
    text = io.StringIO()
    figure.savefig(text, format=ending, metadata=_METADATA[ending])
    title, description = (escape(part) for part in (words.strip().splitlines()[0], " ".join(words.split())))
    words = f'>\n <title id="title">{title}</title>\n <desc id="desc">{description}</desc>\n'
    head, tag, rest = text.getvalue().partition("<svg ")
    named = f'{head}{tag}role="img" aria-labelledby="title" aria-describedby="desc" {rest.replace(">", words, 1)}'
    Path(path).write_text(named, encoding="utf-8", newline="\n")
