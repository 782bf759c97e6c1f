"""Guards the compiled loops: what they watch they see at the very step, alone or in a block, as NumPy's loop does."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import primer.schemes.ftcs as scheme
from primer import BackwardHeat, Seed, Stop, Toy, ftcs, ftcs_ensemble

pytest.importorskip("numba")


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


@pytest.mark.parametrize("seed", range(40))
def test_a_look_promises_no_more_than_it_can_keep(seed):
    """While |v| <= ceiling a step moves u by at most 2 r1 dt ceiling, with rounding twice that; Dist <= |u| + |v|.

    So for as many steps as it is not looked again nothing can cross: not u = 0, not Dist = far. Nor does it look much
    more often than it must, or miss a record or a snapshot.
    """
    from primer.schemes import kernel

    look = getattr(kernel._look, "py_func", kernel._look)  # plain Python where the compiler is switched off
    random = np.random.default_rng(seed)
    n, step, every = 16, int(random.integers(1, 1000)), int(random.choice([7, 10**6]))
    far, dt, r1 = 10 ** random.uniform(0, 3), 10 ** random.uniform(-5, -1), 10 ** random.uniform(-1, 1.5)
    u_inf, u = random.normal(size=(2, n)) + random.uniform(-1, 3)
    v = random.normal(size=n) * far * 10 ** random.uniform(-6, 0)
    clock, shots = np.array([[0], [-1], [0], [0]]), np.zeros((3, 2, n, 1))
    shot_steps = np.array([step + 3, step + 10**8])
    records = np.zeros((2, 1000, 1)) if every == 7 else np.zeros((2, 1, 1))
    again, ceiling = look(u, v, u_inf, 0, r1, dt, far, 1e-6 * far, step, every, clock, *records, shot_steps, shots)
    dist = np.sqrt(((u - u_inf) ** 2 + v**2).max())
    assert clock[:, 0].tolist() == [step, -1 if u.min() > 0 else step, int(dist > far), 0]
    assert ceiling >= 2 * np.abs(v).max()
    quiet = again - step - 1  # steps that are not looked at
    moved = 2 * quiet * 2 * r1 * dt * ceiling
    assert step < again <= min(step + 3, (step // every + 1) * every)
    if quiet:
        assert u.min() <= 0 or moved <= u.min()
        assert np.abs(u - u_inf).max() + moved <= far / 2 * (1 + 1e-12)
        assert ceiling <= far / 2
    far_shots = np.array([step + 10**8])  # nothing asked for before: then it looks away as long as it can
    clock = np.array([[0], [-1], [0], [0]])
    again, _ = look(u, v, u_inf, 0, r1, dt, far, 1e-6 * far, step, 10**9, clock, *np.zeros((2, 1, 1)), far_shots, shots)
    room = min(far / 2 - np.abs(u - u_inf).max(), u.min() if u.min() > 0 else np.inf)
    moved = 2 * (again - step - 1) * 2 * r1 * dt * ceiling
    assert moved <= max(room, 0)
    if ceiling < far / 2 and room > 0 and again < step + 10**8:
        assert moved > 0.7 * room - 8 * r1 * dt * ceiling


def test_ctrl_c_in_the_compiled_loop_returns_what_was_recorded(monkeypatch):
    from primer.schemes import block

    monkeypatch.setattr(scheme, "_compiles", lambda problem, asked: True)
    march = block.Block.march

    def interrupted(self):
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


def test_without_a_folder_to_write_the_loop_is_compiled_all_the_same(monkeypatch):
    import numba

    from primer.compiled import jit

    njit = numba.njit

    def nowhere(*function, cache=False, **options):
        if cache:
            raise RuntimeError("cannot cache function: no locator available")  # numba's words
        return njit(*function, **options)

    monkeypatch.setattr(numba, "njit", nowhere)
    assert jit(lambda x: x + 1)(2) == 3


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


def test_a_look_takes_the_snapshots_of_its_step_and_no_others():
    from primer.schemes import kernel

    look = getattr(kernel._look, "py_func", kernel._look)
    u, v, u_inf, step, none = np.arange(1.0, 5), np.full(4, 0.1), np.zeros(4), 7, -np.ones((3, 2, 4, 1))
    for shot_steps, before, after in (([5, 7, 7], 1, 3), ([7, 7, 9], 0, 2), ([3, 4, 9], 2, 2), ([1, 2, 3], 3, 3)):
        clock, shots = np.array([[0], [-1], [0], [before]]), np.concatenate([none, none[:1]])
        records = np.zeros((2, 1, 1))
        again, _ = look(
            u, v, u_inf, 0, 1.0, 1e-9, 10.0, 1e-5, step, 10**6, clock, *records, np.array(shot_steps), shots
        )  # fmt: skip
        assert clock[:, 0].tolist() == [7, -1, 0, after]
        for place in range(4):
            taken = before <= place < after
            np.testing.assert_array_equal(shots[place, :, :, 0], [u, v] if taken else none[0, :, :, 0])
        assert again == (9 if 9 in shot_steps else 10**6)
    clock = np.array([[0], [-1], [0], [0]])
    look(u - 2, v, u_inf, 0, 1.0, 1e-9, 1.5, 1e-5, 6, 3, clock, *(many := np.zeros((2, 4, 1))), np.array([9]), shots)
    assert clock[:, 0].tolist() == [6, 6, 1, 0]  # u <= 0, and beyond 1.5
    np.testing.assert_allclose(many[:, :, 0], [[0, 0, 4.01, 0], [0, 0, -1, 0]])
    np.testing.assert_array_equal(shots[-1, :, :, 0], [u - 2, v])
