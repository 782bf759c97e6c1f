"""Where growth is largest, in double precision: a scan over wavevectors, and its peaks followed to rounding level."""

from __future__ import annotations

import numpy as np

from primer.analysis import sphere
from primer.analysis.directions import max_growth
from primer.analysis.eigen import EPS, finite_eigenvalues

AROUND = 60  # directions of the scan in the plane
SHAKEN = 4  # times that the entries are moved by a rounding error
ROUNDING = 1e-13  # relative error of an eigenvalue, with something to spare
GENERIC = 1.013  # wavenumbers are powers of ten times this, so that none is at a pole such as |xi| = 1
PEAKS = 12  # local maxima of the scan followed up
POLE = 1e5  # growth that rises by more than this within one step of the scan is unbounded


def reach(pencil, low, high):
    """The decades of |xi| (low, high), about |xi| = 1, at which the entries are numbers."""

    def serves(decade):
        try:
            pencil.matrices(GENERIC * 10.0**decade * directions(pencil))
        except (ValueError, ArithmeticError):
            return False
        return True

    top = next((d for d in range(0, high) if not serves(d + 1)), high)
    bottom = next((d for d in range(0, low, -1) if not serves(d - 1)), low)
    return bottom, top


def directions(pencil):
    """Unit vectors of shape (dim, m); in one space variable the two signs, of shape (2,)."""
    if pencil.dim == 1:
        return np.array([1.0, -1.0])
    if pencil.dim == 3:
        return sphere.directions()
    angle = np.pi * (np.arange(AROUND) + 0.137) / AROUND * (1 if pencil.is_real else 2)
    return np.stack([np.cos(angle), np.sin(angle)])


def growth_and_error(pencil, xi):
    """(max Re lambda, its error) at xi of shape s or (dim,) + s.

    The error is what rounding errors of the matrices' entries do to it, and of the eigenvalue itself.
    """
    S, E = pencil.matrices(xi)
    shape = S.shape[:-2]
    S, E = (m.reshape(-1, pencil.size, pencil.size) for m in (S, E))
    rate, size = _fastest(pencil, S, E)
    error = np.zeros(len(S)) if pencil.size == 1 else ROUNDING * size
    chance = np.random.default_rng(0)
    for _ in range(SHAKEN):
        moved = (_shaken(m, chance) for m in (S, E))
        error = np.fmax(error, 3 * np.abs(_fastest(pencil, *moved)[0] - rate))
    return rate.reshape(shape), error.reshape(shape)


def _shaken(m, chance):
    factors = 1 + 2 * EPS * chance.uniform(-1, 1, (2, *m.shape))
    return m.real * factors[0] + 1j * m.imag * factors[1]


def _fastest(pencil, S, E):
    """(max Re lambda, |lambda| there); -inf where there is none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        lam = -S[:, :, 0] / E[:, :, 0] if pencil.size == 1 else finite_eigenvalues(S, E, pencil.count)
    lam = np.where(np.isfinite(lam), lam, -np.inf)
    best = np.take_along_axis(lam, np.argmax(lam.real, axis=1)[:, None], axis=1)[:, 0]
    return best.real, np.where(np.isfinite(best), np.abs(best), 0)


def largest(pencil, k):
    """(xi, growth, its error) at lengths k of shape (n,), over all directions: xi of shape (n,) or (dim, n)."""
    found = max_growth(pencil, k)
    xi = k * found.direction
    return xi, *growth_and_error(pencil, xi)


def scanned(pencil, k):
    """(xi, growth) at the lengths k, the largest over some fixed directions."""
    d = directions(pencil)
    xi = k[:, None] * d if pencil.dim == 1 else k[:, None] * d[:, None, :]
    rate, error = growth_and_error(pencil, xi)
    rate = np.where(np.abs(rate) <= 10 * error, 0, rate)
    best = np.argmax(rate, axis=1)[:, None]
    xi = np.take_along_axis(xi, best if pencil.dim == 1 else best[None], axis=-1)
    return xi[..., 0], np.take_along_axis(rate, best, axis=1)[:, 0]


def climbed(pencil, xi, width):
    """(xi, growth) with each xi of shape (n,) or (dim, n) moved uphill by ever finer scans about it."""
    axes = np.meshgrid(*[np.linspace(-1, 1, 5 if pencil.dim < 3 else 3)] * pencil.dim, indexing="ij")
    steps = np.stack([axis.ravel() for axis in axes])
    xi = np.atleast_2d(xi)
    for _ in range(60):
        trial = xi[:, :, None] + width * np.linalg.norm(xi, axis=0)[:, None] * steps[:, None, :]
        rate = _rates(pencil, trial)
        best = np.argmax(rate, axis=1)
        middle = rate[:, rate.shape[1] // 2]
        moved = rate[np.arange(len(best)), best] > middle
        chosen = np.take_along_axis(trial, best[None, :, None], axis=2)[..., 0]
        xi = np.where(moved, chosen, xi)
        width /= 1.8
    xi = xi[0] if pencil.dim == 1 else xi
    rate, error = growth_and_error(pencil, xi)
    return xi, np.where(np.abs(rate) <= 10 * error, 0, rate)


def _rates(pencil, xi):
    xi = xi[0] if pencil.dim == 1 else xi
    try:
        S, E = pencil.matrices(xi)
    except (ValueError, ArithmeticError):  # some of them at the edge of what are numbers
        return np.full(xi.shape if pencil.dim == 1 else xi.shape[1:], -np.inf)
    rate, _ = _fastest(pencil, *(m.reshape(-1, pencil.size, pencil.size) for m in (S, E)))
    return rate.reshape(S.shape[:-2])


def supremum(pencil, k):
    """(sup Re lambda, |xi| there) over lengths within k: inf at what is a pole, as far as computed."""
    xi, rate = scanned(pencil, k)
    peaks = 1 + np.flatnonzero((rate[1:-1] >= rate[:-2]) & (rate[1:-1] >= rate[2:]) & np.isfinite(rate[1:-1]))
    peaks = peaks[np.argsort(-rate[peaks], kind="stable")][:PEAKS]
    found = [(float(rate[n]), float(k[n])) for n in (0, -1)]
    if peaks.size:
        place, value = climbed(pencil, xi[..., peaks], k[1] / k[0] - 1)
        size = np.linalg.norm(np.atleast_2d(place), axis=0)
        value = np.where((value > POLE * np.abs(rate[peaks])) & (rate[peaks] != 0), np.inf, value)
        found += zip(value.tolist(), size.tolist(), strict=True)
    return max(found, key=lambda item: item[0])
