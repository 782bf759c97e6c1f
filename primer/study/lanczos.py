"""Whether anything grows about the steady state of the toy system on a grid: a search that keeps no basis.

The quadratic problem of :mod:`primer.study.spectrum` as a first-order one, with w = (u, y) and D = diag(s)::

    lam u = D y,    lam y = -D u - B y,    L = [[0, D], [-D, -B]]

is symmetric under the form <f, g> = -f_u . g_u + f_y . g_y (no conjugate). So the inverse of L - shift is a matrix of
three diagonals in the vectors of Lanczos' recurrence: no vector needs more than the two before it, where Arnoldi's
method makes it orthogonal to all. Without that, an eigenvalue may be found twice, which does not matter here; what is
found is judged by its residual, and where the recurrence fails the answer is left to Arnoldi's method.
"""

import numpy as np

from primer.problems.toy import Toy
from primer.study.real_mode import Parity, form
from primer.study.spectrum import _DENSE, _SLOW, _packet, _shifts, depth, growth

_STEPS = 30
_RESIDUAL = 1e-9  # relative, of an eigenvalue of the inverse that counts as found
_SURE = 1e-9  # relative to |lam|: a smaller real part is left to Arnoldi's method
_BREAKDOWN = 1e-8  # of the form of a vector of length 1


def grows(toy: Toy, n: int) -> bool:
    """Whether some perturbation of the discrete steady state grows on n points, ``growth(toy, n) > 0``."""
    if depth(toy, n) <= 0:
        return False
    if n <= _DENSE or toy.eps == 0:
        return growth(toy, n) > 0
    shifts = [*_shifts(toy, n, 0.0), _SLOW, _packet(toy, n)]
    for shift in dict.fromkeys(complex(shift) for shift in shifts):
        for parity in Parity:
            _, s, diagonal, off = form(toy, n, parity)
            lam = _near(s, diagonal, off, shift, np.ones(s.size))
            if lam is None:  # the recurrence of another vector need not fail
                lam = _near(s, diagonal, off, shift, np.arange(1.0, s.size + 1))
            if lam is None or (np.abs(lam.real) < _SURE * np.abs(lam)).any():
                return growth(toy, n) > 0
            if (lam.real > 0).any():
                return True
    return False


def _near(s, diagonal, off, shift, start):
    """Eigenvalues near ``shift``; None if the recurrence failed, or found none."""
    from scipy.linalg.lapack import zgttrf, zgttrs

    m, size = diagonal.size, min(_STEPS, 2 * diagonal.size - 1)
    off = off.astype(complex)
    *factors, _ = zgttrf(off, diagonal + shift + s * s / shift, off)
    s_shift = s / shift
    u, y = np.zeros(m, dtype=complex), start / np.linalg.norm(start) + 0j
    u_old, y_old = np.zeros_like(u), np.zeros_like(y)
    form_old, back = 1.0, 0.0
    T, last = np.zeros((size, size), dtype=complex), 0.0
    for i in range(size):
        own = y @ y - u @ u
        if abs(own) < _BREAKDOWN:  # what there is so far may do
            T = T[:i, :i]
            break
        new_y = zgttrs(*factors, s_shift * u - y)[0]
        new_u = s_shift * new_y - u / shift
        T[i, i] = alpha = (new_y @ y - new_u @ u) / own
        if i:
            T[i - 1, i] = beta = back * own / form_old
            new_y -= beta * y_old
            new_u -= beta * u_old
        new_y -= alpha * y
        new_u -= alpha * u
        last = float(np.sqrt(np.vdot(new_y, new_y).real + np.vdot(new_u, new_u).real))
        if last < 1e-13 * abs(alpha):  # the space is invariant
            T = T[: i + 1, : i + 1]
            break
        if i + 1 < size:
            T[i + 1, i] = back = last
        u_old, y_old, form_old = u, y, own
        u, y = new_u / last, new_y / last
    mu, vectors = np.linalg.eig(T)
    good = np.abs(last * vectors[-1]) < _RESIDUAL * np.abs(mu)
    return shift + 1 / mu[good] if good.any() else None
