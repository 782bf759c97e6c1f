"""Four rheologies: what each says of the yield stress Y(p, phi, I) and the dilatancy f(p, phi, I).

Every law closes the same equations, ||tau|| = Y and div u = 2 f ||D|| (eqs. yield-cond-Cmu and flow-rule-Cmu), so the
analysis needs only Y, f and their partial derivatives, named Y_p, Y_phi, Y_I, f_p, f_phi, f_I. Anything with these
eight functions of (p, phi, I) is a law. p and Y are pressures in any one unit; f, phi and I are dimensionless.

A law may say more: ``p_max(phi, I)``, the pressure at which Y falls to zero, and ``incompressible = True``, by which it
declares f = 0 and phi constant.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from primer.checks import real
from primer.granular.ansatz import Compressible
from primer.granular.compaction import Compaction, has_C
from primer.granular.friction import as_friction, numbers
from primer.types import ArrayLike, Numbers


class _Incompressible:
    """f = 0 and no dependence on phi: eq. (incompress)."""

    incompressible: ClassVar[bool] = True

    def f(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """0: the flow is isochoric."""
        p, phi, I = numbers(p, phi, I)
        return np.zeros(np.broadcast_shapes(np.shape(p), np.shape(phi), np.shape(I)))[()]

    Y_phi = f_p = f_phi = f_I = f


@dataclass(frozen=True)
class Coulomb(_Incompressible):
    """Rate-independent friction, eq. (yield-cond-coulomb): Y = mu p, f = 0.

    Parameters
    ----------
    mu : float    the friction coefficient, dimensionless, mu > 0

    >>> print(f"{Coulomb(0.4).Y(p=2.0, phi=0.6, I=0.1):.2f}")
    0.80
    """

    mu: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "mu", real("mu", self.mu, above=0))

    def Y(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """mu p."""
        p, phi, I = numbers(p, phi, I)
        return self.mu * p + self.f(p, phi, I)

    def Y_p(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """mu."""
        p, phi, I = numbers(p, phi, I)
        return self.mu + self.f(p, phi, I)

    def Y_I(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """0."""
        p, phi, I = numbers(p, phi, I)
        return self.f(p, phi, I)


@dataclass(frozen=True)
class IncompressibleMuI(_Incompressible):
    """The incompressible mu(I)-rheology of section 2.2: Y = mu(I) p, f = 0.

    Parameters
    ----------
    friction    a law with mu(I) and dmu(I), such as ``MuI`` or ``Friction(mu, dmu)``

    >>> from primer import MuI
    >>> print(f"{IncompressibleMuI(MuI(0.38, 0.64, 0.279)).Y(p=2.0, phi=0.6, I=0.279):.2f}")
    1.02
    """

    friction: Any

    def __post_init__(self) -> None:
        object.__setattr__(self, "friction", as_friction(self.friction))

    def Y(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """mu(I) p."""
        p, phi, I = numbers(p, phi, I)
        return self.friction.mu(I) * p + self.f(p, phi, I)

    def Y_p(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """mu(I)."""
        p, phi, I = numbers(p, phi, I)
        return self.friction.mu(I) + self.f(p, phi, I)

    def Y_I(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """mu'(I) p."""
        p, phi, I = numbers(p, phi, I)
        return self.friction.dmu(I) * p + self.f(p, phi, I)


@dataclass(frozen=True)
class CSSM(Compressible):
    """Critical state soil mechanics, eqs. (sample-yield-cond) and (flow-rule-CSSM)::

        Y = 2 mu p - p^2/C(phi),    f = dY/dp = 2 mu - 2 p/C(phi)

    Parameters
    ----------
    mu : float                 the friction coefficient on the critical state line, dimensionless, mu > 0
    compaction : Compaction    C(phi)

    >>> soil = CSSM(0.4, Compaction(phi0=0.5, eps=0.1, C0=1.0))
    >>> print(f"{soil.p_critical(0.55, 0.1):.2f}, {soil.f(0.2, 0.55, 0.1):.2f}")  # f > 0: it dilates
    0.40, 0.40
    """

    mu: float
    compaction: Compaction

    def __post_init__(self) -> None:
        object.__setattr__(self, "mu", real("mu", self.mu, above=0))
        has_C(self.compaction)

    def a(self, I: ArrayLike) -> Numbers:
        """2 mu."""
        return 2 * self.mu + 0 * np.asarray(I)

    def da(self, I: ArrayLike) -> Numbers:
        """0."""
        return 0.0 * np.asarray(I)

    b, db = a, da


@dataclass(frozen=True)
class CIDR(Compressible):
    """The paper's compressible I-dependent rheology, eq. (Cmu-ansatz-for-aux-fcn)::

        Y = alpha(I) p - p^2/C(phi),    f = beta(I) - 2 p/C(phi)

    with the alpha and beta of Lemma 1.

    Parameters
    ----------
    friction                   a law with mu(I) and dmu(I); where it has no alpha and beta of its own, by quadrature
    compaction : Compaction    C(phi)

    >>> from primer.granular import GLASS_BEADS
    >>> law = CIDR(GLASS_BEADS.friction, Compaction(phi0=0.5, eps=0.1, C0=1.0))
    >>> print(f"{law.Y(0.2, 0.55, 0.1):.6f}")
    0.130189
    """

    friction: Any
    compaction: Compaction

    def __post_init__(self) -> None:
        object.__setattr__(self, "friction", as_friction(self.friction))
        has_C(self.compaction)

    def a(self, I: ArrayLike) -> Numbers:
        """alpha(I)."""
        return self.friction.alpha(I)

    def b(self, I: ArrayLike) -> Numbers:
        """beta(I)."""
        return self.friction.beta(I)

    def da(self, I: ArrayLike) -> Numbers:
        """alpha'(I)."""
        return self.friction.dalpha(I)

    def db(self, I: ArrayLike) -> Numbers:
        """beta'(I)."""
        return self.friction.dbeta(I)
