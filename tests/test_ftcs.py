"""Guards the scheme: its bits, its orders, the paper's three runs, what a run records, and how it ends."""

import math
import os
import signal
import subprocess
import sys
import time
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm
from transcription import dist, march

import primer
import primer.schemes.ftcs as scheme
from primer import PDE, BackwardHeat, Run, Seed, Stop, Toy, ftcs, march_lines
from primer.compiled import _compiler, able
from primer.schemes import record
from primer.schemes.block import tally
from primer.schemes.discrete import dist_floor
from primer.schemes.grid import Grid
from primer.schemes.record import plan


@pytest.fixture(params=["compiled", "interpreted"])
def path(request, monkeypatch):
    """Both time loops: the compiled one, and NumPy's as where llvmlite cannot be imported."""
    compiled = request.param == "compiled"
    if compiled:
        pytest.importorskip("llvmlite")
    monkeypatch.setattr(scheme, "_compiles", lambda problem, asked: compiled)
    return request.param


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize(("a", "eps", "n", "dt"), [(0.5, 0.01, 100, 1e-3), (1.5, 0.0, 7, 0.02), (-2.0, 0.3, 4, 0.01)])
def test_bits_are_those_of_the_plain_transcription(path, dtype, a, eps, n, dt):
    steps, every = 301, 7
    run = ftcs(Toy(a, eps), n, dt, steps * dt, every, snapshots=(100 * dt,), dtype=dtype)
    states = list(march(a, eps, n, dt, steps, dtype))
    np.testing.assert_array_equal(run.final, states[-1])
    np.testing.assert_array_equal(run.snapshots[100 * dt], states[100])
    x = run.x.astype(dtype)
    at = [*range(0, steps, every), steps]
    np.testing.assert_array_equal(run.u_min, [states[k][0].min() for k in at])
    np.testing.assert_array_equal(run.dist, [dist(*states[k], dtype(a), x) for k in at])
    np.testing.assert_array_equal(run.t, np.array(at) * dt)
    assert run.final[0].dtype == dtype


def test_bits_of_longdouble():
    run = ftcs(Toy(0.5), 20, 1e-2, 0.5, dtype=np.longdouble)
    *_, last = march(0.5, 0.01, 20, 1e-2, 50, np.longdouble)
    np.testing.assert_array_equal(run.final, last)


def test_thirty_digits_agree_with_longdouble_to_its_precision():
    fine = ftcs(Toy(0.5), 16, 1e-2, 1.0, digits=30)
    coarse = ftcs(Toy(0.5), 16, 1e-2, 1.0, dtype=np.longdouble)
    assert fine.final[0].dtype == object
    difference = np.abs(np.array(fine.final) - np.array(coarse.final)).astype(float).max()
    assert 0 < difference < 100 * np.finfo(np.longdouble).eps
    np.testing.assert_allclose(fine.dist.astype(float), coarse.dist.astype(float), rtol=1e-15)


@pytest.mark.slow
def test_more_digits_blow_up_later():
    """Seeded by round-off, the blow-up waits ln(10)/2.727 for each decimal digit (growth: physics.md, section 1)."""
    kinds = [{"dtype": np.float32}, {"dtype": np.float64}, {"dtype": np.longdouble}, {"digits": 30}]
    runs = [ftcs(Toy(0.5), 100, 4e-3, 40, **kind) for kind in kinds]
    times = [run.t_stop for run in runs]
    assert all(run.stop is Stop.BLEW_UP for run in runs)
    assert times == sorted(set(times))
    assert 13 < times[1] < 15.5
    digits = 30 - math.log10(1 / np.finfo(float).eps)
    assert times[3] - times[1] == pytest.approx(digits * math.log(10) / 2.727232, rel=0.15)


def test_both_loops_give_the_same_blow_up(monkeypatch):
    pytest.importorskip("llvmlite")
    runs = []
    for fast in (True, False):
        monkeypatch.setattr(scheme, "_compiles", lambda problem, asked, fast=fast: fast)
        runs.append(ftcs(Toy(0.5), n=200, dt=1e-3, t_end=10, snapshots=(1.0, 9.0), seed=(40, 1e-6, "v")))
    first, second = runs
    assert first.stop is second.stop is Stop.BLEW_UP
    assert (first.t_stop, first.t_first_negative) == (second.t_stop, second.t_first_negative)
    np.testing.assert_array_equal(first.dist, second.dist)
    np.testing.assert_array_equal(first.final, second.final)
    assert set(first.snapshots) == set(second.snapshots) == {1.0}  # the run did not live to t = 9


def test_figure_4_comes_to_rest_on_the_floor():
    run = ftcs(Toy(1.5))
    assert run.stop is Stop.REACHED_END
    assert run.t_stop == run.t[-1] == pytest.approx(100)
    assert run.t.size == 1001
    assert run.dist[-1] == pytest.approx(6.582768e-4, rel=5e-7)
    assert run.dist[-1] == pytest.approx(dist_floor(100), rel=1e-9)
    assert run.t_first_negative is None
    assert run.u_min.min() > 0


def test_figure_5_decays_then_blows_up():
    run = ftcs(Toy(0.5), record_every=10, snapshots=(12.5, 50.0))
    assert run.stop is Stop.BLEW_UP
    assert 12 < run.t_stop < 16
    assert run.t_first_negative == pytest.approx(0.8252, abs=0.01)
    assert run.dist[run.t < 8].min() < 0.02 < run.dist[0]
    assert run.dist[-1] > run.blow_up_at >= run.dist[-2]
    assert np.isfinite(run.dist).all()
    assert set(run.snapshots) == {12.5}


def test_figure_6_hides_it():
    run = ftcs(Toy(0.5), n=30)
    assert run.stop is Stop.REACHED_END
    assert run.dist[-1] == pytest.approx(7.348406e-3, rel=5e-7)
    assert run.u_min[-1] == pytest.approx(0.5 - 1 - dist_floor(30), rel=1e-9)


def test_second_order_in_space():
    """Against the exact solution for eps = 0, with a step so small that its error is 1e-5 of the total."""
    toy, t_end = Toy(0.5, eps=0), 2.0
    errors = []
    for n in (20, 40, 80):
        run = ftcs(toy, n, 1e-5, t_end)
        errors.append(np.abs(np.array(run.final) - toy.exact(run.x, t_end)).max())
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2, atol=0.1)


def test_first_order_in_time():
    """Against the exact solution of the semi-discrete equations: one mode, a 2 x 2 matrix exponential."""
    toy, n, t_end = Toy(0.5, eps=0), 20, 2.0
    h = 2 * math.pi / n
    s = math.sin(h) / h
    # u = a + U cos x, v = V sin x:  U' = s V,  V' = -s U - V - 1
    generator = np.array([[0, s, 0], [-s, -1, -1], [0, 0, 0]])
    U, V, _ = expm(generator * t_end) @ [0, -0.5, 1]
    errors = []
    for dt in (4e-3, 2e-3, 1e-3):
        run = ftcs(toy, n, dt, t_end)
        exact = toy.a + U * np.cos(run.x), V * np.sin(run.x)
        errors.append(np.abs(np.array(run.final) - exact).max())
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 1, atol=0.1)


def test_backward_heat_follows_its_mode_until_the_grid_takes_over():
    run = ftcs(BackwardHeat(), 32, 1e-3, 0.2)
    assert run.dist[-1] == pytest.approx(math.exp(0.2), rel=1e-3)
    late = ftcs(BackwardHeat(), 32, 1e-3, 5)
    assert late.stop is Stop.BLEW_UP
    assert late.t_stop < 1


def test_seed_is_what_it_says():
    x = ftcs(Toy(1.5), t_end=0.0).x
    plain, seeded = (ftcs(Toy(1.5), t_end=0.0, seed=s).final for s in (None, Seed(3, 1e-4, "v", phase=0.0)))
    np.testing.assert_array_equal(plain[0], seeded[0])
    np.testing.assert_allclose(seeded[1] - plain[1], 1e-4 * np.cos(3 * x), atol=1e-16)
    np.testing.assert_allclose(Seed(3, 2.0)(x), math.sqrt(2) * (np.cos(3 * x) + np.sin(3 * x)), atol=1e-14)
    tuple_form = ftcs(Toy(1.5), t_end=0.0, seed=(3, 1e-4, "v", 0.0))
    np.testing.assert_array_equal(tuple_form.final, seeded)
    assert tuple_form.seed == Seed(3, 1e-4, "v", 0.0)


def test_a_seed_makes_the_blow_up_sooner_and_reproducible():
    times = [ftcs(Toy(0.5), seed=Seed(49, s)).t_stop for s in (1e-6, 1.001e-6, 1e-9)]
    assert times[0] == pytest.approx(times[1], abs=2e-3)
    # Three decades more to grow through, at the rate 2.727 of the grid's fastest mode (physics.md, section 1).
    assert times[2] - times[0] == pytest.approx(math.log(1e3) / 2.727232, rel=0.1)


@pytest.mark.parametrize(("a", "t"), [(0.0, 0.0), (-1.0, 0.0), (2.5, None)])
def test_first_touch_counts_the_initial_data(path, a, t):
    assert ftcs(Toy(a), 16, 1e-2, 1.0).t_first_negative == t


def test_a_u_of_exactly_zero_counts_as_touched(path):
    n, dt = 16, 1e-2
    grid = Grid(n)
    (_, v) = Toy(1.0).initial(grid.x)
    a = -(dt * grid.derivative(v, 1)).min()  # the first step takes u there to a - a
    run = ftcs(Toy(a), n, dt, 5 * dt, 1)
    assert run.u_min[1] == 0
    assert run.t_first_negative == dt


def test_a_dist_equal_to_the_limit_is_not_beyond_it(path):
    a, n, dt = -2.0, 8, 1e-2
    x, dist2 = Grid(n).x, []
    for u, v in march(a, 0.2, n, dt, 1000):
        dist2.append(((u - (a - np.cos(x))) ** 2 + v**2).max())
        if dist2[-1] > 1e4:
            break
    limit = np.sqrt(dist2)
    exact = [k for k in range(1, len(limit) - 1) if limit[k] ** 2 == dist2[k] > max(dist2[:k])]
    assert len(exact) > 20
    for k in exact[:: len(exact) // 10]:
        run = ftcs(Toy(a, 0.2), n, dt, 10.0, blow_up_at=limit[k])
        later = next(m for m in range(k + 1, len(limit)) if dist2[m] > dist2[k])
        assert (run.stop, run.t_stop) == (Stop.BLEW_UP, later * dt)


def test_records_and_snapshots_lie_where_asked():
    run = ftcs(Toy(1.5), 16, 0.03, 1.0, record_every=10, snapshots=[1.0, 0.0, 0.5, 0.5])
    assert run.t_stop == 33 * 0.03  # whole steps: round(t_end/dt)
    np.testing.assert_allclose(run.t, [0.0, 0.3, 0.6, 0.9, 0.99])
    assert list(run.snapshots) == [0.0, 0.5, 1.0]
    np.testing.assert_array_equal(run.snapshots[0.0], Toy(1.5).initial(run.x))
    np.testing.assert_array_equal(run.snapshots[1.0], run.final)
    *_, at_half = march(1.5, 0.01, 16, 0.03, 17)
    np.testing.assert_array_equal(run.snapshots[0.5], at_half)
    assert [f.shape for f in run.snapshots[0.5]] == [(16,), (16,)]


def test_a_run_cannot_be_changed():
    run = ftcs(Toy(1.5), 8, 0.01, 0.1, snapshots=(0.1,))
    assert isinstance(run, Run)
    with pytest.raises(AttributeError):
        run.t_stop = 3
    for array in (run.x, run.t, run.dist, run.u_min, *run.final, *run.snapshots[0.1]):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    with pytest.raises(TypeError):
        run.snapshots[0.2] = ()


def test_memory_is_that_of_the_records_not_of_the_steps(path):
    steps = 200_000 if path == "compiled" else 4000
    ftcs(Toy(1.5), 50, 1e-3, 1.0)  # whatever is loaded once
    peaks = []
    for factor in (1, 4):
        tracemalloc.start()
        ftcs(Toy(1.5), 50, 1e-3, factor * steps // 4 * 1e-3, record_every=steps)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert max(peaks) < 100_000  # four times the steps: 2 x 50 x 8 bytes each would be megabytes
    assert peaks[1] < peaks[0] + 20_000


class Interrupting(Toy):
    """A toy system during whose 40th step someone presses Ctrl-C."""

    calls = 0

    def rhs(self, *arguments):
        Interrupting.calls += 1
        if Interrupting.calls == 40:
            raise KeyboardInterrupt
        return super().rhs(*arguments)


def test_ctrl_c_returns_what_was_recorded():
    run = ftcs(Interrupting(1.5), 16, 0.01, 10, record_every=10)
    assert run.stop is Stop.INTERRUPTED
    np.testing.assert_allclose(run.t, [0, 0.1, 0.2, 0.3, 0.39])
    assert run.t_stop == pytest.approx(0.39)
    np.testing.assert_array_equal(run.final, list(march(1.5, 0.01, 16, 0.01, 39))[-1])


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="sends a POSIX signal")
def test_ctrl_c_stops_the_compiled_loop(ctrl_c):
    code = (
        "from primer import Toy, ftcs; from primer.schemes.block import Block; ftcs(Toy(1.5), t_end=10);"
        "march = Block.march; Block.march = lambda *all: (print('go', flush=True), march(*all));"
        "run = ftcs(Toy(1.5), t_end=1e6, record_every=100_000); print(run.stop.name, run.t.size, run.t_stop < 1e6)"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "go\n"
        time.sleep(0.5)  # the run would take minutes; whether it has begun by then or not, it ends the same
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate()
    finally:
        process.kill()
    assert out.split()[::2] == ["INTERRUPTED", "True"]


def test_without_a_compiler_it_is_said_once(monkeypatch):
    monkeypatch.setitem(sys.modules, "llvmlite.binding", None)  # importing it now raises ImportError
    monkeypatch.setattr(scheme, "_SOON", 0)
    able.cache_clear()
    _compiler.cache_clear()
    try:
        with pytest.warns(RuntimeWarning, match="llvmlite is not here .*the same, but slower"):
            run = ftcs(Toy(1.5), 100, 1e-3, 0.02)
        ftcs(Toy(1.5), 100, 1e-3, 0.02)  # silent: a warning here would be an error
    finally:
        able.cache_clear()
    *_, last = march(1.5, 0.01, 100, 1e-3, 20)
    np.testing.assert_array_equal(run.final, last)


@pytest.mark.parametrize("problem", [OSError, SystemError, AttributeError, RuntimeError, TypeError, ImportError])
def test_a_compiler_that_fails_to_load_in_any_way_is_said_once(problem, monkeypatch):
    """llvmlite without its library is an OSError, and other faults may be anything."""
    attempts = []

    def broken():
        attempts.append(problem)
        raise problem(f"could not load {len(attempts)}\nand more")

    monkeypatch.setattr("primer.compiled._compiler", broken)
    monkeypatch.setattr(scheme, "started", lambda: True)
    monkeypatch.setattr(scheme, "_SOON", 0)  # so that a short run asks for it, too
    able.cache_clear()
    try:
        with pytest.warns(RuntimeWarning, match="llvmlite is not here .*could not load 1 and more.*slower") as said:
            run = ftcs(Toy(1.5), 100, 1e-3, 0.02)
        assert [one.filename for one in said] == [__file__]
        ftcs(Toy(1.5), 100, 1e-3, 0.02)  # silent: a warning here would be an error
        lines = march_lines(Toy(1.5), 16, 1e-3, 0.02).final
    finally:
        able.cache_clear()
    monkeypatch.undo()
    np.testing.assert_array_equal(run.final, list(march(1.5, 0.01, 100, 1e-3, 20))[-1])
    np.testing.assert_array_equal(lines, march_lines(Toy(1.5), 16, 1e-3, 0.02).final)


@pytest.mark.slow
@pytest.mark.parametrize("problem", ["OSError('libllvmlite.so')", "SystemError('_internal')", "AttributeError('long')"])
def test_a_broken_compiler_costs_a_new_process_only_time(problem, tmp_path):
    (tmp_path / "llvmlite.py").write_text(f"raise {problem}\n")
    code = "from primer import Toy, ftcs, march_lines; print(ftcs(Toy(1.5), t_end=5).dist[-1].hex());"
    code += "march_lines(Toy(1.5), 16, 1e-3, 0.1)"
    env = {**os.environ, "PYTHONPATH": f"{tmp_path}{os.pathsep}{Path(primer.__file__).parents[1]}"}
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=env, timeout=120)
    assert found.stdout == f"{ftcs(Toy(1.5), t_end=5).dist[-1].hex()}\n", found.stderr
    assert found.stderr.count("RuntimeWarning: llvmlite is not here") == 1
    assert "Traceback" not in found.stderr


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_data_too_large_for_the_numbers_are_an_outcome(dtype):
    for problem, seed in ((BackwardHeat(1, 1e300), None), (Toy(1.5), (1, 1e300)), (Toy(1e300), None)):
        run = ftcs(problem, 16, 1e-2, 1.0, seed=seed, dtype=dtype)
        assert run.stop is Stop.BLEW_UP
        assert run.t_stop <= 0.01


def test_fewer_records_than_steps_may_be_asked_for(path):
    assert ftcs(Toy(1.5), 8, 1e-2, 1.0, record_every=10**30).t.tolist() == [0.0, 1.0]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_hopeless_parameters_still_end_in_an_outcome(path, dtype):
    """Steps far beyond any stability limit: the first or second state is no number any more, without a warning."""
    for problem in (Toy(0.5, 1e30), Toy(-1e12, 1.0), Toy(1.5, 10.0), Toy(1e300), Toy(0.5, 1e300)):
        run = ftcs(problem, 64, 10.0, 1000.0, dtype=dtype)
        assert run.stop is Stop.BLEW_UP
        assert run.t_stop <= 200


def test_a_clock_counts_whole_steps_up_to_two_to_the_53():
    """The last whole number before which doubles count every one."""

    def steps(t_end):
        return plan(4, 1.0, t_end, None, (), None, 1e3, np.float64, None).steps

    assert steps(2.0**53 - 1) == 2**53 - 1
    with pytest.raises(ValueError, match="dt must be more than"):
        steps(2.0**53)


@pytest.mark.parametrize(
    ("options", "error", "sentence"),
    [
        ({"n": 3}, ValueError, "n must be an integer >= 4, got 3"),
        ({"n": 10.0}, TypeError, "n must be an integer >= 4, got 10.0 (float)"),
        ({"n": True}, TypeError, "n must be an integer >= 4, got True (bool)"),
        ({"n": 10**9}, ValueError, "n must be an integer <= 1e+07 to fit into memory, got 1000000000"),
        ({"dt": 0}, ValueError, "dt must be a finite number > 0, got 0"),
        ({"dt": -1e-3}, ValueError, "dt must be a finite number > 0, got -0.001"),
        ({"dt": math.nan}, ValueError, "dt must be a finite number > 0, got nan"),
        ({"dt": "1"}, TypeError, "dt must be a finite number > 0, got '1' (str)"),
        ({"dt": 1e-300}, ValueError, "dt must be more than t_end/2^53, got 1e-300"),
        ({"t_end": -1}, ValueError, "t_end must be a finite number >= 0, got -1"),
        ({"t_end": math.inf}, ValueError, "t_end must be a finite number >= 0, got inf"),
        ({"t_end": None}, TypeError, "t_end must be a finite number >= 0, got None (NoneType)"),
        ({"record_every": 0}, ValueError, "record_every must be an integer >= 1, got 0"),
        ({"record_every": 0.1}, TypeError, "record_every must be an integer >= 1, got 0.1 (float)"),
        (
            {"t_end": 1e9, "record_every": 1},
            ValueError,
            "record_every, snapshots and n must let all runs fit into 2 GiB",
        ),
        ({"t_end": 1.0, "snapshots": (1.5,)}, ValueError, "snapshots must be a finite number >= 0 and <= 1, got 1.5"),
        ({"snapshots": (-0.1,)}, ValueError, "snapshots must be a finite number >= 0 and <= 100, got -0.1"),
        ({"snapshots": 2.0}, TypeError, "snapshots must be a sequence of times, got 2.0"),
        ({"snapshots": "12"}, TypeError, "snapshots must be a sequence of times, got '12'"),
        ({"seed": 1e-6}, TypeError, "seed must be a Seed, or its (mode, amplitude, field) as a tuple, or None"),
        ({"seed": (1, 1e-6, "w")}, ValueError, "seed field must be one of u, v, got 'w'"),
        ({"seed": (51, 1e-6, "u")}, ValueError, "seed mode must be an integer <= 50, got 51"),
        ({"seed": (1, math.nan, "u")}, ValueError, "seed amplitude must be a finite number, got nan"),
        ({"blow_up_at": 0}, ValueError, "blow_up_at must be a finite number > 0 and <= 1.34078e+154, got 0"),
        ({"dtype": "float16"}, ValueError, "dtype must be float32, float64 or longdouble"),
        ({"dtype": "nonsense"}, ValueError, "dtype must be float32, float64 or longdouble"),
        ({"dt": 1e-60, "t_end": 1e-50}, ValueError, "dt must be >= 1.2e-38, got 1e-60"),
        ({"seed": (1,)}, TypeError, "seed must be a Seed, or its (mode, amplitude, field) as a tuple, or None"),
        (
            {"problem": Toy},
            TypeError,
            "problem must be a PDE, a Toy, a BackwardHeat or an object with their methods, got <cl",
        ),
        ({"digits": 1}, ValueError, "digits must be an integer >= 2 and <= 10000, got 1"),
        (
            {"problem": 3},
            TypeError,
            "problem must be a PDE, a Toy, a BackwardHeat or an object with their methods, got 3",
        ),
    ],
)
def test_bad_input_gets_one_sentence(options, error, sentence):
    with pytest.raises(error) as caught:
        ftcs(options.pop("problem", Toy(1.5)), **options)
    assert str(caught.value).startswith(sentence)
    assert "\n" not in str(caught.value)


def a_plan(n=16, dt=0.01, t_end=1.0, record_every=None, snapshots=(), seed=None, blow_up_at=1e3, **numbers):
    return plan(
        n, dt, t_end, record_every, snapshots, seed, blow_up_at, **{"dtype": np.float64, "digits": None, **numbers}
    )


def test_which_runs_are_for_the_compiled_loop(monkeypatch):
    """Problems of a text in machine numbers, once the steps of that text so far would have paid for the compiler."""
    monkeypatch.setattr(scheme, "able", lambda: True)
    monkeypatch.setattr(scheme, "started", lambda: False)
    tally.cache_clear()
    long, short = a_plan(dt=1.0, t_end=scheme._LATER + 1.0), a_plan(dt=1.0, t_end=scheme._LATER / 2)
    assert scheme._compiles(PDE("u_t = 2*u_x", {"u": "sin(x)"}), long)
    assert [scheme._compiles(Toy(1.5), short) for _ in range(4)] == [False, False, True, True]
    assert not scheme._compiles(BackwardHeat(), short)
    monkeypatch.setattr(scheme, "started", lambda: True)
    assert scheme._compiles(BackwardHeat(), short)
    assert scheme._compiles(Toy(1.5), a_plan(dtype=np.float32))
    assert not scheme._compiles(Toy(1.5), a_plan(dtype=np.longdouble))
    assert not scheme._compiles(Toy(1.5), a_plan(digits=20))
    assert not scheme._compiles(Interrupting(1.5), long)
    monkeypatch.setattr(scheme, "able", lambda: False)
    assert not scheme._compiles(Toy(1.5), long)


def test_a_plan_in_whole_steps():
    asked = a_plan(t_end=1.004, snapshots=[0.5, 0.0, 1.004, 0.5, 0.014], record_every=10)
    assert (asked.steps, asked.every, asked.times) == (100, 10, (0.0, 0.014, 0.5, 1.004))
    assert asked.shot_steps.tolist() == [0, 1, 50, 100]
    assert a_plan(t_end=100.0).every == 10
    assert a_plan(t_end=19.99).every == 1
    assert a_plan(t_end=20.0).every == 2
    assert a_plan(t_end=0.0).every == 1
    assert a_plan(record_every=101).every == a_plan(record_every=10**9).every == 101
    assert a_plan(record_every=100).every == 100
    assert a_plan(seed=(8, 1.0)).seed == Seed(8, 1.0, "u", -math.pi / 4)
    assert a_plan(seed=(3, 1.0, "v", 0.5)).seed == Seed(3, 1.0, "v", 0.5)
    assert a_plan(blow_up_at=np.finfo(float).max ** 0.5).blow_up_at == np.finfo(float).max ** 0.5
    for seed in ((9, 1.0), Seed(9, 1.0)):
        with pytest.raises(ValueError, match=r"^seed mode must be an integer <= 8, got 9$"):
            a_plan(seed=seed)
    for seed in ((), (1,), (1, 1.0, "u", 0.0, 0.0), 3, "u"):
        with pytest.raises(
            TypeError, match=r"^seed must be a Seed, or its .mode, amplitude, field. as a tuple, or None, got"
        ):
            a_plan(seed=seed)
    least = float(np.finfo(np.float32).tiny)
    assert a_plan(dt=least, t_end=least).steps == 1
    with pytest.raises(ValueError, match=r"^dt must be >= 1.2e-38, got "):
        a_plan(dt=least / 2, t_end=least)
    with pytest.raises(TypeError, match="snapshots must be a sequence of times, got 3"):
        a_plan(snapshots=3)


def test_a_seed_says_what_is_wrong_with_it():
    assert Seed(0, 1.0)(0.0) == pytest.approx(math.sqrt(0.5))
    for arguments, error, said in (
        ((-1, 1.0), ValueError, "seed mode must be an integer >= 0, got -1"),
        ((1, np.inf), ValueError, "seed amplitude must be a finite number, got inf"),
        ((1, 1.0, "u", np.nan), ValueError, "seed phase must be a finite number, got nan"),
        ((1, 1.0, 3), TypeError, "seed field must be the name of a field, such as 'u', got 3"),
    ):
        with pytest.raises(error) as caught:
            Seed(*arguments)
        assert str(caught.value) == said


def test_what_a_run_keeps_is_counted_before_it_starts(monkeypatch):
    """Three numbers a record, and (snapshots + 12) states, of 16 bytes each or as many as the digits take."""
    for numbers, size in (
        ({}, 16),
        ({"digits": 30}, 128 - int(math.log2(10.0**-30) - 1)),
        ({"digits": 9999}, 128 - int(math.log2(1e-300))),
    ):
        for members in (1, 3):
            asked = a_plan(t_end=1.0, record_every=10, snapshots=(0.1, 0.5), **numbers)
            if numbers.get("digits") == 30:
                size = 128 - int(math.log2(asked.numbers.epsilon))
            kept = size * members * (3 * 11 + (2 + 12) * 2 * 16)
            monkeypatch.setattr(record, "MAX_BYTES", kept)
            asked.refuse_if_large(2, members)
            monkeypatch.setattr(record, "MAX_BYTES", kept - 1)
            with pytest.raises(ValueError, match="record_every") as error:
                asked.refuse_if_large(2, members)
            assert str(error.value) == (
                "record_every, snapshots and n must let all runs fit into 0 GiB, "
                f"got {members} with 11 records, 2 snapshots and n = 16"
            )
    monkeypatch.setattr(record, "MAX_BYTES", 16 * (3 * 11 + 12 * 2 * 16))
    a_plan(record_every=10).refuse_if_large(2)  # one member, unless said otherwise
    monkeypatch.undo()
    with pytest.raises(ValueError, match="fit into 2 GiB, got 1 with"):
        a_plan(n=10**7).refuse_if_large(2)


def test_ten_million_million_points_times_steps_are_the_most():
    a_plan(10**6, 1.0, 1e7, 10**6).refuse_if_large(2)
    with pytest.raises(ValueError, match="dt, t_end") as error:
        a_plan(10**6, 1.0, 1e7 + 1, 10**6).refuse_if_large(2)
    assert str(error.value) == (
        "dt, t_end and n must be such that n t_end/dt <= 1e+13 (more takes too long), "
        "got dt = 1, 10000001 steps and n = 1000000"
    )


def test_a_log_keeps_what_it_is_shown_and_ends_with_the_last_state():
    toy, asked = Toy(0.5), a_plan(n=4, dt=0.5, t_end=3.0, record_every=4, snapshots=(0.0, 1.5), blow_up_at=10.0)
    h, x, state, log = asked.start(toy)
    assert (h, log.running, log.limit) == (2 * math.pi / 4, True, 100.0)
    np.testing.assert_array_equal(x, Grid(4).x)
    np.testing.assert_array_equal(state, toy.initial(x))
    assert log.clock.tolist() == [0, -1, 0, 1]
    steady = np.array(toy.steady(x))

    def off(du, dv):
        return steady + np.array([[du], [dv]])

    for step, (du, dv) in enumerate(((3.0, 4.0), (0.25, 0.0), (0.0, 2.0)), start=1):
        log.watch(step, off(du, dv))
        assert log.measure(off(du, dv)) == pytest.approx((du * du + dv * dv, steady[0].min() + du))
    assert log.clock.tolist() == [3, 2, 0, 2]  # the second of them touched zero: 0.5 - 1 + 0.25 < 0
    run = log.run(toy, off(0.0, 2.0), False)
    np.testing.assert_allclose(run.t, [0, 1.5])
    assert run.dist[1] == 2
    assert (run.t_first_negative, run.t_stop, run.stop, run.blow_up_at) == (1.0, 1.5, Stop.REACHED_END, 10.0)
    assert list(run.snapshots) == [0.0, 1.5]
    assert log.run(toy, state, True).stop is Stop.INTERRUPTED
    log.watch(4, off(11.0, 0.0))
    assert not log.running
    assert log.run(toy, state, True).stop is Stop.BLEW_UP
    np.testing.assert_array_equal(log.run(toy, state, False).dist, [1.0, 11.0])


def test_a_run_is_shown_without_its_arrays():
    run = ftcs(Toy(1.5), 8, 0.5, 1.0, seed=(1, 0.0))
    assert repr(run) == (
        f"Run(problem={Toy(1.5)!r}, n=8, dt=0.5, t_first_negative=None, stop={Stop.REACHED_END!r}, t_stop=1.0, "
        f"seed={Seed(1, 0.0)!r}, blow_up_at=1000.0)"
    )
