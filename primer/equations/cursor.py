"""Where the parser stands in its tokens, and what it says when it cannot go on."""

from typing import Any, NoReturn

from primer.equations.error import PDEError
from primer.equations.tree import Node
from primer.equations.vectors import Vector


class Cursor:
    """A place in the tokens of a text, in the variables of that text."""

    def __init__(self, text, tokens, variables, given=None):
        self.text, self.tokens, self.variables = text, tokens, variables
        self.given: Any = {} if given is None else given  # the functions that a reader brings along
        self.next = self.depth = self.operators = 0
        self.open: list[str] = []

    @property
    def token(self):
        """The next one."""
        return self.tokens[self.next]

    def fail(self, problem: str, place: int | None = -1) -> NoReturn:
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

    def name(self, base, by, place, spelling=None):
        """The node of a name."""
        return Node("name", place, self.variables.inside(base, by, spelling))

    def letters(self, by, place):
        """The letters inside of variables."""
        return "".join(self.variables.inner[name] for name in by)

    def spoken_variables(self):
        """x, y and t, as the text calls them."""
        return f"{', '.join(self.variables.space)} and {self.variables.time}"
