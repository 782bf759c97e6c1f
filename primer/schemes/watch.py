"""The time loop around the steps, in machine code that knows nothing of equations: when to look, and what to keep.

A run must know the first step with u <= 0 and the first with Dist > blow_up_at, but looking at every point of every
step would cost as much as half the step. So the steps up to the next record are made while the sweep keeps the least
and the largest value of each field, and no more. If these exclude that anything happened, nothing did; else the state
is put back, and the same steps are made and looked at one by one.
"""

from primer.schemes.kernel import BOOK
from primer.schemes.pointwise import Lanes
from primer.schemes.writer import Writer

BLOCK = 256  # steps made before it is seen whether they must be made again
_NAN = "0x7FF8000000000000"
_ALMOST = "0.9990234375"  # 1 - 2^-10: more than rounding takes from a sum of squares, in either kind


def watch(kind, members):
    """The text of ``march(book)``: advance to step ``until``, or until all members have blown up."""
    loop = _Watch(kind, members)
    loop.write.declare("declare void @llvm.memcpy.p0.p0.i64(ptr, ptr, i64, i1)")
    for name, arguments in (("note", "i64 %step"), ("check", "ptr %quiet"), ("march", "")):
        given = ", ".join(["ptr %book", *filter(None, [arguments])])
        with loop.write.function(name, given, "" if name == "march" else "internal"):
            getattr(loop, name)()
    return loop.write.text


class _Watch:
    def __init__(self, kind, members):
        self.kind, self.members, self.write = kind, members, Writer()
        self.one = Lanes(self.write, kind, 1)

    def book(self, name):
        entry, is_address = BOOK[name]
        kind = "ptr" if is_address else "i64"
        return self.write.load(kind, self.write.at("i64", "%book", entry))

    def integer(self, operation, a, b):
        return self.write.value(f"{operation} i64 {a}, {b}")

    def times(self, a, b):
        return self.integer("mul", a, b)

    def plus(self, a, b):
        return self.integer("add", a, b)

    def number(self, base, index):
        """The number at an index."""
        return self.write.load(self.kind, self.write.at(self.kind, base, index))

    def of(self, m):
        """(first, behind the last) of the lanes of a member."""
        return (m, self.plus(m, 1)) if self.members > 1 else ("0", self.book("slots"))

    def entry(self, clock, line, m):
        return self.write.at("i64", clock, self.plus(line * self.members, m))

    def alive(self, clock, m):
        return self.integer("icmp eq", self.write.load("i64", self.entry(clock, 2, m)), 0)

    def yes(self, variable):
        return self.integer("icmp ne", self.write.load("i64", variable), 0)

    def smaller(self, a, b, relation="slt"):
        return self.write.value(f"select i1 {self.integer(f'icmp {relation}', a, b)}, i64 {a}, i64 {b}")

    def both(self, a, b):
        return self.write.value(f"and i1 {a}, {b}")

    def note(self):
        """After a look: bring each member's clock, records and snapshots up to ``step``."""
        write, kind, clock, every = self.write, self.kind, self.book("clock"), self.book("every")
        shot_steps, limit2 = self.book("shot_steps"), self.number(self.book("limit2"), 0)
        with write.loop("0", self.members) as (m, _, _), write.when(self.alive(clock, m)):
            largest, least = self.found(m)
            write.store("i64", "%step", self.entry(clock, 0, m))
            none = self.integer("icmp slt", write.load("i64", self.entry(clock, 1, m)), 0)
            with write.when(self.both(none, self.one.relation("ule", least, "0.0"))):
                write.store("i64", "%step", self.entry(clock, 1, m))
            with write.when(self.integer("icmp eq", self.integer("srem", "%step", every), 0)):
                cell = self.plus(self.times(self.integer("sdiv", "%step", every), self.members), m)
                write.store(kind, largest, write.at(kind, self.book("dist2"), cell))
                write.store(kind, least, write.at(kind, self.book("u_min"), cell))
            taken = self.entry(clock, 3, m)

            def due():
                then = write.load("i64", write.at("i64", shot_steps, write.load("i64", taken)))
                return self.integer("icmp eq", then, "%step")

            with write.loop_while(due):
                shot = write.load("i64", taken)
                self.keep(shot, m)
                write.store("i64", self.plus(shot, 1), taken)
            with write.when(self.one.relation("ugt", largest, limit2)):
                write.store("i64", "1", self.entry(clock, 2, m))
                self.keep(self.book("shot_count"), m)

    def found(self, m):
        """(largest Dist^2, least u) that a look has found of a member, NaN where something is no number."""
        write, kind, looks, slots = self.write, self.kind, self.book("looks"), self.book("slots")
        start, stop = self.of(m)
        results = []
        for k, relation in ((0, "ogt"), (1, "olt")):
            best = write.variable(kind, self.number(looks, self.plus(self.times(slots, k), start)))
            odd = write.variable("i64", "0")
            with write.loop(start, stop) as (slot, _, _):
                here = self.number(looks, self.plus(self.times(slots, k), slot))
                write.store(kind, self.one.choose(relation, here, write.load(kind, best)), best)
                mark = self.number(looks, self.plus(self.times(slots, 2 + k), slot))
                with write.when(self.one.relation("one", mark, "0.0")):
                    write.store("i64", "1", odd)
            results.append(self.one.pick(self.yes(odd), _NAN, write.load(kind, best)))
        return results

    def keep(self, shot, m):
        """Copy a member's state into ``shots`` (s + 1, rows, n, members)."""
        write, kind, n, rows, reach = self.write, self.kind, *map(self.book, ("n", "rows", "reach"))
        length = self.plus(n, self.times(reach, 2))
        odd = self.integer("and", "%step", 1)
        state = write.at(kind, self.book("w"), self.times(self.times(self.times(odd, rows), length), self.members))
        shots = self.book("shots")
        with write.loop("0", rows) as (f, _, _), write.loop("0", n) as (j, _, _):
            source = self.plus(self.plus(self.times(f, length), reach), j)
            target = self.plus(self.times(self.plus(self.times(shot, rows), f), n), j)
            value = self.number(state, self.plus(self.times(source, self.members), m))
            write.store(kind, value, write.at(kind, shots, self.plus(self.times(target, self.members), m)))

    def check(self):
        """Whether the extremes exclude that u <= 0 or Dist > blow_up_at has happened to a member that is watched."""
        write, kind, clock, slots, one = self.write, self.kind, self.book("clock"), self.book("slots"), self.one
        extremes, bounds, rows = self.book("extremes"), self.book("bounds"), self.book("rows")
        limit2 = one.operation("fmul", self.number(self.book("limit2"), 0), _ALMOST)
        quiet = write.variable("i64", "1")
        with write.loop("0", slots) as (slot, _, _):
            m = slot if self.members > 1 else "0"
            with write.loop("0", rows, 1, [(kind, "0.0")]) as (f, seen, then):
                least, largest = (
                    self.number(extremes, self.plus(self.times(self.plus(self.times(f, 2), side), slots), slot))
                    for side in range(2)
                )
                far = one.choose("ogt", largest, one.operation("fneg", least))
                far = one.operation("fadd", far, self.number(bounds, self.plus(self.times(f, self.members), m)))
                then[0] = one.operation("fadd", seen[0], one.operation("fmul", far, far))
            near = one.relation("ole", seen[0], limit2)
            above = one.relation("ogt", self.number(extremes, slot), "0.0")
            crossed = self.integer("icmp sge", write.load("i64", self.entry(clock, 1, m)), 0)
            fine = self.both(near, write.value(f"or i1 {above}, {crossed}"))
            with write.when(self.both(self.alive(clock, m), write.value(f"xor i1 {fine}, true"))):
                write.store("i64", "0", quiet)
        write.store("i64", write.load("i64", quiet), "%quiet")

    def numbers_only(self, quiet):
        """After a look: what is no number has not been seen by the extremes."""
        write, looks, clock, slots = self.write, self.book("looks"), self.book("clock"), self.book("slots")
        with write.loop("0", slots) as (slot, _, _):
            odd = self.one.relation("one", self.number(looks, self.plus(self.times(slots, 2), slot)), "0.0")
            with write.when(self.both(odd, self.alive(clock, slot if self.members > 1 else "0"))):
                write.store("i64", "0", quiet)

    def march(self):
        """The loop."""
        write = self.write
        clock, every, spare, size = map(self.book, ("clock", "every", "spare", "bytes"))
        sweep, look, shot_steps = map(self.book, ("sweep", "look", "shot_steps"))
        now, running, calm, target, again = (write.variable("i64", value) for value in "00101")
        with write.loop("0", self.members) as (m, _, _):
            step = write.load("i64", self.entry(clock, 0, m))
            write.store("i64", self.smaller(step, write.load("i64", now), "sgt"), now)

        def count_the_living():
            write.store("i64", "0", running)
            with write.loop("0", self.members) as (m, _, _), write.when(self.alive(clock, m)):
                write.store("i64", "1", running)

        def short_of(end):
            return lambda: self.both(self.integer("icmp slt", write.load("i64", now), end()), self.yes(running))

        def copy(back):
            odd = self.integer("and", write.load("i64", now), 1)
            pair = [spare, write.at("i8", self.book("w"), self.times(odd, size))]
            to, source = pair[::-1] if back else pair
            write.put(f"call void @llvm.memcpy.p0.p0.i64(ptr {to}, ptr {source}, i64 {size}, i1 false)")

        count_the_living()
        with write.loop_while(short_of(lambda: self.book("until"))):  # which may be made smaller on the way
            step, until = write.load("i64", now), self.book("until")
            record = self.plus(self.integer("sub", step, self.integer("srem", step, every)), every)
            write.store("i64", self.smaller(self.smaller(until, record), self.plus(step, BLOCK)), target)
            with write.loop("0", self.members) as (m, _, _), write.when(self.alive(clock, m)):
                shot = write.load("i64", write.at("i64", shot_steps, write.load("i64", self.entry(clock, 3, m))))
                with write.when(self.integer("icmp sgt", shot, step)):
                    write.store("i64", self.smaller(shot, write.load("i64", target)), target)
            end = write.load("i64", target)
            many = self.integer("icmp sgt", end, self.plus(step, 1))
            write.store("i64", "1", again)
            with write.when(self.both(many, self.yes(calm))):
                copy(back=False)
                write.put(f"call void {sweep}(ptr %book, i64 {step}, i64 {end})")
                write.put(f"call void {look}(ptr %book, i64 {end})")
                write.put(f"call void @check(ptr %book, ptr {calm})")
                self.numbers_only(calm)
                write.store("i64", self.integer("xor", write.load("i64", calm), 1), again)
                with write.when(self.yes(calm)):
                    write.put(f"call void @note(ptr %book, i64 {end})")
                    write.store("i64", end, now)
                with write.when(self.yes(again)):
                    copy(back=True)
            with write.when(self.yes(again)):
                with write.loop_while(short_of(lambda: write.load("i64", target))):
                    step = write.load("i64", now)
                    following = self.plus(step, 1)
                    write.put(f"call void {sweep}(ptr %book, i64 {step}, i64 {following})")
                    for name in (look, "@note"):
                        write.put(f"call void {name}(ptr %book, i64 {following})")
                    write.store("i64", following, now)
                    count_the_living()
                with write.when(many):
                    write.put(f"call void @check(ptr %book, ptr {calm})")
