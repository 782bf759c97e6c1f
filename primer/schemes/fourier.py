"""Fourier collocation: the derivative that is exact for every wave the grid can tell apart.

``FOURIER`` is the table derivative -> stencil of it (Fornberg, A Practical Guide to Pseudospectral Methods, 1996;
eq. (toy-mat) takes its multipliers to be those of the continuum):

>>> x = 2 * np.pi / 16 * np.arange(16)
>>> print(f"{FOURIER[1](np.sin(x), x[1])[0]:.12f}")  # cos 0
1.000000000000
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from primer.types import ArrayLike, Numbers

MATRIX_UP_TO = 128  # points up to which a product with a matrix costs less than the fast Fourier transforms it replaces


@dataclass(frozen=True)
class Fourier:
    """The m-th derivative, m = 1 or 2, of the trigonometric interpolant, in place of a ``Stencil``.

    Its error on smooth f falls faster than any power of h. Of the sawtooth (-1)^j on an even number of points, which
    sin(nx/2) and cos(nx/2) share, the first derivative is 0 and the second -(n/2)^2 times it.
    """

    derivative: int
    order = math.inf

    def __call__(self, f: np.ndarray, h: float) -> np.ndarray:
        """Apply it to samples f of shape (..., n) of a periodic function on a grid of spacing h = 2 pi/n."""
        n = f.shape[-1]
        f = f - f[..., :1]  # exact for a constant, and so less rounding for a large mean
        if n <= MATRIX_UP_TO:
            return f @ self.matrix(n)
        factors = (1j * np.arange(n // 2 + 1)) ** self.derivative
        if n % 2 == 0 and self.derivative == 1:
            factors[-1] = 0
        return np.fft.irfft(factors * np.fft.rfft(f), n)

    def multiplier(self, xi: ArrayLike, h: float) -> Numbers:
        """What it does to e^{i xi x}: (i xi)^m, for |xi| h < pi; complex, of the shape of xi."""
        return (1j * np.asarray(xi)) ** self.derivative

    @lru_cache(maxsize=64)  # noqa: B019  (there are two of these objects, and they live for ever)
    def matrix(self, n: int) -> np.ndarray:
        """The same derivative as a matrix: ``f @ matrix(n)``, of shape (n, n) and read-only, in closed form.

        See e.g. L. N. Trefethen, "Spectral Methods in MATLAB", SIAM 2000, chapter 3 (even n) and its exercises (odd n).
        """
        j = np.arange(1, (n + 1) // 2)  # half way round; the other half follows by symmetry, to the bit
        half, sign = math.pi / n * j, (-1.0) ** j
        odd = n % 2
        if self.derivative == 1:
            flank = sign / 2 / (np.sin(half) if odd else np.tan(half))
            row = np.concatenate([[0], flank, [0] * (1 - odd), -flank[::-1]])
        else:
            flank = -sign / 2 / np.sin(half) / (np.tan(half) if odd else np.sin(half))
            far = [] if odd else [-0.5 * (-1) ** (n // 2)]
            row = np.concatenate([[-(n * n - 1) / 12 if odd else -(n * n + 2) / 12], flank, far, flank[::-1]])
        j = np.arange(n)
        matrix = row[(j - j[:, None]) % n]
        matrix.flags.writeable = False
        return matrix


#: Derivatives 1 and 2, in place of the table ``CENTRAL`` of differences.
FOURIER = {1: Fourier(1), 2: Fourier(2)}


def interpolate(f: np.ndarray, x: ArrayLike) -> np.ndarray:
    """The trigonometric interpolant at x of samples f, of shape (..., n), on the grid -pi + 2 pi j/n.

    Returns
    -------
    array of shape (...) + the shape of x
    """
    n, x = f.shape[-1], np.asarray(x, dtype=float)
    waves = np.exp(1j * np.arange(n // 2 + 1) * (x[..., None] + math.pi))
    amplitudes = np.fft.rfft(f) / n
    amplitudes[..., 1 : (n + 1) // 2] *= 2  # the wave and its conjugate; the mean and the sawtooth stand alone
    return np.tensordot(amplitudes.real, waves.real, (-1, -1)) - np.tensordot(amplitudes.imag, waves.imag, (-1, -1))


@lru_cache(maxsize=64)
def transfer(n, points):
    """The matrix of shape (n, points) that takes samples on n points to their interpolant on other points."""
    matrix = interpolate(np.eye(n), -math.pi + 2 * math.pi / points * np.arange(points))
    matrix.flags.writeable = False
    return matrix
