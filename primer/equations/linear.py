"""Linearise: from the tree of a text to the derivatives of its equations by every unknown and its derivatives.

Each derivative is a symbol of its own (u, u_x, v_xx ...), so that linearising is differentiating by each of them.
"""

from dataclasses import dataclass, field
from functools import lru_cache

import sympy as sp

from primer.equations.error import PDEError
from primer.equations.text import Source, understand
from primer.equations.tree import OPERATORS, split_name
from primer.equations.unknowns import VARIABLES, unknowns, uses

ORDER = 12  # the highest derivative
OPERATIONS = 400  # the longest expression that the derivative of a bracket may grow to: at 1000 sympy can take minutes
BITS = 4000  # the largest constant, in bits
POWER = 1000  # the largest exponent
CONSTANTS = {"i": sp.I, "pi": sp.pi}


@dataclass(frozen=True)
class System:
    """Equations F = left - right = 0, and their linearisation.

    Names are those of the tree: the space variables are x, y, z and time is t, whatever the text calls them.

    Attributes
    ----------
    text : str
    unknowns : tuple of str     in the order in which they occur, those with a time derivative first
    parameters : tuple of str   the names that are neither unknowns nor variables
    dim : int                   the number of space variables: those declared, or x and those of y and z that occur
    places : dict               where in the text each of the parameters stands first
    sides : tuple               the F themselves
    source : Source             what the text calls all of them
    slopes : tuple of dicts     for each equation {(unknown, (n, a, b)): slope}, the slope of F by the unknown's n-th
                                t-, a-th x- and b-th y-derivative; in three space variables (n, a, b, c). Where
                                H(u) or absD(u) occur, how often stands behind these two numbers, last
    operators : bool            whether they occur
    """

    text: str
    unknowns: tuple
    parameters: tuple
    dim: int
    slopes: tuple
    places: dict = field(default_factory=dict, compare=False)
    sides: tuple = ()
    source: Source | None = field(default=None, compare=False, repr=False)
    operators: bool = False

    def outside(self, name):
        """What the text calls a name, in canonical letters."""
        return self.source.outside(name) if self.source else name

    def said(self, name):
        """A name as the text first says it."""
        return self.source.outside(name, said=True) if self.source else name


def read(text, given=(), named=(), space=None, time=None, functions=None):
    """The :class:`System` of a text.

    Parameters
    ----------
    given            names with values by keyword: unknowns only if differentiated by name
    named            names with values in ``at``
    space, time, functions    as for :func:`primer.equations.text.understand`
    """
    functions = functions or {}
    try:
        return _read(text, tuple(given), tuple(named), _hashable(space), time, tuple(functions.items()))
    except TypeError as error:
        if "unhashable" not in str(error):
            raise
        return _read.__wrapped__(text, tuple(given), tuple(named), _hashable(space), time, tuple(functions.items()))


def _hashable(space):
    return tuple(space) if isinstance(space, list) else space


@lru_cache(maxsize=64)
def _read(text, given, named, space, time, functions):
    source = understand(text, space, time, given, named, dict(functions))
    used = uses(source.equations, CONSTANTS)
    found = unknowns(used, len(source.equations), {source.inside(name) for name in given}, source.outside)
    builder = _Builder(source, found)
    number = 4 if source.dim == 3 else 3
    sides = tuple(builder.build(left) - builder.build(right) for left, right in source.equations)
    letters = "".join(split_name(symbol.name)[1] for F in sides for symbol in F.free_symbols)
    operators = any(letter in letters for letter in OPERATORS.values())
    if OPERATORS["H"] in letters and source.dim > 1:
        raise PDEError("H(u), the Hilbert transform, is that along x in one space variable only")
    counted = "txyz"[:number] + "".join(OPERATORS.values()) * operators
    slopes = tuple(_slopes(F, found, counted) for F in sides)
    names: dict = {}
    for (base, _, _), place in used.items():
        if base not in found and base not in VARIABLES:
            names.setdefault(base, place)
    return System(source.text, found, tuple(names), source.dim, slopes, names, sides, source, operators)


def _slopes(F, unknowns, counted):
    found = {}
    for symbol in sorted(F.free_symbols, key=str):
        base, letters = split_name(symbol.name)
        slope = sp.diff(F, symbol) if base in unknowns else 0
        if slope != 0:
            found[base, tuple(letters.count(c) for c in counted)] = slope
    return found


class sign(sp.Function):
    """The sign of a real number; its slope is 0, but where the number is 0 it has none."""

    @classmethod
    def eval(cls, z):
        """Of a number, sympy's sign."""
        return sp.sign(z) if z.is_number and z.is_extended_real else None

    def fdiff(self, argindex=1):
        """The slope."""
        return slope_of_sign(self.args[0])


class slope_of_sign(sp.Function):
    """0 where its argument is not 0."""

    @classmethod
    def eval(cls, z):
        """Of a number."""
        return (sp.nan if z.is_zero else sp.S.Zero) if z.is_number and z.is_zero is not None else None

    def fdiff(self, argindex=1):
        """The slope: 0 as well, and none at 0."""
        return self


# sqrt(z^2) has a derivative that can be evaluated where z is real; that of sympy's Abs has not.
_CALLS = {"abs": lambda z: sp.sqrt(z**2), "sign": sign}


class _Builder:
    """Sympy expressions from nodes, every operation checked before it is done: no number can grow out of hand."""

    def __init__(self, source, unknowns):
        self.source, self.unknowns = source, unknowns

    def fail(self, problem, node):
        raise PDEError(problem, self.source.text, node.place)

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
        if base in VARIABLES and letters:
            self.fail(f"{self.source.outside(base)} is an independent variable and cannot be differentiated", node)
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
        return (_CALLS.get(node.value) or getattr(sp, node.value))(argument)

    def check_linear(self, value, node):
        """Fail unless an operator that is no derivative is of something linear with constant coefficients."""
        own = [s for s in value.free_symbols if split_name(s.name)[0] in self.unknowns]
        slopes = [sp.diff(value, s) for s in own]
        varying = {split_name(s.name)[0] for slope in slopes for s in slope.free_symbols} & {*self.unknowns, *VARIABLES}
        if varying or sp.expand(value - sum(s * slope for s, slope in zip(own, slopes, strict=True))) != 0:
            self.fail("H and absD are of what is linear with constant coefficients, as H(u_xx + 2*u)", node)

    def derivative(self, node):
        value = self.build(node.operands[0])
        for letter in node.value:
            if letter in OPERATORS.values():
                self.check_linear(value, node)
            change = [sp.diff(value, sp.Symbol(letter))]
            for symbol in sorted(value.free_symbols, key=str):
                base, letters = split_name(symbol.name)
                if base in self.unknowns:
                    change.append(sp.diff(value, symbol) * self.symbol(base, letters + letter, node))
            value = sp.Add(*change)
            if value.count_ops() > OPERATIONS:
                self.fail("a derivative that grows too long", node)
        return value
