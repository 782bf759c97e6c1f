"""Error against wall time, and wall time against N: the paper's scheme, better ones, and what other packages do."""

import math
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from primer.checks import instance, integer, real, sequence
from primer.problems.toy import Toy
from primer.schemes.grid import grids
from primer.schemes.marching import a_problem
from primer.schemes.progress import each
from primer.study.contestants import Method, contestants
from primer.study.truth import solution

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
    """The outcome of :func:`work_precision`: runs of ``toy``, whatever problem it is, to ``t_end``, method by method.

    ``doubt`` is the error bar of what errors are measured against: smaller ones say nothing.
    """

    toy: Any
    t_end: float
    points: tuple[Point, ...]
    doubt: float = 0.0

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
    toy: Any = None,
    t_end: float = 5.0,
    methods: Iterable[Method] | None = None,
    patience: float = 1.0,
    repeats: int = 5,
    exact: Callable | None = None,
    progress: bool = True,
) -> WorkPrecision:
    """Run every method through its knobs; compare the errors at t_end and the wall times.

    Parameters
    ----------
    toy                the problem: a ``Toy`` (default: a = 1.5, eps = 0.01) or a ``PDE`` with a ``reference`` at t_end,
                       a ``BackwardHeat``, which is solved in closed form, or any other with a solution ``exact``
    t_end : float      the end, t_end > 0
    methods            a sequence of ``Method`` (default: ``contestants(problem=toy, t_end=t_end)``)
    patience : float   seconds; a method is taken no further after a run that took longer, or that it refused
    repeats : int      runs of which the median time counts, after one more that compiles what is to be compiled (py-pde
                       compiles each time); one run must do if it takes longer than ``patience``
    exact              ``exact(x, t)``: the fields at the points x and the time t, against which errors are measured
    progress           whether to show a bar of methods, on a terminal, after two seconds

    Returns
    -------
    WorkPrecision; an error is the largest of any field on the method's grid (infinite after a blow-up), against
    ``exact``, or a reference with an error bar below 1e-13 (|a| + 2), of a ``PDE`` below 1e-11 (1 + max |initial|)
    or, where that cannot be had, 100 or 10,000 times as much

    Raises
    ------
    PastHorizon              if there is no reference at t_end
    TypeError, ValueError    in one sentence, for an argument that is not allowed

    For eq. (toy-pde), and any other.

    >>> from primer import PDE
    >>> from primer.study.contestants import contestants
    >>> (paper,) = [method for method in contestants() if method.name == "FTCS"]
    >>> found = work_precision(methods=[paper], patience=0.01, repeats=1)
    >>> print(found.methods, found.points[0].n, f"{found.points[0].error:.4f}")
    ('FTCS',) 25 0.0146
    >>> heat = PDE("u_t = u_xx", {"u": "sin(x)"})
    >>> found = work_precision(heat, 1.0, [paper], 0.01, 1, exact=lambda x, t: [np.exp(-t) * np.sin(x)])
    >>> print(found.points[0].n, f"{found.points[0].error:.4f}")  # (h^2/12 - dt/2) e^-1 sin x
    25 0.0009
    """
    toy = Toy(1.5) if toy is None else toy
    a_problem("toy", toy)
    t_end, patience = real("t_end", t_end, above=0), real("patience", patience, above=0)
    repeats = integer("repeats", repeats, least=1, most=10_000)
    methods = _methods(contestants(problem=toy, t_end=t_end) if methods is None else methods)
    truth, doubt = solution(toy, t_end, exact)
    points, refusal = [], None
    for method in each(methods, "method", progress):
        for knob in method.knobs:
            try:
                _prepare(method, toy, knob)
                seconds, (x, fields, dt) = clock(partial(method.march, toy, knob, t_end), patience, repeats)
            except ValueError as refused:
                refusal = refused
                break
            error = np.abs(np.array(fields) - truth(x)).max()
            points.append(Point(method.name, len(x), dt, float(error) if error < math.inf else math.inf, seconds))
            if seconds > patience:
                break
    if refusal is not None and not points:
        raise refusal
    return WorkPrecision(toy, t_end, pareto(points), doubt)


def pareto(points: Sequence[Point]) -> tuple[Point, ...]:
    """The same points, marked ``on_front`` where no other is both as quick and as accurate."""

    def beaten(p):
        return any(
            q.seconds <= p.seconds and q.error <= p.error and (q.seconds, q.error) != (p.seconds, p.error)
            for q in points
        )

    return tuple(replace(p, on_front=math.isfinite(p.error) and not beaten(p)) for p in points)


def cost_against_n(
    toy: Any = None,
    t_end: float = 5.0,
    ns: Iterable[int] = (50, 100, 200, 400, 800, 1600, 3200),
    methods: Iterable[Method] | None = None,
    seconds: float = 0.05,
    progress: bool = True,
) -> tuple[Point, ...]:
    """Wall time to t_end on n points, for the methods whose knob is n, with steps both stable and accurate enough.

    ``toy`` is the problem, any that can be marched (default: the toy system with a = 1.5, eps = 0.01). A stretch of the
    march that takes at least half of ``seconds`` is timed and scaled to t_end. A method that refuses a grid is taken no
    further. ``progress`` is that of ``work_precision``.

    Returns
    -------
    tuple of ``Point``, with error NaN

    For eq. (toy-pde), and any other.

    >>> from primer.study.contestants import contestants
    >>> (paper,) = [method for method in contestants() if method.name == "FTCS"]
    >>> [point.n for point in cost_against_n(ns=(20, 40), methods=[paper], seconds=1e-3)]
    [20, 40]
    """
    toy, points = Toy(1.5) if toy is None else toy, []
    a_problem("toy", toy)
    t_end, seconds = real("t_end", t_end, above=0), real("seconds", seconds, above=0)
    ns = grids("ns", sequence("ns", ns, "grids, such as [50, 100]"))
    refusal = None
    methods = _methods(contestants(with_py_pde=False, problem=toy, t_end=t_end) if methods is None else methods)
    for method in each(methods, "method", progress):
        for n in ns if method.by_points else ():
            span = min(t_end, 5.0 / n**2)
            try:
                _prepare(method, toy, n)
                while True:
                    spent, (_, _, dt) = clock(partial(method.march, toy, n, span), seconds, 1)
                    if spent > seconds / 2 or span >= t_end:
                        break
                    span = min(t_end, 4 * span)
            except ValueError as refused:
                refusal = refused
                break
            points.append(Point(method.name, n, dt, math.nan, spent * t_end / span))
    if refusal is not None and not points:
        raise refusal
    return tuple(points)


def _prepare(method, problem, knob):
    if method.step is not None:
        method.step(problem, knob)


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
