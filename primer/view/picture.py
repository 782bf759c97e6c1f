"""A figure that is drawn again and again, quickly, and shown as a PNG."""

import io

import numpy as np
from matplotlib import rc_context
from matplotlib.legend import Legend

from primer.view.style import new_figure, styled

_DPI = 96
_RIGHT = 0.12  # inches: the layout is made once, and the last label of another answer may be longer


class Picture:
    """A figure of its own that keeps what does not change: its frames and ticks are drawn anew only if they move.

    ``layout`` are the arguments of ``new_figure``; ``draw(axes, answer, **looks)`` draws on empty axes.
    """

    def __init__(self, layout, draw):
        self._draw = draw
        with styled():
            self.figure, axes = new_figure(**layout)
        self.figure.set_dpi(_DPI)
        self.figure.get_layout_engine().set(rect=(0, 0, 1 - _RIGHT / layout["width"], 1))
        self.axes = np.ravel(axes)
        self._frames: list = [None] * len(self.axes)  # what each frame shows, and its pixels on white
        self._pixels: list = [None] * len(self.axes)

    def drawn(self, answer, looks):
        """The axes with an answer on them."""
        for ax in self.axes:
            _empty(ax)
        self._draw(self.axes, answer, **looks)
        return self.axes

    def png(self, answer, looks):
        """The picture of an answer, as bytes."""
        with styled(), rc_context({"axes.titley": 1.0}):  # titles that stay where they are
            self.drawn(answer, looks)
            self._draw_frames()
            np.asarray(self.figure.canvas.buffer_rgba())[:] = np.minimum.reduce(self._pixels)
            for ax in self.axes:
                for artist in sorted(_contents(ax), key=lambda artist: artist.get_zorder()):
                    ax.draw_artist(artist)
        return png(self.figure.canvas)

    def _draw_frames(self):
        """Lay the axes out around all that is in them, once; then draw the frames that are not as they were."""
        canvas = self.figure.canvas
        if self._frames[0] is None:  # panels that jump about are no help to the eye
            canvas.draw()
            self.figure.set_layout_engine("none")
        for k, ax in enumerate(self.axes):
            frame = (ax.axison, *ax.get_xlim(), *ax.get_ylim(), ax.get_xlabel(), ax.get_ylabel())
            if frame == self._frames[k]:
                continue
            hidden = [each for each in _contents(ax) if each.get_visible()]
            hidden += [other for other in self.axes if other is not ax]
            for artist in hidden:
                artist.set_visible(False)
            canvas.draw()
            self._frames[k], self._pixels[k] = frame, np.array(canvas.buffer_rgba())
            for artist in hidden:
                artist.set_visible(True)


def _contents(ax):
    """All that a draw function puts on axes: what is left are the frame and the ticks."""
    frame = (ax.xaxis, ax.yaxis, ax.patch, *ax.spines.values())
    return [artist for artist in ax.get_children() if not any(artist is part for part in frame)]


def _empty(ax):
    """Take off what was drawn and keep the ticks, which are slow to make."""
    for artist in (*ax.lines, *ax.patches, *ax.collections, *ax.images, *ax.texts):
        artist.remove()
    for artist in [child for child in ax.get_children() if isinstance(child, Legend)]:
        artist.remove()
    ax.set_axis_on()  # who wants none takes it off each time
    ax.set_prop_cycle(None)
    ax.relim()
    ax.autoscale(True)


def png(canvas, compress_level=1):
    """The canvas as bytes: at level 1 in half the time of the default, and hardly larger."""
    from PIL import Image

    data = io.BytesIO()
    Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3]).save(data, "png", compress_level=compress_level)
    return data.getvalue()
