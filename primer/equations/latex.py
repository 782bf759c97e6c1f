"""Equations as LaTeX, as they are written in a text: derivatives as subscripts, quotients as fractions."""

from primer.equations.text import split_name, understand
from primer.equations.tree import OPERATORS

_LOWER = "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi psi"
_UPPER = "Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega"
_GREEK = f"{_LOWER} omega {_UPPER}".split(" ")
_GREEK_NAMES = {name: rf"\{name}" for name in _GREEK} | {"eps": r"\varepsilon", "lam": r"\lambda"}
_SUM, _PRODUCT, _POWER, _ATOM = range(4)  # how tightly what stands at the top of a node binds


def latex(text, space=None, time=None, functions=()):
    """The equations of a text as LaTeX, one string for each; other arguments as for the right-hand side.

    In x and t, whatever the text calls them, and with the functions written out.

    >>> print(*latex("u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"))
    u_{t} = v_{x} v_{t} = \\varepsilon u v_{xx} + u_{x} - v - \\sin\\left(x\\right)
    """
    source = understand(text, space, time, functions=dict(functions))
    return tuple(f"{_latex(left)[0]} = {_latex(right)[0]}" for left, right in source.equations)


def _latex(node):
    """(LaTeX, how tightly it binds) of a node."""
    return {
        "number": _number, "name": _name, "+": _sum, "-": _minus, "*": _product, "/": _reciprocal, "^": _power,
        "call": _call, "derivative": _derivative,
    }[node.kind](node)  # fmt: skip


def _within(node, binding):
    text, own = _latex(node)
    return text if own >= binding else rf"\left({text}\right)"


def _number(node):
    digits, imaginary = node.value
    mantissa, _, exponent = digits.lower().partition("e")
    text = rf"{mantissa} \cdot 10^{{{int(exponent)}}}" if exponent else digits
    return text + r"\,\mathrm{i}" * imaginary, _PRODUCT if exponent or imaginary else _ATOM


def _name(node):
    base, letters = split_name(node.value)
    if base == "i" and not letters:
        return r"\mathrm{i}", _ATOM
    stem, _, subscript = base.partition("_")
    stem = _GREEK_NAMES.get(stem, stem if len(stem) == 1 else rf"\mathrm{{{stem}}}")
    subscript = ",".join(part for part in (subscript.replace("_", ","), letters) if part)
    return (f"{stem}_{{{subscript}}}" if subscript else stem), _ATOM


def _sum(node):
    first, *others = node.operands
    text = _within(first, _SUM)
    for term in others:
        text += f" - {_within(term.operands[0], _PRODUCT)}" if term.kind == "-" else f" + {_within(term, _SUM)}"
    return text, _SUM


def _minus(node):
    return f"-{_within(node.operands[0], _PRODUCT)}", _SUM


def _product(node):
    first, *others = node.operands
    signed = first.kind == "-"
    text = _latex(first)[0] if signed else _within(first, _PRODUCT)
    for factor in others:
        if factor.kind == "/":
            text = rf"\frac{{{text}}}{{{_latex(factor.operands[0])[0]}}}"
        else:
            digits = factor.kind == "number"  # 2 3 would read as 23
            text += (r" \cdot " if digits else " ") + _within(factor, _PRODUCT)
    return text, _SUM if signed else _PRODUCT


def _reciprocal(node):
    return rf"\frac{{1}}{{{_latex(node.operands[0])[0]}}}", _PRODUCT


def _power(node):
    base, exponent = node.operands
    text, own = _latex(base)
    plain = own == _ATOM and base.kind != "call" and "_" not in text
    text = text if plain else rf"\left({text}\right)"
    return rf"{text}^{{{_latex(exponent)[0]}}}", _POWER


def _call(node):
    inner = _latex(node.operands[0])[0]
    if node.value == "sqrt":
        return rf"\sqrt{{{inner}}}", _ATOM
    if node.value == "abs":
        return rf"\left|{inner}\right|", _ATOM
    name = {"asin": r"\arcsin", "acos": r"\arccos", "atan": r"\arctan", "sign": r"\mathrm{sgn}", "erf": r"\mathrm{erf}"}
    return rf"{name.get(node.value, f'{chr(92)}{node.value}')}\left({inner}\right)", _ATOM


def _derivative(node):
    for letter, name in ((OPERATORS["H"], r"\mathcal{H}"), (OPERATORS["absD"], r"|\partial_x|")):
        if node.value == letter:
            return rf"{name}\left({_latex(node.operands[0])[0]}\right)", _ATOM
    return rf"\left({_latex(node.operands[0])[0]}\right)_{{{node.value}}}", _ATOM
