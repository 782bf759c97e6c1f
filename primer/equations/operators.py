"""What the parser does with the many ways to write a derivative: ∂_x u, ∂u/∂x, d/dx(u), Δu, ∇·(D∇u), and LaTeX.

An operator takes the name or the bracket behind it and nothing more; what might belong to it must not follow. Every
function here takes the :class:`~primer.equations.grammar.Parser`, at the token where its part begins.
"""

import re

from primer.equations import functions, operands, vectors
from primer.equations.vectors import Vector

_ORDER = 12  # the highest derivative


def fraction(p):
    r"""\frac{a}{b}, a derivative if there is a ∂, or a d, in both."""
    place = p.take().place
    if p.token.kind == "number" and re.fullmatch(r"\d\d", p.token.value[0]):  # \frac12
        upper, lower = (functions.number(digit, place) for digit in p.take().value[0])
        return functions.over(upper, lower, place)
    if not p.at("{"):
        p.fail(r"\frac is written \frac{a}{b}", place)
    if p.tokens[p.next + 1].value == "∂" and p.tokens[p.next + 2].kind != "subscript":
        p.take(), p.take()
        order = partial_order(p)
        operand = None if p.at("}") else p.scalar(p.sum())
        closed(p, place)
        if not p.at("{"):
            p.fail(r"\frac is written \frac{a}{b}", place)
        p.take()
        letters = below(p, order, place)
        closed(p, place)
        if operand is None:
            return applied(p, lambda node: vectors.derived(p.scalar(node), letters, place), place)
        return vectors.derived(operand, letters, place)
    upper = p.bracket()
    if not p.at("{"):
        p.fail(r"\frac is written \frac{a}{b}", place)
    lower = p.bracket()
    return p.vectors(place, vectors.multiplied, [("*", place, upper), ("/", place, lower)], place)


def closed(p, place):
    """Leave a closing brace behind."""
    if not p.at("}"):
        p.fail("expected '}' to close this", place)
    p.take()


def operated(p):
    """∂_x, ∂/∂x, ∂u/∂x, Δ, ∇, ∇², ∇·, and a dot, with what they work on."""
    sign = p.take()
    place, dim = sign.place, p.variables.dim
    if sign.value == "Δ":
        times = even_order(p, 1, place)
        return applied(p, lambda node: vectors.laplacian(p.scalar(node), dim, place, times), place)
    if sign.value == "dot":
        return vectors.derived(p.scalar(p.bracket() if p.at("{") else operands.primary(p)), "t", place)
    if sign.value == "∂":
        return partial(p, place)
    if p.at("·", "*"):
        p.take()
        return applied(p, lambda v: p.vectors(place, vectors.divergence, v, dim, place), place)
    if p.at("^") or p.token.kind == "script":
        times = even_order(p, 2, place)
        return applied(p, lambda node: vectors.laplacian(p.scalar(node), dim, place, times), place)
    return applied(p, lambda node: vectors.gradient(p.scalar(node), dim, place), place)


def even_order(p, unit, place):
    """How many Laplacians ∇^4 (of unit 2) or Δ^2 (of unit 1) are."""
    order = partial_order(p) or unit
    if order % unit or not 1 <= order // unit <= vectors.LAPLACIANS:
        p.fail("a power of this operator that is not understood", place)
    return order // unit


def partial_order(p):
    """The order that may follow ∂ or a variable below it; 0 if none does."""
    if p.token.kind == "script":
        node = operands.script(p)
    elif p.at("^"):
        p.take()
        node = p.bracket() if p.at("{", "(") else operands.primary(p)
    elif p.token.kind == "number" and p.tokens[p.next - 1].end == p.token.place:
        node = operands.primary(p)
    else:
        return 0
    if isinstance(node, Vector) or node.kind != "number" or not re.fullmatch(r"\d\d?", node.value[0]) or node.value[1]:
        p.fail("the order of a derivative is a number", p.tokens[p.next - 1].place)
    return int(node.value[0])


def partial(p, place):
    """After a ∂."""
    order = partial_order(p)
    if p.token.kind == "subscript":
        by, written = p.take().value
        if by is None:
            p.fail(f"∂ goes by {p.spoken_variables()}, not by {written[1:]}", place)
        more = partial_order(p)
        letters = ordered(p, p.letters(by, place), order or more, place)
        return applied(p, lambda node: vectors.derived(p.scalar(node), letters, place), place)
    if p.at("/"):
        p.take()
        letters = below(p, order, place)
        return applied(p, lambda node: vectors.derived(p.scalar(node), letters, place), place)
    if not p.begins_operand():
        p.fail("∂ is written ∂_x u, ∂u/∂x or ∂/∂x (u)", place)
    begin = p.token.place
    factors = [("*", place, p.power())]
    while p.begins_operand():
        factors.append(("*", place, p.power()))
    operand = p.scalar(p.vectors(place, vectors.multiplied, factors, begin))
    if not (p.at("/") and p.tokens[p.next + 1].value in ("∂", "(")):
        p.fail("∂u must stand over something, as in ∂u/∂x", place)
    p.take()
    return vectors.derived(operand, below(p, order, place), place)


def ordered(p, letters, order, place):
    """The letters of ∂^2_x; one letter is repeated."""
    if order and len(letters) == 1:
        letters *= min(order, _ORDER + 1)
    elif order and order != len(letters):
        p.fail(f"a derivative of order {order} by {len(letters)} variables", place)
    return letters


def below(p, order, place):
    """The letters of what stands below: ∂x, ∂x^2, ∂x∂y."""
    bracket = p.at("(")
    if bracket:
        p.take()
    letters = ""
    while p.at("∂"):
        p.take()
        if p.token.kind != "name":
            p.fail("∂ below a fraction bar takes a variable, as in ∂x")
        base, by, spelling, _ = p.take().value
        stem, digit = (base[:-1], base[-1]) if base[-1].isdigit() else (base, "")
        if not by and base in p.variables.inner:
            letter, count = p.variables.inner[base], partial_order(p) or 1
        elif not by and digit and stem in p.variables.inner:  # d2u/dx2
            letter, count = p.variables.inner[stem], int(digit)
        else:
            p.fail(f"∂ goes by {p.spoken_variables()}, not by {spelling}", p.tokens[p.next - 1].place)
        letters += letter * min(count, _ORDER + 1)
    if bracket:
        if not p.at(")"):
            p.fail("expected ')'")
        p.take()
    if len(letters) != (order or 1):
        p.fail(
            f"the orders above, {order or 1}, and below, {len(letters)}, differ: the second derivative is ∂²u/∂x², "
            "the square of the first (∂u/∂x)^2",
            place,
        )
    return letters


def applied(p, operator, place):
    """The operator on the name, bracket or operator that follows; what might belong to it must not follow."""
    if not p.begins_operand() or p.token.kind == "number":
        p.fail("an operator must be followed by what it works on, a name or a bracket")
    operand = operands.primary(p)
    found = operator(operand)
    written = p.text[place : p.tokens[p.next - 1].end].strip()
    written = written if len(written) <= 30 else "..."
    if p.at("^") or p.token.kind == "script":
        p.fail(f"{written}^2 could be the square of {written} or that operator on a square: write a bracket")
    if p.begins_operand():
        p.fail(f"{written} followed by a factor: does the operator work on that too? Write ({written})*v or a bracket")
    return found
