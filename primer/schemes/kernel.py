"""One step of ``primer.ftcs``, and a look at a state, in machine code made from the tree of the equations.

Ghost cells instead of wrap-around indices; every operation as it is written, none contracted or reordered, so that the
bits are those of NumPy.
"""

from primer.schemes.pointwise import pair, parts, scaled
from primer.schemes.slope import Slope, entries

#: What the loop is given, in this order; ``block.Block`` says what each is.
BOOK = entries(
    (
        "w", "scratch", "fixed", "numbers", "clocks", "steady", "bounds", "limit2", "spare", "extremes", "looks",
        "clock", "dist2", "u_min", "shot_steps", "shots", "call", "sweep", "look",
    ),
    ("n", "until", "every", "shot_count", "rows", "reach", "slots", "bytes"),
)  # fmt: skip


def kernel(evolution, stencils, kind, lanes, members, form, fused):
    """The text of two functions: ``sweep(book, from, to)``, which takes steps, and ``look(book, step)``.

    ``kind`` is "float" or "double". With one member an operation serves so many neighbouring points, with more of them
    the members of one point.
    """
    slope = Slope(evolution, stencils, kind, BOOK, lanes, members, form, fused)
    with slope.write.function("sweep", "ptr %book, i64 %from, i64 %to"):
        _sweep(slope)
    with slope.write.function("look", "ptr %book, i64 %step"):
        _look(slope)
    return slope.write.text


def _buffer(slope, w, step, n):
    """The fields' rows after ``step`` steps: in the first buffer if it is even, else in the second."""
    odd = slope.write.value(f"and i64 {step}, 1")
    size = slope.times(slope.length(n, slope.reach), slope.rows)
    return slope.lay(slope.write.at(slope.kind, w, slope.times(odd, size)), n, slope.rows, slope.reach)


def _sweep(slope):
    """Steps; and in ``extremes`` (rows, 2, lanes) the least and the largest values on the way."""
    write, kind, lanes = slope.write, slope.kind, slope.lanes
    n, w, extremes = slope.book("n"), slope.book("w"), slope.book("extremes")
    slope.prepare(n, 1)
    dt, places = slope.number(slope.book("numbers"), 0), [slope.slot(extremes, k) for k in range(2 * slope.rows)]
    for k, place in enumerate(places):
        write.store(lanes.name, slope.first(_buffer(slope, w, "%from", n)[k // 2]), place)
    with write.loop("%from", "%to") as (step, _, _):
        old, new = (slope.paired(_buffer(slope, w, at, n)) for at in (step, slope.plus(step, 1)))
        time = "0.0"
        if slope.form.clock:
            steps, one = write.value(f"sitofp i64 {step} to {kind}"), write.load(kind, slope.book("numbers"))
            time = slope.one.operation("fmul", steps, one)
            time = time if kind == "double" else write.value(f"fpext float {time} to double")

        def finish(place, slopes, seen, then):
            k = 0
            for row, row_new, change in zip(old, new, slopes, strict=True):
                change = scaled(lanes, dt, pair(lanes, change) if slope.form.fields else change)
                before, more = parts(lanes.read(row, place)), parts(change)
                for was, part, target in zip(before, more, parts(row_new), strict=True):
                    value = lanes.operation("fadd", was, part)
                    lanes.keep(value, target, place)
                    then[k], then[k + 1] = lanes.choose("olt", value, seen[k]), lanes.choose("ogt", value, seen[k + 1])
                    k += 2

        ends = slope.evaluate(old, time, finish, [(lanes.name, write.load(lanes.name, place)) for place in places])
        for place, value in zip(places, ends, strict=True):
            write.store(lanes.name, value, place)


def _look(slope):
    """In ``looks`` (4, lanes): the largest Dist^2, the least (real part of the) first field, 1 where no number."""
    write, lanes = slope.write, slope.lanes
    n, looks = slope.book("n"), slope.book("looks")
    state = slope.paired(_buffer(slope, slope.book("w"), "%step", n))
    steady = slope.paired(slope.lay(slope.book("steady"), n, slope.rows, 0))
    u = parts(state[0])[0]
    carried = [(lanes.name, lanes.whole(0)), (lanes.name, slope.first(u)), *2 * [(lanes.truth, lanes.false)]]
    with slope.over(n, carried) as (place, seen, then):
        total = None
        for row, rest in zip(state, steady, strict=True):
            square = None
            for part, other in zip(parts(row), parts(rest), strict=True):
                apart = lanes.operation("fsub", lanes.read(part, place), lanes.read(other, place))
                more = lanes.operation("fmul", apart, apart)
                square = more if square is None else lanes.operation("fadd", square, more)
            total = square if total is None else lanes.operation("fadd", total, square)
        for k, (relation, value) in enumerate((("ogt", total), ("olt", lanes.read(u, place)))):
            then[k] = lanes.choose(relation, value, seen[k])
            then[2 + k] = lanes.either(seen[2 + k], lanes.relation("uno", value, value))
    for k, value in enumerate(seen):
        found = value if k < 2 else lanes.pick(value, lanes.whole(1), lanes.whole(0))
        write.store(lanes.name, found, slope.slot(looks, k))
