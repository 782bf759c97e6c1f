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

from primer.equations.terms import DERIVATIVE
from primer.types import ArrayLike, Numbers

MATRIX_UP_TO = 192  # points up to which a product with a matrix costs less than the fast Fourier transforms it replaces


@dataclass(frozen=True)
class Fourier:
    """The m-th derivative of the trigonometric interpolant, in place of a ``Stencil``.

    Its error on smooth f falls faster than any power of h. Of the sawtooth (-1)^j on an even number of points, which
    sin(nx/2) and cos(nx/2) share, an odd derivative is 0 and an even one (-1)^(m/2) (n/2)^m times it, at period 2 pi.
    """

    derivative: int
    order = math.inf

    def __call__(self, f: np.ndarray, h: float) -> np.ndarray:
        """Apply it to samples f of shape (..., n), real or complex, of a function of period n h."""
        n = f.shape[-1]
        f = f - f[..., :1]  # exact for a constant, and so less rounding for a large mean
        if n <= MATRIX_UP_TO:
            found = f @ self.matrix(n)
        else:
            transform, inverse = (np.fft.fft, np.fft.ifft) if f.dtype.kind == "c" else (np.fft.rfft, np.fft.irfft)
            waves = np.fft.fftfreq(n, 1 / n) if f.dtype.kind == "c" else np.arange(n // 2 + 1)
            factors = (1j * waves) ** self.derivative
            if n % 2 == 0 and self.derivative % 2:
                factors[n // 2] = 0
            found = inverse(factors * transform(f), n)
        return found if h == 2 * math.pi / n else found * (2 * math.pi / (n * h)) ** self.derivative

    def multiplier(self, xi: ArrayLike, h: float) -> Numbers:
        """What it does to e^{i xi x}: (i xi)^m, for |xi| h < pi; complex, of the shape of xi."""
        return (1j * np.asarray(xi)) ** self.derivative

    @lru_cache(maxsize=64)  # noqa: B019  (there are twelve of these objects, and they live for ever)
    def matrix(self, n: int) -> np.ndarray:
        """The same derivative as a matrix, at period 2 pi: ``f @ matrix(n)``, of shape (n, n) and read-only.

        For m = 1 and 2 in closed form, see e.g. L. N. Trefethen, "Spectral Methods in MATLAB", SIAM 2000, chapter 3
        (even n) and its exercises (odd n).
        """
        j = np.arange(n)
        matrix = self._row(n)[(j - j[:, None]) % n]
        matrix.flags.writeable = False
        return matrix

    def _row(self, n):
        """The derivative at the points 0, h, 2h, ... of the interpolant that is 1 at 0 and 0 at the others."""
        m, odd = self.derivative, n % 2
        j = np.arange(1, (n + 1) // 2)  # half way round; the other half follows by symmetry, to the bit
        half, sign = math.pi / n * j, (-1.0) ** j
        if m == 1:
            flank = sign / 2 / (np.sin(half) if odd else np.tan(half))
            return np.concatenate([[0], flank, [0] * (1 - odd), -flank[::-1]])
        if m == 2:
            flank = -sign / 2 / np.sin(half) / (np.tan(half) if odd else np.sin(half))
            far = [] if odd else [-0.5 * (-1) ** (n // 2)]
            return np.concatenate([[-(n * n - 1) / 12 if odd else -(n * n + 2) / 12], flank, far, flank[::-1]])
        k = np.arange(1, n // 2 + 1)
        angle = 2 * math.pi / n * (np.outer(np.arange(n // 2 + 1), k) % n)
        waves = (np.sin if m % 2 else np.cos)(angle) * (2.0 / n) * (-1.0) ** ((m + 1) // 2)
        if not odd:
            waves[:, -1] /= 2
            waves[:, -1] *= 1 - m % 2
        first = np.array([math.fsum(terms) for terms in waves * k.astype(float) ** m])
        return np.concatenate([first, (-1) ** m * first[1 : (n + 1) // 2][::-1]])


#: Derivatives 1 to 12, in place of the table ``CENTRAL`` of differences.
FOURIER = {m: Fourier(m) for m in range(1, DERIVATIVE + 1)}


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
