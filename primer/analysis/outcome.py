"""What the test for ill-posedness gives back."""

import math
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction


class Kind(StrEnum):
    """What the test can say."""

    WELL_POSED = "well-posed"
    ILL_POSED = "ill-posed"
    UNDECIDED = "undecided"


@dataclass(frozen=True)
class Verdict:
    """The outcome of the test for linear ill-posedness.

    Attributes
    ----------
    kind : Kind
        "ill-posed" if limsup Re lambda = +infinity as |xi| -> infinity, "well-posed" if Re lambda is bounded from above
        (linearly, in the paper's sense), or "undecided"
    exponent : Fraction
    coefficient : float
        the largest growth, over branches and directions, is Re lambda ~ coefficient |xi|^exponent as |xi| -> infinity.
        For a well-posed system that is the branch that decays least; both are 0 where Re lambda is. nan if undecided
    direction : tuple
        the unit vector to which xi/|xi| tends there; in one space variable (1.0,) or (-1.0,)
    bound : float
        the supremum of Re lambda over all xi: inf if ill-posed, nan if undecided
    unstable : bool
        whether the base state is unstable: something grows, bound > 0, and the base state is uniform and steady. Where
        it varies in space or time, coefficients are frozen at a point; growth there is not instability of the state
    reason : str
        in words
    loss : Fraction
        0 where well-posedness is strong, else the power of |xi| by which bounded data may grow in a time of order one:
        then it is weak, and lower-order terms can make it ill-posed. Every unknown counts alike, its j-th time
        derivative divided by |xi|^(jq), q the power of the fastest branch; unknowns without a time derivative are no
        data. inf if ill-posed; nan if undecided, or where the reason says that it was not decided
    exact : bool
        whether the law is derived, as that of a polynomial symbol is; False if it was fitted to growth rates computed
        in double precision, as for |xi| or sqrt(xi tanh xi): good evidence, no proof
    uncertainty : float
        of the exponent where it was fitted, else 0. A fitted exponent is a fraction if one with a denominator up to 12
        lies within; nan where the power did not settle, of a growth that is bounded all the same

    The definition of linear ill-posedness is that of section A2.1.

    >>> from primer import verdict
    >>> print(verdict("u_t = u_x + v_x; v_t = v_x").loss)  # exp(t A) grows like |xi| t, though no eigenvalue does
    1
    >>> found = verdict("u_t = -u_xx - u_xxxx")
    >>> print(found.kind, found.unstable, found.bound)  # an instability, but not ill-posedness
    well-posed True 0.25
    """

    kind: Kind
    exponent: Fraction | float
    coefficient: float
    direction: tuple
    bound: float
    unstable: bool
    reason: str
    loss: Fraction | float = math.nan
    exact: bool = True
    uncertainty: float = 0.0

    @property
    def grows(self) -> bool:
        """Whether any exponential grows, bound > 0; with a finite bound that is not ill-posedness."""
        return self.bound > 0


def undecided(reason: str) -> Verdict:
    """The verdict that claims nothing, for this reason."""
    nan = math.nan
    return Verdict(Kind.UNDECIDED, nan, nan, (), nan, False, reason[0].upper() + reason[1:] + ".")
