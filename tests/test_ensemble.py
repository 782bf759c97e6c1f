"""Guards the compiled loops: what they watch they see at the very step, alone or in a block, as NumPy's loop does."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import primer.schemes.ftcs as scheme
from primer import BackwardHeat, Seed, Stop, Toy, ftcs, ftcs_ensemble

pytest.importorskip("llvmlite")


def assert_same_run(one, other):
    assert one.problem == other.problem
    assert (one.stop, one.t_stop, one.t_first_negative) == (other.stop, other.t_stop, other.t_first_negative)
    for name in ("x", "t", "dist", "u_min", "final"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)
    assert list(one.snapshots) == list(other.snapshots)
    for time in one.snapshots:
        np.testing.assert_array_equal(one.snapshots[time], other.snapshots[time])


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("count", [1, 7, 8, 19])
def test_each_member_is_its_single_run_to_the_bit(dtype, count):
    """Well posed, ill posed, and blown up at different times, in full and in part-filled blocks."""
    problems = [Toy(a, eps) for a, eps in zip(np.linspace(-1.5, 2, count), np.linspace(0.05, 0, count), strict=True)]
    options = {"n": 60, "dt": 2e-3, "t_end": 5.0, "record_every": 7, "snapshots": (0.0, 0.5, 4.999), "dtype": dtype}
    runs = ftcs_ensemble(problems, **options)
    for problem, run in zip(problems, runs, strict=True):
        assert_same_run(run, ftcs(problem, **options))
    if count > 1:
        assert {run.stop for run in runs} == {Stop.BLEW_UP, Stop.REACHED_END}


@settings(max_examples=60, deadline=None)
@given(
    a=st.floats(-2, 2),
    eps=st.sampled_from([0.0, 0.01, 0.3]),
    n=st.integers(4, 70),
    dt=st.floats(1e-3, 0.2),
    every=st.integers(1, 400),
    blow_up_at=st.sampled_from([0.7, 1.01, 3.0, 1e3, 1e9]),
    seed=st.sampled_from([None, Seed(1, 0.5), Seed(2, 1e-3, "v")]),
)
def test_compiled_and_interpreted_loops_see_the_same_steps(a, eps, n, dt, every, blow_up_at, seed):
    """The compiled loop looks only when something may have happened; it must never be late by a step."""
    runs = []
    for compiled in (True, False):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(scheme, "_compiles", lambda problem, asked, c=compiled: c)
            runs.append(
                ftcs(Toy(a, eps), n, dt, 400 * dt, every, (0.0, 150 * dt, 151 * dt, 400 * dt), seed, blow_up_at)
            )
    assert_same_run(*runs)


def test_a_look_ahead_is_not_late(monkeypatch):
    """v starts from rest and accelerates u: min u falls like t^2, the worst case for a look ahead."""
    runs = []
    for fast in (True, False):
        monkeypatch.setattr(scheme, "_compiles", lambda problem, asked, fast=fast: fast)
        runs.append(ftcs(Toy(0.3, 0), 4, 1e-3, 2.0, 10_000, seed=Seed(1, 0.5, "v", -np.pi / 2)))
    assert_same_run(*runs)
    assert runs[0].t_first_negative > 0


def test_ctrl_c_in_the_compiled_loop_returns_what_was_recorded(monkeypatch):
    from primer.schemes import block

    monkeypatch.setattr(scheme, "_compiles", lambda problem, asked: True)
    march = block.Block.march

    def interrupted(self, *tell):
        march(self)
        self.clock[0] -= 3  # as if it had been stopped before the end
        raise KeyboardInterrupt

    monkeypatch.setattr(block.Block, "march", interrupted)
    run = ftcs(Toy(1.5), 16, 1e-2, 1.0, 10)
    assert (run.stop, run.t_stop) == (Stop.INTERRUPTED, 0.97)
    assert len(run.t) == 11


def test_other_problems_and_numbers_are_marched_one_by_one():
    heat, toy = ftcs_ensemble([BackwardHeat(), Toy(1.5)], 16, 1e-3, 0.1)
    assert_same_run(heat, ftcs(BackwardHeat(), 16, 1e-3, 0.1))
    assert_same_run(toy, ftcs(Toy(1.5), 16, 1e-3, 0.1))
    (fine,) = ftcs_ensemble([Toy(1.5)], 8, 1e-2, 0.1, digits=30)
    assert fine.final[0].dtype == object
    assert ftcs_ensemble([]) == ()


def test_an_interrupted_ensemble_keeps_what_it_has(monkeypatch):
    from primer.schemes import block

    marched = []
    march = block.Block.march

    def first_only(self):
        marched.append(self)
        if len(marched) > 1:
            raise KeyboardInterrupt
        march(self)

    monkeypatch.setattr(block.Block, "march", first_only)
    monkeypatch.setattr("os.cpu_count", lambda: 1)
    runs = ftcs_ensemble([Toy(1.5)] * 16, 16, 1e-2, 1.0)
    assert [run.stop for run in runs] == [Stop.REACHED_END] * 8 + [Stop.INTERRUPTED] * 8
    assert runs[-1].t.tolist() == [0.0]


@pytest.mark.parametrize(
    ("problems", "options", "error", "sentence"),
    [
        (3, {}, TypeError, "problems must be a sequence of problems, got 3"),
        (
            [Toy(1.5), 3],
            {},
            TypeError,
            "problems must be a PDE, a Toy, a BackwardHeat or an object with their methods",
        ),
        ([Toy(1.5)], {"n": 3}, ValueError, "n must be an integer >= 4, got 3"),
        ([Toy(1.5)] * 50_000, {"record_every": 1}, ValueError, "record_every, snapshots and n must let "),
    ],
)
def test_bad_input_gets_one_sentence(problems, options, error, sentence):
    with pytest.raises(error) as caught:
        ftcs_ensemble(problems, **options)
    assert str(caught.value).startswith(sentence)


def test_a_block_that_is_halted_stands_still_and_its_runs_are_interrupted():
    from primer.schemes.block import Block
    from primer.schemes.record import plan

    asked = plan(16, 0.01, 1.0, 10, (0.0, 0.5), None, 1e3, np.float64, None)
    block = Block(asked, [Toy(1.5), Toy(0.5)], 8)
    block.halted = True
    block.march()
    runs = list(block.runs(interrupted=True))
    assert [(run.problem, run.stop, run.t.tolist()) for run in runs] == [
        (Toy(1.5), Stop.INTERRUPTED, [0.0]),
        (Toy(0.5), Stop.INTERRUPTED, [0.0]),
    ]
    for run in runs:
        np.testing.assert_array_equal(run.final, run.problem.initial(run.x))
        assert list(run.snapshots) == [0.0]
    block.halted = False
    block.march()
    assert_same_run(list(block.runs())[1], ftcs(Toy(0.5), 16, 0.01, 1.0, 10, (0.0, 0.5)))
