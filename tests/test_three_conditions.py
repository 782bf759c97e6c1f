"""Guards Hadamard's conditions in the course: Tychonoff's solution, norms of BC^k, and where freezing lies."""

import math

import mpmath as mp
import numpy as np
import pytest
from scipy.linalg import expm

from primer import verdict
from primer.study.bounded import bc_norm, log_hadamard
from primer.study.freezing import central, fastest, galerkin, lax_friedrichs, powers, solution
from primer.study.tychonoff import tychonoff


@pytest.mark.parametrize(("x", "t"), [(0.0, 0.4), (0.7, 0.5), (-1.3, 0.3), (2.0, 1.0), (3.0, 0.8), (1.0, 0.1)])
def test_tychonoff_by_cauchys_integral(x, t):
    """g^(k) by the integral of exp(-1/z^2) round t, no polynomial in it."""
    with mp.workdps(60):
        angles = [2 * mp.pi * j / 400 for j in range(400)]
        r = mp.mpf(t) / 4
        values = [mp.exp(-1 / (t + r * mp.expj(a)) ** 2) for a in angles]
        total = mp.mpf(0)
        for k in range(150):
            c = sum(v * mp.expj(-k * a) for v, a in zip(values, angles, strict=True)).real / 400 / r**k
            total += c * mp.factorial(k) * mp.mpf(x) ** (2 * k) / mp.factorial(2 * k)
    assert float(tychonoff(x, t)) == pytest.approx(float(total), rel=1e-9, abs=1e-16)


def test_tychonoff_solves_the_heat_equation_from_nothing():
    for x, t in ((0.5, 0.6), (1.5, 0.7), (2.5, 1.1)):
        d = 1e-3
        u_t = (tychonoff(x, t + d) - tychonoff(x, t - d)) / (2 * d)
        u_xx = (tychonoff(x + d, t) - 2 * tychonoff(x, t) + tychonoff(x - d, t)) / d**2
        assert u_t == pytest.approx(u_xx, rel=1e-3)
        assert abs(u_t) > 1e-3
    assert np.abs(tychonoff([0.0, 0.5, 1.0], 0.02)).max() < 1e-300**0.5


def test_tychonoff_refuses():
    with pytest.raises(ValueError, match="t must be > 0, got 0"):
        tychonoff(1.0, 0.0)
    with pytest.raises(ValueError, match=r"2 x\^2/t <= 300, got 2000"):
        tychonoff(10.0, 0.1)


@pytest.mark.parametrize("n", [32, 33])
def test_bc_norm_by_hand(n):
    x = np.arange(n) * 2 * np.pi / n
    f = 2 * np.sin(x) + 0.1 * np.cos(5 * x)
    derivatives = [f, 2 * np.cos(x) - 0.5 * np.sin(5 * x), -2 * np.sin(x) - 2.5 * np.cos(5 * x)]
    for k in range(3):
        assert bc_norm(f, k) == pytest.approx(max(np.abs(d).max() for d in derivatives[: k + 1]), rel=1e-12)
    assert bc_norm(np.array([f, 2 * f]), 1).shape == (2,)
    assert bc_norm(np.array([1.0, -1.0])) == 1


def test_hadamards_data_in_bc_k():
    x = np.arange(256) * 2 * np.pi / 256
    for n, k, t in ((4, 2, 0.0), (8, 1, 0.1), (16, 3, 0.02)):
        wave = math.exp(n**2 * t - math.sqrt(n)) * np.sin(n * x)
        assert math.log(bc_norm(wave, k)) == pytest.approx(float(log_hadamard(n, k, t)), abs=1e-9)
    with pytest.raises(ValueError, match="n must be whole numbers"):
        log_hadamard(0.5)


def test_frozen_it_is_ill_posed_and_the_truth_is_not():
    assert verdict("w_t = i*w_xx + 3*i*w_x").kind == "ill-posed"
    rng = np.random.default_rng(0)
    for c in rng.uniform(0.5, 4, 3):
        w = np.exp(np.cos(np.arange(64) * 2 * np.pi / 64 - np.pi)) + 0j
        turn = np.exp(c * np.sin(np.arange(64) * 2 * np.pi / 64 - np.pi) / 2)
        for t in (0.3, 50.0):
            assert np.linalg.norm(solution(w, t, c) * turn) == pytest.approx(np.linalg.norm(w * turn), rel=1e-10)


def test_two_discretisations_disagree():
    assert all(abs(fastest(central(n))) < 1e-8 * n**2 for n in (16, 32, 64, 128))
    rates = [fastest(galerkin(n)) for n in (32, 64, 128)]
    np.testing.assert_allclose(rates, [12, 24, 47], rtol=0.15)
    assert fastest(galerkin(64, b=0.5)) > 0.4 * 32  # with a mean it is ill posed, and both say so
    assert fastest(central(128, b=0.5)) == pytest.approx(2 * fastest(central(64, b=0.5)), rel=0.05)


def test_central_differences_converge_to_the_solution():
    """By another route than the turn: matrix exponential of differences, second order; and the equation itself."""
    errors = []
    for n in (64, 128, 256):
        x = -np.pi + 2 * np.pi / n * np.arange(n)
        w = np.exp(np.cos(x)) + 0j
        errors.append(np.abs(expm(0.1 * central(n)) @ w - solution(w, 0.1)).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, 2, atol=0.1)


def test_galerkin_is_the_equation_on_a_wave():
    x, k = np.arange(64) * 2 * np.pi / 64, np.arange(9) - 4
    c = np.random.default_rng(1).standard_normal(9) * (np.abs(k) < 4)
    _, w_x, w_xx = (np.exp(1j * np.outer(x, k)) @ (c * (1j * k) ** m) for m in range(3))
    made = np.exp(1j * np.outer(x, k)) @ (galerkin(9, 2.0, 0.7) @ c)
    np.testing.assert_allclose(made, 1j * w_xx + 1j * (0.7 + 2 * np.cos(x)) * w_x, atol=1e-12)


def test_powers_grow_though_no_eigenvalue_does():
    """|G^m| ~ m for m steps at theta with sin theta ~ 1/... : by the closed form m g^(m-1) b of a Jordan block."""
    theta, ratio, m = np.array([0.1, 0.5, 2.0]), 0.9, 40
    G = lax_friedrichs(theta, ratio)
    assert (np.abs(np.linalg.eigvals(G)) <= 1 + 1e-7).all()
    g, b = G[:, 0, 0], G[:, 0, 1]
    block = np.array([[g**m, m * g ** (m - 1) * b], [0 * g, g**m]]).transpose(2, 0, 1)
    np.testing.assert_allclose(powers(G, m)[-1], [np.linalg.norm(B, 2) for B in block], rtol=1e-9)
    n = np.array([32, 64, 128])  # at t = 1, the worst wave: as many steps as points, and a power of h is lost
    worst = [powers(lax_friedrichs(np.linspace(0, np.pi, 401), 1.0), k)[-1].max() for k in n]
    np.testing.assert_allclose(np.diff(np.log2(worst)), 1, atol=0.05)
    assert powers(lax_friedrichs(np.linspace(0, np.pi, 401), 1.0, 0.0), 128).max() == pytest.approx(1)
    assert verdict("u_t = u_x + v_x; v_t = v_x").loss == 1
    assert verdict("u_t = v_xx; v_t = 0").loss == 2


def test_bad_input_gets_one_sentence():
    for call, sentence in (
        (lambda: central(3), "n must be"),
        (lambda: solution(np.ones((4, 4)), 1), r"w must have shape \(n,\)"),
        (lambda: powers(np.ones((2, 3)), 2), r"G must have shape"),
        (lambda: bc_norm(1.0), "samples must have shape"),
        (lambda: lax_friedrichs(0.1, 0), "ratio must be"),
    ):
        with pytest.raises(ValueError, match=sentence):
            call()
