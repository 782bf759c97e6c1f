"""Equations as text: their trees, their variables and their names. Nothing is evaluated or executed.

See :mod:`primer.equations.grammar` for the grammar and ``primer help equations`` for the language.
"""

from dataclasses import dataclass, replace

from primer.equations.error import PDEError
from primer.equations.functions import FUNCTIONS
from primer.equations.given import Given
from primer.equations.grammar import Parser
from primer.equations.sympy_text import texts
from primer.equations.tokens import tokens
from primer.equations.tree import Node, split_name
from primer.equations.variables import Variables, canonical, variables

LENGTH = 8000  # far beyond what a person would write by hand


@dataclass(frozen=True, eq=False)
class Source:
    """What a text says.

    Attributes
    ----------
    text        as given, or several joined
    equations   pairs (left, right) of nodes, in which the variables are x, y, z and t
    variables   the :class:`Variables`: what the text calls them, and all other names
    """

    text: str
    equations: tuple
    variables: Variables

    @property
    def dim(self):
        """The number of space variables."""
        return self.variables.dim

    def outside(self, name, said=False):
        """What the text calls a name of the tree, in canonical letters: nu; or as it is first ``said`` there: ν."""
        return self.variables.outside(name, said)

    def inside(self, name):
        """What the tree calls a name of the text, such as "u" or "c_rr"; None for what is no name."""
        try:
            first, *rest = tokens(name, self.variables, {canonical(name)})
        except PDEError:
            return None
        if first.kind != "name" or len(rest) != 1:
            return None
        base, by, _, _ = first.value
        if by and self.variables.inside(whole(base, by)) in self.variables.spelt:
            return self.variables.inside(whole(base, by))  # a parameter D_x
        return self.variables.inside(base, by)


def parse(text):
    """The equations of ``text`` as a list of pairs (left, right) of nodes.

    Raises
    ------
    PDEError    with the text and a caret under the place where it goes wrong
    """
    return list(understand(text).equations)


def parse_expression(text, source=None):
    """The node of an expression such as "a - cos(x)", which has no "=", in the variables of a :class:`Source`."""
    known = source.variables if source else variables()
    return Parser(_checked("an expression", "a - cos(x)", text), tokens(text, known, known.valued), known).expression()


def understand(text, space=None, time=None, given=(), named=(), functions=None):
    """The :class:`Source` of a text.

    Parameters
    ----------
    text                    equations; or a list of texts, sympy equations, or a list of these
    space, time             what the text calls its variables: "r", "x, z"; by default x, with y and z if they occur,
                            and t
    given                   the names of parameters that have a value by keyword
    named                   other names that have a value
    functions : dict        texts or functions of Python by name

    Raises
    ------
    PDEError    with the text and a caret under the place where it goes wrong
    """
    text, space, time = texts(text, space, time)
    _checked("the equations", "u_t = u_xx", text)
    known = variables(space, time)
    given = {canonical(name) for name in given if isinstance(name, str)}
    named = given | {canonical(name) for name in named if isinstance(name, str)}
    functions = {canonical(name): function for name, function in (functions or {}).items()}
    found = tokens(text, known, named)
    others = {
        name: tokens(_checked(name, "u^2", function), known, named)
        for name, function in functions.items()
        if isinstance(function, str)
    }
    found = _with_parameters(found, given)
    everything = [token for each in (found, *others.values()) for token in each]
    evolved = {token.value[0] for token in everything if token.kind == "name" and token.value[1]}
    used = {name for token in everything if token.kind in ("name", "subscript") for name in _variables(token, known)}
    known = replace(
        known.narrowed(used),
        plain=frozenset({"e", "i", "pi"} & (evolved | named)),
        evolved=frozenset(evolved),
        valued=frozenset(named),
    )
    makers = Given(functions, known, others)
    equations = Parser(text, found, known, makers).equations()
    makers.check_used()
    return Source(text, tuple(equations), known)


def whole(base, by):
    """A name with its subscript of variables."""
    return f"{base}_{''.join(by)}" if by else base


def _with_parameters(found, given):
    """The tokens, with D_x a name of its own where it has a value by keyword and D is nothing else."""
    bases: dict = {}
    for token in found:
        if token.kind == "name":
            bases.setdefault(token.value[0], set()).add(whole(*token.value[:2]))
    own = {base for base, wholes in bases.items() if wholes <= given}
    return [
        token._replace(value=(whole(*token.value[:2]), (), *token.value[2:]))
        if token.kind == "name" and token.value[1] and token.value[0] in own
        else token
        for token in found
    ]


def _variables(token, known):
    """The variables that a token makes use of: in d/dy, u_y, y, and dy(u)."""
    if token.kind == "subscript":
        return token.value[0] or ()
    base, by, _, _ = token.value
    more = known.derivatives(base[1:]) if base[0] == "d" and len(base) > 1 else None
    return (base, *by, *(more or ()))


def _checked(what, example, text):
    """The text, if it is one and not too long."""
    if not isinstance(text, str):
        raise TypeError(f"{what} must be a string such as {example!r}, got {type(text).__name__}")
    if len(text) > LENGTH:
        raise PDEError(f"the text has {len(text)} characters, more than the {LENGTH} allowed")
    return text


__all__ = ["FUNCTIONS", "LENGTH", "Node", "PDEError", "Source", "parse", "parse_expression", "split_name", "understand"]
