"""The norms of BC^k, in which the paper asks for continuous dependence (section A2.1): the largest derivative up to k.

A well-posed problem carries BC^k into BC^0, continuously, for *some* k: it may lose a fixed number of derivatives.
Where growth has no bound no k is enough: e^{-sqrt n} sin(n x) tends to 0 in every BC^k as n -> infinity, and what
u_t = -u_xx, eq. (backward-heat), makes of it grows like e^{n^2 t - sqrt n}.
"""

import numpy as np

from primer.checks import integer, real_array


def bc_norm(samples, k=0):
    """max over j <= k of the largest |d^j f/dx^j| on the grid, for f of period 2 pi; samples of shape (..., n).

    The derivatives are those of the trigonometric polynomial through the samples: exact, to rounding, for waves below
    n/2. The supremum is over the n points, so it may fall short of that between them.

    Raises
    ------
    TypeError, ValueError    if samples are not real numbers, two or more, or k not an integer >= 0

    >>> x = np.arange(64) * 2 * np.pi / 64
    >>> print(f"{bc_norm(np.sin(4 * x), 2):.6f}")
    16.000000
    """
    f, k = real_array("samples", samples), integer("k", k, least=0, most=20)
    n = f.shape[-1] if f.ndim else 0
    if n < 2:
        raise ValueError(f"samples must have shape (..., n) with n >= 2, got {f.shape}")
    waves, coefficients = 1j * np.arange(n // 2 + 1), np.fft.rfft(f)
    if n % 2 == 0:
        coefficients[..., -1] *= k == 0  # the sawtooth has no derivative on the grid
    sizes = [np.abs(f).max(axis=-1)]
    sizes += [np.abs(np.fft.irfft(coefficients * waves**j, n)).max(axis=-1) for j in range(1, k + 1)]
    return np.max(sizes, axis=0)


def log_hadamard(n, k=0, t=0.0):
    """ln of the BC^k norm at time t of what u_t = -u_xx makes of e^{-sqrt n} sin(n x): k ln n + n^2 t - sqrt n.

    A logarithm, since the norm itself has more digits than a double. n >= 1 a whole number, or an array of them.
    """
    n, k, t = real_array("n", n), integer("k", k, least=0), real_array("t", t)
    if not (n >= 1).all() or not (n == np.floor(n)).all():
        raise ValueError(f"n must be whole numbers >= 1, got {n.min():g} the least")
    return k * np.log(n) + n**2 * t - np.sqrt(n)
