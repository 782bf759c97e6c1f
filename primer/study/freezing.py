"""Where frozen coefficients lie: w_t = i w_xx + i beta(x) w_x on a circle, beta real.

Frozen at x it is ill posed: Re lambda = -beta(x) xi. But with B' = beta and w = z e^{-B/2}::

    z_t = i z_xx - i (beta'/2 + beta^2/4) z

conserves the L2 norm of z. Where the mean of beta is 0, B is periodic and the equation well posed: a wave passes places
where it grows and places where it decays, the faster the shorter it is, and the two cancel. Where the mean is b, a term
i b z_x stays behind, and it is ill posed: Re lambda ~ |b| |xi|. Here beta = b + c cos x.
Source: S. Mizohata, *On the Cauchy Problem* (1985); H.-O. Kreiss, J. Lorenz, *Initial-Boundary Value Problems and the
Navier-Stokes Equations* (1989).
"""

import numpy as np

from primer.checks import affordable, integer, real, shown
from primer.schemes.grid import Grid


def central(n, c=3.0, b=0.0):
    """(n, n) matrix of central differences on ``Grid(n)``: i D_2 + i beta D_1."""
    grid, c, b = _asked(n, c, b)
    eye = np.eye(grid.n)
    first, second = (grid.derivative(eye, m).T for m in (1, 2))
    return 1j * second + 1j * (b + c * np.cos(grid.x))[:, None] * first


def galerkin(n, c=3.0, b=0.0):
    """(n, n) matrix on the waves e^{ikx}, k = -n//2 ... : the equation, and whatever leaves these waves thrown away.

    i beta w_x takes e^{ikx} to -k (b e^{ikx} + c/2 e^{i(k+1)x} + c/2 e^{i(k-1)x}).
    """
    grid, c, b = _asked(n, c, b)
    k = np.arange(grid.n) - grid.n // 2
    return np.diag(-1j * k**2 - b * k) - c / 2 * (np.diag(k[:-1], -1) + np.diag(k[1:], 1))


def fastest(matrix):
    """The largest real part of an eigenvalue: at what rate the fastest mode of w' = A w grows."""
    return float(np.linalg.eigvals(np.asarray(matrix)).real.max())


def solution(w, t, c=3.0):
    """w(x, t) on ``Grid(n)`` from samples ``w`` (n,), for beta = c cos x: by way of z, whose norm is conserved.

    z_t = -i H z with H Hermitian on any grid, by Fourier collocation: nothing can grow, and the error falls faster than
    any power of 1/n for smooth data.
    """
    w = np.asarray(w, dtype=complex)
    if w.ndim != 1:
        raise ValueError(f"w must have shape (n,), got {w.shape}")
    grid, c, _ = _asked(w.size, c, 0.0)
    t, x, k = real("t", t), grid.x, np.fft.fftfreq(grid.n, 1 / grid.n)
    waves = np.fft.fft(np.eye(grid.n), axis=0, norm="ortho")
    H = (waves.conj().T * k**2) @ waves + np.diag(-c * np.sin(x) / 2 + (c * np.cos(x)) ** 2 / 4)
    rates, modes = np.linalg.eigh((H + H.conj().T) / 2)
    turn = np.exp(c * np.sin(x) / 2)
    return modes @ (np.exp(-1j * rates * t) * (modes.conj().T @ (w * turn))) / turn


def powers(G, steps):
    """Norms of G, G^2, ..., G^steps: Lax and Richtmyer ask for a bound on all of them, for all dt and h, not on |g|.

    G of shape (..., m, m), the amplification of each wave; returns (steps, ...), spectral norms.
    """
    G, steps = np.asarray(G), integer("steps", steps, least=1)
    if G.ndim < 2 or G.shape[-1] != G.shape[-2]:
        raise ValueError(f"G must have shape (..., m, m), got {G.shape}")
    affordable("steps and G", 16.0 * steps * G.size, f"{shown(steps)} and shape {G.shape}")
    found, power = [], np.broadcast_to(np.eye(G.shape[-1]), G.shape)
    for _ in range(steps):
        power = power @ G
        found.append(np.linalg.norm(power, 2, axis=(-2, -1)))
    return np.array(found)


def lax_friedrichs(theta, ratio, couple=1.0):
    """Amplification of u_t = u_x + couple v_x, v_t = v_x by Lax and Friedrichs' scheme; (..., 2, 2).

    theta = xi h is the angle of a wave, ratio = dt/h <= 1. Both eigenvalues: cos theta + i ratio sin theta.
    """
    theta, ratio, couple = np.asarray(theta, dtype=float), real("ratio", ratio, above=0), real("couple", couple)
    G = np.zeros((*theta.shape, 2, 2), dtype=complex)
    G[..., 0, 0] = G[..., 1, 1] = np.cos(theta) + 1j * ratio * np.sin(theta)
    G[..., 0, 1] = 1j * ratio * couple * np.sin(theta)
    return G


def _asked(n, c, b):
    grid = Grid(n)
    affordable("n", 64.0 * grid.n**2, f"{grid.n}")
    return grid, real("c", c), real("b", b)
