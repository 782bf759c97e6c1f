"""Fill a grid of points with verdicts, few of which are computed: where labels are equal, a few speak for all."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise

import numpy as np
from scipy import ndimage

from primer.study.region_subject import KINDS
from primer.study.sweep import Job, sweep

CHUNK = 8  # verdicts a job
_COLUMNS = ("kind", "exponent", "coefficient", "bound", "loss")


class Asked:
    """Verdicts at points, each computed once: rows (kind, exponent, coefficient, bound, loss) in a ``Table``."""

    def __init__(self, subject, store, executor, progress):
        self.subject, self.store, self.executor, self.progress = subject, store, executor, progress

    def rows(self, points):
        """(m, 5) at points (m, names); not a number where no verdict came, as after Ctrl-C."""
        keys = [tuple(map(float, point)) for point in points]
        new = [key for key in dict.fromkeys(keys) if key not in self.store.rows]
        jobs = [
            Job(f"{new[k]} and what follows", judged, (new[k : k + CHUNK], self.subject))
            for k in range(0, len(new), CHUNK)
        ]
        if jobs:
            sweep(jobs, self.executor, self.store, self.progress, stacklevel=4)
        lost = (math.nan,) * len(_COLUMNS)
        return np.array([self.store.rows.get(key, lost) for key in keys]).reshape(-1, len(_COLUMNS))

    def kinds(self, points):
        """(m,) what a boundary is between: the kind, exponent and loss, as numbers that can be compared."""
        return identities(self.rows(points))


def judged(points, subject):
    """{point: row} of verdicts; module-level, for other processes."""
    rows = {}
    for point in points:
        found = subject.verdict(point)
        numbers = (float(x) for x in (found.exponent, found.coefficient, found.bound, found.loss))
        rows[point] = (float(KINDS.index(found.kind)), *numbers)
    return rows


def identities(rows):
    """(m, 3) kind, exponent and loss, -1 where one is not a number; rows that are equal are of one piece."""
    return np.nan_to_num(rows[:, [0, 1, 4]], nan=-1.0, posinf=1e9)


def filled(asked, points, labels, samples):
    """(m, 3) identities at all points of a grid.

    ``points`` is of shape s + (names,), ``labels`` of shape s, or None where points cannot be told apart cheaply. Each
    connected set of one label is filled if the verdicts at ``samples`` of its points, its ends among them, agree; else
    its halves are, and so on. Without labels it starts from blocks of an eighth of the grid.
    """
    shape = points.shape[:-1]
    out = np.full((*shape, 3), np.nan)
    todo = []
    if labels is None:
        width = [max(1, math.ceil(s / 8)) for s in shape]
        blocks = np.indices(shape)
        names = np.ravel_multi_index([b // w for b, w in zip(blocks, width, strict=True)], [8] * len(shape))
        todo = [np.argwhere(names == name) for name in np.unique(names)]
    else:
        for label in np.unique(labels):
            parts, count = ndimage.label(labels == label)
            order = np.argsort(parts, axis=None, kind="stable")
            ends = np.searchsorted(parts.ravel()[order], np.arange(1, count + 2))
            places = np.stack(np.unravel_index(order, shape), axis=1)
            todo += [places[a:b] for a, b in pairwise(ends)]
    while todo:
        chosen = [_chosen(cells, samples) for cells in todo]
        found = asked.kinds(points[tuple(np.concatenate(chosen).T)])
        parts, todo, start = todo, [], 0
        for cells, some in zip(parts, chosen, strict=True):
            mine, start = found[start : start + len(some)], start + len(some)
            if (mine == mine[0]).all():
                out[tuple(cells.T)] = mine[0]
            elif len(some) == len(cells):
                out[tuple(some.T)] = mine
            else:
                axis = np.argmax(np.ptp(cells, axis=0))
                middle = (cells[:, axis].min() + cells[:, axis].max()) / 2
                todo += [cells[cells[:, axis] <= middle], cells[cells[:, axis] > middle]]
    return out


def _chosen(cells, samples):
    """Some of the cells: the farthest in eight directions, the one in the middle, and others here and there."""
    if len(cells) <= samples:
        return cells
    ways = cells @ (np.array([[1, 1], [1, -1], [1, 0], [0, 1]]).T if cells.shape[1] == 2 else np.ones((1, 1), int))
    ends = [*ways.argmin(axis=0), *ways.argmax(axis=0)]
    ends.append(int(np.abs(cells - cells.mean(axis=0)).sum(axis=1).argmin()))
    few = list(dict.fromkeys(map(int, ends)))[:samples]
    if len(few) < samples:
        rest = np.random.default_rng(len(cells)).choice(len(cells), samples - len(few), replace=False)
        few = list(dict.fromkeys([*few, *map(int, rest)]))
    return cells[few]


def bisected(same, low, high, steps=50):
    """(low, high), each (m, names), after bisection: ``same(points)`` is True where a point is as its ``low`` is."""
    low, high = low.copy(), high.copy()
    for _ in range(steps):
        middle = (low + high) / 2
        is_low = same(middle)[:, None]
        low, high = np.where(is_low, middle, low), np.where(is_low, high, middle)
    return low, high


def as_fraction(value):
    """An exponent or loss as a Fraction, or the float where it is none."""
    return Fraction(value).limit_denominator(360) if math.isfinite(value) else value
