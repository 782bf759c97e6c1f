"""What the parser does with one operand: names, numbers, calls, bars, roots, and brackets that are differentiated.

Every function here takes the :class:`~primer.equations.grammar.Parser`, at the token where its part begins.
"""

import re

from primer.equations import functions, operators, vectors
from primer.equations.error import ask
from primer.equations.functions import COMPOSED, FUNCTIONS, OTHER_NAMES
from primer.equations.tree import OPERATORS, Node
from primer.equations.vectors import Vector

DEPTH = 80  # far beyond what a person would write by hand


def primary(p):
    """A number, a name, a bracket, a call, or an operator with what it works on."""
    p.operators += 1  # one upon the other, in brackets or not
    if p.operators > DEPTH:
        p.fail(f"operators are nested more than the {DEPTH} levels allowed")
    node = _primary(p)
    p.operators -= 1
    return node


def _primary(p):
    token = p.token
    if token.kind == "number":
        digits, imaginary = p.take().value
        if imaginary and "i" in p.variables.plain:
            p.fail(f"{digits}i: i is a name here, so that a product is written {digits}*i", token.place)
        return Node("number", token.place, (digits, imaginary))
    if token.kind == "name":
        return named(p)
    if p.at("(", "[", "{"):
        return differentiated(p, p.bracket())
    if p.at("|"):
        return differentiated(p, bars(p))
    if p.at("frac"):
        return operators.fraction(p)
    if p.at("√"):
        return root(p)
    if p.at("∂", "∇", "Δ", "dot"):
        return operators.operated(p)
    if token.kind == "subscript":
        p.fail("a subscript needs a name")
    return p.fail("expected a number, a name or '('")


def named(p):
    """A name, or a call."""
    token = p.take()
    base, by, spelling, latex = token.value
    spelling = base if latex else spelling
    name = OTHER_NAMES.get(base, base) if not by else ""
    function = name in FUNCTIONS or name in COMPOSED
    if (function and p.at("^")) or (function and p.token.kind == "script"):
        return power_of_a_function(p, name, token)
    number = base in p.variables.inner or base in p.variables.valued - p.variables.evolved or base in ("i", "pi")
    product = number and not by and base not in p.given  # what is a number is no function: a (u + v) is a product
    if not p.at("(") or (product and not function):
        if function and p.begins_operand() and not p.new_line_before():
            return without_bracket(p, name, token, latex)
        if base in p.given:
            node = p.given.node(base, None, token.place, p)
            return Node("derivative", token.place, p.letters(by, token.place), (node,)) if by else node
        return p.name(base, by, token.place, spelling)
    if function:
        return differentiated(p, call(p, name, token.place))
    if not by and base in ("lap", "laplacian", "bilap", "grad", "div", "dot"):
        return differentiated(p, vector_call(p, base, token.place))
    if not by and base[0] == "d" and (letters := p.variables.derivatives(base[1:])):
        operand = p.scalar(p.bracket())
        return differentiated(p, vectors.derived(operand, p.letters(letters, token.place), token.place))
    if not by and base in OPERATORS and base not in p.variables.evolved and base not in p.given:
        return differentiated(p, vectors.derived(p.scalar(p.bracket()), OPERATORS[base], token.place))
    if not by and base in p.given:
        return differentiated(p, p.given.node(base, arguments(p), token.place, p))
    return ambiguous_call(p, token)


def ambiguous_call(p, token):
    """Fail at u(x) and f(u): a function or a product?"""
    base, by, spelling, latex = token.value
    begin = p.next
    inside = arguments(p) if p.at("(") else []
    within = p.text[p.tokens[begin].end : p.tokens[p.next - 1].place].strip()
    within = within if len(within) <= 20 else "..."
    spelling = base if latex else spelling
    short = spelling if len(spelling) <= 30 else spelling[:27] + "..."
    if by or base in p.variables.evolved or (inside and all(n.kind == "name" and n.value in "xyzt" for n in inside)):
        function = (
            f"as an unknown it is written {short} alone, for unknowns depend on all variables; "
            f"as a function, it must be given, {ask('function', short, within or 'x')}"
        )
        product = f"as a product it is written {short}*({within})"
        p.fail(f"{short}({within}) can be read in two ways: {function}; {product}", token.place)
    known = ", ".join(FUNCTIONS)
    p.fail(
        f"{short!r} is not a known function ({known}): one of your own must be given, "
        f"{ask('function', short, 'u')}; a product is written with '*', {short}*({within})",
        token.place,
    )


def call(p, name, place):
    """A function of the language with its operands in brackets."""
    least, most = functions.arity(name)
    operands = arguments(p)
    if not least <= len(operands) <= most:
        p.fail(f"{name} takes {least if least == most else 'two or more'}, got {len(operands)}", place)
    return functions.called(name, operands, place)


def arguments(p):
    """The nodes between brackets, parted by commas."""
    opened = p.take()
    p.open.append("(")
    found = [p.scalar(p.sum())]
    while p.at(","):
        p.take()
        found.append(p.scalar(p.sum()))
    if not p.at(")"):
        p.fail("expected ')' to close this bracket", opened.place)
    p.take()
    p.open.pop()
    return found


def power_of_a_function(p, name, token):
    r"""sin^2(x), \sin^2 x: a whole power of 2 or more; what sin^-1 would be, nobody knows."""
    if p.token.kind != "script":
        p.take()
    exponent = script(p) if p.token.kind == "script" else p.signed()
    whole = exponent.kind == "number" and re.fullmatch(r"[2-9]|\d\d+", exponent.value[0]) and not exponent.value[1]
    if not whole or not p.at("("):
        p.fail(f"a power of {name} is written {name}(u)^2; 1/{name}(u) and a{name}(u) are two things", token.place)
    return Node("^", exponent.place, operands=(call(p, name, token.place), exponent))


def without_bracket(p, name, token, latex):
    r"""\sin x of one name, where nothing follows that might belong to it."""
    inside = p.token
    if latex and (p.at("{") or inside.kind in ("name", "number")):
        operand = p.scalar(p.bracket() if p.at("{") else primary(p))
        if inside.value == "{" or not (p.begins_operand() or p.at("*", "·", "/", "^") or p.token.kind == "script"):
            return functions.called(name, [operand], token.place)
    return p.fail(f"what {name} is of goes into brackets, as in {name}(u)", token.place)


def bars(p):
    """|...|"""
    opened = p.take()
    p.depth += 1
    p.open.append("|")
    inside = p.sum()
    if not p.at("|"):
        p.fail("expected '|' to close this one", opened.place)
    p.take()
    p.open.pop()
    p.depth -= 1
    return absolute(p, inside, opened.place)


def absolute(p, inside, place):
    """|u|, or the length of a vector."""
    if isinstance(inside, Vector):
        return vectors.length(inside, place)
    return Node("call", place, "abs", (inside,))


def script(p):
    """The node of a superscript: a number with a sign, or a letter."""
    token = p.take()
    text = token.value.translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿ", "0123456789+-n"))
    if not re.fullmatch(r"[+-]?(\d+|n)", text):
        p.fail("a superscript is a number, or n", token.place)
    size = text.lstrip("+-")
    node = functions.number(size, token.place) if size != "n" else p.name("n", (), token.place, "n")
    return functions.minus(node, token.place) if text[0] == "-" else node


def root(p):
    """√ with a bracket or a name; \\sqrt[3]{u} is a power."""
    place = p.take().place
    power = None
    if p.at("["):
        power = p.scalar(p.bracket())
    if not (p.at("(", "{") or p.token.kind in ("name", "number")):
        p.fail("what the root is of goes into brackets, as in sqrt(u)")
    inside = p.scalar(p.bracket() if p.at("(", "{") else primary(p))
    if power is None:
        return differentiated(p, Node("call", place, "sqrt", (inside,)))
    return Node("^", place, operands=(inside, functions.over(functions.number(1, place), power, place)))


def differentiated(p, node):
    """The node, or its derivative if subscripts follow."""
    while p.token.kind == "subscript":
        by, written = p.token.value
        if by is None:
            p.fail(f"a bracket is differentiated by {p.spoken_variables()}, not by {written[1:]}")
        node = p.scalar(node)
        token = p.take()
        letters = p.letters(by, token.place)
        if node.kind == "derivative" and p.tokens[p.next - 2].kind == "subscript":
            node = Node("derivative", node.place, node.value + letters, node.operands)
        else:
            node = Node("derivative", token.place, letters, (node,))
    return node


def vector_call(p, name, place):
    """lap(u), grad(u), div(...)."""
    dim = p.variables.dim
    opened = p.token.place
    p.take()
    p.open.append("(")
    found = [p.sum()]
    while p.at(","):
        p.take()
        found.append(p.sum())
    if not p.at(")"):
        p.fail("expected ')' to close this bracket", opened)
    p.take()
    p.open.pop()
    if name == "div" and len(found) > 1:
        found = [Vector(p.scalar(part) for part in found)]
    if name == "dot" and len(found) == 2:
        return p.vectors(place, vectors.multiplied, [("*", place, part) for part in found], place)
    if len(found) != 1:
        p.fail(f"{name} takes one operand, got {len(found)}", place)
    if name == "div":
        return p.vectors(place, vectors.divergence, found[0], dim, place)
    inside = p.scalar(found[0])
    if name == "grad":
        return vectors.gradient(inside, dim, place)
    return vectors.laplacian(inside, dim, place, 2 if name == "bilap" else 1)
