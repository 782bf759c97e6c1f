"""Error against wall time, and wall time against N: the paper's scheme, better ones, and what other packages do."""

import math
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from primer.checks import instance, integer, real, sequence
from primer.problems.toy import Toy
from primer.schemes.grid import grids
from primer.schemes.reference import reference
from primer.study.contestants import Method, contestants

_AT_LEAST = 0.05  # seconds over which short runs are repeated


@dataclass(frozen=True)
class Point:
    """One run: its points and step (NaN: the method's own), max-norm error, and median wall time in seconds.

    ``on_front``: no other run is both as quick and as accurate (the Pareto front).
    """

    method: str
    n: int
    dt: float
    error: float
    seconds: float
    on_front: bool = False


@dataclass(frozen=True)
class WorkPrecision:
    """The outcome of :func:`work_precision`: runs of ``toy`` to ``t_end``, method by method."""

    toy: Toy
    t_end: float
    points: tuple[Point, ...]

    @property
    def methods(self) -> tuple[str, ...]:
        """The names of the methods, in the order in which they ran."""
        return tuple(dict.fromkeys(point.method for point in self.points))

    def of(self, method: str) -> tuple[Point, ...]:
        """The points of one method."""
        return tuple(point for point in self.points if point.method == method)

    def quickest(self, method: str, error: float) -> Point | None:
        """The quickest point of a method with at most this error, or None."""
        return min((p for p in self.of(method) if p.error <= error), key=lambda p: p.seconds, default=None)


def work_precision(
    toy: Toy | None = None,
    t_end: float = 5.0,
    methods: Iterable[Method] | None = None,
    patience: float = 1.0,
    repeats: int = 5,
) -> WorkPrecision:
    """Run every method through its knobs; compare the errors at t_end and the wall times.

    Parameters
    ----------
    toy : Toy          the problem (default: a = 1.5, eps = 0.01); it needs a ``reference`` at t_end
    t_end : float      the end, t_end > 0
    methods            a sequence of ``Method`` (default: ``contestants()``)
    patience : float   seconds; a method is taken no further after a run that took longer
    repeats : int      runs of which the median time counts, after one more that compiles what is to be compiled (py-pde
                       compiles each time); one run must do if it takes longer than ``patience``

    Returns
    -------
    WorkPrecision; an error is the largest of u and v on the method's grid (infinite after a blow-up), against a
    reference with an error bar below 1e-13 (|a| + 2)

    For eq. (toy-pde).

    >>> from primer.study.contestants import contestants
    >>> (paper,) = [method for method in contestants() if method.name == "FTCS"]
    >>> found = work_precision(methods=[paper], patience=0.01, repeats=1)
    >>> print(found.methods, found.points[0].n, f"{found.points[0].error:.4f}")
    ('FTCS',) 25 0.0146
    """
    toy = Toy(1.5) if toy is None else instance("toy", toy, Toy)
    t_end, patience = real("t_end", t_end, above=0), real("patience", patience, above=0)
    repeats = integer("repeats", repeats, least=1, most=10_000)
    methods = _methods(contestants() if methods is None else methods)
    truth = reference(toy, t_end, tol=1e-13 * (abs(toy.a) + 2))
    points = []
    for method in methods:
        for knob in method.knobs:
            seconds, (x, fields, dt) = clock(partial(method.march, toy, knob, t_end), patience, repeats)
            error = np.abs(np.array(fields) - [f[0] for f in truth.at(x)]).max()
            points.append(Point(method.name, len(x), dt, float(error) if error < math.inf else math.inf, seconds))
            if seconds > patience:
                break
    return WorkPrecision(toy, t_end, pareto(points))


def pareto(points: Sequence[Point]) -> tuple[Point, ...]:
    """The same points, marked ``on_front`` where no other is both as quick and as accurate."""

    def beaten(p):
        return any(
            q.seconds <= p.seconds and q.error <= p.error and (q.seconds, q.error) != (p.seconds, p.error)
            for q in points
        )

    return tuple(replace(p, on_front=math.isfinite(p.error) and not beaten(p)) for p in points)


def cost_against_n(
    toy: Toy | None = None,
    t_end: float = 5.0,
    ns: Iterable[int] = (50, 100, 200, 400, 800, 1600, 3200),
    methods: Iterable[Method] | None = None,
    seconds: float = 0.05,
) -> tuple[Point, ...]:
    """Wall time to t_end on n points, for the methods whose knob is n, with steps both stable and accurate enough.

    A stretch of the march that takes at least half of ``seconds`` is timed and scaled to t_end.

    Returns
    -------
    tuple of ``Point``, with error NaN

    For eq. (toy-pde).

    >>> from primer.study.contestants import contestants
    >>> (paper,) = [method for method in contestants() if method.name == "FTCS"]
    >>> [point.n for point in cost_against_n(ns=(20, 40), methods=[paper], seconds=1e-3)]
    [20, 40]
    """
    toy, points = Toy(1.5) if toy is None else instance("toy", toy, Toy), []
    t_end, seconds = real("t_end", t_end, above=0), real("seconds", seconds, above=0)
    ns = grids("ns", sequence("ns", ns, "grids, such as [50, 100]"))
    for method in _methods(contestants(with_py_pde=False) if methods is None else methods):
        for n in ns if method.by_points else ():
            span = min(t_end, 5.0 / n**2)
            while True:
                spent, (_, _, dt) = clock(partial(method.march, toy, n, span), seconds, 1)
                if spent > seconds / 2 or span >= t_end:
                    break
                span = min(t_end, 4 * span)
            points.append(Point(method.name, n, dt, math.nan, spent * t_end / span))
    return tuple(points)


def _methods(methods):
    return tuple(instance("methods", method, Method) for method in sequence("methods", methods, "Method"))


def clock(run, patience, repeats):
    """(median seconds, outcome) of ``repeats`` calls of run(), or fewer, after one that does not count."""
    times: list[float] = []
    while len(times) <= repeats or sum(times[1:]) < _AT_LEAST:
        start = time.perf_counter()
        outcome = run()
        times.append(time.perf_counter() - start)
        if times[-1] > (5 if len(times) == 1 else 1) * patience:  # the first may have had to compile, but not so long
            return times[-1], outcome
    return float(np.median(times[1:])), outcome
