"""From tokens to trees: a recursive-descent parser. Nothing is evaluated or executed here; the result is a plain tree.

Grammar, blanks aside::

    equations  = equation { (";" | "," | new line) equation }
    equation   = sum "=" sum
    sum        = product { ("+" | "-") product }
    product    = signed { ("*" | "/" | nothing) signed }
    signed     = ("+" | "-") signed | power
    power      = primary [ "^" signed | superscript ]
    primary    = number | name | bracket [ subscript ] | function bracket | operator primary | fraction

A line without a left side and "=" of its own continues the one before. What could be read in two ways is an error that
says both.
"""

from primer.equations import operands
from primer.equations.cursor import Cursor
from primer.equations.functions import minus
from primer.equations.operands import DEPTH
from primer.equations.tree import Node
from primer.equations.vectors import Vector, added, multiplied, squared

EQUATIONS = 10  # far beyond what a person would write by hand
_CLOSING = {"(": ")", "[": "]", "{": "}"}


class Parser(Cursor):
    """The equations, or one expression, of a list of tokens."""

    def equations(self):
        """Pairs (left, right) of nodes."""
        found: list[tuple] = []
        while True:
            while self.at(";", "\n", ","):
                self.take()
            if self.token.kind == "end":
                return found or self.fail("the text holds no equation", None)
            if len(found) == EQUATIONS:
                self.fail(f"more than the {EQUATIONS} equations allowed")
            found.append(self.equation())

    def equation(self):
        """(left, right)"""
        left = self.scalar(self.sum())
        if not self.at("="):
            self.fail("expected '=' or an operator")
        self.take()
        right = self.scalar(self.sum())
        if self.at("="):
            self.fail("an equation has one '='; separate equations by ';'")
        if not self.at(";", "\n", ",") and self.token.kind != "end":
            self.unexpected()
        return left, right

    def expression(self):
        """One node for the whole text, which has no "="."""
        node = self.scalar(self.sum())
        if self.token.kind != "end":
            self.unexpected()
        return node

    def unexpected(self):
        """Fail at what follows an expression that is whole."""
        if self.token.kind in ("subscript", "script"):
            self.fail("a subscript, or a power, of what? write (u^2)_x, or u_x^2 for (u_x)^2")
        closing = self.at(")", "]", "}", "|")
        self.fail(f"unexpected {self.token.value!r}" if closing else "expected an operator, as in 2*u")

    def sum(self):
        """A node or a vector."""
        self.depth += 1  # which the first sign or operand looks at
        place, terms = self.token.place, [("+", 0, self.product())]
        while self.at("+", "-"):
            sign = self.take()
            terms.append((sign.value, sign.place, self.product()))
        self.depth -= 1
        return self.vectors(place, added, terms, place)

    def product(self):
        """A node or a vector."""
        place, factors = self.token.place, [("*", 0, self.signed())]
        divided = None  # the place of a division by what has no bracket around it, a name
        while True:
            if self.at("*", "/", "·"):
                sign = self.take()
                kind = "/" if sign.value == "/" else "*"
                begin = self.next
                factors.append((kind, sign.place, self.signed()))
                divided = sign.place if kind == "/" and not self.is_plain_half(begin) else None
            elif self.begins_operand():
                self.check_product(divided)
                factors.append(("*", self.token.place, self.power()))
            else:
                return self.vectors(place, multiplied, factors, place)

    def is_plain_half(self, begin):
        """Whether the division that ends here is of number by number with a blank behind it, as in 1/2 u_xx."""
        before, number = self.tokens[begin - 2], self.tokens[begin]
        both = before.kind == number.kind == "number" and self.next == begin + 1
        return both and self.token.place > number.end

    def check_product(self, divided):
        """Fail where a product without a sign is no product, or could be read in two ways."""
        token = self.token
        if token.kind == "number" or self.new_line_before():
            self.fail("expected an operator, as in 2*u")
        if divided is not None and not self.at("∂", "∇", "Δ", "frac"):
            self.fail("a/b c could be (a/b)*c or a/(b*c): write one of these", divided)

    def begins_operand(self):
        """Whether the next token begins a factor."""
        if self.token.kind in ("number", "name"):
            return True
        return self.at("(", "[", "{", "∂", "∇", "Δ", "√", "frac", "dot") or (self.at("|") and self.open[-1:] != ["|"])

    def signed(self):
        """A factor with its signs."""
        self.depth += 1
        if self.depth > DEPTH:
            self.fail(f"brackets and signs are nested more than the {DEPTH} levels allowed")
        if self.at("+", "-"):
            sign, value = self.take(), self.signed()
            if sign.value == "-":
                value = (
                    Vector(minus(n, sign.place) for n in value)
                    if isinstance(value, Vector)
                    else minus(value, sign.place)
                )
        else:
            value = self.power()
        self.depth -= 1
        return value

    def power(self):
        """A factor without a sign."""
        begin = self.token
        base = operands.primary(self)
        if not self.at("^") and self.token.kind != "script":
            return base
        exponential = begin.kind == "name" and begin.value[:2] == ("e", ()) and "e" not in self.variables.plain
        if self.token.kind == "script":
            place, exponent = self.token.place, operands.script(self)
            if self.at("^"):
                self.fail("a power of a power needs a bracket")
        else:
            place = self.take().place
            exponent = self.scalar(self.signed())
        if self.token.kind == "subscript":
            self.unexpected()
        if exponential:
            if (
                self.begins_operand()
                and not self.at("|", "∂", "∇", "Δ", "frac")
                and self.tokens[self.next - 1].value not in list(")}]")
            ):
                self.fail("e^a b could be exp(a)*b or exp(a*b): write one of these", begin.place)
            return Node("call", begin.place, "exp", (exponent,))
        if isinstance(base, Vector):
            if exponent.kind == "number" and exponent.value == ("2", False):
                return squared(base, place)
            self.fail("a power of a vector other than its square", place)
        return Node("^", place, operands=(base, exponent))

    def bracket(self):
        """What is between brackets, and the place of the first."""
        opened = self.take()
        closing = _CLOSING[opened.value]
        self.open.append(opened.value)
        inside = self.sum()
        if not self.at(closing):
            self.fail(f"expected '{closing}' to close this bracket", opened.place)
        self.take()
        self.open.pop()
        return inside
