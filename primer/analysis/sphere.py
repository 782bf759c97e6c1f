"""The fastest growth over all directions in three space variables, in double precision."""

from __future__ import annotations

import numpy as np

from primer.analysis.pencil import Pencil, growth

SCAN = 400  # directions of the first scan, evenly over the sphere
PEAKS = 5  # of growth, and places where branches nearly meet, followed up
FAN = 10.0 ** -np.arange(1, 13.0)  # distances (radians) at which the neighbourhood of such a place is searched
TURNS = np.pi * np.arange(6) / 3  # directions of the fan
LOWEST = -1e300  # stands for a direction without eigenvalues
STEPS = 60  # of a third each: from a tenth down to rounding level
_AXES = [v for v in np.ndindex(3, 3, 3) if any(n != 1 for n in v)]
PLAIN = np.array([[n - 1 for n in v] for v in _AXES], dtype=float).T / np.array(
    [np.sqrt(sum((n - 1) ** 2 for n in v)) for v in _AXES]
)  # along axes and between them, where symmetry puts many an extreme


def directions() -> np.ndarray:
    """Unit vectors of shape (3, SCAN + 26): a Fibonacci spiral, and those along axes and diagonals."""
    j = np.arange(SCAN) + 0.5
    z, turn = 1 - 2 * j / SCAN, j * np.pi * (3 - np.sqrt(5))
    r = np.sqrt(1 - z**2)
    return np.concatenate([np.stack([r * np.cos(turn), r * np.sin(turn), z]), PLAIN], axis=1)


def best_directions(pencil: Pencil, k: np.ndarray) -> np.ndarray:
    """Unit vectors of shape (3,) + k.shape, k one-dimensional: the largest growth found at each |xi| = k."""
    scan = directions()
    if not len(k):
        return np.empty((3, 0))
    rate, meeting = _rate_and_meeting(pencil, k[:, None] * scan[:, None, :])
    tops = np.stack([scan[:, _apart(scan, f)] for f in rate], axis=1)  # of shape (3, len(k), PEAKS), as all seeds are
    near = np.stack([scan[:, _apart(scan, -f)] for f in meeting], axis=1)
    near = _climbed(near, lambda d: -_rate_and_meeting(pencil, _times(k, d))[1])
    fan = _fan(near)
    around = growth_of(pencil, _times(k, fan))
    best = np.argsort(-around, axis=1, kind="stable")[:, :PEAKS]
    seeds = np.concatenate([tops, near, np.take_along_axis(fan, best[None], axis=2)], axis=2)
    seeds = _climbed(seeds, lambda d: growth_of(pencil, _times(k, d)))
    final = growth_of(pencil, _times(k, seeds))
    best = np.argmax(final, axis=1)
    found, top = seeds[:, np.arange(len(k)), best], final[np.arange(len(k)), best]
    plain = PLAIN[:, np.argmax(PLAIN.T @ found, axis=0)]  # a symmetric direction itself, where nothing is lost by it
    return np.where(growth_of(pencil, k * plain) >= top - 1e-14 * np.abs(top), plain, found)


def _times(k, d):
    """k d, where d is of shape (3, len(k), ...)."""
    return k.reshape(-1, *[1] * (d.ndim - 2)) * d


def growth_of(pencil, xi):
    """Growth, LOWEST where there is none."""
    rate = growth(pencil, xi)
    return np.where(np.isfinite(rate), rate, LOWEST)


def _rate_and_meeting(pencil, xi):
    """Growth, and the log of the product of all |lambda_i - lambda_j| and |lambda_i|."""
    lam = pencil.eigenvalues(xi)
    lam = np.concatenate([lam, np.zeros_like(lam[..., :1])], axis=-1)
    i, j = np.triu_indices(lam.shape[-1], 1)
    rate = np.where(np.isnan(lam[..., 0]), LOWEST, lam[..., 0].real)
    gap = np.log(np.maximum(np.abs(lam[..., i] - lam[..., j]), np.finfo(float).tiny)).sum(axis=-1)
    return rate, np.where(np.isnan(gap), -LOWEST, gap)


def _apart(d, f):
    """Places of the largest f, no two within a tenth of a radian."""
    found: list[int] = []
    for n in np.argsort(-f, kind="stable"):
        if all(d[:, n] @ d[:, m] < 0.995 for m in found):
            found.append(int(n))
        if len(found) == PEAKS:
            return found
    return found + found[:1] * (PEAKS - len(found))


def _tangents(d):
    """Two unit vectors at right angles to each of d, of shape (3, ...)."""
    e = np.moveaxis(np.eye(3)[np.argmin(np.abs(d), axis=0)], -1, 0)
    a = e - (e * d).sum(axis=0) * d
    a /= np.linalg.norm(a, axis=0)
    return a, np.cross(d, a, axis=0)


def _fan(d):
    """The neighbourhoods of directions of shape (3, n, m), all of them in the last axis."""
    a, b = _tangents(d)
    x, y = (FAN[:, None] * f(TURNS) for f in (np.cos, np.sin))
    moved = d[..., None] + a[..., None] * x.ravel() + b[..., None] * y.ravel()
    moved = moved.reshape(3, d.shape[1], -1)
    return moved / np.linalg.norm(moved, axis=0)


def _climbed(d, f):
    """Directions of shape (3, n, m) moved uphill by ever finer scans about them, down to rounding level."""
    x, y = (s.ravel() for s in np.meshgrid([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], indexing="ij"))
    width, still = 0.1, 0
    for _ in range(STEPS):
        a, b = _tangents(d)
        trial = d[..., None] + width * (a[..., None] * x + b[..., None] * y)
        trial /= np.linalg.norm(trial, axis=0)
        value = f(trial)
        best = np.argmax(value, axis=-1)[..., None]
        gain = np.take_along_axis(value, best, axis=-1)[..., 0] - value[..., 4]
        moved = gain > 1e-15 * np.abs(value[..., 4])
        d = np.where(moved, np.take_along_axis(trial, best[None], axis=-1)[..., 0], d)
        still = 0 if moved.any() else still + 1
        if still == 12:
            break
        width /= 1.6
    return d
