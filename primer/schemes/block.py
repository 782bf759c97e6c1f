"""Problems in the arrays of the compiled loop: one alone, or a block of members of one equation side by side."""

import ctypes
from functools import lru_cache

import numpy as np

from primer.compiled import machine_code
from primer.problems.heat import BackwardHeat
from primer.problems.pde import PDE
from primer.problems.toy import Toy
from primer.schemes.grid import CENTRAL
from primer.schemes.kernel import BOOK, kernel
from primer.schemes.passes import passes
from primer.schemes.pointwise import KINDS
from primer.schemes.slope import reach, width
from primer.schemes.watch import watch
from primer.schemes.whole_rows import Numbers, fused

MEMBERS = 8  # of a block: as many numbers as fill one or two vector registers
CHUNK = 2**24  # grid points marched between two looks at the keyboard: about 0.02 s


class _Tally:
    """Steps that runs of one evolution have taken so far, or are about to take: what compiling is weighed against."""

    steps = 0


@lru_cache(maxsize=256)
def tally(evolution):
    """The count of an evolution."""
    return _Tally()


def of_text(problem):
    """Whether a problem's right-hand side is made from its text, and not that of an object of someone's own."""
    return getattr(type(problem), "rhs", None) in (Toy.rhs, BackwardHeat.rhs, PDE.rhs)


def has_numpy_s_bits(problem):
    """Whether machine code would do what NumPy does: always with real numbers, with complex ones as far as is known."""
    return of_text(problem) and not (getattr(problem, "is_complex", False) and fused() is None)


def compilable(problem, n):
    """Whether a problem on n points can be marched by machine code: its right-hand side is that of its text."""
    if not has_numpy_s_bits(problem):
        return False
    stencils = {m: CENTRAL[m] for m in problem.evolution.orders if m in CENTRAL}
    return len(stencils) == len(problem.evolution.orders) and reach(stencils) <= n


def fits_a_block(problem, asked):
    """What problems must have in common to be members of one block, or None where this one must be marched alone."""
    if asked.numbers.dtype not in (np.float32, np.float64) or not compilable(problem, asked.grid.n):
        return None
    _, x, state, _ = asked.start(problem)
    form = Numbers(problem, x, state.real.dtype).form(state.dtype.kind == "c")
    return None if form.clock or passes(problem.evolution, form).calls else (problem.evolution, form)


@lru_cache(maxsize=256)
def _step(evolution, kind, lanes, members, form):
    """The code of the paper's step for an evolution."""
    return machine_code(kernel(evolution, CENTRAL, kind, lanes, members, form, form.fields and fused()))


@lru_cache
def _loop(kind, members):
    """The code of the loop around any step."""
    return machine_code(watch(kind, members))


class Block:
    """``size`` places for problems with one evolution, members innermost; places left over rest.

    asked       the ``Plan`` of the run
    problems    at most ``size`` of them, with numbers of one machine kind
    size        1, or ``MEMBERS``
    """

    def __init__(self, asked, problems, size=1):
        self.asked, self.problems, self.size, self.halted = asked, problems, size, False
        evolution = problems[0].evolution
        starts = [asked.start(problem) for problem in problems]
        self.logs = [log for _, _, _, log in starts]
        _, x, state, _ = starts[0]
        kind, self.real = KINDS[state.dtype.name], state.real.dtype
        numbers = [Numbers(problem, x, self.real) for problem, (_, x, _, _) in zip(problems, starts, strict=True)]
        form = numbers[0].form(state.dtype.kind == "c")
        stencils = {m: CENTRAL[m] for m in evolution.orders}
        self.reach = reach(stencils)

        def side_by_side(arrays):
            arrays = list(arrays)
            return np.ascontiguousarray(np.stack(arrays + (size - len(arrays)) * arrays[-1:], axis=-1))

        states = [rows(state) for _, _, state, _ in starts]
        ghosts = (0, 0), (0, 0), (self.reach, self.reach)
        scalars = [[asked.dt, *(stencil.scale(h) for stencil in stencils.values())] for h, _, _, _ in starts]
        steady = side_by_side(rows(np.array(log.steady, dtype=state.dtype)) for log in self.logs)
        slots = size if size > 1 else width(kind, x.size)
        code, loop = _step(evolution, kind, slots, size, form), _loop(kind, size)
        w = side_by_side(np.pad(np.stack([state, state]), ghosts) for state in states)
        self.numbers = numbers[0]
        self.numbers.prepare(form, x.size, self.reach, size)
        clock = side_by_side(np.array(log.clock, np.int64) for log in self.logs)
        clock[2, len(problems) :] = 1
        shots = ([*(rows(shot) for shot in log.shots), state] for log, state in zip(self.logs, states, strict=True))
        self.arrays = {
            "w": w,  # (2, rows, n + 2 reach, members): step k is in buffer k % 2, with ghost cells
            "scratch": self.numbers.scratch,
            "fixed": side_by_side(n.fixed() for n in numbers),
            "numbers": side_by_side(n.constants(first) for n, first in zip(numbers, scalars, strict=True)),
            "clocks": self.numbers.clocks,
            "steady": steady,
            "bounds": np.abs(steady).max(axis=1),  # (rows, members): how far from 0 the steady state is
            "limit2": np.array([self.logs[0].limit], self.real),
            "spare": np.zeros_like(w[0]),
            "extremes": np.zeros((2 * w.shape[1], slots), self.real),
            "looks": np.zeros((4, slots), self.real),
            "clock": clock,  # (4, members): step, first step with u <= 0 or -1, 1 once blown up, snapshots taken
            "dist2": side_by_side(log.dist2 for log in self.logs),  # (records, members)
            "u_min": side_by_side(log.u_min for log in self.logs),
            "shot_steps": np.append(asked.shot_steps, -1).astype(np.int64),  # and an end that no step is equal to
            "shots": side_by_side(np.array(taken) for taken in shots),  # behind them the state of who blew up
        }
        self.clock, self.dist2, self.u_min, self.shots = (
            self.arrays[name] for name in ("clock", "dist2", "u_min", "shots")
        )
        self.book = np.zeros(len(BOOK), np.int64)
        given = {name: address(array) for name, array in self.arrays.items()} | {
            "call": self.numbers.address, "sweep": code.address("sweep"), "look": code.address("look"),
            "n": x.size, "every": asked.every, "shot_count": len(asked.times), "rows": w.shape[1],
            "reach": self.reach, "slots": slots, "bytes": w[0].nbytes,
        }  # fmt: skip
        for name, value in given.items():
            self.book[BOOK[name][0]] = value
        self.code, self.loop = code, loop.function("march", ctypes.c_void_p)

    def march(self, tell=lambda step: None):
        """March to the end, looking up now and then to ``tell`` the step; :meth:`runs` has the outcome."""
        asked = self.asked
        with np.errstate(all="ignore"):
            while self.clock[2].min() == 0 and self.clock[0].max() < asked.steps and not self.halted:
                until = min(self.clock[0].max() + CHUNK // self.arrays["w"][0].size + 1, asked.steps)
                self.book[BOOK["until"][0]] = until
                self.numbers.stop = self.stop
                self.loop(address(self.book))
                self.numbers.raise_what_was_raised()
                tell(self.clock[0].max())

    def stop(self):
        """Let the loop come to an end soon."""
        self.book[BOOK["until"][0]] = 0

    def runs(self, interrupted=False):
        """Yield the finished runs of the members."""
        w = self.arrays["w"]
        fields = w[:, :, self.reach : w.shape[2] - self.reach]
        for m, (problem, log) in enumerate(zip(self.problems, self.logs, strict=True)):
            log.clock[:], log.dist2[:], log.u_min[:] = self.clock[:, m], self.dist2[:, m], self.u_min[:, m]
            for place, shot in enumerate(self.shots[:-1, ..., m]):
                log.shots[place] = back(shot, log.shots.dtype)
            step, _, blown_up, _ = log.clock
            state = self.shots[-1, ..., m] if blown_up else fields[step % 2, ..., m]
            yield log.run(problem, back(state, log.shots.dtype), interrupted and log.running)


def address(array):
    """Where its numbers are."""
    return array.__array_interface__["data"][0]


def rows(state):
    """A state (fields, n), the parts of complex fields one behind the other."""
    return np.stack([state.real, state.imag], 1).reshape(-1, state.shape[1]) if state.dtype.kind == "c" else state


def back(parts, dtype):
    """The state of such rows, in an array of its own."""
    if dtype.kind != "c":
        return parts.copy()
    state = np.empty((len(parts) // 2, *parts.shape[1:]), dtype)
    state.real, state.imag = parts[::2], parts[1::2]
    return state
