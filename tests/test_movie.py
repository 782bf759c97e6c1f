"""Guards movies: written whole, in both formats, with the frames they say; and what is said where they cannot be."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

FIGURES = Path(__file__).parents[1] / "figures"
sys.path.insert(0, str(FIGURES))

import blow_up_movie  # noqa: E402
import regenerate  # noqa: E402

from primer import Stop  # noqa: E402
from primer.view.movie import Movie, save_movie, writable  # noqa: E402
from primer.view.style import new_figure, styled  # noqa: E402


@pytest.fixture(scope="module")
def result():
    return blow_up_movie.compute()


@pytest.fixture
def short():
    """Three frames of a moving dot."""
    figure, axes = new_figure(1, 1, width=2.01, height=1.01)
    (dot,) = axes.plot([0], [0], "o")
    axes.set(xlim=(-1, 3), ylim=(-1, 1))
    return Movie(figure, lambda k: dot.set_xdata([k]), (0, 1, 2), fps=10)


def test_a_gif_has_its_frames_and_its_speed(short, tmp_path):
    save_movie(short, tmp_path / "dot.gif")
    with Image.open(tmp_path / "dot.gif") as gif:
        assert (gif.n_frames, gif.info["duration"], gif.info["loop"]) == (3, 100, 0)
        frames = []
        for k in range(3):
            gif.seek(k)
            frames.append(np.asarray(gif.convert("RGB")).astype(int))
    assert np.abs(frames[1] - frames[0]).max() > 100
    assert np.abs(frames[2] - frames[1]).max() > 100


@pytest.mark.slow
@pytest.mark.skipif("mp4" not in writable(), reason="ffmpeg is not here")
def test_an_mp4_is_written_though_the_figure_has_an_odd_number_of_pixels(short, tmp_path):
    save_movie(short, tmp_path / "dot.mp4")
    assert b"ftyp" in (tmp_path / "dot.mp4").read_bytes()[:16]


def test_what_cannot_be_written_is_named(short, tmp_path, monkeypatch, capsys):
    with pytest.raises(ValueError, match=r"path must end in one of .*gif, got .*dot\.avi"):
        save_movie(short, tmp_path / "dot.avi")
    monkeypatch.setattr(regenerate, "writable", lambda: ())
    with pytest.raises(SystemExit) as stopped:
        regenerate.main(["blow_up_movie"])
    assert stopped.value.code == 2
    assert "blow_up_movie needs ffmpeg or Pillow to be written, and neither is here" in capsys.readouterr().err


def test_without_ffmpeg_there_is_a_gif(monkeypatch):
    monkeypatch.setattr("primer.view.movie.FFMpegWriter.isAvailable", lambda: False)
    assert writable() == ("gif",)


def test_each_frame_shows_the_runs_at_its_time(result):
    coarse, middle, fine = result.runs
    assert [run.stop for run in result.runs] == [Stop.REACHED_END, Stop.BLEW_UP, Stop.BLEW_UP]
    with styled():
        movie = blow_up_movie.draw(result)
    panels = movie.figure.axes[:3]
    movie.update(2.0)
    assert [ax.get_title() for ax in panels] == [f"N = {n}, t = 2.0" for n in (30, 100, 200)]
    for ax, run in zip(panels, result.runs, strict=True):
        np.testing.assert_array_equal(ax.lines[-1].get_ydata()[:-1], run.snapshots[2.0][0])
    movie.update(movie.frames[-1])
    assert panels[0].get_title() == "N = 30, t = 17.0"
    assert panels[1].get_title() == f"N = 100, blew up at t = {middle.t_stop:.2f}"
    curve = movie.figure.axes[-1].lines[2]
    np.testing.assert_array_equal(curve.get_ydata(), fine.dist)
    assert coarse.t[-1] == pytest.approx(17)


def test_the_committed_gif_is_small_and_whole():
    gif = FIGURES / "blow_up_movie.gif"
    assert gif.stat().st_size < 1_500_000
    with Image.open(gif) as picture:
        assert picture.n_frames == len(blow_up_movie.FRAMES)


@pytest.mark.slow
def test_made_by_name_only_and_nothing_is_left_behind(tmp_path):
    assert "blow_up_movie" not in regenerate.NAMES
    command = [sys.executable, str(FIGURES / "regenerate.py"), "--out", str(tmp_path), "blow_up_movie"]
    made = subprocess.run(command, capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    ending = writable()[0]
    assert {path.name for path in tmp_path.iterdir()} == {"blow_up_movie.json", f"blow_up_movie.{ending}"}
    claims = json.loads((tmp_path / "blow_up_movie.json").read_text())
    assert claims["stop_30"]["value"] == "reached_end"
