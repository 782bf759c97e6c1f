"""The right-hand side of an evolution equation on rows of points, in machine code: what every time loop calls for."""

from contextlib import contextmanager

from primer.equations.stages import Evolution
from primer.schemes.passes import Form, passes
from primer.schemes.pointwise import Lanes, Leaves, parts, pointwise
from primer.schemes.writer import Writer

_WIDE = {"float": 16, "double": 8}  # points that an operation serves: 64 bytes, one vector register, two or four
PAD = 16  # rows that matrices make are a multiple of this long
NONE = Form()


class Slope:
    """Writes the right-hand side of an evolution, for one system or for ``members`` of them side by side.

    A row is n points, with ``reach`` ghost cells at both ends where differences are taken of it; members are innermost.
    What is complex has two rows, side by side. ``stencils`` is a table of stencils, or None where derivatives are
    products with matrices. ``book`` names what the code is given: addresses first, then numbers.
    """

    def __init__(self, evolution: Evolution, stencils, kind, book, lanes, members=1, form=NONE, fused=False):
        self.evolution, self.kind, self.members, self.form = evolution, kind, members, form
        self.plan = passes(evolution, form)
        self.parts = 1 + form.fields  # of a field
        self.rows = len(evolution.fields) * self.parts
        self.stencils = {m: stencils[m] for m in evolution.orders} if stencils else {}
        self.reach = reach(self.stencils)
        self.entries = book
        self.write = write = Writer()
        self.one = Lanes(write, kind, 1, 1, fused)
        self.lanes = Lanes(write, kind, lanes, members, fused)
        write.declare("declare i64 @llvm.smin.i64(i64, i64)")
        for name, operands in (("fabs", 1), ("sqrt", 1), ("fma", 3)):
            given = ", ".join([self.lanes.name] * operands)
            write.declare(f"declare {self.lanes.name} @llvm.{name}.{self.lanes.suffix}({given})")

    # Addresses.

    def book(self, name):
        """An entry of the book, an address or a number."""
        entry, is_address = self.entries[name]
        kind = "ptr" if is_address else "i64"
        return self.write.load(kind, self.write.at("i64", "%book", entry))

    def times(self, a, b):
        """a b, of whole numbers."""
        return self.write.value(f"mul i64 {a}, {b}")

    def plus(self, a, b):
        """a + b, of whole numbers."""
        return self.write.value(f"add i64 {a}, {b}")

    def length(self, n, reach):
        """Numbers in a row with ghost cells."""
        return self.times(self.plus(n, 2 * reach), self.members)

    def lay(self, base, n, count, reach):
        """Addresses of point 0 of so many rows, one behind the other."""
        length = self.length(n, reach)
        return [
            self.write.at(self.kind, base, self.plus(self.times(length, k), reach * self.members)) for k in range(count)
        ]

    def paired(self, rows):
        """The rows of the fields: by pairs where they are complex."""
        return list(zip(rows[::2], rows[1::2], strict=True)) if self.form.fields else rows

    @contextmanager
    def over(self, n, carried=()):
        """A loop over all points, so many at a time; the last ones may be done twice. Gives (place, seen, then)."""
        with self.write.loop("0", n, 1 if self.members > 1 else self.lanes.width, carried) as (i, seen, then):
            if self.members > 1:
                place = self.times(i, self.members)
            else:
                last = self.write.value(f"sub i64 {n}, {self.lanes.width}")
                place = self.write.value(f"call i64 @llvm.smin.i64(i64 {i}, i64 {last})")
            yield place, seen, then

    def slot(self, base, k):
        """The address of row k of values for each lane."""
        return self.write.at(self.kind, base, k * self.lanes.width)

    def first(self, row):
        """What is at the first point, in all lanes."""
        return self.lanes.read(row, "0") if self.members > 1 else self.lanes.splat(self.one.read(row, "0"))

    def number(self, base, k):
        """Number k in all lanes; each member has its own."""
        if self.members > 1:
            return self.write.load(self.lanes.name, self.write.at(self.kind, base, k * self.members))
        return self.lanes.splat(self.write.load(self.kind, self.write.at(self.kind, base, k)))

    def numbers(self, base, pairs, start=0):
        """Values of numbers one behind the other from the start-th on, two for each that is complex."""
        found = []
        for is_complex in pairs:
            both = [self.number(base, start + k) for k in range(1 + is_complex)]
            found.append(tuple(both) if is_complex else both[0])
            start += 1 + is_complex
        return found

    # The right-hand side.

    def prepare(self, n, first=0):
        """Write what does not change in time, for rows of n points; the ``first`` numbers are somebody else's."""
        form, write = self.form, self.write
        self.n, self.call = n, self.book("call")
        self.scratch = self.lay(self.book("scratch"), n, self.plan.rows, self.reach)
        rows = iter(self.lay(self.book("fixed"), n, len(form.fixed) + sum(form.fixed), 0))
        self.fixed = [(next(rows), next(rows)) if is_complex else next(rows) for is_complex in form.fixed]
        numbers, self.clocks = self.book("numbers"), self.book("clocks")
        scales = self.numbers(numbers, (False,) * len(self.stencils), first)
        self.scales = dict(zip(self.stencils, scales, strict=True))
        self.constants = self.numbers(numbers, form.constant, first + len(scales))
        self.sources = [self.at(row) for row in self.plan.sources]
        self.results = {term: self.at(row) for term, row in self.plan.results.items()}
        self.derived = {}
        if not self.stencils and self.evolution.orders:
            self.matrices, self.padded = self.book("matrices"), self.book("padded")
            slots = [slot for one in self.plan.before for slot in one.derivatives] + list(self.plan.last_derivatives)
            derived = self.book("derived")
            # Each has room for the two parts of what may be complex.
            rows = [write.at(self.kind, derived, self.times(self.padded, k)) for k in range(2 * len(slots))]
            self.derived = {slot: (rows[2 * k], rows[2 * k + 1]) for k, slot in enumerate(slots)}

    def at(self, row):
        """The address of a row of scratch, or a pair of them."""
        real = self.scratch[row.number]
        return real if row.imaginary is None else (real, self.scratch[row.imaginary])

    def evaluate(self, fields, time, finish, carried=()):
        """Write one evaluation on rows (or pairs of them) of the fields, whose ghost cells are filled here.

        ``finish(place, slopes, seen, then)`` is written into the last loop, over all points; ``carried`` are values
        that this loop hands on, as in ``Writer.loop``, and what they end as is returned.
        """
        write, lanes, calls = self.write, self.lanes, self.plan.calls
        if self.form.clock:
            write.put(f"call void {self.call}(i64 -1, double {time})")
        clock = self.numbers(self.clocks, self.form.clock)
        self.sources_now = fields + self.sources
        derived = {
            (source, m): rows if isinstance(self.sources_now[source], tuple) else rows[0]
            for (source, m), rows in self.derived.items()
        }
        leaves = Leaves(
            self.constants, clock, self.fixed, self.sources_now, self.results, derived, self.stencils, self.scales
        )
        self.close(fields)
        for one in self.plan.before:
            self.differentiate(one.derivatives)
            with self.over(self.n) as (place, _, _):
                found = [self.full(pointwise(term, lanes, leaves, place), term) for term, _ in one.stores]
                for value, (_, row) in zip(found, one.stores, strict=True):
                    lanes.keep(value, self.at(row), place)
            self.close([self.at(row) for row in one.ghosts])
            for call in one.calls:
                write.put(f"call void {self.call}(i64 {calls.index(call)}, double {time})")
        self.differentiate(self.plan.last_derivatives)
        with self.over(self.n, carried) as (place, seen, then):
            finish(
                place, [self.full(pointwise(term, lanes, leaves, place), term) for term in self.plan.last], seen, then
            )
        return seen

    def full(self, value, term):
        """NumPy spreads what is one number over the grid by adding zeros: -0 becomes 0."""
        if term.kind not in ("constant", "clock"):
            return value
        found = tuple(self.lanes.operation("fadd", part, self.lanes.whole(0)) for part in parts(value))
        return found if isinstance(value, tuple) else found[0]

    def close(self, rows):
        """Fill the ghost cells at both ends of rows from the other end."""
        lanes, write = (self.lanes if self.members > 1 else self.one), self.write
        for row in rows:
            for part in parts(row):
                end = write.at(self.kind, part, self.times(self.n, self.members))
                for k in range(1, self.reach + 1):
                    low, high = -k * self.members, (k - 1) * self.members
                    for source, target, shift in ((end, part, low), (part, end, high)):
                        value = write.load(lanes.name, write.at(self.kind, source, shift))
                        write.store(lanes.name, value, write.at(self.kind, target, shift))

    def differentiate(self, slots):
        """Where there are no stencils: f'_i = sum_o (f_o - f_0) D[o, i], o in order, into rows of their own."""
        if self.stencils or not slots:
            return
        write, kind, orders = self.write, self.kind, self.evolution.orders
        of: dict = {}
        for slot in slots:
            of.setdefault(slot[0], []).append(slot)
        lanes = Lanes(write, kind, PAD)
        for source, mine in of.items():
            for k, row in enumerate(parts(self.sources_now[source])):
                start = self.one.read(row, "0")
                with write.loop("0", self.padded, PAD) as (i, _, _):
                    carried = [(lanes.name, lanes.whole(0))] * len(mine)
                    with write.loop("0", self.n, 1, carried) as (o, seen, then):
                        apart = lanes.splat(self.one.operation("fsub", self.one.read(row, o), start))
                        for place, (_, m) in enumerate(mine):
                            line = self.plus(self.times(self.n, orders.index(m)), o)
                            weight = lanes.read(self.matrices, self.plus(self.times(line, self.padded), i))
                            then[place] = lanes.operation("fadd", seen[place], lanes.operation("fmul", weight, apart))
                    for value, slot in zip(seen, mine, strict=True):
                        write.store(lanes.name, value, write.at(kind, self.derived[slot][k], i))


def width(kind, n):
    """How many of n points an operation serves; n >= 4."""
    return min(_WIDE[kind], 1 << (n.bit_length() - 1))


def reach(stencils):
    """How far the stencils look."""
    return max((abs(offset) for stencil in stencils.values() for offset in stencil.offsets), default=0)


def entries(addresses, numbers):
    """{name: (place in the book, whether it is an address)}."""
    names = [(name, True) for name in addresses] + [(name, False) for name in numbers]
    return {name: (place, is_address) for place, (name, is_address) in enumerate(names)}
