"""Ways to march a problem that :mod:`primer.study.cost` sets against each other."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from typing import Any

import numpy as np

from primer.problems.pde import PDE
from primer.problems.toy import Toy
from primer.schemes.fourier import FOURIER
from primer.schemes.ftcs import ftcs
from primer.schemes.grid import CENTRAL, CENTRAL_4, CENTRAL_6, Grid
from primer.schemes.lines import march_lines
from primer.schemes.marching import fields_of, grid_of, slope_of
from primer.schemes.reference import reference
from primer.schemes.run import Stop
from primer.schemes.runge_kutta import RK4, RK8
from primer.study import py_pde
from primer.study.suited_step import euler_step, lines_step

_MOST_WORK = 2 * 10**10  # points times steps of one march: more takes minutes, which is no contest


@dataclass(frozen=True)
class Method:
    """A way to march a problem, and the settings of its one knob, in order of cost.

    ``march(problem, knob, t_end)`` returns (x, fields, dt) at t_end; dt is NaN where the method chooses its own steps.
    It may refuse a knob with a ValueError. The knob is the number of grid points, unless it is the tolerance
    (``by_points`` is false). ``stages`` are the evaluations of the right-hand side in each step, 0 where the method
    chooses its own steps. ``step(problem, knob)`` finds out the step and keeps it, so that this is not timed.
    """

    name: str
    march: Callable
    knobs: tuple
    by_points: bool = True
    stages: int = 0
    step: Callable | None = None


def contestants(with_py_pde: bool | None = None, problem: Any = None, t_end: float = 5.0) -> list[Method]:
    """The methods, from the paper's to the reference.

    FTCS, every pair of stencil and Runge-Kutta step, the reference (of a ``Toy`` or a ``PDE``), scipy's ``solve_ivp``
    on the same right-hand side (LSODA for real fields only) and, for what is made from a text, where it is installed
    and unless ``with_py_pde`` is false, py-pde. ``problem`` is what they are to march, the toy system if nothing else
    is said; another one gets more points for Fourier, and steps that go with the ``t_end`` of the comparison.
    """
    if with_py_pde and not find_spec("pde"):
        raise ModuleNotFoundError('py-pde is not here: python -m pip install "illposed-primer[bench]" brings it')
    own = problem is None or isinstance(problem, Toy)
    doubling = tuple(25 * 2**k for k in range(8))
    waves = (8, 10, 12, 14, 16, 20) if own else (8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256)
    spaces = {
        "central 2": (CENTRAL, doubling),
        "central 4": (CENTRAL_4, doubling),
        "central 6": (CENTRAL_6, doubling),
        "Fourier": (FOURIER, waves),
    }
    euler = partial(euler_step, t_end=t_end)
    methods = [Method("FTCS", partial(_ftcs, whole=t_end), doubling, stages=1, step=euler)]
    for time in (RK4, RK8):
        for name, (space, knobs) in spaces.items():
            march = partial(_lines, space=space, time=time, whole=t_end)
            step = partial(lines_step, t_end=t_end, space=space, time=time)
            methods.append(Method(f"{name} + {time.name}", march, knobs, stages=len(time.b), step=step))
    tolerances = tuple(10.0**-k for k in range(4, 13))
    if own or isinstance(problem, PDE):
        methods.append(Method("reference", _reference, tolerances[2:], by_points=False))
    methods.append(Method("solve_ivp RK45, central 2", _solve_ivp_by_points, doubling))
    for name in ("LSODA", "DOP853"):
        if name != "LSODA" or not getattr(problem, "is_complex", False):
            march = partial(solve_ivp, method=name)
            methods.append(Method(f"solve_ivp {name}, Fourier", march, tolerances, by_points=False))
    if (own or hasattr(problem, "text")) and (with_py_pde or (with_py_pde is None and find_spec("pde"))):
        methods.append(Method("py-pde", partial(_py_pde, whole=t_end), (100,), step=euler))
    return methods


def _steps(n, dt, t_end):
    """How many equal steps of at most dt, or a refusal."""
    steps = t_end / dt
    if not steps * n <= _MOST_WORK:
        raise ValueError(f"n must be such that n t_end/dt <= {_MOST_WORK:.0e}, got n = {n} and dt = {dt:.2g}")
    return max(1, math.ceil(steps))


def _ftcs(problem, n, t_end, whole=5.0):
    steps = _steps(n, euler_step(problem, n, whole), t_end)
    size = max(float(np.abs(row).max()) for row in fields_of(problem, "initial", grid_of(problem, n).x))
    run = ftcs(problem, n, t_end / steps, t_end, record_every=steps, blow_up_at=1e3 * max(1.0, size), progress=False)
    lost = run.stop is Stop.BLEW_UP
    return run.x, tuple(np.full_like(row, np.nan) for row in run.final) if lost else run.final, run.dt


def _lines(problem, n, t_end, space, time, whole=5.0):
    dt = lines_step(problem, n, whole, space, time)
    _steps(n, dt, t_end)
    run = march_lines(problem, n, dt, t_end, space, time, progress=False)
    return run.x, run.final, run.dt


def _reference(problem, tol, t_end):
    answer = reference(problem, t_end, tol)
    fields = (answer.u, answer.v) if isinstance(problem, Toy) else answer.fields
    return answer.x, tuple(row[0] for row in fields), math.nan


def solve_ivp(problem, tol, t_end, method, n=None, space=FOURIER):
    """(x, fields, dt) at t_end by a method of scipy.integrate.solve_ivp; dt is NaN, its own step control's."""
    from scipy.integrate import solve_ivp as integrate

    n = n or _enough(problem, tol)
    grid = grid_of(problem, n)
    start = np.array(fields_of(problem, "initial", grid.x))
    start = start.astype(complex if getattr(problem, "is_complex", False) else float)
    tendency = slope_of(problem, grid.x, lambda f, m: space[m](f, grid.h))

    def slope(t, y):
        return tendency(y.reshape(start.shape), t).ravel()

    solution = integrate(slope, (0, t_end), start.ravel(), method, (t_end,), rtol=tol, atol=tol)
    if not solution.success:
        return grid.x, np.full_like(start, np.nan), math.nan
    return grid.x, solution.y[:, -1].reshape(start.shape), math.nan


def _enough(problem, tol):
    """Fourier points for a tolerance: for the toy system as found out; else twice what the initial data need, or 64."""
    if isinstance(problem, Toy):
        return 12 if tol > 1e-7 else 16 if tol > 1e-11 else 24
    for n in (16, 32, 64, 128):
        waves = np.abs(np.fft.fft(fields_of(problem, "initial", grid_of(problem, n).x))) / n
        if waves[:, n // 3 : n - n // 3].max() <= tol * (1 + waves.max()):
            break
    return max(64, 2 * n)


def _solve_ivp_by_points(problem, n, t_end):
    """As it is usually written: second-order differences and the default method, at a tolerance to match."""
    return solve_ivp(problem, Grid(n).h ** 2 / 100, t_end, "RK45", n, CENTRAL)


def _py_pde(problem, n, t_end, whole=5.0):
    """As its manual shows: the equations as text, marched by its compiled Euler solver."""
    steps = _steps(n, euler_step(problem, n, whole), t_end)
    x, fields = py_pde.march(problem, n, t_end / steps, steps)
    return x, fields, t_end / steps
