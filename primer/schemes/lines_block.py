"""A problem in the arrays of the compiled loop of the method of lines."""

import ctypes
from functools import lru_cache

import numpy as np

from primer.compiled import machine_code
from primer.schemes.block import address, back, has_numpy_s_bits, rows
from primer.schemes.fourier import MATRIX_UP_TO
from primer.schemes.grid import Stencil
from primer.schemes.lines_kernel import BOOK, lines_kernel
from primer.schemes.marching import grid_of
from primer.schemes.passes import passes
from primer.schemes.slope import PAD, reach, width
from primer.schemes.whole_rows import Numbers, fused

PIECE = 10**7  # rows times points times stages times steps between two looks up


def compilable(problem, n, space):
    """Whether the march can be made by machine code, and NumPy would not be quicker."""
    if not has_numpy_s_bits(problem):
        return False
    orders = problem.evolution.orders
    kinds = {type(space.get(m)) for m in orders}
    if kinds <= {Stencil}:
        return reach({m: space[m] for m in orders}) <= n
    return n <= MATRIX_UP_TO and len(kinds) == 1 and type(None) not in kinds


@lru_cache(maxsize=256)
def _code(evolution, stencils, lanes, form):
    return machine_code(
        lines_kernel(evolution, dict(stencils) if stencils else None, lanes, form, form.fields and fused())
    )


@lru_cache(maxsize=64)
def _matrices(n, h, derivatives):
    """(orders, n, padded): what takes samples to derivatives, f'_i = sum_o f_o D[o, i]; padded with zeros."""
    found = np.zeros((len(derivatives), n, _padded(n)))
    for matrix, derivative in zip(found, derivatives, strict=True):
        matrix[:, :n] = derivative(np.eye(n), h)
    return found


def _padded(n):
    return -(-n // PAD) * PAD


@lru_cache(maxsize=64)
def _table(time):
    """(starts, places, weights, nodes) of a Runge-Kutta step: what is not 0 in its table, with b as a last line."""
    kept = [[(j, weight) for j, weight in enumerate(line) if weight] for line in ((), *time.rows, time.b)]
    starts = np.cumsum([0, *map(len, kept)]).astype(np.int64)
    places = np.array([j for line in kept for j, _ in line], np.int64)
    return starts, places, np.array([weight for line in kept for _, weight in line]), np.array(time.nodes)


class _Loop:
    """What of a march does not change from call to call: code, and arrays that are only read."""

    def __init__(self, problem, n, derivatives, time, is_complex):
        grid, evolution, self.problem, self.time = grid_of(problem, n), problem.evolution, problem, time
        self.x, self.n, self.rows = grid.x, n, len(evolution.fields) * (1 + is_complex)
        differences = all(isinstance(d, Stencil) for _, d in derivatives)
        self.reach = reach(dict(derivatives)) if differences else 0
        self.padded, self.slots = _padded(n), sum(len(stage.slots) for stage in evolution.stages)
        numbers = self.numbers()
        self.form = numbers.form(is_complex)
        plan = passes(evolution, self.form)
        self.scratch, self.calls = plan.rows, bool(plan.calls)
        self.code = _code(evolution, derivatives if differences else None, width("double", n), self.form)
        self.march = self.code.function("march", ctypes.c_void_p)
        scales = [d.scale(grid.h) for _, d in derivatives] if differences else []
        starts, places, weights, nodes = _table(time)
        self.read = {
            "fixed": numbers.fixed(),
            "numbers": numbers.constants(scales),
            "matrices": np.zeros(0) if differences else _matrices(n, grid.h, tuple(d for _, d in derivatives)),
            "starts": starts,
            "places": places,
            "weights": weights,
            "nodes": nodes,
        }
        self.book = np.zeros(len(BOOK), np.int64)
        given = {name: address(array) for name, array in self.read.items()}
        for name, value in (given | {"n": n, "padded": self.padded, "stages": len(nodes)}).items():
            self.book[BOOK[name][0]] = value

    def numbers(self):
        """The numbers of the problem, with rows of their own."""
        return Numbers(self.problem, self.x, np.dtype(float))


@lru_cache(maxsize=64)
def _loop(problem, n, derivatives, time, is_complex):
    return _Loop(problem, n, derivatives, time, is_complex)


def _pieces(counts, most):
    """(first run, one past the last, steps that are made, steps to be made by then), of at most so many steps each."""
    ends, made, run = np.cumsum(counts), 0, 0
    total = int(ends[-1]) if ends.size else 0
    while True:
        until = min(made + most, total)
        last = len(counts) if until == total else int(np.searchsorted(ends, until)) + 1
        yield run, last, made, until
        if until == total:
            return
        made, run = until, last - 1


def marched(problem, x, y, space, time, dt, begin, counts, limit, states, depth, tell):
    """Fill ``states`` and ``depth`` as ``lines.trace`` has them, from the state y of shape (fields, n).

    Piece by piece, a tenth of a second or so, between which there is time to ``tell`` the steps and for a Ctrl-C; no
    bit depends on that.
    """
    derivatives = tuple((m, space[m]) for m in problem.evolution.orders)
    loop = _loop(problem, x.size, derivatives, time, y.dtype.kind == "c")
    numbers = loop.numbers() if loop.form.clock or loop.calls else None
    start = np.array(rows(y))
    stages = len(loop.read["nodes"])
    own = {
        "y": start,
        "k": np.empty((stages, *start.shape)),
        "at_stage": np.zeros((loop.rows, x.size + 2 * loop.reach)),
        "change": np.zeros_like(start),
        "scratch": np.zeros((loop.scratch, x.size + 2 * loop.reach)),
        "derived": np.zeros((2 * loop.slots, loop.padded)),
        "limit": np.array([limit]),
        "deep": np.zeros(1),
    }
    dt, begin = np.ascontiguousarray(dt, float), np.ascontiguousarray(begin, float)
    counts, found = np.asarray(counts, np.int64), np.full((len(dt), *start.shape), np.nan)
    if numbers:
        numbers.prepare(loop.form, x.size, loop.reach, 1)
        own |= {"scratch": numbers.scratch, "clocks": numbers.clocks}
    book = loop.book.copy()
    given = {name: address(array) for name, array in own.items()}
    if numbers:
        given["call"] = numbers.address
    for name, value in given.items():
        book[BOOK[name][0]] = value
    before = np.cumsum(counts) - counts
    for first, last, made, until in _pieces(counts, max(1, PIECE // (start.size * stages))):
        if made:  # the last run of the piece before goes on, if it was not lost
            if not np.isfinite(depth[first]):
                break
            own["deep"][0], found[first], depth[first] = depth[first], np.nan, np.inf
        here = slice(first, last)
        part = {
            "dt": dt[here],
            "begin": begin[here],
            "firsts": np.clip(made - before[here], 0, counts[here]),
            "counts": np.clip(until - before[here], 0, counts[here]),
            "states": found[here],
            "depth": depth[here],
        }
        for name, value in ({name: address(array) for name, array in part.items()} | {"runs": last - first}).items():
            book[BOOK[name][0]] = value
        with np.errstate(all="ignore"):
            loop.march(address(book))
        if numbers:
            numbers.raise_what_was_raised()
        tell(until)
    for state, parts in zip(states, found, strict=True):
        state[:] = back(parts, state.dtype)
