"""Whose fault is it? Four computations that blow up or change with the grid, for notebook 04: one of each kind.

Three are equations with data, a grid and a step; of the fourth only a function is known. Guess before you ask
``diagnose`` and ``examine``. ``PROGRAMS`` are more functions, for an exercise.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.problems.pde import PDE
from primer.schemes.runge_kutta import RK4, RungeKutta
from primer.study.diagnosis import Diagnosis, diagnose


@dataclass(frozen=True)
class Suspect:
    """A computation: what is marched, on how many points, with which step, to which time.

    Equations beyond the paper's: a thin layer that separates, two layers of water that slide over each other, a flame.
    """

    problem: Any
    n: int
    dt: float
    t_end: float
    time: RungeKutta = RK4

    def diagnose(self) -> Diagnosis:
        """What ``primer.diagnose`` says of it."""
        return diagnose(self.problem, self.n, self.dt, self.t_end, time=self.time)


_LAYERS = "h_t = -(h*(1 - h)*s)_x; s_t = -(s^2*(1 - 2*h)/2 + h)_x"

#: The suspects: separation (Cahn & Hilliard 1958), layers (between two lids, s the difference of their velocities), and
#: a flame front (Sivashinsky 1977).
SUSPECTS = {
    "a mixture that separates": Suspect(
        PDE("u_t = (u^3 - u - 0.01*u_xx)_xx", {"u": "0.1 + 0.01*cos(3*x)"}), n=100, dt=4e-4, t_end=1.0
    ),
    "two layers of water": Suspect(PDE(_LAYERS, {"h": "0.5 + 0.01*cos(x)", "s": "1.5"}), n=64, dt=1e-3, t_end=8.0),
    "a flame front": Suspect(
        PDE("u_t = -u*u_x - u_xx - u_xxxx", {"u": "cos(x/16)*(1 + sin(x/16))"}, period=32 * math.pi),
        n=128, dt=1e-2, t_end=60.0,
    ),
}  # fmt: skip


def stranger(fields, dt):
    """One step of somebody's program for u_t + u_x = 0.01 u_xx on [0, 2 pi): something in it is wrong."""
    u, h = fields, 2 * np.pi / fields.shape[-1]
    u_x = (np.roll(u, -1, axis=-1) - np.roll(u, 1, axis=-1)) / (2 * h)
    u_xx = (np.roll(u, 1, axis=-1) - 2 * u + np.roll(u, -1, axis=-1)) / h**2
    return u - dt * (u_x + 0.01 * u_xx)


def strangers_state(n):
    """The state at rest of that program: u = 1."""
    return np.ones((1, n))


@dataclass(frozen=True)
class Program:
    """A solver that is only given as a function: ``step(fields, dt)``, a state at rest ``state(n)``, and a step dt."""

    step: Any
    state: Any
    dt: float


def _differences(u):
    """(u_x, u_xx) by central differences on [0, 2 pi)."""
    left, right, h = np.roll(u, 1, axis=-1), np.roll(u, -1, axis=-1), 2 * np.pi / u.shape[-1]
    return (right - left) / (2 * h), (left - 2 * u + right) / h**2


def _warm(u, dt):
    return u + dt * 0.5 * _differences(u)[1]


def _drifting(u, dt):
    u_x, u_xx = _differences(u)
    return u + dt * (u_x + 0.05 * u_xx)


def _two_phases(u, dt):
    return u + dt * (u - u**3 + 0.01 * _differences(u)[1])


def _steepening(u, dt):
    """u_t = -u u_x - 0.02 u_xx from u = 1."""
    u_x, u_xx = _differences(u)
    return u - dt * (u * u_x + 0.02 * u_xx)


def _string(fields, dt):
    """u_tt = u_xx by forward Euler: (u, u_t)."""
    u, u_t = fields
    return np.stack([u + dt * u_t, u_t + dt * _differences(u)[1]])


def _flat(*values):
    return lambda n: np.outer(values, np.ones(n))


#: Programs for exercise 4.5, with the grids of ``examine`` left as they are.
PROGRAMS = (
    Program(_steepening, _flat(1.0), 1e-4),
    Program(_warm, _flat(1.0), 2e-3),
    Program(_two_phases, _flat(0.0), 1e-3),
    Program(_drifting, _flat(1.0), 1e-3),
    Program(_string, _flat(0.0, 0.0), 1e-2),
)
