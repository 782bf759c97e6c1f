"""A diagnosis about a uniform, steady state: its waves are known one by one, on every grid and for every step."""

import math

import numpy as np

from primer.schemes.grid import CENTRAL
from primer.schemes.jacobian import rates
from primer.schemes.limit import NEUTRAL, factor, largest_step
from primer.schemes.marching import fields_of, grid_of, slope_of
from primer.study.kinds import Diagnosis, Kind
from primer.study.waves import folded

_RISES = 0.2  # the power of n from which on growth is not bounded
_SPREAD = 1.26  # a blow-up comes this factor sooner or later than e-foldings say


def uniform(problem, n):
    """Whether the initial data are uniform, and steady, and the equations the same everywhere at all times."""
    known = hasattr(problem, "evolution") or hasattr(problem, "symbol")
    if not known or not getattr(problem, "autonomous", True):
        return False
    grid = grid_of(problem, n)
    state = np.array(fields_of(problem, "initial", grid.x))
    if any(np.ptp(part) for f in state for part in (f.real, f.imag)):
        return False
    with np.errstate(all="ignore"):
        slope = slope_of(problem, grid.x, lambda f, m: CENTRAL[m](f, grid.h))(state, 0.0)
    return bool(np.abs(slope).max() <= 1e-12 * max(np.abs(state).max(), 1.0))


def about_uniform(problem, n, dt, t_end, seed, epsilon, time):
    """The :class:`Diagnosis` of perturbations of that state: of the seed, or of round-off."""
    lam = [_of_waves(problem, k * n) for k in (1, 2, 4)]
    scheme_growth = np.log(np.maximum(np.abs(factor(time, dt * lam[0])), 1e-300)) / dt
    own = [each.real > NEUTRAL * max(np.abs(each).max(), 1e-300) for each in lam]
    growths = tuple(float(each.real.max()) if mine.any() else 0.0 for each, mine in zip(lam, own, strict=True))
    fastest = float(scheme_growth[own[0]].max(initial=0.0))
    bad = float(scheme_growth[~own[0]].max(initial=0.0))
    bad = bad if bad * dt > 1e-12 else 0.0
    start = abs(seed.amplitude) if seed is not None and seed.amplitude else epsilon
    place = np.unravel_index(np.argmax(scheme_growth if bad > fastest else np.where(own[0], scheme_growth, -np.inf)),
                             lam[0].shape)  # fmt: skip
    if not own[0].any() and not bad:
        place = np.unravel_index(np.argmax(lam[0].real), lam[0].shape)
    waves = min(place[0], n - place[0])
    length = grid_of(problem, n).h * n / waves if waves else math.inf
    rate = max(fastest, bad)
    t_lost = math.log(1 / start) / rate if rate > 0 else math.inf
    rises = growths[1] > 0 and growths[2] > 0 and math.log(growths[2] / growths[1]) / math.log(2) >= _RISES
    limit = largest_step(lam[0].ravel(), time)
    size = f"{', '.join(f'{g:.3g}' for g in growths)} on n = {n}, {2 * n}, {4 * n}"
    waves_text = f"waves of length {length:.3g}" if waves else "the uniform state itself"
    when = f"from {start:.0e} they are as large as 1 near t = {t_lost:.3g}"
    lost = t_lost <= t_end
    if bad > fastest and lost:
        kind = Kind.SCHEME
        cure = f"dt <= {limit:.3g} would do" if limit > 0 else f"no dt would do with {time.name}, only another scheme"
        reason = f"The step dt = {dt:g} lets {waves_text} grow like e^({bad:.3g} t) on n = {n}, and {when}; {cure}."
    elif rises and growths[0] > 0 and lost:
        kind = Kind.ILL_POSED
        reason = (
            f"Growth rises with the grid, {size}: the equations are ill posed as these grids see them, {waves_text} "
            f"grow like e^({fastest:.3g} t), and {when}; no smaller dt helps."
        )
    elif rises:
        kind = Kind.HIDDEN
        reason = (
            f"Growth rises with the grid, {size}: the equations are ill posed as these grids see them, but on n = {n} "
            f"nothing comes of it by t = {t_end:g}."
        )
    elif growths[0] > 0:
        kind = Kind.UNSTABLE
        reason = f"Growth is bounded, {size}: {waves_text} grow like e^({fastest:.3g} t), the model's own, and {when}."
    else:
        kind = Kind.CONVERGES
        reason = f"Nothing grows on n = {n} points with dt = {dt:g} ({size} as dt -> 0)."
        if bad:
            reason = f"Nothing grows as dt -> 0, and with dt = {dt:g} only like e^({bad:.3g} t): {when}, after the end."
    t_lost = t_lost if kind is not Kind.CONVERGES or bad else math.inf
    blows = lost and kind in (Kind.SCHEME, Kind.ILL_POSED)
    interval = (t_lost / _SPREAD, t_lost * _SPREAD) if blows else None
    return Diagnosis(
        kind, interval, rate if rate > 0 else float(scheme_growth.max()), reason, seed, blows and seed is not None,
        t_lost, growths, length, limit if kind is Kind.SCHEME else math.nan,
        "for all x" if rises else "", False, folded(np.exp(dt * scheme_growth).max(axis=1)),
    )  # fmt: skip


def _of_waves(problem, n):
    """(n, fields) the rates of the waves 0, 1, ... n - 1."""
    return rates(problem, n).reshape(n, -1)
