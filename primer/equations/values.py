"""Numbers for the names in a linearised system: base-state values and parameters, to many digits."""

import numbers
from fractions import Fraction
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from primer.checks import shown
from primer.equations.text import PDEError, canonical, split_name

BITS = 100_000  # the largest exact power, in bits: 3^(10^9) would take for ever
LARGEST_SLOPE = 1e100
LARGEST = 1e6  # the largest argument of a function: the exponential of this has half a million digits before its point


def checked(system, at, parameters):
    """{name: sympy number} from the base state ``at`` and the keyword ``parameters``."""
    at = {} if at is None else at
    if not isinstance(at, dict):
        raise TypeError(f"at must be a dict of base-state values such as {{'u': -0.5}}, got {shown(at)}")
    values = {}
    for name, value in [*at.items(), *parameters.items()]:
        name = canonical(name) if isinstance(name, str) else name
        base, letters = split_name(name) if isinstance(name, str) else (name, "")
        if base in system.unknowns:
            if name in parameters:
                raise PDEError(f"{name} is an unknown or its derivative: give its base value as at={{'{name}': ...}}")
            name = f"{base}_{''.join(sorted(letters))}" if letters else base
        elif name not in (*system.parameters, *"xyt"):
            known = ", ".join([*system.unknowns, *system.parameters])
            raise PDEError(f"{shown(name)} has a value but does not occur in the equations, which name {known}")
        if name in values:
            raise PDEError(f"{name} has two values")
        values[name] = _exact(name, value)
    return values


def _exact(name, value: Any):
    """A number as a sympy one; a float stands for its shortest decimal, so that 0.1 is 1/10."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (numbers.Number, np.number, sp.Expr)):
        raise TypeError(f"{name} must be a number, got {shown(value)} ({type(value).__name__})")
    if isinstance(value, sp.Expr):
        if not value.is_number or not value.is_finite:
            raise ValueError(f"{name} must be a finite number, got {shown(value)}")
        return value
    if isinstance(value, (Fraction, numbers.Integral)):
        return sp.Rational(int(value.numerator), int(value.denominator))
    number = complex(value)  # type: ignore[arg-type]  # the abstract Number does not say that it can
    if not np.isfinite(number):
        raise ValueError(f"{name} must be a finite number, got {shown(value)}")
    real, imaginary = (sp.Rational(repr(part)) for part in (number.real, number.imag))
    return real + sp.I * imaginary


def substituted(expression, values):
    """The expression with these values for their names, exactly; names without a value stay.

    Raises
    ------
    PDEError    for a power with too many digits, or a division by zero
    """
    if expression.is_Symbol:
        return values.get(expression.name, expression)
    if not any(symbol.name in values for symbol in expression.free_symbols):
        return expression
    args = [substituted(a, values) for a in expression.args]
    if expression.is_Pow and args[1].is_Rational:
        bits = max((abs(a.p) * a.q).bit_length() for a in [*args[0].atoms(sp.Rational), sp.S.One])
        if abs(args[1]) * bits > BITS:
            raise PDEError(f"the base state makes {_short(expression)} a power that is too large to write out")
    value = expression.func(*args)
    if value in (sp.nan, sp.zoo):
        raise PDEError(f"the base state makes {_short(expression)} divide by zero: it cannot be linearised there")
    return value


def evaluated(expression, values):
    """The number that an expression has, at mpmath's working precision.

    Raises
    ------
    PDEError    for a division by zero, or a function of too large an argument
    """
    memory = {}

    def value(node):
        if node not in memory:
            memory[node] = compute(node)
        return memory[node]

    def compute(node):
        if node.is_Symbol:
            return value(values[node.name])
        if node.is_Rational:
            return mp.mpc(node.p) / node.q
        if node.is_Add:
            return mp.fsum(value(term) for term in node.args)
        if node.is_Mul:
            return mp.fprod(value(factor) for factor in node.args)
        if node.is_Pow:
            base, exponent = (value(a) for a in node.args)
            return base ** int(node.exp) if node.exp.is_Integer else mp.power(base, exponent)
        if node.is_Function:
            (argument,) = (value(a) for a in node.args)
            if abs(argument) > LARGEST:
                raise PDEError(f"{node.func.__name__} of a number above {LARGEST:g} in the linearised equations")
            return getattr(mp, node.func.__name__)(argument)
        return mp.mpmathify(node.evalf(mp.mp.dps))  # pi, e, i

    try:
        number = mp.mpc(value(expression))
    except (ZeroDivisionError, OverflowError):
        raise PDEError(
            f"the base state makes {_short(expression)} divide by zero: it cannot be linearised there"
        ) from None
    if not mp.isfinite(number) or abs(number) > LARGEST_SLOPE:
        raise PDEError(f"the base state makes {_short(expression)} {mp.nstr(number, 3)}: not a number to work with")
    return number


def _short(expression):
    text = str(expression)
    return text if len(text) <= 60 else text[:57] + "..."
