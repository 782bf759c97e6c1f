"""Guards what can be saved: log-convexity on random data, the promised bound, and that no method can promise more."""

import math

import numpy as np
import pytest

from primer.study.cure import cut_off, march_back
from primer.study.discrepancy import TAU, by_discrepancy, diffuse, log_convex, rms, save, tikhonov

T = 0.05


def tent(x):
    return math.pi / 2 - np.abs(x)


@pytest.mark.parametrize("seed", range(20))
def test_solutions_are_log_convex(seed):
    """Random waves, summed one by one: no library transform, no multiplier."""
    rng = np.random.default_rng(seed)
    k, x = np.arange(9), np.arange(32) * 2 * np.pi / 32
    c = rng.standard_normal((2, 9)) * np.exp(-rng.uniform(0, 2) * k)

    def size(s):
        return rms(
            (np.exp(-(k**2) * s) * c[0]) @ np.cos(np.outer(k, x))
            + (np.exp(-(k**2) * s) * c[1]) @ np.sin(np.outer(k, x))
        )

    end = rng.uniform(0.01, 2)
    for f in rng.uniform(0, 1, 10):
        assert size(f * end) <= log_convex(size(0), size(end), f) * (1 + 1e-12)
    assert size(end / 2) ** 2 <= size(0) * size(end)


def test_one_wave_attains_the_bound():
    """So two profiles, w and 0, fit the same data to within delta: no method beats the bound for all w."""
    for k, E in ((3, 1.0), (7, 20.0)):
        wave = E * np.cos(k * np.arange(64) * 2 * np.pi / 64)
        delta = rms(march_back(wave, diffuse(T)))
        for s in (0.0, 0.01, 0.03, T):
            assert rms(march_back(wave, diffuse(s))) == pytest.approx(log_convex(rms(wave), delta, s / T), rel=1e-12)


def test_tikhonov_is_the_minimum_by_linear_algebra():
    n, alpha = 12, 3e-3
    x = -math.pi + 2 * math.pi / n * np.arange(n)
    A = march_back(np.eye(n), diffuse(0.3)).T
    data = np.exp(np.sin(x))
    w = np.linalg.lstsq(np.vstack([A, math.sqrt(alpha) * np.eye(n)]), np.r_[data, np.zeros(n)], rcond=None)[0]
    np.testing.assert_allclose(march_back(data, tikhonov(0.3, alpha)), w, atol=1e-12)


@pytest.mark.parametrize("method", [tikhonov, cut_off])
@pytest.mark.parametrize("seed", range(5))
def test_the_principle_misses_the_data_by_tau_delta(method, seed):
    x = -math.pi + 2 * math.pi / 64 * np.arange(64)
    noise = np.random.default_rng(seed).standard_normal(64)
    delta = 10.0 ** -(seed + 1)
    data = march_back(tent(x), diffuse(T)) + delta * noise / rms(noise)
    found = by_discrepancy(data, delta, T, method)
    again = float(rms(march_back(found.profile, diffuse(T)) - data))
    assert again == pytest.approx(found.missed, rel=1e-6)
    if method is tikhonov:
        assert again == pytest.approx(TAU * delta, rel=1e-6)
    else:
        assert again <= TAU * delta
        coarser = march_back(data, cut_off(T, found.parameter - 1))
        assert rms(march_back(coarser, diffuse(T)) - data) > TAU * delta


@pytest.mark.parametrize("seed", range(30))
def test_the_promise_is_kept_on_random_profiles(seed):
    """Tikhonov's error is below the theorem's bound at every s; random waves, random noise, random T."""
    rng = np.random.default_rng(seed)
    c, k, end = (
        rng.standard_normal(40) / (1 + np.arange(40.0)) ** rng.uniform(0, 2),
        np.arange(40),
        rng.uniform(0.002, 0.3),
    )
    s = end * np.array([0, 0.1, 0.5, 0.9, 1])
    found = save(lambda x: c @ np.cos(np.outer(k, x)), 10.0 ** rng.uniform(-9, 0, 4), s, end, seed=seed)
    assert (found.error <= found.bound * (1 + 1e-9)).all()
    assert (found.least <= found.bound).all()


def test_the_order_is_that_of_the_bound_for_the_worst_profile():
    """For each delta the worst wave: data 0, so the answer is 0, and the error is E^{1-s/T} delta^{s/T}."""
    s, k = np.array([0.0125, 0.025]), np.arange(3, 10)
    deltas, errors = [], []
    for wave in k:
        true = np.cos(wave * (-math.pi + 2 * math.pi / 64 * np.arange(64)))
        delta = float(rms(march_back(true, diffuse(T))))
        answer = by_discrepancy(1e-30 * true, delta, T).profile
        deltas.append(delta)
        errors.append([float(rms(march_back(answer - true, diffuse(t)))) for t in s])
    order = np.polyfit(np.log(deltas), np.log(errors), 1)[0]
    np.testing.assert_allclose(order, s / T, atol=1e-9)


@pytest.mark.parametrize("method", [tikhonov, cut_off])
def test_of_the_tent_nearly_all_that_can_be_had(method):
    found = save(tent, np.logspace(-8, -2, 7), [0, T / 4, T / 2, T], T, method)
    assert (found.error[:, 1:3] <= 4.5 * found.least[:, 1:3]).all()
    assert (found.order >= np.array([0, 0.25, 0.5, 0.9])).all()
    assert (np.diff(found.error[:, 2]) > 0).all()


def test_bad_input_gets_one_sentence():
    data = np.ones(8)
    for call, sentence in (
        (lambda: by_discrepancy(data, 0, T), "delta must be a finite number > 0, got 0"),
        (lambda: by_discrepancy(data, 1e-3, T, tau=1), "tau must be a finite number > 1, got 1"),
        (lambda: by_discrepancy(data, 1e-3, T, abs), "method must be tikhonov or cut_off"),
        (lambda: by_discrepancy(np.ones(7), 1e-3, T), r"data must have shape \(n,\) with n even and >= 4, got \(7,\)"),
        (lambda: log_convex(1, 1, 1.5), r"fraction must be in \[0, 1\], got 1.5"),
        (lambda: log_convex(-1, 1, 0.5), "early and late must be >= 0"),
        (lambda: save(tent, [0.0], [0.0]), "noise must be numbers > 0"),
        (lambda: save(tent, [0.1], [1.0]), r"s must be in \[0, T\]"),
    ):
        with pytest.raises(ValueError, match=sentence):
            call()


def test_data_below_the_noise_say_nothing():
    found = by_discrepancy(1e-3 * np.ones(8), 1.0, T)
    assert found.missed == pytest.approx(1e-3)
    assert not found.profile.any()
    assert math.isinf(found.parameter)
