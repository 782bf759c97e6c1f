"""grad, div, lap and the derivative operators on nodes, in as many space variables as a text has.

A vector is a tuple of nodes, one for each space variable; it is gone once the text is read. div(D grad(u)) becomes the
derivatives of brackets, (D*u_x)_x + (D*u_y)_y, and lap(u) becomes u_xx + u_yy.
"""

from primer.equations.error import PDEError
from primer.equations.functions import minus, number, over, product_of, sum_of
from primer.equations.tree import Node, split_name

LAPLACIANS = 4  # one upon the other: the eighth derivatives


class Vector(tuple):
    """The nodes of a vector's components."""


def derived(node, letters, place):
    """The derivative of a node: u_x becomes u_xx, and what is no plain name a bracket that is differentiated."""
    if node.kind == "name" and split_name(node.value)[0] not in ("x", "y", "z", "t", "i", "pi"):
        base, own = split_name(node.value)
        return Node("name", node.place, f"{base}_{own}{letters}")
    return Node("derivative", place, letters, (node,))


def gradient(node, dim, place):
    """grad of a scalar."""
    return Vector(derived(node, letter, place) for letter in "xyz"[:dim])


def divergence(vector, dim, place):
    """div of a vector."""
    if not isinstance(vector, Vector):
        vector = Vector([vector])
    if len(vector) != dim:
        raise ValueError(f"div takes a vector of {dim} components here, such as grad(u), got {len(vector)}")
    return sum_of([derived(part, letter, place) for part, letter in zip(vector, "xyz", strict=False)], place)


def laplacian(node, dim, place, times=1):
    """lap of a scalar, so many times."""
    for _ in range(times):
        parts = node.operands if node.kind == "+" and all(part.kind == "name" for part in node.operands) else (node,)
        node = sum_of([derived(part, 2 * letter, place) for part in parts for letter in "xyz"[:dim]], place)
    return node


def added(terms, place):
    """The sum of terms, [(sign "+" or "-", place of the sign, node or vector)]."""
    vectors = [isinstance(term, Vector) for _, _, term in terms]
    if any(vectors):
        if not all(vectors):
            raise ValueError("a sum of a vector and a scalar")
        columns = zip(*([(sign, at, part) for part in term] for sign, at, term in terms), strict=True)
        return Vector(added(list(column), place) for column in columns)
    return sum_of([minus(term, at) if sign == "-" else term for sign, at, term in terms], place)


def multiplied(factors, place):
    """The product of factors, [(sign "*" or "/", place of the sign, node or vector)]; of two vectors their dot."""
    vectors = [k for k, (_, _, factor) in enumerate(factors) if isinstance(factor, Vector)]
    if any(factors[k][0] == "/" for k in vectors):
        raise ValueError("a division by a vector")
    if len(vectors) > 2:
        raise ValueError("a product of three vectors")

    def plain(chosen):
        return product_of([Node("/", at, operands=(f,)) if sign == "/" else f for sign, at, f in chosen], place)

    if not vectors:
        return plain(factors)

    def with_parts(n):
        parts = [(s, at, f[n] if isinstance(f, Vector) else f) for s, at, f in factors]
        return plain(parts)

    columns = [with_parts(n) for n in range(len(factors[vectors[0]][2]))]
    return Vector(columns) if len(vectors) == 1 else sum_of(columns, place)


def length(vector, place):
    """The length of a vector."""
    squares = [Node("^", place, operands=(part, number(2, place))) for part in vector]
    return Node("call", place, "sqrt", (sum_of(squares, place),))


def squared(vector, place):
    """The square of a vector, the sum of the squares of its components."""
    return sum_of([Node("^", place, operands=(part, number(2, place))) for part in vector], place)


__all__ = [
    "PDEError",
    "Vector",
    "added",
    "derived",
    "divergence",
    "gradient",
    "laplacian",
    "length",
    "multiplied",
    "over",
]
