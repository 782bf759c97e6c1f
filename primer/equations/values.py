"""Numbers for the names in a linearised system: base-state values and parameters, to many digits."""

import numbers
import re
from fractions import Fraction
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from primer.checks import shown
from primer.equations.error import PDEError, ask
from primer.equations.tree import split_name
from primer.equations.variables import canonical

BITS = 100_000  # the largest exact power, in bits: 3^(10^9) would take for ever
LARGEST_SLOPE = 1e100
LARGEST = 1e6  # the largest argument of a function: the exponential of this has half a million digits before its point


def checked(system, at, parameters, uniform=False):
    """{name: sympy number} from the base state ``at`` and the keyword ``parameters``; names as in the tree.

    ``uniform`` gives every derivative of an unknown the value 0.
    """
    at = {} if at is None else at
    if not isinstance(at, dict):
        raise TypeError(f"at must be a dict of base-state values such as {{'u': -0.5}}, got {shown(at)}")
    values = {}
    for key, value in [*at.items(), *parameters.items()]:
        name = _inside(system, key)
        base, letters = split_name(name)
        if base in system.unknowns:
            if key in parameters:
                raise PDEError(f"{key} is an unknown or its derivative: give its base value as {ask('base', key)}")
            name = f"{base}_{''.join(sorted(letters))}" if letters else base
        elif name not in (*system.parameters, *"xyzt"):
            known = ", ".join(map(system.said, [*system.unknowns, *system.parameters]))
            raise PDEError(f"{shown(key)} has a value but does not occur in the equations, which name {known}")
        if name in values:
            raise PDEError(f"{system.said(name)} has two values")
        values[name] = _exact(key, value)
        if uniform and base in system.unknowns and letters and values[name] != 0:
            raise PDEError(f"{key} = {shown(value)} and {ask('uniform')} contradict each other: there it is 0")
    if uniform:
        symbols = {s.name for slopes in system.slopes for slope in slopes.values() for s in slope.free_symbols}
        for name in symbols - values.keys():
            if split_name(name)[0] in system.unknowns and split_name(name)[1]:
                values[name] = sp.S.Zero
    return values


def _inside(system, key):
    """What the tree calls the name of a value, in whichever alphabet: nu is ν, and eps is ε where there is no eps."""
    if not isinstance(key, str):
        return ""
    name = system.source.inside(key) or ""
    known = (*system.unknowns, *system.parameters)
    if split_name(name)[0] in known:
        return name
    variables = system.source.variables
    if not variables.declared and name not in ("x", "y", "z"):  # a place, or a derivative, that does not matter
        base, letters = split_name(canonical(key))
        if base in ("x", "y", "z") and not letters:
            return base
        if base in known and letters:
            unused = dict(zip((v for v in "yz" if v not in variables.inner), "yz"[variables.dim - 1 :], strict=False))
            return f"{base}_{''.join(variables.inner.get(v) or unused[v] for v in letters)}"
    for short, long in (("eps", "epsilon"), ("epsilon", "eps")):
        other = re.sub(rf"^{short}(?=_|$|\d)", long, name)
        if other != name and split_name(other)[0] in known:
            return other
    return name


def _exact(name, value: Any):
    """A number as a sympy one; a float stands for its shortest decimal, so that 0.1 is 1/10."""
    value = value.item() if isinstance(value, np.ndarray) and value.ndim == 0 else value
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
            return _function(node.func.__name__, argument)
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


def _function(name, argument):
    """A function of the language, at mpmath's working precision."""
    if name not in ("sign", "slope_of_sign"):
        return getattr(mp, name)(argument)
    if mp.im(argument) != 0:
        raise PDEError("the sign of a complex number, or its absolute value, has no slope")
    if name == "slope_of_sign" and argument == 0:
        raise ZeroDivisionError
    return mp.sign(argument.real) if name == "sign" else mp.mpf(0)


def _short(expression):
    text = str(expression)
    return text if len(text) <= 60 else text[:57] + "..."
