"""Toy systems in the arrays of the compiled loop: one alone, or a block of members side by side."""

import numpy as np

from primer.compiled import compiled
from primer.schemes.grid import CENTRAL

KERNEL = "primer.schemes.kernel"
CHUNK = 2**25  # grid points marched between two looks at the keyboard: about 0.02 s


class Block:
    """``size`` places for toy systems, members innermost; places left over are held by a system at rest.

    asked       the ``Plan`` of the run
    problems    at most ``size`` toy systems
    size        a key of ``kernel.MARCH``
    """

    def __init__(self, asked, problems, size=1):
        self.asked, self.problems, self.size, self.halted = asked, problems, size, False
        starts = [asked.start(problem) for problem in problems]
        self.logs = [log for _, _, _, log in starts]
        spare = size - len(problems)
        h, x, _, _ = starts[0]
        number = asked.numbers.number

        def side_by_side(arrays):
            arrays = list(arrays)
            return np.stack(arrays + spare * arrays[-1:], axis=-1)

        def cells(arrays):
            stacked = side_by_side(arrays)
            return stacked.reshape(*stacked.shape[:-2], -1)

        def eps(problem):
            with np.errstate(over="ignore"):  # an eps beyond the largest number is infinite: a blow-up
                return np.full(x.size + 2, problem.eps, dtype=x.dtype)

        states = [state for _, _, state, _ in starts]
        ghosts = (0, 0), (0, 0), (1, 1)
        self.w = cells([np.pad(np.stack([state, state]), ghosts) for state in states])
        self.clock = side_by_side(log.clock for log in self.logs)
        self.clock[2, len(problems) :] = 1
        self.dist2 = side_by_side(log.dist2 for log in self.logs)
        self.u_min = side_by_side(log.u_min for log in self.logs)
        self.shots = side_by_side([[*log.shots, state] for log, state in zip(self.logs, states, strict=True)])
        self.fixed = (
            cells([np.pad(problem.forcing(x), 1) for problem in problems]),
            cells([np.pad(log.steady[0], 1) for log in self.logs]),
            number(CENTRAL[1].scale(h)),
            number(CENTRAL[2].scale(h)),
            number(asked.dt),
            cells([eps(problem) for problem in problems]),
            number(asked.blow_up_at),
            number(asked.blow_up_at * 1e-6),
        )

    def march(self, tell=lambda step: None):
        """March to the end, looking up now and then to ``tell`` the step; :meth:`runs` has the outcome."""
        asked = self.asked
        while self.clock[2].min() == 0 and self.clock[0].max() < asked.steps and not self.halted:
            until = min(self.clock[0].max() + CHUNK // self.w.shape[2] + 1, asked.steps)
            records = asked.every, self.dist2, self.u_min, asked.shot_steps, self.shots
            compiled(KERNEL).MARCH[self.size](self.w, *self.fixed, self.clock, until, *records)
            tell(self.clock[0].max())

    def runs(self, interrupted=False):
        """Yield the finished runs of the members."""
        fields = self.w.reshape(2, 2, -1, self.size)[:, :, 1:-1]
        for m, (problem, log) in enumerate(zip(self.problems, self.logs, strict=True)):
            log.clock[:], log.dist2[:], log.u_min[:] = self.clock[:, m], self.dist2[:, m], self.u_min[:, m]
            log.shots[:] = self.shots[:-1, ..., m]
            step, _, blown_up, _ = log.clock
            state = self.shots[-1, ..., m] if blown_up else fields[step % 2, ..., m]
            yield log.run(problem, state.copy(), interrupted and log.running)
