"""Guards the reference: its error against closed forms and an independent code, its error bar, and its refusals."""

import pickle

import numpy as np
import pytest
from taylor import PI, REAL, toy_by_taylor

import primer.schemes.reference as module
from primer import FOURIER, PastHorizon, Reference, Toy, reference
from primer.schemes import lines
from primer.schemes.fourier import interpolate

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
        (1.08, 0.01, 4, 1e-10, 32),  # u < 0 for a while
        (0.5, 0.1, 1.5, 1e-10, 48),  # ill posed, before the horizon
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
    ("a", "eps", "tol"), [(0.5, 0.01, 1e-10), (0.5, 0.01, 1e-6), (-1, 0.01, 1e-8), (0.9, 0.01, 1e-8)]
)
def test_an_ill_posed_case_is_answered_up_to_its_horizon_and_refused_beyond(a, eps, tol):
    toy = Toy(a, eps)
    with pytest.raises(PastHorizon, match="horizon") as refusal:
        reference(toy, [1, 1000], tol)
    horizon = refusal.value.horizon
    assert 1 < horizon < 1000
    t = np.array([0.3, 0.6, 1]) * horizon
    answer = reference(toy, t, tol)
    assert answer.horizon == horizon
    # 24 points in longdouble: the growth of round-off, e^{eps |u| k^2 t} with k = 12, leaves at least 12 digits.
    true = true_error(answer, toy_by_taylor(a, eps, t, n=24))
    assert (true <= answer.error).all()
    assert (answer.error <= tol).all()
    with pytest.raises(PastHorizon):
        reference(toy, 1.001 * horizon, tol)


def test_the_horizon_recedes_with_tolerance_and_approaches_with_ill_posedness():
    def horizon(a, eps, tol):
        return reference(Toy(a, eps), 0, tol).horizon

    assert horizon(0.5, 0.01, 1e-10) < horizon(0.5, 0.01, 1e-8) < horizon(0.5, 0.01, 1e-6)
    assert horizon(0.5, 0.1, 1e-10) < horizon(0.5, 0.01, 1e-10) < horizon(0.9, 0.01, 1e-10)
    assert horizon(-1e4, 1, 1e-8) < 1e-3
    assert reference(Toy(1.5, 0.01), [2, 7]).horizon == 7  # well posed: as far as it went


def test_the_search_for_the_horizon_ends_where_it_recedes_or_no_judge_is_left(monkeypatch):
    """A rung is judged by the next one, so that the last of them judges only."""
    last, far = len(module._POINTS) - 1, module._farthest.__wrapped__
    monkeypatch.setattr(module, "_holds", lambda toy, tol, until, rung: float(rung))
    assert far(Toy(0.5), 1e-10, 100.0) == (last - 1, last - 1.0)
    monkeypatch.setattr(module, "_holds", lambda toy, tol, until, rung: -abs(rung - 3.0) + 50)
    assert far(Toy(0.5), 1e-10, 100.0) == (3, 50.0)
    assert far(Toy(0.5), 1e-10, 49.0) == (2, 49.0)


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


def test_without_numba_the_answer_is_the_same_up_to_rounding(monkeypatch):
    toy, t = Toy(1.4, 0.03), [0.5, 4]
    compiled = reference(toy, t)
    monkeypatch.setattr(lines, "compiled", lambda module: None)
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
