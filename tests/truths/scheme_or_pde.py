"""The answers of notebook 04 by other routes than the checkers take."""

import math
import re

import numpy as np

from primer import Stop, Toy, exercises, ftcs
from primer.study.spectrum import jacobian
from primer.study.stability import amplification_over_modes
from truths.reading import numbers


def truth_04_1(seed):
    """By bisection on the amplification of the sawtooth's larger root."""
    a, eps, n = numbers(exercises.ask_04_1(seed))[:3]
    low, high = 0.0, 1.0
    while high - low > 1e-9 * high:
        dt = (low + high) / 2
        low, high = (low, dt) if amplification_over_modes(Toy(a, eps), int(n), dt, a + 1)[1][-1, 0] > 1 else (dt, high)
    return low


def truth_04_2(seed):
    """From the spectrum of the dense Jacobian."""
    a, n = re.search(r"a = (\S+) on N = (\d+)", exercises.ask_04_2(seed)).groups()
    return np.linalg.eigvals(jacobian(Toy(float(a)), int(n))).real.max()


def truth_04_3(seed):
    """By marching, and marching again with a smaller step."""
    found = re.search(r"a = (\S+), eps = (\S+), N = (\d+), dt = (\S+), to t = (\d+)", exercises.ask_04_3(seed))
    a, eps, n, dt, t_end = map(float, found.groups())
    run = ftcs(Toy(a, eps), int(n), dt, t_end)
    if run.stop is Stop.REACHED_END:
        return "hidden" if a < 1 else "converges" if run.t_first_negative is None else "transient"
    gentle = ftcs(Toy(a, eps), int(n), dt / 8, min(t_end, 4 * math.ceil(run.t_stop)))
    if gentle.stop is Stop.REACHED_END and gentle.t_stop > 1.5 * run.t_stop:
        return "scheme"
    return "ill-posed" if a < 1 else "transient"


def truth_04_5(seed):
    """From the matrix of one step on two grids, column by column: of the step asked about, and of a tiny one."""
    from primer.scenes.whose_fault import PROGRAMS

    program = PROGRAMS[int(re.search(r"PROGRAMS\[(\d)\]", exercises.ask_04_5(seed))[1])]

    def growth(n, dt):
        base = program.state(n)
        columns = [
            program.step(base + 1e-6 * e.reshape(base.shape), dt)
            - program.step(base - 1e-6 * e.reshape(base.shape), dt)
            for e in np.eye(base.size)
        ]
        factors = np.abs(np.linalg.eigvals(np.array([c.ravel() for c in columns]).T / 2e-6))
        return np.log(factors.max()) / dt

    asked, gentle = growth(256, program.dt), [growth(n, 1e-6) for n in (64, 128)]
    if gentle[0] > 1e-3 and gentle[1] > 1e-3:
        return "ill-posed" if gentle[1] > 1.5 * gentle[0] else "unstable"
    return "scheme" if asked > 1e-3 else "stable"
