"""The friction law of Barker & Gray, which keeps the incompressible mu(I)-rheology well posed over a wider band."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from primer.checks import real
from primer.granular.criteria import neutral_inertial_numbers
from primer.granular.friction import MuI, inertial
from primer.types import ArrayLike, Numbers


@dataclass(frozen=True)
class RegularisedMuI:
    """The friction law that keeps the incompressible rheology of section 2.2 well posed over a wider band::

        mu = sqrt(alpha/log(A/I)) for I <= I1,    mu = (mu1 I0 + mu2 I + mu_inf I^2)/(I0 + I) for I > I1

    with A such that mu is continuous at I1; mu' jumps there. Where ``MuI`` creeps or flows fast this law does not: it
    has no yield stress, mu(0) = 0, and rises without bound.

    Parameters
    ----------
    mu1, mu2, I0    as in ``MuI``
    mu_inf          the slope of mu at large I, > 0
    alpha           of the logarithm, > 0
    I1              where they meet; left out, the lower neutral inertial number of ``MuI(mu1, mu2, I0)``

    Raises
    ------
    TypeError, ValueError    if a parameter is not a finite number in its range

    Barker & Gray, J. Fluid Mech. 828 (2017) 5. The defaults of mu_inf and alpha, 0.05 and 1.9, go with mu1 = 0.342,
    mu2 = 0.557 and I0 = 0.069 in the parameter files of codes that follow it.

    >>> law = RegularisedMuI(0.342, 0.557, 0.069)
    >>> print(f"{law.I1:.6f} {law.mu(0.1):.4f}")
    0.003972 0.4722
    """

    mu1: float
    mu2: float
    I0: float
    mu_inf: float = 0.05
    alpha: float = 1.9
    I1: float | None = None
    A: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        beads = MuI(self.mu1, self.mu2, self.I0)
        for name in ("mu1", "mu2", "I0"):
            object.__setattr__(self, name, getattr(beads, name))
        for name in ("mu_inf", "alpha"):
            object.__setattr__(self, name, real(name, getattr(self, name), above=0))
        first = self.I1
        if first is None:
            found = neutral_inertial_numbers(beads)
            if not found.size:
                raise ValueError("I1 must be given: MuI(mu1, mu2, I0) has no neutral inertial number to meet at")
            first = float(found[0])
        first = real("I1", first, above=0)
        object.__setattr__(self, "I1", first)
        object.__setattr__(self, "A", first * np.exp(self.alpha / self._fast(first) ** 2))

    def mu(self, I: ArrayLike) -> Numbers:
        """mu(I), of the shape of I; 0 at I = 0."""
        I = inertial("I", I)
        return np.where(I <= self.I1, np.sqrt(self.alpha / self._log(I)), self._fast(I))[()]

    def dmu(self, I: ArrayLike) -> Numbers:
        """mu'(I): mu^3/(2 alpha I) below I1, infinite at I = 0."""
        I = inertial("I", I)
        top = self.mu2 + 2 * self.mu_inf * I - self._fast(I)
        with np.errstate(divide="ignore"):
            slow = np.sqrt(self.alpha) / (2 * I * self._log(I) ** 1.5)
        return np.where(I <= self.I1, slow, top / (self.I0 + I))[()]

    def _fast(self, I):
        return (self.mu1 * self.I0 + I * (self.mu2 + self.mu_inf * I)) / (self.I0 + I)

    def _log(self, I):
        """log(A/I) where I <= I1."""
        with np.errstate(divide="ignore"):
            return np.log(self.A) - np.log(np.minimum(I, float(self.I1 or 0)))
