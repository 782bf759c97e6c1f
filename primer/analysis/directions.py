"""The fastest growth over all directions of a wavevector of given length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from primer.analysis.pencil import Pencil, growth
from primer.analysis.sphere import best_directions
from primer.checks import affordable, instance, real_array, shown
from primer.types import ArrayLike, Numbers

SCAN = 180  # directions of the first scan: a degree apart on the half circle
PEAKS = 8  # local maxima followed up
SPECIAL = 16  # directions where branches nearly meet, or nearly vanish, followed up
LOWEST = -1e300  # stands for a direction without eigenvalues
FAN = 10.0 ** -np.arange(1, 15, 0.25)  # distances (radians) at which the neighbourhood of such a direction is searched


@dataclass(frozen=True, eq=False)
class MaxGrowth:
    """The largest growth at |xi| = k and a direction that attains it.

    Attributes
    ----------
    k : array of shape s            the wavenumbers
    growth : array of shape s       max Re lambda over branches and directions
    direction : array               unit vectors of shape (dim,) + s; signs, of shape s, in one space variable

    The supremum over directions of eq. (wellp-first-formula), at one length of xi.

    >>> from primer.analysis.symbolic import pencil
    >>> found = max_growth(pencil("u_t = u_xx - u_yy"), 10.0)
    >>> print(f"{found.growth:.2f}", abs(found.direction).round(3))
    100.00 [0. 1.]
    """

    k: np.ndarray
    growth: np.ndarray
    direction: np.ndarray

    @property
    def angle(self) -> Numbers:
        """The angle from the x-axis (radians), of shape s; in one space variable 0 or pi, in three that of (x, y)."""
        x, y = self.direction[:2] if self.direction.ndim > self.k.ndim else (self.direction, np.zeros(self.k.shape))
        return np.arctan2(y, x)


def max_growth(pencil: Pencil, k: ArrayLike) -> MaxGrowth:
    """The largest growth rate at |xi| = k over all directions: of shape s, for k > 0 of shape s.

    A scan of fixed directions can miss the peak altogether: in critical-state soil mechanics at its critical state
    the growth |xi|^{2/3} lives in a window of width |xi|^{-2/3} that drifts. So each local maximum of the scan is
    followed to rounding level, and so is each direction where branches nearly meet or vanish, whose neighbourhood is
    then searched at all scales down to 1e-14 radians (in three space variables, as a spiral over the sphere and the
    symmetric directions find them).

    Returns
    -------
    MaxGrowth

    Section 4 asks for the supremum over directions too, eq. (wellp-first-formula).

    >>> import numpy as np
    >>> forward_backward = Pencil(lambda xi: [[xi[0] ** 2 - xi[1] ** 2]], np.eye(1), dim=2)
    >>> print(f"{max_growth(forward_backward, 10.0).growth:.2f}")
    100.00
    """
    instance("pencil", pencil, Pencil, "Pencil (for equations as text there is growth_rates)")
    k = real_array("k", k)
    if (k <= 0).any():
        raise ValueError(f"k must be positive everywhere, being the length of the wavevector, got {shown(k)}")
    flat = k.reshape(-1)
    # Each of the special directions is searched at all scales of the fan.
    trials = 1 if pencil.dim == 1 else 2 * SPECIAL * FAN.size
    affordable("k: all directions of its wavenumbers", 128 * flat.size * trials * pencil.size**2, f"shape {k.shape}")
    if pencil.dim == 1:
        signs = np.array([1.0, -1.0])
        rates = growth(pencil, flat[:, None] * signs)
        best = np.argmax(np.where(np.isnan(rates), -np.inf, rates), axis=1)
        return MaxGrowth(k, rates[np.arange(len(flat)), best].reshape(k.shape), signs[best].reshape(k.shape))
    if pencil.dim == 3:
        direction = best_directions(pencil, flat)
        return MaxGrowth(k, growth(pencil, flat * direction).reshape(k.shape), direction.reshape(3, *k.shape))
    angle = _best_angles(pencil, flat)
    direction = np.stack([np.cos(angle), np.sin(angle)])
    return MaxGrowth(k, growth(pencil, flat * direction).reshape(k.shape), direction.reshape(2, *k.shape))


def _best_angles(pencil, k):
    period = np.pi if pencil.is_real else 2 * np.pi
    width = np.pi / SCAN
    scan = np.broadcast_to(np.arange(0, period - width / 2, width), (len(k), round(period / width)))
    rate, meeting = _rate_and_meeting(pencil, k, scan)
    special, _ = _highest(scan, -meeting, period, SPECIAL)
    special = _followed(pencil, k, special, width, lambda *a: -_rate_and_meeting(*a)[1])
    near = (special[:, :, None] + np.concatenate([[0], FAN, -FAN])).reshape(len(k), -1) % period
    angle = np.concatenate([scan, near], axis=1)
    rate = np.concatenate([rate, _rate_and_meeting(pencil, k, near)[0]], axis=1)
    order = np.argsort(angle, axis=1)
    angle, rate = (np.take_along_axis(a, order, axis=1) for a in (angle, rate))
    peaks, widths = _highest(angle, rate, period, PEAKS)
    peaks = _followed(pencil, k, peaks, widths, lambda *a: _rate_and_meeting(*a)[0])
    final, _ = _rate_and_meeting(pencil, k, peaks)
    return peaks[np.arange(len(k)), np.argmax(final, axis=1)]


def _rate_and_meeting(pencil, k, angle):
    """Growth, and the log of the product of all |lambda_i - lambda_j| and |lambda_i|, at angles of shape (len(k), n).

    The product, unlike the smallest of its factors, dips wherever any one of them does.
    """
    lam = pencil.eigenvalues(k[:, None] * np.stack([np.cos(angle), np.sin(angle)]))
    lam = np.concatenate([lam, np.zeros_like(lam[..., :1])], axis=-1)
    i, j = np.triu_indices(lam.shape[-1], 1)
    rate = np.where(np.isnan(lam[..., 0]), LOWEST, lam[..., 0].real) if pencil.count else np.full(angle.shape, LOWEST)
    gap = np.log(np.maximum(np.abs(lam[..., i] - lam[..., j]), np.finfo(float).tiny)).sum(axis=-1)
    return rate, np.where(np.isnan(gap), -LOWEST, gap)


def _highest(angle, f, period, number):
    """Angles of the highest local maxima of f on a periodic scan, the first repeated if too few, and the spacing."""
    # A rise at rounding level is no peak, except that the highest place of all always counts.
    least = f - 1e-9 * np.abs(f)
    peak = ((least > np.roll(f, 1, axis=1)) & (least > np.roll(f, -1, axis=1))) | (f == f.max(axis=1, keepdims=True))
    number = min(number, peak.sum(axis=1).max())
    order = np.argsort(np.where(peak, -f, np.inf), axis=1, kind="stable")[:, :number]
    order = np.where(np.take_along_axis(peak, order, axis=1), order, order[:, :1])
    forward = (np.roll(angle, -1, axis=1) - angle) % period
    spacing = np.maximum(forward, np.roll(forward, 1, axis=1))
    return np.take_along_axis(angle, order, axis=1), np.take_along_axis(spacing, order, axis=1)


def _followed(pencil, k, angle, width, objective):
    """Each angle moved uphill by ever finer scans of its neighbourhood, down to rounding level."""
    offsets = np.linspace(-1, 1, 5)
    width = np.broadcast_to(width, angle.shape)
    still = 0
    for _ in range(36):  # a degree / 2.5^36 < 1e-16
        trial = angle[..., None] + width[..., None] * offsets
        f = objective(pencil, k, trial.reshape(len(k), -1)).reshape(trial.shape)
        best = np.argmax(f, axis=-1)
        gain = np.take_along_axis(f, best[..., None], axis=-1)[..., 0] - f[..., 2]
        moved = gain > 1e-15 * np.abs(f[..., 2])
        angle = np.where(moved, np.take_along_axis(trial, best[..., None], axis=-1)[..., 0], angle)
        still = 0 if moved.any() else still + 1
        if still == 5:
            break
        width = width / 2.5
    return angle
