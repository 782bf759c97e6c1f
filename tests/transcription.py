"""The paper's scheme as anyone would type it from section A2.2.2: the oracle for every faster version."""

import numpy as np


def march(a, eps, n, dt, steps, dtype=np.float64):
    """Yield (u, v) after 0, 1, ... steps of central-space forward-time differences of eq. (toy-pde)."""
    pi = np.arctan(np.longdouble(1)) * 4 if dtype == np.longdouble else np.pi
    h = dtype(2 * pi / n)
    x = (-pi + (2 * pi / n) * np.arange(n)).astype(dtype)
    a, eps, dt, one, two = dtype(a), dtype(eps), dtype(dt), dtype(1), dtype(2)
    u, v, s = np.full(n, a), -np.sin(x) / two, np.sin(x)
    yield u, v
    for _ in range(steps):
        u_x = (np.roll(u, -1) - np.roll(u, 1)) * (one / (two * h))
        v_x = (np.roll(v, -1) - np.roll(v, 1)) * (one / (two * h))
        v_xx = (np.roll(v, -1) - two * v + np.roll(v, 1)) * (one / (h * h))
        u, v = u + dt * v_x, v + dt * (eps * u * v_xx + u_x - v - s)
        yield u, v


def dist(u, v, a, x):
    """Dist of eq. (toy-err)."""
    return np.sqrt((u - (a - np.cos(x))) ** 2 + v**2).max()
