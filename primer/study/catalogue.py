"""Hard cases: runs of the toy system that a rule of thumb gets wrong, each with what must happen and why."""

from dataclasses import dataclass

import numpy as np

from primer.problems.toy import Toy
from primer.schemes.ftcs import ftcs
from primer.schemes.run import Seed
from primer.study.diagnosis import Kind, diagnose


@dataclass(frozen=True)
class HardCase:
    """A run, the ``Kind`` it is of, whether it blows up by t_end, and why."""

    name: str
    toy: Toy
    n: int
    dt: float
    t_end: float
    kind: Kind
    blows_up: bool
    why: str
    seed: Seed | None = None
    dtype: type = np.float64

    def march(self):
        """The ``Run``."""
        return ftcs(self.toy, self.n, self.dt, self.t_end, seed=self.seed, dtype=self.dtype)

    def diagnose(self):
        """The ``Diagnosis``."""
        return diagnose(self.toy, self.n, self.dt, self.t_end, seed=self.seed, dtype=self.dtype)


_PAPER = Toy(0.5, 0.01)
_BELOW = "below the threshold n = 64 nothing grows on the steady state, though frozen coefficients say so from 45 on"
_HELD = (
    "it grows, but so slowly that each step of the growth is lost in the last bit of u: round-off never gets through"
)

HARD_CASES = (
    HardCase("62 points", _PAPER, 62, 1e-3, 2000.0, Kind.HIDDEN, False, _BELOW),
    HardCase("63 points", _PAPER, 63, 1e-3, 2000.0, Kind.HIDDEN, False, _BELOW),
    HardCase("64 points", _PAPER, 64, 1e-3, 2000.0, Kind.HIDDEN, False, _HELD),
    HardCase("65 points", _PAPER, 65, 1e-3, 2000.0, Kind.HIDDEN, False, _HELD),
    HardCase("66 points", _PAPER, 66, 1e-3, 2000.0, Kind.ILL_POSED, True, "growth 0.09 outruns the last bit"),
    HardCase(
        "64 points, seeded", _PAPER, 64, 1e-3, 2000.0, Kind.ILL_POSED, True,
        "a seed not lost in the last bit shows the growth of 0.025 that round-off could not", Seed(31, 1e-6, "v"),
    ),
    HardCase("a = 1.05, coarse", Toy(1.05), 400, 1e-3, 100.0, Kind.TRANSIENT, False,
        "u < 0 for a while, but what grows on 400 points in that while stays small"),
    HardCase("a = 1.05, fine", Toy(1.05), 800, 5e-4, 100.0, Kind.TRANSIENT, True,
        "the same while is long enough for 800 points: the growth rate goes as n^2"),
    HardCase("a = 1.15, coarse", Toy(1.15), 800, 5e-4, 100.0, Kind.TRANSIENT, False, "u < 0 is shallow and short"),
    HardCase("a = 1.15, fine", Toy(1.15), 1200, 2e-4, 100.0, Kind.TRANSIENT, True, "but not for 1200 points"),
    HardCase("a = 1", Toy(1.0), 100, 1e-3, 100.0, Kind.TRANSIENT, False,
        "the steady state touches zero at one point, and no grid in use is unstable there"),
    HardCase("dt too large", Toy(1.5), 1000, 1e-3, 20.0, Kind.SCHEME, True,
        "dt = 1e-3 is beyond 2/(1 + 4 eps u/h^2) at u = 2.5: the stiffest mode overshoots"),
    HardCase("half of that dt", Toy(1.5), 1000, 5e-4, 20.0, Kind.CONVERGES, False, "below the limit nothing grows"),
    HardCase("eps = 0, 300 points", Toy(0.5, 0.0), 300, 1e-3, 100.0, Kind.SCHEME, True,
        "waves need dt < h^2 = 4.4e-4; they grow by (dt/h^2 - 1)/2 = 0.64 per unit time"),
    HardCase("eps = 0, 400 points", Toy(0.5, 0.0), 400, 1e-3, 100.0, Kind.SCHEME, True, "h^2 = 2.5e-4: sooner still"),
    HardCase("eps = 0, small dt", Toy(-3.0, 0.0), 300, 4e-4, 100.0, Kind.CONVERGES, False,
        "without the second derivative the equations are well posed for every a"),
    HardCase("tiny eps", Toy(0.5, 1e-6), 200, 5e-4, 100.0, Kind.HIDDEN, False, "no grid under 6325 points sees it"),
    HardCase("large eps", Toy(0.5, 1.0), 16, 1e-3, 100.0, Kind.ILL_POSED, True, "even 6 points see it"),
    HardCase("large eps, well posed", Toy(1.5, 1.0), 64, 1e-3, 100.0, Kind.CONVERGES, False,
        "u stays positive, however large eps"),
    HardCase("a very negative", Toy(-10.0), 20, 1e-3, 100.0, Kind.ILL_POSED, True, "u < 0 everywhere"),
    HardCase("odd n", Toy(-1.2341, 0.00173), 59, 1e-3, 1000.0, Kind.ILL_POSED, True,
        "on an odd number of points the sawtooth does not close, which helps it if a < 0", Seed(28, 1e-6, "v")),
    HardCase("even n", Toy(-1.2341, 0.00173), 60, 1e-3, 1000.0, Kind.HIDDEN, False,
        "one point more, and nothing grows", Seed(28, 1e-6, "v")),
    HardCase("4 points", _PAPER, 4, 1e-3, 100.0, Kind.HIDDEN, False, "the coarsest grid of all sees nothing"),
    HardCase("float32", _PAPER, 100, 1e-3, 100.0, Kind.ILL_POSED, True,
        "round-off of 1e-7 instead of 1e-16: the blow-up comes at half the time", None, np.float32),
)  # fmt: skip
