"""Guards the largest stable step of any problem, and refinement that is not misled by a step too large.

Second routes: the limits in closed form, runs just below and just above them, and the same problem as an object.
"""

import math
import warnings

import numpy as np
import pytest

from primer import EULER, FOURIER, PDE, RK4, RK8, Toy, ftcs, march_lines, refine, stable_dt
from primer.schemes.by_transforms import slope_by_transforms, step_by_products
from primer.schemes.jacobian import rates
from primer.schemes.limit import factor, largest_step
from primer.schemes.marching import grid_of, slope_of
from primer.study.stability import tame_dt

HEAT = PDE("u_t = u_xx", {"u": "sin(x)"})
BURGERS = PDE("u_t = nu*u_xx - (u^2/2)_x", {"u": "1 + sin(x)"}, nu=0.1)
WAVE = PDE("u_tt = u_xx", {"u": "sin(x)", "u_t": 0})
CAHN_HILLIARD = PDE("u_t = (u^3 - u - k*u_xx)_xx", {"u": "0.1*cos(x) + 0.05*sin(2*x)"}, k=0.1)
WATER = PDE("h_t + (h*u)_x = 0; u_t + (u^2/2 + h)_x = 0", {"h": "1 + 0.1*cos(x)", "u": 0}, steady={"h": 1, "u": 0})


@pytest.mark.parametrize(("time", "reach"), [(EULER, 2.0), (RK4, 2.7852935634), (RK8, 6.3936515)])
def test_heat_and_its_kin_are_limited_by_the_real_axis(time, reach):
    """2/(4/h^2) for forward Euler; of the fourth derivative, 16/h^4; a period of 3."""
    h = 2 * np.pi / 32
    assert stable_dt(HEAT, 32, time=time) == pytest.approx(reach * h**2 / 4, rel=1e-6)
    bilaplacian = PDE("u_t = -u_xxxx", {"u": "cos(2*pi*x/3)"}, period=3.0)
    assert stable_dt(bilaplacian, 32, time=time) == pytest.approx(reach * (3 / 32) ** 4 / 16, rel=1e-6)


def test_waves_are_limited_by_the_imaginary_axis():
    h = 2 * np.pi / 32
    assert stable_dt(WAVE, 32) == 0  # forward Euler amplifies what swings, however small the step
    assert stable_dt(WAVE, 32, time=RK4) == pytest.approx(np.sqrt(8) * h / 2, rel=1e-9)
    assert 5.9 * h / 2 < stable_dt(WAVE, 32, time=RK8) < 6.4 * h / 2
    assert stable_dt(PDE("u_t = -u_xx", {"u": "sin(x)"}), 32) == np.inf  # all of it grows of itself
    assert stable_dt(Toy(1.5, 0), 50) == pytest.approx((2 * np.pi / 50) ** 2, rel=1e-12)


@pytest.mark.parametrize("time", [EULER, RK4, RK8])
def test_factor_of_a_step_is_what_the_step_does(time):
    for z in (-0.3, 1j, -1 + 2j):
        assert abs(time.step(lambda y, z=z: z * y, np.array([1.0 + 0j]), 1.0)[0] - factor(time, np.array(z))) < 1e-14


@pytest.mark.parametrize("problem", [HEAT, CAHN_HILLIARD], ids=["heat", "Cahn-Hilliard"])
def test_a_run_just_below_the_limit_lives_and_one_above_does_not(problem):
    limit, sawtooth = stable_dt(problem, 32), (16, 1e-6, "u", 0.0)
    ends = []
    for dt in (0.97 * limit, 1.1 * limit):
        run = ftcs(problem, 32, dt, 400 * dt, seed=sawtooth)
        ends.append(np.abs(np.diff(run.final[0], 4)).max() if run.t_stop > 399 * dt else np.inf)
    assert ends[0] < 1 < ends[1]


def test_an_object_of_ones_own_has_the_same_rates():
    class Own:
        fields = ("u",)
        initial = steady = staticmethod(BURGERS.initial)

        def forcing(self, x):
            return None

        def rhs(self, x, state, derivative, forcing):
            return (0.1 * derivative(state[0], 2) - derivative(state[0] ** 2 / 2, 1),)

    for space in (None, FOURIER):
        options = {} if space is None else {"space": space}
        ours, theirs = (np.sort_complex(rates(p, 24, **options)) for p in (BURGERS, Own()))
        assert np.abs(ours[:, None] - theirs).min(axis=1).max() < 1e-6
    assert stable_dt(Own(), 24) == pytest.approx(stable_dt(BURGERS, 24), rel=1e-6)
    with pytest.raises(ValueError, match="n must be <= 800 for a problem that is no text"):
        stable_dt(Own(), 900)


def test_a_large_grid_is_frozen_and_a_uniform_state_is_waves():
    coarse, fine = stable_dt(BURGERS, 800), stable_dt(BURGERS, 1600)
    assert fine == pytest.approx(coarse / 4, rel=0.02)
    n = 20
    matrix = np.sort(rates(BURGERS, n, 1.0 + 1e-13 * np.arange(n)).real)
    np.testing.assert_allclose(matrix, np.sort(rates(BURGERS, n, 1.0).real), atol=1e-9)


@pytest.mark.parametrize("u", ["x", [1.0, 2.0], np.nan, (1, 2, 3)])
def test_a_wrong_state_is_named(u):
    with pytest.raises(ValueError, match=r"^u must be 1 fields, numbers or arrays of shape \(16,\), got"):
        stable_dt(HEAT, 16, u)


def test_refinement_is_not_misled_by_a_step_too_large():
    """Shallow water and Cahn-Hilliard are well posed: what blows up on the finest grid is the scheme, and is named."""
    with pytest.warns(RuntimeWarning, match="too large for n = 128: what these runs show is the scheme"):
        found = refine(CAHN_HILLIARD, [32, 128], dt=1e-4, t_end=0.5)
    assert found.lost_by_scheme.tolist() == [False, True]
    assert np.isfinite(found.t_blow_up).tolist() == [False, True]
    water = refine(WATER, [16, 64], dt=0.1, t_end=2.0)  # no blow-up yet, and worth nothing all the same
    assert water.lost_by_scheme.tolist() == [False, True]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for problem in (CAHN_HILLIARD, WATER):
            calm = refine(problem, [16, 32, 64], dt="stable", t_end=0.5)
            assert not calm.lost_by_scheme.any()
            assert np.isinf(calm.t_blow_up).all()
            apart = np.abs(np.diff(calm.dist_end))
            assert apart[1] < apart[0] < 0.05
        ill = refine(PDE("u_t = -u_xx", {"u": "sin(x)"}, steady={"u": 0}), [16, 32], dt=1e-3, t_end=10.0)
        assert np.isfinite(ill.t_blow_up).all()
        assert not ill.lost_by_scheme.any()  # here it is the equations


def test_a_tame_step_lets_waves_gain_one_percent():
    dt = tame_dt(WAVE, 16, 3.0)
    run = ftcs(WAVE, 16, dt, 3.0, seed=(8, 1e-3, "u", 0.0))
    gain = abs(1 + dt * 1j * 2 / (2 * np.pi / 16)) ** round(3.0 / dt)
    assert 1.005 < gain < 1.01
    assert run.stop == "reached_end"
    with pytest.raises(ValueError, match="or \"stable\", got 'small'"):
        refine(WAVE, [16], dt="small")


def test_the_toys_two_routes_to_its_step():
    """Of RK4 and RK8 from the Jacobian; the march itself dies just above."""
    toy = Toy(1.5, eps=0.5)
    limit = stable_dt(toy, 32, time=RK4)
    assert not march_lines(toy, 32, 0.95 * limit, 400 * limit, time=RK4).blew_up
    assert march_lines(toy, 32, 1.3 * limit, 4000 * limit, time=RK4).blew_up
    assert largest_step(np.array([-1.0, 0.0, 1.0]), EULER) == 2.0


@pytest.mark.parametrize("n", [194, 195, 256])
@pytest.mark.parametrize(
    "problem",
    [
        Toy(1.5, 0.1),
        PDE(
            "u_t = -u_xxxx/9 - u*u_x + sin(x+t)/3; v_t = (u*v)_x + v_xxx/7",
            {"u": "9 + cos(x)", "v": "sin(2*x)"},
            period=5,
        ),
        PDE("u_t = i*u_xx/2 + i*abs(u)^2*u", {"u": "exp(i*x) + 2"}),
    ],
    ids=["toy", "two orders", "complex"],
)
def test_one_transform_for_all_derivatives_is_one_each(problem, n):
    """``slope_by_transforms`` against the derivatives one by one, and the step by products against that by sums."""
    grid = grid_of(problem, n)
    y = np.array(problem.initial(grid.x))
    alone = slope_of(problem, grid.x, lambda f, m: FOURIER[m](f, grid.h))
    at_once = slope_by_transforms(problem, grid.x, FOURIER, y.dtype.kind == "c")
    for _ in range(2):  # the second time with another state
        expected, found = alone(y, 0.3), at_once(y, 0.3)
        assert np.abs(found - expected).max() <= 1e-9 * np.abs(expected).max()
        y = y + 1e-4 * np.cos(3 * math.tau * grid.x / grid.period) + 0.1
    lost = np.zeros_like(y)
    for time in (RK4, RK8):
        sums = time.exact_step(lambda y, t: -y * t, y, lost, 0.1, 0.2)
        products = step_by_products(time, y)(lambda y, t: -y * t, y, lost, 0.1, 0.2)
        assert np.abs(sums[0] - products[0]).max() < 1e-13 * np.abs(y).max()
