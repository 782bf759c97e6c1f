"""The linearisation of a black box, by central differences, with an honest error; and its matrix from few calls.

    A v = [S(u + delta v) - S(u - delta v)]/(2 delta)

is off by delta^2 where the step S bends and by noise/delta where it is noisy. Neither is known, so delta is looked for:
A v is computed with each power of ten, and two neighbours that agree best say both which to take and how good it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.study.black_box import Box, Lost

_DELTAS = 10.0 ** np.arange(-9, 0)  # of a field's size
_MIDDLE = 3  # 1e-6 and 1e-5: right for a smooth step in double precision
_DEAF = 1e-3  # of what is done to larger perturbations: no nonlinearity makes such a difference
_ROUGH = 0.1  # of a derivative: known no better, there is none
_ROUNDING = 1e-15  # what no difference of numbers near 1 can be better than


@dataclass(frozen=True, eq=False)
class Tangent:
    """The linearised step about the base state of a :class:`~primer.study.black_box.Box`.

    Attributes
    ----------
    box, dt    the step
    delta      the size of the perturbations, in units of the fields
    error      of each number in A v for |v| about 1, the root of the mean square
    """

    box: Box
    dt: float
    delta: float
    error: float

    def __call__(self, v):
        """A v, for real v of the shape of the fields."""
        return _difference(self.box, self.dt, self.delta, v)

    def complex(self, v):
        """A v, for complex v, flat."""
        v = v.reshape(self.box.shape)
        found = self(v.real) + (1j * self(v.imag) if np.iscomplexobj(v) and v.imag.any() else 0)
        return found.ravel()


def _difference(box, dt, delta, v):
    return (box.step(delta * v, dt) - box.step(-delta * v, dt)) / (2 * delta)


def tangent(box, dt, near=None):
    """The :class:`Tangent` with the best delta; ``near`` is one at another dt, whose delta will do.

    Raises
    ------
    Lost    if no perturbation at all has a finite answer
    """
    v = np.random.default_rng(2).standard_normal(box.shape)
    known: dict = {}

    def product(i):
        if i not in known:
            try:
                known[i] = _difference(box, dt, _DELTAS[i], v)
            except Lost as why:
                known[i] = why
        return known[i]

    def gap(i):  # between deltas i and i + 1
        pair = product(i), product(i + 1)
        if any(isinstance(each, Lost) for each in pair):
            return np.inf
        return float(np.sqrt(np.mean((pair[0] - pair[1]) ** 2)))

    last = len(_DELTAS) - 2
    i = _MIDDLE if near is None else min(int(np.argmin(np.abs(_DELTAS - near.delta))), last)
    if near is None:
        while i < last and gap(i + 1) <= gap(i):
            i += 1
        while i > 0 and gap(i - 1) < gap(i):
            i -= 1
    if not np.isfinite(gap(i)):
        reasons = [each for each in known.values() if isinstance(each, Lost)]
        raise reasons[0]
    if near is None and gap(i) > _ROUGH * np.sqrt(np.mean(product(i) ** 2)):
        raise Lost("it does not answer small perturbations in proportion: it is not smooth (it rounds, or counts)")
    if near is None and _is_deaf(product, i, v):
        raise Lost("it leaves small perturbations as they are, and not larger ones: tighten the tolerances inside it")
    return Tangent(box, dt, float(_DELTAS[i]), max(gap(i), _ROUNDING))


def _is_deaf(product, i, v):
    """Whether the step does next to nothing to perturbations of one size, and something to larger ones."""
    here = np.abs(product(i) - v).max()
    larger = [product(k) for k in range(i + 1, len(_DELTAS)) if k > len(_DELTAS) - 4]
    return any(not isinstance(each, Lost) and here < _DEAF * np.abs(each - v).max() for each in larger)


def blocks(A):
    """The matrices of a step that treats every place alike, one for each wave: (waves, r, r), or None if it does not.

    A perturbation in which all waves are equally strong is given to each of the r fields in turn, 2 r calls in all; one
    more tells whether the step really is the same everywhere.
    """
    r, *grid = A.box.shape
    axes = tuple(range(1, len(grid) + 1))
    random = np.random.default_rng(3)
    spectrum = np.fft.fftn(random.standard_normal(grid))
    probe = np.fft.ifftn(spectrum / np.abs(spectrum)).real
    probe *= np.sqrt(probe.size)
    found = np.empty((r, r, *grid), dtype=complex)
    for f in range(r):
        v = np.zeros(A.box.shape)
        v[f] = probe
        found[:, f] = np.fft.fftn(A(v), axes=axes) / np.fft.fftn(probe)
    v = random.standard_normal(A.box.shape)
    foreseen = np.fft.ifftn(np.einsum("gf...,f...->g...", found, np.fft.fftn(v, axes=axes)), axes=axes).real
    seen = A(v)
    if np.sqrt(np.mean((foreseen - seen) ** 2)) > 20 * A.error + 1e-4 * np.sqrt(np.mean((seen - v) ** 2)):
        return None
    return np.moveaxis(found, (0, 1), (-2, -1)).reshape(-1, r, r)


def reach(A):
    """How far a perturbation of one point is felt after a step, in points along each axis (periodic): (ny, nx)."""
    r, *grid = A.box.shape
    far = np.zeros(len(grid), dtype=int)
    for place in np.random.default_rng(4).integers(0, grid, size=(3, len(grid))):
        for f in range(r):
            v = np.zeros(A.box.shape)
            v[(f, *place)] = 1
            felt = np.abs(A(v)).max(axis=0) > 10 * A.error
            for axis, size in enumerate(grid):
                where = np.nonzero(felt)[axis]
                steps = (where - place[axis]) % size
                far[axis] = max(far[axis], np.minimum(steps, size - steps).max(initial=0))
    return tuple(int(each) for each in far)


def spacing(far, grid):
    """The least distances, divisors of the grid, at which perturbations of several points at once do not meet."""
    return tuple(
        min(d for d in range(1, size + 1) if size % d == 0 and (d > 2 * w or d == size))
        for w, size in zip(far, grid, strict=True)
    )


def matrix(A, apart):
    """The matrix of A, (N, N) with N all unknowns, from perturbations of points ``apart`` in each direction at once.

    2 r prod(apart) calls instead of 2 N.
    """
    r, *grid = A.box.shape
    rows = np.indices(A.box.shape)
    found = np.zeros((*A.box.shape, *A.box.shape))
    for start in np.ndindex(*apart):
        comb: tuple[Any, ...] = tuple(slice(s, None, d) for s, d in zip(start, apart, strict=True))
        # The nearest perturbed point, periodically, is the one that is felt.
        nearest = [
            (start[axis] + apart[axis] * np.round((rows[axis + 1] - start[axis]) / apart[axis]).astype(int)) % size
            for axis, size in enumerate(grid)
        ]
        for f in range(r):
            v = np.zeros(A.box.shape)
            v[(f, *comb)] = 1
            found[(*rows, f, *nearest)] = A(v)
    size = A.box.shape[0] * int(np.prod(grid))
    return found.reshape(size, size)
