"""Guards the reference: its error against closed forms and an independent code, its error bar, and its refusals."""

import pickle
import re

import numpy as np
import pytest
from taylor import PI, REAL, toy_by_taylor

import primer.schemes.reference as module
from primer import FOURIER, RK8, PastHorizon, Reference, Toy, reference
from primer.schemes import lines
from primer.schemes.fourier import interpolate, transfer
from primer.schemes.positive import certain, least

needs_longdouble = pytest.mark.skipif(np.finfo(REAL).eps > 1e-18, reason="longdouble is no longer than double here")


def true_error(answer, truth):
    """The largest error of u and v at each time; truth (m, 2, n') on a grid of its own."""
    return np.abs(np.stack([answer.u, answer.v], axis=1) - interpolate(truth.astype(float), answer.x)).max(axis=(1, 2))


@pytest.mark.parametrize("a", [1.5, 0.5, -3, 40.0])
def test_without_diffusion_it_is_the_exact_solution(a):
    toy, t = Toy(a, 0), np.array([0, 0.3, 1, 5, 30])
    answer = reference(toy, t, tol=1e-11)
    error = np.abs(np.array(toy.exact(answer.x, t[:, None])) - [answer.u, answer.v]).max(axis=(0, 2))
    assert (error <= answer.error).all()
    assert (answer.error <= 1e-11).all()
    off_grid = np.array([-4.0, 0.1, 2.5])
    assert np.abs(np.array(toy.exact(off_grid, t[:, None])) - answer.at(off_grid)).max() <= 2e-11


def test_asked_for_all_it_can_give_it_gives_near_machine_precision():
    toy = Toy(1.5, 0)
    answer = reference(toy, 5, tol=1.1e-13)
    assert np.abs(np.array(toy.exact(answer.x, 5)) - [answer.u[0], answer.v[0]]).max() < 3e-14


def _check_estimates(cases):
    ratios = []
    for a, eps, t in cases:
        answer = reference(Toy(a, eps), t)
        (true,) = true_error(answer, toy_by_taylor(a, eps, [t], n=48))
        assert true <= answer.error[0] <= 1e-10, (a, eps, t)
        ratios.append(answer.error[0] / true)
    assert np.quantile(ratios, 0.9) <= 100


def _random_cases(count):
    rng = np.random.default_rng(20170504)
    return [(rng.uniform(1.2, 3), rng.uniform(0, 0.1), rng.uniform(0, 30)) for _ in range(count)]


@pytest.mark.slow
@needs_longdouble
def test_the_estimate_covers_the_error_and_not_much_more():
    _check_estimates(_random_cases(8))


@needs_longdouble
@pytest.mark.slow
def test_the_estimate_covers_the_error_in_two_hundred_cases():
    _check_estimates(_random_cases(200))


@needs_longdouble
@pytest.mark.parametrize(
    ("a", "eps", "t", "tol", "n"),
    [
        (1.3, 0.6, 1.5, 1e-8, 48),  # strong diffusion: a slowly decaying spectrum
        (100.0, 0.1, 0.5, 1e-11, 16),  # stiff, and a large u
        (1.08, 0.01, 2.0, 1e-10, 32),  # u is about to touch 0
        (0.5, 0.1, 0.83, 1e-10, 48),
        (1.5, 0.01, 5, 1e-3, 32),  # a loose tolerance
        (1.5, 0.01, 5, 2e-13, 32),  # a tight one
    ],
)
def test_hard_cases(a, eps, t, tol, n):
    answer = reference(Toy(a, eps), [t / 2, t], tol)
    true = true_error(answer, toy_by_taylor(a, eps, [t / 2, t], n))
    assert (true <= answer.error).all()
    assert (answer.error <= tol).all()


def test_times_may_come_in_any_order_and_more_than_once():
    toy = Toy(1.5, 0.05)
    answer = reference(toy, [3, 0, 1, 3])
    assert isinstance(answer, Reference)
    assert answer.u.shape == answer.v.shape == (4, answer.x.size)
    assert (answer.t == [3, 0, 1, 3]).all()
    assert (answer.u[0] == answer.u[3]).all()
    assert (np.array([answer.u[1], answer.v[1]]) == toy.initial(answer.x)).all()
    single = reference(toy, 3)
    assert single.u.shape == (1, single.x.size)
    assert np.abs(single.at(0.3)[0] - answer.at(0.3)[0][0]) <= single.error + answer.error[0]


def test_two_times_may_come_in_either_order():
    there, back = reference(Toy(1.5), [1.0, 2.0]), reference(Toy(1.5), [2.0, 1.0])
    np.testing.assert_array_equal(there.u, back.u[::-1])
    np.testing.assert_array_equal(back.t, [2.0, 1.0])


def test_values_between_the_points_are_those_of_the_interpolant():
    answer = reference(Toy(1.5, 0.05), [1, 2])
    assert np.abs(answer.at(answer.x)[1] - answer.v).max() < 1e-14
    u, v = answer.at(np.zeros((3, 2)))
    assert u.shape == v.shape == (2, 3, 2)
    rng = np.random.default_rng(1)
    for n in (8, 9):
        f, x = rng.normal(size=n), rng.uniform(-4, 4, 5)
        k = np.arange(-(n // 2), n - n // 2)
        grid = -np.pi + 2 * np.pi / n * np.arange(n)
        waves = np.exp(1j * np.outer(k, x)).T @ (np.exp(-1j * np.outer(k, grid)) @ f) / n
        if n % 2 == 0:  # the sawtooth is a cosine about the first point
            waves += 1j * np.sin(n / 2 * (x + np.pi)) * (f @ (-1.0) ** np.arange(n)) / n
        assert np.abs(interpolate(f, x) - waves).max() < 1e-14


@needs_longdouble
@pytest.mark.parametrize(
    ("a", "eps", "tol"), [(0.5, 0.01, 1e-10), (0.5, 0.1, 1e-6), (0.2, 0.01, 1e-8), (0.9, 0.3, 1e-8), (1.1, 0.01, 1e-9)]
)
def test_the_horizon_is_the_first_u_equal_to_0_and_past_it_there_is_no_answer(a, eps, tol):
    toy = Toy(a, eps)
    with pytest.raises(PastHorizon, match="u first touches 0, where the equations become ill posed") as refusal:
        reference(toy, [0.1, 5.0], tol)
    horizon = reference(toy, 0.1, tol).horizon
    # u is even about x = 0, where it is least on the way down, and 48 points have x = 0 among them.
    there, soon = toy_by_taylor(a, eps, [horizon, horizon + 3e-7], n=48)[:, 0].min(axis=1)
    assert 0 <= there < 3e-8
    assert soon < 0
    assert 0 <= horizon - refusal.value.horizon < 1e-5 * horizon  # what is printed is rounded down
    t = np.array([0.3, 0.6, 1]) * horizon
    answer = reference(toy, t, tol)
    true = true_error(answer, toy_by_taylor(a, eps, t, n=32))
    assert (true <= answer.error).all()
    assert (answer.error <= tol).all()
    with pytest.raises(PastHorizon):
        reference(toy, horizon + 1e-9, tol)


def test_what_two_coarse_grids_agree_on_is_not_certified():
    """To t = 5 they agree to 1e-12; the scheme without round-off is lost at t = 4.97 on 400 points, 3.54 on 600."""
    for a in (0.5, 0.9):
        ends = [lines.march_lines(Toy(a), n, 0.02, 5.0, FOURIER, RK8) for n in (16, 24)]
        assert np.abs(ends[1].final[0] - interpolate(ends[0].final[0], ends[1].x)).max() < 1e-9
        with pytest.raises(PastHorizon):
            reference(Toy(a), 5.0)


def test_at_eps_0_the_first_u_equal_to_0_is_no_end():
    answer = reference(Toy(0.5, 0), [0.825, 50.0], 1e-12)
    assert answer.horizon == 50
    first = reference(Toy(0.5, 1e-13), 0.5).horizon
    assert first == pytest.approx(0.825153642138549, abs=2e-12)


@pytest.mark.parametrize("a", [0.0, -1.0, -1e4])
def test_where_u_is_not_positive_at_first_there_are_the_data_and_no_more(a):
    toy = Toy(a, 0.5)
    answer = reference(toy, [0.0, 0.0], 1e-6)
    assert answer.horizon == 0
    assert (answer.u == a).all()
    with pytest.raises(PastHorizon, match=r"^t must be <= 0.0, the horizon") as refusal:
        reference(toy, 1e-9, 1e-6)
    assert refusal.value.horizon == 0


def test_the_horizon_comes_later_for_a_larger_a_and_not_at_all_from_1_191_on():
    def horizon(a, eps=0.01):
        return reference(Toy(a, eps), 0.01).horizon

    assert 0 < horizon(0.01) < horizon(0.5) < horizon(0.9) < horizon(1.05) < horizon(1.18)
    assert reference(Toy(1.1911, 1e-9), 20.0).horizon == 20  # the deepest u is a - 1.19103
    assert horizon(1.19102, 1e-9) == pytest.approx(3.0230, abs=0.02)
    assert reference(Toy(1.5, 0.01), [2, 7]).horizon == 7  # well posed: as far as it went


def test_a_horizon_that_is_printed_is_accepted():
    rng = np.random.default_rng(5)
    for _ in range(25):
        toy, tol = Toy(rng.uniform(0, 1.15), 10 ** rng.uniform(-4, -0.5)), 10 ** rng.uniform(-10, -3)
        with pytest.raises(PastHorizon) as refusal:
            reference(toy, 20.0, tol)
        printed = float(re.match(r"t must be <= (\S+), the horizon", str(refusal.value)).group(1))
        assert printed == refusal.value.horizon > 0
        assert reference(toy, printed, tol).error <= tol


@pytest.mark.parametrize(("depth", "found"), [(-1e-9, True), (1e-9, False), (-0.3, True), (1e-4, False), (1.0, False)])
@pytest.mark.parametrize("speed", [1.0, 7.0, 40.0])
def test_a_dip_between_the_samples_is_not_missed(depth, found, speed):
    def margin(t):
        return depth + 1 - np.cos(speed * (t - 3.0471))

    until = 3.0471 + 2 / speed
    end = certain(margin, until)
    if not found:
        assert end == until
    else:  # the first of several dips
        period = 2 * np.pi / speed
        first = (3.0471 - np.arccos(1 + depth) / speed) % period
        assert end == pytest.approx(first, abs=1e-10) or (end == 0 and margin(np.array([0.0]))[0] <= 0)


def test_the_least_value_of_an_interpolant_lies_between_its_points():
    rng = np.random.default_rng(3)
    for n in (8, 9, 16):
        f = rng.normal(size=(5, n))
        x = np.linspace(-np.pi, np.pi, 200001)
        assert np.abs(least(f) - interpolate(f, x).min(axis=1)).max() < 1e-8
        assert (least(f) <= f.min(axis=1)).all()


@pytest.mark.parametrize(("tol", "n"), [(1e-6, 8), (1e-7, 8), (1e-8, 16), (1e-12, 16)])
def test_the_first_points_tried_go_with_the_tolerance(tol, n):
    """At eps = 0 one wave is all there is, and the fewest points tried hold it."""
    assert reference(Toy(1.5, 0), 1.0, tol).x.size == n


def test_an_answer_is_shown_without_its_arrays():
    answer = reference(Toy(1.5), 1.0)
    assert repr(answer) == f"Reference(toy={answer.toy!r}, tol=1e-10, horizon=1.0)"


def test_a_refusal_survives_pickling():
    with pytest.raises(PastHorizon) as refusal:
        reference(Toy(-1), 50)
    again = pickle.loads(pickle.dumps(refusal.value))
    assert (again.horizon, str(again)) == (refusal.value.horizon, str(refusal.value))


def test_without_a_compiler_the_answer_is_the_same_up_to_rounding(monkeypatch):
    toy, t = Toy(1.4, 0.03), [0.5, 4]
    compiled = reference(toy, t)
    monkeypatch.setattr(lines, "able", lambda: False)
    plain = reference(toy, t)
    assert np.abs(compiled.u - plain.u).max() < 2e-14
    assert np.abs(compiled.v - plain.v).max() < 2e-14
    with pytest.raises(PastHorizon):
        reference(Toy(0.45, 0.2), 50, tol=1e-6)


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ((1.5, 1), TypeError, "toy must be a Toy"),
        ((Toy(1.5), -1), ValueError, "t must be a time >= 0"),
        ((Toy(1.5), []), (TypeError, ValueError), "t must be"),
        ((Toy(1.5), [[1, 2]]), ValueError, "t must be a time >= 0"),
        ((Toy(1.5), float("nan")), ValueError, "t must be finite"),
        ((Toy(1.5), "soon"), TypeError, "t must be a number"),
        ((Toy(1.5), 1, 1e-15), ValueError, "tol must be >= .* double precision"),
        ((Toy(1e6), 1, 1e-10), ValueError, "tol must be >= .* double precision"),
        ((Toy(1.5), 1, 0), ValueError, "tol must be"),
        ((Toy(1.5), 1, 2), ValueError, "tol must be"),
        ((Toy(1e9, 1), 1, 1e-2), ValueError, "steps"),
    ],
)
def test_bad_input_is_named(arguments, error, words):
    with pytest.raises(error, match=words):
        reference(*arguments)


@pytest.mark.parametrize("n", [4, 5, 16, 33, 129, 130, 131])
@pytest.mark.parametrize("m", [1, 2])
def test_fourier_derivatives_three_ways(n, m):
    grid = -np.pi + 2 * np.pi / n * np.arange(n)
    f = np.random.default_rng(n).normal(size=(3, n))
    by_transform = FOURIER[m](f, 2 * np.pi / n)
    # derivatives of the waves, at the grid's points, of which the sawtooth keeps only the even one
    k = np.arange(n // 2 + 1)
    symbol = (1j * k) ** m * ((2 * k != n) | (m == 2))
    share = np.where((k == 0) | (2 * k == n), 1, 2) / n
    by_sum = f @ (share * symbol * np.exp(1j * k * (grid[None, :, None] - grid[:, None, None]))).sum(axis=-1).real
    assert np.abs(by_transform - by_sum).max() < 1e-15 * n**3
    assert np.abs(f @ FOURIER[m].matrix(n) - by_sum).max() < 1e-15 * n**3
    xi = np.arange(-(n // 2) + 1, n // 2)
    waves = np.exp(1j * xi[:, None] * grid)
    derivative = FOURIER[m](waves.real, 2 * np.pi / n) + 1j * FOURIER[m](waves.imag, 2 * np.pi / n)
    assert np.abs(derivative - FOURIER[m].multiplier(xi, 2 * np.pi / n)[:, None] * waves).max() < 1e-15 * n**3


@pytest.mark.parametrize("times", [[1e9], [0.1, 1e9]])
def test_a_time_that_would_take_for_ever_is_refused(times):
    with pytest.raises(ValueError, match="10000000 steps"):
        reference(Toy(1.5), times)


def test_pi_of_the_independent_code():
    assert float(PI) == np.pi


def test_the_least_tolerance_is_four_times_the_round_off():
    """128 units in the last place of |a| + 2."""
    for toy in (Toy(1.5, 0), Toy(-7.0, 0)):
        least = 128 * np.finfo(float).eps * (abs(toy.a) + 2)
        assert reference(toy, 0.0, least).tol == least
        below = float(np.nextafter(least, 0))
        with pytest.raises(ValueError, match="tol must be >=") as error:
            reference(toy, 0.0, below)
        said = f"tol must be >= {least:.1e} for a = {toy.a:g} in double precision, got {below!r}"
        assert str(error.value) == said


def test_up_to_a_hundred_thousand_times_may_be_asked_for():
    assert module._times(np.ones(10**5)).size == 10**5
    with pytest.raises(ValueError, match=r"^t must be at most 100000 times, got 100001$"):
        module._times(np.ones(10**5 + 1))
    given = np.array([1, 2])
    assert module._times(given).dtype == float
    floats = np.array([1.0, 2.0])
    assert module._times(floats) is not floats  # they are frozen in the answer
    with pytest.raises(ValueError, match=r"sequence of them, got array\(\[ ?0., -1.\]\)$"):
        module._times([0.0, -1.0])


def fake_attempt(tried, holds_until):
    """In place of a march: an error within the tolerance up to a time that depends on the rung."""

    def attempt(toy, times, tol, rung, progress=False):
        tried.append((rung, tol))
        error = np.where(times <= holds_until(rung), 1e-300, 0.5)
        return np.zeros((times.size, 2, module._POINTS[rung])), error, False

    return attempt


def test_points_are_added_until_no_judge_is_left(monkeypatch):
    """Each rung is allowed a quarter of the last one's error in time. The horizon is the best that was seen."""
    tried = []
    monkeypatch.setattr(module, "_attempt", fake_attempt(tried, lambda rung: {1: 1.0, 2: 3.0}.get(rung, 2.0)))
    with pytest.raises(PastHorizon) as refusal:
        reference(Toy(1.5), [1.0, 2.0, 3.0, 4.0])
    assert refusal.value.horizon == 3.0
    assert str(refusal.value) == (
        f"t must be <= 3.0, the horizon of {Toy(1.5)} at tol = 1e-10, got 4: there the spectrum is too long for 128 "
        "points"
    )
    rungs = range(1, len(module._POINTS) - 1)
    assert tried[: len(rungs)] == [(rung, 1e-10 / 4 ** (rung - 1)) for rung in rungs]
    assert [rung for rung, _ in tried[len(rungs) :]] == [1, 2]  # and what is printed is accepted
    tried.clear()
    with pytest.raises(PastHorizon) as refusal:
        reference(Toy(1.5), [5.0], 1e-6)
    assert refusal.value.horizon == 0.0
    assert [rung for rung, _ in tried] == list(range(len(module._POINTS) - 1))
    tried.clear()
    found = reference(Toy(1.5), [2.5, 1.0])
    assert [rung for rung, _ in tried] == [1, 2]
    assert (found.horizon, found.x.size, found.t.tolist()) == (2.5, module._POINTS[2], [2.5, 1.0])


def test_how_many_times_from_the_first_on_are_good():
    for errors, good in (([0.1, 0.1], 2), ([0.1, 0.3], 1), ([0.3, 0.1], 0), ([0.1, np.nan, 0.1], 1), ([0.2, 0.1], 2)):
        assert module._good(np.array(errors), 0.2) == good


@pytest.mark.parametrize(("a", "eps"), [(1.5, 0.05), (0.9, 0.02)])
def test_an_attempt_is_what_it_says(a, eps):
    """Its steps, its error estimate of two marches and round-off, as the docstring of reference."""
    toy, times, tol, rung = Toy(a, eps), np.array([0.5, 0.75, 4.0]), 1e-9, 1
    states, error, below = module._attempt(toy, times, tol, rung)
    n, finer = 16, 24
    assert module._POINTS[rung : rung + 2] == (n, finer)
    for points in (n, finer):
        stable = lines.stable_step(toy, points, FOURIER, RK8)
        assert module._step(toy, tol, points) == pytest.approx(min(stable, 0.4 * 10 ** (1 / 8)), rel=1e-14)
    gaps = np.array([0.5, 0.25, 3.25])
    few = np.ceil(gaps / module._step(toy, tol, n)).astype(int)
    many = np.maximum(np.ceil(1.3 * few), np.ceil(gaps / module._step(toy, tol, finer))).astype(int)
    ours, _ = lines.trace(toy, n, FOURIER, RK8, gaps / few, few)
    judge, deep = lines.trace(toy, finer, FOURIER, RK8, gaps / many, many)
    np.testing.assert_array_equal(states, ours)
    x = -np.pi + 2 * np.pi / finer * np.arange(finer)
    apart = np.abs(interpolate(states, x) - judge).max(axis=(1, 2))
    np.testing.assert_allclose(error, 2 * apart + 32 * np.finfo(float).eps * (a + 2), rtol=1e-4)
    assert below == (deep[-1] > 0) == (a < 1)


def test_more_than_ten_million_steps_are_refused():
    toy = Toy(1.5)
    step = module._step(toy, 1e-10, 24)
    with pytest.raises(ValueError, match="t must be <=") as error:
        module._attempt(toy, np.array([1.0, 1.0001e7 * step]), 1e-10, 1)
    said = f"t must be <= {1e7 * step:.3g}, 10000000 steps for {toy}, got {1.0001e7 * step:g}"
    assert str(error.value) == said


@pytest.mark.parametrize("m", [1, 2])
def test_a_constant_has_no_derivative_whatever_its_size(m):
    for n in (16, 129):
        np.testing.assert_array_equal(FOURIER[m](np.full((2, n), 1e17), 2 * np.pi / n), np.zeros((2, n)))


def test_the_matrix_between_two_grids_is_the_interpolant():
    for n, points in ((8, 16), (16, 24), (7, 9), (16, 8)):
        f = np.random.default_rng(n).normal(size=(3, n))
        matrix = transfer(n, points)
        assert matrix.shape == (n, points)
        grid = -np.pi + 2 * np.pi / points * np.arange(points)
        np.testing.assert_allclose(f @ matrix, interpolate(f, grid), atol=1e-14)
        assert not matrix.flags.writeable
        assert not FOURIER[1].matrix(n).flags.writeable
