"""Terms of an equation written as operations of LLVM on a few neighbouring points at once.

A real value is a register; a complex one a pair of them. Each operation is the one that NumPy does on arrays, with the
same rounding: ``fused`` says whether its product of complex arrays rounds once where two products are added.
"""

from dataclasses import dataclass
from functools import cached_property

from primer.schemes.writer import Writer

KINDS = {"float32": "float", "float64": "double", "complex64": "float", "complex128": "double"}
_OPERATIONS = {"+": "fadd", "-": "fsub"}


@dataclass(frozen=True, eq=False)
class Lanes:
    """``width`` numbers of one kind that one operation serves: points beside each other, or the members of a block.

    ``name`` is LLVM's for all of them; neighbours in x are ``apart`` numbers apart.
    """

    write: Writer
    kind: str
    width: int
    apart: int = 1
    fused: bool = False

    @cached_property
    def name(self):
        return self.kind if self.width == 1 else f"<{self.width} x {self.kind}>"

    @property
    def truth(self):
        """The type of as many truth values."""
        return "i1" if self.width == 1 else f"<{self.width} x i1>"

    @property
    def suffix(self):
        """By which LLVM's functions know the type."""
        return (f"v{self.width}" if self.width > 1 else "") + {"float": "f32", "double": "f64"}[self.kind]

    def splat(self, number):
        """One number in all places."""
        if self.width == 1:
            return number
        one = self.write.value(f"insertelement {self.name} poison, {self.kind} {number}, i32 0")
        zeros = f"<{self.width} x i32> zeroinitializer"
        return self.write.value(f"shufflevector {self.name} {one}, {self.name} poison, {zeros}")

    def whole(self, value):
        """A whole number that both kinds hold."""
        text = f"{float(value):.1f}"
        return text if self.width == 1 else "<" + ", ".join([f"{self.kind} {text}"] * self.width) + ">"

    @property
    def false(self):
        """Not true, in all places."""
        return "false" if self.width == 1 else "zeroinitializer"

    def address(self, row, i, offset=0):
        """Of what is at point i + offset of a row."""
        here = self.write.at(self.kind, row, i)
        return self.write.at(self.kind, here, offset * self.apart) if offset else here

    def read(self, row, i, offset=0):
        """What is there; it must not change while this block runs. Of a pair of rows, the pair."""
        if isinstance(row, tuple):
            return tuple(self.read(part, i, offset) for part in row)
        part = {"float": 4, "double": 8}[self.kind]
        return self.write.value(f"load {self.name}, ptr {self.address(row, i, offset)}, align {part}")

    def keep(self, value, row, i):
        """Store a value; a real one in a pair of rows is complex."""
        if isinstance(row, tuple):
            for part, where in zip(pair(self, value), row, strict=True):
                self.keep(part, where, i)
        else:
            self.write.store(self.name, value, self.address(row, i))

    # Real operations.

    def operation(self, name, *operands):
        """fadd, fsub, fmul, fdiv, fneg."""
        return self.write.value(f"{name} {self.name} {', '.join(operands)}")

    def function(self, name, *operands):
        """One of LLVM's own functions."""
        given = ", ".join(f"{self.name} {operand}" for operand in operands)
        return self.write.value(f"call {self.name} @llvm.{name}.{self.suffix}({given})")

    def relation(self, relation, a, b):
        """Where a is in a relation of LLVM's to b."""
        return self.write.value(f"fcmp {relation} {self.name} {a}, {b}")

    def either(self, a, b):
        """Where one or the other is true."""
        return self.write.value(f"or {self.truth} {a}, {b}")

    def choose(self, relation, a, b):
        """a where (a relation b), else b."""
        return self.pick(self.relation(relation, a, b), a, b)

    def pick(self, condition, a, b):
        """a where the condition is true, else b."""
        return self.write.value(f"select {self.truth} {condition}, {self.name} {a}, {self.name} {b}")


def pair(lanes, value):
    """A value as a complex one."""
    return value if isinstance(value, tuple) else (value, lanes.whole(0))


def parts(value):
    """The real numbers of a value: one, or two."""
    return value if isinstance(value, tuple) else (value,)


def scaled(lanes, factor, value):
    """A real factor times a value, part by part."""
    found = tuple(lanes.operation("fmul", factor, part) for part in parts(value))
    return found if isinstance(value, tuple) else found[0]


def added(lanes, name, a, b):
    """fadd or fsub of two values."""
    if not isinstance(a, tuple) and not isinstance(b, tuple):
        return lanes.operation(name, a, b)
    return tuple(lanes.operation(name, x, y) for x, y in zip(pair(lanes, a), pair(lanes, b), strict=True))


def product(lanes, a, b):
    """a b, as NumPy multiplies arrays."""
    if not isinstance(a, tuple) and not isinstance(b, tuple):
        return lanes.operation("fmul", a, b)
    (ar, ai), (br, bi) = pair(lanes, a), pair(lanes, b)
    first, second = lanes.operation("fmul", ai, bi), lanes.operation("fmul", ai, br)
    if lanes.fused:
        return lanes.function("fma", ar, br, lanes.operation("fneg", first)), lanes.function("fma", ar, bi, second)
    real = lanes.operation("fsub", lanes.operation("fmul", ar, br), first)
    return real, lanes.operation("fadd", lanes.operation("fmul", ar, bi), second)


def quotient(lanes, a, b):
    """a/b, complex ones by Smith's formula, as NumPy does it."""
    if not isinstance(a, tuple) and not isinstance(b, tuple):
        return lanes.operation("fdiv", a, b)
    (ar, ai), (br, bi) = pair(lanes, a), pair(lanes, b)
    do = lanes.operation

    def smith(x, y, p, q):
        """The ratio y/x and the scale for |x| >= |y|, and what p + q ratio is times the scale."""
        ratio = do("fdiv", y, x)
        return ratio, do("fdiv", lanes.whole(1), do("fadd", x, do("fmul", y, ratio)))

    size_r, size_i = lanes.function("fabs", br), lanes.function("fabs", bi)
    ratio, scale = smith(br, bi, ar, ai)
    one = (
        do("fmul", do("fadd", ar, do("fmul", ai, ratio)), scale),
        do("fmul", do("fsub", ai, do("fmul", ar, ratio)), scale),
    )
    ratio, scale = smith(bi, br, ar, ai)
    other = (
        do("fmul", do("fadd", do("fmul", ar, ratio), ai), scale),
        do("fmul", do("fsub", do("fmul", ai, ratio), ar), scale),
    )
    nothing = do("fdiv", ar, size_r), do("fdiv", ai, size_r)
    zero = lanes.whole(0)
    both = lanes.write.value(
        f"and {lanes.truth} {lanes.relation('oeq', size_r, zero)}, {lanes.relation('oeq', size_i, zero)}"
    )
    larger = lanes.relation("oge", size_r, size_i)
    return tuple(lanes.pick(both, n, lanes.pick(larger, x, y)) for n, x, y in zip(nothing, one, other, strict=True))


@dataclass(frozen=True, eq=False)
class Leaves:
    """Where a pass finds what its terms are made of: registers with all lanes filled, and addresses of rows.

    constants, clocks    values
    fixed, sources       rows, with pairs of them for what is complex
    results              term of a call -> row
    derivatives          (source, m) -> row, where a pass before has made them
    stencils, scales     m -> stencil, and the register with its scale, where not
    """

    constants: list
    clocks: list
    fixed: list
    sources: list
    results: dict
    derivatives: dict
    stencils: dict
    scales: dict


def pointwise(term, lanes, leaves, i):
    """The value of a term at the points of index i."""

    def value(term):
        kind = term.kind
        if term in leaves.results:
            return lanes.read(leaves.results[term], i)
        if kind == "slot":
            return slot(*term.value)
        if kind == "constant":
            return leaves.constants[term.value]
        if kind == "clock":
            return leaves.clocks[term.value]
        if kind == "fixed":
            return lanes.read(leaves.fixed[term.value], i)
        if kind == "power":
            return power(value(term.operands[0]), term.value)
        operands = tuple(map(value, term.operands))  # no frame of its own: a sum may be hundreds of terms deep
        if kind == "neg":
            signs = tuple(lanes.operation("fneg", part) for part in parts(operands[0]))
            return signs if isinstance(operands[0], tuple) else signs[0]
        if kind == "call":
            return lanes.function({"abs": "fabs"}.get(term.value, term.value), *operands)
        if kind in _OPERATIONS:
            return added(lanes, _OPERATIONS[kind], *operands)
        return (product if kind == "*" else quotient)(lanes, *operands)

    def power(base, n):
        if n == 1:
            return base
        half = power(base, n // 2)
        whole = product(lanes, half, half)
        return product(lanes, whole, base) if n % 2 else whole

    def slot(source, m):
        if m == 0:
            return lanes.read(leaves.sources[source], i)
        if (source, m) in leaves.derivatives:
            return lanes.read(leaves.derivatives[source, m], i)
        stencil, total = leaves.stencils[m], None
        for offset, weight in zip(stencil.offsets, stencil.weights, strict=True):
            value = lanes.read(leaves.sources[source], i, offset)
            value = value if abs(weight) == 1 else scaled(lanes, lanes.whole(abs(weight)), value)
            if total is not None:  # a + (-w) f is a - w f, to the bit
                total = added(lanes, "fadd" if weight > 0 else "fsub", total, value)
            else:
                total = value if weight > 0 else scaled(lanes, lanes.whole(-1), value)
        return scaled(lanes, leaves.scales[m], total)

    return value(term)
