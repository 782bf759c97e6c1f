"""A problem as py-pde takes it: its text in that package's language, marched by its compiled Euler solver."""

from __future__ import annotations

from typing import Any

import numpy as np

from primer.equations.evolution import first_order
from primer.equations.terms import Term
from primer.schemes.marching import grid_of

_CALLS = {"abs": "Abs"}


def expressions(problem: Any) -> dict[str, str]:
    """{field: its time derivative} of a problem made from a text.

    A derivative is made of d_dx and laplace, which on a line are the paper's central differences; the third is d_dx of
    laplace.

    >>> from primer import PDE
    >>> expressions(PDE("u_t = nu*u_xx - (u^2/2)_x", {"u": "sin(x)"}, nu=0.1))
    {'u': '((0.1 * laplace(u)) - d_dx(((u**2) / 2)))'}
    """
    fields, _, terms, _ = first_order(problem.text, tuple(problem.parameters))
    return {field: _written(term, fields, problem.parameters) for field, term in zip(fields, terms, strict=True)}


def _written(term: Term, fields, parameters) -> str:
    inner = [_written(operand, fields, parameters) for operand in term.operands]
    value: Any = term.value
    match term.kind:
        case "number":
            return value
        case "i":
            return "I"
        case "pi" | "x" | "t":
            return term.kind
        case "parameter":
            return _number(parameters[value])
        case "slot":
            return _derivative(fields[value[0]], value[1])
        case "derivative":
            return _derivative(inner[0], value)
        case "neg":
            return f"(-{inner[0]})"
        case "power":
            return f"({inner[0]}**{value})"
        case "call":
            return f"{_CALLS.get(value, value)}({inner[0]})"
    return f"({inner[0]} {'**' if term.kind == '^' else term.kind} {inner[1]})"


def _number(value):
    if isinstance(value, complex):
        return f"({value.real!r} + {value.imag!r}*I)"
    return repr(value) if value >= 0 else f"({value!r})"


def _derivative(text, m):
    for _ in range(m // 2):
        text = f"laplace({text})"
    return f"d_dx({text})" if m % 2 else text


def march(problem: Any, n: int, dt: float, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """(x, fields) after so many steps; x are the middles of py-pde's cells, and the time to compile is included."""
    import pde

    half = grid_of(problem, n).period / 2
    grid = pde.CartesianGrid([[-half, half]], n, periodic=True)
    x = np.asarray(grid.axes_coords[0])
    state = pde.FieldCollection([pde.ScalarField(grid, row) for row in problem.initial(x)])
    final = pde.PDE(expressions(problem)).solve(state, t_range=dt * steps, dt=dt, tracker=None)
    return x, final.data
