"""Guards what a release holds: the wheel, the sdist, the citation, the checks before a commit, exit codes."""

import io
import re
import shlex
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

import primer
from primer.__main__ import main

ROOT = Path(__file__).parents[1]


def read(name):
    return (ROOT / name).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The names in the wheel, and in the sdist (without its first folder)."""
    pytest.importorskip("hatchling")
    if not (ROOT / "primer").is_dir():
        pytest.skip("there is no source here to build from")
    folder = tmp_path_factory.mktemp("built")
    code = "import sys; from hatchling.build import *; build_wheel(sys.argv[1]); build_sdist(sys.argv[1])"
    done = subprocess.run([sys.executable, "-c", code, str(folder)], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (wheel,), (sdist,) = folder.glob("*.whl"), folder.glob("*.tar.gz")
    for file in (wheel, sdist):
        assert file.name.startswith(f"illposed_primer-{primer.__version__}")
    with tarfile.open(sdist) as archive:
        parts = {name.partition("/")[2] for name in archive.getnames()}
    return wheel, set(zipfile.ZipFile(wheel).namelist()), parts


def ours(folder, pattern="*"):
    """What git would keep of a folder: not what running leaves behind."""
    left = {"__pycache__", ".ipynb_checkpoints", "artefacts"}
    paths = (p for p in (ROOT / folder).rglob(pattern) if p.is_file() and not left & set(p.parts))
    return {p.relative_to(ROOT).as_posix() for p in paths if p.suffix not in (".pyc", ".nbi", ".nbc", ".mp4")}


@pytest.mark.slow
def test_the_wheel_holds_the_package_and_nothing_else(built):
    _, names, _ = built
    info = f"illposed_primer-{primer.__version__}.dist-info"
    course = {f"primer/{name}" for name in ours("notebooks")}
    assert {name for name in names if not name.startswith(info)} == ours("primer") | course
    assert {"primer/claims.toml", "primer/view/primer.mplstyle", "primer/view/page/page.html"} <= names
    assert {f"{info}/licenses/LICENSE", f"{info}/licenses/LICENSE-prose", f"{info}/entry_points.txt"} <= names


@pytest.mark.slow
def test_the_wheel_works_without_the_repository(built, tmp_path):
    """Unpacked elsewhere, it finds its data files; and its metadata say what it is."""
    wheel, _, _ = built
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
        metadata = archive.read(f"illposed_primer-{primer.__version__}.dist-info/METADATA").decode()
    assert f"Version: {primer.__version__}" in metadata
    assert "License-Expression: BSD-3-Clause AND CC-BY-4.0" in metadata
    code = "import sys; sys.path.insert(0, sys.argv[1]); import primer; from primer.claims import claims\n"
    code += "from primer.view.style import styled\nwith styled(): print(primer.__file__, len(claims()))"
    done = subprocess.run(
        [sys.executable, "-P", "-c", code, str(tmp_path)], capture_output=True, text=True, cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(str(tmp_path))


@pytest.mark.slow
def test_the_sdist_holds_what_one_needs_to_work_on_it(built):
    _, _, names = built
    for folder in ("primer", "figures", "tests", "notebooks"):
        assert ours(folder) <= names, ours(folder) - names
    top = "README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff LICENSE LICENSE-prose pyproject.toml .ci/run .gitignore"
    assert {*top.split(), "paper.md", "paper.bib", ".pre-commit-config.yaml", "PKG-INFO"} <= names
    rooms = {"primer", "figures", "tests", "notebooks", ".ci"}
    assert {name.split("/")[0] for name in names if "/" in name} == rooms


def test_the_citation_has_what_the_format_requires():
    lines = read("CITATION.cff").splitlines()
    keys = [line.partition(":")[0] for line in lines if re.match(r"[a-z]", line)]
    assert {"cff-version", "message", "title", "authors", "version", "license", "references"} <= set(keys)
    assert len(keys) == len(set(keys))
    assert "cff-version: 1.2.0" in lines
    assert "license: BSD-3-Clause" in lines


def test_the_paper_is_cited_alike_everywhere():
    for name in ("CITATION.cff", "paper.bib", "README.md"):
        assert "10.1098/rspa.2016.0846" in read(name), name
        assert "1610.05135" in read(name), name
    paper = read("paper.md")
    assert set(re.findall(r"@([A-Za-z]+\d{4})", paper)) == set(
        re.findall(r"^@\w+\{(\w+),", read("paper.bib"), flags=re.M)
    )
    assert re.findall(r"- name: (.+)", paper) == re.findall(r"- name: (.+)", read("CITATION.cff"))
    assert all(f"\n# {part}\n" in paper for part in ("Summary", "Statement of need", "Audience", "How it is used"))


def test_versions_agree_everywhere():
    project = tomllib.loads(read("pyproject.toml"))
    assert project["project"]["dynamic"] == ["version"]
    assert project["tool"]["hatch"]["version"]["path"] == "primer/__init__.py"
    assert re.findall(r"^## (\S+)", read("CHANGELOG.md"), flags=re.M)[0] == primer.__version__


def test_the_checks_before_a_commit_are_those_of_ci():
    entries = re.findall(r"^ +entry: (.+)$", read(".pre-commit-config.yaml"), flags=re.M)
    assert entries == re.findall(r"^(ruff .+|mypy)$", read(".ci/run"), flags=re.M)


def test_contributing_names_commands_that_exist():
    text = read("CONTRIBUTING.md")
    for command in ("python figures/regenerate.py --check", "python -m pytest", 'pip install -e ".[test]"'):
        assert command in text
    assert len(re.findall(r"^\d+\. ", text, flags=re.M)) == 10


def test_without_arguments_it_greets():
    done = subprocess.run([sys.executable, "-m", "primer"], capture_output=True, text=True, cwd=ROOT)
    assert (done.returncode, done.stderr) == (0, "")
    assert all(word in done.stdout for word in ("Welcome", "usage: primer", "verdict", "granular", "lab", "claims"))
    for example in re.findall(r"^  primer (.+?)  +", done.stdout, flags=re.M):
        if not example.startswith("lab"):
            assert main(shlex.split(example)) == 0


def test_ctrl_c_gives_130(monkeypatch):
    class Interrupted(io.StringIO):
        def read(self, *_):
            raise KeyboardInterrupt

    monkeypatch.setattr(sys, "stdin", Interrupted())
    assert main(["verdict", "-"]) == 130


def test_the_environment_is_that_of_the_package():
    """What conda and Binder build: the Python that pyproject.toml asks for, and the package itself."""
    lines = [line.strip() for line in read("environment.yml").splitlines() if not line.startswith("#")]
    assert f"- python{tomllib.loads(read('pyproject.toml'))['project']['requires-python']}" in lines
    assert lines[-2:] == ["- pip:", "- -e ."]
