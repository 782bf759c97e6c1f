"""The right-hand side of an evolution equation as stages: what a time loop does with it, in the order of the text.

A differentiated bracket is differentiated as it is written: its values on the grid are differenced, so that
``u_t + (u^2/2)_x = 0`` conserves the mean of u to rounding. A bracket within a bracket is a stage of its own.
"""

from dataclasses import dataclass, field
from functools import cached_property, lru_cache

from primer.equations.evolution import first_order
from primer.equations.terms import Term


@dataclass(frozen=True)
class Stage:
    """Terms that are computed point by point, from fields, from derivatives, and from what came before.

    Attributes
    ----------
    slots     the (source, m) needed: the m-th x-derivative (m = 0: the values) of source s. Sources 0 ... F - 1 are the
              fields, F, F + 1, ... the values of the stages so far, in their order
    values    terms of kind slot, constant, fixed or clock, joined by + - * / ^ neg power call
    """

    slots: tuple[tuple[int, int], ...]
    values: tuple[Term, ...]


@dataclass(frozen=True)
class Evolution:
    """(fields)_t = f(x, t, fields, their derivatives), as it is computed.

    Attributes
    ----------
    text            the equations
    fields          the names of the fields, F of them
    parameters      the names that need a value
    stages          the :class:`Stage`; the values of the last one are the time derivatives of the fields
    constants       terms of numbers and parameters: computed once a run
    fixed           terms of x alone: computed once a run, for each x
    clocks          terms of t alone: computed once for each t
    divisors        numbers of the constants by which something else is divided: they must not be 0
    imaginary       whether i occurs
    """

    text: str
    fields: tuple[str, ...]
    parameters: tuple[str, ...]
    stages: tuple[Stage, ...] = field(repr=False)
    constants: tuple[Term, ...] = field(repr=False)
    fixed: tuple[Term, ...] = field(repr=False)
    clocks: tuple[Term, ...] = field(repr=False)
    divisors: tuple[int, ...] = field(repr=False)
    imaginary: bool = field(repr=False)

    @property
    def autonomous(self) -> bool:
        """Whether t does not occur."""
        return not self.clocks

    @cached_property
    def orders(self) -> tuple[int, ...]:
        """The orders of the x-derivatives that are taken, ascending."""
        return tuple(sorted({m for stage in self.stages for _, m in stage.slots if m}))


@lru_cache(maxsize=256)
def evolution(text, given=(), space=None, time=None, functions=()):
    """The :class:`Evolution` of a text; ``given`` is a tuple of the names of the parameters that have values.

    ``space`` and ``time`` are what the text calls its variables, ``functions`` pairs (name, text or function).

    Raises
    ------
    PDEError    if the text is wrong, or its equations can be judged only, not marched

    >>> toy = evolution("u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)")
    >>> print(toy.fields, toy.parameters, toy.stages[0].slots, toy.orders)
    ('u', 'v') ('eps',) ((1, 1), (0, 0), (1, 2), (0, 1), (1, 0)) (1, 2)
    """
    fields, parameters, terms, divisors = first_order(text, given, space, time, functions)
    return _Lowering(len(fields)).evolution(text, fields, parameters, terms, divisors)


class _Lowering:
    """From terms with brackets in them to stages; equal brackets, constants and functions of x are computed once."""

    def __init__(self, number):
        self.number = number
        self.inner = []  # [(depth, term of a differentiated bracket)], in the order in which they were met
        self.shared: dict = {"constant": {}, "fixed": {}, "clock": {}}
        self.divisors: set = set()
        self.imaginary = False

    def evolution(self, text, fields, parameters, terms, divisors):
        last = max(self.depth(term) for term in terms)
        for term in terms:
            self.collect(term)
        self.inner.sort(key=lambda pair: pair[0])
        self.source = {term: self.number + k for k, (_, term) in enumerate(self.inner)}
        stages = []
        for depth in range(last):
            stages.append(self.stage([term for d, term in self.inner if d == depth]))
        stages.append(self.stage(terms))
        self.divisors |= {self.lower(term, {}).value for term in divisors if not self.needs(term)}
        constants, fixed, clocks = (tuple(found) for found in self.shared.values())
        return Evolution(
            text,
            fields,
            parameters,
            tuple(stages),
            constants,
            fixed,
            clocks,
            tuple(sorted(self.divisors)),
            self.imaginary,
        )

    def depth(self, term):
        """How many brackets are differentiated one within the other."""
        return max((self.depth(operand) for operand in term.operands), default=0) + (term.kind == "derivative")

    def collect(self, term):
        for operand in term.operands:
            self.collect(operand)
        if term.kind == "derivative":
            pair = self.depth(term) - 1, term.operands[0]
            if pair not in self.inner:
                self.inner.append(pair)

    def stage(self, terms):
        slots: dict = {}
        values = tuple(self.lower(term, slots) for term in terms)
        return Stage(tuple(slots), values)

    def lower(self, term, slots):
        """The term with slots for derivatives and one leaf for each part that needs no field."""
        needs = self.needs(term)
        kind = {frozenset(): "constant", frozenset("x"): "fixed", frozenset("t"): "clock"}.get(needs)
        if kind:
            self.imaginary |= self.has_i(term)
            return Term(kind, self.shared[kind].setdefault(term, len(self.shared[kind])))
        if term.kind == "derivative":
            term = Term("slot", (self.source[term.operands[0]], term.value))
        if term.kind == "slot":
            slots[term.value] = None
            return term
        if term.kind == "/" and not self.needs(term.operands[1]):
            self.divisors.add(self.lower(term.operands[1], slots).value)
        return Term(term.kind, term.value, tuple(self.lower(operand, slots) for operand in term.operands))

    def needs(self, term):
        """What a term depends on: of x, t and f, the fields. What is differenced counts as a field."""
        if term.kind in ("slot", "derivative"):
            return frozenset("f")
        if term.kind in ("x", "t"):
            return frozenset(term.kind)
        return frozenset().union(*(self.needs(operand) for operand in term.operands))

    def has_i(self, term):
        return term.kind == "i" or any(self.has_i(operand) for operand in term.operands)
