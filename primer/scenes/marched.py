"""The scene of an equation at work: what it does on finer and finer grids, in words."""

from __future__ import annotations

import math
import re
from functools import lru_cache
from itertools import pairwise

import numpy as np

from primer.checks import shown
from primer.problems.pde import PDE
from primer.study.grid_comparison import GridComparison, compare_grids

WORK = 3 * 10**7  # points times steps on the finest grid that a slider can wait for
_SECOND = (1.7, 2.3)  # orders that count as the second, that of central differences


def data_of(text: str, name: str = "initial") -> dict[str, str]:
    """Field -> text from "u = a; v = -sin(x)/2".

    Raises
    ------
    ValueError    if it is not of this form, or gives a field twice
    """
    data: dict[str, str] = {}
    for part in filter(str.strip, re.split(r"[;\n]", text)):
        field, equals, value = (piece.strip() for piece in part.partition("="))
        if not (equals and field and value) or field in data:
            raise ValueError(f"{name} must be FIELD = TEXT parted by ';', each field once, got {shown(part.strip())}")
        data[field] = value
    return data


def length(text: str | float) -> float:
    """A number above 0, or a multiple of pi such as "16*pi".

    Raises
    ------
    ValueError    if it is neither
    """
    factor, star, last = str(text).replace(" ", "").rpartition("*")
    try:
        number = float(factor or 1) * math.pi if last == "pi" and bool(factor) == bool(star) else float(text)
    except ValueError:
        number = math.nan
    if not 0 < number < math.inf:
        raise ValueError(f"period must be a number above 0, or a multiple of pi such as 16*pi, got {shown(text)}")
    return number


@lru_cache(maxsize=32)
def marched(problem: PDE, n: int, t_end: float, work: float = WORK) -> GridComparison:
    """:func:`primer.study.grid_comparison.compare_grids` on n, 2n and 4n points, kept for the next look."""
    return compare_grids(problem, [n, 2 * n, 4 * n], t_end, work)


def in_words(found: GridComparison) -> str:
    """What the grids show, in a sentence; proof is none of it.

    >>> print(in_words(compare_grids(PDE("u_t = u_xx", {"u": "sin(x)"}), [16, 32], 1.0)))
    On 16 and 32 points the run reaches t = 1; successive grids differ by 0.00355 there.
    """
    sizes = _listed(found.n)
    if found.by_scheme.any():
        which = _listed(found.n[found.by_scheme])
        return f"On {which} points even an eighth of the step moves the time at which the run is lost: undecided."
    if np.isinf(found.lost).all():
        return f"On {sizes} points the run reaches t = {found.t[-1]:.4g}{_agreement(found)}"
    times = ", ".join(f"by t = {t:.3g}" if t < math.inf else f"not by {found.t[-1]:.3g}" for t in found.lost)
    looks = f"looked at {found.t.size - 1} times"
    lost = f"On {sizes} points the run is lost {times} (grown a thousandfold; {looks})"
    lost += ", and half the step moves that by a tenth at most"  # as compare_grids tells a step that is to blame
    if found.n.size == 1:
        return f"{lost}: other grids must tell why."
    if all(coarse > 1.1 * fine for coarse, fine in pairwise(found.lost)):
        return f"{lost}: the finer the grid the sooner, as where equations are ill posed."
    if found.lost[-1] == math.inf:
        return f"{lost}: the finest reaches the end, and the coarser ones are too coarse."
    if found.lost[-1] > 0.9 * found.lost[0]:
        return f"{lost}: at about the same time, which refining does not move: growth of the equations themselves."
    if np.isinf(found.lost[:-1]).any() and (np.diff(np.minimum(found.lost, 1e300)) <= 0).all():
        return f"{lost}: the finer the sooner, and the coarsest does not show it yet."
    return f"{lost}: sooner on the finest than on the coarsest, though not each time."


def _listed(numbers):
    *first, last = map(str, numbers)
    return f"{', '.join(first)} and {last}" if first else last


def _agreement(found):
    if found.n.size == 1:
        return "."
    apart = f"; successive grids differ by {_listed(f'{gap:.3g}' for gap in found.gap[:, -1])} there"
    if found.n.size == 2:
        return f"{apart}."
    if math.isnan(found.order):
        return f"{apart}: no order can be told."
    apart += f", a ratio of {found.gap[-2, -1] / found.gap[-1, -1]:.2g}"
    if _SECOND[0] <= found.order <= _SECOND[1]:
        return f"{apart}: they converge, with order {found.order:.1f}."
    if found.order > _SECOND[1]:
        return f"{apart}: the coarsest is too coarse for an order to show."
    if found.order > 0.3:
        return f"{apart}: they come closer, more slowly than in the second order."
    return f"{apart}: refining does not bring them together, as where equations are ill posed, or a flow chaotic."
