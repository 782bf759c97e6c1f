"""The functions of the language, in one table, and those that a reader brings along as a text or in Python."""

from primer.checks import shown
from primer.equations.error import PDEError, ask
from primer.equations.tree import Node

#: What a call in the tree may be; everything else is written with these.
FUNCTIONS = (
    *("sin", "cos", "tan", "exp", "log", "sqrt", "sinh", "cosh", "tanh", "abs"),
    *("sign", "asin", "acos", "atan", "erf"),
)
OTHER_NAMES = {"ln": "log", "arcsin": "asin", "arccos": "acos", "arctan": "atan", "sgn": "sign", "fabs": "abs"}
COMPOSED = ("max", "min", "sech")
SIZE = 4000  # nodes that functions given by keyword may add to the tree


def number(digits, place):
    """The node of a number."""
    return Node("number", place, (str(digits), False))


def minus(node, place):
    """-node."""
    return Node("-", place, operands=(node,))


def sum_of(nodes, place):
    """The node of a sum of one or more."""
    return nodes[0] if len(nodes) == 1 else Node("+", place, operands=tuple(nodes))


def product_of(nodes, place):
    """The node of a product of one or more."""
    return nodes[0] if len(nodes) == 1 else Node("*", place, operands=tuple(nodes))


def over(a, b, place):
    """a/b."""
    return Node("*", place, operands=(a, Node("/", place, operands=(b,))))


def called(name, operands, place):
    """The node of a call of a function of the language.

    max(a, b) = (a + b + |a - b|)/2, min(a, b) = (a + b - |a - b|)/2, sech(a) = 1/cosh(a).
    """
    name = OTHER_NAMES.get(name, name)
    if name == "sech":
        return over(number(1, place), Node("call", place, "cosh", tuple(operands)), place)
    if name in ("max", "min"):
        found, *others = operands
        for other in others:
            gap = Node("call", place, "abs", (sum_of([found, minus(other, place)], place),))
            gap = gap if name == "max" else minus(gap, place)
            found = over(sum_of([found, other, gap], place), number(2, place), place)
        return found
    return Node("call", place, name, tuple(operands))


def arity(name):
    """(least, most) number of operands."""
    return (2, 9) if name in ("max", "min") else (1, 1)


class Traced:
    """A number that remembers how it was computed: what a function of Python does to it becomes a tree.

    Arithmetic and NumPy's functions of the same names as those of the language are understood.
    """

    __slots__ = ("count", "node")

    def __init__(self, node, count):
        self.node, self.count = node, count

    def _made(self, node):
        self.count[0] += 1
        if self.count[0] > SIZE:
            raise PDEError("a function given by keyword grows too long")
        return Traced(node, self.count)

    def _of(self, value):
        if isinstance(value, Traced):
            return value.node
        value = value.item() if hasattr(value, "item") else value
        if isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e300:
            size = number(repr(abs(value)), self.node.place)
            return minus(size, self.node.place) if value < 0 else size
        raise TypeError(f"{shown(value)} cannot be part of an equation")

    def _joined(self, kind, a, b):
        place = self.node.place
        if kind == "-":
            return self._made(sum_of([a, minus(b, place)], place))
        if kind == "/":
            return self._made(over(a, b, place))
        return self._made(Node(kind, place, operands=(a, b)))

    def __add__(self, other):
        return self._joined("+", self.node, self._of(other))

    def __radd__(self, other):
        return self._joined("+", self._of(other), self.node)

    def __sub__(self, other):
        return self._joined("-", self.node, self._of(other))

    def __rsub__(self, other):
        return self._joined("-", self._of(other), self.node)

    def __mul__(self, other):
        return self._joined("*", self.node, self._of(other))

    def __rmul__(self, other):
        return self._joined("*", self._of(other), self.node)

    def __truediv__(self, other):
        return self._joined("/", self.node, self._of(other))

    def __rtruediv__(self, other):
        return self._joined("/", self._of(other), self.node)

    def __pow__(self, other):
        return self._joined("^", self.node, self._of(other))

    def __rpow__(self, other):
        return self._joined("^", self._of(other), self.node)

    def __neg__(self):
        return self._made(minus(self.node, self.node.place))

    def __bool__(self):
        raise TypeError("whether an unknown is true, or equal to something, is not known")

    def __eq__(self, other):
        return bool(self)

    __hash__ = None  # type: ignore[assignment]

    def __pos__(self):
        return self

    def __abs__(self):
        return self._made(called("abs", [self.node], self.node.place))

    def __array_ufunc__(self, ufunc, method, *inputs, **options):
        operator = _OPERATORS.get(ufunc.__name__)
        name = {"absolute": "abs", "maximum": "max", "minimum": "min"}.get(ufunc.__name__, ufunc.__name__)
        if method != "__call__" or options or not (operator or _is_function(name)):
            return NotImplemented
        nodes = [self._of(value) for value in inputs]
        if ufunc.__name__ == "square":
            return self._joined("*", nodes[0], nodes[0])
        if ufunc.__name__ == "negative":
            return self._made(minus(nodes[0], self.node.place))
        if operator:
            return self._joined(operator, *nodes)
        return self._made(called(name, nodes, self.node.place))


_OPERATORS = {
    "add": "+", "subtract": "-", "multiply": "*", "divide": "/", "true_divide": "/", "power": "^", "float_power": "^",
    "negative": "-", "square": "*",
}  # fmt: skip


def _is_function(name):
    return name in FUNCTIONS or name in OTHER_NAMES or name in COMPOSED


def traced(name, function, operands, place):
    """The node of what a function of Python makes of these nodes.

    Raises
    ------
    PDEError    if it does what cannot be followed, such as a branch or a call of ``math``
    """
    count = [0]
    try:
        found = function(*(Traced(node, count) for node in operands))
        return Traced(operands[0] if operands else number(0, place), count)._of(found)
    except PDEError:
        raise
    except Exception as error:  # whatever a function of someone else's may do
        raise PDEError(
            f"{name} must be a function made of + - * / ** and of numpy's functions, or a text such as "
            f"{ask('function', name, 'u')}, got {shown(error)}"
        ) from None
