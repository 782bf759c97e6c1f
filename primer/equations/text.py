"""Equations as text: a recursive-descent parser. Nothing is evaluated or executed here; the result is a plain tree.

Grammar, blanks aside::

    equations  = equation { (";" | new line) equation }
    equation   = sum "=" sum
    sum        = product { ("+" | "-") product }
    product    = signed { ("*" | "/") signed }
    signed     = ("+" | "-") signed | power
    power      = primary [ ("^" | "**") signed ]
    primary    = number | name | [ function ] "(" sum ")" [ derivatives ]

A line without a left side and "=" of its own continues the one before. A name's subscript of the letters x, y, t
differentiates: u_t, v_xx, u_xyt; so does one after a bracket, the "derivatives" of the grammar: (h*u)_x.
"""

import re
import unicodedata
from dataclasses import dataclass

from primer.equations.error import PDEError

FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "sqrt", "sinh", "cosh", "tanh", "abs")
LENGTH, TOKENS, DEPTH, EQUATIONS, NAME = 4000, 600, 80, 6, 40  # far beyond what a person would write by hand

_TOKEN = re.compile(
    r"""[ \t\r]*(?:
    (?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?P<imaginary>[ij](?!\w))?
  | (?P<name>[^\W\d_]\w*)
  | (?P<subscript>_[xyt]+(?!\w))
  | (?P<operator>\*\*|[-+*/^=();\n]))""",
    re.VERBOSE,
)
_SPOKEN = str.maketrans({"−": "-", "·": "*", "×": "*"})


@dataclass(frozen=True)
class Node:
    """One node of the tree: what it is, its operands, and its place in the text.

    kind is "number" (value: the digits, and whether i follows), "name" (the name), "+", "*" (any number of operands),
    "-" (sign), "/" , "^", "call" (value: the function) or "derivative" (value: the letters).
    """

    kind: str
    place: int
    value: object = None
    operands: tuple = ()


def parse(text):
    """The equations of ``text`` as a list of pairs (left, right) of nodes.

    Raises PDEError, with the text and a caret under the place where it goes wrong.
    """
    return _parser("the equations", "u_t = u_xx", text).equations()


def parse_expression(text):
    """The node of an expression such as "a - cos(x)", which has no "="; otherwise as :func:`parse`."""
    parser = _parser("an expression", "a - cos(x)", text)
    node = parser.sum()
    if parser.tokens[parser.next][0] != "end":
        parser.fail("expected an operator, as in 2*u" if parser._is_operand() else "the expression should end here")
    return node


def _parser(what, example, text):
    if not isinstance(text, str):
        raise TypeError(f"{what} must be a string such as {example!r}, got {type(text).__name__}")
    if len(text) > LENGTH:
        raise PDEError(f"the text has {len(text)} characters, more than the {LENGTH} allowed")
    return _Parser(text, list(_tokens(text.translate(_SPOKEN))))


def canonical(name):
    """The one form of a name that has several: in a keyword Python, too, takes the micro sign for the Greek mu."""
    return unicodedata.normalize("NFKC", name)


def split_name(name):
    """("v", "xx") for "v_xx"; ("eps", "") for a name without a subscript of the letters x, y, t."""
    base, _, subscript = name.rpartition("_")
    return (base, subscript) if base and re.fullmatch("[xyt]+", subscript) else (name, "")


def _tokens(text):
    place = depth = count = 0
    while match := _TOKEN.match(text, place):
        kind = match.lastgroup or ""  # which no match is without
        value = match[kind]
        if kind == "imaginary":
            kind, value = "number", match["number"]
        if kind == "name" and not value.isidentifier():
            odd = next(n for n, _ in enumerate(value) if not value[: n + 1].isidentifier())
            raise PDEError(f"unexpected character {value[odd]!r}", text, match.start("name") + odd)
        if kind == "name" and ("__" in value or value.endswith("_")):
            raise PDEError("a name with two underscores together, or with one at its end", text, match.start("name"))
        if kind == "name":
            value = canonical(value)
        if kind == "name" and len(value) > NAME:
            raise PDEError(f"a name longer than the {NAME} characters allowed", text, match.start("name"))
        start, place, count = match.start(kind), match.end(), count + 1
        depth += (value == "(") - (value == ")")
        if count > TOKENS:
            raise PDEError(f"the text has more than the {TOKENS} symbols allowed", text, start)
        if value != "\n" or (depth <= 0 and _begins_equation(text, place)):
            yield kind, value, start, bool(match["imaginary"])
    rest = text[place:].lstrip(" \t\r")
    if rest:
        start = len(text) - len(rest)
        raise PDEError(f"unexpected character {rest[0]!r}", text, start)
    yield "end", "", len(text), False


def _begins_equation(text, place):
    """Whether the line that starts here is not the continuation of the one before: it has its own left side."""
    left, equals, _ = re.split("[;\n]", text[place:])[0].partition("=")
    return bool(equals and left.strip(" \t\r"))


class _Parser:
    def __init__(self, text, tokens):
        self.text, self.tokens, self.next, self.depth = text, tokens, 0, 0

    def fail(self, problem, place=None):
        raise PDEError(problem, self.text, self.tokens[self.next][2] if place is None else place)

    def at(self, *values):
        kind, value, _, _ = self.tokens[self.next]
        return kind == "operator" and value in values

    def take(self):
        token = self.tokens[self.next]
        self.next += 1
        return token

    def equations(self):
        found: list[tuple] = []
        while True:
            while self.at(";", "\n"):
                self.take()
            if self.tokens[self.next][0] == "end":
                break
            if len(found) == EQUATIONS:
                self.fail(f"more than the {EQUATIONS} equations allowed")
            found.append(self.equation())
        if not found:
            raise PDEError("the text holds no equation")
        return found

    def equation(self):
        left = self.sum()
        if not self.at("="):
            self.fail("expected '=' or an operator" if not self._is_operand() else "expected an operator, as in 2*u")
        self.take()
        right = self.sum()
        if self.at("="):
            self.fail("an equation has one '='; separate equations by ';'")
        if not self.at(";", "\n") and self.tokens[self.next][0] != "end":
            self.fail("expected an operator, as in 2*u" if self._is_operand() else "unexpected ')'")
        return left, right

    def _is_operand(self):
        return self.tokens[self.next][0] in ("number", "name") or self.at("(")

    def sum(self):
        self.depth += 1  # which the first sign or operand looks at
        place, terms = self.tokens[self.next][2], [self.product()]
        while self.at("+", "-"):
            _, sign, at, _ = self.take()
            term = self.product()
            terms.append(Node("-", at, operands=(term,)) if sign == "-" else term)
        self.depth -= 1
        return terms[0] if len(terms) == 1 else Node("+", place, operands=tuple(terms))

    def product(self):
        place, factors = self.tokens[self.next][2], [self.signed()]
        while self.at("*", "/"):
            _, sign, at, _ = self.take()
            factor = self.signed()
            factors.append(Node("/", at, operands=(factor,)) if sign == "/" else factor)
        return factors[0] if len(factors) == 1 else Node("*", place, operands=tuple(factors))

    def signed(self):
        self.depth += 1
        if self.depth > DEPTH:
            self.fail(f"brackets and signs are nested more than the {DEPTH} levels allowed")
        if self.at("+", "-"):
            _, sign, at, _ = self.take()
            operand = self.signed()
            node = Node("-", at, operands=(operand,)) if sign == "-" else operand
        else:
            node = self.primary()
            if self.at("^", "**"):
                _, _, at, _ = self.take()
                node = Node("^", at, operands=(node, self.signed()))
        self.depth -= 1
        return node

    def primary(self):
        kind, value, place, imaginary = self.take()
        if kind == "number":
            return Node("number", place, (value, imaginary))
        if kind == "name":
            if not self.at("("):
                return Node("name", place, value)
            if value not in FUNCTIONS:
                known = ", ".join(FUNCTIONS)
                self.fail(f"{_short(value)} is not a known function ({known}); a product is written with '*'", place)
            opened = self.take()[2]
            return self.differentiated(Node("call", place, value, (self.bracket(opened),)))
        if kind == "operator" and value == "(":
            return self.differentiated(self.bracket(place))
        self.next -= 1
        return self.fail("expected a number, a name or '('" if kind != "subscript" else "a subscript needs a name")

    def bracket(self, opened):
        inside = self.sum()
        if not self.at(")"):
            self.fail("expected ')' to close this bracket", opened)
        self.take()
        return inside

    def differentiated(self, node):
        if self.tokens[self.next][0] != "subscript":
            return node
        _, letters, place, _ = self.take()
        return Node("derivative", place, letters[1:], (node,))


def _short(name):
    return repr(name if len(name) <= 30 else name[:27] + "...")
