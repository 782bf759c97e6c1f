"""Guards the work-precision study: all methods solve the same problem, the front is one, the table is the data's."""

import math
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from primer import Toy
from primer.study import contestants as contestants_module
from primer.study import cost, measured
from primer.study.contestants import Method, contestants
from primer.study.cost import Point, WorkPrecision, pareto, work_precision

ROOT = Path(__file__).parents[1]
STORE = ROOT / "figures" / "work_precision.measured.json"


@pytest.fixture(scope="module")
def study():
    methods = [Method(m.name, m.march, m.knobs[:3], m.by_points) for m in contestants(with_py_pde=False)]
    return work_precision(Toy(1.4, 0.02), 1.0, methods, repeats=1)


@pytest.mark.slow
def test_every_method_solves_the_problem_better_and_better(study):
    assert len(study.methods) == 13
    for method in study.methods:
        points = study.of(method)
        assert points[-1].error < 0.02, method
        if "solve_ivp" not in method:  # which at so few steps is better than it was asked to be
            assert points[-1].error <= points[0].error, method
        assert all(p.seconds > 0 for p in points)
    orders = {"central 2": 2, "central 4": 4, "central 6": 6}
    for name, order in orders.items():
        _, coarse, fine = study.of(f"{name} + RK8")
        assert fine.n == 2 * coarse.n
        assert math.log2(coarse.error / fine.error) == pytest.approx(order, abs=0.25)


def test_the_front_is_what_nothing_beats():
    data = [(1.0, 1.0), (2.0, 0.5), (3.0, 0.6), (2.0, 0.7), (0.5, math.inf), (4.0, 0.5), (1.0, 1.0)]
    points = pareto([Point("m", 8, 0.1, error, seconds) for seconds, error in data])
    assert [p.on_front for p in points] == [True, True, False, False, False, False, True]
    assert [(p.seconds, p.error) for p in points] == data
    study = WorkPrecision(Toy(1.5), 1.0, points)
    assert study.quickest("m", 0.6).seconds == 2.0
    assert study.quickest("m", 0.1) is None


def test_cost_is_scaled_to_the_whole_march(monkeypatch):
    """A march that takes a thousandth of a second of a clock of ours per point and unit of time."""
    now = [0.0]
    monkeypatch.setattr(cost.time, "perf_counter", lambda: now[0])

    def march(toy, n, t_end):
        now[0] += 1e-3 * n * t_end
        return np.zeros(n), np.zeros((2, n)), 0.1

    methods = [Method("by points", march, (8,)), Method("by tolerance", march, (1e-3,), by_points=False)]
    points = cost.cost_against_n(t_end=2.0, ns=(50, 200), methods=methods, seconds=0.01)
    assert [(p.method, p.n) for p in points] == [("by points", 50), ("by points", 200)]
    assert [p.seconds for p in points] == pytest.approx([0.1, 0.4])
    assert all(math.isnan(p.error) for p in points)


def test_cost_is_measured_by_default_to_time_5_on_50_to_3200_points_over_a_twentieth_of_a_second(monkeypatch):
    """Stretches grow fourfold until one takes at least half of that."""
    now, stretches = [0.0], {}
    monkeypatch.setattr(cost.time, "perf_counter", lambda: now[0])

    def march(toy, n, t_end):
        now[0] += 1e-3 * n**2 * t_end
        stretches.setdefault(n, []).append(t_end)
        return np.zeros(n), np.zeros((2, n)), 0.1

    points = cost.cost_against_n(methods=[Method("by points", march, (8,))])
    assert [p.n for p in points] == [50 * 2**k for k in range(7)]
    assert [p.seconds for p in points] == pytest.approx([5e-3 * p.n**2 for p in points])
    for n, spans in stretches.items():
        assert 0.025 < 1e-3 * n**2 * spans[-1] <= 0.1


def test_py_pde_is_given_the_steps_of_the_papers_scheme(monkeypatch):
    """A package of ours under its name says what it is asked for."""
    asked = {}

    class PDE:
        def __init__(self, equations):
            asked.update(equations)

        def solve(self, state, t_range, dt, tracker):
            asked.update(t_range=t_range, dt=dt)
            return SimpleNamespace(data=np.zeros((2, 8)))

    def grid(bounds, n, periodic):
        return SimpleNamespace(axes_coords=[np.linspace(*bounds[0], n + 1)[:-1]])

    def field(grid, value):
        return value

    field.from_expression = field
    pde = SimpleNamespace(CartesianGrid=grid, ScalarField=field, PDE=PDE, FieldCollection=list)
    monkeypatch.setitem(sys.modules, "pde", pde)
    x, fields, dt = contestants_module._py_pde(Toy(1.5, 0.02), 8, 0.5)
    _, _, paper = contestants_module._ftcs(Toy(1.5, 0.02), 8, 0.5)
    assert (dt, asked["dt"], asked["t_range"]) == (paper, paper, 0.5)
    assert paper <= (math.pi / 8) ** 2
    assert asked["v"] == "0.02 * u * laplace(v) + d_dx(u) - v - sin(x)"
    assert x.shape == (8,)
    assert fields.shape == (2, 8)


@pytest.mark.slow
def test_a_blow_up_is_an_infinite_error():
    def blown_up(toy, knob, t_end):
        return np.zeros(knob), np.full((2, knob), np.nan), 0.1

    study = work_precision(Toy(1.5), 1.0, [Method("bad", blown_up, (8, 16))], repeats=1)
    assert [p.error for p in study.points] == [math.inf, math.inf]
    assert not any(p.on_front for p in study.points)


def test_a_method_that_takes_long_is_taken_no_further():
    calls = []

    def slow(toy, knob, t_end):
        calls.append(knob)
        np.linalg.svd(np.ones((300, 300)))
        return np.zeros(knob), np.zeros((2, knob)), 0.1

    work_precision(Toy(1.5), 1.0, [Method("slow", slow, (8, 16, 32))], patience=1e-6)
    assert set(calls) == {8}


def test_measurements_survive_the_file(study, tmp_path):
    cost = (Point("FTCS", 50, 0.1, math.nan, 1.0),)
    measured.write(tmp_path / "m.json", study, cost)
    again, cost_again = measured.read(tmp_path / "m.json")
    assert again.toy == study.toy
    assert again.methods == study.methods
    for p, q in zip(again.points, study.points, strict=True):
        assert (p.method, p.n) == (q.method, q.n)
        assert p.seconds == pytest.approx(q.seconds, rel=1e-3)
        assert p.error == pytest.approx(q.error, rel=1e-3)
    assert math.isnan(cost_again[0].error)
    assert cost_again[0].seconds == 1.0
