"""The edges of a region: where the verdict changes between neighbours of a grid, bisected, and what lies on them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from primer.analysis.outcome import Kind
from primer.study.region_fill import bisected
from primer.study.region_subject import KINDS

_EXACT = 24  # edges that are bisected by verdicts, thirty of them each, where there are no labels to tell sides apart
_BESIDE = 12  # boundaries beside which verdicts are computed, to see whether labels have told the truth
_ON = 3  # boundaries of each pair of neighbours on which a verdict is computed
_DIGITS = 10  # to which a place is rounded before a coefficient that vanishes there is hoped to


@dataclass(frozen=True, eq=False)
class Lines:
    """Where neighbours differ: the edges' ends after bisection (m, names), what is on each side, and the errors."""

    low: np.ndarray
    high: np.ndarray
    kinds: np.ndarray  # (m, 2, 3) identities of the two sides; equal where only the labels differ
    error: np.ndarray  # (m,)

    def told(self):
        """(boundaries, error, changes): an array of values for one name, of points for two."""
        kind = self.kinds[:, 0, 0] != self.kinds[:, 1, 0]
        rest = (self.kinds[:, 0] != self.kinds[:, 1]).any(axis=1) & ~kind
        place = (self.low + self.high) / 2
        place[np.abs(place) < np.minimum(self.error, 1e-9)[:, None]] = 0.0
        if place.shape[1] == 2:
            return place[kind], self.error[kind], place[rest]
        values, errors = _once(place[kind, 0], self.error[kind])
        return values, errors, _once(place[rest, 0], self.error[rest])[0]


def _once(values, errors):
    """Values, ascending, of which those nearer to each other than their errors are one: a point between two edges."""
    order = np.argsort(values)
    kept: list[int] = []
    for k in order:
        if not kept or values[k] - values[kept[-1]] > 2 * (errors[k] + errors[kept[-1]]):
            kept.append(k)
    return values[kept], errors[kept]


def edges(asked, points, whole, labels) -> Lines:
    """The :class:`Lines` of a grid: points s + (names,), identities s + (3,), labels s or None."""
    names = points.shape[-1]
    parts: list[tuple] = []
    for axis in range(names):
        a, b = (tuple(cut if k == axis else slice(None) for k in range(names)) for cut in (slice(-1), slice(1, None)))
        differ = (whole[a] != whole[b]).any(axis=-1) & ~np.isnan(whole[a] + whole[b]).any(axis=-1)
        told = np.zeros_like(differ) if labels is None else labels[a] != labels[b]
        here = differ | told
        mark = np.zeros((here.sum(), 2)) if labels is None else np.stack([labels[a][here], labels[b][here]], axis=1)
        parts.append((points[a][here], points[b][here], np.stack([whole[a][here], whole[b][here]], axis=1), mark))
    low, high, kinds, marks = (np.concatenate(part) for part in zip(*parts, strict=True))
    error = np.abs(high - low).max(axis=1, initial=0) / 2
    split = marks[:, 0] != marks[:, 1]
    if split.any():
        meaning = _meaning(labels, whole)
        first = marks[split, 0]
        first = np.where((kinds[split, 0] != kinds[split, 1]).any(axis=1), meaning(first), first)
        ends = bisected(lambda x: _like(first, asked.subject.labels(x)[0], meaning), low[split], high[split])
        step = np.abs(ends[1] - ends[0]).max(axis=1)
        sure = _sure(asked, ends[0], ends[1], low[split], high[split], kinds[split])
        places = np.flatnonzero(split)[sure]
        low[places], high[places] = ends[0][sure], ends[1][sure]
        error[places] = step[sure] + 1e-11 * (1 + np.abs(ends[0][sure]).max(axis=1))
        split[np.flatnonzero(split)[~sure]] = False
    left = np.flatnonzero(~split & (kinds[:, 0] != kinds[:, 1]).any(axis=1))
    if len(left):
        some = left if len(left) <= _EXACT else left[:: -(-len(left) // _EXACT)]
        first = kinds[some, 0]
        ends = bisected(lambda x: (asked.kinds(x) == first).all(axis=1), low[some], high[some], 36)
        low[some], high[some] = ends
        error[some] = np.abs(ends[1] - ends[0]).max(axis=1)
    return Lines(low, high, kinds, error)


def _meaning(labels, whole):
    """A function of labels: a number < -10 for each identity that a label has on all of the grid; else the label."""
    flat, identity = labels.ravel(), np.unique(whole.reshape(-1, 3), axis=0, return_inverse=True)[1].ravel()
    stands = {}
    for label in np.unique(flat):
        some = identity[flat == label]
        stands[label] = -10 - int(some[0]) if (some == some[0]).all() else label
    return lambda found: np.array([stands.get(label, label) for label in found.tolist()])


def _like(first, found, meaning):
    """Whether points are as the first is: of the same identity, where that is what ``first`` is, else of its label."""
    return np.where(first <= -10, meaning(found), found) == first


def _sure(asked, low, high, start, end, kinds):
    """Whether the verdicts beside bisected edges are those of their sides: looked at for some of each pair of kinds."""
    sure = np.ones(len(low), dtype=bool)
    pairs, which = np.unique(kinds.reshape(-1, 6), axis=0, return_inverse=True)
    for k, pair in enumerate(pairs):
        if (pair[:3] == pair[3:]).all():
            continue
        mine = np.flatnonzero(np.ravel(which) == k)
        some = mine[:: -(-len(mine) // _BESIDE)]
        off = 1e-9 * (end[some] - start[some]) + 1e-9 * np.abs(low[some]) * (end[some] != start[some])
        beside = [np.maximum(low[some] - off, start[some]), np.minimum(high[some] + off, end[some])]
        told = [asked.kinds(x)[:, 0] for x in beside]
        if any((kind != pair[3 * s]).any() for s, kind in enumerate(told)):
            sure[mine] = False
    return sure


def isolated(asked, points, lines):
    """(({name: value}, Verdict), ...): points on lines whose kind is that of neither side."""
    tried = _on_lines(lines) + _on_middle_lines(asked.subject, points)
    found: list[tuple] = []
    for exact, beside in tried:
        verdict, place = asked.subject.exact(exact), [float(x) for x in exact]
        sides = asked.rows(beside)[:, 0]
        seen = any(np.allclose(place, other, rtol=1e-9) for other, _ in found)
        if verdict.kind is not Kind.UNDECIDED and KINDS.index(verdict.kind) not in sides and not seen:
            found.append((place, verdict))
    return tuple((dict(zip(asked.subject.names, place, strict=True)), verdict) for place, verdict in found)


def _on_lines(lines):
    """Places, rounded, on some lines of each kind, with a point on each side."""
    pairs = lines.kinds.reshape(-1, 6)
    tried = []
    for pair in np.unique(pairs, axis=0):
        mine = np.flatnonzero((pairs == pair).all(axis=1) & (lines.error < 1e-6))
        for k in mine[:: max(1, len(mine) // _ON)][:_ON]:
            across = np.abs(lines.high[k] - lines.low[k])
            size = np.maximum(np.abs(lines.low[k]), 1e-6)
            place = [
                float(x) if not d else float(f"{x:.{_DIGITS}g}") if abs(x) > 1e-11 else 0.0
                for x, d in zip((lines.low[k] + lines.high[k]) / 2, across, strict=True)
            ]
            off = np.where(across > 0, 1e-5 * size, 0.0)
            tried.append((place, [place - off, place + off]))
    return tried


def _on_middle_lines(subject, points):
    """Places where a coefficient vanishes, along the grid's middle lines, also where it does not change its sign."""
    names, tried = subject.names, []
    middle = points[tuple(s // 2 for s in points.shape[:-1])]
    low, high = points.reshape(-1, len(names)).min(axis=0), points.reshape(-1, len(names)).max(axis=0)
    for k, name in enumerate(names):
        aside = middle + (high - low) / math.e**5  # of what may vanish in the middle
        others = dict(zip(names, aside, strict=True))
        for value in subject.special(name, others):
            if low[k] <= value <= high[k]:
                place = np.array([float(value) if other == name else others[other] for other in names])
                off = np.zeros(len(names))
                off[k] = 1e-5 * max(abs(float(value)), 1e-3 * (high[k] - low[k]))
                exact = [value if other == name else x for other, x in zip(names, place, strict=True)]
                tried.append((exact, [place - off, place + off]))
    return tried
