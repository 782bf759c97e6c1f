"""Terms: expressions in the order of operations of the text, two operands at most, made from the parser's nodes.

``a - b + c`` is (a - b) + c and ``a*b/c`` is (a*b)/c, as Python would do it. Whole powers are products::

    u^2 = u*u,    u^(2k) = u^k * u^k,    u^(2k+1) = u^(2k) * u,    u^(-n) = 1/u^n

and u^(1/2) is sqrt(u), so that NumPy, a compiled loop and many digits do the same operations one by one.
"""

from dataclasses import dataclass
from fractions import Fraction

from primer.equations.text import PDEError, split_name

DERIVATIVE = 12  # the highest derivative
POWER = 1000  # the largest whole exponent


@dataclass(frozen=True)
class Term:
    """One term: what it is, and its operands.

    kind is one of

    number (value: its digits as text), pi, i, x, t, parameter (its name)
    slot        (s, m): the m-th x-derivative of source s; of a field, or of an intermediate result
    latest      the highest time derivative of an unknown (its name), which the equations are solved for
    derivative  the m-th x-derivative of its operand
    + - * / ^   of two operands
    neg, power (the whole exponent >= 2), call (the name of the function)    of one
    constant, fixed, clock    number k of what is computed once a run, once for each x, once for each t
    """

    kind: str
    value: object = None
    operands: tuple["Term", ...] = ()


ONE, ZERO = Term("number", "1"), Term("number", "0")


def add(a, b):
    """a + b, without a zero."""
    return b if a == ZERO else a if b == ZERO else Term("+", None, (a, b))


def subtract(a, b):
    """a - b, without a zero, nor a sign too many."""
    if b.kind == "neg":
        return add(a, b.operands[0])
    return negative(b) if a == ZERO else a if b == ZERO else ZERO if a == b else Term("-", None, (a, b))


def negative(a):
    """-a."""
    return a.operands[0] if a.kind == "neg" else a if a == ZERO else Term("neg", None, (a,))


def times(a, b):
    """a*b, without a one."""
    return ZERO if ZERO in (a, b) else b if a == ONE else a if b == ONE else Term("*", None, (a, b))


def over(a, b):
    """a/b, without a one."""
    return a if b == ONE else ZERO if a == ZERO else ONE if a == b else Term("/", None, (a, b))


def whole_power(a, n):
    """a^n for a whole n."""
    if n < 0:
        return Term("/", None, (ONE, whole_power(a, -n)))
    return (ONE, a)[n] if n < 2 else Term("power", n, (a,))


def size(term):
    """The number of operations and names in a term."""
    return 1 + sum(size(operand) for operand in term.operands)


class Builder:
    """Terms from the nodes of one text.

    ``name(base, letters, node)`` gives the term of an unknown with its derivatives, ``place(letters, term, node)`` that
    of a differentiated bracket; ``unknowns`` are the names that they are for.
    """

    def __init__(self, text, unknowns=(), name=None, bracket=None):
        self.text, self.unknowns, self.unknown, self.bracket = text, unknowns, name, bracket
        self.parameters: dict = {}

    def fail(self, problem, node):
        """Raise a PDEError that points at the node."""
        raise PDEError(problem, self.text, node.place)

    def build(self, node):
        """The term of a node."""
        build = {"+": self._sum, "*": self._product, "-": self._minus, "^": self._power}
        return (build.get(node.kind) or getattr(self, f"_{node.kind}"))(node)

    def _number(self, node):
        digits, imaginary = node.value
        _, _, exponent = digits.lower().partition("e")
        if len(digits) > 60 or abs(int(exponent or "0")) > 300:
            self.fail("a number with more digits, or a larger exponent, than is allowed", node)
        value = Term("number", digits)
        return times(value, Term("i")) if imaginary else value

    def _name(self, node):
        base, letters = split_name(node.value)
        if base in self.unknowns:
            return self.unknown(base, letters, node)
        if letters:
            self.fail(f"{base} is not an unknown and cannot be differentiated", node)
        if node.value in ("x", "t", "pi", "i"):
            return Term(node.value)
        if node.value == "y":
            self.fail("a second space variable, y: such equations can be judged, not marched", node)
        self.parameters[node.value] = None
        return Term("parameter", node.value)

    def _sum(self, node):
        total, *others = (self.build(term) for term in node.operands)
        for term in others:
            kind, term = ("-", term.operands[0]) if term.kind == "neg" else ("+", term)
            total = Term(kind, None, (total, term))
        return total

    def _minus(self, node):
        return Term("neg", None, (self.build(node.operands[0]),))

    def _product(self, node):
        total = None
        for factor in node.operands:
            kind, inner = ("/", factor.operands[0]) if factor.kind == "/" else ("*", factor)
            value = self.build(inner)
            if kind == "/" and rational(inner) == 0:
                self.fail("division by zero", factor)
            total = value if total is None else Term(kind, None, (total, value))
        return total

    def _power(self, node):
        base, exponent = node.operands
        value, a = rational(exponent), self.build(base)
        if value is not None and value.denominator == 1:
            if abs(value) > POWER:
                self.fail(f"a power above the {POWER} allowed", node)
            return whole_power(a, int(value))
        return Term("call", "sqrt", (a,)) if value == Fraction(1, 2) else Term("^", None, (a, self.build(exponent)))

    def _call(self, node):
        return Term("call", node.value, (self.build(node.operands[0]),))

    def _derivative(self, node):
        if self.bracket is None:
            self.fail("a derivative has no place here", node)
        return self.bracket(node.value, self.build(node.operands[0]), node)


def rational(node):
    """The number that a node writes out, as a Fraction, or None: 2, -3, 1/2."""
    if node.kind == "number" and not node.value[1]:
        digits, _, exponent = node.value[0].lower().partition("e")
        return Fraction(node.value[0]) if len(digits) <= 60 and abs(int(exponent or 0)) <= 300 else None
    if node.kind == "-":
        value = rational(node.operands[0])
        return None if value is None else -value
    if node.kind != "*":
        return None
    total = Fraction(1)
    for factor in node.operands:
        value = rational(factor.operands[0] if factor.kind == "/" else factor)
        if value is None or (factor.kind == "/" and value == 0):
            return None
        total = total / value if factor.kind == "/" else total * value
    return total
