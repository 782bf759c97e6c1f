"""Tell what a run of the toy system will do, and whether to blame the scheme or the equations, of which more is known.

Where the run can be made in less time than it takes to foretell it, it is made, with companions; otherwise (many
digits, very many steps) the growth of small perturbations is followed on the smooth solution.
"""

from __future__ import annotations

import math
from numbers import Real

import numpy as np

from primer.checks import instance, shown
from primer.problems.toy import Toy
from primer.schemes.discrete import discrete_steady
from primer.schemes.ftcs import ftcs
from primer.schemes.grid import Grid
from primer.schemes.record import plan
from primer.schemes.run import Seed, Stop
from primer.study.exact import MOST_DIGITS, exact_march
from primer.study.forecast import Forecast, forecast
from primer.study.kinds import Diagnosis, Kind
from primer.study.real_mode import nothing_grows
from primer.study.spectrum import leader, rate
from primer.study.stability import OVERSHOOT, amplification_over_modes, stable_dt
from primer.study.toy_reason import said_of
from primer.types import DTypeLike

# A blow-up measured within [earliest, latest]: the width, a factor 1.45, is twice the spread of measured times over
# random scenes (tests/test_diagnose.py), and reaches further up since a seed may lie badly for the growing mode.
_EARLIEST, _LATEST = 0.87, 1.26
_FINEST = 5000  # points; the march of the perturbations takes minutes there where waves grow, and goes as n^2
_MUCH_LATER = 2.0  # a blow-up that a smaller step puts off by this factor is the scheme's, whatever becomes of it then
_DOUBLE = 17  # digits; with more, the smooth solution itself is marched: double precision cannot see what it does
_WAVE, _GROWTH = 0.3, 0.04  # steps over h^2 and over 1/growth to which such a march may be coarsened
_MAX_WORK = 3e8  # products of numbers in it: ten minutes and more
_QUICK = 1e9  # points times steps of a run that takes seconds
_GENTLE = 0.2  # the same for a run of that small step, of which each costs
_SOONER = 1.1  # by which a seed must be sooner than round-off to be what the run is lost to
_SAME = 0.03  # times of blow-up in two arithmetics that are no accident
_RESTS, _AT_REST = 32.0, 1e-6  # time after which the way to the steady state, e^{-t/2}, is no longer than that
_SMALL = 0.05  # a step so far below the scheme's limit that only the equations are left to blame


def foretold(
    toy: Toy,
    n: int = 100,
    dt: float = 1e-3,
    t_end: float = 100.0,
    seed: Seed | tuple | float | None = None,
    dtype: DTypeLike = np.float64,
    digits: int | None = None,
    run: bool = False,
) -> Diagnosis:
    """What :func:`primer.diagnose` says of a ``Toy``; arguments as there.

    With ``run`` the run is made where that is possible and takes seconds at most. Otherwise nothing is run but, with
    more than 17 digits, the smooth solution, on half the grid in whole numbers (``exact_march``): it may be lost before
    round-off has grown.
    """
    instance("toy", toy, Toy)
    if isinstance(seed, Real) and not isinstance(seed, bool):
        seed = Seed(Grid(n).n // 2 - 1, seed)
    asked = plan(n, dt, t_end, None, (), seed, 1e3, dtype, digits)
    if asked.grid.n > _FINEST:
        raise ValueError(f"n must be an integer <= {_FINEST} for a diagnosis, got {asked.grid.n}")
    n, dt, t_end, seed = asked.grid.n, asked.dt, asked.steps * asked.dt, asked.seed
    if seed and seed.field not in toy.fields:
        raise ValueError(f"seed field must be one of {', '.join(toy.fields)}, got {shown(seed.field)}")
    epsilon = max(asked.numbers.epsilon, 1e-300)
    many = digits if digits is not None and digits > _DOUBLE else None
    if run and digits is None and asked.numbers.dtype in (np.float32, np.float64) and n * asked.steps <= _QUICK:
        lead = leader(toy, n, dt)
        found, gentle, small, seen = _watched(toy, n, dt, t_end, seed, asked.numbers.dtype, rate(lead[0], dt) <= 0)
        return _said(toy, n, dt, t_end, seed, found, gentle, gentle.t_first_negative, lead, small, seen)
    found, gentle = _foreseen(toy, n, dt, t_end, seed, epsilon, many), None
    blows_up, t_dip = found.t_blow_up <= t_end, found.t_first_negative
    if blows_up and many and found.smooth and dt <= _accurate(toy, n):
        gentle = found
    elif blows_up:
        gentle = _with_a_small_step(toy, n, dt, max(t_end, 1.5 * found.t_blow_up), seed, epsilon, many) or found
        t_dip = gentle.t_first_negative  # which the scheme may not have let it reach
    return _said(toy, n, dt, t_end, seed, found, gentle or found, t_dip, leader(toy, n, dt))


def _said(toy, n, dt, t_end, seed, found, gentle, t_dip, lead, small=None, seen=math.inf):
    """The diagnosis from what becomes of the run and of one with a small step; ``small`` is that, if both were run.

    ``lead`` is the fastest mode of the steady state, and ``seen`` the time to which the run was made.
    """
    blows_up = found.t_blow_up <= t_end
    later = gentle.t_blow_up / max(found.t_blow_up, dt)
    if blows_up and (gentle.t_blow_up > max(t_end, 1.5 * found.t_blow_up) or later > _MUCH_LATER):
        kind = Kind.SCHEME
    elif toy.eps > 0 and toy.a < 1:
        kind = Kind.ILL_POSED if blows_up else Kind.HIDDEN
    elif toy.eps > 0 and t_dip is not None:
        kind = Kind.TRANSIENT
    else:
        kind = Kind.ILL_POSED if blows_up else Kind.CONVERGES
    interval = (_EARLIEST * found.t_blow_up, _LATEST * found.t_blow_up) if blows_up else None
    growth = float(rate(lead[0], dt))
    where = _ill_where(toy) if toy.eps > 0 and (toy.a < 1 or t_dip is not None) else ""
    reason = said_of(kind, toy, n, dt, t_end, found, gentle, t_dip, growth, where or "where u < 0", small)
    if small is not None:
        how = "cheaper than to foretell it" if seen >= t_end else f"to t = {seen:g}: at rest there, and nothing grows"
        reason = f"{reason[:-1]} (as running it shows, which is {how})."
        reason = reason.replace("shows, which is to", "shows to")
    return Diagnosis(
        kind, interval, growth, reason, seed, blows_up and found.seeded, found.t_blow_up, _growths(toy, n),
        2 * math.pi / lead[1], _cure(toy, n) if kind is Kind.SCHEME else math.nan, where, small is not None,
        _amplification(toy, n, dt),
    )  # fmt: skip


def _growths(toy, n):
    """The fastest growth on the steady state as dt -> 0 on n, 2 n and 4 n points; 0 where nothing grows."""
    return tuple(0.0 if nothing_grows(toy, m) else max(leader(toy, m)[0].real, 0.0) for m in (n, 2 * n, 4 * n))


def _amplification(toy, n, dt):
    """Of each wave, frozen at the u of the steady state that is worst for it: the least or the greatest.

    The conditions that both factors of a wave are within a circle are linear in u (Jury), so that those u are an
    interval: the largest factor is at one of its ends.
    """
    deep = Grid(n).h / math.sin(Grid(n).h)
    factors = [amplification_over_modes(toy, n, dt, u)[1][:, 0] for u in (toy.a - deep, toy.a + deep)]
    return tuple(np.maximum(*factors).tolist())


def _cure(toy, n):
    """The step that lets nothing grow where u >= 0."""
    return stable_dt(toy, n, np.array([0.0, max(toy.a + OVERSHOOT, 0.0)]))


def _ill_where(toy):
    if abs(toy.a) < 1:
        return f"where u < 0, for |x| < {math.acos(toy.a):.3g}"
    return "where u < 0, for all x" if toy.a <= -1 else "where u < 0, on the way"


def _watched(toy, n, dt, t_end, seed, dtype, decays):
    """(found, gentle, small, seen): what becomes of the run, and of one with a small step, as forecasts; that step.

    ``decays`` says that on the steady state nothing grows: a run that is at rest on it at the time ``seen`` stays.
    """
    seen = t_end if t_end <= _RESTS or not decays else _RESTS
    run = ftcs(toy, n, dt, seen, seed=seed, dtype=dtype, progress=False)
    rest = discrete_steady(toy, run.x, Grid(n).h)
    if run.stop is not Stop.BLEW_UP and seen < t_end and np.abs(np.subtract(run.final, rest)).max() > _AT_REST:
        seen, run = t_end, ftcs(toy, n, dt, t_end, seed=seed, dtype=dtype, progress=False)
    small = min(dt, _GENTLE * min((math.pi / n) ** 2, stable_dt(toy, n, max(toy.a + 1.2, 0.0))))
    if run.stop is not Stop.BLEW_UP:
        found = Forecast(math.inf, False, False, run.t_first_negative)
        return found, found, small, seen
    t = run.t_stop
    seeded = seed is not None and _lost(toy, n, dt, _SOONER * t, None, dtype) == math.inf
    other = np.float32 if dtype == np.float64 else np.float64
    # Other digits change when round-off takes over, and not when the smooth solution is lost.
    smooth = not seeded and seed is None and abs(_lost(toy, n, dt, 1.1 * t, None, other) / t - 1) < _SAME
    found = Forecast(t, seeded, smooth, run.t_first_negative)
    if dt <= small or dt <= _GENTLE * _cure(toy, n):
        return found, found, small, t_end
    later = ftcs(toy, n, small, (_MUCH_LATER + 0.1) * t, seed=seed, dtype=dtype, progress=False)
    t_later = later.t_stop if later.stop is Stop.BLEW_UP else math.inf
    return found, Forecast(t_later, False, False, later.t_first_negative), small, t_end


def _lost(toy, n, dt, t_end, seed, dtype):
    run = ftcs(toy, n, dt, t_end, seed=seed, dtype=dtype, progress=False)
    return run.t_stop if run.stop is Stop.BLEW_UP else math.inf


def _foreseen(toy, n, dt, t_end, seed, epsilon, digits, **options):
    """The forecast, and where there are many digits what the smooth solution does by itself up to then."""
    if digits is None:
        return forecast(toy, n, dt, t_end, seed, epsilon, **options)
    found = forecast(toy, n, dt, t_end, seed, epsilon, smooth_too=False, **options)
    until = min(found.t_blow_up, t_end)
    step = max(dt, _accurate(toy, n))
    if until / step * n > _MAX_WORK:
        raise ValueError(
            f"n, dt and t_end must be such that n t_end/dt <= {_MAX_WORK:.0e} where a diagnosis is asked for with more "
            f"than {_DOUBLE} digits, got n = {n} and {until / step:.0f} steps"
        )
    alone = exact_march(toy, n, step, until, min(digits, MOST_DIGITS))
    if alone.stop is not Stop.BLEW_UP:
        return found
    return Forecast(alone.t_stop, False, True, alone.t_first_negative)


def _accurate(toy, n):
    """A step by which the smooth solution is marched well enough to say when it is lost, where the scheme is stable."""
    h = Grid(n).h
    fastest = 4 * toy.eps * (1.2 - toy.a) / h**2  # at the least u on the way
    return min(_WAVE * h**2, _GROWTH / max(fastest, 1.0))


def _with_a_small_step(toy, n, dt, t_end, seed, epsilon, digits=None):
    """The forecast with a step that the scheme surely allows, or None if dt is such a one."""
    # At a - 1.2 < u < a + 1.2 the limit is at least that of u = 0, or that of the stiffest mode.
    small = _SMALL * min((math.pi / n) ** 2, stable_dt(toy, n, max(toy.a + 1.2, 0.0)))
    if dt <= small:
        return None
    return _foreseen(toy, n, small, t_end, seed, epsilon, digits, locks=False)
