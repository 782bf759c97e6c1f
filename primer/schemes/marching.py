"""What a march asks of any problem: its period, whether it knows the time, whether its numbers are complex."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from primer.checks import shown
from primer.schemes.grid import Grid

ORDERS = 12  # the highest derivative that the tables of stencils have
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


def fields_of(problem: Any, name: str, x: np.ndarray) -> tuple:
    """``problem.initial(x)`` or another of its functions that give the fields, held to one array of shape (n,) each."""
    made = getattr(problem, name)(x)
    rows = tuple(made) if np.iterable(made) and not isinstance(made, (str, dict)) else ()
    fields = getattr(problem, "fields", rows)
    if not rows or len(rows) != len(fields) or not all(_is_field(row, x) for row in rows):
        raise ValueError(f"problem.{name}(x) must give {_wanted(len(fields), x)}, got {_got(made, rows)}")
    return rows


def slope_of(problem: Any, x: np.ndarray, derivative: Callable) -> Callable[[np.ndarray, Any], np.ndarray]:
    """f(state, t): the time derivatives, of the shape of the state (fields, n)."""
    timed = not getattr(problem, "autonomous", True)
    with np.errstate(all="ignore"):  # what is infinite at an x makes itself known in the first step
        forcing = problem.forcing(x)
    if hasattr(problem, "evolution"):  # a text: what it gives has the right shape
        if not timed:
            return lambda state, t: np.array(problem.rhs(x, state, derivative, forcing))
        return lambda state, t: np.array(problem.rhs(x, state, derivative, forcing, t))

    def asked(f, m):
        if np.shape(f)[-1:] != x.shape:
            raise ValueError(f"derivative(f, m) must be asked for f of shape (..., {x.size}), got shape {np.shape(f)}")
        try:
            return derivative(np.asarray(f), m)
        except (KeyError, TypeError):
            raise ValueError(
                f"derivative(f, m) must be asked for an order that the scheme has, 1 to {ORDERS} and no other, "
                f"got m = {shown(m)}; a higher one is a derivative of a derivative"
            ) from None

    def slope(state, t):
        made = problem.rhs(x, state, asked, forcing, t) if timed else problem.rhs(x, state, asked, forcing)
        try:
            found = np.array(made)
        except ValueError:  # arrays of several lengths
            found = np.array(None)
        if found.shape != state.shape or found.dtype.kind not in ("iufO" if state.dtype.kind != "c" else "iufcO"):
            rows = tuple(made) if isinstance(made, (tuple, list)) else ()
            raise ValueError(f"problem.rhs must give {_wanted(len(state), x)}, as the fields, got {_got(made, rows)}")
        return found

    return slope


def _is_field(row, x):
    try:
        row = np.asarray(row)
    except ValueError:
        return False
    return row.shape == x.shape and row.dtype.kind in "iufcO"


def _wanted(fields, x):
    return f"{fields} real array{'s' * (fields != 1)} of {x.size} points, one for each field"


def _got(made, rows):
    if isinstance(made, np.ndarray):
        return f"an array of shape {made.shape} ({made.dtype})"
    if rows and any(isinstance(row, np.ndarray) for row in rows):
        parts = [f"shape {row.shape} ({row.dtype})" if isinstance(row, np.ndarray) else shown(row) for row in rows[:4]]
        return f"{len(rows)}: {', '.join(parts)}{', ...' * (len(rows) > 4)}"
    return shown(made)
