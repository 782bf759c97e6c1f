"""Functions that a reader brings along, f="u^3 - u" or f=lambda u: u**3 - u, as makers of the nodes of f(u)."""

from primer.equations.error import PDEError, ask
from primer.equations.functions import SIZE, traced
from primer.equations.grammar import Parser
from primer.equations.tree import Node, split_name

NESTED = 8  # functions given by functions


class Given:
    """The functions given, by name; ``functions`` are texts, whose ``tokens`` are known, or functions of Python."""

    def __init__(self, functions, variables, tokens):
        self.functions, self.variables, self.tokens = functions, variables, tokens
        self.count, self.nested, self.used = 0, 0, set()

    def __contains__(self, name):
        return name in self.functions

    def check_used(self):
        """Raise PDEError for a function that does not occur."""
        for name in self.functions:
            if name not in self.used:
                raise PDEError(f"{name!r} is given but does not occur in the equations")

    def node(self, name, arguments, place, parser):
        """The node of a call of ``name`` with these nodes, or of the name alone (None)."""
        self.used.add(name)
        function = self.functions[name]
        if not isinstance(function, str):
            if arguments is None:
                parser.fail(f"{name} is given as a function: write what it is of, as in {name}(u)", place)
            return self._moved(traced(name, function, arguments, place), place, parser)
        self.nested += 1
        if self.nested > NESTED:
            parser.fail(f"{name} is given by itself, or by functions nested too deeply", place)
        node = Parser(function, self.tokens[name], self.variables, self).expression()
        self.nested -= 1
        node = node if arguments is None else self._called(name, node, arguments, place, parser)
        return self._moved(node, place, parser)

    def _called(self, name, node, arguments, place, parser):
        """The text's tree, with the argument of the call in place of the one name that has no value."""
        names = dict.fromkeys(split_name(leaf.value)[0] for leaf in _leaves(node) if leaf.kind == "name")
        arguments_named = {argument.value for argument in arguments if argument.kind == "name"}
        if len(arguments_named) == len(arguments) and arguments_named & names.keys():
            return node  # f(u) of a text in u
        valued = self.variables.valued
        own = [n for n in names if n not in ("i", "pi") and self.variables.outside(n) not in valued]
        if len(arguments) != 1 or len(own) > 1:
            said = ", ".join(map(self.variables.outside, own))
            parser.fail(
                f"{name} is given as a text in {said}, and this call does not say what stands for what: write it in "
                f"the names of the call, {ask('function', name, 'u')} for {name}(u)",
                place,
            )
        return _put(node, own[0], arguments[0]) if own else node

    def _moved(self, node, place, parser):
        """The node with every place that of the call, if it is not too large."""
        self.count += sum(1 for _ in _leaves(node))
        if self.count > SIZE:
            parser.fail("functions given by keyword grow too long", place)
        return _placed(node, place)


def _leaves(node):
    yield node
    for operand in node.operands:
        yield from _leaves(operand)


def _placed(node, place):
    return Node(node.kind, place, node.value, tuple(_placed(operand, place) for operand in node.operands))


def _put(node, name, argument):
    if node.kind == "name":
        base, letters = split_name(node.value)
        if base != name:
            return node
        return Node("derivative", node.place, letters, (argument,)) if letters else argument
    return Node(node.kind, node.place, node.value, tuple(_put(operand, name, argument) for operand in node.operands))
