"""Whose fault is it? A solver of which nothing is known but what it does in one step."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np

from primer.checks import function, integer, real, sequence
from primer.study.advance import no_step
from primer.study.black_box import Box, Exhausted, Lost, Meter, numbers
from primer.study.fault import judged
from primer.study.modes import Spectra
from primer.study.remedy import remedied
from primer.study.sighting import look
from primer.study.vanishing_step import deep, unresolved

_CALLS = 80  # of the step, for each grid, at the very least


class Fault(StrEnum):
    """Whose fault it is."""

    SCHEME = "scheme"  # the time step lets grow what does not grow as dt -> 0
    ILL_POSED = "ill-posed"  # the finer the grid the faster: the program, which need not be the equations
    UNSTABLE = "unstable"  # growth that the grid does not change: the model's own
    STABLE = "stable"  # nothing grows
    UNDECIDED = "undecided"


@dataclass(frozen=True, eq=False)
class Examination:
    """What :func:`examine` found.

    Attributes
    ----------
    kind            a :class:`Fault`
    n, dt           the grids, (g,), and the step
    growth          (g,) fastest growth per unit time on each grid, extrapolated to dt -> 0; nan where it was not found
    error           (g,) how far off it may be
    amplification   (g,) the largest factor by which one step of dt multiplies a mode
    growths         (g, 3) the fastest growth with steps of dt, dt/2 and dt/4
    exponent        growth ~ coefficient k^exponent, with k waves in the domain; nan if nothing grows
    coefficient     nan if nothing grows
    wavelength      (g,) of the fastest mode, or of the one that the scheme amplifies, as a fraction of the domain
    stable_dt       where the scheme is to blame: the largest step on all these grids that is not, or 0 if there is
                    none; else nan
    calls           how often the step was called
    reason          in words

    A growth law that a grid shows is that of section A2.1 for the shortest waves that it has.

    >>> def step(u, dt):  # u_t = -u_xx: no step will cure it
    ...     h = 2 * np.pi / u.shape[-1]
    ...     return u - dt * (np.roll(u, 1, -1) - 2 * u + np.roll(u, -1, -1)) / h**2
    >>> found = examine(step, lambda n: np.zeros((1, n)), n=(16, 32, 64), dt=1e-4)
    >>> print(found.kind, f"{found.exponent:.2f}", found.wavelength * found.n)
    ill-posed 2.00 [2. 2. 2.]
    """

    kind: Fault
    n: tuple[int, ...]
    dt: float
    growth: np.ndarray
    error: np.ndarray
    amplification: np.ndarray
    growths: np.ndarray
    exponent: float
    coefficient: float
    wavelength: np.ndarray
    stable_dt: float
    calls: int
    reason: str


def examine(
    step: Callable[[np.ndarray, float], np.ndarray],
    state: Callable[[int], np.ndarray],
    n: Iterable[int] = (64, 128, 256),
    dt: float = 1e-3,
    patience: float = 120.0,
) -> Examination:
    """Is it the time step, the grid or the model? Asked of a solver that is only given as a function.

    Nothing is marched: small perturbations of the base state are followed through single steps of dt, dt/2 and dt/4 (or
    less, until rates converge), on each grid, by finite differences of the step. It is the program that is judged,
    which need not be the equations: about this base state, held still, and for small perturbations.

    Parameters
    ----------
    step        ``step(fields, dt)`` returns the fields, of shape (m, n) or (m, ny, nx), real or complex, a time dt
                later. Whatever is inside, the answer must depend on fields and dt alone; adapters for scipy, py-pde,
                FiPy and a plain loop are in :mod:`primer.study.black_box`
    state       ``state(n)`` gives the base state for each of ``n``: a uniform one costs a few dozen calls
    n           two grids or more, from coarse to fine; three to measure a power
    dt          the step that is in doubt, > 0
    patience    seconds that the calls may take together; what would take longer is not started

    Returns
    -------
    Examination. It is ``undecided`` where steps are noisy, random, remember, or fail, and says what would help.

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not allowed, fields that change their shape or are
                             not finite after one step from the base state, and a step that is too slow (an estimate)

    Growth of short waves without bound is ill-posedness (section A2.1); growth that a smaller dt takes away is the
    scheme's.

    >>> def step(u, dt):  # u_t = u_x by forward Euler and central differences
    ...     return u + dt * (np.roll(u, -1, -1) - np.roll(u, 1, -1)) * u.shape[-1] / (4 * np.pi)
    >>> examine(step, lambda n: np.ones((1, n)), n=(16, 32, 64)).kind.value
    'scheme'
    """
    function("step", step, "fields and dt")
    function("state", state, "n")
    dt, patience = real("dt", dt, above=0), real("patience", patience, above=0)
    grids = sequence("n", n, "two grids or more, such as (64, 128, 256)")
    grids = tuple(integer("n", each, least=4) for each in grids)
    if len(grids) < 2 or any(b <= a for a, b in pairwise(grids)):
        raise ValueError(f"n must be two grids or more, from coarse to fine, got {grids}")
    meter = Meter(patience)
    boxes = _timed(step, state, grids, dt, meter)
    try:
        doubts = [doubt for box in boxes if (doubt := box.doubt(dt) or no_step(box, dt))]
        if doubts:
            return _undecided(grids, dt, meter, f"Cannot tell: {doubts[0]}.")
        seen = _looked_at(boxes, dt)
        verdict = judged(seen, dt)
        if verdict.kind == Fault.SCHEME:
            verdict = remedied(verdict, seen, dt)
        if verdict.kind in (Fault.STABLE, Fault.UNSTABLE) and (lost := _lost(step, state, grids[-1], dt)):
            return _undecided(grids, dt, meter, f"Cannot tell: small perturbations say '{verdict.kind}', but {lost}.")
    except Lost as why:
        text = f"Cannot tell: from some perturbed state {why} (or a smaller dt may do, or another base state)."
        return _undecided(grids, dt, meter, text)
    except Exhausted:
        text = f"Cannot tell: {meter.calls} calls took {meter.seconds:.0f} s, more than patience = {patience:g} foresaw"
        return _undecided(grids, dt, meter, text + "; fewer or coarser grids, or more patience, would do.")
    each_grid = {name: np.array([getattr(one, name) for one in seen]) for name in ("growth", "error", "amplification")}
    growths = np.array([each.growths for each in seen])
    return Examination(
        Fault(verdict.kind), grids, dt, **each_grid, growths=growths, exponent=verdict.exponent,
        coefficient=verdict.coefficient, wavelength=np.array(verdict.wavelength), stable_dt=verdict.stable_dt,
        calls=meter.calls, reason=verdict.reason,
    )  # fmt: skip


def _timed(step, state, grids, dt, meter):
    """A box for each grid, and a refusal as soon as the calls are bound to take too long."""
    boxes: list[Box] = []
    for i, n in enumerate(grids):
        box = Box(step, state, n, dt, meter)
        if _CALLS * box.seconds * (len(grids) - i) > meter.patience and box.seconds < meter.patience / 2:
            before = meter.seconds
            box.step(np.zeros(box.shape), dt)  # the first call may have had something to compile
            box.seconds = min(box.seconds, meter.seconds - before)
        boxes.append(box)
        if box.shape[0] != boxes[0].shape[0] or (i and np.prod(box.shape) <= np.prod(boxes[i - 1].shape)):
            raise ValueError(
                f"state must give the same fields on each grid, on more points for a larger n, got shapes "
                f"{boxes[i - 1].base.shape} for n = {boxes[i - 1].n} and {box.base.shape} for n = {n}"
            )
        need = _CALLS * (sum(each.seconds for each in boxes) + box.seconds * (len(grids) - i - 1))
        if need > meter.patience:
            raise ValueError(
                f"step takes {box.seconds:.2g} s a call on n = {n}, and an examination at least {_CALLS} calls a grid, "
                f"together some {_time(need)}: more than patience = {meter.patience:g} seconds, so it was not started "
                "(where a first call compiles, call step once on each grid before)"
            )
    return boxes


def _time(seconds):
    return f"{seconds:.0f} seconds" if seconds < 120 else f"{seconds / 60:.0f} minutes"


def _looked_at(boxes, dt):
    """What each grid shows; the coarsest says how small a step must be for nothing to be hidden by it."""
    coarsest = Spectra(boxes[0], dt)
    first = look(coarsest, dt, dt / 4)
    if coarsest.route != "fastest" and unresolved(first.modes):
        found, _ = deep(coarsest, first.limit.dt)
        rate, _, grows = found.largest
        if grows and not found.open.any() and rate > 1.2 * max(first.growth, 0) + first.error:
            first = look(coarsest, dt, found.dt)  # an implicit step hid it
    start = first.limit.dt
    shrinks = 0 if start == dt / 4 else 2  # a finer grid needs a smaller step for the same
    return [first, *(look(Spectra(box, dt), dt, start * (boxes[0].n / box.n) ** shrinks) for box in boxes[1:])]


def _lost(step, state, n, dt, steps=10):
    """What becomes of the base state itself in some steps, if that is a blow-up; else None."""
    fields = numbers(state(n))
    largest = max(np.abs(fields).max(), 1.0)
    for k in range(1, steps + 1):
        try:
            with np.errstate(all="ignore"):  # that it may overflow is the question
                fields = numbers(step(fields.copy(), dt))
        except Exception as problem:
            return f"the march from state({n}) fails at step {k}, {type(problem).__name__}"
        if not np.isfinite(fields).all() or np.abs(fields).max() > 1e6 * largest:
            return f"the march from state({n}) itself is lost at step {k}"
    return None


def _undecided(grids, dt, meter, reason):
    lost, nan = np.full(len(grids), math.nan), math.nan
    growths = np.full((len(grids), 3), nan)
    return Examination(
        Fault.UNDECIDED, grids, dt, lost, lost, lost, growths, nan, nan, lost, nan, meter.calls, reason
    )  # fmt: skip
