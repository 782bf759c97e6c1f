"""Linearise: from the tree of a text to the derivatives of its equations by every unknown and its derivatives.

Each derivative is a symbol of its own (u, u_x, v_xx ...), so that linearising is differentiating by each of them.
"""

import re
from dataclasses import dataclass, field

import sympy as sp

from primer.equations.text import PDEError, parse, split_name
from primer.equations.unknowns import VARIABLES, unknowns, uses

ORDER = 12  # the highest derivative
OPERATIONS = 400  # the longest expression that the derivative of a bracket may grow to: at 1000 sympy can take minutes
BITS = 4000  # the largest constant, in bits
POWER = 1000  # the largest exponent
CONSTANTS = {"i": sp.I, "pi": sp.pi}


@dataclass(frozen=True)
class System:
    """Equations F = left - right = 0, and their linearisation.

    Attributes
    ----------
    text : str
    unknowns : tuple of str     in the order in which they occur, those with a time derivative first
    parameters : tuple of str   the names that are neither unknowns nor x, y, t
    dim : int                   the number of space variables: 2 if y occurs, or a derivative by y; else 1
    slopes : tuple of dicts     for each equation {(unknown, (n, a, b)): slope}, the slope of F by the unknown's n-th
                                t-, a-th x- and b-th y-derivative
    places : dict               where in the text each of the parameters stands first
    sides : tuple               the F themselves
    """

    text: str
    unknowns: tuple
    parameters: tuple
    dim: int
    slopes: tuple
    places: dict = field(default_factory=dict, compare=False)
    sides: tuple = ()


def read(text, given=()):
    """The :class:`System` of a text. ``given`` are names with values: unknowns only if differentiated by name."""
    equations = parse(text)
    used = uses(equations, CONSTANTS)
    found = unknowns(used, len(equations), given)
    builder = _Builder(text, found)
    sides = tuple(builder.build(left) - builder.build(right) for left, right in equations)
    slopes = tuple(_slopes(F, found) for F in sides)
    names: dict = {}
    for (base, _, _), place in used.items():
        if base not in found and base not in VARIABLES:
            names.setdefault(base, place)
    dim = 2 if any(base == "y" or "y" in own + around for base, own, around in used) else 1
    return System(text, found, tuple(names), dim, slopes, names, sides)


def dropped(system, values):
    """The names without a value of which the linearised equations keep nothing, as of a forcing; but see the error.

    Raises
    ------
    PDEError    for a name without a value that looks like a derivative spelt otherwise
    """
    for name, place in system.places.items():
        if name not in values and (intended := _intended(name, system)):
            problem = f"{name} was not understood: {intended}; if it is a parameter, give {name}=..."
            raise PDEError(problem, system.text, place)
    kept = {symbol.name for slopes in system.slopes for slope in slopes.values() for symbol in slope.free_symbols}
    return [name for name in system.parameters if name not in values and name not in kept]


def _intended(name, system):
    """What a name was probably meant to be, in words; "" for one that is like no derivative."""
    stem, _, subscript = name.rpartition("_")
    for u in sorted(system.unknowns, key=len, reverse=True):
        rest = name.removeprefix(u)
        if rest != name and re.fullmatch("[xyt]+", rest):
            return f"the derivative of {u} is written {u}_{rest}"
        if stem == u and re.fullmatch(r"(([^\W\d_])\2*|([^\W\d_]\d+)+|[XYZT]+)", subscript):
            return f"derivatives of {u} are written with the letters x, y and t, as in {u}_xx"
        if re.search(rf"(?:^|_)(lap|laplacian|grad|div)_?{u}$|^d\d?{u}_?d[xyt]\d?$|^D\d?_?{u}$", name):
            return f"derivatives of {u} are written {u}_xx, {u}_xy, {u}_t"
    return ""


def _slopes(F, unknowns):
    found = {}
    for symbol in sorted(F.free_symbols, key=str):
        base, letters = split_name(symbol.name)
        slope = sp.diff(F, symbol) if base in unknowns else 0
        if slope != 0:
            found[base, tuple(letters.count(c) for c in "txy")] = slope
    return found


class _Builder:
    """Sympy expressions from nodes, every operation checked before it is done: no number can grow out of hand."""

    def __init__(self, text, unknowns):
        self.text, self.unknowns = text, unknowns

    def fail(self, problem, node):
        raise PDEError(problem, self.text, node.place)

    def build(self, node):
        build = {"+": self.sum, "*": self.product, "-": self.minus, "/": self.reciprocal, "^": self.power}
        value = (build.get(node.kind) or getattr(self, node.kind))(node)
        if value.has(sp.zoo, sp.nan, sp.oo, sp.S.NegativeInfinity):
            self.fail("a value that is not finite", node)
        if any(power.exp.is_Rational and abs(power.exp) > POWER for power in value.atoms(sp.Pow)):
            self.fail(f"a power above the {POWER} allowed", node)
        return value

    def number(self, node):
        digits, imaginary = node.value
        _, _, exponent = digits.lower().partition("e")
        if len(digits) > 60 or abs(int(exponent or "0")) > 300:
            self.fail("a number with more digits, or a larger exponent, than is allowed", node)
        value = sp.Rational(digits)
        return value * sp.I if imaginary else value

    def name(self, node):
        if node.value in CONSTANTS:
            return CONSTANTS[node.value]
        base, letters = split_name(node.value)
        stem, _, subscript = node.value.rpartition("_")
        if stem in self.unknowns and "z" in subscript and set(subscript) <= set("xyzt"):
            self.fail("a third space variable: there are x and y only", node)
        if base in VARIABLES and letters:
            self.fail(f"{base} is an independent variable and cannot be differentiated", node)
        return self.symbol(base, letters, node)

    def symbol(self, base, letters, node):
        if len(letters) > ORDER:
            self.fail(f"a derivative of order {len(letters)}, above the {ORDER} allowed", node)
        return sp.Symbol(f"{base}_{''.join(sorted(letters))}" if letters else base)

    def sum(self, node):
        return sp.Add(*(self.build(term) for term in node.operands))

    def product(self, node):
        return sp.Mul(*(self.build(factor) for factor in node.operands))

    def minus(self, node):
        return -self.build(node.operands[0])

    def reciprocal(self, node):
        value = self.build(node.operands[0])
        return self.fail("division by zero", node) if value == 0 else 1 / value

    def power(self, node):
        base, exponent = (self.build(operand) for operand in node.operands)
        if base == 0 and not exponent.is_positive:
            self.fail("division by zero", node)
        if exponent.is_Rational:
            bits = max((abs(a.p) * a.q).bit_length() for a in [*base.atoms(sp.Rational), sp.S.One])
            if abs(exponent) > 100 or exponent.q > 100 or abs(exponent) * bits > BITS:
                self.fail("a power that is too large", node)
        return base**exponent

    def call(self, node):
        argument = self.build(node.operands[0])
        # sqrt(z^2) has a derivative that can be evaluated where z is real; that of sympy's Abs has not.
        return sp.sqrt(argument**2) if node.value == "abs" else getattr(sp, node.value)(argument)

    def derivative(self, node):
        value = self.build(node.operands[0])
        for letter in node.value:
            change = [sp.diff(value, sp.Symbol(letter))]
            for symbol in sorted(value.free_symbols, key=str):
                base, letters = split_name(symbol.name)
                if base in self.unknowns:
                    change.append(sp.diff(value, symbol) * self.symbol(base, letters + letter, node))
            value = sp.Add(*change)
            if value.count_ops() > OPERATIONS:
                self.fail("a derivative that grows too long", node)
        return value
