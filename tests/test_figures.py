"""Guards the main job: figures regenerate byte for byte, their numbers are held to, bad calls cost nothing."""

import importlib
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

FIGURES = Path(__file__).parents[1] / "figures"
sys.path.insert(0, str(FIGURES))

import regenerate  # noqa: E402
import sidecar  # noqa: E402

from primer.view.style import styled  # noqa: E402


def run(*arguments, **options):
    """``python figures/regenerate.py`` as a user types it."""
    command = [sys.executable, str(FIGURES / "regenerate.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, **options)


TWICE = ["abs_sin", "fig33", "granular_erratum", "granular_paper", "hadamard_modes", "toy_growth", "work_precision"]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """All figures in all formats; those that are quickly made, of each kind, twice."""
    folders = [tmp_path_factory.mktemp(name) for name in ("first", "second")]
    for folder, names in zip(folders, ([], TWICE), strict=True):
        result = run("--out", folder, "--formats", "svg,png,pdf", *names)
        assert result.returncode == 0, result.stderr
        assert "Warning" not in result.stderr
    return folders


@pytest.mark.slow
def test_every_script_makes_every_format(made):
    expected = {f"{name}.{ending}" for name in regenerate.NAMES for ending in ("json", "svg", "png", "pdf")}
    assert {"fig31", "fig32", "fig33", "toy_refinement", "heat_refinement", "hadamard_modes", "abs_sin"} <= set(
        regenerate.NAMES
    )
    assert {path.name for path in made[0].iterdir()} == expected  # and nothing else is left behind


@pytest.mark.slow
def test_pictures_are_the_same_bytes_each_time(made):
    first, second = made
    for path in second.iterdir():
        assert path.read_bytes() == (first / path.name).read_bytes(), path.name


@pytest.mark.parametrize("name", ["fig33", "hadamard_modes", "toy_growth", "abs_sin"])
def test_no_legend_hides_data(name):
    """Nothing that is drawn lies behind a legend."""
    script = importlib.import_module(name)
    with styled():
        figure = script.draw(script.compute())
        figure.canvas.draw()
        for ax in figure.axes:
            if ax.get_legend() is not None:
                box, frame = ax.get_legend().get_window_extent(), ax.bbox
                for line in ax.lines:
                    xy = line.get_transform().transform(line.get_xydata())
                    assert not any(box.contains(*p) and frame.contains(*p) for p in xy), (name, line.get_label())


@pytest.mark.slow
def test_committed_numbers_are_what_is_computed():
    names = regenerate.NAMES + regenerate.ON_REQUEST
    result = run("--check", *names)
    assert result.returncode == 0, result.stderr
    assert f"{len(names)} of {len(names)} figures checked" in result.stdout


def test_committed_pictures_and_numbers_are_complete():
    for name in regenerate.NAMES:
        assert (FIGURES / f"{name}.svg").read_text(encoding="utf-8").startswith("<?xml")
        claims = json.loads((FIGURES / f"{name}.json").read_text(encoding="utf-8"))
        assert claims
        assert all(claim["why"] for claim in claims.values())


@pytest.mark.slow
def test_check_names_what_drifted_and_writes_nothing(made, tmp_path):
    folder = shutil.copytree(made[0], tmp_path / "copy")
    stored = json.loads((folder / "fig31.json").read_text())
    stored["dist_end"]["value"] *= 1 + 1e-6
    stored["stop"]["value"] = "blew_up"
    (folder / "fig31.json").write_text(json.dumps(stored))
    (folder / "fig32.json").unlink()
    (folder / "abs_sin.json").write_text("{")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    result = run("--check", "--out", folder, "fig31", "fig32", "abs_sin", "hadamard_modes")
    assert result.returncode == 1
    assert "fig31: dist_end is 0.000658" in result.stderr
    assert "the floor" in result.stderr  # and says why it must not
    assert "fig31: stop is 'reached_end', but must be 'blew_up'" in result.stderr
    assert "fig32: no stored numbers" in result.stderr
    assert "abs_sin: no stored numbers" in result.stderr
    assert "hadamard_modes" not in result.stderr
    assert "1 of 4 figures checked" in result.stdout
    assert before == {path.name: path.read_bytes() for path in folder.iterdir()}


def test_drift_sees_each_kind_of_claim():
    stored = {
        "near": sidecar.close(1.0, "x", rtol=1e-3),
        "in": sidecar.within(2.0, 1, 3, "x"),
        "high": sidecar.within(2.0, 1, 3, "x"),
        "small": sidecar.close(-1.0, "x", atol=1e-3, rtol=1e-3),
        "far": sidecar.close(-1.0, "x", atol=1e-3, rtol=1e-3),
        "text": sidecar.same("a", "x"),
        "gone": sidecar.same(1, "x"),
    }
    fresh = {**stored, "near": sidecar.close(1.002, "x"), "in": sidecar.within(0.9, 1, 3, "x"), "new": stored["gone"]}
    fresh |= {"high": sidecar.within(3.1, 1, 3, "x"), "small": sidecar.close(-1.0019, "x")}
    fresh["far"] = sidecar.close(-0.9979, "x")
    del fresh["gone"]
    sentences = "\n".join(sidecar.drift(stored, fresh))
    for name in ("near", "in", "high", "far", "gone", "new"):
        assert f"{name} is" in sentences
    assert "text" not in sentences
    assert "small" not in sentences  # the two slacks add up
    assert sidecar.drift(stored, stored) == []
    assert sidecar.drift({"in": stored["in"]}, {"in": sidecar.within(float("nan"), 1, 3, "x")})


def test_a_number_that_is_not_finite_is_not_stored():
    with pytest.raises(ValueError, match="JSON"):
        sidecar.dumps({"x": sidecar.close(float("inf"), "x")})


def test_what_is_there_and_holds_is_left_alone(tmp_path, monkeypatch):
    """Another machine has other last digits, and a clone stays clean; a number that left its claim is written."""
    made = regenerate._make("abs_sin", tmp_path, ["svg"], redraw=False)
    assert made == ([], False)
    svg, stored = tmp_path / "abs_sin.svg", tmp_path / "abs_sin.json"
    assert "<title" in svg.read_text(encoding="utf-8")
    assert "<desc" in svg.read_text(encoding="utf-8")
    svg.write_text("as it was")
    assert regenerate._make("abs_sin", tmp_path, ["svg"], redraw=False) == ([], True)
    assert svg.read_text() == "as it was"
    assert regenerate._make("abs_sin", tmp_path, ["png"], redraw=False) == ([], False)
    assert (tmp_path / "abs_sin.png").exists()
    numbers = json.loads(stored.read_text(encoding="utf-8"))
    numbers[next(iter(numbers))]["value"] = 1e9
    stored.write_text(json.dumps(numbers))
    assert regenerate._make("abs_sin", tmp_path, ["svg"], redraw=False) == ([], False)
    assert svg.read_text(encoding="utf-8") != "as it was"
    svg.write_text("as it was")
    assert regenerate._make("abs_sin", tmp_path, ["svg"], redraw=True) == ([], False)
    assert svg.read_text(encoding="utf-8") != "as it was"


def test_numbers_are_rounded_to_one_digit_more_than_is_claimed():
    assert sidecar.close(0.12345678, "x", rtol=1e-3)["value"] == 0.12346
    assert sidecar.close(12.345678, "x", atol=0.1)["value"] == 12.35
    assert sidecar.close(0.1 + 0.2, "x")["value"] == 0.1 + 0.2
    assert sidecar.within(14.4876, 12, 16, "x")["value"] == 14.49
    assert sidecar.close(0.0, "x", rtol=1e-3)["value"] == 0.0


def test_what_is_asked_for_twice_is_made_once(tmp_path):
    options = regenerate._options(["fig31", "fig32", "fig31", "--formats", "svg,png,svg", "--out", str(tmp_path)])
    assert (options.names, options.formats) == (["fig31", "fig32"], ["svg", "png"])


def test_an_interrupted_or_failing_drawing_leaves_the_old_files(tmp_path, monkeypatch):
    old = {"fig31.svg": "old picture", "fig31.json": "old numbers"}
    for name, text in old.items():
        (tmp_path / name).write_text(text)

    def fails(figure, path, words):
        raise KeyboardInterrupt

    monkeypatch.setattr(regenerate, "save", fails)
    with pytest.raises(KeyboardInterrupt):
        regenerate._make("fig31", tmp_path, ["svg"], redraw=True)
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == old


@pytest.mark.slow
def test_list_names_every_figure():
    result = run("--list")
    assert result.returncode == 0
    assert [line.split()[0] for line in result.stdout.splitlines()] == regenerate.NAMES + regenerate.ON_REQUEST
    assert "[on request]" in result.stdout.splitlines()[-1]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["fig99"], "NAME must be one of"),
        (["--jobs", "0"], "--jobs must be >= 1, got 0"),
        (["--jobs", "two"], "argument --jobs: invalid int value: 'two'"),
        (["--formats", "bmp"], "--formats must be some of svg,png,pdf, got 'bmp'"),
        (["--formats", ""], "--formats must be some of svg,png,pdf, got ''"),
        (["blow_up_movie", "--formats", "svg"], "--formats must be some of"),
        (["blow_up_movie", "fig31", "--formats", "gif"], "make it in a call of its own"),
        (["explorer", "--formats", "svg"], "--formats must be some of html, got 'svg'"),
        (["explorer", "blow_up_movie", "--formats", "gif"], "make it in a call of its own"),
        (["fig31", "--formats", "gif"], "--formats must be some of svg,png,pdf, got 'gif'"),
        (["--out", __file__], "--out must be a folder that can be written"),
        (["--out", "/proc/nowhere"], "--out must be a folder that can be written"),
        (["--nonsense"], "unrecognized arguments: --nonsense"),
    ],
)
def test_bad_calls_end_with_exit_2_and_one_sentence(arguments, sentence, capsys):
    with pytest.raises(SystemExit) as stopped:
        regenerate.main(arguments)
    assert stopped.value.code == 2
    assert sentence in capsys.readouterr().err


def test_a_bad_call_from_a_terminal():
    result = run("fig99")
    assert result.returncode == 2
    assert "NAME must be one of" in result.stderr
    assert "Traceback" not in result.stderr


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root may write everywhere")
def test_a_read_only_folder_is_named(tmp_path):
    tmp_path.chmod(0o500)
    result = run("--out", tmp_path, "fig31")
    assert result.returncode == 2
    assert "--out must be a folder that can be written" in result.stderr
