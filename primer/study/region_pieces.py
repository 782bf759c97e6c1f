"""The pieces of a region: what has one kind, exponent and loss, and what is known of it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from primer.analysis.outcome import Kind, Verdict
from primer.study.region_fill import as_fraction, identities
from primer.study.region_subject import KINDS


@dataclass(frozen=True)
class Piece:
    """All points of a region with one kind, exponent and loss.

    Attributes
    ----------
    kind, exponent, loss    those of :class:`primer.Verdict`
    share                   of the points of the grid
    where                   {name: value} of one of its points at which the verdict was computed
    verdict                 the :class:`primer.Verdict` there
    coefficient, bound      (least, largest) at the points at which the verdict was computed
    computed                at how many that was
    """

    kind: Kind
    exponent: Fraction | float
    loss: Fraction | float
    share: float
    where: dict
    verdict: Verdict
    coefficient: tuple
    bound: tuple
    computed: int


def pieces_of(of, points, whole, rows):
    """The pieces of a grid, largest first: identities (.., 3) at its points, rows {place: verdict's numbers}."""
    places, values = np.array(list(rows)), np.array(list(rows.values()))
    same_as, found = identities(values), []
    for identity in np.unique(whole[~np.isnan(whole).any(axis=-1)], axis=0):
        mine = (same_as == identity).all(axis=1)
        some, place = values[mine], tuple(places[mine][mine.sum() // 2])
        coefficient, bound = (tuple(map(float, (c.min(), c.max()))) for c in (some[:, 2], some[:, 3]))
        exponent, loss = as_fraction(float(some[0, 1])), as_fraction(float(some[0, 4]))
        share = float((whole == identity).all(axis=-1).mean())
        here = dict(zip(of.names, map(float, points[place]), strict=True))
        verdict = of.verdict(points[place])
        found.append(
            Piece(KINDS[int(identity[0])], exponent, loss, share, here, verdict, coefficient, bound, int(mine.sum()))
        )
    return tuple(sorted(found, key=lambda piece: -piece.share))
