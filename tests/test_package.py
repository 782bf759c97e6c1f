"""Guards the house: lazy imports, floors that only import downwards, public names that exist, examples that run."""

import ast
import inspect
import re
import shlex
import subprocess
import sys
from dataclasses import fields, is_dataclass
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import primer
from primer.__main__ import main

ROOT = Path(__file__).parents[1]
PACKAGE = Path(primer.__file__).parent  # in the checkout, or where a wheel was installed
MODULES = sorted(PACKAGE.rglob("*.py"))
FLOORS = [
    "types",
    "checks",
    "claims",
    "arithmetic",
    "compiled",
    "terminal",
    "equations",
    "problems",
    "schemes",
    "analysis",
    "granular",
    "study",
    "scenes",
    "exercises",
    "view",
    "lab",
    "site",
    "slides",
    "run",
    "diagnosing",
    "region_command",
    "base_state",
    "__main__",
]


def imported(path):
    """Dotted names of the modules that a file imports, anywhere in it."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module


def floor(path):
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def test_import_primer_is_light():
    code = "import sys, primer; print(*{name.split('.')[0] for name in sys.modules})"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not {"numba", "matplotlib", "sympy", "ipywidgets", "bokeh", "scipy", "mpmath"} & set(loaded)


@pytest.mark.parametrize(
    "path", [p for p in MODULES if p.name != "__init__.py"], ids=lambda p: str(p.relative_to(PACKAGE))
)
def test_imports_only_point_down(path):
    here = FLOORS.index(floor(path))
    for module in imported(path):
        if module.startswith("primer."):
            assert FLOORS.index(module.split(".")[1]) <= here, f"{path.name} imports {module}"
        if floor(path) != "view":
            assert module.split(".")[0] not in ("matplotlib", "ipywidgets", "bokeh"), f"{path.name} imports {module}"
        assert module != "matplotlib.pyplot"


@pytest.mark.parametrize("name", primer.__all__)
def test_public_names_exist_and_say_what_they_are(name):
    assert getattr(primer, name).__doc__
    assert name in dir(primer)


def test_dataclasses_are_frozen():
    """And every module can be imported by itself."""
    seen = set()
    for path in MODULES:
        name = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__")
        seen |= {x for x in vars(import_module(name)).values() if isinstance(x, type) and is_dataclass(x)}
    assert len(seen) > 40
    assert [x.__name__ for x in seen if not x.__dataclass_params__.frozen] == []
    # Arrays have no truth value to compare results by, functions no other one than themselves.
    holds_arrays = {x for x in seen if any(kind in str(f.type) for f in fields(x) for kind in ("ndarray", "Numbers"))}
    assert [x.__name__ for x in holds_arrays if x.__dataclass_params__.eq] == []
    inside = "AtWork Atlas Case Code Dispersion Family GridThreshold Job Known Lanes Leaves Linearisation Movie"
    inside += " Pencil Refinement RheologyAnswer Source Subject Tangent _Matrix"  # deeper down
    assert sorted(x.__name__ for x in seen - holds_arrays if not x.__dataclass_params__.eq) == inside.split()


def test_results_of_studies_that_hold_arrays_are_compared_as_themselves():
    """The == of arrays is no truth value, and they have no hash; everything else is equal where its parts are."""
    by_value = {"HardCase", "Method", "Point", "WorkPrecision", "Diagnosis", "Forecast", "Judgement", "Nudged", "Piece"}
    for path in (PACKAGE / "study").glob("*.py"):
        for thing in vars(import_module(f"primer.study.{path.stem}")).values():
            if isinstance(thing, type) and is_dataclass(thing) and thing.__module__ == f"primer.study.{path.stem}":
                assert (thing.__eq__ is not object.__eq__) == (thing.__name__ in by_value), thing


def test_what_is_left_out_is_the_same_everywhere():
    """The paper's runs to t = 100 on 100 points with dt = 1e-3 and eps = 0.01; 5 for what is timed."""
    usual = {
        "n": 100, "dt": 1e-3, "t_end": 100.0, "eps": 0.01, "blow_up_at": 1e3, "dtype": np.float64, "order": "full",
        "snapshots": (), "progress": True, "rho": 1.0, "d": 1.0, "I": 0.1,
    }  # fmt: skip
    timed = ("work_precision", "cost_against_n")
    found = 0
    for module in (primer, import_module("primer.granular")):
        for name in set(module.__all__) - {"Run"}:
            if callable(thing := getattr(module, name)) and not (isinstance(thing, type) and issubclass(thing, str)):
                for key, parameter in inspect.signature(thing).parameters.items():
                    if key in usual and parameter.default not in (None, inspect.Parameter.empty):
                        found += 1
                        expected = 5.0 if key == "t_end" and name in timed else usual[key]
                        expected = (64, 128, 256) if (name, key) == ("examine", "n") else expected
                        assert parameter.default == expected, name
    assert found > 30


def test_unknown_names_are_refused():
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = primer.nonsense


def test_no_module_is_longer_than_250_lines():
    lengths = {str(path): len(path.read_text(encoding="utf-8").splitlines()) for path in MODULES}
    assert max(lengths.values()) <= 250, max(lengths, key=lengths.get)


def readme():
    return (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("example", re.findall(r"```python\n(.*?)```", readme(), flags=re.S))
def test_readme_examples_run(example, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(compile(example, "README.md", "exec"), names)
    out = capsys.readouterr().out
    said = "blew_up" in out and "reached_end" in out, "0.005 |xi|^2" in out, "64" in out and "hidden" in out
    said += "scheme 0.0003" in out, "well-posed" in out and "order 2.0" in out
    assert any(said) or list(tmp_path.iterdir())


def test_readme_layout_names_every_room():
    (picture,) = re.findall(r"## How the code is laid out\n.*?```text\n(.*?)```", readme(), flags=re.S)
    for path in [*PACKAGE.iterdir(), *(ROOT / d for d in ("figures", "tests", "notebooks"))]:
        if path.suffix in (".py", "") and path.name not in ("__init__.py", "__pycache__"):
            assert re.search(rf"\b{path.name}(/|\s)", picture), path.name


def test_every_figure_is_listed_once():
    others = {"regenerate", "sidecar", "readme", "blow_up_movie", "explorer"}
    scripts = {path.stem for path in (ROOT / "figures").glob("*.py")} - others
    listed = (ROOT / "figures" / "README.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"^\| \[(\w+)\]\(\1\.svg\)", listed, flags=re.M)) == sorted(scripts)


def test_versions_agree():
    assert re.fullmatch(r"\d+\.\d+\.\d+", primer.__version__)
    assert f"## {primer.__version__}" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"version: {primer.__version__}" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")


@pytest.mark.parametrize("block", re.findall(r"```console\n\$ primer (.*?)```", readme(), flags=re.S))
def test_readme_shows_what_the_commands_print(block, capsys):
    command, shown = block.split("\n", 1)
    assert main(shlex.split(command)) == 0
    assert capsys.readouterr().out == shown
