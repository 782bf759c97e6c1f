"""Guards the reference where diffusion is strong, against scipy's DOP853 on transforms, and what it is made of."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from primer import Toy, reference
from primer.schemes import reference as module
from primer.schemes import stiff


def truth(a, eps, t, n):
    """(u, v) on n points by another method, another form of the derivative, and the equations typed anew."""
    x = -np.pi + 2 * np.pi / n * np.arange(n)
    ik = 1j * np.arange(n // 2 + 1)
    ik_odd = np.where(np.arange(n // 2 + 1) == n / 2, 0, ik)

    def slope(t, y):
        u, v = y.reshape(2, n)
        u, deviation = u + a, np.fft.rfft(u)
        waves = np.fft.rfft(v)
        v_x, v_xx, u_x = (np.fft.irfft(w, n) for w in (ik_odd * waves, ik * ik * waves, ik_odd * deviation))
        return np.concatenate([v_x, eps * u * v_xx + u_x - v - np.sin(x)])

    start = np.concatenate([np.zeros(n), -np.sin(x) / 2])
    y = solve_ivp(slope, (0, t), start, "DOP853", (t,), rtol=1e-11, atol=1e-12).y[:, -1].reshape(2, n)
    return x, y[0] + a, y[1]


@pytest.mark.parametrize(("a", "eps", "t"), [(1.3, 100.0, 0.5), (100.0, 1.0, 0.5), (2.0, 10.0, 2.0)])
def test_reference_where_diffusion_is_strong(monkeypatch, a, eps, t):
    calls = []
    monkeypatch.setattr(module, "_STIFF", 1e4)
    original = stiff.stiff_attempt
    monkeypatch.setattr(module, "stiff_attempt", lambda *given: calls.append(1) or original(*given))
    found = reference(Toy(a, eps), [0.0, t], 1e-9)
    assert calls  # LSODA did it
    x, u, v = truth(a, eps, t, 16)
    at_x = found.at(x)
    assert np.abs(np.array(at_x)[:, 1] - [u, v]).max() < found.error[1] + 2e-10
    assert np.abs(at_x[0][0] - a).max() < 1e-12  # the initial data
    assert (found.error < 1e-9).all()


@pytest.mark.parametrize(("a", "eps", "t"), [(1.5, 1.0, 5.0), (1.3, 10.0, 2.0), (50.0, 1.0, 2.0)])
def test_both_ways_to_march_agree(a, eps, t):
    toy, times = Toy(a, eps), np.array([t / 7, t])
    implicit = stiff.stiff_attempt(toy, 32, 48, times, 1e-10)
    explicit = module._attempt(toy, times, 1e-11, 3, stiff=False)
    assert (np.abs(implicit[0] - explicit[0]).max(axis=(1, 2)) <= implicit[1] + explicit[1]).all()
    assert not implicit[2]


def test_u_below_zero_is_seen_between_the_times():
    _, below = stiff.stiff_trace(Toy(0.9, 0.01), 16, np.array([3.5, 6.0]), 1e-8)
    assert below
    assert stiff.stiff_attempt(Toy(1.5, 10), 16, 24, np.array([1.0]), 1e-13) is None


def test_what_it_cannot_do_is_left_to_short_steps(monkeypatch):
    monkeypatch.setattr(module, "stiff_attempt", lambda *given: None)
    monkeypatch.setattr(module, "_STIFF", 0.0)
    assert reference(Toy(1.5, 1.0), 2.0, 1e-8).error.max() < 1e-8
