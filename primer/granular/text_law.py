"""A law of one's own from two texts, Y(p, phi, I) and f(p, phi, I): the derivatives are made from the trees."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from primer.checks import real, shown
from primer.equations.text import parse_expression
from primer.granular.friction import numbers
from primer.types import ArrayLike, Numbers

_VARIABLES = "p", "phi", "I"
_CONSTANTS = {"pi": np.pi, "e": np.e}
#: Each function and its derivative.
_FUNCTIONS: dict[str, tuple[Callable, Callable]] = {
    "sqrt": (np.sqrt, lambda a: 0.5 / np.sqrt(a)),
    "exp": (np.exp, np.exp),
    "log": (np.log, lambda a: 1 / a),
    "sin": (np.sin, np.cos),
    "cos": (np.cos, lambda a: -np.sin(a)),
    "tan": (np.tan, lambda a: 1 / np.cos(a) ** 2),
    "sinh": (np.sinh, np.cosh),
    "cosh": (np.cosh, np.sinh),
    "tanh": (np.tanh, lambda a: 1 / np.cosh(a) ** 2),
}


@dataclass(frozen=True)
class TextLaw:
    """A law of one's own, closing eqs. (yield-cond-Cmu) and (flow-rule-Cmu), from two texts in p, phi and I.

    Parameters
    ----------
    Y_text, f_text    Y and f, with + - * / ^, brackets, pi, e, and sqrt, exp, log, sin, cos,
                      tan, sinh, cosh, tanh
    parameters        numbers by name for the other names in the texts

    Derivatives are those of the trees, exact to rounding. Where f is "0" and phi is not in Y the law is incompressible.

    Raises
    ------
    ValueError    (PDEError among them) for a text that cannot be read, a name without a value, or an unknown function

    >>> law = TextLaw("2*mu*p - p^2/C", "2*mu - 2*p/C", {"mu": 0.4, "C": 1.0})
    >>> print(f"{law.Y(0.2, 0.55, 0.1):.3f} {law.Y_p(0.2, 0.55, 0.1):.3f}")
    0.120 0.400
    """

    Y_text: str
    f_text: str
    parameters: dict[str, float] = field(default_factory=dict)
    incompressible: bool = field(init=False, default=False)

    def __post_init__(self) -> None:
        values = {}
        if not isinstance(self.parameters, dict):
            raise TypeError(f"parameters must be a dict of numbers by name, got {shown(self.parameters)}")
        for name, number in self.parameters.items():
            if name in _VARIABLES:
                raise ValueError(f"parameters must not hold p, phi or I, of which the law is a function, got {name}")
            values[name] = real(f"parameters: {name}", number)
        object.__setattr__(self, "parameters", values)
        trees, used = [], set()
        for name, text in (("Y_text", self.Y_text), ("f_text", self.f_text)):
            if not isinstance(text, str):
                raise TypeError(f"{name} must be a text such as '0.4*p', got {shown(text)}")
            try:
                tree = parse_expression(text)
            except ValueError as error:
                why = str(error).splitlines()[0]
                raise ValueError(f"{name} must be a text in p, phi and I, got {shown(text)}: {why}") from None
            used |= _check(name, tree, values)
            trees.append(tree)
        unused = sorted(set(values) - used)
        if unused:
            raise ValueError(f"parameters must be names in the texts, got {', '.join(unused)}")
        object.__setattr__(self, "_trees", tuple(trees))
        object.__setattr__(self, "incompressible", _zero(trees[1]) and "phi" not in _names(trees[0]))

    def _value(self, which: int, slot: int, p: Any, phi: Any, I: Any) -> Numbers:
        p, phi, I = numbers(p, phi, I)
        shape = np.broadcast_shapes(np.shape(p), np.shape(phi), np.shape(I))
        leaves = dict(zip(_VARIABLES, (p, phi, I), strict=True))
        with np.errstate(all="ignore"):
            found = _dual(self._trees[which], leaves, self.parameters)[slot]  # type: ignore[attr-defined]
        return np.broadcast_to(found, shape)[()]

    def Y(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """The first text."""
        return self._value(0, 0, p, phi, I)

    def Y_p(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """dY/dp."""
        return self._value(0, 1, p, phi, I)

    def Y_phi(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """dY/dphi."""
        return self._value(0, 2, p, phi, I)

    def Y_I(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """dY/dI."""
        return self._value(0, 3, p, phi, I)

    def f(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """The second text."""
        return self._value(1, 0, p, phi, I)

    def f_p(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """df/dp."""
        return self._value(1, 1, p, phi, I)

    def f_phi(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """df/dphi."""
        return self._value(1, 2, p, phi, I)

    def f_I(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """df/dI."""
        return self._value(1, 3, p, phi, I)


def _dual(node, leaves, parameters):
    """(value, d/dp, d/dphi, d/dI) of a tree."""
    if node.kind == "number":
        return float(node.value[0]), 0.0, 0.0, 0.0
    if node.kind == "name":
        if node.value in leaves:
            return (leaves[node.value], *(float(node.value == name) for name in _VARIABLES))
        return parameters.get(node.value, _CONSTANTS.get(node.value)), 0.0, 0.0, 0.0
    parts = [_dual(operand, leaves, parameters) for operand in node.operands]
    a = parts[0]
    if node.kind == "-":
        return tuple(-v for v in a)
    if node.kind == "/" and len(parts) == 1:  # a factor of a product that stands below the line
        return _two("/", (1.0, 0.0, 0.0, 0.0), a)
    if node.kind == "call":
        value, slope = _FUNCTIONS[node.value]
        return _chain(value(np.asarray(a[0], dtype=float)), slope(np.asarray(a[0], dtype=float)), a)
    for b in parts[1:]:
        a = _two(node.kind, a, b)
    return a


def _two(kind, a, b):
    if kind == "+":
        return tuple(x + y for x, y in zip(a, b, strict=True))
    if kind == "*":
        return (a[0] * b[0], *(x * b[0] + a[0] * y for x, y in zip(a[1:], b[1:], strict=True)))
    if kind == "/":
        q = np.divide(a[0], b[0])
        return (q, *(np.divide(x - q * y, b[0]) for x, y in zip(a[1:], b[1:], strict=True)))
    base = np.asarray(a[0], dtype=float)
    value = np.power(base, b[0])
    found = _chain(value, b[0] * np.power(base, b[0] - 1.0), a)
    if all(np.ndim(y) == 0 and y == 0 for y in b[1:]):
        return found
    return (value, *(x + value * np.log(base) * y for x, y in zip(found[1:], b[1:], strict=True)))


def _chain(value, slope, a):
    """f(a); a derivative that is 0 stays 0 where the slope is infinite."""
    return (value, *(0.0 if np.ndim(x) == 0 and x == 0 else slope * x for x in a[1:]))


def _check(which, node, parameters):
    """The names that a tree uses, or one sentence on what it may not hold."""
    if node.kind == "name":
        if node.value not in (*_VARIABLES, *_CONSTANTS) and node.value not in parameters:
            raise ValueError(
                f"{which} must be a text in p, phi, I and parameters with a value, got the name {node.value}"
            )
    elif node.kind == "call":
        if node.value not in _FUNCTIONS:
            raise ValueError(f"{which} must use only the functions {', '.join(_FUNCTIONS)}, got {node.value}")
    elif node.kind == "number":
        if node.value[1]:
            raise ValueError(f"{which} must be real, got the imaginary number {node.value[0]}i")
    elif node.kind not in ("+", "*", "-", "/", "^"):
        raise ValueError(f"{which} must have no derivatives, got {shown(node.value)}")
    return _names(node).union(*(_check(which, operand, parameters) for operand in node.operands))


def _names(node):
    found = {node.value} if node.kind == "name" else set()
    return found.union(*(_names(operand) for operand in node.operands))


def _zero(node):
    return node.kind == "number" and float(node.value[0]) == 0
