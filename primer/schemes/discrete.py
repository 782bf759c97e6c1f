"""What the scheme does exactly: its own steady state, the floor it leaves in Dist, and each mode's growth per step."""

import math

import numpy as np

from primer.arithmetic import constant, cos
from primer.checks import instance, real, shown
from primer.problems.toy import Toy
from primer.schemes.grid import Grid


def discrete_steady(toy, x, h):
    """(u, v) of the steady state of the central differences: u = a - (h/sin h) cos x, v = 0.

    A central first difference turns cos x into -(sin h/h) sin x; u must make up for it. It differs from eq.
    (toy-steady) by h^2/6 to leading order.
    """
    instance("toy", toy, Toy)
    h = real("h", h, above=0, below=math.pi)
    return toy.a - (h / math.sin(h)) * cos(x), constant(x, 0)


def dist_floor(n):
    """h/sin h - 1 with h = 2 pi/n, n >= 4: the Dist of eq. (toy-err) on which a converged run comes to rest.

    It is attained at x = -pi, a point of every grid, and is h^2/6 to leading order.
    """
    h = Grid(n).h
    return h / math.sin(h) - 1


def amplification(symbol, dt):
    """Factors by which one step of forward Euler multiplies the modes of a symbol: the eigenvalues of 1 + dt S.

    Parameters
    ----------
    symbol : (..., m, m) array    such as ``toy.symbol(xi, u, multiplier=grid.multiplier)``
    dt : float                    step, dt > 0

    Returns
    -------
    complex array of shape (..., m), with the largest modulus first
    """
    dt = real("dt", dt, above=0)
    try:
        S = np.asarray(symbol, dtype=complex)
    except (TypeError, ValueError):
        raise TypeError(f"symbol must be an array of numbers, got {shown(symbol)}") from None
    if S.ndim < 2 or S.shape[-1] != S.shape[-2] or not S.shape[-1]:
        raise ValueError(f"symbol must have shape (..., m, m), got {S.shape}")
    if not np.isfinite(S).all():
        raise ValueError(f"symbol must be finite everywhere, got {shown(symbol)}")
    factors = 1 + dt * np.linalg.eigvals(S)
    return np.take_along_axis(factors, np.argsort(-np.abs(factors), axis=-1), axis=-1)
