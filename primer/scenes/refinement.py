"""The scene of refinement: the toy system on a grid, on one twice and on one four times as fine, with one step dt."""

import math
from dataclasses import dataclass

import numpy as np

from primer.checks import integer, real
from primer.problems.toy import Toy
from primer.schemes.discrete import amplification, dist_floor
from primer.schemes.ftcs import ftcs
from primer.schemes.grid import Grid
from primer.schemes.run import Run
from primer.study.diagnosis import Kind
from primer.study.round_off import blow_up_time
from primer.study.spectrum import growth
from primer.study.stability import stable_dt

T_END = 40.0  # what is left of the data is e^-20 by then: a run that converges is on its floor
EPS = 0.01  # the paper's
_SHOTS = np.arange(0, T_END + 0.25, 0.5)  # times that can be looked at
_SAFETY = 0.9  # of the scheme's own limit
_LATER = 1.5  # a smaller step that buys more than this factor of time: it was the step
_DIP = 5.0  # where u is lowest on its way is t = 3.02: what is below zero later has not come from the data
_AT_REST = 0.01  # relative distance from the floor that counts as none


@dataclass(frozen=True, eq=False)
class RefinementAnswer:
    """What :func:`refinement` found, each a tuple over the three grids, coarsest first.

    Attributes
    ----------
    runs             :class:`primer.Run` to t = 40 or to the blow-up, with snapshots at every half unit of time
    floor            h/sin h - 1, where Dist comes to rest if nothing grows
    xi, rate         wavenumbers up to N/2, and the growth ln|1 + dt lam|/dt of eq. (toy-mat) as grid and step see it,
                     the largest over the u of the steady state; each of shape (k,)
    growth           per unit time, of the fastest perturbation of the discrete steady state, for a grid that blew up
                     because of it; NaN for others
    measured         when the run blew up; infinite if it did not
    allowed          the dt below which no frozen wave grows where u >= 0
    gentle_dt        a smaller step, which the scheme surely allows; a run that blew up is marched again with it
    gentle           when that blew up; infinite if it did not, or there was no need
    kinds            :class:`primer.study.diagnosis.Kind`
    verdict          did refining help? One text
    """

    runs: tuple[Run, ...]
    floor: tuple[float, ...]
    xi: tuple[np.ndarray, ...]
    rate: tuple[np.ndarray, ...]
    growth: tuple[float, ...]
    measured: tuple[float, ...]
    allowed: tuple[float, ...]
    gentle_dt: tuple[float, ...]
    gentle: tuple[float, ...]
    kinds: tuple[Kind, ...]
    verdict: str


def refinement(a: float = 0.5, n: int = 50, dt: float = 1e-3) -> RefinementAnswer:
    """March the toy system from (toy-initial) on n, 2n and 4n points with the same step: did refining help?

    What blows up is marched again with a smaller step, for only the scheme can be cured that way. The answer takes time
    in proportion to n/dt.

    Raises
    ------
    TypeError, ValueError    for a outside [-10, 10], n outside [6, 64], dt outside [1e-5, 0.1]
    """
    toy = Toy(real("a", a, least=-10, most=10), EPS)
    n, dt = integer("n", n, least=6, most=64), real("dt", dt, least=1e-5, most=0.1)
    found = [_on_grid(toy, factor * n, dt) for factor in (1, 2, 4)]
    columns = {name: tuple(one[name] for one in found) for name in found[0]}
    dips = [t for t in columns.pop("dip") if t is not None and t < _DIP]
    answer = RefinementAnswer(**columns, verdict="")
    object.__setattr__(answer, "verdict", _verdict(toy, answer, min(dips, default=None)))
    return answer


def _on_grid(toy, n, dt):
    """One column of the answer, and the first u = 0 that is not the scheme's."""
    run = ftcs(toy, n, dt, T_END, snapshots=_SHOTS)
    measured = blow_up_time(run)
    # Where u < 0 no step is stable; the limit that a smaller step could meet is that of the u >= 0 it visits.
    allowed = stable_dt(toy, n, np.clip([toy.a - 1.2, toy.a + 1.2], 0, None))
    gentle_dt, again = min(dt / 2, _SAFETY * allowed), run
    if measured < math.inf:
        again = ftcs(toy, n, gentle_dt, max(T_END, _LATER * measured))
    gentle = blow_up_time(again)
    scheme = measured < gentle and gentle > max(T_END, _LATER * measured)
    smooth = again if scheme else run
    first = smooth.t_first_negative
    kind = Kind.SCHEME if scheme else _kind(toy, measured, first)
    rate = growth(toy, n) if measured < math.inf and kind is Kind.ILL_POSED else math.nan
    xi = np.linspace(0, n / 2, 97)
    return {
        "runs": run,
        "floor": dist_floor(n),
        "xi": xi,
        "rate": _stepped_growth(toy, xi, Grid(n), dt),
        "growth": rate,
        "measured": measured,
        "allowed": allowed,
        "gentle_dt": gentle_dt,
        "gentle": gentle,
        "kinds": kind,
        "dip": first,
    }


def _kind(toy, measured, first_negative):
    if toy.a < 1:
        return Kind.ILL_POSED if measured < math.inf else Kind.HIDDEN
    if first_negative is not None and first_negative < _DIP:
        return Kind.TRANSIENT
    return Kind.ILL_POSED if measured < math.inf else Kind.CONVERGES


def _stepped_growth(toy, xi, grid, dt):
    """ln|1 + dt lam|/dt of the frozen symbol on a grid, the largest over u* from a - 1 to a + 1; of the shape of xi."""
    u = toy.a + np.linspace(-1, 1, 5)[:, None]
    factors = np.abs(amplification(toy.symbol(xi, u, multiplier=grid.multiplier), dt)).max(axis=(0, -1))
    return np.log(factors) / dt


def _verdict(toy, answer, dip):
    return " ".join([_equations(toy, dip), *_alive(toy, answer, dip), *_lost(answer), *_scheme(toy, answer)])


def _equations(toy, dip):
    if toy.a < 1:
        where = "everywhere" if toy.a <= -1 else f"for |x| < {math.acos(toy.a):.3g}"
        return f"Ill posed: in the steady state u < 0 {where}, and there the shorter a wave the faster it grows."
    if dip is None:
        return "Well posed: u stays positive."
    return f"Marginal: on the way u dips below zero, first at t = {dip:.3g}, and there the equations are ill posed."


def _alive(toy, answer, dip):
    """What the grids that reached the end say, and what a reader may make of it."""
    alive = [i for i in range(3) if answer.measured[i] == math.inf]
    ends = [float(answer.runs[i].dist[-1]) for i in alive]
    resting = [i for i, end in zip(alive, ends, strict=True) if abs(end / answer.floor[i] - 1) < _AT_REST]
    off = [i for i in alive if i not in resting]
    late = [i for i in alive if toy.a > 1 and growth(toy, answer.runs[i].n, answer.runs[i].dt) > 0]
    if resting:
        rest = f"Dist comes to rest at {_listed(f'{answer.runs[i].dist[-1]:.3g}' for i in resting)}"
        rest += f" on {_grids(answer, resting)}, the floor h/sin h - 1 of the scheme"
        if len(resting) > 1:
            first, last = resting[0], resting[-1]
            order = math.log2(ends[alive.index(first)] / ends[alive.index(last)]) / (last - first)
            rest += f", of order {order:.2f} in h"
        if len(resting) == 3 and toy.a >= 1 and dip is None and not late:
            yield f"Refining helps: {rest}."
        elif len(resting) == 3 and not late:
            hides = "these grids hold no wave that grows enough to be seen, and a fine enough one blows up"
            yield f"Refining seems to help: {rest}, as if all were well. But {hides}."
        elif toy.a < 1:
            yield f"On a coarse grid it is hidden: {rest}."
        else:
            yield f"{rest}."
    if off:
        far = _listed(f"{answer.runs[i].dist[-1] / answer.floor[i]:.3g}" for i in off)
        yield f"By t = {T_END:g}, {_grids(answer, off)} had not blown up, with Dist {far} times the floor."
    if late:
        rate = growth(toy, answer.runs[late[-1]].n, answer.runs[0].dt)
        yield (
            f"But dt = {answer.runs[0].dt:.2g} is too large for {_grids(answer, late)}: perturbations of that rest "
            f"grow, like e^({rate:.3g} t) on N = {answer.runs[late[-1]].n}, unseen by t = {T_END:g}."
        )


def _lost(answer):
    """The grids that the equations blew up."""
    lost = [i for i in range(3) if answer.measured[i] < math.inf and answer.kinds[i] is not Kind.SCHEME]
    if lost:
        times = [answer.measured[i] for i in lost]
        sooner = ": finer is sooner" if len(lost) > 1 and times == sorted(times, reverse=True) else ""
        i = lost[-1]
        mode = f"; on N = {answer.runs[i].n} the fastest mode grows like e^({answer.growth[i]:.3g} t)"
        fastest = mode if answer.growth[i] > 0 else ""
        yield (
            f"Refining does not help{sooner}. {_blew_up(answer, lost)}{fastest}. Nor does a smaller "
            f"step: with dt = {answer.gentle_dt[i]:.2g} "
            f"in place of {answer.runs[i].dt:.2g} it blew up at t = {answer.gentle[i]:.3g}."
        )


def _scheme(toy, answer):
    """The grids that the step blew up."""
    lost = [i for i in range(3) if answer.kinds[i] is Kind.SCHEME]
    if lost:
        i = lost[-1]
        yield (
            f"It is the scheme that blows up: dt = {answer.runs[i].dt:.2g} is too large, since a finer grid needs a "
            f"smaller step. {_blew_up(answer, lost)}; up to dt = {answer.allowed[i]:.2g} no wave grows on "
            f"N = {answer.runs[i].n} where u > 0, and with dt = {answer.gentle_dt[i]:.2g} it lives to "
            f"t = {max(T_END, _LATER * answer.measured[i]):.3g}."
        )
        if toy.a < 1:
            yield "A smaller step is no cure for the equations: where u < 0 a finer grid blows up with any."


def _blew_up(answer, lost):
    return _listed(f"N = {answer.runs[i].n} blew up at t = {answer.measured[i]:.3g}" for i in lost)


def _grids(answer, which):
    return "N = " + _listed(str(answer.runs[i].n) for i in which)


def _listed(texts):
    """one, two and three."""
    *first, last = texts
    return f"{', '.join(first)} and {last}" if first else last
