"""From a pencil back to its coefficients, where its entries are polynomials in xi."""

from itertools import product

import mpmath as mp
import numpy as np

from primer.analysis.symbol import Symbol

HALF_DEGREES = (1, 2, 4)  # the number of nodes on each side of zero
NOISE = 1e-12  # relative error of the values of a pencil's entries, with something to spare
SCALES = (1.0, 1e2, 1e4, 1e6)  # sizes of xi_1 and xi_2 at which what is found between -1 and 1 must give the entries
DIGITS = 13  # kept of a coefficient, so that equal ones come out equal and the rest may count as exact


def recovered(pencil):
    """The :class:`Symbol` of a pencil: its coefficients, by interpolation between -1 and 1; None if they do not fit.

    They must fit far out, too: the symbol of a grid, such as 2 (1 - cos(h xi))/h^2, is nearly a polynomial nearby.
    """
    for half in HALF_DEGREES:
        node = np.arange(-half, half + 1) / half
        axes = np.meshgrid(*[node] * pencil.dim, indexing="ij")
        try:
            S, E = pencil.matrices(axes[0] if pencil.dim == 1 else np.stack(axes))
        except (ValueError, ArithmeticError):  # not a number there, as 1/(1 - xi^2) at 1
            return None
        inverse = np.linalg.inv(np.vander(node, increasing=True))
        tables = []
        for values in (S, E):
            for axis in range(pencil.dim):
                values = np.moveaxis(np.tensordot(inverse, values, axes=(1, axis)), 0, axis)
            tables.append(_without_noise(values if pencil.dim == 2 else values[:, None]))
        if _fits_far(pencil, tables):
            return _symbol(tables, pencil)
    return None


def _fits_far(pencil, tables):
    try:
        return all(_fits(pencil, tables, (pencil.probe.T * scale).T) for scale in product(SCALES, repeat=pencil.dim))
    except (ValueError, ArithmeticError):  # beyond all numbers, as exp(xi)
        return False


def _without_noise(table):
    """Coefficients without the rounding errors of the interpolation, and of the values themselves."""
    least = NOISE * np.abs(table).max(axis=(0, 1))
    parts = (np.where(np.abs(part) > least, part, 0.0) for part in (table.real, table.imag))
    return next(parts) + 1j * next(parts)


def _fits(pencil, tables, xi):
    """Whether the coefficients give the matrices at xi, up to rounding and to what the noise in them is worth there."""
    x, y = xi if pencil.dim == 2 else (xi, np.ones_like(xi))
    for values, table in zip(pencil.matrices(xi), tables, strict=True):
        powers = x ** np.arange(len(table))[:, None], y ** np.arange(table.shape[1])[:, None]
        terms = np.einsum("an,bn,abrc->nabrc", *powers, table)
        most = NOISE * np.abs(table).max(axis=(0, 1)) * (table != 0)
        noise = np.einsum("an,bn,abrc->nrc", *map(np.abs, powers), most)
        off = np.abs(values - terms.sum(axis=(1, 2)))
        if (off > noise + 1e-9 * (np.abs(terms).sum(axis=(1, 2)) + np.abs(values))).any():
            return False
    return True


def _symbol(tables, pencil):
    entries: list[list[dict]] = [[{} for _ in range(pencil.size)] for _ in range(pencil.size)]
    for n, table in enumerate(tables):
        for (a, b, r, c), value in np.ndenumerate(table):
            if value:
                number = mp.mpc(*(f"{p:.{DIGITS - 1}e}" for p in (value.real, value.imag)))
                entries[r][c][n, a, b] = number / mp.mpc(0, 1) ** (a + b)
    return Symbol(tuple(tuple(row) for row in entries), pencil.dim)
