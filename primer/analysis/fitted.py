"""A verdict by computation, for symbols that are not polynomials: |xi|, sqrt(xi tanh xi), exp(-i xi s), rational ones.

The largest growth is computed over many decades of |xi|, in double precision, and a power is fitted to the last of
them. The fit has settled only if what changes from one decade to the next shrinks as it does for a power of |xi| with
corrections of lower powers; beside a logarithm it does not. Growth that rounding could have made counts as none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from primer.analysis import places
from primer.analysis.outcome import Kind, Verdict, undecided
from primer.analysis.poles import of_law
from primer.analysis.puiseux import Law
from primer.equations.error import PDEError

DECADES = {1: 16, 2: 12, 3: 8}  # of |xi|, up and down from 1, as far as the entries are numbers, by space variables
STEPS = {1: 8, 2: 2, 3: 1}  # wavenumbers a decade
WINDOW = 4  # decades that are fitted
SETTLED = 1e-2  # the largest uncertainty of an exponent
SHRINKS = 0.65  # by which what changes from decade to decade must shrink: k^(-1/4) gives 0.56, 1/log k gives 0.87
STILL = 2e-6  # a change that no longer matters
VISIBLE = 1e6  # how far growth must stand out of its error to be fitted
DENOMINATOR = 12  # the largest of an exponent that is taken for a fraction
SAMPLES, SAME = 4000, 0.05  # of a decade; relative change of its largest |lambda| below which that counts as bounded


@dataclass(frozen=True)
class Fit:
    """What was fitted.

    Attributes
    ----------
    law : Law              how the largest growth behaves as |xi| -> infinity; None where that did not settle
    uncertainty : float    of its exponent
    direction : tuple      of the largest growth, at the largest |xi|
    bound, place : float   sup Re lambda and |xi| there
    remark : str           what did not settle, in words
    """

    law: Law | None
    uncertainty: float
    direction: tuple
    bound: float
    place: float
    remark: str = ""


def computed(pencil):
    """The verdict on a pencil whose entries are not polynomials."""
    if not pencil.count:
        raise PDEError("the constraints leave nothing that evolves: no perturbation has a growth rate")
    fit = fitted(pencil)
    if math.isnan(fit.bound):
        return replace(undecided(fit.remark), exact=False)
    law, error = fit.law or Law(math.nan, math.nan), fit.uncertainty  # type: ignore[arg-type]
    short = fit.remark or (f"{law}, fitted, exponent +- {error:.0e}" if law.coefficient else "Re lambda vanishes")
    if math.isinf(fit.bound):
        kind, lost, reason = Kind.ILL_POSED, math.inf, f"As computed, {short}: it grows without bound"
    else:
        kind, lost = Kind.WELL_POSED, math.nan
        place = f"near |xi| = {fit.place:.4g}" if math.isfinite(fit.place) else "as |xi| -> infinity"
        reason = f"As computed, Re lambda <= {fit.bound:.6g}, reached {place} (for short waves {short})"
    reason += ". This is a computation in double precision, not a proof."
    at = law.exponent, law.coefficient, fit.direction, fit.bound, fit.bound > 0
    return Verdict(kind, *at, reason, lost, exact=False, uncertainty=error)


def fitted(pencil):
    """The :class:`Fit` of a :class:`primer.Pencil` of any kind."""
    low, high = places.reach(pencil, -DECADES[pencil.dim], DECADES[pencil.dim])
    steps = STEPS[pencil.dim]
    k = places.GENERIC * 10.0 ** (np.arange(low * steps, high * steps + 1) / steps)
    span = f"as far as computed, for |xi| from {k[0]:.0e} to {k[-1]:.0e}"
    xi, rate, error = places.largest(pencil, k)
    direction = tuple(float(x) + 0.0 for x in np.atleast_1d(xi[..., -1] / np.linalg.norm(np.atleast_1d(xi[..., -1]))))
    found = _power(np.log10(k), rate, error, steps)
    if found and not found[0].is_bounded:
        return Fit(found[0], found[1], direction, math.inf, math.inf)
    inward = _power(-np.log10(k[::-1]), rate[::-1], error[::-1], steps)  # as |xi| -> 0, a power of 1/|xi|
    known = [(of_law(end[0]), at) for end, at in ((inward, 0.0), (found, math.inf)) if end]
    known.append(places.supremum(pencil, k))
    bound, place = max(known, key=lambda item: item[0])
    if math.isinf(bound):
        where = f"near |xi| = {place:.4g}" if place else "as |xi| -> 0"
        return Fit(None, math.nan, (), math.nan, place, f"growth is unbounded {where}, {span}")
    if found:
        return Fit(found[0], found[1], direction, bound, place)
    last = rate[-WINDOW * steps :]
    if (last < 0).all() and (np.diff(last) < 0).all():
        return Fit(None, math.nan, direction, bound, place, "it decays, by no power of |xi|")
    if (top := _bounded(pencil, high)) is not None:
        return Fit(Law(Fraction(0), top), 0.0, direction, max(bound, top), place, "it oscillates")
    return Fit(None, math.nan, (), math.nan, math.nan, f"the largest growth does not settle to a power of |xi|, {span}")


def _power(decade, rate, error, steps):
    """(law, uncertainty of its exponent) as the decades grow, or None if that is not settled."""
    seen = np.abs(rate) > VISIBLE * error
    if not seen.any():
        return Law(Fraction(0), 0.0), 0.0
    end = int(np.flatnonzero(seen)[-1])
    gone = end + 1 < len(rate) and bool((np.abs(rate[end + 1 :]) <= 10 * error[end + 1 :])[steps:].all())
    begin = end - WINDOW * steps
    inside = slice(max(begin, 0), end + 1)
    settled = begin >= 0 and seen[inside].all() and len(set(np.sign(rate[inside]))) == 1
    if settled:
        height = np.log10(np.abs(rate[inside]))
        slope = height[steps:] - height[:-steps]
        older, newer = (np.abs(slope[n + steps : n + 2 * steps + 1] - slope[n : n + steps + 1]) for n in (0, steps))
        change = newer.max()
        settled = change <= STILL or (change <= SHRINKS * older.max() and 3 * change <= SETTLED)
    if settled:
        uncertainty = max(3 * float(change), 1e-9)
        exponent = _plain(float(slope[-1]), uncertainty)
        coefficient = math.copysign(10 ** float(height[-1] - exponent * decade[end]), rate[end])
        return Law(exponent, coefficient), uncertainty
    if gone and (abs(rate[end + 1]) <= 1e3 * error[end + 1] or abs(rate[end]) < abs(rate[end - 1])):
        return Law(Fraction(0), 0.0), 0.0
    return None


def _plain(q, uncertainty):
    """The fraction that q is within its uncertainty, or q to as many digits as are known."""
    near = Fraction(q).limit_denominator(DENOMINATOR)
    return near if abs(q - near) <= uncertainty else round(q, max(0, -math.floor(math.log10(uncertainty))))


def _bounded(pencil, high):
    """The largest growth at large |xi| if all |lambda| are bounded there, so far as many samples tell; else None."""
    if high < 2 * WINDOW:
        return None
    chance, top, rates = np.random.default_rng(0), [], []
    for decade in range(high - WINDOW, high):
        d = chance.normal(size=(pencil.dim, SAMPLES))
        xi = 10.0 ** (decade + chance.uniform(0, 1, SAMPLES)) * d / np.linalg.norm(d, axis=0)
        xi = xi[0] if pencil.dim == 1 else xi
        lam = pencil.eigenvalues(xi)
        if not np.isfinite(lam).all():
            return None
        top.append(np.abs(lam).max())
        best = np.argmax(lam[:, 0].real)
        rates.append(float(places.climbed(pencil, xi[..., best : best + 1], 1 / SAMPLES)[1][0]))
    largest = max(rates) if abs(max(rates)) > STILL * max(top) else 0.0
    return largest if max(top) <= (1 + SAME) * min(top) else None
