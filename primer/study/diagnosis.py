"""Tell, without running it, what a run of the toy system will do, and whether to blame the scheme or the equations."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from numbers import Real

import numpy as np

from primer.checks import instance, shown
from primer.problems.toy import Toy
from primer.schemes.grid import Grid
from primer.schemes.record import plan
from primer.schemes.run import Seed, Stop
from primer.study.exact import MOST_DIGITS, exact_march
from primer.study.forecast import Forecast, forecast
from primer.study.spectrum import growth
from primer.study.stability import stable_dt
from primer.types import DTypeLike

# A blow-up measured within [earliest, latest]: the width, a factor 1.45, is twice the spread of measured times over
# random scenes (tests/test_diagnose.py), and reaches further up since a seed may lie badly for the growing mode.
_EARLIEST, _LATEST = 0.87, 1.26
_FINEST = 5000  # points; the march of the perturbations takes minutes there where waves grow, and goes as n^2
_MUCH_LATER = 2.0  # a blow-up that a smaller step puts off by this factor is the scheme's, whatever becomes of it then
_DOUBLE = (
    17  # digits; with more, what the smooth solution does by itself is marched, for double precision cannot see it
)
_WAVE, _GROWTH = 0.3, 0.04  # steps over h^2 and over 1/growth to which such a march may be coarsened
_MAX_WORK = 3e8  # products of numbers in it: ten minutes and more
_SMALL = 0.05  # a step so far below the scheme's limit that only the equations are left to blame


class Kind(StrEnum):
    """What becomes of a run."""

    CONVERGES = "converges"  # well posed throughout, and the scheme is stable
    HIDDEN = "hidden"  # ill posed, but this grid cannot see it by the end of the run
    ILL_POSED = "ill-posed"  # ill posed, and this grid blows up
    TRANSIENT = "transient"  # a well-posed steady state, but u dips below zero on the way
    SCHEME = "scheme"  # the time step is too large: a smaller one lives


@dataclass(frozen=True)
class Diagnosis:
    """What :func:`diagnose` foresees.

    Attributes
    ----------
    kind       a :class:`Kind`
    blow_up    (earliest, latest) time of the blow-up, or None if the run will reach its end
    growth     per unit time, of the fastest small perturbation of the steady state on this grid: ln|1 + dt lam|/dt
    reason     one sentence
    seed       the stated perturbation, or None
    seeded     whether the blow-up grows from it rather than from round-off
    t_blow_up  the single best guess, also where it lies after t_end; infinite if never

    Figures 4 to 6 of the paper are of the kinds converges, ill-posed and hidden.

    >>> from primer import Toy
    >>> found = diagnose(Toy(0.5), n=100)
    >>> earliest, latest = found.blow_up
    >>> print(found.kind, earliest < 14 < latest, f"{found.growth:.3f}")
    ill-posed True 2.724
    """

    kind: Kind
    blow_up: tuple[float, float] | None
    growth: float
    reason: str
    seed: Seed | None
    seeded: bool
    t_blow_up: float


def diagnose(
    toy: Toy,
    n: int = 100,
    dt: float = 1e-3,
    t_end: float = 100.0,
    seed: Seed | tuple | float | None = None,
    dtype: DTypeLike = np.float64,
    digits: int | None = None,
) -> Diagnosis:
    """Foresee what ``primer.ftcs(toy, n, dt, t_end, seed=seed, dtype=dtype, digits=digits)`` will do.

    Nothing is run: the growth of small perturbations, from the stated seed and from round-off in the stated arithmetic,
    is followed on the smooth solution, and where a smaller dt may help a second time with dt near zero. Only with more
    than 17 digits is the smooth solution itself marched, on half the grid in whole numbers (``exact_march``): it may be
    lost before round-off has grown.

    Parameters
    ----------
    toy             a ``Toy``
    n, dt, t_end    grid points >= 4, step > 0, end >= 0
    seed            a ``Seed``, or its arguments as a tuple, or None; a number is the amplitude of the mode n//2 - 1 of
                    u, next to the sawtooth and so to what grows. The mode matters: from a low one, hardly anything
                    reaches the growing ones before round-off does
    dtype, digits   the arithmetic, as for ``ftcs``

    Returns
    -------
    Diagnosis. On scenes with a in [-1, 2], eps in [0.001, 0.1], n in [8, 600], dt in [1e-5, 0.02] and a seed of 1e-6 in
    any mode, the blow-up comes within the interval in more than nine of ten. Seeds are taken as small.

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not allowed

    The scheme is that of section A2.2.2.

    >>> [str(diagnose(Toy(a), n).kind) for a, n in ((1.5, 100), (0.5, 100), (0.5, 30))]  # Figures 4 to 6
    ['converges', 'ill-posed', 'hidden']
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
    found, gentle = _foreseen(toy, n, dt, t_end, seed, epsilon, many), None
    blows_up, t_dip = found.t_blow_up <= t_end, found.t_first_negative
    if blows_up and many and found.smooth and dt <= _accurate(toy, n):
        gentle = found
    elif blows_up:
        gentle = _with_a_small_step(toy, n, dt, max(t_end, 1.5 * found.t_blow_up), seed, epsilon, many) or found
        t_dip = gentle.t_first_negative  # which the scheme may not have let it reach
    gentle = gentle or found
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
    rate = growth(toy, n, dt)
    reason = _reason(kind, toy, n, dt, t_end, found, gentle, t_dip, rate)
    return Diagnosis(kind, interval, rate, reason, seed, blows_up and found.seeded, found.t_blow_up)


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


def _reason(kind, toy, n, dt, t_end, found, gentle, t_dip, rate):
    source = "the seed" if found.seeded else "the smooth solution itself" if found.smooth else "round-off"
    when = f"what grows from {source} is as large as u near t = {found.t_blow_up:.3g}"
    if kind is Kind.SCHEME:
        lives = "a smaller one lives to the end"
        if gentle.t_blow_up <= t_end:
            lives = f"a smaller one lives to about t = {gentle.t_blow_up:.3g}"
            lives += (
                ", and is lost to the equations, ill posed where u < 0" if gentle.t_first_negative is not None else ""
            )
        return f"The step dt = {dt:g} is too large for n = {n}, and {when}; {lives}."
    if kind is Kind.ILL_POSED:
        return f"Where u < 0 the equations are ill posed, n = {n} points see it, and {when}; no smaller dt helps."
    if kind is Kind.HIDDEN:
        if rate <= 0:
            return f"The equations are ill posed where u < 0, but on n = {n} points nothing grows on the steady state."
        if found.t_blow_up < math.inf:
            return (
                f"The equations are ill posed where u < 0, but on n = {n} points perturbations grow only by "
                f"e^({rate:.3g} t): {when}, after the end."
            )
        return (
            f"The equations are ill posed where u < 0, but on n = {n} points perturbations grow only by "
            f"e^({rate:.3g} t), so slowly that each step of theirs is lost in the last bit."
        )
    if kind is Kind.TRANSIENT:
        first = f"The steady state is well posed, but u dips below zero at t = {t_dip:.3g}"
        if found.t_blow_up <= t_end:
            return f"{first}, n = {n} points see that it is ill posed there, and {when}."
        return f"{first}; it recovers before anything on n = {n} points has grown enough."
    why = "the equations have no second derivative" if toy.eps == 0 else "u stays positive"
    return f"The equations are well posed, as {why}, and nothing on n = {n} points grows to matter."
