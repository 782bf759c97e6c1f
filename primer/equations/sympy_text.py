"""Equations of sympy, and lists, as one text: what else may stand where a text of equations does."""

import sys
from typing import Any

from primer.checks import shown
from primer.equations.error import PDEError

_CALLS = {"Abs": "abs", "sign": "sign", "Max": "max", "Min": "min", "log": "log"}


def texts(given, space=None, time=None):
    """(text, space, time): one text of a text, of a sympy equation, or of a list of them.

    The functions of sympy equations tell the variables where these are not declared: of u(r, t) they are r and t.
    """
    if isinstance(given, str):
        return given, space, time
    parts = list(given) if isinstance(given, (list, tuple)) else [given]
    sympy: Any = sys.modules.get("sympy")  # whoever has a sympy equation has imported it
    symbolic = [part for part in parts if sympy and isinstance(part, (sympy.Basic, sympy.logic.boolalg.Boolean))]
    if not parts or not all(isinstance(part, str) or any(part is each for each in symbolic) for part in parts):
        what = type(given).__name__ if not isinstance(given, (list, tuple)) else shown(given)
        raise TypeError(
            f"the equations must be a string such as 'u_t = u_xx', a list of them or of sympy's Eq, got {what}"
        )
    if symbolic:
        variables = dict.fromkeys(
            str(a)
            for part in symbolic
            for f in sorted(part.atoms(sympy.core.function.AppliedUndef), key=str)
            if all(a.is_Symbol for a in f.args)
            for a in f.args
        )
        time = "t" if time is None else time
        space = [name for name in sorted(variables) if name != time] or None if space is None else space
        writer = _Writer(sympy, {*variables})
        parts = [part if isinstance(part, str) else writer.equation(part) for part in parts]
    return "; ".join(part.strip().rstrip(";") for part in parts), space, time


class _Writer:
    def __init__(self, sympy, variables):
        self.sympy, self.variables = sympy, variables

    def equation(self, part):
        if not isinstance(part, self.sympy.Eq):
            raise PDEError(f"a sympy expression is no equation: write Eq(..., 0), got {shown(part)}")
        return f"{self.written(part.lhs)} = {self.written(part.rhs)}"

    def written(self, e):
        """An expression in the language of equations, every operand in brackets that might need them."""
        sp = self.sympy
        if e.is_Rational:
            return str(e) if e.is_Integer and e >= 0 else f"({e})"
        if e.is_Float:
            return f"({sp.Rational(repr(float(e)))})"
        if e is sp.I or e is sp.pi:
            return "i" if e is sp.I else "pi"
        if e is sp.E:
            return "exp(1)"
        if e.is_Symbol:
            return str(e)
        if e.is_Add:
            return "(" + " + ".join(map(self.written, e.args)) + ")"
        if e.is_Mul:
            return "(" + "*".join(map(self.written, e.args)) + ")"
        if isinstance(e, sp.exp):
            return f"exp({self.written(e.args[0])})"
        if e.is_Pow:
            return f"({self.written(e.base)})^({self.written(e.exp)})"
        if isinstance(e, sp.Derivative):
            by = " ".join(str(v) for v, count in e.variable_count for _ in range(int(count)))
            inner = self.written(e.expr)
            return f"{inner}_{{{by}}}" if inner.isidentifier() else f"({inner})_{{{by}}}"
        if isinstance(e, sp.core.function.AppliedUndef):
            name, arguments = e.func.__name__, [self.written(a) for a in e.args]
            return name if {*arguments} <= self.variables and len(arguments) > 0 else f"{name}({', '.join(arguments)})"
        if e.is_Function:
            name = _CALLS.get(e.func.__name__, e.func.__name__)
            return f"{name}({', '.join(map(self.written, e.args))})"
        raise PDEError(f"{shown(e)} cannot be read as part of an equation")
