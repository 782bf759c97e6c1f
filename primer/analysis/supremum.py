"""The largest growth rate over all wavevectors, for symbols whose growth is bounded."""

import mpmath as mp
import numpy as np

from primer.analysis.puiseux import collected
from primer.analysis.roots import DIGITS, ZERO, roots

NOISE = 1e-11  # relative real part below which an eigenvalue in double precision counts as purely imaginary
PLACES = 6  # local maxima followed up
TRIALS = 20  # places looked at in search of them
PRECISE = 300  # digits for the roots of one polynomial: enough for roots 24 decades apart in size


def supremum(symbol, law, real):
    """(sup Re lambda over all xi, the |xi| where), given that the fastest ``law`` as |xi| -> infinity is bounded.

    It is attained at a local maximum of a scan over 24 decades of |xi| (12 in two space variables), followed to
    rounding level, or at xi = 0; or it is approached as |xi| -> infinity, and then the second number is infinity.
    """
    pencil = symbol.pencil()
    reach, angles = (12, 1 if real else 2) if symbol.dim == 1 else (6, 60 if real else 120)
    s = np.linspace(-reach, reach, 50 * reach + 1 if symbol.dim == 1 else 10 * reach + 1)
    angle = (np.pi if real else 2 * np.pi) * np.arange(angles) / angles
    rate = _rates(pencil, s[:, None], angle)
    values = [(exact_growth(symbol, np.zeros(symbol.dim)), 0.0)]
    # At xi = 0 some unknown may be undetermined, so that the limit is asked for too.
    values += [(exact_growth(symbol, _wavevector(symbol.dim, -15.0, a)), 0.0) for a in angle[::15]]
    if law.exponent <= 0:
        values.append((law.coefficient if law.exponent == 0 else 0.0, np.inf))
    peaks = _peaks(rate)
    order = np.argsort(-peaks, axis=None)
    order = order[peaks.flat[order] > -np.inf]
    imaginary = order[rate.flat[order] == 0]
    followed = 0
    for place in [*imaginary[:: len(imaginary) // PLACES + 1], *order[rate.flat[order] != 0][:TRIALS]]:
        n, m = np.unravel_index(place, rate.shape)
        # What double precision takes for growth, or for none, may be rounding: ask with more digits.
        exact = exact_growth(symbol, _wavevector(symbol.dim, s[n], angle[m]))
        best_so_far = max(value for value, _ in values)
        values.append((exact, float(10.0 ** s[n])))
        if exact < best_so_far - 0.5 * (abs(exact) + abs(best_so_far)):
            continue  # no maximum can be so much higher than the scan's nearest place
        if followed < PLACES and rate[n, m] != 0 and abs(exact - rate[n, m]) <= 1e-3 * abs(exact):
            best = _followed(pencil, s[n], angle[m], s[1] - s[0], np.pi / angles)
            values += _sharpened(symbol, *best)
            followed += 1
    values += _poles(symbol) if symbol.dim == 1 else []
    value, where = max(values, key=lambda item: item[0])
    tiny = 1e-14 * np.abs(np.nan_to_num(pencil.eigenvalues(_wavevector(symbol.dim, 0.0, 0.1)))).max(initial=0)
    return (0.0 if abs(value) <= tiny else value), where


def _wavevector(dim, s, angle):
    """xi of length 10^s in this direction; in one space variable angles count as a sign."""
    k, direction = 10.0**s, np.cos(angle)
    return k * np.sign(direction) if dim == 1 else k * np.stack(np.broadcast_arrays(direction, np.sin(angle)))


def _rates(pencil, s, angle):
    lam = pencil.eigenvalues(_wavevector(pencil.dim, *np.broadcast_arrays(s, angle)))
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
    turns = steps if pencil.dim == 2 else np.zeros(1)
    for _ in range(30):
        rate = _rates(pencil, s + width * steps[:, None], angle + turn * turns)
        n, m = np.unravel_index(np.argmax(rate), rate.shape)
        if rate[n, m] > rate[2, len(turns) // 2]:
            s, angle = s + width * steps[n], angle + turn * turns[m]
        width, turn = width / 1.8, turn / 1.8
    return s, angle


def _poles(symbol):
    """Wavenumbers, in one space variable, at which a branch goes to +infinity: its time derivative drops out there."""
    top = max(n for n, _, _ in symbol.determinant)
    leading = {a: c for (n, a, _), c in symbol.determinant.items() if n == top}
    found = []
    with mp.workdps(DIGITS):
        for z, _ in roots([leading.get(a, mp.mpc(0)) for a in range(max(leading) + 1)], ZERO):
            if abs(z.imag) <= mp.sqrt(ZERO) * abs(z) and z.real != 0:
                for side in (1, -1):
                    near, nearer = (exact_growth(symbol, z.real * (1 + side * mp.mpf(10) ** -n)) for n in (9, 12))
                    found.append((np.inf if nearer > 2 * max(near, 0) else nearer, abs(float(z.real))))
    return found


def _sharpened(symbol, s, angle):
    """The growth at the top of the parabola through three places about a maximum in s, and |xi| there."""
    values = []
    for h in (1e-4, 1e-7):
        low, mid, high = (exact_growth(symbol, _wavevector(symbol.dim, s + step, angle)) for step in (-h, 0, h))
        values.append((mid, 10.0**s))
        bend = low - 2 * mid + high
        if bend < 0:
            s += np.clip(0.5 * (low - high) / bend, -1, 1) * h
    return [*values, (exact_growth(symbol, _wavevector(symbol.dim, s, angle)), 10.0**s)]


def exact_growth(symbol, xi):
    """max Re lambda at one wavevector from the roots of det M, with many digits; -inf if det M vanishes."""
    with mp.workdps(PRECISE):
        xi = [mp.mpf(x) for x in np.atleast_1d(xi)] + [mp.mpf(1)]
        terms = ((n, c * xi[0] ** a * xi[1] ** b) for (n, a, b), c in symbol.determinant.items())
        p = collected(terms)
        if max(p, default=0) == 0:
            return -np.inf
        p = [p.get(n, mp.mpc(0)) for n in range(max(p) + 1)]
        return float(max(z.real if abs(z.real) > ZERO * abs(z) else 0 for z, _ in roots(p, mp.mpf(10) ** -200)))
