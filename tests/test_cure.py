"""Guards the cure: what the regularised equations do, in closed form, by marching, and on noisy data."""

import math

import numpy as np
import pytest

from primer import checks
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


@pytest.mark.parametrize("n", [4, 16])
def test_all_is_as_it_says_of_the_tent(n):
    """The profile, the data mode by mode, the draw of the noise, the bias, and the noise let through, by plain sums."""
    t, cuts, noise = 0.1, [1.0, n / 2], [0.5, 0.0]
    found = recover(cut_off, cuts, noise, t=t, n=n, seed=3)
    x = -math.pi + 2 * math.pi / n * np.arange(n)
    tent = math.pi / 2 - np.abs(x)
    waves = np.exp(1j * np.outer(np.fft.fftfreq(n, 1 / n), x))  # of k = 0, 1, ... -1
    coefficients = waves.conj() @ tent / n
    k2 = np.fft.fftfreq(n, 1 / n) ** 2
    np.testing.assert_allclose(found.x, x)
    np.testing.assert_allclose(found.profile, tent)
    np.testing.assert_allclose(found.data, (coefficients * np.exp(-k2 * t) @ waves).real, atol=1e-14)
    assert (found.t, found.noise.tolist(), found.parameters.tolist()) == (t, noise, cuts)
    draw = waves.conj() @ np.random.default_rng(3).standard_normal(n) / n
    for j, cut in enumerate(cuts):
        gain = np.where(k2 <= cut**2, np.exp(k2 * t), 0)
        left_out = (coefficients * (gain * np.exp(-k2 * t) - 1)) @ waves
        assert found.bias[j] == pytest.approx(np.sqrt(np.mean(np.abs(left_out) ** 2)), abs=1e-12)
        for i, level in enumerate(noise):
            answer = (left_out + level * (draw * gain) @ waves).real
            assert found.error[i, j] == pytest.approx(np.sqrt(np.mean(answer**2)), abs=1e-12)
            through = level**2 * np.sum(gain**2) / n  # white noise: each wave has 1/n of its mean square
            assert found.expected[i, j] == pytest.approx(math.sqrt(found.bias[j] ** 2 + through), abs=1e-12)
    assert recover(cut_off, cuts, noise, t=t, n=n).error[0, 1] != found.error[0, 1]
    np.testing.assert_array_equal(
        recover(cut_off, cuts, noise, t=t, n=n).error, recover(cut_off, cuts, noise, t, n, 0).error
    )


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: cut_off(-0.5, 3), "t must be a finite number >= 0, got -0.5"),
        (lambda: cut_off(0.5, -0.5), "K must be a finite number >= 0, got -0.5"),
        (lambda: fourth_derivative(-0.5, 3), "t must be a finite number >= 0, got -0.5"),
        (lambda: march_back(1.0, abs), "data must have shape (..., n) with n >= 2 samples, got ()"),
        (lambda: march_back([1.0], abs), "data must have shape (..., n) with n >= 2 samples, got (1,)"),
        (lambda: march_back([1.0, 2.0], 3), "multiplier must be a function of the wavenumbers, got 3"),
        (lambda: recover(3, [1.0], [0.1]), "regularise must be a function of t and the parameter, got 3"),
        (lambda: recover(cut_off, [1.0], [0.1], n=7), "n must be even, got 7"),
        (lambda: recover(cut_off, [1.0], [0.1], seed=-1), "seed must be an integer >= 0, got -1"),
        (
            lambda: recover(cut_off, [1.0], [-0.1]),
            "noise and parameters must be non-empty sequences of numbers, the noise >= 0, "
            "got noise = array([-0.1]) and parameters = array([1.])",
        ),
        (
            lambda: recover(cut_off, np.ones(1000), np.ones(40), n=2000),
            "n, noise and parameters must fit into 2 GiB of memory, got n = 2000",
        ),
    ],
)
def test_bad_input_gets_the_whole_sentence(call, sentence):
    with pytest.raises((TypeError, ValueError)) as caught:
        call()
    assert str(caught.value) == sentence


def test_what_is_just_allowed(monkeypatch):
    monkeypatch.setattr(checks, "MAX_BYTES", 64 * 8 * 3 * 2)  # answers on 8 points for 3 levels of noise and 2 cut-offs
    recover(cut_off, [1.0, 2.0], [0.0, 0.1, 0.2], n=8)
    monkeypatch.setattr(checks, "MAX_BYTES", 64 * 8 * 3 * 2 - 1)
    with pytest.raises(ValueError, match="n, noise and parameters must fit into 0 GiB of memory, got n = 8"):
        recover(cut_off, [1.0, 2.0], [0.0, 0.1, 0.2], n=8)
    monkeypatch.undo()
    np.testing.assert_allclose(march_back([1.0, 3.0], cut_off(0.0, 0)), [2, 2])
    assert fourth_derivative(0, 1e-9)(np.arange(3.0)).tolist() == [1, 1, 1]
    assert recover(cut_off, [0.0], [0.0], n=4).error.shape == (1, 1)
