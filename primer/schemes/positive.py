"""How long u stays positive: the time up to which eq. (toy-pde) is well posed on its own solution."""

import math

import numpy as np

from primer.schemes.fourier import transfer

_BETWEEN = 16  # points looked at for each grid point, before Newton's method finds the least u of the interpolant
_SAMPLES = 16  # gaps looked at at once, or into which one is cut
_GAP = 0.1  # of the first samples: u moves on a time scale of 1
_AFTER, _STRETCH = 10.0, 1.03  # from there on, with e^{-t/2}, it moves less and less, and gaps grow by this
_CLOSEST = 1e-13  # of a time: there is no dividing it further


def least(u):
    """The least value (m,) over x, between the points too, of the trigonometric interpolants of samples u (m, n)."""
    m, n = u.shape
    fine = u @ transfer(n, _BETWEEN * n)
    lowest = fine.argmin(axis=1)
    x = 2 * math.pi / fine.shape[1] * lowest
    k = np.arange(n // 2 + 1)
    waves = np.fft.rfft(u) / n
    waves[:, 1 : (n + 1) // 2] *= 2
    for _ in range(3):
        here = waves * np.exp(1j * k * x[:, None])
        slope, bend = (1j * k * here).real.sum(axis=1), (-(k**2) * here).real.sum(axis=1)
        move = np.divide(-slope, bend, out=np.zeros(m), where=bend > 0)
        x = x + np.clip(move, -1 / n, 1 / n)
    there = (waves * np.exp(1j * k * x[:, None])).real.sum(axis=1)
    return np.minimum(fine.min(axis=1), there)


def certain(margin, until):
    """The last time up to which ``margin`` is positive for certain, or ``until``.

    ``margin(times)`` is the least u at ascending times, less its error bar. Between two samples it is taken to dip by
    no more than the second differences there; where that is not enough, the gap is cut into 16.
    """
    edges = np.append(np.arange(0, min(until, _AFTER), _GAP), min(until, _AFTER))
    while edges[-1] < until:
        edges = np.append(edges, min(until, edges[-1] * _STRETCH))
    for start in range(0, len(edges) - 1, _SAMPLES):  # not farther than need be
        found = _walk(margin, edges[start : start + _SAMPLES + 1])
        if found is not None:
            return found
    return until


def _walk(margin, times):
    """The last time for certain, or None if the margin is positive throughout."""
    values = margin(times)
    if not values[0] > 0:
        return float(times[0])
    bends = np.abs(np.diff(values, 2)) if times.size > 2 else np.array([np.inf])
    bends = np.concatenate((bends[:1], bends, bends[-1:]))
    for i in range(times.size - 1):
        left, right = times[i : i + 2]
        if min(values[i : i + 2]) > bends[max(i - 1, 0) : i + 3].max():
            continue
        if right - left <= _CLOSEST * right:
            return float(left)
        if values[i + 1] < 0 and -values[i + 1] > bends[i : i + 2].max():  # it goes through 0, and once
            return _crossing(margin, float(left), float(right))
        found = _walk(margin, np.linspace(left, right, _SAMPLES + 1))
        if found is not None:
            return found
    return None


def _crossing(margin, left, right):
    """The last time for certain where the margin falls through 0 between two times, by the Illinois method."""
    high, low = margin(np.array([left, right]))
    same = 0
    while right - left > _CLOSEST * right:
        middle = left + (right - left) * high / (high - low)
        if not left < middle < right:
            break
        value = margin(np.array([middle]))[0]
        if value > 0:
            left, high, low = middle, value, low / 2 if same == 1 else low
        else:
            right, low, high = middle, value, high / 2 if same == -1 else high
        same = 1 if value > 0 else -1
    return left
