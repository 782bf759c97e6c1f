"""What a diagnosis says: the kinds, and one frozen result."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum

from primer.schemes.run import Seed


class Kind(StrEnum):
    """What becomes of a run."""

    CONVERGES = "converges"  # well posed throughout, and the scheme is stable
    HIDDEN = "hidden"  # ill posed, but this grid cannot see it by the end of the run
    ILL_POSED = "ill-posed"  # ill posed, and this grid feels it: it blows up, or fills with its shortest waves
    TRANSIENT = "transient"  # a well-posed steady state, but ill posed on the way
    SCHEME = "scheme"  # the time step is too large: it amplifies what does not grow of itself
    UNSTABLE = "unstable"  # perturbations grow, no faster on finer grids: the model's own physics
    UNDECIDED = "undecided"


@dataclass(frozen=True)
class Diagnosis:
    """What :func:`primer.diagnose` foresees.

    Attributes
    ----------
    kind        a :class:`Kind`
    blow_up     (earliest, latest) time of the blow-up, or None if the run will reach its end
    growth      per unit time, of the fastest small perturbation of the steady state on this grid: ln|1 + dt lam|/dt; of
                the initial data where no steady state is known
    reason      one sentence
    seed        the stated perturbation, or None
    seeded      whether the blow-up grows from it rather than from round-off
    t_blow_up   the single best guess, also where it lies after t_end; infinite if never
    growths     fastest growth as dt -> 0 on n, 2 n and 4 n points, where it was computed
    wavelength  of the fastest mode with this step: of the strongest wave in it; nan where it was not looked for
    stable_dt   the step that would cure a blow-up of the scheme, else nan
    where       where the equations are ill posed, frozen: "for |x| < 1.05"; empty if nowhere, or not looked for
    ran         whether the run itself was made, as it is where that is cheaper than to foretell it
    amplification    by what one step multiplies waves of k = 0, 1, ... n/2 in the period, (n//2 + 1,) numbers: the
                largest factor, of a uniform state; frozen at each x, the largest of all there

    Figures 4 to 6 of the paper are of the kinds converges, ill-posed and hidden.

    >>> from primer import Toy, diagnose
    >>> found = diagnose(Toy(0.5), n=100)
    >>> earliest, latest = found.blow_up
    >>> print(found.kind, earliest < 14 < latest, f"{found.growth:.3f}")
    ill-posed True 2.724
    """

    kind: Kind
    blow_up: tuple[float, float] | None
    growth: float
    reason: str
    seed: Seed | None
    seeded: bool
    t_blow_up: float
    growths: tuple[float, ...] = ()
    wavelength: float = math.nan
    stable_dt: float = math.nan
    where: str = ""
    ran: bool = False
    amplification: tuple[float, ...] = field(default=(), repr=False)
