"""Guards the scheme's limit on dt: the closed form against a search over modes, and against runs."""

import math

import numpy as np
import pytest

from primer import Stop, Toy, ftcs, stable_dt
from primer.schemes.discrete import amplification
from primer.schemes.grid import Grid
from primer.schemes.jacobian import rates
from primer.study.spectrum import jacobian
from primer.study.stability import OVERSHOOT, amplification_over_modes, frozen_dt


def largest_factor(h, u, eps, dt):
    xi = np.linspace(0, math.pi / h, 4001)
    symbol = Toy(0, eps).symbol(
        xi, u, multiplier=lambda k, m: 1j * np.sin(k * h) / h if m == 1 else (2 * np.cos(k * h) - 2) / h**2
    )
    return np.abs(amplification(symbol, dt)).max()


@pytest.mark.parametrize("seed", range(40))
def test_frozen_limit_is_where_the_first_mode_starts_to_grow(seed):
    random = np.random.default_rng(seed)
    h, eps = 10 ** random.uniform(-2.5, 0), 10 ** random.uniform(-4, 0)
    u = random.uniform(-1, 3) * min(1, h**2 / (4 * eps)) if seed % 2 else random.uniform(0, 3)
    dt = frozen_dt(h, u, eps)
    assert largest_factor(h, u, eps, 0.999 * dt) <= 1 + 1e-12
    assert largest_factor(h, u, eps, 1.002 * dt) > 1 + 1e-9 * dt


def test_special_values():
    assert frozen_dt(0.1, 7.0, 0) == pytest.approx(0.01, rel=1e-14)
    np.testing.assert_allclose(
        frozen_dt(0.1, [-0.25 + 1e-9, -0.2501], 0.01), [0.0025, 0], rtol=2e-4
    )  # 4 eps u/h^2 = -1
    assert largest_factor(0.1, -0.2501, 0.01, 1e-7) > 1
    assert stable_dt(Toy(-2.0, 0), 4) == 2  # on four points h^2 = 2.5, and the sawtooth of v needs dt <= 2
    for n in (5, 30, 101):
        assert stable_dt(Toy(-2.0, 0), n) == pytest.approx(Grid(n).h ** 2, rel=1e-14)
    assert stable_dt(Toy(0.5), 200) == 0
    t = np.linspace(0, 20, 400001)
    m = 1 - np.exp(-t / 2) * np.cos(math.sqrt(3) / 2 * t)  # eq. (toy-sln)
    assert m.max() == pytest.approx(OVERSHOOT, rel=1e-9)
    assert stable_dt(Toy(1.5), 100, u=[0.5, 2.5]) == min(frozen_dt(Grid(100).h, u, 0.01) for u in (0.5, 2.5))


@pytest.mark.parametrize(("a", "eps", "n"), [(1.5, 0.01, 1000), (1.5, 0.1, 300), (2.0, 0.0, 60), (1.6, 0.01, 60)])
def test_runs_live_below_the_limit_and_die_well_above_it(a, eps, n):
    """Frozen coefficients are local: the true limit lies a little above them."""
    toy = Toy(a, eps)
    dt = stable_dt(toy, n)
    assert ftcs(toy, n, 0.95 * dt, 30.0, blow_up_at=1e3).stop is Stop.REACHED_END
    assert ftcs(toy, n, 2.2 * dt, 150.0, blow_up_at=1e3).stop is Stop.BLEW_UP


def test_numerical_instability_goes_with_dt_and_ill_posedness_does_not():
    n, h = 100, Grid(100).h
    k, over = amplification_over_modes(Toy(1.5), n, 6 * h**2, u=0.5)
    _, cured = amplification_over_modes(Toy(1.5), n, 2 * h**2, u=0.5)
    assert k.tolist() == list(range(51))
    assert over.shape == (51, 2)
    assert over.max() > 1.01
    assert cured.max() <= 1 + 1e-14
    growths = [np.log(amplification_over_modes(Toy(0.5), n, dt, u=-0.5)[1].max()) / dt for dt in (1e-3, 1e-4, 1e-6)]
    assert growths[-1] == pytest.approx(4 * 0.01 * 0.5 / h**2 - 1, rel=1e-4)
    assert min(growths) > 3.9
    finer = np.log(amplification_over_modes(Toy(0.5), 2 * n, 1e-6, u=-0.5)[1].max()) / 1e-6
    assert finer > 4 * growths[-1]


def test_bad_input_gets_one_sentence():
    with pytest.raises(ValueError, match="h must be a finite number > 0, got 0"):
        frozen_dt(0, 1, 1)
    with pytest.raises(ValueError, match="n must be an integer >= 4, got 3"):
        stable_dt(Toy(1), 3)


def test_at_the_edge_the_sawtooth_is_neutral_and_the_other_bound_holds():
    """g = 4 eps u/h^2 = -1 exactly: h^2/4, where the next smaller u has none."""
    assert frozen_dt(2.0, -1.0, 1.0) == 1.0
    assert frozen_dt(2.0, np.nextafter(-1.0, -2), 1.0) == 0.0
    assert isinstance(frozen_dt(0.1, 1.0, 0.01), float)
    assert frozen_dt(0.1, [1.0], 0.01).shape == (1,)
    assert stable_dt(Toy(0.1, 0.05), 30) == frozen_dt(Grid(30).h, 0.1 - OVERSHOOT, 0.05)
    assert stable_dt(Toy(3.0, 0.5), 60) == frozen_dt(Grid(60).h, 3 + OVERSHOOT, 0.5)
    for call, sentence in (
        (lambda: frozen_dt(0.1, 1.0, -0.5), "eps must be a finite number >= 0, got -0.5"),
        (
            lambda: stable_dt(3, 8),
            "problem must be a PDE, a Toy, a BackwardHeat or an object with their methods, got 3",
        ),
        (lambda: stable_dt(Toy(1), 8, []), "u must hold at least one number, got []"),
        (lambda: amplification_over_modes(3, 8, 0.1, 1.0), "toy must be a Toy, got 3"),
    ):
        with pytest.raises((TypeError, ValueError)) as caught:
            call()
        assert str(caught.value) == sentence


def test_rates_of_toy_about_its_steady_state():
    """Against the Jacobian that study/spectrum.py writes by hand."""
    toy, n = Toy(0.5), 24
    x = Grid(n).x
    found = rates(toy, n, toy.steady(x))
    expected = np.linalg.eigvals(jacobian(toy, n, toy.steady(x)))
    assert found.size == expected.size
    assert np.abs(found[:, None] - expected).min(axis=1).max() < 1e-6
