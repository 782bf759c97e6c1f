"""A text whose values are partly left open: det M as a polynomial in lambda and xi, its coefficients in the open names.

A polynomial is a dict {(n, a, b): c} that stands for the sum of c lambda^n xi_1^a xi_2^b, the c being sympy's.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp

from primer.analysis.frozen import frozen
from primer.equations.error import PDEError
from primer.equations.missing import dropped, not_given
from primer.equations.values import substituted

LAM = sp.Symbol("lambda")
WAVES = sp.symbols("xi_1 xi_2 xi_3")
SIZE = 5  # unknowns: a determinant with more of them, in symbols, can take minutes


@dataclass(frozen=True, eq=False)
class Family:
    """det M of a text with open names.

    Attributes
    ----------
    names : tuple of str      the open names, as they were given or as the text says them
    symbols : tuple           sympy's symbols for them, real, in the same order
    determinant : dict        {(n, a, b): expression}, in one space variable b = 0
    dim : int                 the number of space variables
    """

    names: tuple
    symbols: tuple
    determinant: dict
    dim: int


def family(text: Any, open_names: tuple | None, at=None, order="full", uniform=False, space=None, time=None, **given):
    """The :class:`Family` of a text; ``open_names`` None: all names without a value stay open.

    Raises
    ------
    PDEError               (a ValueError) for text that cannot be used, or for other names without a value
    NotImplementedError    for what this does not hold: more than SIZE unknowns, the operators H and absD
    """
    at = dict(at or {})
    if open_names is not None:
        system, values = frozen(text, {**dict.fromkeys(open_names, 1), **at}, order, uniform, space, time, given)
        inside = tuple(values)[: len(open_names)]  # the names of the tree, in the order in which they were given
        values = {name: value for name, value in values.items() if name not in inside}
    else:
        system, values = frozen(text, at, order, uniform, space, time, given)
        used = {s.name for slopes in system.slopes for slope in slopes.values() for s in slope.free_symbols}
        inside = tuple(sorted(used - values.keys()))
        open_names = tuple(map(system.outside, inside))
        values = {**{name: sp.S.Zero for name in dropped(system, values)}, **values}
    if len(system.unknowns) > SIZE:
        raise NotImplementedError(f"more than {SIZE} unknowns")
    if system.operators:
        raise NotImplementedError("H and absD make a symbol that is no polynomial")
    own = {name: sp.Symbol(said, real=True) for name, said in zip(inside, open_names, strict=True)}
    size = len(system.unknowns)
    M = sp.zeros(size)
    for r, slopes in enumerate(system.slopes):
        kept: dict[str, set] = {name: set() for name in system.unknowns}
        for (name, power), slope in sorted(slopes.items(), key=lambda item: -sum(item[0][1][1:])):
            if order == "maximal" and any(n == power[0] and sum(rest) > sum(power[1:]) for n, *rest in kept[name]):
                continue
            entry = substituted(slope, values)
            left = sorted({s.name for s in entry.free_symbols} - own.keys())
            if left:
                raise PDEError(not_given(left, system))
            entry = entry.xreplace({sp.Symbol(old): new for old, new in own.items()})
            if entry == 0:
                continue
            kept[name].add(power)
            n, *orders = power
            wave = sp.prod((sp.I * k) ** m for k, m in zip(WAVES, orders[: system.dim], strict=False))
            M[r, system.unknowns.index(name)] += entry * LAM**n * wave
    D = sp.Poly(M.det(method="berkowitz"), LAM, *WAVES[: system.dim])
    terms = {}
    for (n, *powers), c in D.terms():
        c = sp.expand(c)
        c = sp.cancel(c) if c.has(sp.Pow) and not c.is_polynomial(*own.values()) else c
        if c != 0:
            terms[n, *powers, *[0] * (2 - len(powers))] = c
    return Family(tuple(open_names), tuple(own.values()), terms, system.dim)


def numbers(expressions, symbols, values):
    """(c, most): the expressions at many points, and the sums of the sizes of their terms; complex (k, m) and real.

    ``values`` are the symbols' arrays, of shape (m,); what has no value there is not a number.
    """
    own = {"sign": lambda z: np.sign(np.real(z)), "slope_of_sign": lambda z: np.where(z == 0, np.nan, 0.0)}
    values = [np.asarray(v, dtype=complex) for v in values]
    shape = values[0].shape
    found, sizes = [], []
    with np.errstate(all="ignore"):
        for c in expressions:
            terms = sp.Add.make_args(sp.expand(c))
            rows = sp.lambdify(symbols, list(terms), [own, "numpy"])(*values)
            rows = np.array([np.broadcast_to(row, shape) for row in rows], dtype=complex)
            found.append(rows.sum(axis=0))
            sizes.append(np.abs(rows).sum(axis=0))
    return np.array(found), np.array(sizes)
