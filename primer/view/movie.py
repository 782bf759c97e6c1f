"""Moving pictures: a figure, what changes in it from frame to frame, and how it is written."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.animation import FFMpegWriter
from matplotlib.figure import Figure

MOVIES = ("mp4", "gif")
COLOURS = 48  # of a GIF's one palette, enough for a few lines and their edges


@dataclass(frozen=True, eq=False)
class Movie:
    """``update(frame)`` changes the figure; the frames follow each other at ``fps`` per second."""

    figure: Figure
    update: Callable[[Any], Any]
    frames: Sequence[Any]
    fps: int


def writable():
    """Those of MOVIES that can be written here, the better first: mp4 needs ffmpeg, gif needs Pillow."""
    here = {"mp4": FFMpegWriter.isAvailable(), "gif": find_spec("PIL") is not None}
    return tuple(ending for ending in MOVIES if here[ending])


def save_movie(movie, path):
    """Write ``movie`` to ``path`` as mp4 or gif, by its ending.

    Raises
    ------
    ValueError    if such a file cannot be written here
    """
    ending = Path(path).suffix[1:]
    if ending not in writable():
        raise ValueError(f"path must end in one of {', '.join(writable()) or 'nothing: no writer is here'}, got {path}")
    (_save_mp4 if ending == "mp4" else _save_gif)(movie, path)


def _save_mp4(movie, path):
    # yuv420p, for players that know no other, needs an even number of pixels each way.
    even = ["-pix_fmt", "yuv420p", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-crf", "20"]
    writer = FFMpegWriter(fps=movie.fps, codec="libx264", extra_args=even)
    with writer.saving(movie.figure, str(path), dpi=150):
        for frame in movie.frames:
            movie.update(frame)
            writer.grab_frame()


def _save_gif(movie, path):
    from PIL import Image

    def picture(frame):
        movie.update(frame)
        movie.figure.canvas.draw()
        return Image.fromarray(np.asarray(movie.figure.canvas.buffer_rgba())).convert("RGB")

    # One palette for all frames, from the busiest of a few, so that what stands still does not flicker.
    few = [picture(frame) for frame in movie.frames[:: max(1, len(movie.frames) // 8)]]
    sheet = Image.new("RGB", (few[0].width, few[0].height * len(few)))
    for row, each in enumerate(few):
        sheet.paste(each, (0, row * each.height))
    palette = sheet.quantize(COLOURS)
    first, *rest = (picture(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in movie.frames)
    first.save(path, save_all=True, append_images=rest, duration=1000 // movie.fps, loop=0, optimize=True)
