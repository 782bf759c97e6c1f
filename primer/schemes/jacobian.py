"""Growth rates of small perturbations of a state on a grid: the eigenvalues of the right-hand side's Jacobian."""

from __future__ import annotations

from typing import Any

import numpy as np

from primer.checks import shown
from primer.equations.evaluate import known
from primer.equations.slopes import linearised
from primer.schemes.grid import CENTRAL
from primer.schemes.marching import a_problem, grid_of, slope_of
from primer.types import Derivative

DENSE = 800  # unknowns up to which all eigenvalues of the matrix are computed (a second); beyond, it is frozen
_WAVES = 129  # wavenumbers looked at where it is frozen
_STEP = 6e-6  # relative step of difference quotients, for problems that are no texts: the cube root of rounding


def rates(problem: Any, n: int, state: Any = None, t: float = 0.0, space: Any = CENTRAL) -> np.ndarray:
    """The growth rates lam of perturbations e^{lam t} of a state on n points; complex, one-dimensional.

    About a uniform state they are those of the waves; otherwise the eigenvalues of the Jacobian, a matrix of up to 800
    unknowns; beyond that, those of the equations frozen at every point, for 129 wavenumbers of the grid.

    Parameters
    ----------
    problem, n    a ``PDE``, a ``Toy`` or any other problem, and its grid; one that has no text, but a ``symbol`` of
                  the first derivative's multipliers, is asked for that about its steady state
    state         the fields, numbers or arrays of shape (n,); left out, the initial data
    t             the time, where the equations depend on it
    space         the derivatives
    """
    a_problem("problem", problem)
    grid = grid_of(problem, n)
    x, h = grid.x, grid.h
    state = _state(problem, x, state)

    def derivative(f, m):
        return space[m](f, h)

    if not hasattr(problem, "evolution") and hasattr(problem, "symbol") and _is_base(problem, x, state):
        return np.linalg.eigvals(problem.symbol(_waves(n, derivative, np.arange(n))(1))).ravel()
    if not hasattr(problem, "evolution"):
        return np.linalg.eigvals(_quotients(problem, x, state, derivative, t))
    about = _about(problem, x, state, derivative, t)
    if _is_uniform(about):
        symbol = _uniform(about).symbol(_waves(n, derivative, np.arange(n)))
        return np.linalg.eigvals(np.broadcast_to(symbol, (n, *symbol.shape[-2:]))).ravel()  # without derivatives, one
    if len(state) * n <= DENSE:
        return np.linalg.eigvals(about.matrix(n, derivative))
    chosen = np.unique(np.linspace(0, n // 2, _WAVES).astype(int))
    waves = _waves(n, derivative, chosen)
    return np.linalg.eigvals(about.symbol(lambda m: waves(m)[:, None], derivative)).ravel()


def frozen_rates(problem: Any, n: int, state: Any, places: np.ndarray, t: float = 0.0) -> np.ndarray:
    """(waves, places, fields): the rates of waves k = 0, 1, ... n - 1 of the period, the equations frozen at points.

    ``places`` are indices of points of the grid, on which derivatives are central differences.
    """
    grid = grid_of(problem, n)

    def derivative(f, m):
        return CENTRAL[m](f, grid.h)

    about = _about(problem, grid.x, _state(problem, grid.x, state), derivative, t)
    waves = _waves(n, derivative, np.arange(n))
    symbol = about.symbol(lambda m: waves(m)[:, None], derivative)
    symbol = np.broadcast_to(symbol, (n, grid.x.size, *symbol.shape[-2:]))[:, places]
    return np.linalg.eigvals(symbol)


def modes(problem: Any, n: int, state: Any, t: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """(rates, (fields, n, modes) vectors) of the Jacobian of a problem that is a text, on up to 800 unknowns."""
    grid = grid_of(problem, n)

    def derivative(f, m):
        return CENTRAL[m](f, grid.h)

    state = _state(problem, grid.x, state)
    lam, vectors = np.linalg.eig(_about(problem, grid.x, state, derivative, t).matrix(n, derivative))
    return lam, vectors.reshape(len(state), n, lam.size)


def _about(problem, x, state, derivative, t):
    given = known(problem.evolution, x, problem.parameters)
    with np.errstate(all="ignore"):
        about = linearised(problem.evolution, problem.parameters, state, derivative, given, t)
    if not all(np.isfinite(c).all() for c in _slopes(about)):
        raise ValueError(f"u must be a state about which the equations can be linearised, got {shown(state)}")
    return about


def _is_base(problem, x, state):
    """Whether the state is the one about which the problem itself knows its waves."""
    return np.array_equal(state, np.array(problem.steady(x)))


def _slopes(about):
    return [np.ravel(c) for stage in about.slopes for found in stage for c in found.values()]


def _is_uniform(about):
    return all((c == c[0]).all() for c in _slopes(about))


def _state(problem, x, state):
    fields = len(problem.fields)
    given = problem.initial(x) if state is None else [state] if fields == 1 and np.ndim(state) < 2 else state
    try:
        rows = [np.broadcast_to(np.asarray(row), x.shape) for row in given]
    except (TypeError, ValueError):
        rows = []
    if len(rows) != fields or not all(r.dtype.kind in "iufc" and np.isfinite(r).all() for r in rows):
        raise ValueError(f"u must be {fields} fields, numbers or arrays of shape ({x.size},), got {shown(state)}")
    return np.array(rows, dtype=complex if getattr(problem, "is_complex", False) else float)


def _uniform(about):
    """The same linearisation with numbers in the place of arrays."""
    slopes = tuple(tuple({k: np.ravel(c)[0] for k, c in found.items()} for found in stage) for stage in about.slopes)
    return type(about)(about.evolution, slopes)


def _waves(n: int, derivative: Derivative, k: np.ndarray):
    """multiplier(m): what the m-th derivative does to the k-th waves of the grid."""
    unit = np.zeros(n)
    unit[0] = 1.0
    return lambda m: np.fft.fft(derivative(unit, m))[k]


def _quotients(problem, x, state, derivative, t):
    if state.size > DENSE:
        raise ValueError(f"n must be <= {DENSE // len(state)} for a problem that is no text, got {x.size}")
    slope = slope_of(problem, x, derivative)
    step = _STEP * (1 + np.abs(state).max())
    columns = []
    for unit in np.eye(state.size, dtype=state.dtype):
        change = step * unit.reshape(state.shape)
        columns.append((slope(state + change, t) - slope(state - change, t)).ravel() / (2 * step))
    return np.array(columns).T
