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


def test_pdf_without_a_browser_is_one_sentence_and_writes_nothing(tmp_path, capsys, monkeypatch):
    from primer.__main__ import main
    from primer.view import pdf

    monkeypatch.setattr(pdf, "_PLACES", ())
    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(["slides", str(tmp_path / "out"), "--pdf"]) == 2
    assert re.fullmatch(
        r"primer: --pdf needs Chromium or Chrome on PATH to print, got none: .*\n", capsys.readouterr().err
    )
    assert not (tmp_path / "out").exists()


def test_a_browser_that_prints_half_leaves_the_old_file(tmp_path):
    from primer.view import pdf

    fake, page, out = tmp_path / "fake", tmp_path / "page.html", tmp_path / "page.pdf"
    fake.write_text('#!/bin/sh\nfor a; do case $a in --print-to-pdf=*) printf %%PDF-1.4 >"${a#*=}";; esac; done\n')
    fake.chmod(0o755)
    page.write_text("<p>", encoding="utf-8")
    out.write_bytes(b"old")
    with pytest.raises(ValueError, match=r"made no PDF of page\.html"):
        pdf.printed(str(fake), page, out)
    assert out.read_bytes() == b"old"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["fake", "page.html", "page.pdf"]


@pytest.mark.slow
def test_every_page_is_printed(tmp_path, capsys, monkeypatch):
    """One notebook, as PDFs by the real browser."""
    from primer import slides
    from primer.__main__ import main
    from primer.view import pdf

    try:
        pdf.browser()
    except ValueError:
        pytest.skip("there is no browser here")
    (tmp_path / "course").mkdir()
    name = "09_write_it_yourself"
    (tmp_path / "course" / f"{name}.ipynb").write_bytes((COURSE / f"{name}.ipynb").read_bytes())
    monkeypatch.setattr(slides, "course", lambda: tmp_path / "course")
    assert main(["slides", str(tmp_path / "out"), "--pdf", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["files"]
    assert told == [f"{name}.{kind}.{form}" for kind in ("slides", "handout") for form in ("html", "pdf")]
    assert sorted(told) == sorted(p.name for p in (tmp_path / "out").iterdir())
    for kind in ("slides", "handout"):
        made = (tmp_path / "out" / f"{name}.{kind}.pdf").read_bytes()
        assert made.startswith(b"%PDF-")
        assert len(re.findall(rb"/Type\s*/Page\b", made)) > 1
