"""Guards the exponential step: its order, its coefficients, and what it takes for the linear part."""

import math

import mpmath
import numpy as np
import pytest

from primer import CENTRAL, ETDRK4, FOURIER, PDE, RK8, BackwardHeat, Toy, march_lines
from primer.schemes.exponential import coefficients, linear_part


def apart(problem, n, dt, t_end, truth):
    return np.abs(np.array(march_lines(problem, n, dt, t_end, FOURIER, ETDRK4).final) - truth).max()


@pytest.mark.parametrize(
    ("problem", "n", "dt"),
    [
        (Toy(1.5), 32, 0.2),
        (PDE("u_t = 0.05*u_xx - u*u_x", {"u": "sin(x) + 2"}), 64, 0.025),
        (PDE("u_t = u_xx/5 + cos(t)*u^2/4", {"u": "sin(x) + 2"}), 32, 0.1),
        (PDE("u_t = (u_x + v - u^2)_x/5; v_t = v_xx/3 - u*v", {"u": "cos(x)", "v": "sin(x)"}, period=5), 32, 0.02),
    ],
    ids=["toy", "burgers", "time", "system"],
)
def test_order_against_small_explicit_steps(problem, n, dt):
    truth = np.array(march_lines(problem, n, dt / 50, 1.0, FOURIER, RK8).final)
    one, two = (apart(problem, n, h, 1.0, truth) for h in (dt, dt / 2))
    assert 3.6 < math.log2(one / two) < 4.5


def test_schroedinger_whose_modulus_has_no_slope():
    """The soliton-free plane wave of i u_t = -u_xx - |u|^2 u: u = a e^{i (k x - (k^2 - a^2) t)}."""
    wave = PDE("u_t = i*u_xx + i*abs(u)^2*u", {"u": "0.7*exp(3*i*x)"})
    end = march_lines(wave, 32, 0.0025, 1.0, FOURIER, ETDRK4)
    assert np.abs(end.final[0] - 0.7 * np.exp(1j * (3 * end.x - (9 - 0.49)))).max() < 1e-9
    L = linear_part(wave, end.x, np.array(wave.initial(end.x)), FOURIER)
    assert np.abs(L[:, 0, 0] + 1j * np.fft.fftfreq(32, 1 / 32) ** 2).max() < 1e-11


def test_linear_equations_are_exact_in_one_step():
    for problem, t in ((BackwardHeat(2), 0.05), (PDE("u_t = 3*u_xxx - u_xxxx - u", {"u": "cos(2*x)"}), 0.3)):
        end = march_lines(problem, 16, 9.0, t, FOURIER, ETDRK4)
        exact = (
            np.sin(2 * end.x) * math.exp(4 * t)
            if isinstance(problem, BackwardHeat)
            else math.exp(-17 * t) * np.cos(2 * end.x - 24 * t)
        )
        assert np.abs(end.final[0] - exact).max() < 1e-11 * np.abs(exact).max() + 1e-15


@pytest.mark.parametrize("size", [1, 2])
def test_coefficients_against_many_digits(size):
    rng, h = np.random.default_rng(size), 0.3
    L = rng.normal(size=(5, size, size)) * np.array([1e-9, 1e-2, 1, 30, 1e4])[:, None, None] + 0j
    L[3:] -= 1.5 * np.abs(L[3:]).max(axis=(1, 2))[:, None, None] * np.eye(size)
    found = coefficients(L, h)
    with mpmath.workdps(60):
        for place, each in enumerate(L):
            z = mpmath.matrix(each.tolist()) * h
            one, phi = mpmath.eye(size), [mpmath.expm(z, method="pade")]
            for k in range(3):
                phi.append((phi[-1] - one / mpmath.factorial(k)) * z**-1)
            want = h * (phi[1] - 3 * phi[2] + 4 * phi[3]), h * (phi[2] - 2 * phi[3]), h * (4 * phi[3] - phi[2])
            for f, exact in zip((found[0], *found[3:]), (phi[0], *want), strict=True):
                exact = np.array(exact.tolist(), dtype=complex).reshape(size, size)
                assert np.abs(f[place] - exact).max() < 1e-12


def test_stiff_where_explicit_steps_are_short():
    """Toy, eps = 10 on 48 points: a step sixty times the limit of RK4, and yet the answer."""
    truth = np.array(march_lines(Toy(1.5, 10), 48, 1e-4, 1.0, FOURIER, RK8).final)
    assert apart(Toy(1.5, 10), 48, 0.01, 1.0, truth) < 1e-8


def test_refusals():
    with pytest.raises(ValueError, match="time must be a Runge-Kutta step"):
        march_lines(Toy(1.5), 16, 0.1, 1.0, CENTRAL, ETDRK4)
    assert march_lines(PDE("u_t = u^2", {"u": "2"}), 16, 0.01, 2.0, FOURIER, ETDRK4).blew_up
