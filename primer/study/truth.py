"""What errors are measured against: a solution that is given, the problem's own, or a reference with an error bar."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np

from primer.checks import shown
from primer.problems.pde import PDE
from primer.problems.toy import Toy
from primer.schemes.marching import grid_of
from primer.schemes.reference import reference

_TOL = 1e-11  # of a PDE's reference, times 1 + the size of its data


def _answer(problem, t_end, tol):
    """The reference, of a PDE if need be with a hundred or ten thousand times the tolerance."""
    try:
        return reference(problem, t_end, tol=tol)
    except ValueError:
        if isinstance(problem, PDE):
            for more in (100, 10_000):
                with suppress(ValueError):
                    return reference(problem, t_end, tol=more * tol)
        raise


def solution(problem: Any, t_end: float, exact: Callable | None = None) -> tuple[Callable, float]:
    """(f, error bar): f(x) gives the fields at t_end, (fields, n), by ``exact(x, t)`` or as near as can be had.

    Raises
    ------
    PastHorizon    if there is no reference at t_end
    TypeError      in one sentence, if nothing tells the solution, or ``exact`` does not give it
    """
    if exact is None and isinstance(problem, Toy | PDE):
        if isinstance(problem, Toy):
            tol = 1e-13 * (abs(problem.a) + 2)
        else:
            size = max(float(np.abs(row).max()) for row in problem.initial(grid_of(problem, 64).x))
            tol = min(_TOL * (1 + size), 1e-7)
        answer = _answer(problem, t_end, tol)
        return lambda x: np.array([f[0] for f in answer.at(x)]), float(answer.error[0])
    exact = getattr(problem, "exact", None) if exact is None else exact
    if not callable(exact):
        raise TypeError(
            f"exact must be a function of x and t, where the problem is no Toy, PDE or BackwardHeat, got {shown(exact)}"
        )

    def truth(x):
        found = np.array(exact(x, t_end))
        found = found[None] if found.shape == np.shape(x) and len(problem.fields) == 1 else found
        if found.shape != (len(problem.fields), len(x)) or not np.isfinite(found).all():
            raise TypeError(
                f"exact must give {len(problem.fields)} finite arrays of the shape of x, one for each field, "
                f"got {shown(found)}"
            )
        return found

    truth(grid_of(problem, 8).x)  # what is no solution is said before anything is marched
    return truth, 0.0
