"""Guards the READMEs: short enough to be read, and their numbers are those beside the figures, written by a script."""

import json
import re
import sys
from pathlib import Path

import pytest

import primer

PACKAGE = Path(primer.__file__).parent
ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "figures"))
import readme  # noqa: E402


def test_the_tables_are_what_the_script_writes():
    text = (ROOT / "figures" / "README.md").read_text(encoding="utf-8")
    assert readme.written(text) == text


def test_the_first_page_is_short():
    """Long tables belong to the pages that own them."""
    assert len((ROOT / "README.md").read_text(encoding="utf-8").split()) <= 1800


def test_each_number_is_shown_within_its_claim():
    for what, figure, name, form in readme.NUMBERS:
        claim = json.loads((ROOT / "figures" / f"{figure}.json").read_text(encoding="utf-8"))[name]
        shown = float(format(claim["value"], form))
        assert shown == pytest.approx(claim["value"], rel=1e-2), what
        assert claim.get("low", -1e300) <= shown <= claim.get("high", 1e300)
    (row,) = (line for line in readme.numbers() if "Figure 5): the first u = 0" in line)
    assert "| 0.827 | ± 0.002 | fig33 |" in row


def test_the_table_of_the_course_names_what_is_there():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    rows = [row.strip("| ").split(" | ") for row in text.splitlines() if re.match(r"\| \[\d\d ", row)]
    lessons = sorted(path.name for path in (ROOT / "notebooks").glob("*.ipynb"))
    assert [re.search(r"\]\(notebooks/(.*?)\)", row[0])[1] for row in rows] == lessons
    labels = (ROOT / "tests" / "paper_labels.txt").read_text(encoding="utf-8").split()
    for _, rooms, figures, equations in rows:
        for room in re.findall(r"`(.*?)`", rooms):
            assert any(PACKAGE.glob(f"{room.rstrip('/')}*")), room
        assert all((ROOT / "figures" / f"{name}.svg").exists() for name in figures.split(", ")), figures
        for label in re.findall(r"\(([a-z][\w-]+)\)", equations):
            assert label in labels, label


def test_only_what_is_between_the_markers_is_written(tmp_path):
    file = tmp_path / "README.md"
    parts = "".join(f"before\n<!-- {name}: begin -->\nold\n<!-- {name}: end -->\nafter\n" for name in readme.PARTS)
    file.write_text(parts, encoding="utf-8")
    readme.main(file)
    text = file.read_text(encoding="utf-8")
    assert text.startswith("before\n<!-- work-precision: begin -->\nWall time")
    assert text.count("before\n") == text.count("after\n") == len(readme.PARTS)
    assert "| FTCS |" in text
    assert "old" not in text
    assert [path.name for path in tmp_path.iterdir()] == ["README.md"]
    file.write_text("no markers", encoding="utf-8")
    with pytest.raises(ValueError, match="must have the lines <!-- work-precision: begin -->"):
        readme.main(file)
    assert file.read_text(encoding="utf-8") == "no markers"
