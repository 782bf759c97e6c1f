"""Guards the map of blow-up times over any two parameters: against the toy system's own map, and against verdicts."""

import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from types import SimpleNamespace

import numpy as np
import pytest

from primer import PDE, Seed, Stop, blow_up_map, ftcs

sweeping = sys.modules["primer.study.sweep"]

TOY = PDE(
    "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)",
    {"u": "a", "v": "-sin(x)/2"}, steady={"u": "a - cos(x)", "v": "0"}, a=0.5, eps=0.01,
)  # fmt: skip


def test_the_toys_text_has_the_toys_map():
    own = blow_up_map([0.5, 1.5], [30, 100], t_end=20.0, progress=False)
    found = blow_up_map(TOY, vary={"a": [0.5, 1.5], "n": [30, 100]}, t_end=20.0)
    assert (np.isfinite(found.t_blow_up) == np.isfinite(own.t_blow_up)).all()
    assert found.t_blow_up[0, 1] == pytest.approx(own.t_blow_up[0, 1], rel=0.15)  # of round-off, at another dt
    assert found.t_seeded[0, 1] == pytest.approx(own.t_seeded[0, 1], rel=0.01)
    assert (found.from_round_off == own.from_round_off).all()
    assert found.names == ("a", "n")
    assert (found.dt == 1e-3).all()


def test_diffusion_of_either_sign_over_two_parameters_none_of_which_is_the_grid():
    """u_t = k u_xx + s u_x: only k < 0 blows up, whatever s, and no step is to blame."""
    pde = PDE("u_t = k*u_xx + s*u_x", {"u": "sin(x)"}, steady={"u": 0}, k=1, s=0)
    found = blow_up_map(pde, vary={"k": [-1.0, 0.5, 2.0], "s": [0.0, 1.0]}, n=32, t_end=5.0, dt=0.1)
    assert np.isfinite(found.t_blow_up).tolist() == [[True, True], [False, False], [False, False]]
    h = 2 * np.pi / 32
    assert (found.dt[1:] <= h**2 / 2 / np.array([[0.5], [2.0]])).all()
    assert found.t_seeded[0, 0] < found.t_blow_up[0, 0]


A, N = [0.3, 0.6, 1.5], [16, 80, 120]


def same(one, other):
    for name in ("rows", "columns", "dt", "t_blow_up", "t_seeded"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


def toy_map(a=A, pde=TOY, **options):
    return blow_up_map(pde, vary={"n": N, "a": a}, t_end=30.0, **({"progress": False} | options))


@pytest.fixture(scope="module")
def whole():
    return toy_map()


def test_cells_are_single_runs(whole):
    assert whole.done.all()
    for i, n in enumerate(N):
        for j, a in enumerate(A):
            pde, dt = TOY.replace(a=a), whole.dt[i, j]
            for found, seed in ((whole.t_blow_up, None), (whole.t_seeded, Seed(n // 2 - 1, 1e-12))):
                if seed is None or whole.t_blow_up[i, j] < np.inf:
                    run = ftcs(pde, n, dt, 30.0, seed=seed)
                    assert found[i, j] == (run.t_stop if run.stop is Stop.BLEW_UP else np.inf)
    assert np.isfinite(whole.t_blow_up).tolist() == [[False] * 3, [True, False, False], [True, True, False]]


def test_threads_give_the_same_map(whole):
    with ThreadPoolExecutor(2) as executor:
        same(toy_map(executor=executor), whole)


@pytest.mark.slow
def test_spawned_processes_give_the_same_map(whole):
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as executor:
        same(toy_map(executor=executor), whole)


def test_an_interrupted_map_keeps_what_was_done_and_goes_on(whole, tmp_path, monkeypatch):
    """And a wider one marches what is new alone, whatever is marched together with it."""
    march, marched, broken = sweeping.ftcs_ensemble, [], [120]

    def interrupted(problems, n, *options, **named):
        if n in broken:
            raise KeyboardInterrupt
        if named["seed"] is None:
            marched.extend((n, pde.parameters["a"]) for pde in problems)
        return march(problems, n, *options, **named)

    monkeypatch.setattr(sweeping, "ftcs_ensemble", interrupted)
    path = tmp_path / "map.csv"
    first = toy_map(table=path)
    assert first.done.tolist() == [[True] * 3, [True] * 3, [False] * 3]
    assert np.isnan(first.dt[2]).all()
    assert not first.from_round_off[2].any()
    np.testing.assert_array_equal(first.t_seeded[:2], whole.t_seeded[:2])
    broken.clear()
    same(toy_map(table=path), whole)
    assert sorted(marched) == [(n, a) for n in N for a in A]
    wider = toy_map([0.3, 0.45, 0.6, 1.5], table=path)
    np.testing.assert_array_equal(wider.t_seeded[:, [0, 2, 3]], whole.t_seeded)
    assert marched[9:] == [(n, 0.45) for n in N]
    assert [each.name for each in tmp_path.iterdir()] == ["map.csv"]


def test_a_table_is_of_one_problem(tmp_path):
    """Functions and samples count by their values, so that another process knows them again."""
    path = tmp_path / "map.csv"
    text = "u_t = k*u_xx + s*u_x"

    def quick(initial, text=text, table=path, k=1, t_end=0.1, **options):
        pde = PDE(text, {"u": initial}, k=k, s=0, **options)
        return blow_up_map(pde, vary={"k": [0.5], "s": [0.0, 1.0]}, n=8, t_end=t_end, table=table, progress=False)

    found = quick(np.sin)
    same(quick(lambda x: np.sin(x)), found)
    same(quick(np.sin, k=7), found)  # a value that is varied is not the table's
    for other in (
        lambda: quick(np.cos), lambda: quick("sin(x)"), lambda: quick(np.sin, period=2.0),
        lambda: quick(np.sin, steady={"u": 0}), lambda: quick(np.sin, t_end=0.2),
        lambda: quick(np.sin, "u_t = s*u_x + k*u_xx"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=r"^table must be new or one of the same sweep"):
            other()
    quick([1, 2, 3, 4], table=tmp_path / "samples.csv")
    with pytest.raises(ValueError, match=r"^table must be new"):
        quick([1, 2, 3, 5], table=tmp_path / "samples.csv")


def test_a_job_that_fails_is_named_and_the_others_kept(monkeypatch):
    march = sweeping.ftcs_ensemble

    def failing(problems, n, *options, **named):
        if n == 80:
            raise MemoryError("no more")
        return march(problems, n, *options, **named)

    monkeypatch.setattr(sweeping, "ftcs_ensemble", failing)
    with ThreadPoolExecutor(1) as executor, pytest.warns(RuntimeWarning, match="not marched") as caught:
        found = blow_up_map(TOY, vary={"n": N, "a": A}, t_end=0.1, dt=1e-4, executor=executor, progress=False)
    assert [str(each.message) for each in caught] == [
        "not marched, and not a number in the map: n = 80, a = 0.3 and 2 more (MemoryError: no more)"
    ]
    assert caught[0].filename == __file__
    assert found.done.tolist() == [[True] * 3, [False] * 3, [True] * 3]


def test_the_bar_counts_cells(monkeypatch):
    bars = []

    class Bar:
        def __init__(self, **options):
            self.options, self.steps = options, []
            bars.append(self)
            self.update = self.steps.append

        def __enter__(self):
            return self

        def __exit__(self, *_):
            return None

    monkeypatch.setitem(sys.modules, "tqdm", SimpleNamespace(tqdm=Bar))
    toy_map(progress=True)
    assert bars[0].options == {"total": 9, "unit": "cell", "disable": None}
    assert sum(bars[0].steps) == 9
    assert len(bars[0].steps) > 2


@pytest.mark.parametrize(
    ("call", "what"),
    [
        (lambda: blow_up_map(TOY, vary={"a": [1.0]}), "vary must be a dict of two"),
        (lambda: blow_up_map(TOY), "vary must be a dict of two"),
        (
            lambda: blow_up_map(TOY, vary={"a": [1.0], "b": [2.0]}),
            "vary must name parameters of the PDE, or n",
        ),
        (lambda: blow_up_map(TOY, vary={"a": [1.0], "n": [2]}), "vary n must be an integer >= 4, got 2"),
        (lambda: blow_up_map(TOY, vary={"a": ["x"], "n": [8]}), "vary a must be"),
        (lambda: blow_up_map(TOY, vary={"a": [1.0], "n": [8]}, dt=0), "dt must be"),
        (lambda: blow_up_map(TOY, vary={"a": [1.0, 1.0], "n": [8]}), "vary a must be without repeats"),
        (lambda: blow_up_map(TOY, vary={"a": [1.0], "n": [8]}, executor=3), "executor must be a concurrent.futures.Ex"),
        (
            lambda: blow_up_map(TOY, vary={"a": [1.0], "n": [8]}, table=3),
            "table must be the path of a CSV file or None",
        ),
        (lambda: blow_up_map(TOY, vary={"a": range(10**5), "n": [8, 9]}), "vary must make at most 100000 cells, got 1"),
        (lambda: blow_up_map(TOY, [8], vary={"a": [1.0], "n": [8]}), "n_values and eps go with base states"),
        (lambda: blow_up_map(TOY, eps=0.1, vary={"a": [1.0], "n": [8]}), "n_values and eps go with base states"),
        (lambda: blow_up_map([0.5], [8], vary={"a": [1.0], "n": [8]}), "vary goes with a PDE"),
    ],
)
def test_bad_input_gets_one_sentence(call, what):
    with pytest.raises((TypeError, ValueError), match=what):
        call()
