"""Values of terms on arrays: float32, float64, longdouble, complex ones, and mpmath numbers in object arrays.

Numbers in a text are decimals, rounded once to the numbers of the arrays; parameters are what they are as floats.
Where real numbers have no value (log of -1, 1/0 with many digits) it is not a number, and nothing is raised.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from primer.equations.stages import Evolution
from primer.types import Derivative

_PI = "3.14159265358979323846264338327950288419716939937510"  # more digits than any longdouble holds


@dataclass(frozen=True)
class Scalars:
    """What turns numbers of a text and parameters into those of an array: its dtype's, or its mpmath context's."""

    dtype: np.dtype
    context: Any = None

    @classmethod
    def of(cls, x):
        """Those of an array: for float and complex arrays alike, the real ones."""
        if x.dtype == object:
            return cls(x.dtype, next(z for z in x.flat).context)
        return cls(np.empty(0, x.dtype).real.dtype if x.dtype.kind in "fc" else np.dtype(float))

    def number(self, value):
        """A number of the text (its digits), a float or a complex number as one of these numbers."""
        if isinstance(value, complex):
            return self.context.mpc(value) if self.context else np.result_type(self.dtype, 1j).type(value)
        return self.context.mpf(value) if self.context else self.dtype.type(value)

    @property
    def pi(self):
        """Pi."""
        return +self.context.pi if self.context else self.dtype.type(_PI)


@dataclass(frozen=True, eq=False)
class Known:
    """What a time loop computes once: ``constants`` (numbers) and ``fixed`` (functions of x) of an ``Evolution``."""

    scalars: Scalars
    constants: tuple
    fixed: tuple


def known(evolution: Evolution, x: np.ndarray, parameters: Mapping[str, Any]) -> Known:
    """The :class:`Known` of an evolution on the points x, in the numbers of x."""
    scalars = Scalars.of(x)
    constants = tuple(value(term, scalars, parameters) for term in evolution.constants)
    return Known(scalars, constants, tuple(value(term, scalars, parameters, x=x) for term in evolution.fixed))


def tendencies(
    evolution: Evolution,
    parameters: Mapping[str, Any],
    state: Sequence[np.ndarray],
    derivative: Derivative,
    given: Known,
    t: Any = 0.0,
) -> tuple[np.ndarray, ...]:
    """The time derivatives of the fields: arrays of the shape of the fields, (..., n).

    ``derivative(f, m)`` gives the m-th x-derivative of an array along its last axis.
    """
    return tuple(stage_values(evolution, parameters, state, derivative, given, t)[0][-len(evolution.fields) :])


def stage_values(evolution, parameters, state, derivative, given, t=0.0):
    """(sources, slots): all fields and values of all stages; and, stage by stage, {(source, m): array}."""
    t = given.scalars.number(t) if evolution.clocks else t
    clocks = tuple(value(term, given.scalars, parameters, t=t) for term in evolution.clocks)
    leaves: dict = {"constant": given.constants, "fixed": given.fixed, "clock": clocks}
    sources, every = list(state), []
    for stage in evolution.stages:
        slots = {(s, m): derivative(sources[s], m) if m else sources[s] for s, m in stage.slots}
        leaves["slot"] = slots
        for term in stage.values:
            found = _value(term, leaves)
            sources.append(found if np.shape(found) == np.shape(state[0]) else found + np.zeros_like(state[0]))
        every.append(slots)
    return sources, every


def _value(term, leaves):
    if not term.operands:
        return leaves[term.kind][term.value]
    return operate(term.kind, term.value, *[_value(operand, leaves) for operand in term.operands])


def value(term: Any, scalars: Scalars, parameters: Mapping[str, Any], **variables: Any) -> Any:
    """The value of a term of numbers, parameters and the ``variables`` x or t."""
    if term.operands:
        inner = [value(operand, scalars, parameters, **variables) for operand in term.operands]
        return operate(term.kind, term.value, *inner)
    if term.kind in ("number", "parameter"):
        return scalars.number(term.value if term.kind == "number" else parameters[term.value])
    return scalars.number(1j) if term.kind == "i" else scalars.pi if term.kind == "pi" else variables[term.kind]


def operate(kind: str, what: Any, a: Any, b: Any = None) -> Any:
    """One operation on one or two values, of the kind that a :class:`~primer.equations.terms.Term` has."""
    if kind == "+":
        return a + b
    if kind == "-":
        return a - b
    if kind == "*":
        return a * b
    if kind == "neg":
        return -a
    if kind == "power":
        return power(a, what)
    if _many_digits(a) or _many_digits(b):
        return _guarded(kind, what)(a, b)
    if kind == "/":
        return a / b
    return np.power(a, b) if kind == "^" else _numpy(what)(a)


@cache
def _numpy(what):
    """NumPy's function of this name in the language; erf is SciPy's."""
    if what == "erf":
        from scipy.special import erf

        return erf
    return getattr(np, {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}.get(what, what))


def power(a: Any, n: int) -> Any:
    """a^n, n >= 1, by products: a^(2k) = a^k * a^k, a^(2k+1) = a^(2k) * a."""
    if n == 1:
        return a
    if n % 2:
        return power(a, n - 1) * a
    half = power(a, n // 2)
    return half * half


def _many_digits(a):
    return hasattr(a, "context") or (isinstance(a, np.ndarray) and a.dtype == object)


@cache
def _guarded(kind, what):
    """The operation, element by element, on mpmath numbers; not a number where it has no value."""

    def operation(a, b):
        context = (a if hasattr(a, "context") else b).context
        try:
            if kind == "/":
                found = a / b
            elif kind == "^":
                found = a**b
            else:
                found = abs(a) if what == "abs" else getattr(context, what)(a)
        except (ZeroDivisionError, OverflowError, ValueError):
            return context.nan
        real = not isinstance(a, context.mpc) and not isinstance(b, context.mpc)
        return context.nan if real and isinstance(found, context.mpc) else found

    return np.frompyfunc(operation, 2, 1)
