"""Where in the space of its states and parameters an equation is ill posed: the verdict over one or two of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import pairwise
from os import PathLike
from typing import Any

import numpy as np

from primer.analysis.outcome import Verdict
from primer.checks import affordable, instance, integer, real, shown
from primer.study.region_edges import edges, isolated
from primer.study.region_fill import Asked, filled
from primer.study.region_pieces import pieces_of
from primer.study.region_subject import KINDS, Subject, subject
from primer.study.sweep import an_executor
from primer.study.table import Table

_POINTS = 10**6  # of a grid
_N = {1: 201, 2: 101}
_COLUMNS = ("kind", "exponent", "coefficient", "bound", "loss")


@dataclass(frozen=True, eq=False, repr=False)
class Region:
    """The verdict over one or two values; arrays are of the shape (n,), or (n, m) for two: first name, second name.

    Attributes
    ----------
    names, axes      what was varied, and an array of the values of each
    kind             "well-posed", "ill-posed" or "undecided"
    exponent, loss   those of the verdicts, as floats; nan if undecided
    coefficient      of the leading law where it is ill posed and the leading order of the Newton polygon shows it, or
                     the verdict was computed; elsewhere nan
    pieces           a ``Piece`` for each kind, exponent and loss, the largest first
    boundaries       one name: (k,) its values, ascending, where the kind changes. Two: (k, 2) points where it does, one
                     on each edge of the grid whose ends differ in kind
    error            (k,) by how much a boundary may be off
    changes          the same as ``boundaries`` where the exponent or the loss changes and the kind does not
    isolated         pairs ({name: value}, Verdict) of points on lines, or single ones, whose kind is that of neither
                     side: of those that lie where a coefficient vanishes
    computed         how many verdicts were computed

    Of the test of section A2.1, see ``region``.

    >>> from primer import region
    >>> found = region("u_t = (u^3 - u)_xx", {"u": (-2, 2)}, uniform=True, n=21)
    >>> print(found.boundaries.round(8), found.pieces[0].kind, found.verdict(u=0.5).kind)
    [-0.57735027  0.57735027] well-posed ill-posed
    """

    names: tuple
    axes: tuple
    kind: np.ndarray
    exponent: np.ndarray
    loss: np.ndarray
    coefficient: np.ndarray
    pieces: tuple
    boundaries: np.ndarray
    error: np.ndarray
    changes: np.ndarray
    isolated: tuple
    computed: int
    subject: Subject

    def __repr__(self):
        pieces = ", ".join(f"{piece.kind} on {piece.share:.0%}" for piece in self.pieces)
        return f"Region over {' and '.join(self.names)}: {pieces}; {len(self.boundaries)} boundary points"

    def verdict(self, **values: float) -> Verdict:
        """The verdict, computed, at one point."""
        if set(values) != set(self.names):
            raise ValueError(f"values must be of {' and '.join(self.names)}, got {shown(sorted(values))}")
        return self.subject.verdict([real(name, values[name]) for name in self.names])


def region(
    pde: Any,
    /,
    vary: Mapping[str, Any],
    *,
    at: dict[str, Any] | None = None,
    order: str = "full",
    uniform: bool = False,
    space: Any = None,
    time: str | None = None,
    n: int | None = None,
    samples: int = 9,
    table: str | PathLike | None = None,
    executor: Executor | None = None,
    progress: bool = True,
    **parameters: Any,
) -> Region:
    """For which base-state values or parameters, one or two of them, equations are ill posed, by ``verdict``.

    Parameters
    ----------
    pde         equations as text; a function of the varied names (and of ``at``) that gives a ``Pencil`` or a
                ``Verdict``; or a granular law, over p, phi and I
    vary        {name: (lowest, highest)} or {name: ascending values}, of one or two names
    n           how many values of each, where the ends are given: 201 of one, 101 of two
    samples     verdicts computed in each connected set of one signature
    table       a CSV file of the verdicts computed, with which a region that was interrupted goes on
    executor    any ``concurrent.futures.Executor``, for slow ones; progress: a bar on a terminal
    others      as for :func:`primer.verdict`

    What is assumed. With text in one space variable the *signature* is computed at all points, in double precision:
    which coefficients of det M vanish, and on which side of the imaginary axis the roots on each edge of its Newton
    polygon lie. A connected set of points of one signature is filled with one verdict if those at ``samples`` of its
    points agree, and parted until they do; other equations, and pencils, begin with an eighth of each axis. Where
    growth is decided below the leading order, or without a signature, a strip or island that lies between all these
    points is not seen. A line or point at which a coefficient of det M vanishes, as eps = 0, is looked for, also
    between the points of the grid: on the grid's own edges, and along its middle lines. Boundaries between signatures
    are bisected to 1e-10 of the axis, and verdicts beside some of them computed; others to what ``error`` says.

    Raises
    ------
    ValueError, TypeError    as :func:`primer.verdict`, and for a bad vary, n or samples

    It is the test of section A2.1, asked at many base states.

    >>> toy = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"
    >>> found = region(toy, {"u": (-2, 2)}, at={"v_xx": 0.3}, eps=0.01, n=41)  # eq. (toy-pde)
    >>> print(found.boundaries.round(8), [str(piece.kind) for piece in found.pieces])
    [0.] ['well-posed', 'ill-posed']
    """
    names, axes = _axes(vary, n)
    samples = integer("samples", samples, least=2)
    instance("progress", progress, bool)
    an_executor(executor)
    options: dict[str, Any] = {"order": order, "uniform": uniform, "space": space, "time": time, **parameters}
    of = subject(pde, names, {} if at is None else at, options)
    if len(names) == 1:
        axes = (_with_special(axes[0], of.special(names[0], {})),)
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    shape = points.shape[:-1]
    of.verdict(points[(0,) * len(names)])  # what cannot be used is said before all else
    settings = {"pde": repr(pde).replace("\n", " "), "at": sorted((at or {}).items()), "options": sorted(options)}
    settings |= {name: repr(value) for name, value in sorted(options.items())}
    asked = Asked(of, Table(table, settings, names, _COLUMNS), executor, progress)
    labels, growth = None, np.full(shape, math.nan)
    if of.has_labels:
        found, rate = of.labels(points.reshape(-1, len(names)))
        labels, growth = found.reshape(shape), rate.reshape(shape)
    whole = filled(asked, points, labels, samples)
    lines = edges(asked, points, whole, labels)
    alone = isolated(asked, points, lines)
    coefficient = np.where(whole[..., 0] == 1, growth, math.nan)
    index = [{value: k for k, value in enumerate(axis.tolist())} for axis in axes]
    rows = {  # of the points of the grid
        tuple(places[x] for x, places in zip(key, index, strict=True)): row
        for key, row in asked.store.rows.items()
        if all(x in places for x, places in zip(key, index, strict=True))
    }
    for place, row in rows.items():
        coefficient[place] = row[2]
    coefficient[whole[..., 0] != 1] = math.nan
    kind = np.array([*map(str, KINDS)], dtype=object)[np.nan_to_num(whole[..., 0], nan=2).astype(int)]
    exponent = _numbers(whole[..., 1], whole[..., 0] == 2)
    loss = _numbers(whole[..., 2], whole[..., 0] == 2)
    pieces = pieces_of(of, points, whole, rows)
    boundaries, error, changes = lines.told()
    if len(names) == 1:
        boundaries, error = _joined(boundaries, error, [place[names[0]] for place, _ in alone])
    arrays = kind.astype(str), exponent, loss, coefficient
    return Region(names, axes, *arrays, pieces, boundaries, error, changes, alone, len(asked.store.rows), of)


def _axes(vary, n):
    if not isinstance(vary, Mapping) or not 1 <= len(vary) <= 2:
        raise ValueError(f"vary must be a dict of one or two names, such as {{'u': (-2, 2)}}, got {shown(vary)}")
    many = _N[len(vary)] if n is None else integer("n", n, least=2)
    affordable("n: the grid of values", 256 * many ** len(vary), shown(many))
    axes = []
    for name, given in vary.items():
        if not isinstance(name, str):
            raise TypeError(f"vary must name values by texts, got {shown(name)}")
        try:
            values = [real(f"vary {name}", value) for value in given]
        except TypeError:
            raise TypeError(f"vary {name} must be its lowest and highest value, got {shown(given)}") from None
        if len(values) < 2 or any(a >= b for a, b in pairwise(values)):
            raise ValueError(f"vary {name} must be its lowest and highest value, or ascending ones, got {shown(given)}")
        axes.append(_even(values[0], values[1], many) if len(values) == 2 else np.array(values))
    if math.prod(map(len, axes)) > _POINTS:
        raise ValueError(f"n must make at most {_POINTS} points, got {' x '.join(str(len(a)) for a in axes)}")
    return tuple(vary), tuple(axes)


def _even(low, high, n):
    """Even values whose decimals are short: 0.3 and not 0.30000000000000004, so that what vanishes there does."""
    step = (high - low) / (n - 1)
    digits = 12 - math.floor(math.log10(max(abs(low), abs(high), step)))
    values = np.array([round(float(x), digits) for x in np.linspace(low, high, n)])
    values[[0, -1]] = low, high
    return values


def _with_special(axis, special):
    """The axis with the special values on it, and one value between each two neighbours of those."""
    inside = [float(x) for x in special if axis[0] <= x <= axis[-1]]
    between = [(a + b) / 2 for a, b in pairwise(inside)]
    return np.unique(np.concatenate([axis, inside, between]))


def _numbers(values, gone):
    return np.where(gone | (values == -1), math.nan, np.where(values == 1e9, math.inf, values))


def _joined(boundaries, error, alone):
    """The boundaries with the isolated points, at which the kind changes too, that are not among them."""
    new = [x for x in alone if not (np.abs(boundaries - x) <= 1e-9 * (1 + abs(x))).any()]
    order = np.argsort([*boundaries, *new])
    return np.array([*boundaries, *new])[order], np.array([*error, *(0.0 for _ in new)])[order]
