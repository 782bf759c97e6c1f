"""The spectrum of the toy system on a grid: small perturbations about the steady state of the central differences.

With U = a - c cos x, c = h/sin h, V = 0 (:func:`primer.schemes.discrete.discrete_steady`) the linearised system is::

    u_t = D1 v,    v_t = D1 u - v + eps U D2 v

The differences are diagonal in e^{ikx}, with s = sin(kh)/h and k2 = (4/h^2) sin^2(kh/2), and cos x couples only
neighbours k and k + 1. So in y = sqrt(k2) v, split by parity about x = 0, growth rates lam are those of a small
symmetric tridiagonal problem::

    [lam^2 + lam (1 + eps A) + s^2] y = 0,    A = sqrt(k2) U sqrt(k2)

The numerical range of the quadratic says at once that Re lam <= -min eig(1 + eps A) wherever that is positive, and
hence that nothing grows unless ``depth`` Q = 4 eps (c - a)/h^2 - 1 > 0: the frozen estimate is a lower bound.

Left out as exactly neutral, lam = 0: the constant u, and on an even number of points the sawtooth of u, to which D1 is
blind.
"""

import math
from dataclasses import dataclass, field

import numpy as np

from primer.checks import affordable, instance, real
from primer.problems.toy import Toy
from primer.schemes.discrete import discrete_steady
from primer.schemes.grid import Grid
from primer.study.real_mode import Parity, form, surely_fastest

_BYTES = 600  # for each point, of the 31 complex vectors of a search
_SLOW = 1e-3  # no eigenvalue where all decay, and nearer to those of slow decay than to others
_DENSE = 100  # points up to which all eigenvalues cost less than a few of them


@dataclass(frozen=True, eq=False)
class Mode:
    """The fastest growing perturbation on a grid, proportional to e^{lam t}.

    Attributes
    ----------
    n, x      the grid
    lam       complex growth rate, Im lam >= 0
    parity    its symmetry about x = 0
    u, v      (n,) complex fields, scaled to max |v| = 1; the real part is a perturbation
    """

    def content(self, u, v):
        """How much of this mode there is in a small perturbation (u, v): it grows to 2 Re(content e^{lam t} mode).

        The projection is by the mode itself, under a form that makes the Jacobian symmetric::

            <f, g> = sum f_v D2 g_v - f_u D2 g_u

        If lam is real, the factor 2 is not there.
        """
        return self._form(u, v) / self._form(self.u, self.v)

    def _form(self, u, v):
        second = Grid(self.n).derivative(np.stack((u, v)), 2)
        return self.v @ second[1] - self.u @ second[0]

    n: int
    lam: complex
    parity: Parity
    x: np.ndarray = field(repr=False)
    u: np.ndarray = field(repr=False)
    v: np.ndarray = field(repr=False)


def jacobian(toy, n, state=None):
    """The (2n, 2n) Jacobian of the semi-discrete system, u first, about ``state``, by default its steady state."""
    instance("toy", toy, Toy)
    grid = Grid(n)
    affordable("n: the Jacobian", 80 * grid.n**2, f"n = {grid.n}")
    u, v = discrete_steady(toy, grid.x, grid.h) if state is None else state
    d1, d2 = (grid.derivative(np.eye(grid.n), m).T for m in (1, 2))
    v_xx = grid.derivative(np.asarray(v, dtype=float), 2)
    zero = np.zeros_like(d1)
    return np.block([[zero, d1], [d1 + toy.eps * np.diag(v_xx), toy.eps * np.asarray(u)[:, None] * d2 - np.eye(n)]])


def depth(toy, n):
    """Q = 4 eps (c - a)/h^2 - 1: the frozen growth of the sawtooth of v at x = 0; nothing grows unless Q > 0."""
    instance("toy", toy, Toy)
    h = Grid(n).h
    return 4 * toy.eps * (h / math.sin(h) - toy.a) / h**2 - 1


def fastest(toy, n, dt=0.0):
    """The :class:`Mode` that grows fastest about the discrete steady state, marched by the scheme with step dt.

    With dt = 0 time is continuous. A mode that grows with dt but not without it is of the scheme.
    """
    return _mode(toy, n, *_spectrum(toy, n, dt)[0])


def growing(toy, n, dt=0.0):
    """All modes that grow, the fastest first; the fastest alone if none does.

    On more than 100 points it is those near the places where a mode can be the fastest.
    """
    first, *others = _spectrum(toy, n, dt)
    return tuple(_mode(toy, n, *each) for each in [first, *(one for one in others if rate(one[0], dt) > 0)])


def growth(toy, n, dt=0.0):
    """The :func:`rate` of the :func:`fastest` mode. Dimensionless."""
    return float(rate(leader(toy, n, dt)[0], dt))


def leader(toy, n, dt=0.0):
    """(lam, k) of the :func:`fastest` mode: k is the number of its strongest wave in v. Often quicker."""
    instance("toy", toy, Toy)
    n, dt = Grid(n).n, real("dt", dt, least=0)
    lam, parity, y = surely_fastest(toy, n, dt) or _spectrum(toy, n, dt)[0]
    k = form(toy, n, parity)[0]
    return complex(lam), int(k[np.argmax(np.abs(y) / np.sin(k * np.pi / n))])


def rate(lam, dt=0.0):
    """ln|1 + dt lam|/dt, the growth per unit time that steps of dt make of a growth rate lam; Re lam for dt = 0."""
    return np.log(np.abs(1 + dt * lam)) / dt if dt else np.real(lam)


def _spectrum(toy, n, dt):
    """(lam, parity, y) of the eigenvalues found, Im lam >= 0, those of the largest rate first."""
    instance("toy", toy, Toy)
    n, dt = Grid(n).n, real("dt", dt, least=0)
    affordable("n: the search for eigenvalues", _BYTES * n, f"n = {n}")
    found = []
    for parity in Parity:
        for lam, y in zip(*_of_parity(toy, n, parity, dt), strict=True):
            found.append((lam, parity, y) if lam.imag >= 0 else (lam.conj(), parity, y.conj()))
    return sorted(found, key=lambda each: rate(each[0], dt), reverse=True)


def _of_parity(toy, n, parity, dt):
    """(lam, y): the eigenvalues of one parity, (m,), and their y, (m, number of wavenumbers)."""
    _, s, diagonal, off = form(toy, n, parity)
    s = s[s > 0]
    if toy.eps == 0:  # every wavenumber by itself
        lam, vectors = np.sqrt(0.25 - s**2 + 0j) - 0.5, np.eye(s.size + diagonal.size, s.size, k=-s.size)
    elif n <= _DENSE:
        size = s.size + diagonal.size
        matrix = np.zeros((size, size))
        matrix[range(s.size), range(s.size, 2 * s.size)] = s
        matrix[range(s.size, 2 * s.size), range(s.size)] = -s
        matrix[s.size :, s.size :] = -(np.diag(diagonal) + np.diag(off, 1) + np.diag(off, -1))
        lam, vectors = np.linalg.eig(matrix)
        lam, vectors = lam[lam.imag >= 0], vectors[:, lam.imag >= 0]  # the others are their conjugates
    else:
        found = [_near(s, diagonal, off, shift) for shift in _shifts(toy, n, dt)]
        if max(rate(lam, dt).max() for lam, _ in found) < 0:  # what decays last is near the sawtooth, or a packet
            found += [_near(s, diagonal, off, shift) for shift in (_SLOW, _packet(toy, n))]
        lam, vectors = (np.concatenate(part, axis=-1) for part in zip(*found, strict=True))
    return lam, vectors[s.size :].T


def _mode(toy, n, lam, parity, y):
    """The :class:`Mode` of an eigenvalue."""
    grid, (k, s, _, _) = Grid(n), form(toy, n, parity)
    half = 2 * np.sin(k * grid.h / 2) / grid.h
    y = y / half
    v = np.zeros(n, dtype=complex)
    v[k] = y * (-1.0) ** k  # x = -pi + j h
    if parity is Parity.OPPOSITE:
        if s[-1] == 0:
            v[k[-1]] /= math.sqrt(2)  # the sawtooth's norm on the grid is sqrt(2) times that of the other cosines
        # The mean of v drives nothing and is driven by cos x times the first harmonic.
        v[0] = toy.eps * grid.h / math.sin(grid.h) / 2 * half[0] ** 2 * y[0] / (lam + 1)
        v = np.fft.fft(v) + n * np.fft.ifft(v)
    else:
        v = n * np.fft.ifft(v) - np.fft.fft(v)
    v = v / v[np.argmax(np.abs(v))]
    return Mode(n, complex(lam), parity, grid.x, grid.derivative(v, 1) / lam, v)


def _shifts(toy, n, dt):
    """Where to look for the eigenvalues that grow fastest.

    The two places where a wave packet at x = 0 does not drift: near the sawtooth, v = (-1)^j w(x) with
    w'' + lam (Q - lam - K x^2) w = 0, K = 2 eps c/h^2, so that the ground state has sqrt(lam) (Q - lam) = sqrt(K); and
    near k = n/4, where s = 1/h is largest, lam = i/h + (Q - 1)/4 to leading order, from which the finite width of a
    packet takes away. And with a finite step the two bounds of :mod:`primer.study.stability`: the wave that is first to
    grow at x = 0, and the stiffest mode, the sawtooth at x = -pi.
    """
    h, Q = Grid(n).h, depth(toy, n)
    K = 2 * toy.eps / (h * math.sin(h))
    roots = np.roots([1, 0, -Q, math.sqrt(K)])
    shifts = [complex(lam.real, abs(lam.imag)) for lam in sorted(roots[roots.real > 1e-9] ** 2, key=np.real)[-1:]]
    if Q > 0.8 or dt:
        shifts.append(_packet(toy, n))
    if dt:
        S = 1 / (1 + math.sqrt(max(-Q, 0)))
        b = 1 - (Q + 1) * S
        shifts.append(complex(-b / 2, math.sqrt(abs(4 * S * (1 - S) / h**2 - b * b / 4)) + 1e-3))
        shifts.append(complex(-1 - 4 * toy.eps * (toy.a + h / math.sin(h)) / h**2))
    return shifts


def _packet(toy, n):
    return complex(depth(toy, n) - 1, 4 / Grid(n).h) / 4


def _near(s, diagonal, off, shift, steps=30):
    """(lam, vectors): eigenvalues near ``shift`` by Arnoldi's method on the inverse, each solve a tridiagonal one."""
    from scipy.linalg.lapack import zgttrf, zgttrs

    m, r = diagonal.size, s.size
    steps = min(steps, m + r - 1)
    s_all = np.zeros(m)
    s_all[:r] = s
    *factors, _ = zgttrf(off.astype(complex), diagonal + shift + s_all**2 / shift, off.astype(complex))
    basis, H = np.zeros((steps + 1, r + m), dtype=complex), np.zeros((steps + 1, steps), dtype=complex)
    basis[0] = 1 / math.sqrt(r + m)
    for i in range(steps):
        b_u, b_v = basis[i, :r], basis[i, r:]
        right = -b_v
        right[:r] += s * b_u / shift
        y = zgttrs(*factors, right)[0]
        w = np.concatenate([(s * y[:r] - b_u) / shift, y])
        for _ in range(2):  # twice is enough to stay orthogonal
            # Not by @: on products so small the threads of a BLAS can wait for each other far longer than they work.
            overlap = np.einsum("ij,j->i", basis[: i + 1].conj(), w)
            H[: i + 1, i] += overlap
            w -= np.einsum("i,ij->j", overlap, basis[: i + 1])
        H[i + 1, i] = np.linalg.norm(w)
        if H[i + 1, i] < 1e-13 * np.abs(H[: i + 1, i]).max():  # the space is invariant: all is found
            steps = i + 1
            break
        basis[i + 1] = w / H[i + 1, i]
    mu, vectors = np.linalg.eig(H[:steps, :steps])
    good = np.abs(H[steps, steps - 1] * vectors[-1]) < 1e-9 * np.abs(mu)
    good[np.argmax(np.abs(mu))] = True  # the nearest one of all is the safest
    return shift + 1 / mu[good], np.einsum("ik,ij->kj", basis[:steps], vectors[:, good])
