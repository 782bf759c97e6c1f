"""Drucker-Prager with a viscosity, as geodynamics codes use it: Bingham and Herschel-Bulkley."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from primer.checks import real
from primer.granular.friction import numbers
from primer.granular.rheology import _Incompressible
from primer.types import ArrayLike, Numbers


@dataclass(frozen=True)
class DruckerPrager(_Incompressible):
    """Drucker-Prager with a viscous part, of index n, incompressible as in eq. (incompress)::

        Y = c + mu p + 2 K ||D||^n,    ||D|| = I sqrt(p/rho)/(2 d),    f = 0

    n = 1 is Bingham's, Y = c + mu p + 2 eta ||D|| with eta = K; other n are Herschel and Bulkley's. The viscous part
    knows ||D|| and not p, so that B = mu whatever K: what it adds is A = n K ||D||^{n-1}.

    Parameters
    ----------
    mu      friction coefficient, dimensionless, mu > 0
    K       consistency, in pressure times time^n, K >= 0
    index   n, dimensionless, n > 0
    c       cohesion, a pressure, c >= 0
    d, rho  diameter and density with which I is made: give the base states the same (1, the defaults of both)

    Raises
    ------
    TypeError, ValueError    if a parameter is not a finite number in its range

    >>> law = DruckerPrager(mu=0.6, K=0.1)
    >>> print(f"{law.Y(p=1.0, phi=0.6, I=0.5):.3f}")  # 0.6 + 2 (0.1) (0.25)
    0.650
    >>> print(f"{law.threshold(p=1.0, D=0.25):.4f}")
    0.1333
    """

    mu: float
    K: float
    index: float = 1.0
    c: float = 0.0
    d: float = 1.0
    rho: float = 1.0

    def __post_init__(self) -> None:
        for name in ("mu", "index", "d", "rho"):
            object.__setattr__(self, name, real(name, getattr(self, name), above=0))
        for name in ("K", "c"):
            object.__setattr__(self, name, real(name, getattr(self, name), least=0))

    def Y(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """c + mu p + 2 K ||D||^n."""
        p, phi, I = numbers(p, phi, I)
        return self.c + self.mu * p + self._viscous(p, I) + self.f(p, phi, I)

    def Y_p(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """mu + n K ||D||^n/p."""
        p, phi, I = numbers(p, phi, I)
        return self.mu + self.index * self._viscous(p, I) / (2 * np.asarray(p)) + self.f(p, phi, I)

    def Y_I(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """2 n K ||D||^n/I."""
        p, phi, I = numbers(p, phi, I)
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.index * self._viscous(p, I) / np.asarray(I) + self.f(p, phi, I)

    def threshold(self, p: float, D: float) -> float:
        """The K from which on the law is well posed at a pressure and a ||D||; inf where no K is enough.

        In every direction A (1 - x^2) + t x (x + mu) >= 0 with t = (c + mu p)/(2 ||D||) + K ||D||^{n-1}, that is
        A/t >= 1 - b, b = (1 + sqrt(1 - mu^2))/2, from the largest growth, at x = -tan(asin(mu)/2)::

            2 K ||D||^n = (c + mu p) (1 - b)/(n - 1 + b)

        For n = 1 this is eta = (c + mu p)(1 - b)/(2 b ||D||). If n <= 1 - b it never is, nor if mu >= 1.
        """
        p, D = real("p", p, above=0), real("D", D, above=0)
        b = (1 + np.sqrt(max(1 - self.mu**2, 0.0))) / 2
        if self.mu >= 1 or self.index <= 1 - b:
            return float("inf")
        return float((self.c + self.mu * p) * (1 - b) / (self.index - 1 + b) / (2 * D**self.index))

    def _viscous(self, p, I):
        """2 K ||D||^n."""
        return 2 * self.K * (np.asarray(I) * np.sqrt(np.asarray(p) / self.rho) / (2 * self.d)) ** self.index
