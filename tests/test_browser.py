"""Guards the course as a reader meets it: JupyterLab in a real browser, sliders moved by keyboard and by number box."""

import itertools
import shutil
import statistics
from pathlib import Path

import nbformat
import pytest
from jupyter import CHROMIUM, Notebook, chromium, lab

from primer.view import explorers
from primer.view.explorers.controls import Number

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="no Chromium is installed (Debian: apt-get install chromium)"),
]
COURSE = Path(__file__).parents[1] / "notebooks"
_STEPS = 16


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Notebook 03 as it is, and a notebook with one cell for each explorer."""
    folder = tmp_path_factory.mktemp("course")
    shutil.copy(COURSE / "03_grid_dependence.ipynb", folder)
    cells = [nbformat.v4.new_code_cell(f"from primer.view import {name}\n\n{name}()") for name in explorers.__all__]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3 (ipykernel)", "language": "python"}}
    nbformat.write(nbformat.v4.new_notebook(cells=cells, metadata=kernel), folder / "explorers.ipynb")
    return folder


@pytest.fixture(scope="module")
def open_notebook(folder, tmp_path_factory):
    with lab(folder, tmp_path_factory.mktemp("jupyter")) as address, chromium() as browser:
        yield lambda name: Notebook(browser, address, name)


@pytest.fixture(scope="module")
def gallery(open_notebook):
    notebook = open_notebook("explorers.ipynb")
    notebook.run_all()
    return notebook


def test_notebook_03_answers_to_the_keyboard_and_to_the_number_box(open_notebook):
    notebook = open_notebook("03_grid_dependence.ipynb")
    notebook.run_all()
    explorer = notebook.explorer()
    begun, picture = explorer.verdict, explorer.picture
    assert begun.startswith("Well posed")
    explorer.slider("base state a")
    for _ in range(20):  # from 1.5 to 0.5
        explorer.step(lambda: notebook.page.keyboard.press("ArrowLeft"))
    assert explorer.number("base state a").input_value() == "0.5"
    assert explorer.verdict.startswith("Ill posed")
    assert explorer.picture != picture
    notebook.photograph("notebook_03_by_keyboard")
    for value, said in (("1.5", "Well posed"), ("0.5", "Ill posed")):
        box = explorer.number("base state a")
        box.fill(value)
        explorer.step(lambda box=box: box.press("Enter"))
        assert explorer.verdict.startswith(said)
    notebook.photograph("notebook_03_by_number_box")
    assert not notebook.errors
    notebook.page.close()


def test_time_plays(gallery):
    """Without a hand on it, t goes on and the picture with it, until it is stopped."""
    shown = gallery.explorer(explorers.__all__.index("HeatExplorer"))
    shown.press("reset")
    play, begun, seen = shown.box.locator(".widget-play button").first, float(shown.number("time t").input_value()), []
    for _ in range(4):
        seen.append(shown.step(play.click if not seen else lambda: None))
    play.click()
    assert float(shown.number("time t").input_value()) != begun
    gallery.page.wait_for_timeout(500)
    stopped = shown.picture
    gallery.page.wait_for_timeout(500)
    assert shown.picture == stopped
    assert not gallery.errors


@pytest.mark.parametrize("name", explorers.__all__)
def test_every_explorer_answers(gallery, name, measured):
    shown, kind = gallery.explorer(explorers.__all__.index(name)), getattr(explorers, name)
    begun = shown.verdict
    control = next(control for control in kind.controls if isinstance(control, Number))
    shown.slider(control.label)
    keys = itertools.islice(itertools.cycle(("ArrowRight", "ArrowRight", "ArrowLeft", "ArrowLeft")), _STEPS)
    seconds = [shown.step(lambda key=key: gallery.page.keyboard.press(key)) for key in keys]
    measured(f"{name}: a step of {control.name} is on the page after {statistics.median(seconds):.3f} s (median)")
    box = shown.number(control.label)
    box.fill("-1e9")
    box.press("Enter")
    shown.wait_until("alert", control.name)
    shown.press("reset")
    shown.wait_until("status", begun)
    for preset, state in kind.presets.items():
        shown.press(preset)
        shown.wait_until("status", kind.snapshot(state).verdict)
    gallery.photograph(name)
    assert not gallery.errors
