"""Of each wave by what one step multiplies it, and which of them the fastest mode is."""

from __future__ import annotations

import math

import numpy as np

from primer.schemes.jacobian import DENSE, frozen_rates, modes
from primer.schemes.limit import factor
from primer.schemes.marching import grid_of

_PLACES = 64  # points at which the equations are frozen


def of_waves(problem, n, dt, states, time):
    """(wavelength, amplification) about [(state, time)]: of the fastest mode with this step, and of each wave.

    The fastest mode is that of the Jacobian, and its wave the strongest one in it, its mean apart; on more than 800
    unknowns it is the fastest of the frozen waves. The amplification, (n//2 + 1,) numbers for k = 0, 1, ... waves in
    the period, is that of the equations frozen at up to 64 points of each state, and the largest of all. Of a problem
    that is no text nothing is known: (nan, ()).
    """
    if not hasattr(problem, "evolution"):
        return math.nan, ()
    places = np.unique(np.linspace(0, n - 1, _PLACES).astype(int))
    frozen = (frozen_rates(problem, n, state, places, t) for state, t in states)
    amplification = folded(np.max([_factors(lam, dt, time).max(axis=(1, 2)) for lam in frozen], axis=0))
    if len(problem.fields) * n > DENSE:
        k = int(np.argmax(amplification))
    else:
        k, best = 0, -math.inf
        for state, t in states:
            lam, vectors = modes(problem, n, state, t)
            factors = _factors(lam, dt, time)
            fastest = int(np.argmax(factors))
            if factors[fastest] > best:
                strength = np.sum(np.abs(np.fft.fft(vectors[..., fastest], axis=1)) ** 2, axis=0)
                k, best = 1 + int(np.argmax(strength[1:])), factors[fastest]
        k = min(k, n - k)
    return grid_of(problem, n).h * n / k if k else math.inf, amplification


def folded(factors):
    """The larger one of waves k and n - k, which differ where fields are complex, for k = 0, 1, ... n//2."""
    n = len(factors)
    k = np.arange(n // 2 + 1)
    return tuple(np.maximum(factors[k], factors[(n - k) % n]).tolist())


def _factors(lam, dt, time):
    return np.abs(factor(time, dt * lam))
