"""Guards the parser alone: its tokens and trees with their places, whole messages, and limits at their very edge.

Second route to the trees: a random writer that knows the tree and every place while it writes the text.
"""

import random
import re

import pytest

from primer.equations.error import marked as _marked
from primer.equations.text import FUNCTIONS, PDEError, parse, split_name
from primer.equations.text import Node as N
from primer.equations.tokens import tokens
from primer.equations.variables import variables


class Writer:
    """Writes random expressions of the grammar; each method adds text and returns the node that it must become."""

    def __init__(self, rng):
        self.rng, self.text = rng, ""

    def put(self, token):
        """Add blanks and a token; its place."""
        self.text += self.rng.choice(("", "", " ", "\t", "  \r"))
        place = len(self.text)
        self.text += token
        return place

    def chain(self, part, depth, signs):
        """Some of ``part``, joined by the two signs; the second of them is a node of its own."""
        node = part(depth)
        if self.rng.random() < 0.6:
            return node
        first, parts, (whole, inverse) = self.first, [node], signs
        for sign in self.rng.choices(signs, k=self.rng.randint(1, 2)):
            at = self.put(sign)
            node = part(depth)
            parts.append(N(inverse, at, operands=(node,)) if sign == inverse else node)
        self.first = first
        return N(whole, first, operands=tuple(parts))

    def sum(self, depth):
        return self.chain(self.product, depth, "+-")

    def product(self, depth):
        return self.chain(self.signed, depth, "*/")

    def signed(self, depth):
        if depth and self.rng.random() < 0.2:
            sign = self.rng.choice("+-")
            at = self.put(sign)
            node = self.signed(depth - 1)
            self.first = at
            return N("-", at, operands=(node,)) if sign == "-" else node
        node = self.primary(depth)
        if depth and self.rng.random() < 0.2:
            first, at = self.first, self.put(self.rng.choice(("^", "**")))
            node = N("^", at, operands=(node, self.signed(depth - 1)))
            self.first = first
        return node

    def primary(self, depth):
        """``first`` is the place where the expression just written begins."""
        kind = self.rng.choice(("number", "name", "bracket", "call") if depth else ("number", "name"))
        if kind == "number":
            digits = self.rng.choice(("2", "0.5", ".5", "3.", "1e-3", "25E+1", "7e2"))
            imaginary = self.rng.choice(("", "", "i", "j"))
            self.first = self.put(digits + imaginary)
            return N("number", self.first, (digits, bool(imaginary)))
        if kind == "name":
            name = self.rng.choice(("u", "v_xx", "phi_1_t", "ε", "x", "pi"))
            self.first = self.put(name)
            return N("name", self.first, name.replace("ε", "epsilon"))
        function = self.rng.choice(FUNCTIONS)
        first = self.put(function if kind == "call" else "(")
        if kind == "call":
            self.put("(")
        node = self.sum(depth - 1)
        self.put(")")
        if kind == "call":
            node = N("call", first, function, (node,))
        if self.rng.random() < 0.3:
            letters = self.rng.choice(("x", "ty", "xx"))
            node = N("derivative", self.put("_" + letters), letters, (node,))
        self.first = first
        return node


def test_every_text_becomes_the_tree_that_was_meant_with_every_place():
    rng = random.Random(0)
    for _ in range(400):
        writer, expected = Writer(rng), []
        for n in range(rng.randint(1, 3)):
            writer.text += rng.choice((";", "\n", ";\n; ")) if n else ""
            left = writer.sum(1)
            writer.put("=")
            expected.append((left, writer.sum(3)))
        assert parse(writer.text) == expected, writer.text


def test_tokens():
    text = "u_t=1.5e2i**(3. \n-x_yz)_xy ; \nv_t = ε\n"
    known = variables()
    assert [token[:3] for token in tokens(text, known)] == [
        ("name", ("u", ("t",), "u_t", False), 0),
        ("operator", "=", 3),
        ("number", ("1.5e2", True), 4),
        ("operator", "^", 10),
        ("operator", "(", 12),
        ("number", ("3.", False), 13),
        ("operator", "-", 17),
        ("name", ("x", ("y", "z"), "x_yz", False), 18),
        ("operator", ")", 22),
        ("subscript", (("x", "y"), "_xy"), 23),
        ("operator", ";", 27),
        ("operator", "\n", 29),
        ("name", ("v", ("t",), "v_t", False), 30),
        ("operator", "=", 34),
        ("name", ("epsilon", (), "ε", False), 36),
        ("end", "", 38),
    ]
    assert [token.kind for token in tokens("", known)] == ["end"]
    assert tokens("2i_x", known)[0].value == ("2", False)  # no i of its own


@pytest.mark.parametrize(
    ("text", "equations"),
    [
        ("a_t = b\n + c\n c_t = b", 2),  # a line that goes on, and one with a left side
        ("a_t = b;\n\n;c_t = b;", 2),
        ("a_t\n = b", 1),
        ("a_t = (b\n+ c)\nb_t = c", 2),
        ("a_t = b +\nc; b_t = c", 2),
        ("a_t = b +\nc\nb_t = c", 2),
        ("(a\n)_t = b\n(b)_t = c", 2),
        ("\na_t = b", 1),
    ],
)
def test_where_a_line_begins_an_equation(text, equations):
    assert len(parse(text)) == equations


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("v_xx", ("v", "xx")),
        ("v_xyt", ("v", "xyt")),
        ("eps", ("eps", "")),
        ("phi_1", ("phi_1", "")),
        ("phi_1_t", ("phi_1", "t")),
        ("u_xa", ("u_xa", "")),
        ("u_ax", ("u_ax", "")),
        ("_xx", ("_xx", "")),
        ("xx", ("xx", "")),
        ("u_", ("u_", "")),
        ("u_x_t", ("u_x", "t")),
    ],
)
def test_the_parts_of_a_name(name, parts):
    assert split_name(name) == parts


UNKNOWN = f" is not a known function ({', '.join(FUNCTIONS)}): one of your own must be given, "
UNKNOWN += "{0}='u^2' or {0}=lambda u: u**2; "
UNKNOWN += "a product is written with '*', {0}*(u)"
OPERAND = "expected a number, a name or '('"
PRODUCT = "expected an operator, as in 2*u"
NESTED = "brackets and signs are nested more than the 80 levels allowed"


@pytest.mark.parametrize(
    ("text", "problem", "place"),
    [
        ("u_t = u_xx +", OPERAND, 12),
        ("u_t = * u", OPERAND, 6),
        ("= u", OPERAND, 0),
        ("u_t = ; v_t = u", OPERAND, 6),
        ("u_t = ()", OPERAND, 7),
        ("u_t = 2*_x", "a subscript needs a name", 8),
        ("u_t = u 2", PRODUCT, 8),
        ("u_t = u\n2", PRODUCT, 8),
        ("u_t 2 = u", PRODUCT, 4),
        ("u_t", "expected '=' or an operator", 3),
        ("u_t )", "expected '=' or an operator", 4),
        ("u_t = u)", "unexpected ')'", 7),
        ("u_t = u\n = 3", "an equation has one '='; separate equations by ';'", 9),  # no left side: the line goes on
        ("u_t = u = 3", "an equation has one '='; separate equations by ';'", 8),
        ("u_t = 2*(u + (v)", "expected ')' to close this bracket", 8),
        ("u_t = sin (u; v_t = u", "expected ')' to close this bracket", 10),
        ("u_t = 2*foo(u)", "'foo'" + UNKNOWN.format("foo"), 8),
        (f"u_t = {'f' * 30}(u)", f"'{'f' * 30}'" + UNKNOWN.format("f" * 30), 6),
        (f"u_t = {'f' * 27}ghij(u)", f"'{'f' * 27}...'" + UNKNOWN.format("f" * 27 + "..."), 6),
        ("u_t = u @ 2", "unexpected character '@'", 8),
        ("u_t = u  \t@", "unexpected character '@'", 10),
        ("@", "unexpected character '@'", 0),
        ("u_t = u⁺", "a superscript is a number, or n", 7),
        ("u_t = u²^3", "a power of a power needs a bracket", 8),
        ("u_t = u^2_x", "a subscript, or a power, of what? write (u^2)_x, or u_x^2 for (u_x)^2", 9),
        ("u_t = 2*\u037a", "unexpected character '\u037a'", 8),  # a letter that is no identifier
        ("u_t = _x", "a subscript needs a name", 6),
        ("u_t = a__b", "a name with two underscores together, or with one at its end", 6),
        ("u_t = 2*a_", "a name with two underscores together, or with one at its end", 8),
        (f"u_t = 2*{'a' * 41}", "a name longer than the 40 characters allowed", 8),
        ("u_t = " + "(" * 40 + "u" + ")" * 40, NESTED, 46),
        ("u_t = " + "sin(" * 40 + "u" + ")" * 40, NESTED, 166),
        ("u_t = " + "-" * 79 + "u", NESTED, 85),
        ("u_t = " + "2^" * 79 + "u", NESTED, 164),
        ("u_t = (u)*-u*(u)" + "*" + "(" * 40 + "u" + ")" * 40, NESTED, 57),  # what is closed does not count
        ("; ".join(f"{c}_t = {c}" for c in "abcdfghklmn"), "more than the 10 equations allowed", 90),
        ("u_t = -u" + "+u" * 448 + "*u", "the text has more than the 900 symbols allowed", 904),
    ],
)
def test_errors_in_full(text, problem, place):
    with pytest.raises(PDEError) as caught:
        parse(text)
    said, line, caret = str(caught.value).split("\n")
    begin = text.rfind("\n", 0, place) + 1
    left = max(begin, place - 50)
    assert said == problem
    assert line == "    " + text[left : left + 80].replace("\t", " ")
    assert caret == " " * (4 + place - left) + "^"


def test_the_line_and_the_window_that_are_shown():
    """80 characters from at most 50 before the place, of its line alone; what cannot be printed is a blank."""
    assert _marked("ab\ncde\nfgh", 4) == "    cde\n     ^"
    assert _marked("ab\ncde\nfgh", 3) == "    cde\n    ^"
    assert _marked("ab\ncde\nfgh", 1) == "    ab\n     ^"
    assert _marked("\nab", 1) == "    ab\n    ^"
    assert _marked("ab\n", 2) == "    ab\n      ^"
    assert _marked("a\0\tb", 3) == "    a  b\n       ^"
    line = "".join(chr(33 + n % 90) for n in range(200))
    for place in range(200):
        left = 0 if place <= 50 else place - 50
        assert _marked(line, place) == f"    {line[left : left + 80]}\n{' ' * (4 + place - left)}^"


def test_an_error_without_a_place_is_one_sentence():
    for text in ("", " \t\n;", ";;"):
        with pytest.raises(PDEError, match=r"^the text holds no equation$"):
            parse(text)
    with pytest.raises(PDEError, match=r"^the text has 8001 characters, more than the 8000 allowed$"):
        parse("u_t = u".ljust(8001))
    with pytest.raises(
        TypeError, match=re.escape("such as 'u_t = u_xx', a list of them or of sympy's Eq, got int") + "$"
    ):
        parse(3)
    assert str(PDEError("a problem", "a text")) == "a problem"
    assert str(PDEError("a problem", "a text", 0)) == "a problem\n    a text\n    ^"


@pytest.mark.parametrize(
    "text",
    [
        "u_t = u".ljust(8000),
        "u_t = -u" + "+u" * 448,  # 900 symbols
        f"u_t = {'a' * 40}",
        "u_t = " + "(" * 39 + "u" + ")" * 39,
        "u_t = " + "-" * 78 + "u",
        "u_t = " + "*".join(["(-u)"] * 99),
        "; ".join(f"{c}_t = {c}" for c in "abcdfghklm") + ";\n",
    ],
)
def test_what_just_fits_is_taken(text):
    assert parse(text)
