"""Names without a value: those that the answer would silently drop, and those that are derivatives spelt otherwise."""

import re

from primer.equations.error import PDEError, ask
from primer.equations.tree import split_name
from primer.equations.variables import GREEK


def dropped(system, values):
    """The names without a value of which the linearised equations keep nothing, as of a forcing; but see the error.

    Raises
    ------
    PDEError    for a name without a value that looks like a derivative spelt otherwise
    """
    for name, place in system.places.items():
        if name not in values and (intended := _intended(name, system)):
            said = system.said(name)
            problem = f"{said} was not understood: {intended}; if it is a parameter, give {ask('value', said)}"
            raise PDEError(problem, system.text, place)
    kept = {symbol.name for slopes in system.slopes for slope in slopes.values() for symbol in slope.free_symbols}
    return [name for name in system.parameters if name not in values and name not in kept]


def not_given(missing, system):
    """What to say of names that must have a value."""
    parameters = [system.said(name) for name in missing if name in system.parameters]
    base = [system.said(name) for name in missing if name not in system.parameters]
    parts = []
    if base:
        parts.append(f"base-state values {', '.join(base)} ({ask('base', *base)})")
    if parameters:
        parts.append(f"parameters {ask('value', *parameters)}")
    said = "not given: " + " and ".join(parts)
    if any(split_name(name)[1] for name in missing if name not in system.parameters):
        return f"give {ask('uniform')} if the base state is uniform (all its derivatives are 0); {said}"
    return said


def _intended(name, system):
    """What a name was probably meant to be, in words; "" for one that is like no derivative."""
    said, variables = system.outside(name), system.source.variables
    stem, _, subscript = said.rpartition("_")
    by = f"{', '.join(variables.space)} and {variables.time}"
    for u in sorted(map(system.outside, system.unknowns), key=len, reverse=True):
        rest = said.removeprefix(u)
        if rest != said and (variables.derivatives(rest) or (not variables.declared and re.fullmatch("[xyzt]+", rest))):
            return f"the derivative of {u} is written {u}_{rest}"
        if stem == u and (re.fullmatch(_LIKE, subscript) or subscript in GREEK):
            other = subscript if subscript in GREEK else re.findall(r"[^\W\d_]\d*", subscript)[0]
            variable = ask("variable", "space" if other not in ("tau", "T") else "time", other)
            return f"derivatives of {u} are taken by {by}, as in {u}_{variables.space[0] * 2} (or declare {variable})"
        if re.search(_OPERATOR.replace("U", re.escape(u)), said):
            first = variables.space[0]
            return f"derivatives of {u} are written {u}_{2 * first}, d/d{first}({u}), lap({u})"
    return ""


_OPERATOR = r"(?:^|_)(?:lap|laplacian|grad|div)_?U$|^d\d?U_?d\w\d?$|^[dD]\d?[xyz]*_?U$"
_LIKE = r"(([^\W\d_])\2*|([^\W\d_]\d+)+|[XYZT]+)"  # subscripts like rr, x1x1, XX
