"""The mu(I), Phi(I)-rheology: friction and solids fraction are functions of I alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.checks import real
from primer.granular.friction import as_friction, numbers
from primer.types import ArrayLike, Numbers


@dataclass(frozen=True)
class MuIPhiI:
    """mu(I) with a solids fraction Phi(I) = phi_max - slope I to which phi relaxes, as a flow rule (flow-rule-Cmu)::

        Y = mu(I) p,    f = K (Phi(I) - phi)

    phi = Phi(I) itself, Pouliquen's mu(I), Phi(I)-rheology, is K -> infinity. On phi = Phi(I) the pressure follows from
    phi and ||D||, and det V = t (p/||D||)(x + mu) at |xi| = 1 with x = cos 2 theta: negative towards x = -1 wherever
    mu < 1, so that it is ill posed wherever it deforms, whatever I (with K >> 1/(slope I)). The growth tends to
    (p/||D||)(1 - mu) |xi|^2/(rho phi), in the direction of extension.

    Parameters
    ----------
    friction    a law with mu(I) and dmu(I)
    phi_max     Phi(0), 0 < phi_max <= 1
    slope       -Phi'(I) > 0
    K           how strongly phi is bound to Phi(I), > 0

    Raises
    ------
    TypeError, ValueError    if a parameter is not in its range

    Heyman, Delannay, Tabuteau & Valance, J. Fluid Mech. 830 (2017), for the ill-posedness: in arXiv:1609.01502v1 the
    edge without bulk friction is mu = 1 in two dimensions, as here.

    >>> from primer.granular import GLASS_BEADS, BaseState, verdict
    >>> law = MuIPhiI(GLASS_BEADS.friction)
    >>> print(verdict(law, BaseState(p=1.0, phi=law.Phi(0.1), I=0.1)).kind)
    ill-posed
    """

    friction: Any
    phi_max: float = 0.6
    slope: float = 0.2
    K: float = 1e6

    def __post_init__(self) -> None:
        object.__setattr__(self, "friction", as_friction(self.friction))
        object.__setattr__(self, "phi_max", real("phi_max", self.phi_max, above=0, most=1))
        for name in ("slope", "K"):
            object.__setattr__(self, name, real(name, getattr(self, name), above=0))

    def Phi(self, I: ArrayLike) -> Numbers:
        """phi_max - slope I."""
        return self.phi_max - self.slope * np.asarray(I, dtype=float)[()]

    def Y(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """mu(I) p."""
        p, phi, I = numbers(p, phi, I)
        return self.friction.mu(I) * p + 0 * phi

    def Y_p(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """mu(I)."""
        p, phi, I = numbers(p, phi, I)
        return self.friction.mu(I) + 0 * p * phi

    def Y_phi(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """0."""
        p, phi, I = numbers(p, phi, I)
        return 0.0 * p * phi * I

    def Y_I(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """mu'(I) p."""
        p, phi, I = numbers(p, phi, I)
        return self.friction.dmu(I) * p + 0 * phi

    def f(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """K (Phi(I) - phi)."""
        p, phi, I = numbers(p, phi, I)
        return self.K * (self.Phi(I) - phi) + 0 * p

    f_p = Y_phi

    def f_phi(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """-K."""
        return self.Y_phi(p, phi, I) - self.K

    def f_I(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """K Phi'(I) = -K slope."""
        return self.Y_phi(p, phi, I) - self.K * self.slope
