"""Guards the cure: what the regularised equations do, in closed form, by marching, and on noisy data."""

import math

import numpy as np
import pytest

from primer.study.cure import cut_off, fourth_derivative, march_back, recover

K = np.arange(2, 30)
NOISE = np.array([1e-6, 1e-4, 1e-2])


def test_multipliers():
    k = np.arange(6.0)
    np.testing.assert_allclose(cut_off(0.1, 3)(k), [1, math.exp(0.1), math.exp(0.4), math.exp(0.9), 0, 0])
    np.testing.assert_allclose(cut_off(0.0, 0.5)(k), [1, 0, 0, 0, 0, 0])
    top = fourth_derivative(0.3, 0.02)(np.linspace(0, 20, 100001)).max()
    assert top == pytest.approx(math.exp(0.3 / (4 * 0.02)), rel=1e-8)  # at k^2 = 1/(2 beta)
    assert np.isfinite(cut_off(1.0, 5)(np.arange(2000.0))).all()


def test_fourth_derivative_solves_its_equation():
    """Against small steps of u_t = -u_xx - beta u_xxxx with exact derivatives of a few modes."""
    x, beta, t, steps = np.arange(32) * math.pi / 16, 0.05, 0.2, 20000
    amplitudes = np.array([1.0, -0.5, 0.2])
    k = np.array([1, 2, 4])
    start = amplitudes @ np.cos(np.outer(k, x))
    for _ in range(steps):
        amplitudes = amplitudes * (1 + t / steps * (k**2 - beta * k**4))
    np.testing.assert_allclose(
        march_back(start, fourth_derivative(t, beta)), amplitudes @ np.cos(np.outer(k, x)), atol=1e-4
    )


def test_without_noise_and_cut_off_the_profile_comes_back():
    found = recover(cut_off, [8.0, 12.0], [0.0], t=0.05, n=24)
    assert found.error[0, 1] < 1e-12
    assert found.error[0, 0] == pytest.approx(found.bias[0], rel=1e-12)


def test_bias_is_what_the_cut_off_leaves_out():
    """The tent's coefficients are 2/(pi k^2) for odd k: Parseval, on a grid fine enough for aliasing to be small."""
    found = recover(cut_off, [3.0, 9.0], [0.0], t=0.002, n=4096)
    for cut, bias in zip((3, 9), found.bias, strict=True):
        odd = np.arange(cut + 2, 4000, 2.0)
        assert bias == pytest.approx(math.sqrt(2 * np.sum((2 / (math.pi * odd**2)) ** 2)), rel=2e-3)


@pytest.mark.parametrize("regularise", [cut_off, fourth_derivative])
def test_error_is_bias_and_noise_let_through(regularise):
    """One draw of the noise scatters about the expected error; over many draws the mean square is met."""
    parameters = [6.0, 12.0] if regularise is cut_off else [0.02, 0.004]
    squares = [recover(regularise, parameters, NOISE, seed=seed).error ** 2 for seed in range(300)]
    expected = recover(regularise, parameters, NOISE).expected
    np.testing.assert_allclose(np.sqrt(np.mean(squares, axis=0)), expected, rtol=0.15)


def test_the_best_cut_off_depends_on_the_noise():
    found = recover(cut_off, K, NOISE)
    assert np.all(np.diff(found.best) < 0)
    best = found.error.min(axis=1)
    assert np.all(np.diff(best) > 0)
    for i, noise in enumerate(NOISE):  # where the noise let through is as large as what is left out
        assert found.best[i] == pytest.approx(math.sqrt(math.log(1 / noise) / found.t), rel=0.35)


def test_bad_input_gets_one_sentence():
    with pytest.raises(ValueError, match="beta must be a finite number > 0, got 0"):
        fourth_derivative(1.0, 0)
    with pytest.raises(ValueError, match="t must be a finite number > 0, got 0"):
        recover(cut_off, [1.0], [0.0], t=0)
