"""What the page shows of a base state on a grid: curves, words and a few numbers, each as ``base_state`` found it."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from primer.checks import integer, real
from primer.scenes.base_state import T_END, base_state
from primer.study.diagnosis import Kind

_MOST = 400  # recorded times that are shown of a run: every second or third one is enough for a curve
_LINE = np.linspace(-np.pi, np.pi, 97)
_GROWS = 1e-6  # a rate that round-off cannot tell from zero


@dataclass(frozen=True, eq=False)
class Shown:
    """One state of the page.

    Attributes
    ----------
    a, n       base state and grid points
    kind       a :class:`primer.study.diagnosis.Kind`
    verdict    in words, of ``base_state``
    measured   time of the blow-up, infinite if there is none by t = 100
    numbers    name -> text, for the page's table
    labels     name of a curve -> its label; empty for a curve that is not there
    alts       name of a plot -> in words what it shows
    curves     name of a curve -> name of a coordinate -> (k,) array
    """

    a: float
    n: int
    kind: Kind
    verdict: str
    measured: float
    numbers: dict
    labels: dict
    alts: dict
    curves: dict


@dataclass(frozen=True, eq=False)
class Atlas:
    """All states of a page: ``states[i][j]`` is that of a[i] on n[j] points, with one eps."""

    eps: float
    a: tuple
    n: tuple
    states: tuple

    def at(self, a, n):
        """The state of a on n points.

        Raises
        ------
        ValueError    if it is not one of the atlas
        """
        if a not in self.a or n not in self.n:
            raise ValueError(f"(a, n) must be a state of the atlas, got ({a!r}, {n!r})")
        return self.states[self.a.index(a)][self.n.index(n)]


def atlas(a, n, eps=0.01, progress=iter):
    """The :class:`Atlas` of all pairs of the base states ``a`` and the grids ``n``; ``progress`` wraps the loop over a.

    Raises
    ------
    TypeError, ValueError    if a or n is empty or does not increase, or for what ``base_state`` refuses
    """
    a = _increasing("a", a, lambda value: real("a", value))
    n = _increasing("n", n, lambda value: integer("n", value))
    return Atlas(eps, a, n, tuple(tuple(shown(base_state(each, eps, grid)) for grid in n) for each in progress(a)))


def _increasing(name, values, check):
    if not isinstance(values, Iterable):
        raise TypeError(f"{name} must be a sequence of numbers, got {type(values).__name__}")
    values = tuple(map(check, values))
    if not values or any(left >= right for left, right in pairwise(values)):
        raise ValueError(f"{name} must hold numbers that increase, at least one, got {values}")
    return values


def shown(answer):
    """The :class:`Shown` of a :class:`primer.scenes.base_state.BaseStateAnswer`; its fields are those at the end."""
    run, times = answer.run, {"first": answer.run.t_first_negative, "foretold": answer.predicted}
    times = {name: time for name, time in (times | {"blow_up": answer.measured}).items() if _seen(time)}
    names = {"first": "first u = 0", "foretold": "foretold blow-up", "blow_up": "blow-up"}
    return Shown(
        a=run.problem.a,
        n=run.n,
        kind=answer.kind,
        verdict=answer.verdict,
        measured=answer.measured,
        numbers=_numbers(answer),
        labels={name: f"{says}: t = {times[name]:.3g}" if name in times else "" for name, says in names.items()}
        | {"grid": f"on N = {run.n}", "end": f"shortest wave of N = {run.n}", "negative": _shaded(run.final[0])},
        alts={"growth": _growth_in_words(answer), "dist": _dist_in_words(run), "fields": _fields_in_words(run)},
        curves=_curves(answer, times),
    )


def _seen(time):
    return time is not None and time <= T_END


def _curves(answer, times):
    run = answer.run
    x = np.append(run.x, np.pi)  # the period closed
    u, v = (np.append(f, f[0]) for f in run.final)
    thin = np.unique(np.append(np.arange(0, run.t.size, -(-run.t.size // _MOST)), run.t.size - 1))
    return {
        "equations": {"x": answer.xi, "y": answer.rate},
        "grid": {"x": answer.grid_xi, "y": answer.grid_rate},
        "end": {"x": answer.grid_xi[-1:], "y": answer.grid_rate[-1:]},
        "dist": {"x": run.t[thin], "y": run.dist[thin]},
        **{name: {"x": np.array([times[name]] if name in times else [])} for name in ("first", "foretold", "blow_up")},
        "steady": {"x": _LINE, "y": run.problem.steady(_LINE)[0]},
        "u": {"x": x, "y": u},
        "v": {"x": x, "y": v},
        "negative": dict(zip(("left", "right"), _negative(run), strict=True)),
    }


def _negative(run):
    """Left and right ends of the stretches where u < 0; a point of the grid stands for h/2 on either side."""
    u, h = run.final[0], 2 * np.pi / run.n
    below = np.concatenate(([False], u < 0, [u[0] < 0, False]))  # the period closed
    first, past = np.flatnonzero(~below[:-1] & below[1:]), np.flatnonzero(below[:-1] & ~below[1:])
    return tuple(np.clip((ends - 0.5) * h - np.pi, -np.pi, np.pi) for ends in (first, past))


def _shaded(u):
    return "u < 0: ill posed" if (u < 0).any() else ""


def _numbers(answer):
    run = answer.run
    return {
        "growth": f"{answer.growth:.4g}" if answer.growth > _GROWS else "nothing grows",
        "foretold": f"t = {answer.predicted:.4g}" if answer.predicted < math.inf else "never",
        "measured": f"t = {answer.measured:.4g}" if answer.measured < math.inf else f"none by t = {T_END:g}",
        "first": f"t = {run.t_first_negative:.4g}" if run.t_first_negative is not None else "never",
        "dist": f"{run.dist[-1]:.4g} at t = {run.t_stop:.4g}",
        "dt": f"{run.dt:.3g}",
        "end": f"t = {run.t_stop:.4g}",
    }


def _growth_in_words(answer):
    return (
        f"Growth rate against wavenumber xi, frozen at x = 0. The equations: {_rise(answer.xi, answer.rate)}. "
        f"On N = {answer.run.n} points, whose shortest wave is xi = {answer.run.n / 2:g}: "
        f"{_rise(answer.grid_xi, answer.grid_rate)}."
    )


def _rise(xi, rate):
    if not (rate > _GROWS).any():
        return "nowhere above zero"
    return f"above zero from xi = {xi[np.argmax(rate > _GROWS)]:.3g} on, {rate.max():.3g} at most"


def _dist_in_words(run):
    low = np.argmin(run.dist)
    return (
        f"Dist against time, on a logarithmic scale: {run.dist[0]:.3g} at t = 0, least at t = {run.t[low]:.3g} with "
        f"{run.dist[low]:.3g}, and {run.dist[-1]:.3g} at the end, t = {run.t_stop:.4g}."
    )


def _fields_in_words(run):
    (u, v), count = run.final, int((run.final[0] < 0).sum())
    return (
        f"u and v against x at t = {run.t_stop:.4g}, over the steady state a - cos x: u from {u.min():.3g} to "
        f"{u.max():.3g}, v from {v.min():.3g} to {v.max():.3g}; u < 0 at {count} of {run.n} points."
    )
