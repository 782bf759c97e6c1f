"""Symbols with their coefficients known: polynomial matrices M(lambda, xi), and det M without rounding.

A polynomial is a dict {(n, a, b): c} standing for the sum of c lambda^n xi_1^a xi_2^b; b = 0 in one space variable. In
three there is one more power, (n, a, b, c).
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property

import mpmath as mp
import numpy as np

from primer.analysis.determinant import determinant
from primer.analysis.pencil import Pencil
from primer.analysis.roots import DIGITS, ZERO
from primer.equations.text import PDEError
from primer.types import Multiplier


@dataclass(frozen=True)
class Symbol:
    """M(lambda, xi) of frozen-coefficient equations M q = 0: entry [r][c] is what equation r does to unknown c.

    Attributes
    ----------
    entries : tuple of tuples of polynomials {(n, a, b): c} in lambda and the derivatives (d/dx, d/dy) = i xi: the
        coefficients of time derivatives of order n and space derivatives of orders a and b (and c)
    dim : int       the number of space variables
    uniform : bool  whether the coefficients are those of a base state that is uniform and steady, so that the growth of
                    an exponential is that of a perturbation; where it varies they are frozen at a point
    operators : bool    whether the last two powers are those of the Hilbert transform and of |xi|: no polynomials then
    """

    entries: tuple
    dim: int = 1
    uniform: bool = True
    operators: bool = False

    @cached_property
    def determinant(self):
        """det M as a polynomial {(n, a, b): c} in lambda, xi_1, xi_2, without the terms that cancel."""
        with mp.workdps(DIGITS):
            i = mp.mpc(0, 1)
            rows = [[{p: c * i ** sum(p[1:]) for p, c in entry.items()} for entry in row] for row in self.entries]
            return determinant(rows, ZERO)

    def pencil(self, multiplier: Multiplier | None = None) -> Pencil:
        """The symbol as numbers: a :class:`Pencil`, with extra unknowns that stand for u_t where u_tt occurs.

        ``multiplier(xi, m)`` replaces (i xi)^m; it is called with m >= 1.
        """
        orders = [max((n for row in self.entries for n, *_ in row[c]), default=0) for c in range(len(self.entries))]
        width = len(orders)
        place = {}  # (unknown, time derivatives) -> column
        for c, order in enumerate(orders):
            place[c, 0] = c
            for n in range(1, order):
                place[c, n], width = width, width + 1
        S: dict = defaultdict(list)
        E: dict = defaultdict(list)
        for r, row in enumerate(self.entries):
            for c, entry in enumerate(row):
                for (n, *powers), value in entry.items():
                    top = n and n == orders[c]
                    (E if top else S)[r, place[c, n - 1 if top else n]].append((complex(value), *powers))
        for (c, n), column in place.items():
            if n:
                E[column, place[c, n - 1]].append((1, 0, 0))
                S[column, column].append((-1, 0, 0))
        matrices = [_Matrix(sums, width, self.dim, multiplier, self.operators) for sums in (S, E)]
        try:
            return Pencil(matrices[0], matrices[1], self.dim)
        except ValueError as singular:  # the equations do not determine the unknowns
            raise PDEError(str(singular)) from None


@dataclass(frozen=True, eq=False)
class _Matrix:
    """The matrix of sums of c (i xi_1)^a (i xi_2)^b, a callable of xi as a Pencil wants it."""

    sums: dict
    width: int
    dim: int
    multiplier: Multiplier | None
    operators: bool

    def __call__(self, xi):
        axes = [xi] if self.dim == 1 else list(xi)
        powers = {}
        value = np.zeros((*np.shape(axes[0]), self.width, self.width), dtype=complex)
        for (r, c), terms in self.sums.items():
            for factor, *orders in terms:
                term = factor
                if self.operators:
                    *orders, hilbert, moduli = orders
                    term = term * _operated(axes, hilbert, moduli)
                for axis, m in enumerate(orders):
                    if m:
                        if (axis, m) not in powers:
                            powers[axis, m] = self._derivative(axes[axis], m)
                        term = term * powers[axis, m]
                value[..., r, c] += term
        return value

    def _derivative(self, xi, m):
        return self.multiplier(xi, m) if self.multiplier else 1j**m * xi**m


def _operated(axes, hilbert, moduli):
    """(-i sign xi)^hilbert |xi|^moduli; sums of squares are only taken where there is more than one variable."""
    length = np.abs(axes[0]) if len(axes) == 1 else np.sqrt(sum(x**2 for x in axes))
    return (-1j * np.sign(axes[0])) ** hilbert * length**moduli if hilbert else length**moduli
