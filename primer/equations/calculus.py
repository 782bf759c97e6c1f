"""The lower half of the parser: names, brackets, functions, and the many ways to write a derivative.

An operator such as ∂_x, Δ, grad or d/dx takes the name or the bracket behind it and nothing more.
"""

import re

from primer.equations import functions, vectors
from primer.equations.functions import COMPOSED, FUNCTIONS, OTHER_NAMES
from primer.equations.error import PDEError, ask
from primer.equations.tree import Node
from primer.equations.vectors import Vector

_LAP, _ORDER = ("lap", "laplacian", "bilap"), 12


class Calculus:
    """What the parser does with one operand."""

    def __init__(self, text, tokens, variables, given=None):
        self.text, self.tokens, self.variables = text, tokens, variables
        self.given = {} if given is None else given  # the functions that a reader brings along
        self.next = self.depth = 0
        self.open: list[str] = []

    # ------------------------------------------------------------ tokens

    @property
    def token(self):
        """The next one."""
        return self.tokens[self.next]

    def fail(self, problem, place=-1):
        """Raise the error, at the next token unless another place, or none, is given."""
        raise PDEError(problem, self.text, self.token.place if place == -1 else place)

    def at(self, *values):
        """Whether the next token is one of these operators."""
        return self.token.kind == "operator" and self.token.value in values

    def take(self):
        """The next token, which is left behind."""
        self.next += 1
        return self.tokens[self.next - 1]

    def new_line_before(self):
        """Whether the next token begins a line."""
        return "\n" in self.text[self.tokens[self.next - 1].end : self.token.place]

    def scalar(self, value):
        """The node, which must not be a vector."""
        if isinstance(value, Vector):
            if len(value) > 1:
                self.fail("a vector where a scalar is needed: div(...) and a dot product make one", value[0].place)
            return value[0]
        return value

    def vectors(self, place, make, *arguments):
        """make(*arguments), its complaint with the place."""
        try:
            return make(*arguments)
        except PDEError:
            raise
        except ValueError as error:
            return self.fail(str(error), place)

    # ------------------------------------------------------------ operands

    def primary(self):
        """A number, a name, a bracket, a call, or an operator with what it works on."""
        token = self.token
        if token.kind == "number":
            digits, imaginary = self.take().value
            if imaginary and "i" in self.variables.plain:
                self.fail(f"{digits}i: i is a name here, so that a product is written {digits}*i", token.place)
            return Node("number", token.place, (digits, imaginary))
        if token.kind == "name":
            return self.named()
        if self.at("(", "[", "{"):
            return self.differentiated(self.bracket())
        if self.at("|"):
            return self.differentiated(self.bars())
        if self.at("frac"):
            return self.fraction()
        if self.at("√"):
            return self.root()
        if self.at("∂", "∇", "Δ", "dot"):
            return self.operated()
        if token.kind == "subscript":
            self.fail("a subscript needs a name")
        return self.fail("expected a number, a name or '('")

    def name(self, base, by, place, spelling=None):
        """The node of a name."""
        return Node("name", place, self.variables.inside(base, by, spelling))

    def named(self):
        """A name, or a call."""
        token = self.take()
        base, by, spelling, latex = token.value
        spelling = base if latex else spelling
        name = OTHER_NAMES.get(base, base) if not by else ""
        function = name in FUNCTIONS or name in COMPOSED
        if (function and self.at("^")) or (function and self.token.kind == "script"):
            return self.power_of_a_function(name, token)
        if not self.at("("):
            if function and self.begins_operand() and not self.new_line_before():
                return self.without_bracket(name, token, latex)
            if base in self.given:
                node = self.given.node(base, None, token.place, self)
                return Node("derivative", token.place, self.letters(by, token.place), (node,)) if by else node
            return self.name(base, by, token.place, spelling)
        if function:
            return self.differentiated(self.call(name, token.place))
        if not by and base in (*_LAP, "grad", "div", "dot"):
            return self.differentiated(self.vector_call(base, token.place))
        if not by and base[0] == "d" and (letters := self.variables.derivatives(base[1:])):
            operand = self.scalar(self.bracket())
            return self.differentiated(vectors.derived(operand, self.letters(letters, token.place), token.place))
        if not by and base in self.given:
            return self.differentiated(self.given.node(base, self.arguments(), token.place, self))
        return self.ambiguous_call(token)

    def ambiguous_call(self, token):
        """Fail at u(x) and f(u): a function or a product?"""
        base, by, spelling, _ = token.value
        begin = self.next
        inside = self.arguments() if self.at("(") else []
        arguments = self.text[self.tokens[begin].end : self.tokens[self.next - 1].place].strip()
        arguments = arguments if len(arguments) <= 20 else "..."
        short = spelling if len(spelling) <= 30 else spelling[:27] + "..."
        if (
            by
            or base in self.variables.evolved
            or (inside and all(n.kind == "name" and n.value in "xyzt" for n in inside))
        ):
            function = (
                f"as an unknown it is written {short} alone, for unknowns depend on all variables; "
                f"as a function, it must be given, {ask('function', short, arguments or 'x')}"
            )
            self.fail(
                f"{short}({arguments}) can be read in two ways: {function}; as a product it is written {short}*({arguments})",
                token.place,
            )
        known = ", ".join(FUNCTIONS)
        self.fail(
            f"{short!r} is not a known function ({known}): one of your own must be given, {ask('function', short, 'u')}; "
            f"a product is written with '*', {short}*({arguments})",
            token.place,
        )

    def call(self, name, place):
        """A function of the language with its operands in brackets."""
        least, most = functions.arity(name)
        operands = self.arguments()
        if not least <= len(operands) <= most:
            self.fail(f"{name} takes {least if least == most else 'two or more'}, got {len(operands)}", place)
        return functions.called(name, operands, place)

    def arguments(self):
        """The nodes between brackets, parted by commas."""
        opened = self.take()
        self.open.append("(")
        found = [self.scalar(self.sum())]
        while self.at(","):
            self.take()
            found.append(self.scalar(self.sum()))
        if not self.at(")"):
            self.fail("expected ')' to close this bracket", opened.place)
        self.take()
        self.open.pop()
        return found

    def power_of_a_function(self, name, token):
        r"""sin^2(x), \sin^2 x: a whole power of 2 or more; what sin^-1 would be, nobody knows."""
        exponent = self.script() if self.token.kind == "script" else (self.take(), self.primary())[1]
        whole = exponent.kind == "number" and re.fullmatch(r"[2-9]|\d\d+", exponent.value[0]) and not exponent.value[1]
        if not whole or not self.at("("):
            self.fail(
                f"a power of {name} is written {name}(u)^2; 1/{name}(u) and a{name}(u) are two things", token.place
            )
        return Node("^", exponent.place, operands=(self.call(name, token.place), exponent))

    def without_bracket(self, name, token, latex):
        r"""\sin x of one name, where nothing follows that might belong to it."""
        inside = self.token
        if latex and (self.at("{") or inside.kind in ("name", "number")):
            operand = self.scalar(self.bracket() if self.at("{") else self.primary())
            if inside.value == "{" or not (
                self.begins_operand() or self.at("*", "·", "/", "^") or self.token.kind == "script"
            ):
                return functions.called(name, [operand], token.place)
        return self.fail(f"what {name} is of goes into brackets, as in {name}(u)", token.place)

    def bars(self):
        """|...|"""
        opened = self.take()
        self.depth += 1
        self.open.append("|")
        inside = self.sum()
        if not self.at("|"):
            self.fail("expected '|' to close this one", opened.place)
        self.take()
        self.open.pop()
        self.depth -= 1
        return self.absolute(inside, opened.place)

    def absolute(self, inside, place):
        """|u|, or the length of a vector."""
        if isinstance(inside, Vector):
            return vectors.length(inside, place)
        return Node("call", place, "abs", (inside,))

    def script(self):
        """The node of a superscript: a number with a sign, or a letter."""
        token = self.take()
        text = token.value.translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿ", "0123456789+-n"))
        match = re.fullmatch(r"([+-]?)(\d+|n)", text)
        if not match:
            self.fail("a superscript is a number, or n", token.place)
        node = functions.number(match[2], token.place) if match[2] != "n" else self.name("n", (), token.place, "n")
        return functions.minus(node, token.place) if match[1] == "-" else node

    def fraction(self):
        r"""\frac{a}{b}, a derivative if there is a ∂, or a d, in both."""
        place = self.take().place
        if self.token.kind == "number" and re.fullmatch(r"\d\d", self.token.value[0]):  # \frac12
            above, below = (functions.number(digit, place) for digit in self.take().value[0])
            return functions.over(above, below, place)
        if not self.at("{"):
            self.fail(r"\frac is written \frac{a}{b}", place)
        if self.tokens[self.next + 1].value == "∂" and self.tokens[self.next + 2].kind != "subscript":
            self.take(), self.take()
            order = self.partial_order()
            operand = None if self.at("}") else self.scalar(self.sum())
            self.closed(place)
            if not self.at("{"):
                self.fail(r"\frac is written \frac{a}{b}", place)
            self.take()
            letters = self.below(order, place)
            self.closed(place)
            if operand is None:
                return self.applied(lambda node: vectors.derived(self.scalar(node), letters, place), place)
            return vectors.derived(operand, letters, place)
        above = self.bracket()
        if not self.at("{"):
            self.fail(r"\frac is written \frac{a}{b}", place)
        below = self.bracket()
        return self.vectors(place, vectors.multiplied, [("*", place, above), ("/", place, below)], place)

    def closed(self, place):
        """Leave a closing brace behind."""
        if not self.at("}"):
            self.fail("expected '}' to close this", place)
        self.take()

    def root(self):
        """√ with a bracket or a name; \\sqrt[3]{u} is a power."""
        place = self.take().place
        power = None
        if self.at("["):
            power = self.scalar(self.bracket())
        if not (self.at("(", "{") or self.token.kind in ("name", "number")):
            self.fail("what the root is of goes into brackets, as in sqrt(u)")
        inside = self.scalar(self.bracket() if self.at("(", "{") else self.primary())
        if power is None:
            return self.differentiated(Node("call", place, "sqrt", (inside,)))
        return Node("^", place, operands=(inside, functions.over(functions.number(1, place), power, place)))

    def differentiated(self, node):
        """The node, or its derivative if subscripts follow."""
        while self.token.kind == "subscript":
            by, written = self.token.value
            if by is None:
                self.fail(f"a bracket is differentiated by {self.spoken_variables()}, not by {written[1:]}")
            node = self.scalar(node)
            token = self.take()
            letters = self.letters(by, token.place)
            if node.kind == "derivative" and self.tokens[self.next - 2].kind == "subscript":
                node = Node("derivative", node.place, node.value + letters, node.operands)
            else:
                node = Node("derivative", token.place, letters, (node,))
        return node

    def spoken_variables(self):
        """x, y and t, as the text calls them."""
        *space, time = (*self.variables.space, self.variables.time)
        return f"{', '.join(space)} and {time}"

    def letters(self, by, place):
        """The letters inside of variables."""
        return "".join(self.variables.inner[name] for name in by)

    # ------------------------------------------------------------ operators

    def operated(self):
        """∂_x, ∂/∂x, ∂u/∂x, Δ, ∇, ∇², ∇·, and a dot, with what they work on."""
        sign = self.take()
        place, dim = sign.place, self.variables.dim
        if sign.value == "Δ":
            times = self.even_order(1, place)
            return self.applied(lambda node: vectors.laplacian(self.scalar(node), dim, place, times), place)
        if sign.value == "dot":
            return vectors.derived(self.scalar(self.bracket() if self.at("{") else self.primary()), "t", place)
        if sign.value == "∂":
            return self.partial(place)
        if self.at("·", "*"):
            self.take()
            return self.applied(lambda v: self.vectors(place, vectors.divergence, v, dim, place), place)
        if self.at("^") or self.token.kind == "script":
            times = self.even_order(2, place)
            return self.applied(lambda node: vectors.laplacian(self.scalar(node), dim, place, times), place)
        return self.applied(lambda node: vectors.gradient(self.scalar(node), dim, place), place)

    def even_order(self, unit, place):
        """How many Laplacians ∇^4 (of unit 2) or Δ^2 (of unit 1) are."""
        order = self.partial_order() or unit
        if order % unit or not 1 <= order // unit <= vectors.LAPLACIANS:
            self.fail("a power of this operator that is not understood", place)
        return order // unit

    def partial_order(self):
        """The order that may follow ∂ or a variable below it; 0 if none does."""
        if self.token.kind == "script":
            node = self.script()
        elif self.at("^"):
            self.take()
            node = self.bracket() if self.at("{", "(") else self.primary()
        elif self.token.kind == "number" and self.tokens[self.next - 1].end == self.token.place:
            node = self.primary()
        else:
            return 0
        if (
            isinstance(node, Vector)
            or node.kind != "number"
            or not re.fullmatch(r"\d\d?", node.value[0])
            or node.value[1]
        ):
            self.fail("the order of a derivative is a number", self.tokens[self.next - 1].place)
        return int(node.value[0])

    def partial(self, place):
        """After a ∂."""
        order = self.partial_order()
        if self.token.kind == "subscript":
            by, written = self.take().value
            if by is None:
                self.fail(f"∂ goes by {self.spoken_variables()}, not by {written[1:]}", place)
            more = self.partial_order()
            letters = self.ordered(self.letters(by, place), order or more, place)
            return self.applied(lambda node: vectors.derived(self.scalar(node), letters, place), place)
        if self.at("/"):
            self.take()
            letters = self.below(order, place)
            return self.applied(lambda node: vectors.derived(self.scalar(node), letters, place), place)
        if not self.begins_operand():
            self.fail("∂ is written ∂_x u, ∂u/∂x or ∂/∂x (u)", place)
        factors = [("*", place, self.power())]
        while self.begins_operand():
            factors.append(("*", place, self.power()))
        operand = self.scalar(self.vectors(place, vectors.multiplied, factors, factors[0][2].place))
        if not (self.at("/") and self.tokens[self.next + 1].value in ("∂", "(")):
            self.fail("∂u must stand over something, as in ∂u/∂x", place)
        self.take()
        return vectors.derived(operand, self.below(order, place), place)

    def ordered(self, letters, order, place):
        """The letters of ∂^2_x; one letter is repeated."""
        if order and len(letters) == 1:
            letters *= min(order, _ORDER + 1)
        elif order and order != len(letters):
            self.fail(f"a derivative of order {order} by {len(letters)} variables", place)
        return letters

    def below(self, order, place):
        """The letters of what stands below: ∂x, ∂x^2, ∂x∂y."""
        bracket = self.at("(")
        if bracket:
            self.take()
        letters = ""
        while self.at("∂"):
            self.take()
            if self.token.kind != "name":
                self.fail("∂ below a fraction bar takes a variable, as in ∂x")
            base, by, spelling, _ = self.take().value
            match = re.fullmatch(r"(.+?)(\d?)", base)
            if not by and base in self.variables.inner:
                letter, count = self.variables.inner[base], self.partial_order() or 1
            elif not by and match[1] in self.variables.inner and match[2]:  # d2u/dx2
                letter, count = self.variables.inner[match[1]], int(match[2])
            else:
                self.fail(f"∂ goes by {self.spoken_variables()}, not by {spelling}", self.tokens[self.next - 1].place)
            letters += letter * min(count, _ORDER + 1)
        if bracket:
            if not self.at(")"):
                self.fail("expected ')'")
            self.take()
        if len(letters) != (order or 1):
            self.fail(
                f"the orders above, {order or 1}, and below, {len(letters)}, differ: the second derivative is ∂²u/∂x², "
                "the square of the first (∂u/∂x)^2",
                place,
            )
        return letters

    def applied(self, operator, place):
        """The operator on the name, bracket or operator that follows; what might belong to it must not follow."""
        self.depth += 1
        if self.depth > 80:
            self.fail("operators are nested more than the 80 levels allowed")
        if not self.begins_operand() or self.token.kind == "number":
            self.fail("an operator must be followed by what it works on, a name or a bracket")
        if self.at("∂", "∇", "Δ", "dot"):
            operand = self.operated()
        else:
            operand = self.primary()
        self.depth -= 1
        found = operator(operand)
        written = self.text[place : self.tokens[self.next - 1].end].strip()
        written = written if len(written) <= 30 else "..."
        if self.at("^") or self.token.kind == "script":
            self.fail(f"{written}^2 could be the square of {written} or that operator on a square: write a bracket")
        if self.begins_operand():
            self.fail(
                f"{written} followed by a factor: does the operator work on that too? Write ({written})*v or a bracket"
            )
        return found

    def vector_call(self, name, place):
        """lap(u), grad(u), div(...)."""
        dim = self.variables.dim
        opened = self.token.place
        self.take()
        self.open.append("(")
        found = [self.sum()]
        while self.at(","):
            self.take()
            found.append(self.sum())
        if not self.at(")"):
            self.fail("expected ')' to close this bracket", opened)
        self.take()
        self.open.pop()
        if name == "div" and len(found) > 1:
            found = [Vector(self.scalar(part) for part in found)]
        if name == "dot" and len(found) == 2:
            return self.vectors(place, vectors.multiplied, [("*", place, part) for part in found], place)
        if len(found) != 1:
            self.fail(f"{name} takes one operand, got {len(found)}", place)
        if name == "div":
            return self.vectors(place, vectors.divergence, found[0], dim, place)
        inside = self.scalar(found[0])
        if name == "grad":
            return vectors.gradient(inside, dim, place)
        return vectors.laplacian(inside, dim, place, 2 if name == "bilap" else 1)

    # ------------------------------------------------------------ of the upper half

    def sum(self):  # pragma: no cover
        raise NotImplementedError

    power = bracket = begins_operand = sum
