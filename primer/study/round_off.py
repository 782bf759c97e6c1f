"""Round-off as the seed: Hadamard's third condition, met in the last bit.

With a = 0.5 and n = 100 exact arithmetic would keep u even and v odd for ever, and the fastest mode has the opposite
symmetry: what grows is the rounding error. So the time of the blow-up depends on the number of digits, on a change of
one unit in the last place, on the order in which three numbers are added; and it depends on each in the same way, by
ln(1/size)/growth.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.checks import instance, integer, real_array, sequence, shown
from primer.problems.toy import Toy, tendency
from primer.schemes.ftcs import ftcs
from primer.schemes.grid import Grid
from primer.schemes.record import plan
from primer.schemes.run import Run, Seed, Stop
from primer.study.spectrum import growth

#: The precision ladder: what ``ftcs`` is told, by name.
PRECISIONS: dict[str, dict[str, Any]] = {
    "float32": {"dtype": np.float32},
    "float64": {"dtype": np.float64},
    "longdouble": {"dtype": np.longdouble},
    "30 digits": {"digits": 30},
    "60 digits": {"digits": 60},
}


def blow_up_time(run):
    """When a ``Run`` blew up; infinite if it did not."""
    return run.t_stop if run.stop is Stop.BLEW_UP else math.inf


def precision_ladder(toy, n, dt, t_end, precisions=tuple(PRECISIONS)):
    """{name: Run} of the same run in the arithmetics of ``PRECISIONS``. The last two are slow."""
    instance("toy", toy, Toy)
    precisions = sequence("precisions", precisions, "names")
    for name in precisions:
        if not isinstance(name, str) or name not in PRECISIONS:
            raise ValueError(f"precisions must be of {', '.join(PRECISIONS)}, got {shown(name)}")
    return {name: ftcs(toy, n, dt, t_end, **PRECISIONS[name]) for name in precisions}


@dataclass(frozen=True, eq=False)
class SeedLadder:
    """Blow-up times from seeds of several amplitudes, and the line through them, T = c + slope ln(1/amplitude).

    ``rate`` is the growth of the fastest mode, as the scheme steps it; the slope should be 1/rate.
    """

    runs: tuple[Run, ...]
    amplitudes: np.ndarray
    times: np.ndarray
    slope: float
    c: float
    rate: float


def seed_ladder(toy, n, dt, t_end, amplitudes, mode=None, field="v"):
    """March from seeds of these amplitudes, by default in the mode n//2 - 1 of v, and fit the line: a ``SeedLadder``.

    Raises
    ------
    ValueError    if fewer than two of the runs blow up by t_end
    """
    instance("toy", toy, Toy)
    amplitudes = np.atleast_1d(real_array("amplitudes", amplitudes))
    if amplitudes.ndim != 1 or amplitudes.size < 2 or (amplitudes <= 0).any():
        raise ValueError(f"amplitudes must be a sequence of two or more numbers > 0, got {shown(amplitudes)}")
    mode = Grid(n).n // 2 - 1 if mode is None else integer("mode", mode, least=0, most=Grid(n).n // 2)
    runs = tuple(ftcs(toy, n, dt, t_end, seed=Seed(mode, x, field)) for x in amplitudes.tolist())
    times = np.array([blow_up_time(run) for run in runs])
    lost = np.isfinite(times)
    if lost.sum() < 2:
        raise ValueError(f"amplitudes must make at least two runs blow up by t_end = {t_end:g}, got {lost.sum()}")
    slope, c = np.polyfit(np.log(1 / amplitudes[lost]), times[lost], 1)
    return SeedLadder(runs, amplitudes, times, float(slope), float(c), growth(toy, n, dt))


@dataclass(frozen=True)
class Nudged:
    """A toy system with one initial value of u moved by so many units in its last place."""

    toy: Toy
    point: int
    ulps: int = 1
    fields = Toy.fields

    def initial(self, x):
        """(u, v) of eq. (toy-initial), nudged."""
        u, v = self.toy.initial(x)
        u[self.point] += self.ulps * np.spacing(u[self.point])
        return u, v

    def __getattr__(self, name):
        return getattr(self.toy, name)


def one_ulp(toy, n, dt, t_end, points):
    """Blow-up times after moving the initial u at one of ``points`` (indices) by one unit in its last place."""
    instance("toy", toy, Toy)
    points = [integer("points", point, least=-Grid(n).n, most=n - 1) for point in sequence("points", points, "indices")]
    return np.array([blow_up_time(ftcs(Nudged(toy, point), n, dt, t_end)) for point in points])


def mirror_symmetric(toy, n, dt, t_end, blow_up_at=1e3):
    """The blow-up time of the same scheme in an order of operations that has the symmetry x -> -x; infinite if none.

    sin x is odd to the last bit on a grid made so, and (v[+1] + v[-1]) - 2 v takes both neighbours alike, where
    ``ftcs`` adds the left one last. Then rounding, too, keeps u even and v odd, and only the slower modes of that
    symmetry are left to grow.
    """
    instance("toy", toy, Toy)
    asked = plan(n, dt, t_end, 10**9, (), None, blow_up_at, np.float64, None)
    asked.refuse_if_large(fields=2)
    n, dt, steps, blow_up_at = asked.grid.n, asked.dt, asked.steps, asked.blow_up_at
    h, m = asked.grid.h, np.arange(n)
    half = np.minimum(m, n - m)  # points from x = -pi, on either side
    sin_x = np.where(m <= n - m, -1.0, 1.0) * np.sin(h * half) * (2 * half != n)
    u, v = np.full(n, toy.a), -sin_x / 2
    steady = toy.a + np.cos(h * half)
    r1, r2 = 1 / (2 * h), 1 / (h * h)
    for step in range(steps + 1):
        if not np.max((u - steady) ** 2 + v**2) <= blow_up_at**2:
            return step * dt
        (u_right, v_right), (u_left, v_left) = (np.roll((u, v), shift, axis=1) for shift in (-1, 1))
        v_xx = ((v_right + v_left) - 2 * v) * r2
        u_t, v_t = tendency(u, v, (u_right - u_left) * r1, (v_right - v_left) * r1, v_xx, sin_x, toy.eps)
        u, v = u + dt * u_t, v + dt * v_t
    return math.inf
