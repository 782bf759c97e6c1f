"""The accurate reference for the toy system: an answer with an error bar, or a refusal."""

import math
from dataclasses import dataclass, field

import numpy as np

from primer.checks import real, real_array, shown
from primer.problems.toy import Toy
from primer.schemes.fourier import FOURIER, interpolate, transfer
from primer.schemes.grid import Grid
from primer.schemes.lines import trace
from primer.schemes.runge_kutta import RK8

MODES = (8, 16, 24, 32, 48, 64, 96, 128)  # grid points tried in turn; multiples of 8 fill the vector registers
MAX_STEPS = 10**7
_SAFETY = 2.0
_ULP = np.finfo(float).eps


class PastHorizon(ArithmeticError):
    """The reference has no answer at the time asked for; ``horizon`` is the time up to which it has one."""

    def __init__(self, message, horizon):
        super().__init__(message)
        self.horizon = horizon

    def __reduce__(self):
        return type(self), (self.args[0], self.horizon)


@dataclass(frozen=True, eq=False)
class Reference:
    """What :func:`reference` gives back; everything is dimensionless, arrays are read-only."""

    toy: Toy
    tol: float
    x: np.ndarray = field(repr=False)
    t: np.ndarray = field(repr=False)
    u: np.ndarray = field(repr=False)
    v: np.ndarray = field(repr=False)
    error: np.ndarray = field(repr=False)
    horizon: float

    def at(self, x):
        x = real_array("x", x)
        return interpolate(self.u, x), interpolate(self.v, x)


def pair(toy, t, rung, tol):
    n, m = MODES[rung], MODES[rung + 1]
    gaps = np.diff(t, prepend=0.0)
    counts = np.ceil(gaps / step_size(toy, n, tol))
    more = np.maximum(np.ceil(1.5 * counts), np.ceil(gaps / step_size(toy, m, tol)))
    states, _ = trace(toy, Grid(n), FOURIER, RK8, t, counts.astype(np.int64))
    finer, depth = trace(toy, Grid(m), FOURIER, RK8, t, more.astype(np.int64))
    return states, finer, depth


def step_size(toy, n, tol):
    k = n // 2
    damping = 1 + toy.eps * (abs(toy.a) + 1.25) * k * k
    fastest = max(k, (damping + math.sqrt(max(0.0, damping**2 - 4 * k * k))) / 2)
    return min(0.9 * RK8.reach / fastest, 0.45 * (tol / 1e-10) ** (1 / 8))
