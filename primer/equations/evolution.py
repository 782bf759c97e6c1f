"""Equations solved for their highest time derivatives: what can be marched, as terms, and what cannot.

Lower time derivatives are fields of their own: u_tt = u_xx is the system of u and u_t with (u)_t = u_t, (u_t)_t = u_xx.
"""

from primer.equations.terms import (
    DERIVATIVE,
    ONE,
    ZERO,
    Builder,
    Term,
    add,
    negative,
    over,
    size,
    subtract,
    times,
    whole_power,
)
from primer.equations.text import PDEError, understand
from primer.equations.tree import OPERATORS
from primer.equations.unknowns import unknowns, uses
from primer.equations.variables import MARK

SIZE = 5_000  # the longest right-hand side; a text is at most 600 symbols, but solving may multiply them
NOT_MARCHED = "such equations can be judged (primer.verdict), not marched"


def first_order(text, given=(), space=None, time=None, functions=()):
    """(fields, parameters, terms, divisors) of a text; arguments as for :func:`primer.equations.stages.evolution`.

    Returns
    -------
    fields       the unknowns with their lower time derivatives, such as ("u", "u_t", "v")
    parameters   the other names
    terms        for each field its time derivative
    divisors     the factors of time derivatives that were divided by, which must not vanish

    Raises
    ------
    PDEError    for a constraint, a mixed time derivative, a second space variable, or what is not linear in the highest
                time derivatives
    """
    source = understand(text, space, time, given if functions else (), (), dict(functions))
    equations, text = source.equations, source.text
    used = uses(equations, ("i", "pi"))
    if any(base == "y" or "y" in own + around for base, own, around in used):
        raise PDEError(f"there is a second space variable, y: {NOT_MARCHED}")
    if any(letter in own + around for _, own, around in used for letter in OPERATORS.values()):
        raise PDEError(f"H(u) and absD(u) look everywhere at once: {NOT_MARCHED}")
    names = unknowns(used, len(equations), given)
    orders = {name: max((own + around).count("t") for base, own, around in used if base == name) for name in names}
    for name, order in orders.items():
        if name.endswith(MARK) or name in ("x", "t"):
            raise PDEError(f"{name.removesuffix(MARK)} has a meaning of its own and cannot be an unknown")
        if order == 0:
            raise PDEError(f"{name} has no time derivative, so that there is a constraint: {NOT_MARCHED}")
    solver = _Solver(text, orders)
    latest = dict(zip(names, solver.solve(equations), strict=True))
    terms = [
        latest[name] if k == orders[name] - 1 else Term("slot", (i + 1, 0)) for i, (name, k) in enumerate(solver.levels)
    ]
    return solver.fields, tuple(solver.builder.parameters), terms, solver.divisors


def field(name, k):
    """The name of the k-th time derivative of an unknown: u, u_t, u_tt."""
    return f"{name}_{'t' * k}" if k else name


class _Solver:
    def __init__(self, text, orders):
        self.text, self.orders = text, orders
        self.levels = [(name, k) for name, order in orders.items() for k in range(order)]
        self.fields = tuple(field(name, k) for name, k in self.levels)
        self.divisors: list[Term] = []
        self.builder = Builder(text, orders, self.unknown, self.bracket)

    def unknown(self, base, letters, node):
        if len(letters) > DERIVATIVE:
            self.builder.fail(f"a derivative of order {len(letters)}, above the {DERIVATIVE} allowed", node)
        return self.state(base, letters.count("t"), letters.count("x"), node)

    def state(self, name, k, m, node):
        if k < self.orders[name]:
            return Term("slot", (self.fields.index(field(name, k)), m))
        if m:
            raise PDEError(f"the highest time derivative of {name} is differentiated by x as well: {NOT_MARCHED}")
        return Term("latest", name)

    def bracket(self, letters, inner, node):
        m = letters.count("x")
        if len(letters) > DERIVATIVE:
            self.builder.fail(f"a derivative of order {len(letters)}, above the {DERIVATIVE} allowed", node)
        for _ in range(letters.count("t")):
            inner = self.in_time(inner, node)
            if size(inner) > SIZE:
                self.builder.fail("a derivative that grows too long", node)
        if m and self.has_latest(inner):
            raise PDEError(f"a highest time derivative is differentiated by x as well: {NOT_MARCHED}")
        if m and inner.kind == "slot" and inner.value[1] == 0:
            return Term("slot", (inner.value[0], m))  # (u)_x is u_x
        return Term("derivative", m, (inner,)) if m else inner

    def in_time(self, term, node):
        """The time derivative of a term, by the chain rule."""
        kind, of = term.kind, term.operands
        if kind == "t":
            return ONE
        if kind == "slot":
            name, k = self.levels[term.value[0]]
            return self.state(name, k + 1, term.value[1], node)
        if kind == "latest":
            raise PDEError(f"a time derivative of a time derivative that is not written as such: {NOT_MARCHED}")
        changes = [self.in_time(operand, node) for operand in of]
        if all(change == ZERO for change in changes):
            return ZERO
        if kind in ("+", "-"):
            return (add if kind == "+" else subtract)(*changes)
        if kind == "neg":
            return negative(*changes)
        if kind == "*":
            return add(times(changes[0], of[1]), times(of[0], changes[1]))
        if kind == "/":
            return over(subtract(changes[0], times(term, changes[1])), of[1])
        if kind == "power":
            return times(times(Term("number", str(term.value)), whole_power(of[0], term.value - 1)), changes[0])
        if kind == "derivative":
            return Term("derivative", term.value, tuple(changes))
        if kind == "call" and term.value == "sqrt":
            return over(changes[0], times(Term("number", "2"), term))
        if kind == "call" and term.value in ("exp", "log"):
            return times(term, changes[0]) if term.value == "exp" else over(changes[0], of[0])
        return self.builder.fail("a time derivative of this bracket is not taken here: write it out", node)

    def has_latest(self, term):
        return term.kind == "latest" or any(self.has_latest(operand) for operand in term.operands)

    def solve(self, equations):
        """The highest time derivatives, one for each unknown."""
        rows = []
        for left, right in equations:
            (on_left, rest), (on_right, total) = (self.split(self.builder.build(side)) for side in (left, right))
            for term, sign in _terms_of(rest):
                total = subtract(total, term) if sign > 0 else add(total, term)
            slopes = {name: subtract(on_left.get(name, ZERO), on_right.get(name, ZERO)) for name in self.orders}
            rows.append((slopes, total))
        return _eliminate(rows, list(self.orders), self.divisors)

    def split(self, term):
        """({unknown: its factor}, the rest) of a term that is linear in the highest time derivatives."""
        kind, of = term.kind, term.operands
        if kind == "latest":
            return {term.value: ONE}, ZERO
        if not self.has_latest(term):
            return {}, term
        parts = [self.split(operand) for operand in of]
        if kind == "neg":
            return {n: negative(f) for n, f in parts[0][0].items()}, negative(parts[0][1])
        if kind in ("+", "-"):
            join = add if kind == "+" else subtract
            (a, rest_a), (b, rest_b) = parts
            return {n: join(a.get(n, ZERO), b.get(n, ZERO)) for n in {**a, **b}}, join(rest_a, rest_b)
        if kind == "*" and not all(found for found, _ in parts):
            (a, rest_a), (b, rest_b) = parts
            if b:
                return {n: times(of[0], f) for n, f in b.items()}, times(of[0], rest_b)
            return {n: times(f, of[1]) for n, f in a.items()}, times(rest_a, of[1])
        if kind == "/" and not parts[1][0]:
            return {n: over(f, of[1]) for n, f in parts[0][0].items()}, over(parts[0][1], of[1])
        raise PDEError(f"the equations are not linear in their highest time derivatives: {NOT_MARCHED}")


def _terms_of(term):
    """[(term, sign)] of a sum, in the order of the text."""
    if term.kind in ("+", "-"):
        a, b = term.operands
        return [*_terms_of(a), (b, 1 if term.kind == "+" else -1)]
    return [] if term == ZERO else [(term.operands[0], -1) if term.kind == "neg" else (term, 1)]


def _eliminate(rows, names, divisors):
    """Gauss's elimination with terms for numbers; a row that has its unknown alone is left as it is written."""
    solved: dict = {}
    while rows:
        alone = [(row, [n for n in names if row[0][n] != ZERO]) for row in rows]
        row, present = min(alone, key=lambda pair: len(pair[1]) or 99)
        if not present:
            raise PDEError(f"the equations do not determine all time derivatives: {NOT_MARCHED}")
        pivot = min(present, key=lambda n: (row[0][n] != ONE, size(row[0][n]), names.index(n)))
        rows = [other for other in rows if other is not row]
        if row[0][pivot] != ONE:
            divisors.append(row[0][pivot])
        value = {n: over(row[0][n], row[0][pivot]) for n in present if n != pivot}, over(row[1], row[0][pivot])
        solved[pivot] = value
        rows = [_without(other, pivot, value) for other in rows]
        if sum(size(term) for _, term in rows) > SIZE:
            raise PDEError(f"solving the equations for their time derivatives grows too long: {NOT_MARCHED}")
    found: dict = {}
    for name in reversed(solved):
        slopes, total = solved[name]
        for other, slope in slopes.items():
            total = subtract(total, times(slope, found[other]))
        found[name] = total
    return [found[name] for name in names]


def _without(row, pivot, value):
    slopes, total = row
    factor = slopes[pivot]
    if factor == ZERO:
        return row
    gone = {n: subtract(s, times(factor, value[0].get(n, ZERO))) for n, s in slopes.items()}
    return {**gone, pivot: ZERO}, subtract(total, times(factor, value[1]))
