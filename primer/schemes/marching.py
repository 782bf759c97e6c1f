"""What a march asks of any problem: its period, whether it knows the time, whether its numbers are complex."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from primer.checks import shown
from primer.schemes.grid import Grid

PARTS = ("fields", "initial", "steady", "forcing", "rhs")


def a_problem(name: str, problem: Any, parts: tuple[str, ...] = PARTS) -> None:
    """Raise TypeError unless the problem has what a march needs."""
    if isinstance(problem, type) or not all(hasattr(problem, part) for part in parts):
        raise TypeError(
            f"{name} must be a PDE, a Toy, a BackwardHeat or an object with their methods, got {shown(problem)}"
        )


def grid_of(problem: Any, n: int) -> Grid:
    """The grid of n points on the problem's period, 2 pi unless it says otherwise."""
    return Grid(n, getattr(problem, "period", 2 * math.pi))


def orders_of(problem: Any) -> tuple[int, ...]:
    """The orders of the derivatives that the problem takes: 1 and 2 unless it is a text that says otherwise."""
    return problem.evolution.orders if hasattr(problem, "evolution") else (1, 2)


def slope_of(problem: Any, x: np.ndarray, derivative: Callable) -> Callable[[np.ndarray, Any], np.ndarray]:
    """f(state, t): the time derivatives, of the shape of the state (fields, n)."""
    with np.errstate(all="ignore"):  # what is infinite at an x makes itself known in the first step
        forcing = problem.forcing(x)
    if getattr(problem, "autonomous", True):
        return lambda state, t: np.array(problem.rhs(x, state, derivative, forcing))
    return lambda state, t: np.array(problem.rhs(x, state, derivative, forcing, t))
