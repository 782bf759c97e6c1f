"""Guards the notebooks' form: executed, whole, short cells, captions; that their outputs are true is nbval's part."""

import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest

from primer import exercises

COURSE = Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = sorted(path for path in COURSE.rglob("*.ipynb") if ".ipynb_checkpoints" not in path.parts)
LESSONS = [path for path in NOTEBOOKS if path.parent == COURSE]
HEADINGS = ("Predict first", "Explore", "What you should have seen", "Exercises", "Summary", "References")


def read(path):
    return nbformat.read(path, as_version=4)


def code(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def prose(notebook):
    return "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")


def outputs(notebook):
    return [output for cell in code(notebook) for output in cell.outputs]


def test_there_is_a_course():
    assert LESSONS
    assert [path.name[:2] for path in LESSONS] == [f"{k:02d}" for k in range(len(LESSONS))]
    assert all(re.fullmatch(r"\d\d_[a-z_]+\.ipynb", path.name) for path in LESSONS)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_is_executed_from_top_to_bottom(path):
    notebook = read(path)
    nbformat.validate(notebook)
    assert [cell.execution_count for cell in code(notebook)] == list(range(1, len(code(notebook)) + 1))
    for output in outputs(notebook):
        assert output.output_type != "error"
        assert output.get("name") != "stderr", output.text
        text = output.get("text", "") or output.get("data", {}).get("text/plain", "")
        assert not re.search(r"0x[0-9a-f]{6,}|(?<![\w.)\]|])/[a-z]\w*/|Warning", text), text
    assert all(not {"nbval-skip", "raises-exception"} & set(cell.metadata.get("tags", ())) for cell in notebook.cells)
    assert "state" in notebook.metadata.get("widgets", {}).get(
        "application/vnd.jupyter.widget-state+json", {"state": 0}
    )


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_cells_are_short_and_plain(path):
    for cell in code(read(path)):
        if "yours" in cell.metadata.get("tags", ()):  # the student's own program
            continue
        lines = [line for line in cell.source.splitlines() if line.strip() and "import" not in line.split()]
        assert len(lines) <= 5, cell.source
        assert not re.search(r"^\s*(def|class|for|while|global|%|!)\b", cell.source, flags=re.M), cell.source
        assert not cell.source.rstrip().endswith(";")


@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.name)
def test_has_its_parts_in_order(path):
    text = prose(read(path))
    assert re.match(rf"# {int(path.name[:2])}\. ", text)
    assert "**You will be able to**" in text
    assert re.search(r"\*\*Time:\*\* \d+ minutes", text)
    places = [text.find(f"\n## {heading}") for heading in HEADINGS]
    assert min(places) > 0, dict(zip(HEADINGS, places, strict=True))
    assert places == sorted(places)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_every_picture_has_a_caption_and_words_for_those_who_do_not_see_it(path):
    cells = read(path).cells
    for cell, following in zip(cells, [*cells[1:], None], strict=True):
        for output in cell.get("outputs", ()):
            assert "image/png" not in output.get("data", {})  # whose alternative text no reader shows
            html = output.get("data", {}).get("text/html", "")
            assert html.count("<img ") == len(re.findall(r'<img [^>]*alt="[^"]', html))
            if "<img " in html and "widget-view" not in str(output.data.keys()):
                assert following.source.lstrip().startswith("*"), cell.source


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.name)
def test_links_lead_somewhere(path):
    for target in re.findall(r"\]\(([^)\s]+)\)", prose(read(path))):
        if not target.startswith(("http://", "https://", "#")):
            assert (path.parent / target.partition("#")[0]).exists(), target


def test_the_course_is_a_chain():
    """Each lesson leads to its neighbours, at the top and at the end, and the first names all."""
    for before, lesson, after in zip([None, *LESSONS], LESSONS, [*LESSONS[1:], None], strict=False):
        cells = read(lesson).cells
        for neighbour in filter(None, (before, after)):
            assert f"]({neighbour.name})" in cells[0].source, lesson.name
            assert f"]({neighbour.name})" in cells[-1].source, lesson.name
    assert all(f"({path.name})" in prose(read(LESSONS[0])) for path in LESSONS[1:])


@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.name)
def test_every_exercise_is_asked_and_solved(path):
    """A lesson calls its checkers, and the solutions call them with answers that are right."""
    number, solved = path.name[:2], read(COURSE / "solutions" / path.name)
    asked = {name for name in exercises.__all__ if name.startswith(f"check_{number}")}
    assert len(asked) >= 2
    for notebook in (read(path), solved):
        assert asked == set(re.findall(rf"(check_{number}_\d)\(", "\n".join(cell.source for cell in code(notebook))))
    said = [output.get("data", {}).get("text/plain", "") + output.get("text", "") for output in outputs(solved)]
    assert sum(text.count("Right:") for text in said) >= len(asked)
    assert not any("Not yet:" in text for text in said)
    assert f"](../{path.name})" in prose(solved)


def test_the_instructor_is_told_what_is_there():
    guide = (COURSE / "INSTRUCTORS.md").read_text(encoding="utf-8")
    minutes = 0
    for path in LESSONS:
        text, number = prose(read(path)), path.name[:2]
        takes = int(re.search(r"\*\*Time:\*\* (\d+) minutes", text)[1])
        assert re.search(rf"\]\({path.name}\) \| {takes} \|", guide), path.name
        minutes += takes
        for name in exercises.__all__:
            if name.startswith(f"check_{number}"):
                assert f"{int(number)}.{name[-1]}" in guide, name
    assert f"{minutes} minutes in all" in guide
    for row in re.findall(r"^\| (\".*?) \|\s*([\d, ]+) \|", guide, flags=re.M):
        for said in re.findall(r'"(.*?)"', row[0]):
            met = {path.name[:2] for path in LESSONS if f'**"{said}"**' in prose(read(path))}
            assert met, said
            assert met <= set(row[1].split(", ")), said
    for target in re.findall(r"\]\(([^)\s]+)\)", guide):
        assert (COURSE / target).exists(), target


def test_students_copy_keeps_their_work(tmp_path):
    from primer.lab import copy_course

    folder = tmp_path / "my course é"
    copied, kept = copy_course(folder)
    assert len(copied) == len(NOTEBOOKS)
    assert not kept
    mine = folder / copied[0]
    mine.write_text("my work", encoding="utf-8")
    (folder / copied[-1]).with_suffix(".txt").write_text("notes", encoding="utf-8")
    again, kept = copy_course(folder)
    assert (again, kept) == ([], copied)
    assert mine.read_text(encoding="utf-8") == "my work"
    assert not list(folder.rglob(".copy-*"))


def test_a_copy_without_solutions(tmp_path, capsys):
    from primer.__main__ import main

    assert main(["lab", str(tmp_path / "course"), "--without-solutions", "--copy-only", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert sorted(told["copied"]) == sorted(path.name for path in LESSONS)
    assert not (tmp_path / "course" / "solutions").exists()


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="signals are of POSIX")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_jupyterlab_with_the_command(tmp_path, number):
    """JupyterLab is stood in for by a process that writes its number and waits."""
    waits = "import os, sys, time; print(os.getpid(), flush=True); time.sleep(600)"
    code = f"import sys; from primer.lab import _serve; _serve([sys.executable, '-c', {waits!r}])"
    command = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    server = int(command.stdout.readline())
    command.send_signal(number)
    assert command.wait(30) != 0
    with pytest.raises(ProcessLookupError):
        os.kill(server, 0)


def test_a_folder_that_cannot_be(tmp_path, capsys):
    from primer.__main__ import main

    (tmp_path / "file").write_text("", encoding="utf-8")
    assert main(["lab", "--copy-only", str(tmp_path / "file" / "course")]) == 2
    said = capsys.readouterr()
    assert not said.out
    assert re.fullmatch(r"primer: FOLDER must be a folder that can be written, got '.*' \(.*\)\n", said.err)
    assert main(["lab", "--copy-only", str(tmp_path / "course")]) == 0
    assert "notebooks copied" in capsys.readouterr().out


def test_jupyterlab_starts_on_the_first_notebook_and_its_failure_is_told(tmp_path, capsys, monkeypatch):
    from primer import lab
    from primer.__main__ import main

    started, code = [], 0

    def start(command):
        started.append(command)
        return code

    monkeypatch.setattr(lab, "_serve", start)
    for between in (["--"], []):
        assert main(["lab", str(tmp_path), *between, "--no-browser", "--port", "9000"]) == 0
        assert "--LabApp.default_url=/lab/tree/00_start_here.ipynb" in started[-1]  # the address it prints
        assert started[-1][-3:] == ["--no-browser", "--port", "9000"]
    mine = tmp_path / "03_grid_dependence.ipynb"
    mine.write_text("my work", encoding="utf-8")
    assert main(["lab", str(tmp_path)]) == 0
    assert f"--LabApp.default_url=/lab/tree/{mine.name}" in started[-1]  # where the student left off
    code = 1
    assert main(["lab", str(tmp_path)]) == 2
    assert "got its exit code 1" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["lab"])
    assert capsys.readouterr().err.rstrip().endswith("required: FOLDER")


def test_the_newer_lessons_are_thin():
    """The targets of the course, which the lessons from 09 on meet; ``python tests/course_table.py`` prints all."""
    from course_table import measured

    for path in LESSONS[9:]:
        minutes, lines, _, longest = measured(path)
        assert minutes <= 45, path.name
        assert lines <= 50, path.name
        assert longest <= 120, path.name
