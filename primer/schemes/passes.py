"""What one evaluation of the right-hand side is made of: passes over the grid, and what each leaves for the next."""

from dataclasses import dataclass, field
from functools import lru_cache

from primer.equations.stages import Evolution
from primer.equations.terms import Term

INLINE = ("abs", "sqrt")  # of real numbers exact in IEEE arithmetic; all others are NumPy's, to the bit


@dataclass(frozen=True)
class Form:
    """What is complex: the fields, and which of the constants, of the functions of x, and of those of t."""

    fields: bool = False
    constant: tuple[bool, ...] = ()
    fixed: tuple[bool, ...] = ()
    clock: tuple[bool, ...] = ()


@dataclass(frozen=True)
class Row:
    """A row of scratch: its number, and that of its imaginary part where it is complex."""

    number: int
    imaginary: int | None = None


@dataclass(frozen=True)
class Call:
    """A function of whole rows, which NumPy computes: of rows, or of constants by number."""

    name: str
    operands: tuple[Row | int, ...]
    result: Row


@dataclass(frozen=True)
class Pass:
    """One loop over the grid.

    stores         the terms that are stored, and in which rows
    ghosts         rows that are then closed periodically
    calls          what is then computed of them
    derivatives    the (source, m) that this pass needs
    """

    stores: tuple[tuple[Term, Row], ...]
    ghosts: tuple[Row, ...] = ()
    calls: tuple[Call, ...] = ()
    derivatives: tuple[tuple[int, int], ...] = ()


@dataclass(frozen=True)
class Passes:
    """The passes of an :class:`Evolution`.

    Attributes
    ----------
    before      the passes that fill rows of scratch
    last        what the last one computes: the time derivatives of the fields, and for it the (source, m) it needs
    sources     the rows of the sources of slots beyond the fields
    results     term of a call -> the row with its values
    rows        how many rows of scratch there are
    """

    before: tuple[Pass, ...]
    last: tuple[Term, ...]
    last_derivatives: tuple[tuple[int, int], ...]
    sources: tuple[Row, ...]
    results: dict[Term, Row] = field(hash=False)
    rows: int

    @property
    def calls(self) -> tuple[Call, ...]:
        """All calls, in order."""
        return tuple(call for one in self.before for call in one.calls)


@lru_cache(maxsize=256)
def passes(evolution: Evolution, form: Form) -> Passes:
    """The :class:`Passes` of an evolution in a form."""
    plan = _Plan(evolution, form)
    for stage in evolution.stages[:-1]:
        plan.calls(stage.values)
        plan.keep(stage.values)
    last = evolution.stages[-1].values
    plan.calls(last)
    return Passes(tuple(plan.before), last, plan.needed(last), tuple(plan.sources), plan.results, plan.rows)


class _Plan:
    def __init__(self, evolution, form):
        self.form, self.fields, self.rows = form, len(evolution.fields), 0
        self.before, self.sources, self.results = [], [], {}
        self.kinds, self.made = {}, set()

    def row(self, is_complex):
        self.rows += 1 + is_complex
        return Row(self.rows - 2, self.rows - 1) if is_complex else Row(self.rows - 1)

    def is_complex(self, term):
        """Whether a term is a complex array, as NumPy's rules have it."""
        if term not in self.kinds:
            if term.kind == "slot":
                source = term.value[0] - self.fields
                found = self.form.fields if source < 0 else self.sources[source].imaginary is not None
            elif not term.operands:
                found = getattr(self.form, term.kind)[term.value]
            else:
                found = any(map(self.is_complex, term.operands)) and not (term.kind == "call" and term.value == "abs")
            self.kinds[term] = found
        return self.kinds[term]

    def needed(self, terms):
        """The derivatives in these terms that no pass before has asked for."""
        found: dict = {}

        def walk(term):
            if term.kind == "slot" and term.value[1] and term.value not in self.made:
                found[term.value] = None
            for operand in term.operands:
                if operand not in self.results:
                    walk(operand)

        for term in terms:
            if term not in self.results:
                walk(term)
        self.made |= set(found)
        return tuple(found)

    def keep(self, terms):
        """A pass that makes sources of the terms."""
        # One number, spread over the grid, is of the fields' kind.
        kinds = [self.form.fields if t.kind in ("constant", "clock") else self.is_complex(t) for t in terms]
        stores = tuple((term, self.row(kind)) for term, kind in zip(terms, kinds, strict=True))
        self.before.append(Pass(stores, tuple(row for _, row in stores), (), self.needed(terms)))
        self.sources += [row for _, row in stores]

    def calls(self, terms):
        """Passes that make the values of all calls in the terms, the innermost first."""
        while wanted := dict.fromkeys(call for term in terms for call in self.innermost(term)):
            stores: dict = {}
            calls = []
            for term in wanted:
                operands: list = []
                for operand in term.operands:
                    if operand.kind == "constant":
                        operands.append(operand.value)
                        continue
                    if operand not in stores:
                        stores[operand] = self.row(self.is_complex(operand))
                    operands.append(stores[operand])
                result = self.row(self.is_complex(term))
                calls.append(Call(term.value or "^", tuple(operands), result))
                self.kinds[term] = result.imaginary is not None
            needed = self.needed(stores)
            self.before.append(Pass(tuple(stores.items()), (), tuple(calls), needed))
            self.results.update({term: call.result for term, call in zip(wanted, calls, strict=True)})

    def innermost(self, term):
        """The calls in a term whose operands are without further calls to be made."""
        if term in self.results:
            return []
        inner = [call for operand in term.operands for call in self.innermost(operand)]
        exact = term.kind == "call" and term.value in INLINE and not self.is_complex(term.operands[0])
        return inner or ([term] if term.kind == "^" or (term.kind == "call" and not exact) else [])
