"""Guards slides and handouts: whole in themselves, nothing asked of the network, nothing of a notebook left out."""

import json
import re
from pathlib import Path

import nbformat
import pytest

pytest.importorskip("nbconvert")
COURSE = Path(__file__).parents[1] / "notebooks"


def test_every_notebook_becomes_slides_and_a_handout(tmp_path, capsys):
    from primer.__main__ import main

    assert main(["slides", str(tmp_path / "out"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["files"]
    lessons = sorted(COURSE.glob("*.ipynb"))
    assert sorted(told) == sorted(f"{p.stem}.{kind}.html" for p in lessons for kind in ("slides", "handout"))
    for path in lessons:
        notebook = nbformat.read(path, as_version=4)
        pictures = sum(
            "<img " in o.get("data", {}).get("text/html", "") for c in notebook.cells for o in c.get("outputs", ())
        )
        assert pictures or path.stem.startswith("09")
        headings = sum(
            len(re.findall(r"^#{1,3} ", c.source, re.M)) for c in notebook.cells if c.cell_type == "markdown"
        )
        for kind in ("slides", "handout"):
            page = (tmp_path / "out" / f"{path.stem}.{kind}.html").read_text(encoding="utf-8")
            assert not re.search(r'(?:src|href)="(?!data:|https?://|#)', page)
            assert not re.search(r'src="https?:|<link ', page)
            assert len(re.findall(r"<h[1-3]", page)) == headings
            assert page.count("<section>") > 5
            assert "¶" not in page
            assert page.count("<img ") <= pictures
            assert page.count("<img ") >= pictures - 3  # explorers have a text instead
            assert "$$" not in page
            assert ("<script>" in page) == (kind == "slides")


def test_a_folder_that_cannot_be(tmp_path, capsys):
    from primer.__main__ import main

    (tmp_path / "file").write_text("", encoding="utf-8")
    assert main(["slides", str(tmp_path / "file" / "x")]) == 2
    assert re.fullmatch(r"primer: OUT must be a folder that can be written, got '.*' \(.*\)\n", capsys.readouterr().err)
