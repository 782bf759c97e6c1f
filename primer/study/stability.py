"""The time step that a scheme allows: numerical instability, which dt cures. In closed form for the frozen toy system:

A mode with s^2 = sin^2(kh)/h^2 = 4 S (1 - S)/h^2 and k2 = 4 S/h^2, S = sin^2(kh/2), on a frozen u is multiplied each
step by mu = 1 + dt lam, lam^2 + b lam + s^2 = 0, b = 1 + eps u k2. By Jury's conditions both |mu| <= 1 iff::

    dt s^2 <= b    and    4 - 2 b dt + s^2 dt^2 >= 0

With g = 4 eps u/h^2, the first is tightest over S at S = 1/(1 + sqrt(1 + g)), the second at the sawtooth S = 1::

    dt <= (h^2/4) (1 + sqrt(1 + g))^2    and    dt <= 2/(1 + g)

The first bound grows with u and the second falls. Where g < -1 the sawtooth has b < 0: it grows for every dt > 0, the
ill-posedness as this grid sees it, and the finer the grid the faster.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from primer.checks import instance, real, real_array, shown
from primer.problems.toy import Toy
from primer.schemes.discrete import amplification
from primer.schemes.grid import Grid
from primer.schemes.jacobian import rates
from primer.schemes.limit import largest_step
from primer.schemes.marching import a_problem, grid_of
from primer.schemes.runge_kutta import EULER, RungeKutta
from primer.types import ArrayLike, Numbers

# max m of u = a - m cos x at eps = 0: 1 + e^{-t/2} cos(pi/6) at t = (5 pi/3)/sqrt(3), where m' = 0.
OVERSHOOT = 1 + math.sqrt(3) / 2 * math.exp(-5 * math.pi / (6 * math.sqrt(3)))


def frozen_dt(h: float, u: ArrayLike, eps: float) -> Numbers:
    """The largest dt for which no mode grows on spacing h with u frozen; 0 where it is ill posed for every dt.

    Parameters
    ----------
    h, u, eps    spacing > 0, the frozen u, the coefficient >= 0; u of any shape

    Returns
    -------
    float, or an array of the shape of u: min(h^2, 2) at eps = 0
    """
    h, eps, u = real("h", h, above=0), real("eps", eps, least=0), real_array("u", u)
    g = 4 * eps * u / h**2
    well = np.maximum(1 + g, 0)
    with np.errstate(divide="ignore"):
        dt = np.minimum(h**2 / 4 * (1 + np.sqrt(well)) ** 2, 2 / well)
    dt = np.where(1 + g < 0, 0.0, dt)
    return float(dt) if dt.ndim == 0 else dt


def stable_dt(problem: Any, n: int, u: Any = None, time: RungeKutta = EULER, t: float = 0.0) -> float:
    """The largest step of the central differences on n points that amplifies no mode which does not grow of itself.

    A blow-up with a larger dt may be of the scheme, and a smaller dt then cures it. The modes are those of the
    Jacobian on the grid (:func:`primer.schemes.jacobian.rates`) about the state u. Forward Euler amplifies whatever
    swings without damping, however small the step: then it is 0. Where every mode grows of itself it is infinite.

    Parameters
    ----------
    problem    a ``PDE`` or any other problem
    n          its grid
    u          the state that counts: for each field a number or an array of shape (n,); left out, both the initial data
               and the steady state, if there is one
    time       ``EULER``, ``RK4`` or ``RK8``
    t          the time, where the equations depend on it

    Of a ``Toy`` and forward Euler, more is known: with coefficients frozen at any u that the run visits, it is the
    largest dt for which *no* mode grows, h^2 at eps = 0 (2, on four points), and 0 where the sawtooth grows whatever
    dt: the equations are ill posed there and the grid is fine enough for a frozen mode to feel it (whether the grid as
    a whole does, :func:`primer.grid_threshold` says). u are the values that count; left out, those of the solution for
    eps = 0: u = a - m(t) cos x passes through a -+ 1.1910 before it settles to a -+ 1.

    The scheme of section A2.2.2; what is frozen is eq. (toy-mat).

    >>> from primer import PDE, RK4, Toy
    >>> print(f"{stable_dt(Toy(1.5, eps=0), n=100):.6f}")  # h^2
    0.003948
    >>> stable_dt(Toy(0.5), n=200)  # no dt will do
    0.0
    >>> heat = PDE("u_t = u_xx", {"u": "sin(x)"})
    >>> print(f"{stable_dt(heat, 100):.6f} {stable_dt(heat, 100, time=RK4):.6f}")  # h^2/2, 0.696 h^2
    0.001974 0.002749
    """
    instance("time", time, RungeKutta, "RungeKutta step such as EULER, RK4 or RK8")
    if isinstance(problem, Toy) and time.order == 1:
        values = real_array("u", u if u is not None else problem.a + np.array([-OVERSHOOT, OVERSHOOT]))
        if not values.size:
            raise ValueError(f"u must hold at least one number, got {shown(u)}")
        # Both bounds are monotonic in u: the least and the greatest u decide.
        return float(np.min(frozen_dt(Grid(n).h, np.array([values.min(), values.max()]), problem.eps)))
    return min(largest_step(lam, time) for lam in all_rates(problem, n, u, t))


def all_rates(problem: Any, n: int, u: Any = None, t: float = 0.0) -> list[np.ndarray]:
    """The growth rates on n points about the state u; or about the initial data and about the steady state."""
    a_problem("problem", problem)
    if u is not None:
        return [rates(problem, n, u, t)]
    x = grid_of(problem, n).x
    states = [problem.initial(x)]
    if getattr(problem, "dist_from", "steady") == "steady":
        states.append(problem.steady(x))
    return [rates(problem, n, state, t) for state in states]


def tame_dt(problem: Any, n: int, t_end: float) -> float:
    """A step of forward Euler for a run to t_end: 0.9 of that at which what does not grow of itself gains 1 % by then.

    So there is one for waves without damping as well, in proportion to h^2/t_end. At most t_end/100.
    """
    gain = math.log(1.01) / max(t_end, 1e-300)
    return min(0.9 * min(largest_step(lam, EULER, gain) for lam in all_rates(problem, n)), t_end / 100 or 1e-3)


def amplification_over_modes(toy: Toy, n: int, dt: float, u: float) -> tuple[np.ndarray, np.ndarray]:
    """(k, factors): |1 + dt lam| of every wavenumber k = 0 ... n/2 on a frozen u, the larger root first; (n//2 + 1, 2).

    A value over 1 that goes down to 1 and below as dt is halved is numerical instability; one whose logarithm per unit
    time tends to Re lam > 0 is ill-posedness.
    """
    instance("toy", toy, Toy)
    grid = Grid(n)
    k = np.arange(grid.n // 2 + 1)
    symbol = toy.symbol(k.astype(float), np.float64(real("u", u)), multiplier=grid.multiplier)
    return k, np.abs(amplification(symbol, dt))
