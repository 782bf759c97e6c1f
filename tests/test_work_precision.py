"""Guards the work-precision study: all methods solve the same problem, the front is one, the table is the data's."""

import math
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import integrate

from primer import (
    CENTRAL,
    CENTRAL_4,
    CENTRAL_6,
    FOURIER,
    PDE,
    RK4,
    RK8,
    BackwardHeat,
    PastHorizon,
    Toy,
    ftcs,
    march_lines,
    reference,
)
from primer.schemes.grid import Grid
from primer.schemes.lines import stable_step
from primer.study import contestants as contestants_module
from primer.study import cost, measured, py_pde, truth
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
    assert study.quickest("m", 0.5).seconds == 2.0
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

    pde = SimpleNamespace(CartesianGrid=grid, ScalarField=field, PDE=PDE, FieldCollection=list)
    monkeypatch.setitem(sys.modules, "pde", pde)
    x, fields, dt = contestants_module._py_pde(Toy(1.5, 0.02), 8, 0.5)
    _, _, paper = contestants_module._ftcs(Toy(1.5, 0.02), 8, 0.5)
    assert (dt, asked["dt"], asked["t_range"]) == (paper, paper, 0.5)
    assert paper <= (math.pi / 8) ** 2
    assert asked["v"] == "(((((0.02 * u) * laplace(v)) + d_dx(u)) - v) - sin(x))"
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


def timed(monkeypatch, seconds):
    """A run that takes these times of a clock of ours, one after the other, and says which it is."""
    now, left = [100.0], list(enumerate(seconds))

    def run():
        k, spent = left.pop(0)
        now[0] += spent
        return k

    monkeypatch.setattr(cost.time, "perf_counter", lambda: now[0])
    return run


@pytest.mark.parametrize(
    ("seconds", "patience", "repeats", "median", "last"),
    [
        ([9.0, 3.0, 1.0, 8.0], 10.0, 3, 3.0, 3),  # the first does not count
        ([1.0, 1.0], 1.0, 1, 1.0, 1),
        ([0.5, *4 * [2.0**-6]], 1.0, 1, 2.0**-6, 4),  # short ones go on for a twentieth of a second
        ([5.0, 1.0, 0.5], 1.0, 2, 0.75, 2),  # it may have had to compile
        ([5.25], 1.0, 3, 5.25, 0),  # but not so long
        ([0.5, 0.5, 1.25], 1.0, 5, 1.25, 2),  # one that tries the patience is the last
    ],
)
def test_the_clock_takes_the_median_of_what_counts(monkeypatch, seconds, patience, repeats, median, last):
    assert cost.clock(timed(monkeypatch, seconds), patience, repeats) == (median, last)


def test_an_error_is_the_largest_of_u_and_v_against_a_reference_far_better(monkeypatch):
    asked = []

    def watched(*arguments, **options):
        asked.append((arguments, options))
        return reference(*arguments, **options)

    def march(toy, knob, t_end):
        x = Grid(knob).x
        fields = np.array([f[0] for f in reference(toy, t_end, 1e-12).at(x)])
        fields[knob % 2, 3] += 0.25 * (-1) ** knob
        return x, fields, 1 / knob

    monkeypatch.setattr(truth, "reference", watched)
    found = work_precision(None, 0.5, [Method("off", march, (8, 11))], repeats=1)
    assert [(p.n, p.dt, p.error) for p in found.points] == [
        (8, 1 / 8, pytest.approx(0.25)),
        (11, 1 / 11, pytest.approx(0.25)),
    ]
    assert (found.toy, found.t_end) == (Toy(1.5), 0.5)
    assert work_precision(Toy(-3.0, 0), 0.01, [Method("off", march, (8,))], repeats=1).toy == Toy(-3.0, 0)
    assert asked == [((Toy(1.5), 0.5), {"tol": 1e-13 * 3.5}), ((Toy(-3.0, 0), 0.01), {"tol": 1e-13 * 5})]


def test_lost_runs_have_an_infinite_error():
    def lost(toy, knob, t_end):
        return Grid(knob).x, np.full((2, knob), np.nan if knob == 8 else np.inf), 0.1

    found = work_precision(Toy(1.5), 0.1, [Method("bad", lost, (8, 16))], repeats=1)
    assert [p.error for p in found.points] == [math.inf, math.inf]
    assert not any(p.on_front for p in found.points)
    assert found.methods == ("bad",)
    assert found.of("bad") == found.points
    assert found.of("good") == ()


def test_patience_is_by_method(monkeypatch):
    """One that took just so long is given its next knob; one that took longer is not, and the next method starts."""
    monkeypatch.setattr(
        cost, "clock", lambda run, patience, repeats: (run.args[1] / 8, (np.zeros(4), np.zeros((2, 4)), 1))
    )
    methods = [Method(name, None, (8, 16, 24, 32)) for name in "ab"]
    monkeypatch.setattr(cost, "partial", lambda march, *args: SimpleNamespace(args=args))
    found = work_precision(Toy(1.5), 0.1, methods, patience=2.0)
    assert [(p.method, p.seconds) for p in found.points] == [(m, t) for m in "ab" for t in (1, 2, 3)]


def test_a_short_march_is_timed_whole(monkeypatch):
    now, spans = [0.0], []
    monkeypatch.setattr(cost.time, "perf_counter", lambda: now[0])

    def march(toy, n, t_end):
        assert toy == Toy(2.0)
        now[0] += t_end
        spans.append(t_end)
        return np.zeros(n), np.zeros((2, n)), 0.1

    methods = [Method("m", march, (8,)), Method("tol", march, (8,), by_points=False)]
    (point,) = cost.cost_against_n(Toy(2.0), 0.001, (50,), methods, seconds=1e-6)
    assert set(spans) == {0.001}
    assert (point.method, point.n, point.dt, point.seconds) == ("m", 50, 0.1, pytest.approx(0.001))
    spans.clear()
    (point,) = cost.cost_against_n(Toy(2.0), 0.06, (4,), methods, seconds=10)  # all of it, however short, and no more
    assert spans == 2 * [0.06]  # once for the compiler, and once for more than a twentieth of a second
    assert point.seconds == pytest.approx(0.06)
    spans.clear()
    (point,) = cost.cost_against_n(Toy(2.0), 3.0, (50,), methods, seconds=0.02)
    assert sorted(set(spans)) == [0.002, 0.008, 0.032]  # 5/n^2, then four times as far until half of that is reached
    assert point.seconds == pytest.approx(3.0)
    spans.clear()
    cost.cost_against_n(Toy(2.0), 3.0, (50,), methods, seconds=0.012)
    assert sorted(set(spans)) == [0.002, 0.008]


def test_cost_is_of_all_contestants_but_py_pde(monkeypatch):
    asked = []
    monkeypatch.setattr(cost, "contestants", lambda *of, **options: asked.append((of, options)) or [])
    assert cost.cost_against_n() == ()
    assert work_precision(Toy(1.5), 0.1).points == ()
    assert asked == [
        ((), {"with_py_pde": False, "problem": Toy(1.5), "t_end": 5.0}),
        ((), {"problem": Toy(1.5), "t_end": 0.1}),
    ]


def test_without_a_toy_it_is_that_of_the_well_posed_example():
    toys = []

    def march(toy, n, t_end):
        toys.append(toy)
        return np.zeros(n), np.zeros((2, n)), 0.1

    cost.cost_against_n(None, 0.1, (8,), [Method("m", march, (8,))], seconds=1e-9)
    assert set(toys) == {Toy(1.5)}


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: work_precision(t_end=-0.5), "t_end must be a finite number > 0, got -0.5"),
        (lambda: work_precision(patience=-0.5), "patience must be a finite number > 0, got -0.5"),
        (lambda: work_precision(repeats=0), "repeats must be an integer >= 1 and <= 10000, got 0"),
        (lambda: work_precision(repeats=10_001), "repeats must be an integer >= 1 and <= 10000, got 10001"),
        (lambda: cost.cost_against_n(t_end=-0.5), "t_end must be a finite number > 0, got -0.5"),
        (lambda: cost.cost_against_n(seconds=-0.5), "seconds must be a finite number > 0, got -0.5"),
        (
            lambda: cost.cost_against_n(3),
            "toy must be a PDE, a Toy, a BackwardHeat or an object with their methods, got 3",
        ),
        (lambda: work_precision(3), "toy must be a PDE, a Toy, a BackwardHeat or an object with their methods, got 3"),
    ],
)
def test_bad_input_gets_the_whole_sentence(call, sentence):
    with pytest.raises((TypeError, ValueError)) as caught:
        call()
    assert str(caught.value) == sentence


QUICK = ("FTCS", "central 2 + RK4", "central 4 + RK8", "central 6 + RK8")


def orders_of(problem, t_end, **options):
    """{method: order of accuracy between 50 and 100 points}."""
    methods = [
        Method(m.name, m.march, (50, 100), stages=m.stages)
        for m in contestants(False, problem, t_end)
        if m.name in QUICK
    ]
    study = work_precision(problem, t_end, methods, patience=30, repeats=1, **options)
    assert study.methods == QUICK
    return {m: math.log2(study.of(m)[0].error / study.of(m)[1].error) for m in study.methods}


EXPECTED = {"FTCS": 2, "central 2 + RK4": 2, "central 4 + RK8": 4, "central 6 + RK8": 6}
TRAVELS = PDE("u_t = -c*u_x", {"u": "exp(cos(pi*x))"}, period=2.0, c=0.5)
TURNS = PDE("u_t = i*k*u_xx", {"u": "exp(i*x)"}, k=0.5)
SWINGS = PDE("w_tt = w_xx - w", {"w": "cos(x)", "w_t": "0"})


@pytest.mark.slow
@pytest.mark.parametrize(
    ("problem", "t_end", "exact"),
    [
        (PDE("u_t = k*u_xx", {"u": "sin(x)"}, k=0.7), 1.0, lambda x, t: np.exp(-0.7 * t) * np.sin(x)),
        (TRAVELS, 0.5, lambda x, t: [np.exp(np.cos(np.pi * (x - t / 2)))]),
        (TURNS, 1.0, lambda x, t: np.exp(1j * (x - t / 2))),
        (SWINGS, 1.0, lambda x, t: (w := 2**0.5) and [np.cos(x) * np.cos(w * t), -w * np.cos(x) * np.sin(w * t)]),
        (PDE("u_t = -u*u_x + nu*u_xx", {"u": "1 + sin(x)"}, nu=0.5), 0.5, None),
        (PDE("u_t = -u_xxxx - u_xx + cos(t)*sin(x)", {"u": "0"}), 0.5, lambda x, t: np.sin(t) * np.sin(x)),
    ],
    ids=["heat", "advection", "Schroedinger", "Klein-Gordon", "Burgers", "forced, of fourth order"],
)
def test_any_equation_has_the_orders_of_its_methods(problem, t_end, exact):
    """Against solutions in closed form and, of Burgers' equation, the reference."""
    assert orders_of(problem, t_end, exact=exact) == pytest.approx(EXPECTED, abs=0.25)


@pytest.mark.slow
def test_every_contestant_marches_any_equation():
    """All of them to the end, the reference and scipy too, complex fields without LSODA, which has none."""
    for problem, t_end, number in ((TRAVELS, 0.5, 13), (TURNS, 0.5, 12), (SWINGS, 0.5, 13)):
        methods = [
            replace(m, knobs=(16, 32) if "Fourier +" in m.name else m.knobs[:2])
            for m in contestants(False, problem, t_end)
        ]
        study = work_precision(problem, t_end, methods, patience=30, repeats=1)
        assert len(study.methods) == number
        assert 0 < study.doubt < 1e-10
        for method in study.methods:
            assert len(study.of(method)) == 2
            assert study.of(method)[-1].error < 0.1
        assert study.of("Fourier + RK8")[-1].error < 1e-7
        assert study.of("reference")[0].error < 1e-6


def test_backward_heat_is_solved_in_closed_form_and_its_runs_are_lost_on_fine_grids():
    methods = [m for m in contestants(False, BackwardHeat(), 1.0) if m.name in ("FTCS", "central 2 + RK4")]
    assert [m.name for m in contestants(False, BackwardHeat())].count("reference") == 0
    study = work_precision(BackwardHeat(), 0.5, [replace(m, knobs=(8, 100, 200)) for m in methods], repeats=1)
    for method in ("FTCS", "central 2 + RK4"):
        coarse, *fine = study.of(method)
        growth = (8 / math.pi) ** 2 * math.sin(math.pi / 8) ** 2  # of sin x by central differences on 8 points
        assert coarse.error == pytest.approx(math.exp(0.5) - math.exp(0.5 * growth), rel=0.5)
        assert fine[-1].error > 1e3


def test_where_there_is_no_truth_that_is_said_in_one_sentence():
    own = SimpleNamespace(
        fields=("u",), initial=lambda x: (np.sin(x),), steady=lambda x: (0 * x,), forcing=lambda x: None,
        rhs=lambda x, state, derivative, forcing: (derivative(state[0], 2),),
    )  # fmt: skip
    with pytest.raises(PastHorizon, match="ill posed"):
        work_precision(PDE("u_t = -u_xx", {"u": "exp(cos(x))"}), 1.0, [])
    with pytest.raises(PastHorizon, match=r"u first touches 0"):
        work_precision(Toy(0.5), 5.0, [])
    with pytest.raises(TypeError, match=r"^exact must be a function of x and t, where the problem is no Toy, PDE or"):
        work_precision(own, 1.0, [])
    for wrong in (lambda x, t: 0.0, lambda x, t: [x, x], lambda x, t: x * np.nan):
        with pytest.raises(TypeError, match=r"^exact must give 1 finite arrays of the shape of x"):
            work_precision(own, 1.0, [], exact=wrong)
    methods = [replace(m, knobs=(16, 32)) for m in contestants(False, own, 1.0) if m.name == "central 4 + RK4"]
    found = work_precision(own, 1.0, methods, repeats=1, exact=lambda x, t: np.exp(-t) * np.sin(x))
    assert math.log2(found.points[0].error / found.points[1].error) == pytest.approx(4, abs=0.2)


def test_a_method_is_taken_no_further_than_it_goes():
    def march(toy, n, t_end):
        if n > 8:
            raise ValueError("n must be small")
        return np.zeros(n), np.zeros((2, n)), 0.1

    found = work_precision(Toy(1.5), 0.1, [Method("m", march, (8, 16, 32)), Method("k", march, (8,))], repeats=1)
    assert [(p.method, p.n) for p in found.points] == [("m", 8), ("k", 8)]
    for study in (
        lambda: work_precision(Toy(1.5), 0.1, [Method("m", march, (16,))]),
        lambda: cost.cost_against_n(Toy(1.5), 0.1, (16,), [Method("m", march, (8,))]),
    ):
        with pytest.raises(ValueError, match=r"^n must be small"):
            study()


def test_the_cost_of_any_equation_is_that_of_its_whole_march():
    """Steps are those of a march to t_end, whatever stretch is timed; finding them out is not timed."""
    heat = PDE("u_t = u_xx", {"u": "1 + sin(x)"})
    (paper,) = (m for m in contestants(False, heat, 2.0) if m.name == "FTCS")
    asked = []
    watched = replace(paper, step=lambda problem, n: asked.append(n) or paper.step(problem, n))
    points = cost.cost_against_n(heat, 2.0, (20, 40), [watched], seconds=1e-3)
    assert asked == [20, 40]
    for p in points:
        limit = (2 * math.pi / p.n) ** 2 / 4 * 2 / 5
        assert limit / 2 < p.dt <= limit


def test_py_pde_is_given_any_text():
    pde = PDE(
        "u_tt = -(u_x - b*x/2)_x + u_xxxx/4 + abs(u)^3*exp(t) - 2i*u_t", {"u": "1", "u_t": "0"}, b=-0.5 + 1j
    )  # fmt: skip
    assert py_pde.expressions(pde) == {
        "u": "u_t",
        "u_t": "((((-d_dx((d_dx(u) - (((-0.5 + 1.0*I) * x) / 2)))) + (laplace(laplace(u)) / 4))"
        " + ((Abs(u)**3) * exp(t))) - ((2 * I) * u_t))",
    }


DOUBLING = (25, 50, 100, 200, 400, 800, 1600, 3200)
POINTS, FEW = dict.fromkeys(("central 2", "central 4", "central 6"), DOUBLING), (8, 10, 12, 14, 16, 20)
TOLERANCES = tuple(10.0**-k for k in range(4, 13))


def test_the_contestants_and_their_knobs(monkeypatch):
    expected = [("FTCS", DOUBLING, True, 1)]
    for time, stages in (("RK4", 4), ("RK8", 12)):
        expected += [(f"{space} + {time}", knobs, True, stages) for space, knobs in (POINTS | {"Fourier": FEW}).items()]
    expected += [
        ("reference", TOLERANCES[2:], False, 0),
        ("solve_ivp RK45, central 2", DOUBLING, True, 0),
        ("solve_ivp LSODA, Fourier", TOLERANCES, False, 0),
        ("solve_ivp DOP853, Fourier", TOLERANCES, False, 0),
    ]
    last = [("py-pde", (100,), True, 0)]

    def described(with_py_pde):
        return [(m.name, m.knobs, m.by_points, m.stages) for m in contestants(with_py_pde)]

    for here in (None, "a spec"):
        monkeypatch.setattr(contestants_module, "find_spec", lambda name, here=here: here if name == "pde" else 1 / 0)
        assert described(False) == expected
        assert described(None) == expected + (last if here else [])
    assert described(True) == expected + last
    monkeypatch.setattr(contestants_module, "find_spec", lambda name: None)
    with pytest.raises(ModuleNotFoundError) as caught:
        contestants(True)
    assert str(caught.value) == 'py-pde is not here: python -m pip install "illposed-primer[bench]" brings it'


SPACES = {"central 2": CENTRAL, "central 4": CENTRAL_4, "central 6": CENTRAL_6, "Fourier": FOURIER}


def test_each_pair_takes_the_step_whose_error_is_that_of_its_space():
    """c h^order or 10^(-1 - 0.8 n) = 6e-3 dt^4 or 5e-8 dt^8, but for 0.6, round-off and the limit of stability."""
    toy, methods, limits = Toy(1.5), {m.name: m for m in contestants(False)}, set()
    for name, space in SPACES.items():
        for time in (RK4, RK8):
            for n in (8, 12, 20) if name == "Fourier" else (8, 40, 100):
                h = 2 * math.pi / n
                order, c = {"central 2": (2, 0.25), "central 4": (4, 0.05), "central 6": (6, 0.012)}.get(name, (0, 0))
                error = c * h**order if order else max(10 ** (-1 - 0.8 * n), 1e-14)
                dt = (error / 6e-3) ** 0.25 if time is RK4 else (error / 5e-8) ** 0.125
                steps = {"accurate": dt, "0.6": 0.6, "stable": stable_step(toy, n, space, time)}
                limits.add(min(steps, key=steps.get))
                x, fields, step = methods[f"{name} + {time.name}"].march(toy, n, 2.0)
                run = march_lines(toy, n, min(steps.values()), 2.0, space, time)
                assert step == pytest.approx(run.dt, rel=1e-12)
                assert 2.0 / step == pytest.approx(math.ceil(2.0 / min(steps.values())), rel=1e-9)
                np.testing.assert_array_equal(x, run.x)
                np.testing.assert_allclose(fields, run.final, atol=1e-12)
    assert limits == {"accurate", "0.6", "stable"}


def test_the_paper_s_scheme_takes_a_quarter_of_h_squared_and_ends_at_the_end():
    for n, t_end, steps in ((25, 1.0, 64), (8, 1e-3, 1), (16, (math.pi / 8) ** 2 / 4 * 3, 3)):
        x, fields, dt = contestants_module._ftcs(Toy(1.5), n, t_end)
        assert steps == max(1, math.ceil(t_end / ((2 * math.pi / n) ** 2 / 4)))
        assert dt == t_end / steps
        np.testing.assert_array_equal(fields, ftcs(Toy(1.5), n, t_end / steps, t_end).final)
        np.testing.assert_array_equal(x, Grid(n).x)


@pytest.mark.parametrize("name", ["reference", "solve_ivp LSODA, Fourier", "solve_ivp DOP853, Fourier"])
def test_methods_of_their_own_steps_are_as_good_as_their_tolerance(name):
    (method,) = (m for m in contestants(False) if m.name == name)
    truth = reference(Toy(1.5), 1.0, 1e-12)
    for tol, n in ((1e-6, 12), (2e-7, 12), (1e-7, 16), (1e-8, 16), (2e-11, 16), (1e-11, 24)):
        x, fields, dt = method.march(Toy(1.5), tol, 1.0)
        assert math.isnan(dt)
        assert np.shape(fields) == (2, len(x))
        assert np.abs(np.array(fields) - [f[0] for f in truth.at(x)]).max() < 30 * tol
        if name != "reference":
            assert len(x) == n


def test_differences_by_scipy_are_given_the_tolerance_that_matches(monkeypatch):
    """A hundredth of h^2, absolute and relative; and the answer is that of the differences in exact time."""
    asked = {}
    solve = integrate.solve_ivp

    def watched(f, span, y, method, times, rtol, atol):
        asked.update(span=span, method=method, times=times, rtol=rtol, atol=atol)
        return solve(f, span, y, method, times, rtol=rtol, atol=atol)

    monkeypatch.setattr(integrate, "solve_ivp", watched)
    x, fields, dt = contestants_module._solve_ivp_by_points(Toy(1.5), 20, 1.0)
    tol = (2 * math.pi / 20) ** 2 / 100
    assert asked == {"span": (0, 1.0), "method": "RK45", "times": (1.0,), "rtol": tol, "atol": tol}
    assert math.isnan(dt)
    np.testing.assert_array_equal(x, Grid(20).x)
    np.testing.assert_allclose(fields, march_lines(Toy(1.5), 20, 1e-2, 1.0, CENTRAL, RK4).final, atol=5 * tol)


def test_a_file_of_measurements_has_four_digits_and_null_for_what_is_no_number(tmp_path):
    points = (Point("FTCS", 25, 0.123456, math.inf, 2.0, True), Point("solve_ivp", 8, math.nan, 1.23456e-7, 0.5))
    measured.write(tmp_path / "m.json", WorkPrecision(Toy(1.5, 0.02), 4.0, points), points[:1])
    assert (tmp_path / "m.json").read_text(encoding="utf-8") == (
        '{\n "a": 1.5,\n "eps": 0.02,\n "t_end": 4.0,\n "points": [\n'
        '  {"method": "FTCS", "n": 25, "dt": 0.1235, "error": null, "seconds": 2.0},\n'
        '  {"method": "solve_ivp", "n": 8, "dt": null, "error": 1.235e-07, "seconds": 0.5}\n ],\n "cost": [\n'
        '  {"method": "FTCS", "n": 25, "dt": 0.1235, "error": null, "seconds": 2.0}\n ]\n}\n'
    )
    study, kept = measured.read(tmp_path / "m.json")
    assert (study.toy, study.t_end) == (Toy(1.5, 0.02), 4.0)
    assert [p.on_front for p in study.points] == [False, True]
    assert math.isnan(kept[0].error)
    (tmp_path / "bad.json").write_text("{}", encoding="utf-8")
    with pytest.raises(
        ValueError, match=r"^path must be a file of measurements as write\(\) keeps them, got '.*bad.json'$"
    ):
        measured.read(tmp_path / "bad.json")
