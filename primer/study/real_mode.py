"""The fastest mode of the toy system on a grid where it surely is a real one: a few tridiagonal eigenproblems.

With T(lam) = lam^2 + lam B + S^2, B and S^2 real and symmetric (:mod:`primer.study.spectrum`), every eigenvalue is a
root of lam^2 + b lam + c for its own vector y, b = y'By, c = y'S^2 y, |y| = 1. Hence

* a pair that is not real has Re lam = -b/2 and |1 + dt lam|^2 = 1 - dt b + dt^2 c, which the least eigenvalues of B and
  of dt B - dt^2 S^2 bound: for all such pairs at once;
* above half of -min eig B every y has passed its lesser root, so that the largest real lam is where T becomes positive
  definite. The larger root of the lowest vector of T is a lower bound of it: repeated, that climbs to it;
* the most negative one is that of -B, the other way round; and if B > 0, the slowest to decay is the first place below
  0 where T, positive definite at 0, ceases to be so, as long as that is above half of -min eig B.

If what is found so outgrows the bound of all the others it is the fastest, without a search.
"""

import math
from enum import StrEnum

import numpy as np

_TURNS = 60  # of a climb that takes about five
_CLOSE = 1e-13  # of a growth rate
_LEAST = 1e-6  # of the least eigenvalue of B: no slower decay is looked for


class Parity(StrEnum):
    """Symmetry of a perturbation about x = 0. The data and the steady state have that of ``DATA``."""

    DATA = "u even, v odd"
    OPPOSITE = "u odd, v even"


def form(toy, n, parity):
    """(k, s, diagonal, off-diagonal) of s and B = 1 + eps A over the wavenumbers k = 1 ... of one parity."""
    h = 2 * math.pi / n
    even_v = parity is Parity.OPPOSITE
    k = np.arange(1, n // 2 + 1 if even_v or n % 2 else n // 2)
    s, half = np.sin(k * h) / h, 2 * np.sin(k * h / 2) / h  # half = sqrt(k2)
    diagonal = toy.a * half**2
    off = -h / math.sin(h) / 2 * half[1:] * half[:-1]
    if n % 2:  # the neighbour of the last wavenumber is, on the grid, itself: with the sign of the sawtooth's ends
        diagonal[-1] += (1 if even_v else -1) * h / math.sin(h) / 2 * half[-1] ** 2
    elif even_v:
        s[-1] = 0  # sin(pi) in exact arithmetic
        off[-1:] *= math.sqrt(2)
    return k, s, 1 + toy.eps * diagonal, toy.eps * off


def surely_fastest(toy, n, dt=0.0):
    """(lam, parity, y) of the fastest mode with steps of dt, if it is real and that can be proven; else None."""
    found, least, bound = [], math.inf, -math.inf
    for parity in Parity:
        _, s, d, e = form(toy, n, parity)
        if d.size < 3 or toy.eps == 0:
            return None
        lowest = _value(d, e, 1)
        least, c = min(least, lowest), s * s
        bound = max(bound, -_value(dt * d - dt * dt * c, dt * e, 1) if dt else -lowest)
        top = _climb(c, d, e, lowest) if lowest < 0 else _slowest(c, d, e, lowest)
        if top is None:
            return None
        bottom = _climb(c, -d, -e, -_value(d, e, d.size)) if dt else None
        found += [(lam, parity, y) for lam, y in (top, _mirrored(bottom)) if lam is not None]
    if not found:
        return None
    best = max(found, key=lambda each: _rate(each[0], dt))
    others = math.log(max(1 + bound, 1e-300)) / (2 * dt) if dt else bound / 2
    # A real one that was not found is below half of the least eigenvalue, and above the most negative one.
    others = max(others, _rate(min(-least / 2, 0.0) if least > 0 else -least / 2, dt))
    return best if _rate(best[0], dt) >= others else None


def nothing_grows(toy, n):
    """Whether it is plain that as dt -> 0 nothing grows on n points: B >= 0, or no second derivative at all."""
    if toy.eps == 0:
        return True
    forms = [form(toy, n, parity) for parity in Parity]
    return all(_value(d, e, 1) >= 0 for _, _, d, e in forms)


def _rate(lam, dt):
    return math.log(max(abs(1 + dt * lam), 1e-300)) / dt if dt else lam


def _mirrored(found):
    return (None, None) if found is None or found[0] is None else (-found[0], found[1])


def _climb(c, d, e, lowest):
    """(lam, y): the largest real eigenvalue, if it is above -lowest/2; else (None, None)."""
    lam = -lowest / 2
    for _ in range(_TURNS if lam > 0 else 0):
        value, y = _pair(d + lam + c / lam, e, 1)
        if value >= 0:  # positive definite from here on
            break
        b = d @ (y * y) + 2 * (e @ (y[1:] * y[:-1]))
        new = -b / 2 + math.sqrt(max(b * b / 4 - c @ (y * y), 0.0))
        if new <= lam * (1 + _CLOSE):
            break
        lam = new
    return (lam, y) if lam > -lowest / 2 else (None, None)


def _slowest(c, d, e, lowest):
    """(lam, y): the largest real eigenvalue, if B > 0 and it is above -lowest/2; else (None, None); None if unknown.

    Below 0 the sawtooth alone, of c = 0, is not definite from the start: it stands for the neutral mode left out.
    """
    from scipy.optimize import brentq

    place = d.size - int(np.count_nonzero(c == 0))

    def value(mu):
        return _value(d - mu - c / mu, e, place)

    low, high = _LEAST * lowest, lowest / 2
    if not high or value(low) >= 0:
        return None
    if value(high) <= 0:
        return None, None
    mu = brentq(value, low, high, xtol=1e-12 * high, rtol=1e-12)
    return -mu, _pair(d - mu - c / mu, e, place)[1]


def _value(d, e, place):
    """The place-th eigenvalue, from 1, of a symmetric tridiagonal matrix."""
    from scipy.linalg.lapack import dstebz

    if d.size == 1:
        return float(d[0])
    return float(dstebz(d, e, 2, 0.0, 0.0, place, place, 0.0, "B")[1][0])


def _pair(d, e, place):
    from scipy.linalg.lapack import dstebz, dstein

    _, w, block, split, _ = dstebz(d, e, 2, 0.0, 0.0, place, place, 0.0, "B")
    return w[0], dstein(d, e, w[:1], block, split)[0][:, 0]
