"""The same small noise under a law on several grids: no time stepping, one small matrix exponential per wavevector."""

from dataclasses import dataclass

import numpy as np

from primer.checks import affordable, integer, real, shown
from primer.granular.dispersion import growth_rate
from primer.granular.linearisation import coefficients, reduced

_LARGEST = 1e20  # of a wavenumber: its powers must be finite
_NEAR = 5.37  # norm up to which the rational approximation of order 13 to e^z is exact to rounding (Higham 2005)
_HIGHAM = (64764752532480000, 32382376266240000, 7771770303897600, 1187353796428800, 129060195264000, 10559470521600,
           670442572800, 33522128640, 1323241920, 40840800, 960960, 16380, 182, 1)  # fmt: skip
_PARTS = 10  # the growth is measured over the last of this many parts of the time


@dataclass(frozen=True, eq=False)
class Noise:
    """Small noise on a doubly periodic square, after a time t under frozen coefficients, on one grid.

    Attributes
    ----------
    n : int                          grid points along each side
    t, side : float                  the time, and the side of the square
    before, after : (3, n, n)        (u_1, u_2, phi) at times 0 and t; axis 1 is x_1, axis 2 is x_2
    gain : float                     r.m.s. velocity at t over that at 0
    k : array                        wavenumbers, one for each shell of modes of like |m|
    measured : array                 on each shell the fastest growth of a mode's velocity over the last tenth of t
    predicted : array                on each shell the largest growth rate of the symbol
    """

    n: int
    t: float
    side: float
    before: np.ndarray
    after: np.ndarray
    gain: float
    k: np.ndarray
    measured: np.ndarray
    predicted: np.ndarray


def noise_after(law, state, n, t, side=200.0, seed=1, smooth=2.5):
    """What a law makes of noise: the ``Noise`` on the n x n grid at time t.

    The noise is a sum of Fourier modes whose amplitudes depend on the seed and the wavevector alone, so that a finer
    grid adds modes and changes none. Velocities are of the size of ||D|| d, phi of 1/1000; the equations are linear, so
    only this ratio matters. A velocity that must be free of divergence is projected.

    Parameters
    ----------
    law, state     as in ``linearise``, a single state
    n : int        even, >= 4; wavevectors (2 pi/side) m with |m_1|, |m_2| < n/2
    t : float      time > 0
    side : float   the side of the square, in units of length
    seed : int     of the noise
    smooth : float amplitudes fall like |m|^-smooth, -10 <= smooth <= 10
    """
    n, t, side = integer("n", n, least=4), real("t", t, above=0), real("side", side, above=0)
    seed, smooth = integer("seed", seed, least=0), real("smooth", smooth, least=-10, most=10)
    if n % 2:
        raise ValueError(f"n must be even, got {n}")
    affordable("n: the matrices of all modes", 2000 * n**2, f"n = {shown(n)}")
    c = coefficients(law, state)
    if state.shape != ():
        raise ValueError(f"state must be a single state, got shape {state.shape}")
    if np.pi * n / side > _LARGEST:
        raise ValueError(f"side must be >= pi n/{_LARGEST:g}, got {side:g} with n = {n}")
    q = modes(n, seed, smooth) * np.array([state.D * state.d, state.D * state.d, 1e-3])[:, None, None]
    moving = np.abs(q).any(axis=0)
    m = np.stack(np.meshgrid(*[np.fft.fftfreq(n, 1 / n)] * 2, indexing="ij"))[:, moving]
    xi = 2 * np.pi / side * m
    with np.errstate(over="ignore", invalid="ignore"):
        if c.incompressible:
            step, value = _step_incompressible(c, xi, q[:, moving], t / _PARTS)
        else:
            step, value = _exponentials(-reduced(c, xi) * (t / _PARTS)), q[:, moving].T
        values = [value]
        for _ in range(_PARTS):
            values.append((step @ values[-1][..., None])[..., 0])
    if not np.isfinite(values).all():
        raise ValueError(f"t must be short enough for the noise to stay finite, got {t:g}")
    before, after = (_field(n, moving, v) for v in (values[0], values[-1]))
    k, speeds = np.hypot(*xi), [np.linalg.norm(v[:, :2], axis=1) for v in values[-2:]]
    alive = (speeds[0] > 0) & (speeds[1] > 0)  # a mode damped below the smallest number has no rate left to measure
    rates = np.full(k.shape, -np.inf)
    rates[alive] = np.log(speeds[1][alive] / speeds[0][alive]) * _PARTS / t
    symbol = growth_rate(c, k, (xi[0] ** 2 - xi[1] ** 2) / k**2)
    shell = np.round(np.hypot(*m)).astype(int)
    shells = np.unique(shell)
    return Noise(
        n=n,
        t=t,
        side=side,
        before=before,
        after=after,
        gain=_rms(after[:2]) / _rms(before[:2]),
        k=2 * np.pi / side * shells,
        measured=np.array([rates[shell == s].max() for s in shells]),
        predicted=np.array([symbol[shell == s].max() for s in shells]),
    )


def _exponentials(A):
    """exp(A) of many small matrices (..., m, m) at once, by scaling, Pade's approximation and squaring.

    N. J. Higham, SIAM J. Matrix Anal. Appl. 26 (2005), Algorithm 2.3 with order 13. One by one, as scipy does
    them, they take five times as long, and far longer where each sets threads of BLAS in motion.
    """
    norm = np.abs(A).sum(axis=-2).max(axis=-1)
    times = np.ceil(np.log2(np.maximum(np.where(np.isfinite(norm), norm, 0.0) / _NEAR, 1.0))).astype(int)
    A = A * np.exp2(-times.astype(float))[..., None, None]
    square, power = A @ A, np.eye(A.shape[-1])
    odd = even = np.zeros_like(A)
    for b_even, b_odd in zip(_HIGHAM[::2], _HIGHAM[1::2], strict=True):
        odd, even, power = odd + b_odd * power, even + b_even * power, power @ square
    odd = A @ odd
    found = np.linalg.solve(even - odd, even + odd)
    for done in range(times.max(initial=0)):
        more = times > done
        found[more] = found[more] @ found[more]
    return found


def _field(n, moving, value):
    spectrum = np.zeros((3, n, n), dtype=complex)
    spectrum[:, moving] = value.T
    return np.fft.ifft2(spectrum, norm="forward").real


def _rms(v):
    top = np.abs(v).max()
    return top * np.sqrt(((v / top) ** 2).mean())


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
