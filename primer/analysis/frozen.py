"""A text at a base state: its linearised system with numbers for the names, and what is known of that state."""

import mpmath as mp
import numpy as np
import sympy as sp

from primer.analysis.roots import DIGITS, ZERO
from primer.checks import shown
from primer.equations.error import PDEError
from primer.equations.linear import read
from primer.equations.tree import split_name
from primer.equations.values import checked, evaluated, substituted


def frozen(text, at, order, uniform, space, time, parameters):
    """(system, values): the :class:`System` of a text, and numbers for its names, as far as they are given."""
    if order not in ("full", "maximal"):
        raise ValueError(f"order must be 'full' or 'maximal', got {shown(order)}")
    if not isinstance(uniform, (bool, np.bool_)):
        raise TypeError(f"uniform must be True or False, got {shown(uniform)}")
    functions = {name: value for name, value in parameters.items() if _is_function(value)}
    parameters = {name: value for name, value in parameters.items() if name not in functions}
    system = read(text, parameters, at if isinstance(at, dict) else (), space, time, functions)
    return system, checked(system, at, parameters, uniform)


def _is_function(value):
    return isinstance(value, str) or (callable(value) and not isinstance(value, sp.Basic))


def is_lower(power, kept):
    """Whether a higher space derivative, of the same order in time, is among those kept."""
    return any(n == power[0] and sum(rest) > sum(power[1:]) for n, *rest in kept)


def is_uniform(system, values):
    """Whether the base state is uniform and steady, as far as given; an unknown without a value counts as zero."""
    state = dict(values)
    names = {symbol.name for F in system.sides for symbol in F.free_symbols}
    for name in names | set(values):
        base, letters = split_name(name)
        if base in ("x", "y", "z", "t") or (base in system.unknowns and letters and values.get(name, 0) != 0):
            return False
        if base in system.unknowns:
            state.setdefault(name, sp.S.Zero)
    try:
        with mp.workdps(DIGITS):
            left = (substituted(F, state) for F in system.sides)
            return all(not F.free_symbols and abs(evaluated(F, {})) < ZERO for F in left)
    except PDEError:  # without a value at this state, as log(u) at u = 0 where u matters to no slope
        return False
