"""The linearisation of an evolution equation about a state on a grid: slopes of each stage, and what is made of them.

A stage's value g(f_1, f_2, ...) of slots f_i changes by sum_i (dg/df_i) delta f_i, and a slot by the same stencil that
it is computed with. So the Jacobian is a sum of diagonals times differences, through brackets as well, and no
linearisation is written by hand: eq. (toy-pde-lin) of the paper comes out of eq. (toy-pde).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import comb
from typing import Any

import numpy as np

from primer.equations.evaluate import Known, operate, power, stage_values, value
from primer.equations.stages import Evolution
from primer.types import Derivative


@dataclass(frozen=True, eq=False)
class Linearisation:
    """The right-hand side of an ``Evolution``, linearised about a state.

    Attributes
    ----------
    evolution
    slopes       stage by stage, for each value {(source, m): its slope by that slot}: numbers or arrays (..., n)
    """

    evolution: Evolution
    slopes: tuple[tuple[dict, ...], ...]

    def apply(self, change: Any, derivative: Derivative) -> np.ndarray:
        """J times perturbations of shape (fields, ..., n)."""
        sources = list(change)
        for stage in self.slopes:
            for slopes in stage:
                zero = np.zeros_like(change[0])
                terms = (c * (derivative(sources[s], m) if m else sources[s]) for (s, m), c in slopes.items())
                sources.append(sum(terms, zero))
        return np.array(sources[-len(self.evolution.fields) :])

    def matrix(self, n: int, derivative: Derivative) -> np.ndarray:
        """J as a matrix on n points, (F n, F n) for F fields: J[f n + j, g n + k] acts on field g at point k."""
        fields = len(self.evolution.fields)
        # Of the unit perturbation of field g at point k, field f at point j: (f, g, k, j).
        units = np.moveaxis(np.eye(fields * n).reshape(fields, n, fields, n), 2, 0)
        return np.moveaxis(self.apply(units, derivative), 3, 1).reshape(fields * n, fields * n)

    def symbol(self, multiplier: Callable[[int], Any], derivative: Derivative | None = None) -> np.ndarray:
        """The frozen matrix at every point: what J does to a short wave e^{i xi x} there, complex, (..., F, F).

        ``multiplier(m)`` is what the m-th derivative does to the wave, of a shape that broadcasts against the slopes;
        ``derivative`` differentiates the slopes of brackets: (a w)_x is a w_x + a_x w; left out, they count as uniform.
        The shape (...) is that to which slopes and multipliers broadcast.
        """
        fields = len(self.evolution.fields)
        # Each source's change is a sum of c (d/dx)^k ... of the fields: {(field, (k, ...)): c}.
        sources: list[dict] = [{(f, ()): 1.0} for f in range(fields)]
        for stage in self.slopes:
            for slopes in stage:
                total: dict = {}
                for (s, m), slope in slopes.items():
                    for (f, orders), c in _differentiated(sources[s], m, derivative).items():
                        total[f, orders] = total.get((f, orders), 0) + slope * c
                sources.append(total)
        rows = [[_wave(source, f, multiplier) for f in range(fields)] for source in sources[-fields:]]
        shape = np.broadcast_shapes(*(np.shape(entry) for row in rows for entry in row))
        matrix = np.empty((*shape, fields, fields), dtype=complex)
        for i, row in enumerate(rows):
            for j, entry in enumerate(row):
                matrix[..., i, j] = entry
        return matrix


def _differentiated(source, m, derivative):
    """The m-th derivative of sums of c (d/dx)^k, by Leibniz."""
    if not m:
        return source
    found: dict = {}
    for (f, orders), c in source.items():
        for k in range(m + 1):
            if k and (derivative is None or not np.shape(c)):
                break  # uniform coefficients
            key = f, tuple(sorted((*orders, m - k))) if m > k else orders
            found[key] = found.get(key, 0) + comb(m, k) * (derivative(c, k) if k else c)
    return found


def _wave(source, f, multiplier):
    total: Any = 0
    for (g, orders), c in source.items():
        if g == f:
            for m in orders:
                c = c * multiplier(m)
            total = total + c
    return total


def linearised(
    evolution: Evolution,
    parameters: Mapping[str, Any],
    state: Any,
    derivative: Derivative,
    given: Known,
    t: Any = 0.0,
) -> Linearisation:
    """The :class:`Linearisation` about a state (fields, each of shape (..., n)) at time t."""
    _, slots = stage_values(evolution, parameters, state, derivative, given, t)
    return about(evolution, parameters, slots, given, t)


def about(evolution: Evolution, parameters: Mapping[str, Any], slots: Any, given: Known, t: Any = 0.0):
    """The :class:`Linearisation` about given values of the slots: for each stage {(source, m): value}."""
    t = given.scalars.number(t) if evolution.clocks else t
    clocks = tuple(value(term, given.scalars, parameters, t=t) for term in evolution.clocks)
    leaves = {"constant": given.constants, "fixed": given.fixed, "clock": clocks}
    slopes = tuple(
        tuple(_slopes(term, {**leaves, "slot": found})[1] for term in stage.values)
        for stage, found in zip(evolution.stages, slots, strict=True)
    )
    return Linearisation(evolution, slopes)


def _slopes(term, leaves):
    """(value, {slot: slope}) of a term."""
    if not term.operands:
        return leaves[term.kind][term.value], ({term.value: 1} if term.kind == "slot" else {})
    values, slopes = zip(*(_slopes(operand, leaves) for operand in term.operands), strict=True)
    found = operate(term.kind, term.value, *values)
    total: dict = {}
    for k, inner in enumerate(slopes):
        if inner:
            factor = _factor(term, values, found, k)
            for slot, slope in inner.items():
                total[slot] = total.get(slot, 0) + factor * slope
    return found, total


def _factor(term, values, found, k):
    """The slope of an operation by its k-th operand."""
    kind, a = term.kind, values[0]
    if kind in ("+", "-", "neg"):
        return -1 if kind == "neg" or (kind == "-" and k) else 1
    if kind == "*":
        return values[1 - k]
    if kind == "/":
        return operate("/", None, -found if k else 1 + 0 * values[1], values[1])
    if kind == "power":
        return term.value * power(a, term.value - 1)
    if kind == "^":
        return operate("call", "log", a) * found if k else values[1] * operate("^", None, a, values[1] - 1)
    return _CALLS[term.value](a, found)


def _sign(a, found):
    if np.iscomplexobj(a):
        raise ValueError("abs of a complex field has no slope, so that the equations cannot be linearised")
    return (a > 0) * 1.0 - (a < 0) * 1.0


def _gauss(a, found):
    """2/sqrt(pi) exp(-a^2), in the numbers of a: pi is 4 atan(1)."""
    root = operate("call", "sqrt", operate("call", "atan", 1 + 0 * a))
    return operate("/", None, operate("call", "exp", -a * a), root)


_CALLS = {
    "sin": lambda a, f: operate("call", "cos", a),
    "cos": lambda a, f: -operate("call", "sin", a),
    "tan": lambda a, f: 1 + f * f,
    "exp": lambda a, f: f,
    "log": lambda a, f: operate("/", None, 1 + 0 * a, a),
    "sqrt": lambda a, f: operate("/", None, 1 + 0 * a, 2 * f),
    "sinh": lambda a, f: operate("call", "cosh", a),
    "cosh": lambda a, f: operate("call", "sinh", a),
    "tanh": lambda a, f: 1 - f * f,
    "abs": _sign,
    "sign": lambda a, f: 0 * _sign(a, f),
    "asin": lambda a, f: operate("/", None, 1 + 0 * a, operate("call", "sqrt", 1 - a * a)),
    "acos": lambda a, f: operate("/", None, -1 + 0 * a, operate("call", "sqrt", 1 - a * a)),
    "atan": lambda a, f: operate("/", None, 1 + 0 * a, 1 + a * a),
    "erf": _gauss,
}
