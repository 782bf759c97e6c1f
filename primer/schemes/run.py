"""What a marched problem gives back: a frozen ``Run``, why it stopped, and the seed that was put in."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np

from primer.arithmetic import cos, points
from primer.checks import integer, real, shown
from primer.types import ArrayLike


class Stop(StrEnum):
    """Why a run stopped. A blow-up is an outcome, not an error.

    Figures 4 to 6 of the paper end as REACHED_END, BLEW_UP and REACHED_END.

    >>> Stop("blew_up") is Stop.BLEW_UP, str(Stop.BLEW_UP)
    (True, 'blew_up')
    """

    REACHED_END = "reached_end"
    BLEW_UP = "blew_up"
    INTERRUPTED = "interrupted"


@dataclass(frozen=True)
class Seed:
    """A stated perturbation of the initial data: amplitude cos(mode x + phase) is added to one field.

    The default phase gives the even and the odd part the same weight, so that no symmetry of the problem can hide a
    growing mode: [cos(mode x) + sin(mode x)] amplitude/sqrt(2).

    Raises
    ------
    TypeError, ValueError    if mode is not an integer >= 0, or amplitude or phase is not finite, or field is no text

    Added to eq. (toy-initial), it stands in for round-off.

    >>> bump = Seed(mode=3, amplitude=1e-6, phase=0.0)
    >>> print(f"{bump(0.0):.1e}")
    1.0e-06
    """

    mode: int
    amplitude: float
    field: str = "u"
    phase: float = -math.pi / 4

    def __post_init__(self) -> None:
        object.__setattr__(self, "mode", integer("seed mode", self.mode, least=0))
        object.__setattr__(self, "amplitude", real("seed amplitude", self.amplitude))
        object.__setattr__(self, "phase", real("seed phase", self.phase))
        if not isinstance(self.field, str):
            raise TypeError(f"seed field must be the name of a field, such as 'u', got {shown(self.field)}")

    def __call__(self, x: ArrayLike) -> np.ndarray:
        """The perturbation at x, of the shape of x; another period than 2 pi is scaled to that first."""
        return self.amplitude * cos(self.mode * points(x) + self.phase)


@dataclass(frozen=True, eq=False)
class Run:
    """The record of one marched problem; see :func:`primer.ftcs`. Times are dimensionless; arrays are read-only.

    Attributes
    ----------
    problem, n, dt      what was marched, on how many points, with which step
    x                   (n,) the grid
    t                   (r,) recorded times, the last one t_stop
    dist                (r,) Dist of eq. (toy-err): max over the grid of the distance to the steady state
    u_min               (r,) min over the grid of u
    snapshots           time asked for -> fields, each of shape (n,); times that the run did not reach are absent
    final               the fields at t_stop, each of shape (n,)
    t_first_negative    first time with u <= 0 somewhere (the paper's dashed line), or None; every step is looked at
    stop, t_stop        why and when the run stopped
    seed                the perturbation that was added to the initial data, or None
    blow_up_at          the Dist above which the run counts as blown up

    >>> from primer import Toy, ftcs
    >>> run = ftcs(Toy(1.5), n=30, t_end=5.0)
    >>> print(run.stop, run.x.shape, len(run.final), run.t_first_negative)
    reached_end (30,) 2 None
    """

    problem: Any
    n: int
    dt: float
    x: np.ndarray = field(repr=False)
    t: np.ndarray = field(repr=False)
    dist: np.ndarray = field(repr=False)
    u_min: np.ndarray = field(repr=False)
    snapshots: Mapping[float, tuple[np.ndarray, ...]] = field(repr=False)
    final: tuple[np.ndarray, ...] = field(repr=False)
    t_first_negative: float | None
    stop: Stop
    t_stop: float
    seed: Seed | None = None
    blow_up_at: float = math.inf

    @property
    def dist_from(self) -> str:
        """From what Dist is measured: "steady", or "initial" where a ``PDE`` has no steady state."""
        return getattr(self.problem, "dist_from", "steady")

    def __post_init__(self) -> None:
        for array in (self.x, self.t, self.dist, self.u_min, *self.final, *sum(self.snapshots.values(), ())):
            array.flags.writeable = False
