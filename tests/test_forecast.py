"""Guards the forecast behind ``diagnose``: its strides, its two marches and its last word, each by the plain thing."""

import math

import numpy as np
import pytest

from primer import Seed, Stop, Toy, ftcs
from primer.schemes.discrete import discrete_steady
from primer.schemes.grid import Grid
from primer.study.forecast import _NOISE, _SEED, _SMOOTH, Forecast, _Smooth, _stride, _Waves, forecast
from primer.study.leap import Half
from primer.study.spectrum import Parity, fastest, jacobian, rate
from primer.study.stability import frozen_dt

NOTHING = 1e-200  # an arithmetic so fine that round-off plays no part
SIZES = [4, 5, 16, 31]


def whole(halves, fields, row):
    """The full-grid perturbation of one origin: the sum of its two symmetric parts."""
    return sum(half.full(field[row]) for half, field in zip(halves, fields, strict=True))


def waves_of(toy, n, seed=None, epsilon=NOTHING, row=None, full=None):
    """``_Waves``, with a full-grid perturbation in place of one row, and of all noise."""
    waves = _Waves(toy, n, seed, epsilon)
    if row is not None:
        waves.fields = [np.zeros_like(field) for field in waves.fields]
        for half, field in zip(waves.halves, waves.fields, strict=True):
            field[row] = half.part(full)
    return waves


# Strides


@pytest.mark.parametrize(
    ("eps", "u", "h", "dt", "steps"),
    [
        (0.01, [0.5, 1.0], 0.2, 2.0**-10, 51),  # a twentieth of the solution's time
        (2.0**-6, [-1.0, 1.0], 2.0**-4, 2.0**-10, 20),  # the sawtooth grows at 15: 0.3/15
        (0.0, [1.0, 2.0], 2.0**-4, 2.0**-8, 12),  # at the limit h^2 no wave grows yet
        (0.0, [1.0, 2.0], 2.0**-4, 2.0**-7, 4),  # beyond it they do, and turn in a time h
        (2.0**-6, [-0.1, 1.0], 2.0**-5, 2.0**-10, 16),  # so they do where u is so negative that g < -1: h/2
        (2.0**-6, [1.0, 64.0], 2.0**-4, 2.0**-9, 1),  # the stiffest mode is at the limit: step by step
        (2.0**-6, [1.0, 64.0], 2.0**-4, 2.0**-10, 51),  # at half of that it is not
        (2.0**-6, [-1 / 16, 1.0], 2.0**-4, 2.0**-10, 51),  # g = -1: nothing grows yet, and nothing is divided by
        (0.01, [-2.0, -1.0], 0.2, 0.5, 1),  # never less than one
    ],
)
def test_a_stride_is_the_longest_that_each_limit_allows(eps, u, h, dt, steps):
    assert _stride(eps, np.array(u), h, dt) == steps


# The smooth solution


@pytest.mark.parametrize("n", SIZES)
def test_single_strides_of_the_smooth_solution_are_the_scheme(n):
    toy, dt = Toy(0.7, 0.05), 0.01
    smooth = _Smooth(toy, n)
    for steps in (1, 30):
        for _ in range(steps - (steps > 1)):
            solve = smooth.half.factored(toy.eps, smooth.u, smooth.v_xx, 0.0)
            smooth.advance(solve, dt)
        run = ftcs(toy, n, dt, steps * dt)
        np.testing.assert_allclose(smooth.half.full(np.stack((smooth.u, smooth.v))), run.final, atol=1e-10)
        steady = np.array(discrete_steady(toy, run.x, run.x[1] - run.x[0]))
        assert smooth.away() == pytest.approx(np.abs(run.final - steady).max(), abs=1e-10)


def test_krasny_s_filter_puts_harmonics_below_a_trillionth_to_zero():
    """Of amplitude 2e-12: |rfft| of cos kx is half the number of points."""
    smooth, x = _Smooth(Toy(2.0), 16), Grid(16).x[:9]
    smooth.u = 2 - np.cos(x) + 1.9e-12 * np.cos(3 * x) + 2.1e-12 * np.cos(4 * x)
    smooth.v = 1.9e-12 * np.sin(2 * x) + 2.1e-12 * np.sin(5 * x)
    smooth.advance(lambda f: f, 0.0)
    np.testing.assert_allclose(smooth.u - (2 - np.cos(x)), 2.1e-12 * np.cos(4 * x), rtol=0, atol=3e-15)
    np.testing.assert_allclose(smooth.v, 2.1e-12 * np.sin(5 * x), rtol=0, atol=1e-15)


@pytest.mark.parametrize("n", SIZES)
def test_the_smooth_solution_settles_on_the_steady_state_and_stands_still(n):
    smooth = _Smooth(Toy(1.5), n)
    before, steady = np.stack((smooth.u, smooth.v)), np.array(discrete_steady(Toy(1.5), Grid(n).x, Grid(n).h))
    assert smooth.still is False
    np.testing.assert_allclose(smooth.settle(), before - steady[:, : n // 2 + 1], atol=1e-15)
    assert smooth.still is True
    assert smooth.away() == 0
    smooth.advance(None, 1.0)
    np.testing.assert_allclose((smooth.u, smooth.v), steady[:, : n // 2 + 1], atol=1e-15)
    np.testing.assert_allclose(smooth.u_x, np.sin(Grid(n).x[: n // 2 + 1]), atol=1e-14)  # (h/sin h) D1 cos x = -sin x
    np.testing.assert_array_equal((smooth.v_x, smooth.v_xx), 0)


# The perturbations


@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("amplitude", [3e-7, -3e-7])
def test_the_stated_seed_is_the_first_of_the_perturbations(n, amplitude):
    """Its size is in the logarithm, its sign is nobody's business."""
    for field in ("u", "v"):
        seed = Seed(2, amplitude, field, phase=0.3)
        waves = _Waves(Toy(0.5), n, seed, 1e-16)
        expected = np.zeros((2, n))
        expected["uv".index(field)] = seed(Grid(n).x) * np.sign(amplitude)
        found = whole(waves.halves, waves.fields, _SEED) * math.exp(waves.logs[_SEED])
        np.testing.assert_allclose(found, expected, atol=1e-20)
        np.testing.assert_array_equal(whole(waves.halves, waves.fields, _SMOOTH), 0)
        assert waves.logs[_SMOOTH] == 0


def test_no_seed_and_a_seed_of_nothing_are_the_same():
    for seed in (None, Seed(2, 0.0)):
        waves = _Waves(Toy(0.5), 8, seed, 1e-16)
        np.testing.assert_array_equal(whole(waves.halves, waves.fields, _SEED), 0)
        assert waves.logs[_SEED] == 0
        assert waves.largest() == _NOISE


def test_round_off_is_a_fifth_of_the_last_place_a_step():
    """Standard deviations over many points: of u and of v, in proportion to their sizes and the root of the steps."""
    n, epsilon = 20001, 1e-9
    waves = _Waves(Toy(-3.0), n, None, epsilon)
    before = whole(waves.halves, waves.fields, _NOISE) * math.exp(waves.logs[_NOISE])
    np.testing.assert_allclose(before.std(axis=1) / epsilon, [0.2 * 3, 0.2 / 2], rtol=0.03)
    assert abs(np.corrcoef(before)[0, 1]) < 0.03
    waves.round_off(np.array([5.0, 0.7]), 400, 30 * epsilon)
    after = whole(waves.halves, waves.fields, _NOISE) * math.exp(waves.logs[_NOISE])
    np.testing.assert_allclose(
        (after - before).std(axis=1) / epsilon, [30 * 0.2 * 20 * 5, 30 * 0.2 * 20 * 0.7], rtol=0.03
    )
    np.testing.assert_array_equal(whole(waves.halves, waves.fields, _SEED), 0)


@pytest.mark.parametrize("n", SIZES)
def test_single_strides_of_the_perturbations_are_steps_of_the_linearised_scheme(n):
    """Of a seed and of what the smooth solution had left to go, beside noise at the level of u and v."""
    toy, dt, epsilon = Toy(0.7, 0.05), 0.01, 1e-13
    smooth = _Smooth(toy, n)
    for _ in range(20):  # so that v_xx and the slopes are something
        smooth.advance(lambda f: f, dt)
    state = smooth.half.full(np.stack((smooth.u, smooth.v)))
    J = jacobian(toy, n, state)
    f = np.random.default_rng(n).normal(size=(2, n))
    waves = _Waves(toy, n, None, epsilon)
    for half, field in zip(waves.halves, waves.fields, strict=True):
        field[_SEED], field[_SMOOTH] = half.part(f), -2 * half.part(f)
        field[_NOISE] = 0
    waves.advance(smooth, 1, [half.factored(toy.eps, smooth.u, smooth.v_xx, 0.0) for half in waves.halves], dt)
    expected = (f.ravel() + dt * J @ f.ravel()).reshape(2, n)
    np.testing.assert_allclose(whole(waves.halves, waves.fields, _SEED), expected, atol=1e-12)
    np.testing.assert_allclose(whole(waves.halves, waves.fields, _SMOOTH), -2 * expected, atol=1e-12)
    noise = whole(waves.halves, waves.fields, _NOISE)
    level = np.abs(state).max(axis=1)
    assert (np.abs(noise).max(axis=1) > 0).all()
    assert (np.abs(noise).max(axis=1) < 5 * 0.2 * level).all()


def test_the_noise_of_a_stride_is_that_of_its_steps_at_the_level_of_u_and_v():
    n, toy = 5001, Toy(3.0)
    smooth, waves = _Smooth(toy, n), _Waves(toy, n, None, 1e-10)
    for field in waves.fields:
        field[:] = 0
    waves.advance(smooth, 100, 2 * [lambda f: f], 0.0)
    np.testing.assert_allclose(
        whole(waves.halves, waves.fields, _NOISE).std(axis=1), [0.2 * 10 * 3.0, 0.2 * 10 * 0.5], rtol=0.05
    )


@pytest.mark.parametrize("half", [0, 1])
def test_what_has_grown_large_is_scaled_and_its_size_kept_in_the_logarithm(half):
    toy, n = Toy(0.5), 16
    smooth, waves = _Smooth(toy, n), _Waves(toy, n, None, NOTHING)
    for field in waves.fields:
        field[:] = 0
    waves.fields[half][_SEED, 1, 3] = -3e6
    waves.fields[1 - half][_SEED, 0, 2] = 6e5
    waves.fields[half][_SMOOTH, 0, 2] = 9e5
    waves.logs[:] = -7.0, -400.0, -8.0
    waves.advance(smooth, 1, 2 * [lambda f: f], 0.0)
    assert waves.logs[_SEED] == pytest.approx(-7 + math.log(3e6), rel=1e-14)
    assert waves.logs[_SMOOTH] == -8
    assert waves.fields[half][_SEED, 1, 3] == -1
    assert waves.fields[1 - half][_SEED, 0, 2] == 0.2
    assert waves.fields[half][_SMOOTH, 0, 2] == 9e5


def test_sizes_add_up_field_by_field_and_the_largest_in_u_is_the_cause():
    waves = waves_of(Toy(0.5), 16, row=_SEED, full=np.zeros((2, 16)))
    waves.logs[:] = math.log(1e-3), math.log(1e-2), 0.0
    waves.fields[0][_SEED, 0, 1], waves.fields[1][_SEED, 0, 4] = -5, 2  # 5e-3 of u
    waves.fields[1][_NOISE, 0, 3], waves.fields[0][_NOISE, 1, 3] = 0.2, 7  # 2e-3 of u, 7e-2 of v
    waves.fields[1][_SMOOTH, 1, 3] = 0.1
    np.testing.assert_allclose(np.exp(waves.log_sizes()), [7e-3, 0.17], rtol=1e-12)
    assert waves.largest() == _SEED
    waves.fields[1][_NOISE, 0, 3] = 0.6
    assert waves.largest() == _NOISE
    waves.fields[1][_SMOOTH, 0, 3] = -0.01
    assert waves.largest() == _SMOOTH


# The last word


OPPOSITE, DATA, SLOW = (Toy(0.5), 100), (Toy(-1.0, 0.1), 13), (Toy(0.5), 66)


@pytest.mark.parametrize(("toy", "n"), [OPPOSITE, DATA, SLOW])
@pytest.mark.parametrize("row", [_SEED, _SMOOTH])
def test_the_time_left_is_that_of_exponential_growth_to_one(toy, n, row):
    """Or to the root of the growth rate, if that is less: the square of the size then counts against it."""
    dt, mode = 1e-3, fastest(toy, n, 1e-3)
    growth = math.log(abs(1 + dt * mode.lam)) / dt
    amplitude = 3e-7 * np.exp(0.7j) if mode.lam.imag else 3e-7
    waves = waves_of(toy, n, row=row, full=np.real(amplitude * np.stack((mode.u, mode.v))))
    waves.logs[row] = math.log(1e-3)
    size = 3e-10 * np.abs(mode.u).max() * (1 if mode.lam.imag else 2)
    left, cause = waves.outlook(mode, dt, 0.0, locks=False)
    assert cause == row
    assert left == pytest.approx(math.log(min(1.0, math.sqrt(growth)) / size) / growth, rel=1e-9)
    waves.logs[row] = math.log(1e9)
    assert waves.outlook(mode, dt, 0.0, locks=False) == (0.0, row)


def test_parities_of_the_modes_looked_at():
    assert fastest(*OPPOSITE, 1e-3).parity is Parity.OPPOSITE
    assert fastest(*DATA, 1e-3).parity is Parity.DATA
    assert fastest(*OPPOSITE, 1e-3).lam.imag == 0
    assert fastest(*SLOW, 1e-3).lam.imag > 0


def test_what_decays_leaves_time_for_ever():
    mode = fastest(Toy(1.5), 50, 1e-3)
    waves = waves_of(Toy(1.5), 50, row=_SEED, full=np.real(np.stack((mode.u, mode.v))))
    assert waves.outlook(mode, 1e-3, 0.0, locks=False) == (math.inf, _SEED)


@pytest.mark.parametrize("t", [0.0, 30.0, 70.0])
def test_a_mode_is_held_still_where_its_steps_are_lost_in_the_last_bit(t):
    """At the time t = 2 ln(2 dt/epsilon), when the smooth solution's steps are lost too, or now if that is past."""
    toy, n, dt, epsilon = Toy(0.5), 66, 1e-3, 2.0**-52
    mode = fastest(toy, n, dt)
    then = max(t, 2 * math.log(2 * dt / epsilon))
    assert (then == t) == (t == 70)
    enough = epsilon / (dt * abs(mode.lam)) / math.exp(rate(mode.lam, dt) * (then - t))
    for factor, held in ((0.99, True), (1.01, False)):
        full = np.real(np.stack((mode.u, mode.v))) / np.abs(mode.u).max()
        waves = waves_of(toy, n, epsilon=epsilon, row=_SEED, full=full)
        waves.logs[_SEED] = math.log(factor * enough)
        left, _ = waves.outlook(mode, dt, t, locks=True)
        assert (left == math.inf) == held
        assert waves.outlook(mode, dt, t, locks=False)[0] < math.inf


# All of it


def plain(toy, n, dt, t_end, seed, blow_up_at=1e3):
    """Step by step: (t, whether by the seed) when it or the smooth solution is too large, and the first u <= 0."""
    grid, negative = Grid(n), None
    even = Half(n, grid.h, 1)
    state = np.array(toy.initial(grid.x))
    steady = np.array(discrete_steady(toy, grid.x, grid.h))
    f = np.zeros((2, n))
    f["uv".index(seed.field)] = seed(grid.x)
    for step in range(round(t_end / dt) + 1):
        if negative is None and state[0].min() <= 0:
            negative = step * dt
        away = np.abs(state - steady).max()
        if not away < blow_up_at or np.abs(f[0]).max() > 1 or np.abs(f[1]).max() > blow_up_at:
            return step * dt, away < blow_up_at, negative
        u, v = state
        v_xx = grid.derivative(v, 2)
        change = (
            grid.derivative(f[1], 1),
            grid.derivative(f[0], 1) - f[1] + toy.eps * (u * grid.derivative(f[1], 2) + v_xx * f[0]),
        )
        f = f + dt * np.array(change)
        state = state + dt * np.array(toy.rhs(grid.x, state, grid.derivative))
        state = even.full(even.part(state))  # or round-off would grow on it
    return math.inf, True, negative


@pytest.mark.parametrize(
    ("toy", "n", "seed", "blow_up_at"),
    [
        (Toy(-1.0, 0.05), 24, Seed(11, 1e-6), 1e3),
        (Toy(-0.5, 0.05), 31, Seed(14, 1e-4, "v"), 1e3),
        (Toy(0.5, 0.05), 40, Seed(19, 1e-3, phase=1.0), 1e3),
        (Toy(-1.0, 0.05), 24, Seed(11, 1e-6), 3.0),  # v is the first to be too large
        (Toy(-1.0, 0.1), 13, Seed(3, 1e-9), 1e3),  # the smooth solution itself
    ],
)
def test_with_strides_of_one_step_the_forecast_is_the_linearised_scheme(toy, n, seed, blow_up_at):
    """To the step: the run is lost one step after the linearised one is too large."""
    dt = 0.06
    t, by_the_seed, negative = plain(toy, n, dt, 60.0, seed, blow_up_at)
    found = forecast(toy, n, dt, 60.0, seed, NOTHING, blow_up_at)
    assert found == Forecast(pytest.approx(t + dt), by_the_seed, not by_the_seed, pytest.approx(negative))


@pytest.mark.parametrize(
    ("toy", "n", "seed", "within"),
    [
        (Toy(-1.0), 60, Seed(29, 1e-6), 0.06),
        (Toy(0.5), 100, Seed(49, 1e-6), 0.06),
        (Toy(-0.3, 0.02), 51, Seed(24, 1e-8, "v"), 0.06),
        (Toy(0.5, 0.1), 25, Seed(11, 1e-8), 1 / 0.6),  # it has settled by then: one e-folding of the fastest mode
    ],
)
def test_with_long_strides_it_is_the_same_to_a_stride(toy, n, seed, within):
    dt = 0.9 * min(2e-2, frozen_dt(Grid(n).h, 0.0, toy.eps))
    t, by_the_seed, negative = plain(toy, n, dt, 80.0, seed)
    found = forecast(toy, n, dt, 80.0, seed, NOTHING)
    assert found.t_blow_up == pytest.approx(t, abs=within)
    assert (found.seeded, found.smooth) == (by_the_seed, not by_the_seed)
    assert found.t_first_negative == pytest.approx(negative, abs=0.06)


def test_round_off_counts_by_its_logarithm():
    """The same noise a ten-thousandth as large needs ln(10^4)/growth longer."""
    toy, n, dt = Toy(0.5), 80, 5e-3
    found = [forecast(toy, n, dt, 10.0, None, epsilon, locks=False) for epsilon in (1e-30, 1e-34)]
    assert found[1].t_blow_up - found[0].t_blow_up == pytest.approx(math.log(1e4) / rate(fastest(toy, n, dt).lam, dt))
    assert [each.seeded or each.smooth for each in found] == [False, False]


def test_a_change_that_is_lost_in_the_last_bit_is_lost():
    """On 64 points it grows by 0.025 only; the forecast of the equations alone does not care."""
    assert forecast(Toy(0.5), 64, 1e-3, 1.0).t_blow_up == math.inf
    assert forecast(Toy(0.5), 64, 1e-3, 1.0, locks=False).t_blow_up < math.inf


def test_what_the_smooth_solution_had_left_to_go_is_a_perturbation_of_its_own():
    """On 23 points the first mode to grow has the symmetry of the data: it needs no seed, and no round-off."""
    toy, n, dt = Toy(0.5, 0.1), 23, 1e-2
    mode = fastest(toy, n, dt)
    assert mode.parity is Parity.DATA
    run = ftcs(toy, n, dt, 100.0)
    found = forecast(toy, n, dt, 30.0, None, NOTHING)
    assert found.smooth
    assert not found.seeded
    assert 30 < found.t_blow_up == pytest.approx(run.t_stop, abs=1 / rate(mode.lam, dt))


def test_u_at_zero_counts_as_negative_and_a_positive_one_does_not():
    assert forecast(Toy(0.0), 8, 1e-3, 0.0).t_first_negative == 0
    assert forecast(Toy(0.5), 8, 1e-3, 0.5).t_first_negative is None
    run = ftcs(Toy(0.5), 64, 1e-3, 2.0)
    assert run.stop is Stop.REACHED_END
    found = forecast(Toy(0.5), 64, 1e-3, 2.0).t_first_negative
    assert run.t_first_negative <= found < run.t_first_negative + 0.05
