"""Guards the map of blow-ups: cells are single runs, and a sweep that is interrupted loses and repeats nothing."""

import math
import os
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest

from primer import Seed, Stop, Toy, blow_up_map, ftcs, stable_dt
from primer.study.maps import map_step
from primer.study.stability import OVERSHOOT
from primer.study.table import Table

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
    sweep = sys.modules["primer.study.maps"]
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
