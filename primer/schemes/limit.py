"""The largest step of a Runge-Kutta method that amplifies no mode which does not grow of itself."""

from __future__ import annotations

import math

import numpy as np

from primer.schemes.runge_kutta import RungeKutta

NEUTRAL = 1e-10  # of the largest rate: a real part that rounding makes of a zero
_GRID = 0.01  # steps in |lam| dt in which the end of stability is looked for, before it is bisected


def largest_step(lam: np.ndarray, time: RungeKutta, gain: float = 0.0) -> float:
    """The largest dt with |R(dt lam)| <= 1 for every lam with Re lam <= 0, where R is the factor of one step.

    For forward Euler, R = 1 + dt lam, that is dt = min -2 Re lam/|lam|^2: zero as soon as something swings without
    damping. ``gain`` is a growth rate that is forgiven: with it dt = min 2 (gain - Re lam)/|lam|^2. Infinite if all
    modes grow of themselves, or none moves.
    """
    size = np.abs(lam).max(initial=0.0)
    real = np.where(np.abs(lam.real) <= NEUTRAL * size, 0.0, lam.real)
    quiet = (real <= 0) & (np.abs(lam) > NEUTRAL * size)
    z = real[quiet] + 1j * lam.imag[quiet]
    if not z.size:
        return math.inf
    if time.order == 1:
        return float((2 * (gain - z.real) / np.abs(z) ** 2).min())
    return float((_reach(time, z / np.abs(z)) / np.abs(z)).min())


def factor(time: RungeKutta, z: np.ndarray) -> np.ndarray:
    """R(z) = 1 + z b'1 + z^2 b'A1 + ...: by what one step multiplies a mode with dt lam = z."""
    A, b = time.table
    found, power, ones = np.ones_like(z, dtype=complex), np.ones_like(z, dtype=complex), np.ones(len(b))
    for _ in b:
        power = power * z
        found = found + power * (b @ ones)
        ones = A @ ones
    return found


def _reach(time, direction):
    """How far along each direction of the left half plane R stays within the unit circle."""
    radii = np.arange(time.reach, 3 * time.reach + 1, _GRID)
    low = np.full(direction.shape, float(time.reach))
    open_ = np.ones(direction.shape, dtype=bool)
    for radius in radii:
        open_ &= np.abs(factor(time, radius * direction)) <= 1 + 1e-12
        low[open_] = radius
        if not open_.any():
            break
    high = low + _GRID
    for _ in range(40):
        middle = (low + high) / 2
        inside = np.abs(factor(time, middle * direction)) <= 1 + 1e-12
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return low
