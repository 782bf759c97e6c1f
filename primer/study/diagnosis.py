"""Tell what a run will do, and whether to blame the scheme, the grid or the equations."""

from __future__ import annotations

from numbers import Real
from typing import Any

import numpy as np

from primer.checks import instance, shown
from primer.problems.toy import Toy
from primer.schemes.grid import Grid
from primer.schemes.marching import a_problem
from primer.schemes.record import plan
from primer.schemes.run import Seed
from primer.schemes.runge_kutta import EULER, RungeKutta
from primer.study.companions import MOST
from primer.study.kinds import Diagnosis, Kind
from primer.study.toy_diagnosis import foretold
from primer.study.trial import tried
from primer.study.uniform import about_uniform, uniform
from primer.types import DTypeLike

__all__ = ["Diagnosis", "Kind", "diagnose"]


def diagnose(
    problem: Any,
    n: int = 100,
    dt: float = 1e-3,
    t_end: float = 100.0,
    seed: Seed | tuple | float | None = None,
    dtype: DTypeLike = np.float64,
    digits: int | None = None,
    time: RungeKutta = EULER,
) -> Diagnosis:
    """What ``primer.ftcs(problem, n, dt, t_end, seed=seed, dtype=dtype, digits=digits)`` will do, and why.

    About a uniform, steady state the growth of each wave is known, on n, 2 n and 4 n points, with the step and as
    dt -> 0. Otherwise the run is made, since that is cheaper than to foretell it, with companions of smaller steps, a
    finer grid and a perturbation; the Jacobian on the grid about the states that it visits, and the equations frozen at
    each x, say why. Of a ``Toy`` more is known, and with many digits its run is foretold.

    The price for a ``Toy``, t_end = 100 and n <= 400: about half of a run that lives and takes more than 10 ms, since
    it is made only until it is at rest, if nothing grows there. A run that is lost is over in half a millisecond, and
    what tells why (companions, growth on three grids) takes ten to twenty times that: some 7 ms. Over random scenes,
    most of them lost, the median is ten runs.

    Parameters
    ----------
    problem         a ``PDE``, a ``Toy``, a ``BackwardHeat`` or an object with their methods
    n, dt, t_end    grid points >= 4, step > 0, end >= 0
    seed            a ``Seed``, or its arguments as a tuple, or None; a number is the amplitude of the mode n//2 - 1 of
                    the first field, next to the sawtooth. The mode matters: from a low one, hardly anything reaches the
                    growing ones before round-off does
    dtype, digits   the arithmetic, as for ``ftcs``; digits for a ``Toy`` only
    time            ``EULER``, ``RK4`` or ``RK8``, on the same central differences; for a ``Toy`` ``EULER`` only

    Returns
    -------
    Diagnosis. On scenes of the toy system with a in [-1, 2], eps in [0.001, 0.1], n in [8, 600], dt in [1e-5, 0.02] and
    a seed of 1e-6 in any mode, the blow-up comes within the interval in more than nine of ten.

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not allowed, and for runs that would take minutes

    The scheme is that of section A2.2.2.

    >>> from primer import PDE
    >>> [str(diagnose(Toy(a), n).kind) for a, n in ((1.5, 100), (0.5, 100), (0.5, 30))]  # Figures 4 to 6
    ['converges', 'ill-posed', 'hidden']
    >>> heat = PDE("u_t = u_xx", {"u": "sin(x)"})
    >>> found = diagnose(heat, n=100, dt=2.1e-3, t_end=10.0)
    >>> print(found.kind, f"{found.stable_dt:.5f}")  # h^2/2
    scheme 0.00197
    """
    instance("time", time, RungeKutta, "RungeKutta step such as EULER, RK4 or RK8")
    if isinstance(problem, Toy) and time.order == 1:
        return foretold(problem, n, dt, t_end, seed, dtype, digits, run=True)
    a_problem("problem", problem)
    if digits is not None:
        raise ValueError(f"digits must be None but for a Toy, got {shown(digits)}")
    if isinstance(seed, Real) and not isinstance(seed, bool):
        seed = Seed(max(Grid(n).n // 2 - 1, 1), seed, problem.fields[0])
    asked = plan(n, dt, t_end, None, (), seed, 1e3, dtype, None)
    n, dt, t_end, seed = asked.grid.n, asked.dt, asked.steps * asked.dt, asked.seed
    if seed and seed.field not in problem.fields:
        raise ValueError(f"seed field must be one of {', '.join(problem.fields)}, got {shown(seed.field)}")
    if uniform(problem, n):
        return about_uniform(problem, n, dt, t_end, seed, asked.numbers.epsilon, time)
    if n * asked.steps > MOST:
        raise ValueError(
            f"n t_end/dt must be <= {MOST:.0e} for a diagnosis, which makes the run, got {n * asked.steps:.1e}"
        )
    return tried(problem, n, dt, t_end, seed, asked.numbers.dtype, time)
