"""Still pictures for notebooks: drawn by the figures' functions, with words for who does not see them."""

import base64
from dataclasses import dataclass, field
from html import escape

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from primer.view.picture import png
from primer.view.style import new_figure, styled

_DPI = 110


@dataclass(frozen=True)
class Still:
    """A picture, and in words what it shows."""

    alt: str
    png: bytes = field(repr=False)

    def __str__(self):
        return self.alt

    def _repr_mimebundle_(self, **_):
        return {"text/html": picture_html(self.png, self.alt), "text/plain": str(self)}


def picture_html(png, alt):
    """A PNG as HTML that holds it, with its alternative text: what metadata say of an image, no notebook shows.

    JupyterLab's dark theme gets the picture dark: its lightness turned round, its hues kept.
    """
    width, height = (int.from_bytes(png[k : k + 4], "big") for k in (16, 20))  # as the PNG's header has them
    return (
        "<style>[data-jp-theme-light=false] .primer-picture{filter:invert(1) hue-rotate(180deg)}</style>"
        f'<img class="primer-picture" alt="{escape(alt)}" width="{width}" height="{height}" decoding="sync" '
        f'style="max-width:100%;height:auto" src="data:image/png;base64,{base64.b64encode(png).decode()}">'
    )


def still(alt, *panels, height=3.4, width=None):
    """Panels side by side, each ``(draw, *arguments)`` or, with keywords, ``(draw, *arguments, {"label": ...})``.

    ``draw(ax, *arguments, **keywords)`` is any of the ``draw_*`` functions; ``alt`` says in words what there is to see.

    Raises
    ------
    TypeError    if a panel does not begin with a function
    """
    for panel in panels:
        if not isinstance(panel, tuple) or not panel or not callable(panel[0]):
            raise TypeError(f"each of panels must be (draw, *arguments), got {type(panel).__name__}")

    def draw(axes):
        for ax, (function, *arguments) in zip(axes, panels, strict=True):
            keywords = arguments.pop() if arguments and isinstance(arguments[-1], dict) else {}
            function(ax, *arguments, **keywords)

    return Still(
        str(alt), render({"columns": len(panels), "width": width or 1 + 4.0 * len(panels), "height": height}, draw)
    )


def picture(figure, alt):
    """A :class:`Still` of a matplotlib figure, as ``new_figure`` makes it; ``alt`` says in words what there is to see.

    Raises
    ------
    TypeError    if figure is not a matplotlib figure
    """
    if not isinstance(figure, Figure):
        raise TypeError(f"figure must be a matplotlib figure, got {type(figure).__name__}")
    if not hasattr(figure.canvas, "buffer_rgba"):
        FigureCanvasAgg(figure)
    figure.set_dpi(_DPI)
    with styled():
        figure.canvas.draw()
    return Still(str(alt), png(figure.canvas, compress_level=9))


def render(layout, draw):
    """A picture as bytes of a PNG, at the resolution of a page; ``draw(axes)`` draws on ``new_figure(**layout)``."""
    with styled():
        figure, axes = new_figure(**layout)
        figure.set_dpi(_DPI)
        draw(np.ravel(axes))
        figure.canvas.draw()
    return png(figure.canvas, compress_level=9)
