"""The time loop of the method of lines in machine code, made from the tree of the equations.

One text serves every Runge-Kutta table, which is an argument. Nothing is contracted or reordered.
"""

from primer.schemes.slope import Slope, entries

#: What the loop is given, in this order; see ``lines._compiled``.
BOOK = entries(
    (
        "y", "k", "at_stage", "change", "scratch", "fixed", "numbers", "clocks", "matrices", "derived",
        "starts", "places", "weights", "nodes", "dt", "begin", "firsts", "counts", "deep",
        "limit", "states", "depth", "call",
    ),
    ("n", "padded", "stages", "runs"),
)  # fmt: skip


def lines_kernel(evolution, stencils, lanes, form, fused):
    """The text of ``march(book)``; ``stencils`` is None where derivatives are products with matrices.

    It takes the steps firsts[m] ... counts[m] - 1 of dt[m] for m = 0, 1, ..., as long as every |number| <= limit at
    each stage of each step, so that no product is beyond the largest number. What it is given:

    y                  (rows, n) the state, overwritten; complex fields have two rows
    k, at_stage        (stages, rows, n) slopes, and the rows with ghost cells at which they are taken
    change             (rows, n) zeros at first: what rounding took from y, and goes into the next change (Kahan's sum)
    starts, places,    the table A of the step by its entries that are not 0: those of stage s are starts[s] ...
    weights            starts[s + 1] - 1; a last "stage" has the weights b
    nodes              (stages,) sums of the lines of A
    begin              (m,) the times at which the runs of steps begin
    states             (m, rows, n) filled with the states after each run of steps; those not reached are left alone
    deep               (1,) the depth so far, 0 at first
    depth              (m,) filled with the integral of max(0, -min u) to those times, by the rectangle rule
    """
    slope = Slope(evolution, stencils, "double", BOOK, lanes, 1, form, fused)
    truth = slope.lanes.truth
    slope.write.declare(f"declare i1 @llvm.vector.reduce.or.v{lanes}i1({truth})")
    slope.write.declare("declare void @llvm.memcpy.p0.p0.i64(ptr, ptr, i64, i1)")
    with slope.write.function("march", "ptr %book"):
        _march(slope)
    return slope.write.text


def _march(slope):
    write, one, lanes = slope.write, slope.one, slope.lanes
    n, runs, stages = slope.book("n"), slope.book("runs"), slope.book("stages")
    slope.prepare(n)
    y, change = (slope.lay(slope.book(name), n, slope.rows, 0) for name in ("y", "change"))
    at_stage = slope.lay(slope.book("at_stage"), n, slope.rows, slope.reach)
    k, size = slope.book("k"), slope.times(n, slope.rows)
    starts, places, weights = slope.book("starts"), slope.book("places"), slope.book("weights")
    limit = lanes.splat(one.read(slope.book("limit"), "0"))
    dts, begin, counts, nodes = (slope.book(name) for name in ("dt", "begin", "counts", "nodes"))
    firsts = slope.book("firsts")
    states, depth = slope.book("states"), slope.book("depth")
    deep = slope.book("deep")

    def combined(stage, row, base, dt, few, i):
        """base + sum of dt A[stage, j] k_j at the points of index i."""
        first, last = (write.load("i64", write.at("i64", starts, at)) for at in (stage, slope.plus(stage, 1)))
        with write.loop(first, last, 1, [(few.name, base)]) as (entry, seen, then):
            weight = one.operation("fmul", dt, write.load("double", write.at("double", weights, entry)))
            place = slope.times(write.load("i64", write.at("i64", places, entry)), size)
            cell = slope.plus(slope.plus(place, slope.times(n, row)), i)
            then[0] = few.operation("fadd", seen[0], few.operation("fmul", few.splat(weight), few.read(k, cell)))
        return seen[0]

    def leave_if_beyond(rows):
        """Return where a number in one of the rows is beyond the limit."""
        beyond = lanes.false
        for row in rows:
            with slope.over(n, [(lanes.truth, beyond)]) as (i, seen, then):
                size_of = lanes.function("fabs", lanes.read(row, i))
                then[0] = lanes.either(seen[0], lanes.relation("ugt", size_of, limit))
            beyond = seen[0]
        write.leave_if(write.value(f"call i1 @llvm.vector.reduce.or.v{lanes.width}i1({lanes.truth} {beyond})"))

    with write.loop("0", runs) as (m, _, _):
        dt, first, count, since = (
            write.load(kind, write.at(kind, base, m))
            for kind, base in (("double", dts), ("i64", firsts), ("i64", counts), ("double", begin))
        )
        with write.loop(first, count) as (step, _, _):
            with write.loop("0", n, 1, [("double", "0.0")]) as (i, seen, then):
                then[0] = one.choose("olt", one.read(y[0], i), seen[0])
            more = one.operation("fmul", dt, seen[0])
            write.store("double", one.operation("fsub", write.load("double", deep), more), deep)
            done = one.operation("fmul", write.value(f"sitofp i64 {step} to double"), dt)
            now = one.operation("fadd", since, done)
            with write.loop("0", stages) as (stage, _, _):
                for row in range(slope.rows):
                    with slope.over(n) as (i, _, _):
                        lanes.keep(combined(stage, row, lanes.read(y[row], i), dt, lanes, i), at_stage[row], i)
                leave_if_beyond(at_stage)
                node = write.load("double", write.at("double", nodes, stage))
                time = one.operation("fadd", now, one.operation("fmul", node, dt))
                mine = write.at("double", k, slope.times(stage, size))
                target = slope.paired(slope.lay(mine, n, slope.rows, 0))

                def finish(place, slopes, seen, then, target=target):
                    for value, row in zip(slopes, target, strict=True):
                        lanes.keep(value, row, place)

                slope.evaluate(slope.paired(at_stage), time, finish)
            whole = slope.times(write.value(f"udiv i64 {n}, {lanes.width}"), lanes.width)
            for row in range(slope.rows):  # what is overwritten must not be done twice: the last points one by one
                for few, first, last in ((lanes, "0", whole), (one, whole, n)):
                    with write.loop(first, last, few.width) as (i, _, _):
                        total = combined(stages, row, few.read(change[row], i), dt, few, i)
                        was = few.read(y[row], i)
                        new = few.operation("fadd", was, total)
                        few.keep(new, y[row], i)
                        few.keep(few.operation("fsub", total, few.operation("fsub", new, was)), change[row], i)
            leave_if_beyond(y)
        to = write.at("double", states, slope.times(m, size))
        write.put(f"call void @llvm.memcpy.p0.p0.i64(ptr {to}, ptr {y[0]}, i64 {slope.times(size, 8)}, i1 false)")
        write.store("double", write.load("double", deep), write.at("double", depth, m))
