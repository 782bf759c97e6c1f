"""Guards the stencils and what the scheme does exactly: multipliers, steady state, growth per step."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

from primer import BackwardHeat, Toy, ftcs
from primer.schemes.discrete import amplification, discrete_steady, dist_floor
from primer.schemes.grid import CENTRAL, Grid, grids


@pytest.mark.parametrize("n", [4, 9, 30, 100])
@pytest.mark.parametrize("m", [1, 2])
def test_multiplier_is_what_the_stencil_does_to_an_exponential(n, m):
    grid = Grid(n)
    for k in range(-(n // 2), n // 2 + 1):
        wave = np.exp(1j * k * grid.x)
        np.testing.assert_allclose(grid.derivative(wave, m), grid.multiplier(k, m) * wave, atol=1e-11 / grid.h**m)


def test_multipliers_are_the_closed_forms():
    grid, xi = Grid(50), np.linspace(-40, 40, 17)
    np.testing.assert_allclose(grid.multiplier(xi, 1), 1j * np.sin(xi * grid.h) / grid.h, atol=1e-13)
    np.testing.assert_allclose(grid.multiplier(xi, 2), -4 / grid.h**2 * np.sin(xi * grid.h / 2) ** 2, atol=1e-11)
    assert abs(grid.multiplier(math.pi / grid.h, 1)) < 1e-13  # blind to the sawtooth


@pytest.mark.parametrize("m", [1, 2])
def test_stencils_reach_their_order(m):
    h = np.array([1e-2, 5e-3])
    error = [abs(CENTRAL[m].multiplier(1.0, step) - 1j**m) for step in h]
    assert np.log2(error[0] / error[1]) == pytest.approx(CENTRAL[m].order, abs=0.01)


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: Grid(8).derivative(np.arange(7.0), 1), r"f must have shape \(..., 8\) on this grid, got \(7,\)"),
        (lambda: discrete_steady(Toy(1.5), 0.0, math.pi), "h must be a finite number > 0 and < 3.14159"),
        (lambda: discrete_steady(Toy(1.5), 0.0, 0), "h must be a finite number > 0 and < 3.14159"),
        (lambda: amplification(np.eye(2), -1), "dt must be a finite number > 0, got -1"),
    ],
)
def test_bad_input_gets_one_sentence(call, sentence):
    with pytest.raises(ValueError, match=sentence):
        call()


def test_grid_is_the_papers():
    grid = Grid(100)
    assert grid.x[0] == -math.pi
    assert grid.x.size == 100
    np.testing.assert_allclose(np.diff(grid.x), 2 * math.pi / 100)


@pytest.mark.parametrize("n", [4, 7, 30, 101])
def test_discrete_steady_state_is_steady(n):
    """The right-hand side of the differences vanishes on it, and one step of the scheme leaves it."""
    grid, toy = Grid(n), Toy(0.5, eps=0.3)
    rates = toy.rhs(grid.x, discrete_steady(toy, grid.x, grid.h), grid.derivative)
    np.testing.assert_allclose(rates, np.zeros((2, n)), atol=1e-13)


@pytest.mark.parametrize(("n", "floor"), [(100, 6.582768e-4), (30, 7.348406e-3)])
def test_dist_floor(n, floor):
    assert dist_floor(n) == pytest.approx(floor, rel=1e-6)
    grid, toy = Grid(n), Toy(1.5)
    difference = discrete_steady(toy, grid.x, grid.h)[0] - toy.steady(grid.x)[0]
    assert dist_floor(n) == pytest.approx(np.abs(difference).max(), rel=1e-12)


@dataclass(frozen=True)
class Frozen:
    """The toy system linearised about frozen (u*, v_xx*), eq. (toy-pde-full-lin), from one real field pair."""

    eps: float
    u_star: float
    v_xx_star: float
    start: np.ndarray
    fields: ClassVar[tuple[str, ...]] = ("u", "v")

    def initial(self, x):
        return tuple(self.start)

    def steady(self, x):
        return np.zeros_like(x), np.zeros_like(x)

    def forcing(self, x):
        return None

    def rhs(self, x, state, derivative, forcing=None):
        u, v = state
        v_t = self.eps * (self.u_star * derivative(v, 2) + self.v_xx_star * u) + derivative(u, 1) - v
        return derivative(v, 1), v_t


@pytest.mark.parametrize("mode", [1, 7, 15])
@pytest.mark.parametrize(("u_star", "v_xx_star"), [(1.5, 0.0), (-0.5, 0.3)])
def test_one_step_multiplies_a_mode_by_one_plus_dt_lambda(mode, u_star, v_xx_star):
    n, dt, eps = 30, 0.02, 0.05
    grid = Grid(n)
    S = Toy(1.0, eps).symbol(float(mode), u_star, v_xx_star, grid.multiplier)
    lam, vectors = np.linalg.eig(S)
    np.testing.assert_allclose(
        np.sort_complex(amplification(S, dt)), np.sort_complex(1 + dt * lam), rtol=1e-12
    )  # the library's factors are those
    for k in range(2):
        wave = vectors[:, k, None] * np.exp(1j * mode * grid.x)
        parts = [ftcs(Frozen(eps, u_star, v_xx_star, part), n, dt, dt).final for part in (wave.real, wave.imag)]
        stepped = np.array(parts[0]) + 1j * np.array(parts[1])
        np.testing.assert_allclose(stepped, (1 + dt * lam[k]) * wave, atol=1e-12)


@pytest.mark.parametrize("xi", [1, 5, 16])
def test_backward_heat_grows_by_its_amplification_factor(xi):
    n, dt, steps = 64, 1e-4, 40
    grid = Grid(n)
    factor = 1 + dt * 4 / grid.h**2 * math.sin(xi * grid.h / 2) ** 2  # physics.md, section 2
    assert amplification(BackwardHeat().symbol(float(xi), grid.multiplier), dt)[0] == pytest.approx(factor, rel=1e-14)
    run = ftcs(BackwardHeat(xi), n, dt, steps * dt)
    np.testing.assert_allclose(run.final[0], factor**steps * np.sin(xi * grid.x), atol=1e-12)


def test_at_eps_0_the_scheme_is_unstable_just_above_dt_h2():
    """At eps = 0 a factor exceeds 1 iff dt > h^2: numerical instability, a matter of dt alone."""
    grid = Grid(64)
    xi = np.arange(33.0)
    S = Toy(1.0, eps=0).symbol(xi, 1.0, multiplier=grid.multiplier)
    for ratio, stable in ((0.99, True), (1.01, False)):
        assert bool(np.abs(amplification(S, ratio * grid.h**2)).max() <= 1 + 1e-14) is stable


@pytest.mark.parametrize(
    ("symbol", "error", "said"),
    [
        ("x", TypeError, "symbol must be an array of numbers, got 'x'"),
        ([1.0, 2.0], ValueError, "symbol must have shape (..., m, m), got (2,)"),
        (np.ones((2, 3)), ValueError, "symbol must have shape (..., m, m), got (2, 3)"),
        (np.ones((3, 0, 0)), ValueError, "symbol must have shape (..., m, m), got (3, 0, 0)"),
        ([[np.inf]], ValueError, "symbol must be finite everywhere, got [[inf]]"),
    ],
)
def test_a_symbol_is_an_array_of_square_matrices(symbol, error, said):
    with pytest.raises(error) as caught:
        amplification(symbol, 0.1)
    assert str(caught.value) == said


def test_factors_come_with_the_largest_first():
    S = np.array([np.diag([-3.0, 0.5, 1.0]), np.diag([1.0, -100.0, 0.0])])
    np.testing.assert_allclose(amplification(S, 0.1), [[1.1, 1.05, 0.7], [-9, 1.1, 1]], rtol=1e-14)
    np.testing.assert_allclose(amplification([[2.0]], 0.5), [2.0])
    assert amplification(S, 0.1).dtype == complex


def test_a_grid_takes_fields_of_any_shape_and_names_what_it_cannot_take():
    grid = Grid(6)
    f = np.random.default_rng(0).normal(size=(2, 3, 6))
    for m in (1, 2, 5):
        both = grid.derivative(f, m)
        np.testing.assert_array_equal(both[1, 2], grid.derivative(f[1, 2], m))
        wave = f + 1j * f[::-1]
        np.testing.assert_allclose(grid.derivative(wave, m), both + 1j * both[::-1], rtol=1e-12, atol=1e-12)
    np.testing.assert_array_equal(grid.derivative([0, 1, 0, 0, 0, 0], 1), np.array([1, 0, -1, 0, 0, 0]) / (2 * grid.h))
    for m in (0, 13):
        for call in (lambda m=m: grid.derivative(f, m), lambda m=m: grid.multiplier(1.0, m)):
            with pytest.raises(ValueError, match=f"m must be an integer >= 1 and <= 12, got {m}"):
                call()
    with pytest.raises(ValueError, match="xi must be finite"):
        grid.multiplier(np.inf, 1)
    with pytest.raises(ValueError, match=r"f must have shape \(..., 6\) on this grid, got \(\)"):
        grid.derivative(3.0, 1)
    assert Grid(4).n == 4
    assert Grid(10**7).n == 10**7
    with pytest.raises(ValueError, match=r"n must be an integer <= 1e.07 to fit into memory, got 10000001"):
        Grid(10**7 + 1)


def test_grid_sizes_in_a_row_are_each_checked_under_their_name():
    assert grids("ns", (4, 10**7, np.int64(5))) == (4, 10**7, 5)
    assert all(type(n) is int for n in grids("ns", (4, np.int64(5))))
    for ns, said in (
        ((4, 3), "ns must be an integer >= 4, got 3"),
        ((10**7 + 1, 4), "ns must be integers <= 1e+07 to fit into memory, got 10000001"),
    ):
        with pytest.raises(ValueError, match="ns must be") as error:
            grids("ns", ns)
        assert str(error.value) == said


def test_the_weighted_sum_is_scaled_once():
    for m in (1, 2):
        assert CENTRAL[m].scale(0.1) == 1 / ((2 if m == 1 else 1) * (0.1 if m == 1 else 0.1 * 0.1))
