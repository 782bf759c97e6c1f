"""The largest growth rate over all wavevectors, for symbols whose growth is bounded."""

from __future__ import annotations

import math
from fractions import Fraction

import mpmath as mp
import numpy as np

from primer.analysis import levels
from primer.analysis.factors import factors
from primer.analysis.poles import limit, limits
from primer.analysis.puiseux import collected
from primer.analysis.roots import ZERO, roots
from primer.analysis.scales import scales

PRECISE = 150  # digits for the roots at one wavenumber
ABOVE = mp.mpf(10) ** -9  # how far above the best value found, relative to it, growth is asked for
FAINT = mp.mpf(10) ** -30  # growth smaller than this beside the smallest scale of lambda counts as none
ROUNDS = 20  # of asking; two or three are usual
RAYS = 12  # directions that are asked
ANGLES = 60  # directions of the scan
NOISE = 1e-11  # relative real part below which an eigenvalue in double precision counts as purely imaginary
TRIALS = 12  # local maxima of the scan looked at


def along_line(P, real, known=()):
    """(sup Re lambda, k where) over k > 0 for the roots of P(lambda, k), not below the values (growth, k) in ``known``.

    From the best value found, all places are asked for where growth exceeds it, see :mod:`primer.analysis.levels`;
    from there it climbs, and asks again, until there are none. No scan, and no scale but those of P.
    """
    with mp.workdps(PRECISE):
        known = [*limits(P), *known, (limit(P), math.inf)]
        value, where = max(known, key=lambda item: item[0])
        sizes = scales(P)
        if not sizes or (math.isinf(value) and value > 0):  # each branch a power of k: the limits are all there is
            return float(value), float(where)
        faint = FAINT * mp.exp(min(low for _, low, _ in sizes))
        if math.isinf(value):
            value, where = max((rate(P, mp.exp(s)), mp.exp(s)) for s, _, _ in sizes)
        for _ in range(ROUNDS):
            level = value + abs(value) * ABOVE if value else faint
            found = levels.gaps(P, level, real)
            places = _steps(sizes) if found is None else [mp.mpf(x.numerator) / x.denominator for x in found]
            rates = [rate(P, x) for x in places]
            top = max(range(len(rates)), key=rates.__getitem__)
            if rates[top] <= level:
                break
            low, high = places[max(top - 1, 0)], places[min(top + 1, len(places) - 1)]
            around = (mp.log(low), mp.log(places[top]), mp.log(high))
            value, s = climbed(lambda s: rate(P, mp.exp(s)), *around, rates[top])
            where = mp.exp(s)
        return float(value), float(where)


def _steps(sizes):
    """Places about the scales of k, twenty for a decade, where all that exceed a level are too many to find."""
    steps = {round(8.7 * s) + m for s, _, _ in sizes for m in range(-20, 21)}
    return [mp.exp(mp.mpf(m) / 8.7) for m in sorted(steps)]


def in_plane(symbol, real, known=()):
    """(sup Re lambda, |xi| where) over all wavevectors in the plane, not below the values (growth, k) in ``known``.

    Local maxima of a scan about the scales of the determinant are climbed; then rays in all directions are asked
    whether growth exceeds the best anywhere on them, exactly, and where it does the direction is turned uphill.
    """
    D, pencil = symbol.determinant, symbol.pencil()
    with mp.workdps(PRECISE):
        half = mp.pi if real else 2 * mp.pi
        angles = [half * (m + mp.mpf("0.137")) / RAYS for m in range(RAYS)] + [mp.mpf(0), mp.pi / 2]
        parts = factors(D)
        sizes = [size for angle in angles[::3] for part in parts for size in scales(ray(part, angle))]
        if sizes:
            known = [*known, *_scanned(D, pencil, real, sizes)]
        turned = None
        best, where = max(known, key=lambda item: item[0])
        for angle in angles:
            value, k = _along(parts, angle, real, [(best, where)])
            if value > best:
                best, where, turned = value, k, angle
        if turned is not None and math.isfinite(best):
            width = half / RAYS

            def on_ray(angle):
                return mp.mpf(_along(parts, angle, real)[0])

            best, angle = climbed(on_ray, turned - width, turned, turned + width, mp.mpf(best))
            where = _along(parts, angle, real)[1]
        return float(best), float(where)


def _along(parts, angle, real, known=()):
    """(sup Re lambda, |xi| where) along a ray, over the factors of det M."""
    found = [along_line(P, real, known) for part in parts if (P := ray(part, angle))]
    return max(found, key=lambda item: item[0], default=(-math.inf, 0.0))


def exact_growth(symbol, xi):
    """max Re lambda at one wavevector from the roots of det M, with many digits; -inf if there are none."""
    with mp.workdps(PRECISE):
        xi = [mp.mpf(x) for x in np.atleast_1d(xi)] + [mp.mpf(1)]
        found = [-mp.inf]
        for part in factors(symbol.determinant):
            P = collected((((n, 0), c * xi[0] ** a * xi[1] ** b) for (n, a, b), c in part.items()))
            found += [rate(P, mp.mpf(1))] if P else []
        return float(max(found))


def ray(D, angle):
    """det M along xi = k (cos, sin)(angle): a polynomial {(n, a): c} in lambda and k."""
    x, y = mp.cos(angle), mp.sin(angle)
    x, y = (mp.mpf(0) if abs(z) < mp.eps * 100 else z for z in (x, y))
    return collected((((n, Fraction(a + b)), c * x**a * y**b) for (n, a, b), c in D.items()))


def _scanned(D, pencil, real, sizes):
    """Values (growth, |xi|) at the tops of the local maxima of a scan in double precision, each with many digits."""
    s = (
        np.array(sorted({round(10 * float(size) / math.log(10)) + m for size, _, _ in sizes for m in range(-15, 16)}))
        / 10
    )
    s = s[np.abs(s) < 60]
    period = np.pi if real else 2 * np.pi
    angle = period * np.arange(ANGLES) / ANGLES
    grid = np.broadcast_arrays(s[:, None], angle)
    try:
        values = _rates(pencil, *grid)
    except ValueError:  # beyond what double precision holds
        return []
    peaks = _peaks(values)
    found = []
    for place in np.argsort(-peaks, axis=None)[:TRIALS]:
        n, m = np.unravel_index(place, peaks.shape)
        if peaks[n, m] > -np.inf:
            start = exact_rate(D, s[n], angle[m])
            found.append((float(start), float(10.0 ** s[n])))
            best = max(value for value, _ in found)
            low = start < best - 0.5 * (abs(start) + abs(best))
            if low or start == 0 or abs(start - values[n, m]) > 1e-3 * abs(start):
                continue  # neither higher than the best, nor a figure that double precision can climb
            found += _sharpened(D, *_followed(pencil, s[n], angle[m], 0.1, period / ANGLES))
    return found


def exact_rate(D, s, angle):
    """The growth rate at |xi| = 10^s in this direction."""
    with mp.workdps(PRECISE):
        return max(rate(ray(part, mp.mpf(angle)), mp.mpf(10) ** mp.mpf(s)) for part in factors(D))


def _sharpened(D, s, angle):
    """The growth at the top of the parabola through three places about a maximum in s, and |xi| there."""
    values = []
    for h in (1e-4, 1e-7):
        low, mid, high = (float(exact_rate(D, s + step, angle)) for step in (-h, 0, h))
        values.append((mid, 10.0**s))
        bend = low - 2 * mid + high
        if bend < 0:
            s += np.clip(0.5 * (low - high) / bend, -1, 1) * h
    return [*values, (float(exact_rate(D, s, angle)), 10.0**s)]


def _rates(pencil, s, angle):
    xi = 10.0**s * np.stack([np.cos(angle), np.sin(angle)])
    lam = pencil.eigenvalues(xi)
    real = np.where(np.abs(lam.real) <= NOISE * np.abs(lam), 0, lam.real)
    return np.where(np.isnan(lam), -np.inf, real).max(axis=-1, initial=-np.inf)


def _peaks(rate):
    """rate where no neighbour is higher, -inf elsewhere."""
    around = np.pad(rate, ((1, 1), (0, 0)), constant_values=-np.inf)
    is_peak = (rate >= around[:-2]) & (rate >= around[2:])
    is_peak &= (rate >= np.roll(rate, 1, axis=1)) & (rate >= np.roll(rate, -1, axis=1))
    return np.where(is_peak, rate, -np.inf)


def _followed(pencil, s, angle, width, turn):
    """(s, angle) moved uphill by ever finer scans of its neighbourhood."""
    steps = np.linspace(-1, 1, 5)
    for _ in range(30):
        rate = _rates(pencil, *np.broadcast_arrays(s + width * steps[:, None], angle + turn * steps))
        n, m = np.unravel_index(np.argmax(rate), rate.shape)
        if rate[n, m] > rate[2, 2]:
            s, angle = s + width * steps[n], angle + turn * steps[m]
        width, turn = width / 1.8, turn / 1.8
    return s, angle


def climbed(f, low, middle, high, value):
    """(maximum, place) of f in [low, high], not less than its value in the middle: Brent's method."""
    x = w = v = middle
    fx = fw = fv = value
    step = before = high - low
    for _ in range(100):
        centre, near = (low + high) / 2, 1e-13 * (1 + abs(x))
        flat = x != w != v != x and max(fx - fw, fx - fv) <= 1e-18 * abs(fx)
        if flat or abs(x - centre) <= 2 * near - (high - low) / 2:
            break
        p, q = mp.mpf(0), mp.mpf(0)
        if abs(before) > near:
            r, q = (x - w) * (fx - fv), (x - v) * (fx - fw)
            p, q = (x - v) * q - (x - w) * r, 2 * (q - r)
            p, q = (-p if q > 0 else p), abs(q)
        if abs(p) < abs(q * before / 2) and q * (low - x) < p < q * (high - x):
            before, step = step, p / q
        else:
            before = (high if x < centre else low) - x
            step = 0.381966 * before
        trial = x + (step if abs(step) >= near else near * mp.sign(step))
        ft = f(trial)
        if ft >= fx:
            low, high = (x, high) if trial >= x else (low, x)
            v, w, x, fv, fw, fx = w, x, trial, fw, fx, ft
        else:
            low, high = (trial, high) if trial < x else (low, trial)
            if ft >= fw or w == x:
                v, w, fv, fw = w, trial, fw, ft
            elif ft >= fv or v in (x, w):
                v, fv = trial, ft
    return fx, x


def rate(P, k):
    """max Re lambda over the roots of P(., k); -inf if there are none."""
    p = collected((n, c * k ** int(a)) for (n, a), c in P.items())
    if max(p, default=0) == 0:
        return -mp.inf
    p = [p.get(n, mp.mpc(0)) for n in range(max(p) + 1)]
    return max(z.real if abs(z.real) > ZERO * abs(z) else mp.mpf(0) for z, _ in roots(p))
