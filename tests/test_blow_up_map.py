"""Guards the map of blow-ups: cells are single runs, and a sweep that is interrupted loses and repeats nothing."""

import math
import os
import subprocess
import sys
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from types import SimpleNamespace

import numpy as np
import pytest

from primer import Seed, Stop, Toy, blow_up_map, ftcs, stable_dt
from primer.study.maps import BlowUpMap, map_step
from primer.study.stability import OVERSHOOT
from primer.study.table import Table

sweep, sweeping = sys.modules["primer.study.maps"], sys.modules["primer.study.sweep"]
A, N = [0.3, 0.6, 1.5], [16, 80, 120]


def same(one, other):
    for name in ("a", "n", "dt", "t_blow_up", "t_seeded"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


@pytest.fixture(scope="module")
def reference():
    return blow_up_map(A, N, t_end=30.0, progress=False)


def test_cells_are_single_runs(reference):
    assert reference.t_blow_up.shape == (3, 3)
    assert reference.done.all()
    for i, a in enumerate(A):
        for j, n in enumerate(N):
            run = ftcs(Toy(a), n, reference.dt[j], 30.0)
            expected = run.t_stop if run.stop is Stop.BLEW_UP else math.inf
            assert reference.t_blow_up[i, j] == expected
            if expected < math.inf:
                seeded = ftcs(Toy(a), n, reference.dt[j], 30.0, seed=Seed(n // 2 - 1, 1e-12))
                assert reference.t_seeded[i, j] == seeded.t_stop
    assert np.isfinite(reference.t_blow_up).tolist() == [[False, True, True], [False, False, True], [False] * 3]


def test_round_off_is_what_a_small_seed_overtakes(reference):
    np.testing.assert_array_equal(reference.from_round_off, np.isfinite(reference.t_blow_up))
    coarse = blow_up_map([-1.0], [13], eps=0.1, t_end=30.0, progress=False)  # the smooth solution itself runs away
    assert np.isfinite(coarse.t_blow_up).all()
    assert not coarse.from_round_off.any()


@pytest.mark.slow
@pytest.mark.parametrize("pool", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_any_executor_gives_the_same_map(reference, pool):
    options = {} if pool is ThreadPoolExecutor else {"mp_context": get_context("spawn")}
    with pool(2, **options) as executor:
        same(blow_up_map(A, N, t_end=30.0, executor=executor, progress=False), reference)


@pytest.mark.slow
def test_dask_gives_the_same_map(reference):
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
        client.get_executor() as executor,
    ):
        same(blow_up_map(A, N, t_end=30.0, executor=executor, progress=False), reference)


def test_an_interrupted_sweep_goes_on_where_it_was(reference, tmp_path, monkeypatch):
    march, marched = sweep._column, []

    def interrupted(a, n, *rest):
        if n == 120 and not marched.count(120):
            marched.append(n)
            raise KeyboardInterrupt
        marched.append(n)
        return march(a, n, *rest)

    monkeypatch.setattr(sweep, "_column", interrupted)
    path = tmp_path / "map.csv"
    options = {"t_end": 30.0, "table": path, "progress": False}
    first = blow_up_map(A, N, **options)
    assert first.done.tolist() == [True, True, False]
    assert np.isnan(first.t_blow_up[:, 2]).all()
    same(blow_up_map(A, N, **options), reference)
    assert marched == [16, 80, 120, 120]  # nothing lost, nothing redone
    same(blow_up_map(A, N, **options), reference)
    assert len(marched) == 4
    wider = blow_up_map([0.3, 0.45, 0.6, 1.5], N, **options)  # only the new base state is marched
    np.testing.assert_array_equal(wider.t_blow_up[[0, 2, 3]], reference.t_blow_up)
    assert [p.name for p in tmp_path.iterdir()] == ["map.csv"]


def test_the_step_of_a_map_is_within_every_limit():
    """``most`` on coarse grids; else 0.9 of h^2/4, where u < 0 (physics.md: the central difference at its largest)."""
    assert map_step([0.5, 1.5], 16, 0.01) == 1e-3
    assert map_step([0.5, 1.5], 300, 0.01) == pytest.approx(0.9 * (2 * math.pi / 300) ** 2 / 4)
    stiff = map_step([0.5, 8.0], 200, 0.4)
    assert stiff == pytest.approx(0.9 * stable_dt(Toy(0, 0.4), 200, 8.0 + OVERSHOOT))
    assert stiff < 0.9 * (2 * math.pi / 200) ** 2 / 4
    assert map_step([], 16, 0.01) == 1e-3


def test_a_failed_write_leaves_the_table_as_it_was(tmp_path, monkeypatch):
    path = tmp_path / "t.csv"
    table = Table(path, {"eps": 0.1}, ("n",), ("t",))
    table.add({(4,): (1 / 3,)})
    before = path.read_bytes()
    monkeypatch.setattr(os, "replace", lambda *_: (_ for _ in ()).throw(OSError("full")))
    with pytest.raises(OSError, match="full"):
        table.add({(5,): (math.inf,)})
    assert path.read_bytes() == before
    assert Table(path, {"eps": 0.1}, ("n",), ("t",)).rows == {(4.0,): (1 / 3,)}


def test_a_table_of_another_sweep_is_refused(tmp_path):
    path = tmp_path / "map.csv"
    blow_up_map([1.5], [8], t_end=1.0, table=path, progress=False)
    with pytest.raises(ValueError, match="table must be new or one of the same sweep"):
        blow_up_map([1.5], [8], t_end=2.0, table=path, progress=False)


@pytest.mark.parametrize(
    ("arguments", "options", "error", "sentence"),
    [
        (([0.5, 0.5], [8]), {}, ValueError, "a_values must be without repeats"),
        (([0.5], [3]), {}, ValueError, "n_values must be an integer >= 4, got 3"),
        (([0.5], [8]), {"executor": 3}, TypeError, "executor must be a concurrent.futures.Executor or None, got 3"),
        (([0.5], [8]), {"seed": 0}, ValueError, "seed must be a finite number > 0, got 0"),
    ],
)
def test_bad_input_gets_one_sentence(arguments, options, error, sentence):
    with pytest.raises(error) as caught:
        blow_up_map(*arguments, **options)
    assert str(caught.value).startswith(sentence)


def test_a_blow_up_is_from_round_off_if_the_seed_comes_first_by_two_percent():
    nan, inf = math.nan, math.inf
    plain = np.array([[10.0, 10.0, 10.0, inf, nan]])
    seeded = np.array([[9.79, 9.81, inf, inf, nan]])
    found = BlowUpMap(np.array([0.5]), np.arange(5), 0.01, 1.0, np.ones(5), 1e-12, plain, seeded)
    assert found.from_round_off.tolist() == [[True, False, False, False, False]]
    assert found.done.tolist() == [True, True, True, True, False]
    two = BlowUpMap(
        np.arange(2), np.arange(3), 0.01, 1.0, np.ones(3), 1e-12, np.array([[1, nan, 1], [1, 1, nan]]), None
    )
    assert two.done.tolist() == [True, False, False]


def test_a_step_counts_u_from_zero_up_and_no_base_states_as_zero():
    h = 2 * math.pi / 200
    assert map_step([-3.0], 200, 10.0) == pytest.approx(0.9 * h**2 / 4)
    assert map_step([], 200, 10.0) == map_step([0.0], 200, 10.0) == pytest.approx(0.9 * 2 / (1 + 40 * OVERSHOOT / h**2))
    assert map_step([-1.0, 0.5], 200, 0.4, most=1e-6) == 1e-6
    assert map_step([-1.0, 0.5], 200, 10.0) == map_step([0.5], 200, 10.0) < map_step([-1.0], 200, 10.0)


class Inline(Executor):
    """Runs what is submitted at once; on the grid ``n`` it gives ``outcome`` instead, an error to raise or to keep."""

    def __init__(self, n=None, outcome=None):
        self.n, self.outcome, self.futures = n, outcome, {}

    def submit(self, function, a, n, *rest):
        if n == self.n and isinstance(self.outcome, BrokenExecutor):
            raise self.outcome
        future = self.futures[n] = Future()
        if n != self.n:
            future.set_result(function(a, n, *rest))
        elif self.outcome is not None:
            future.set_exception(self.outcome)
        return future


QUICK = {"t_end": 1.0, "progress": False}


@pytest.mark.parametrize("error", [BrokenExecutor("gone"), MemoryError("gone")])
def test_a_grid_whose_worker_dies_is_named_and_the_others_kept(error):
    """Whether it is dead when asked or dies on the way; the warning points at the call."""
    with pytest.warns(RuntimeWarning, match="not marched") as caught:
        found = blow_up_map([0.5, 1.5], [8, 10, 12], executor=Inline(10, error), **QUICK)
    why = f"n = 10 ({type(error).__name__}: gone)"
    assert [str(each.message) for each in caught] == [f"not marched, and not a number in the map: {why}"]
    assert caught[0].filename == __file__
    assert found.done.tolist() == [True, False, True]
    assert np.isnan(found.t_blow_up[:, 1]).all()
    assert np.isnan(found.t_seeded[:, 1]).all()
    assert np.isinf(found.t_seeded[:, [0, 2]]).all()


@pytest.mark.slow
def test_a_script_without_a_main_guard_is_told_what_to_do(tmp_path):
    """Spawned workers read the script again: one sentence, not a map of nothing and their traces."""
    script = tmp_path / "script.py"
    script.write_text(
        "import multiprocessing\nfrom concurrent.futures import ProcessPoolExecutor\nfrom primer import blow_up_map\n"
        "pool = ProcessPoolExecutor(2, mp_context=multiprocessing.get_context('spawn'))\n"
        "print(blow_up_map([0.5], [8, 10], t_end=1.0, executor=pool, progress=False).t_blow_up)\n",
        encoding="utf-8",
    )
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 1
    assert 'must stand under if __name__ == "__main__":' in done.stderr.splitlines()[-1]
    assert done.stderr.count("Traceback") == 1


def test_a_worker_that_is_interrupted_ends_the_sweep_and_what_waits_is_cancelled(monkeypatch):
    executor = Inline(10, None)  # this one never ends

    def as_completed(waiting):
        yield executor.futures[8]
        executor.futures[12].set_exception(KeyboardInterrupt()) if not executor.futures[12].done() else None
        interrupted = Future()
        interrupted.set_exception(KeyboardInterrupt())
        waiting[interrupted] = 2
        yield interrupted

    monkeypatch.setattr(sweeping, "as_completed", as_completed)
    found = blow_up_map([0.5], [8, 10, 12], executor=executor, **QUICK)
    assert found.done.tolist() == [True, False, False]
    assert executor.futures[10].cancelled()


def test_the_bar_counts_cells_and_hides_off_a_terminal(monkeypatch, tmp_path):
    bars = []

    class Bar:
        def __init__(self, **options):
            self.options, self.steps, self.says = options, [], []
            bars.append(self)
            self.update, self.set_postfix_str = self.steps.append, self.says.append

        def __enter__(self):
            return self

        def __exit__(self, *_):
            return None

    monkeypatch.setitem(sys.modules, "tqdm", SimpleNamespace(tqdm=Bar))
    path = tmp_path / "map.csv"
    blow_up_map([0.5, 1.5], [8, 10], t_end=1.0, table=path)
    blow_up_map([0.5, 0.7, 1.5], [8, 10], t_end=1.0, table=path, progress=False)
    blow_up_map([0.5], [8], executor=Inline(8, KeyboardInterrupt()), **QUICK)
    assert [bar.options for bar in bars] == [
        {"total": total, "unit": "cell", "disable": hidden} for total, hidden in ((4, None), (2, True), (1, True))
    ]
    assert [bar.steps for bar in bars] == [[2, 2], [1, 1], []]
    assert [bar.says for bar in bars] == [[], [], ["interrupted"]]


def test_a_column_marches_what_blows_up_once_more_from_the_seed(monkeypatch):
    asked = []

    def ensemble(toys, n, dt, t_end, record_every, seed):
        asked.append((toys, n, dt, t_end, seed))
        assert record_every > 1e8  # nothing but the end is wanted
        times = {0.1: 3.0, 0.2: 7.0, 0.3: 99.0}
        stops = [Stop.REACHED_END if toy.a == 0.3 else Stop.BLEW_UP for toy in toys]
        sooner = [times[toy.a] - (seed is not None) for toy in toys]
        return [SimpleNamespace(stop=stop, t_stop=t) for stop, t in zip(stops, sooner, strict=True)]

    monkeypatch.setattr(sweeping, "ftcs_ensemble", ensemble)
    found = sweep._column([0.1, 0.3, 0.2], 15, 0.02, 1e-3, 50.0, 1e-9)
    assert found == {(15, 1e-3, 0.1): (3, 2), (15, 1e-3, 0.3): (math.inf, math.inf), (15, 1e-3, 0.2): (7, 6)}
    toys = [Toy(a, 0.02) for a in (0.1, 0.3, 0.2)]
    assert asked == [(toys, 15, 1e-3, 50.0, None), ([toys[0], toys[2]], 15, 1e-3, 50.0, Seed(6, 1e-9))]
    asked.clear()
    assert sweep._column([0.3], 16, 0.02, 1e-3, 50.0, 1e-9) == {(16, 1e-3, 0.3): (math.inf, math.inf)}
    assert asked[1:] == []
    run = SimpleNamespace(stop=Stop.INTERRUPTED)
    monkeypatch.setattr(sweeping, "ftcs_ensemble", lambda *_, **__: [run])
    with pytest.raises(KeyboardInterrupt):
        sweep._column([0.1], 16, 0.02, 1e-3, 50.0, 1e-9)


def test_what_is_too_large_is_refused_before_anything_is_marched(monkeypatch):
    monkeypatch.setattr(sweep, "sweep", lambda *_, **__: 1 / 0)
    for n, members in ((10**7, 1), (10**6, 7)):  # 12 numbers for each of two fields: 16 bytes for each
        with pytest.raises(ValueError, match=rf"2 GiB, got {members} with 1 records, 0 snapshots and n = {n}$"):
            blow_up_map(np.arange(members) / 10, [n], t_end=0.0, progress=False)
    with pytest.raises(ZeroDivisionError):
        blow_up_map(np.arange(5) / 10, [10**6], t_end=0.0, progress=False)
    with pytest.raises(ZeroDivisionError):  # of a long run the end is all that is kept
        blow_up_map(np.arange(20_000) / 1e5, [8], t_end=1000.0, progress=False)
    with pytest.raises(ValueError, match=r"^t_end must be a finite number >= 0, got -0\.5$"):
        blow_up_map([0.5], [8], t_end=-0.5)
    with pytest.raises(ValueError, match=r"^dt must be a finite number > 0, got -0\.5$"):
        blow_up_map([0.5], [8], dt=-0.5)


SETTINGS = {"eps": 0.1, "t": 2.0}


def table(path):
    return Table(path, SETTINGS, ("n", "a"), ("t",))


def test_a_table_is_text_that_reads_back_to_the_last_bit(tmp_path):
    path = tmp_path / "t.csv"
    kept = table(path)
    assert not path.exists()
    kept.add({(8, 0.1): (math.inf,), (4, 1 / 3): (2 / 3,)})
    assert path.read_bytes() == (b"# eps=0.1 t=2.0\nn,a,t\n4.0,0.3333333333333333,0.6666666666666666\n8.0,0.1,inf\n")
    assert table(path).rows == kept.rows == {(8.0, 0.1): (math.inf,), (4.0, 1 / 3): (2 / 3,)}
    assert [each.name for each in tmp_path.iterdir()] == ["t.csv"]
    none = table(None)
    none.add({(1, 2): (3,)})
    assert none.rows == {(1.0, 2.0): (3.0,)}


@pytest.mark.parametrize(
    "text",
    [
        "", "# eps=0.1 t=2.0\n", "# eps=0.1 t=3.0\nn,a,t\n", "# eps=0.1 t=2.0\nn,a,s\n", "n,a,t\n1,2,3\n",
        "# eps=0.1 t=2.0\nn,a,t\n1,2\n", "# eps=0.1 t=2.0\nn,a,t\n1,2,3,4\n", "# eps=0.1 t=2.0\nn,a,t\n1,2,x\n",
        '# eps=0.1 t=2.0\nn,a,t\n1,2,"3"4\n', "\udcff",
    ],
)  # fmt: skip
def test_what_is_no_such_table_is_refused_in_one_sentence(tmp_path, text):
    path = tmp_path / "t.csv"
    path.write_bytes(text.encode(errors="surrogateescape"))
    with pytest.raises(ValueError, match=r"^table") as caught:
        table(path)
    sentence = f"table must be new or one of the same sweep (eps=0.1 t=2.0), undamaged, got {str(path)!r}"
    assert str(caught.value) == sentence
    assert path.read_bytes() == text.encode(errors="surrogateescape")


def test_where_no_table_can_be_kept_is_said_before_the_sweep(tmp_path):
    for wrong, shown in ((3, "3"), (b"x", "b'x'"), (SimpleNamespace(), "namespace()")):
        with pytest.raises(TypeError) as caught:
            table(wrong)
        assert str(caught.value) == f"table must be the path of a CSV file or None, got {shown}"

    class Bytes:
        def __fspath__(self):
            return b"x"

    os.PathLike.register(Bytes)
    with pytest.raises(TypeError, match=r"^table must be the path of a CSV file or None, got <"):
        table(Bytes())
    for wrong in ("", str(tmp_path), tmp_path):
        with pytest.raises(ValueError, match=r"^table") as caught:
            table(wrong)
        assert str(caught.value) == f"table must be the path of a CSV file, got the folder {str(wrong)!r}"
    with pytest.raises(ValueError, match=r"^table must be in a folder that can be written, got '.*none/t\.csv' \("):
        table(tmp_path / "none" / "t.csv")


def test_nothing_is_left_of_a_write_that_failed(tmp_path, monkeypatch):
    path = tmp_path / "t.csv"
    monkeypatch.setattr(os, "replace", lambda *_: (_ for _ in ()).throw(OSError(28, "full")))
    with pytest.raises(OSError, match="full") as caught:
        table(path).add({(4, 1): (2,)})
    assert str(caught.value) == (
        f"[Errno 28] full; the table is as it was, and the same call goes on from there: {str(path)!r}"
    )
    assert list(tmp_path.iterdir()) == []
    monkeypatch.setattr(os, "replace", lambda name, _: os.unlink(name) or (_ for _ in ()).throw(OSError("gone")))
    with pytest.raises(OSError, match="gone; the table is as it was"):
        table(path).add({(4, 1): (2,)})
