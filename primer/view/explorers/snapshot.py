"""Still pictures of an explorer's states, with their verdicts."""

from dataclasses import dataclass, field

import numpy as np

from primer.view.explorers.picture import png
from primer.view.style import new_figure, styled

_DPI = 110


@dataclass(frozen=True)
class Snapshot:
    """A picture, and in words what it shows, for places without pictures and readers who do not see them."""

    state: str
    verdict: str
    png: bytes = field(repr=False)

    def __str__(self):
        return f"[{self.state}] {self.verdict}"

    def _repr_mimebundle_(self, **_):
        return {"image/png": self.png, "text/plain": str(self)}, {"image/png": {"alt": self.verdict}}


def still(layout, draw, answer, looks):
    """A picture as bytes of a PNG, at the resolution of a page."""
    with styled():
        figure, axes = new_figure(**layout)
        figure.set_dpi(_DPI)
        draw(np.ravel(axes), answer, **looks)
        figure.canvas.draw()
    return png(figure.canvas, compress_level=9)
