"""From a pencil back to its coefficients, where its entries are polynomials in xi."""

from itertools import product

import mpmath as mp
import numpy as np

from primer.analysis.symbol import Symbol

HALF_DEGREES = (1, 2, 4)  # the number of nodes on each side of zero
NOISE = 1e-12  # relative error of the values of a pencil's entries, with something to spare
SCALES = (
    1.0,
    1e2,
    1e4,
    1e6,
)  # of the components of xi, at which what is found between -1 and 1 must give the entries
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
            tables.append(_without_noise(values if pencil.dim > 1 else values[:, None]))
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
    least = NOISE * np.abs(table).max(axis=tuple(range(table.ndim - 2)))
    parts = (np.where(np.abs(part) > least, part, 0.0) for part in (table.real, table.imag))
    return next(parts) + 1j * next(parts)


def _fits(pencil, tables, xi):
    """Whether the coefficients give the matrices at xi, up to rounding and to what the noise in them is worth there."""
    parts = xi if pencil.dim > 1 else (xi, np.ones_like(xi))
    for values, table in zip(pencil.matrices(xi), tables, strict=True):
        axes = tuple(range(table.ndim - 2))
        product, most = table, NOISE * np.abs(table).max(axis=axes) * (table != 0)
        size = np.abs(table)
        product, most, size = (np.broadcast_to(a, (len(xi.T), *a.shape)) for a in (product, most, size))
        for axis, x in zip(axes, parts, strict=True):
            powers = x[:, None] ** np.arange(table.shape[axis])
            shape = [len(powers), *[1] * table.ndim]
            shape[1 + axis] = powers.shape[1]
            powers = powers.reshape(shape)
            product, most, size = product * powers, most * np.abs(powers), size * np.abs(powers)
        within = tuple(1 + axis for axis in axes)
        off = np.abs(values - product.sum(axis=within))
        if (off > most.sum(axis=within) + 1e-9 * (size.sum(axis=within) + np.abs(values))).any():
            return False
    return True


def _symbol(tables, pencil):
    entries: list[list[dict]] = [[{} for _ in range(pencil.size)] for _ in range(pencil.size)]
    for n, table in enumerate(tables):
        for (*powers, r, c), value in np.ndenumerate(table):
            if value:
                number = mp.mpc(*(f"{p:.{DIGITS - 1}e}" for p in (value.real, value.imag)))
                entries[r][c][(n, *powers)] = number / mp.mpc(0, 1) ** sum(powers)
    return Symbol(tuple(tuple(row) for row in entries), pencil.dim)
