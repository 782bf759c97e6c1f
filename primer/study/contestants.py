"""Ways to march the toy system that :mod:`primer.study.cost` sets against each other."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec

import numpy as np

from primer.schemes.fourier import FOURIER
from primer.schemes.ftcs import ftcs
from primer.schemes.grid import CENTRAL, CENTRAL_4, CENTRAL_6, Grid
from primer.schemes.lines import march_lines, stable_step
from primer.schemes.reference import reference
from primer.schemes.runge_kutta import RK4, RK8


@dataclass(frozen=True)
class Method:
    """A way to march the toy system, and the settings of its one knob, in order of cost.

    ``march(toy, knob, t_end)`` returns (x, (u, v), dt) at t_end; dt is NaN where the method chooses its own steps.
    The knob is the number of grid points, unless it is the tolerance (``by_points`` is false). ``stages`` are the
    evaluations of the right-hand side in each step, 0 where the method chooses its own steps.
    """

    name: str
    march: Callable
    knobs: tuple
    by_points: bool = True
    stages: int = 0


def contestants(with_py_pde=None):
    """The methods, from the paper's to the reference.

    FTCS, every pair of stencil and Runge-Kutta step, the reference, scipy's ``solve_ivp`` on the same right-hand side
    and, where it is installed and unless ``with_py_pde`` is false, py-pde.
    """
    if with_py_pde and not find_spec("pde"):
        raise ModuleNotFoundError('py-pde is not here: python -m pip install "illposed-primer[bench]" brings it')
    doubling = tuple(25 * 2**k for k in range(8))
    spaces = {
        "central 2": (CENTRAL, doubling),
        "central 4": (CENTRAL_4, doubling),
        "central 6": (CENTRAL_6, doubling),
        "Fourier": (FOURIER, (8, 10, 12, 14, 16, 20)),
    }
    methods = [Method("FTCS", _ftcs, doubling, stages=1)]
    for time in (RK4, RK8):
        for name, (space, knobs) in spaces.items():
            march = partial(_lines, space=space, time=time)
            methods.append(Method(f"{name} + {time.name}", march, knobs, stages=len(time.b)))
    tolerances = tuple(10.0**-k for k in range(4, 13))
    methods += [
        Method("reference", _reference, tolerances[2:], by_points=False),
        Method("solve_ivp RK45, central 2", _solve_ivp_by_points, doubling),
        Method("solve_ivp LSODA, Fourier", partial(solve_ivp, method="LSODA"), tolerances, by_points=False),
        Method("solve_ivp DOP853, Fourier", partial(solve_ivp, method="DOP853"), tolerances, by_points=False),
    ]
    if with_py_pde or (with_py_pde is None and find_spec("pde")):
        methods.append(Method("py-pde", _py_pde, (100,)))
    return methods


def _ftcs(toy, n, t_end):
    dt = Grid(n).h ** 2 / 4  # the paper's at N = 100: the errors of space and time fall together, and it is stable
    steps = max(1, math.ceil(t_end / dt))
    run = ftcs(toy, n, t_end / steps, t_end, record_every=steps)
    return run.x, run.final, run.dt


def _lines(toy, n, t_end, space, time):
    # The step whose error is about that of space. At t = 5, a = 1.5, eps = 0.01 the latter is c h^order for differences
    # and 10^(-1 - 0.8 n), down to round-off, for Fourier; the former is 6e-3 dt^4 and 5e-8 dt^8.
    c = {2: 0.25, 4: 0.05, 6: 0.012}
    error = max(10 ** (-1 - 0.8 * n), 1e-14) if space is FOURIER else c[space[1].order] * Grid(n).h ** space[1].order
    accurate = min(0.6, (error / {4: 6e-3, 8: 5e-8}[time.order]) ** (1 / time.order))
    run = march_lines(toy, n, min(accurate, stable_step(toy, n, space, time)), t_end, space, time)
    return run.x, run.final, run.dt


def _reference(toy, tol, t_end):
    answer = reference(toy, t_end, tol)
    return answer.x, (answer.u[0], answer.v[0]), math.nan


def solve_ivp(toy, tol, t_end, method, n=None, space=FOURIER):
    """(x, fields, dt) at t_end by a method of scipy.integrate.solve_ivp; dt is NaN, its own step control's."""
    from scipy.integrate import solve_ivp as integrate

    n = n or (12 if tol > 1e-7 else 16 if tol > 1e-11 else 24)
    grid = Grid(n)
    x, h, forcing = grid.x, grid.h, toy.forcing(grid.x)

    def derivative(f, m):
        return space[m](f, h)

    def slope(t, y):
        return np.concatenate(toy.rhs(x, y.reshape(2, -1), derivative, forcing))

    solution = integrate(slope, (0, t_end), np.concatenate(toy.initial(x)), method, (t_end,), rtol=tol, atol=tol)
    return x, solution.y[:, -1].reshape(2, -1), math.nan


def _solve_ivp_by_points(toy, n, t_end):
    """As it is usually written: second-order differences and the default method, at a tolerance to match."""
    return solve_ivp(toy, Grid(n).h ** 2 / 100, t_end, "RK45", n, CENTRAL)


def _py_pde(toy, n, t_end):
    """As its manual shows: the equations as text, marched by its compiled Euler solver."""
    import pde

    grid = pde.CartesianGrid([[-math.pi, math.pi]], n, periodic=True)
    u, v = pde.ScalarField(grid, toy.a), pde.ScalarField.from_expression(grid, "-sin(x)/2")
    equations = pde.PDE({"u": "d_dx(v)", "v": f"{toy.eps!r} * u * laplace(v) + d_dx(u) - v - sin(x)"})
    dt = Grid(n).h ** 2 / 4
    steps = max(1, math.ceil(t_end / dt))
    final = equations.solve(pde.FieldCollection([u, v]), t_range=t_end, dt=t_end / steps, tracker=None)
    return grid.axes_coords[0], final.data, t_end / steps
