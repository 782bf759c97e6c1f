"""Where the equations, frozen at a state that a run visits, are ill posed: "where u < 0, for |x| < 1.05"."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from primer.equations.evaluate import known
from primer.equations.slopes import linearised
from primer.schemes.fourier import FOURIER
from primer.schemes.marching import grid_of

_SHORT = 2.0 ** np.array([9, 12, 15])  # wavenumbers of short waves, in waves per period
_RISES = 1.2  # growth over growth from each of these to the next, eight times as short: |xi|^0.09
_ROUNDING = 1e-9  # of the largest eigenvalue: less is no growth


@dataclass(frozen=True, eq=False)
class Frozen:
    """The frozen verdict over a run.

    Attributes
    ----------
    x       (n,) the grid
    ill     (s, n) whether it is ill posed at each point of each state looked at
    text    where, in words; empty if nowhere
    """

    x: np.ndarray
    ill: np.ndarray
    text: str


def frozen(problem, n, states, times=None):
    """The :class:`Frozen` verdict about states, (s, fields, n): does growth rise with the wavenumber without bound?

    ``times`` are those of the states, where the equations depend on time. In double precision, from three short waves;
    of a problem that is no text it is not known, and said to be nowhere.
    """
    x = grid_of(problem, n).x
    states = np.asarray(states)
    if not hasattr(problem, "evolution"):
        return Frozen(x, np.zeros((len(states), n), dtype=bool), "")
    times = np.zeros(len(states)) if times is None else times
    ill = np.array([_at(problem, x, state, t) for state, t in zip(states, times, strict=True)])
    return Frozen(x, ill, _words(problem, x, ill, states))


def _at(problem, x, state, t):
    """(n,) where one state is ill posed."""
    xi = 2 * np.pi / (grid_of(problem, x.size).h * x.size) * _SHORT
    found = np.zeros(x.size, dtype=bool)

    def derivative(f, m):
        return FOURIER[m](f, grid_of(problem, x.size).h)

    with np.errstate(all="ignore"):
        given = known(problem.evolution, x, problem.parameters)
        about = linearised(problem.evolution, problem.parameters, tuple(state), derivative, given, t)
        for waves in (xi, -xi):
            symbol = about.symbol(partial(_multiplier, waves))
            symbol = np.broadcast_to(symbol, (xi.size, x.size, *symbol.shape[-2:]))
            good = np.isfinite(symbol).all(axis=(0, 2, 3))
            lam = np.linalg.eigvals(np.where(good[:, None, None], symbol, 0))
            size = np.abs(lam).max(axis=2)
            growth = np.where(lam.real.max(axis=2) > _ROUNDING * size, lam.real.max(axis=2), 0.0)
            rises = (growth[1:] > _RISES * growth[:-1]).all(axis=0) & (growth[0] >= 0) & (growth[-1] > 0)
            found |= rises & good
    return found


def _multiplier(xi, m):
    return ((1j * xi) ** m)[:, None]


def _words(problem, x, ill, states):
    if not ill.any():
        return ""
    anywhere = ill.any(axis=0)
    signs = [
        f"{name} {sign} 0"
        for i, name in enumerate(problem.fields)
        for sign, holds in (("<", states[:, i] < 0), (">", states[:, i] > 0))
        if not np.iscomplexobj(states) and (holds == ill).mean() > 0.995 and 0 < holds.mean() < 1
    ]
    condition = f"where {signs[0]}, " if signs else ""
    if anywhere.all():
        return condition + "for all x"
    half = (x[1] - x[0]) / 2
    inside = np.flatnonzero(anywhere)
    whole = inside.size == inside[-1] - inside[0] + 1
    low, high = x[inside[0]] - half, x[inside[-1]] + half
    if whole and abs(low + high) <= 4 * half:
        return condition + f"for |x| < {(high - low) / 2:.3g}"
    if whole:
        return condition + f"for {low:.3g} < x < {high:.3g}"
    outside = np.flatnonzero(~anywhere)
    if outside.size == outside[-1] - outside[0] + 1 and abs(x[outside[0]] + x[outside[-1]]) <= 4 * half:
        return condition + f"for |x| > {(x[outside[-1]] - x[outside[0]]) / 2 + half:.3g}"
    return condition + f"on {100 * anywhere.mean():.0f} % of the period"
