"""The scene of the course: what the base state a, the coefficient eps and the grid N make of the toy system."""

import math
from dataclasses import dataclass

import numpy as np

from primer.checks import integer, real
from primer.problems.toy import Toy
from primer.schemes.ftcs import ftcs
from primer.schemes.grid import Grid
from primer.schemes.run import Run, Stop
from primer.study.diagnosis import Kind
from primer.study.spectrum import growth
from primer.study.stability import stable_dt

MAX_N = 400  # finer grids answer too slowly for a slider
T_END = 100.0  # where the paper ends
_DT = 1e-3  # the paper's step
_SHOTS = np.arange(0, T_END + 0.25, 0.5)  # times that can be looked at
_SAFETY = 0.9  # of the scheme's own limit
_SLOW = 1e-6  # a rate that round-off cannot tell from zero
_BIT = 2.0**-53  # the relative size of a rounding error, from which an unseeded mode starts


@dataclass(frozen=True, eq=False)
class BaseStateAnswer:
    """What :func:`base_state` found.

    Attributes
    ----------
    run            the :class:`primer.Run` to t = 100 or to its blow-up, with snapshots at every half unit of time
    xi, rate       (k,) wavenumbers and max Re lambda of eq. (toy-mat) frozen at x = 0, where u = a - 1 is least
    grid_xi, grid_rate    the same as the grid sees it, up to its cut-off N/2 = pi/h
    growth         per unit time, of the fastest perturbation of the discrete steady state: the true rate of this grid
    predicted      when round-off of 2^-53 has grown to 1 at that rate, from the first u = 0 on; infinite if never
    measured       when the run blew up; infinite if it did not
    kind           a :class:`primer.study.diagnosis.Kind`
    verdict        the same in words
    """

    run: Run
    xi: np.ndarray
    rate: np.ndarray
    grid_xi: np.ndarray
    grid_rate: np.ndarray
    growth: float
    predicted: float
    measured: float
    kind: Kind
    verdict: str


def base_state(a: float = 1.5, eps: float = 0.01, n: int = 100) -> BaseStateAnswer:
    """March the toy system from (toy-initial) on n points, and say what its symbol and its grid foretell.

    The step is the paper's 10^-3, or 0.9 of what keeps the scheme stable, if that is less: what blows up here is not
    the scheme.

    Raises
    ------
    TypeError, ValueError    for a outside [-10, 10], eps outside [0, 1], n outside [4, 400]
    """
    a, eps = real("a", a, least=-10, most=10), real("eps", eps, least=0, most=1)
    n = integer("n", n, least=4, most=MAX_N)
    toy = Toy(a, eps)
    # Where u < 0 no step is stable; the limit that a smaller step could meet is that of the u >= 0 it visits.
    dt = min(_DT, _SAFETY * stable_dt(toy, n, np.clip([a - 1.2, a + 1.2], 0, None)))
    run = ftcs(toy, n, dt, T_END, snapshots=_SHOTS)
    xi, grid_xi = np.linspace(0, 128, 257), np.linspace(0, n / 2, 129)
    grid_rate, rate = _symbol_growth(toy, grid_xi, Grid(n).multiplier), growth(toy, n)
    predicted = (run.t_first_negative or 0.0) - math.log(_BIT) / rate if rate > _SLOW else math.inf
    measured = run.t_stop if run.stop is Stop.BLEW_UP else math.inf
    kind = _kind(toy, run, measured)
    return BaseStateAnswer(
        run,
        xi,
        _symbol_growth(toy, xi),
        grid_xi,
        grid_rate,
        rate,
        predicted,
        measured,
        kind,
        _verdict(kind, toy, run, grid_rate.max(), rate, predicted),
    )


def _symbol_growth(toy, xi, multiplier=None):
    """max Re lambda of eq. (toy-mat) at u* = a - 1, v_xx* = 0, where lam^2 + b lam + s2 = 0."""
    S = toy.symbol(xi, toy.a - 1, multiplier=multiplier)
    b, s2 = -S[..., 1, 1].real, -(S[..., 0, 1] * S[..., 1, 0]).real
    # -2 s2/(b + root) where b > 0: no cancellation.
    root = np.sqrt(np.maximum(b**2 / 4 - s2, 0))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(b > 0, np.where(root > 0, -s2 / (b / 2 + root), -b / 2), root - b / 2)


def _kind(toy, run, measured):
    blew_up = measured < math.inf
    if toy.eps > 0 and toy.a < 1:
        return Kind.ILL_POSED if blew_up else Kind.HIDDEN
    if toy.eps > 0 and run.t_first_negative is not None:
        return Kind.TRANSIENT
    return Kind.ILL_POSED if blew_up else Kind.CONVERGES


def _verdict(kind, toy, run, frozen, rate, predicted):
    grid = f"N = {run.n} points"
    if kind is Kind.CONVERGES:
        why = "there is no second derivative" if toy.eps == 0 else "u stays positive"
        return (
            f"Well posed: {why}, every short wave decays, and Dist comes to rest at {run.dist[-1]:.3g}, "
            f"the error of {grid}."
        )
    if kind is Kind.TRANSIENT:
        end = (
            f"the run blew up at t = {run.t_stop:.3g}, before u could recover"
            if run.stop is Stop.BLEW_UP
            else f"on {grid} it recovers, and Dist ends at {run.dist[-1]:.3g}"
        )
        steady = "is well posed" if toy.a > 1 else "just touches u = 0"
        return (
            f"Marginal: the steady state {steady}, but on the way u dips below zero, first at "
            f"t = {run.t_first_negative:.3g}, and there the equations are ill posed; {end}."
        )
    where = "everywhere" if toy.a <= -1 else f"for |x| < {math.acos(toy.a):.3g}"
    ill = f"Ill posed: in the steady state u < 0 {where}, and there the shorter a wave the faster it grows."
    if kind is Kind.HIDDEN and not predicted < math.inf:
        why = (
            f"frozen at x = 0 the shortest waves of {grid} would grow, but none fits into the stretch where u < 0"
            if frozen > _SLOW
            else f"{grid} hold no wave short enough to grow"
        )
        return f"{ill} The picture looks fine all the same: {why}. Refine the grid and it blows up."
    grows = f"On {grid} the fastest mode grows like e^({rate:.3g} t)"
    if kind is Kind.HIDDEN:  # no time here: so slow a mode may be lost in the last bit of every step, and never come
        return f"{ill} {grows}, too slowly for round-off to be seen by t = {run.t_stop:g}. A finer grid blows up."
    foretold = f"from the last bit it is as large as u near t = {predicted:.3g}"
    return f"{ill} {grows}; {foretold}. The run blew up at t = {run.t_stop:.3g}."
