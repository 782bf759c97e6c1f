"""Guards the annotations: complete on what is public, true by mypy, and a user's type checker makes use of them."""

import importlib
import inspect
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import primer

ROOT = Path(__file__).parents[1]
ROOMS = ("primer", "primer.granular", "primer.study", "primer.view.explorers", "primer.exercises")
OWN = {"__init__", "__call__"}  # of a class, beside its public names; what a dataclass generates is annotated by itself
needs_mypy = pytest.mark.skipif(not find_spec("mypy"), reason="needs mypy")


def functions(thing):
    """The functions that a public thing gives to call: itself, or those of its class and the classes it is made of."""
    if inspect.isroutine(thing):
        yield thing.__qualname__, inspect.unwrap(thing)
        return
    for one in inspect.getmro(thing if inspect.isclass(thing) else type(thing)):
        for name, part in vars(one).items():
            part = getattr(part, "fget", None) or getattr(part, "func", None) or getattr(part, "__func__", part)
            ours = one.__module__.startswith("primer.") and (not name.startswith("_") or name in OWN)
            part = inspect.unwrap(part) if callable(part) else part
            if ours and inspect.isfunction(part) and part.__module__.startswith("primer."):
                yield f"{one.__name__}.{name}", part


def public():
    for room in map(importlib.import_module, ROOMS):
        for name in room.__all__:
            yield from functions(getattr(room, name))


def test_what_is_public_is_annotated():
    found = dict(public())
    assert len(found) > 140
    bare = {}
    for name, function in found.items():
        signature = inspect.signature(function)
        parts = [
            p.name for p in signature.parameters.values() if p.annotation is p.empty and p.name not in ("self", "cls")
        ]
        parts += ["return"] * (signature.return_annotation is signature.empty)
        bare |= {name: parts} if parts else {}
    assert not bare
    # help() and a notebook's tooltip say ArrayLike, rather than the two hundred characters of what that is.
    assert not [name for name, function in found.items() if "_typing" in str(inspect.signature(function))]


def test_a_type_checker_sees_the_names_that_are_loaded_late():
    stub = Path(primer.__file__).with_suffix(".pyi").read_text(encoding="utf-8")
    names = re.findall(r"^from \.([\w.]+) import (\w+) as \2$", stub, flags=re.M)
    assert {name: home for home, name in names} == primer._HOME
    assert re.findall(r"^from \. import (\w+) as \1$", stub, flags=re.M) == sorted(primer._ROOMS)


def mypy(*arguments, **options):
    return subprocess.run([sys.executable, "-m", "mypy", *arguments], capture_output=True, text=True, **options)


@pytest.mark.slow
@needs_mypy
@pytest.mark.skipif(not (ROOT / "primer").is_dir(), reason="there is no source here to check")
def test_the_package_is_what_its_annotations_say():
    found = mypy(cwd=ROOT)
    assert found.returncode == 0, found.stdout


RIGHT = """
import numpy as np
import primer
from primer import BackwardHeat, BaseState, CIDR, CSSM, Compaction, Friction, MuI, Pencil, Run, Seed, Toy
from primer import blow_up_map, critical_state, diagnose, ftcs, ftcs_ensemble, grid_threshold, growth, growth_laws
from primer import growth_limit, linearise, march_lines, max_growth, neutral_inertial_numbers, reference, refine
from primer import CENTRAL_4, FOURIER, RK8, stable_dt, verdict, work_precision
from primer.exercises import ask_03_1, check_03_1
from primer.granular import GLASS_BEADS, coefficients, largest_growth
from primer.view import RefinementExplorer

class Advection:
    fields = ("u",)
    def initial(self, x): return (np.sin(x),)
    def steady(self, x): return (0 * x,)
    def forcing(self, x): return None
    def rhs(self, x, state, derivative, forcing=None): return (-derivative(state[0], 1),)

toy, heat, grids = Toy(a=0.5), BackwardHeat(xi=3), np.array([25, 50])
run: Run = ftcs(toy, n=grids[1], t_end=2, seed=Seed(3, 1e-9), dtype="float32", snapshots=np.arange(3.0))
runs = [ftcs(Advection(), t_end=0.1), *ftcs_ensemble([Toy(a) for a in np.linspace(0, 2, 5)], 64, t_end=0.1)]
runs += refine(heat, (25, 50), t_end=0.1, seed=(3, 1e-9)).runs
slopes = refine(toy, grids, dt=lambda n: 1 / n**2, seed=lambda n: Seed(n // 2, 1e-9), t_end=0.1).dist_end[1:]
ends = march_lines(toy, 16, 0.1, 5, FOURIER, RK8), march_lines(heat, 16, 0.1, 1, CENTRAL_4)
u, v = reference(toy, [0.25, 0.5]).at(0.0)
numbers = run.dist[-1] * 2, run.problem.a, ends[0].blew_up, u[0] + toy.steady(0.0)[0]
rates = toy.symbol([1, 2], u=0.5).real.max(), stable_dt(toy, 50) / 2, (grid_threshold(0.5).n or 0) + 1
pencil = Pencil(lambda xi: [[xi**2]], np.eye(1))
rates = growth(pencil, [1.0, 2.0])[0] + growth(pencil, 3.0), max_growth(pencil, 10.0).growth.max(), 1
exponent = float(verdict("u_t = eps*u_xx", eps=0.1).exponent)
law = growth_laws("u_t = u*u_x", at={"u": 1, "u_x": 0})[0].law
matrix, packing = linearise("u_t = u_xx"), Compaction(0.5, 0.1, 1)
for soil in (CIDR(GLASS_BEADS.friction, packing), CSSM(0.4, packing), CIDR(Friction(np.tanh, np.cos), packing)):
    states, state = critical_state(soil, phi=np.linspace(0.51, 0.59, 5)), BaseState(0.02, 0.55, I=0.1)
    found = growth_limit(soil, states)[0], coefficients(soil, state).B, largest_growth(soil, state, 10.0)[1]
ends_of_range = neutral_inertial_numbers(MuI(0.3, 0.6, 0.3)).round(3)
words = diagnose(toy, seed=1e-9).reason.split(), ask_03_1(3).upper(), primer.__version__.split(".")
times = blow_up_map([0.5], range(20, 22), t_end=0.1, table="map.csv", progress=False).t_blow_up[0]
feedback, explorer, again = check_03_1(0.1).right, RefinementExplorer(a=0.5).state.split(","), primer.study.diagnose
point = work_precision(toy, t_end=0.5, methods=[]).quickest("FTCS", 1e-3)
"""
WRONG = """
ftcs(toy, n="many")
ftcs(0.5)
ftcs(toy, snapshots=3.0)
ftcs_ensemble(toy)
Toy("a")
BackwardHeat(xi=0.5)
Seed(3)
refine(toy, [25, 50]).no_such_field
refine(toy, 25)
march_lines(toy, 16, 0.1, 5.0, time="RK4")
march_lines(toy, 16, 0.1, 5.0).stop
reference(heat, 1.0)
growth("u_t = u_xx", 1.0)
verdict(toy)
verdict("u_t = u_xx").kinds
growth_limit(packing, state)
critical_state(MuI(0.3, 0.6, 0.3), 0.55)
diagnose(toy, t_end="long")
check_03_1("0.1")
RefinementExplorer.from_state(0.5)
primer.no_such_name
from primer import Toi
"""


@pytest.mark.slow
@needs_mypy
def test_a_users_right_calls_pass_and_wrong_ones_are_reported(tmp_path):
    """By a checker that stands elsewhere: it has to find ``py.typed`` and the names that are loaded late."""
    right, wrong = RIGHT.strip().splitlines(), WRONG.strip().splitlines()
    (tmp_path / "script.py").write_text("\n".join(right + wrong), encoding="utf-8")
    found = mypy("--strict", "--allow-untyped-defs", "--allow-untyped-calls", "script.py", cwd=tmp_path)
    reported = {int(line) for line in re.findall(r"^script\.py:(\d+): error", found.stdout, flags=re.M)}
    assert reported == {len(right) + k for k in range(1, len(wrong) + 1)}, found.stdout


def test_the_right_calls_are_right(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    exec(compile(RIGHT, "script.py", "exec"), {})
