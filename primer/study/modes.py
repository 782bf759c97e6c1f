"""The modes of one step on one grid: by what each is multiplied, how surely, and how long its wave is.

The linearised step A is looked at as a batch of matrices, by the cheapest of three routes:

* a uniform state, and a step that is the same everywhere: one r x r matrix for each wave, from 2 r calls;
* else all of A, from 2 N calls, or fewer where a perturbation is not felt far away;
* else, where that is too large or too slow, A on the space of the modes that grow most, by Arnoldi's method
  (:mod:`primer.study.krylov`).

Steps of different dt are compared mode by mode: they share their eigenvectors where they approximate exp(dt J), and
what A' does to a mode of A is y A' x/(y x), with the left eigenvector y and the right one x.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.study.black_box import Lost
from primer.study.krylov import dominant
from primer.study.tangent import blocks, matrix, reach, spacing, tangent

_WHOLE = 800  # unknowns up to which all eigenvalues are computed: a second
_SAFE = 5.0  # standard deviations
LARGER = 1e-2  # of a field's size: a perturbation that an adaptive step takes note of
_EIG = 2e-16  # what a computation of eigenvalues adds, over the largest number and for each row


@dataclass(frozen=True, eq=False)
class Modes:
    """The eigenvalues of one step.

    Attributes
    ----------
    dt              the step
    factor          (p, r) complex: by what each mode is multiplied
    doubt           (p, r): how far off its logarithm may be, from the noise of the step and the mode's condition
    loose           (p, r): the same by the condition alone, large where two modes are nearly one
    spread          how far the largest logarithm moves if the matrix is changed by as much as it may be wrong
    right, left     (p, r, r): its eigenvectors, as columns of ``right`` and rows of ``left`` = its inverse
    """

    dt: float
    factor: np.ndarray
    doubt: np.ndarray
    loose: np.ndarray
    spread: float
    right: np.ndarray
    left: np.ndarray

    @property
    def growth(self):
        """ln |factor|/dt, (p, r)."""
        return np.log(np.maximum(np.abs(self.factor), 1e-300)) / self.dt

    @property
    def swing(self):
        """|ln |factor|| + |its angle|, (p, r): how far a mode is carried in a step."""
        return np.abs(self.growth * self.dt) + np.abs(np.angle(self.factor))

    def under(self, matrices):
        """By what another step, of these matrices, multiplies the same modes, (p, r)."""
        change = np.einsum("pij,pji->pi", self.left, matrices @ self.right - self.right)
        return 1 + change / np.einsum("pij,pji->pi", self.left, self.right)  # left is only nearly the inverse


class Spectra:
    """The modes of a :class:`~primer.study.black_box.Box` for any dt; each matrix is computed once."""

    def __init__(self, box, dt):
        self.box, self.dt, self._first = box, dt, tangent(box, dt)
        self._tangents, self._matrices, self._modes = {dt: self._first}, {}, {}
        self._basis: Any = None  # (N, k), where only the fastest modes are looked at
        self._seen: set[float] = set()
        self._slack = 0.0
        self.route = self._chosen(dt)

    def _chosen(self, dt):
        A, size = self._first, int(np.prod(self.box.shape))
        if self.box.uniform and (found := blocks(A)) is not None:
            self._matrices[dt] = found
            return "waves"
        if size <= _WHOLE:
            far = reach(A)
            self._apart = spacing(far, self.box.shape[1:])
            calls = 2 * self.box.shape[0] * int(np.prod(self._apart))
            if 3 * calls * self.box.seconds <= self.box.meter.left() / 2:
                return "whole"
        self._basis = np.zeros((size, 0))
        return "fastest"

    def tangent(self, dt):
        """The linearised step of another dt."""
        if dt not in self._tangents:
            self._tangents[dt] = tangent(self.box, dt, self._first)
        return self._tangents[dt]

    def matrices(self, dt):
        """The step as a batch of matrices, (p, r, r)."""
        if dt not in self._matrices:
            A = self.tangent(dt)
            if self.route == "waves":
                found = blocks(A)
                if found is None:
                    raise Lost(f"with dt = {dt:g} it is not the same everywhere, as it is with {self._first.dt:g}")
            elif self.route == "whole":
                found = matrix(A, self._apart)[None]
            else:
                Q = self._basis
                found = (Q.conj().T @ np.stack([A.complex(q) for q in Q.T], axis=1))[None]
            self._matrices[dt] = found
        return self._matrices[dt]

    def modes(self, dt):
        """The :class:`Modes` of a step of dt."""
        if dt not in self._modes:
            A = self.matrices(dt)
            factor, right = np.linalg.eig(A)
            left = _inverse(right)
            condition = np.linalg.norm(left, axis=2) * np.linalg.norm(right, axis=1)
            noise = _SAFE * self.tangent(dt).error * np.sqrt(A.shape[-1]) + _EIG * A.shape[-1] * np.abs(A).max()
            loose = doubt = noise * condition
            spread = 0.0
            if A.shape[-1] < 10:  # a double eigenvalue without two eigenvectors moves by the root of the noise
                size = np.linalg.norm(A - np.eye(A.shape[-1]), axis=(1, 2), ord="fro")[:, None]
                root = 1 / min(A.shape[-1], 3)
                doubt = np.minimum(doubt, _SAFE * noise**root * np.maximum(size, noise) ** (1 - root))
            else:  # and a whole crowd of them by more than each alone would say
                other = A + noise / _SAFE * np.random.default_rng(7).standard_normal(A.shape) / np.sqrt(A.shape[-1])
                spread = 2 * _SAFE * float(abs(np.log(np.abs(np.linalg.eigvals(other)).max() / np.abs(factor).max())))
            size = np.maximum(np.abs(factor), 1e-300)
            doubt, loose = (np.log1p(each / size) + self._slack * dt for each in (doubt, loose))
            self._modes[dt] = Modes(dt, factor, doubt, loose, spread, right, left)
        return self._modes[dt]

    def look(self, dt):
        """See to it that the modes which grow most in a step of dt are among those looked at."""
        if self.route != "fastest" or dt in self._seen:
            return
        self._seen.add(dt)
        found, slack = dominant(self.tangent(dt), self.box)
        self._slack = max(self._slack, slack / dt)
        basis = np.concatenate((self._basis, found), axis=1)
        U, s, _ = np.linalg.svd(basis, full_matrices=False)
        self._basis = U[:, s > 1e-6 * s[0]]
        self._matrices, self._modes = {}, {}

    def larger(self, modes, place):
        """By what one step multiplies a mode of the size ``LARGER``: an adaptive step notices it where it has grown."""
        p, i = place
        grid = self.box.shape[1:]
        vector = modes.right[p, :, i]
        if self.route == "waves":
            wave = np.zeros(grid, dtype=complex)
            wave.ravel()[p] = 1
            vector = vector.reshape(-1, *(1 for _ in grid)) * np.fft.ifftn(wave)
        elif self._basis is not None:
            vector = self._basis @ vector
        v = vector.reshape(self.box.shape)
        v = v * (LARGER / np.abs(v).max())
        parts = [part for part in (v.real, v.imag) if np.abs(part).max() > 1e-6 * LARGER]  # a step may swap the two
        try:
            after = [(self.box.step(part, modes.dt) - self.box.step(-part, modes.dt)) / 2 for part in parts]
        except Lost:
            return np.inf
        return float(np.linalg.norm(after) / np.linalg.norm(parts))

    def wavelength(self, modes, place):
        """That of one mode, as a fraction of the domain: of the strongest wave in it; infinite if that is uniform."""
        p, i = place
        grid = self.box.shape[1:]
        waves = np.meshgrid(*(np.abs(np.fft.fftfreq(n, 1 / n)) for n in grid), indexing="ij")
        if self.route == "waves":
            number = np.sqrt(sum(each.ravel()[p] ** 2 for each in waves))
        else:
            vector = modes.right[p, :, i]
            vector = vector if self._basis is None else self._basis @ vector
            strength = np.abs(np.fft.fftn(vector.reshape(self.box.shape), axes=range(1, len(grid) + 1))) ** 2
            strongest = np.unravel_index(np.argmax(strength.sum(axis=0)), grid)
            number = np.sqrt(sum(each[strongest] ** 2 for each in waves))
        return float(1 / number) if number else float("inf")


def _inverse(right):
    try:
        return np.linalg.inv(right)
    except np.linalg.LinAlgError:  # two modes are one
        return np.linalg.inv(right + 1e-15 * np.random.default_rng(5).standard_normal(right.shape))
