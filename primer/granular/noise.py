"""The same small noise under a law on several grids: no time stepping, one small matrix exponential per wavevector."""

from dataclasses import dataclass

import numpy as np

from primer.checks import integer, real
from primer.granular.dispersion import growth_rate
from primer.granular.linearisation import coefficients, reduced

_PARTS = 10  # the growth is measured over the last of this many parts of the time


@dataclass(frozen=True, eq=False)
class Noise:
    """Small noise on a doubly periodic square, after a time t under frozen coefficients, on one grid.

    Attributes
    ----------
    n : int                          grid points along each side
    t : float                        time
    before, after : (3, n, n)        (u_1, u_2, phi) at times 0 and t, perturbations; axis 1 is x_1, axis 2 is x_2
    gain : float                     r.m.s. velocity at t over that at 0
    measured : float                 the growth rate of the r.m.s. velocity over the last tenth of t
    predicted : float                the largest growth rate of the symbol over the grid's wavevectors
    """

    n: int
    t: float
    before: np.ndarray
    after: np.ndarray
    gain: float
    measured: float
    predicted: float


def noise_after(law, state, n, t, side=200.0, seed=1, smooth=4.0):
    """What a law makes of noise: the ``Noise`` on the n x n grid at time t.

    The noise is a sum of Fourier modes whose amplitudes depend on the seed and the wavevector alone, so that a finer
    grid adds modes and changes none. A velocity that must be free of divergence is projected.

    Parameters
    ----------
    law, state     as in ``linearise``, a single state
    n : int        even, >= 4; wavevectors (2 pi/side) m with |m_1|, |m_2| < n/2
    t : float      time > 0
    side : float   the side of the square, in the units of d
    seed : int     of the noise
    smooth : float amplitudes fall like |m|^-smooth
    """
    n, t, side = integer("n", n, least=4), real("t", t, above=0), real("side", side, above=0)
    c = coefficients(law, state)
    m = np.fft.fftfreq(n, 1 / n)
    xi = 2 * np.pi / side * np.stack(np.meshgrid(m, m, indexing="ij"))
    q = modes(n, seed, smooth)
    moving = np.abs(q).any(axis=0)
    if c.incompressible:
        step, value = _step_incompressible(c, xi[:, moving], q[:, moving], t / _PARTS)
    else:
        from scipy.linalg import expm

        step, value = expm(-reduced(c, xi[:, moving]) * (t / _PARTS)), q[:, moving].T
    values = [value]
    for _ in range(_PARTS):
        values.append((step @ values[-1][..., None])[..., 0])
    fields = []
    for value in (values[0], values[-2], values[-1]):
        spectrum = np.zeros_like(q)
        spectrum[:, moving] = value.T
        fields.append(np.fft.ifft2(spectrum, norm="forward").real)
    size = [np.sqrt((field[:2] ** 2).mean()) for field in fields]
    k = np.hypot(*xi[:, moving])
    x = (xi[0, moving] ** 2 - xi[1, moving] ** 2) / k**2
    return Noise(
        n=n,
        t=t,
        before=fields[0],
        after=fields[2],
        gain=size[2] / size[0],
        measured=np.log(size[2] / size[1]) * _PARTS / t,
        predicted=float(growth_rate(c, k, x).max()),
    )


def modes(n, seed, smooth):
    """Fourier coefficients of (u_1, u_2, phi), complex of shape (3, n, n) in the order of the FFT.

    The field is the real part. They are drawn shell by shell, max(|m_1|, |m_2|) = 1, 2, ..., n/2 - 1, each from its own
    stream.
    """
    m = np.fft.fftfreq(n, 1 / n).astype(int)
    shell = np.maximum(np.abs(m[:, None]), np.abs(m))
    q = np.zeros((3, n, n), dtype=complex)
    for s in range(1, n // 2):
        i, j = (m[index] for index in np.nonzero(shell == s))
        order = np.lexsort((j, i))  # the same order of the modes on every grid
        draw = np.random.default_rng([seed, s]).normal(size=(2, 3, i.size))
        q[:, i[order], j[order]] = (draw[0] + 1j * draw[1]) * np.hypot(i, j)[order] ** -smooth
    return q


def _step_incompressible(c, xi, q, t):
    """The step of length t as matrices (modes, 3, 3), and the noise with its divergence taken out."""
    k = np.hypot(*xi)
    across = np.stack([-xi[1], xi[0]]) / k
    start = q.T.copy()
    start[:, :2] = ((across * q[:2]).sum(axis=0) * across).T
    x = (xi[0] ** 2 - xi[1] ** 2) / k**2
    step = np.zeros((k.size, 3, 3))
    step[:, 0, 0] = step[:, 1, 1] = np.exp(growth_rate(c, k, x) * t)
    step[:, 2, 2] = 1
    return step, start
