"""How the strength of the packing depends on the solids fraction: C(phi) of eq. (form-of-C)."""

from __future__ import annotations

from dataclasses import dataclass

from primer.checks import real, real_array, shown
from primer.types import ArrayLike, Numbers


@dataclass(frozen=True)
class Compaction:
    """The packing's strength as a function of the solids fraction, eqs. (form-of-C) and (range-phi)::

        C(phi) = C0 z/(1 - z),    z = (phi - phi0)/eps,    phi0 <= phi < phi0 + eps

    Parameters
    ----------
    phi0 : float    the smallest solids fraction that carries stress (random loose packing), dimensionless, 0 < phi0 < 1
    eps : float     the width of the range up to jamming at phi0 + eps, dimensionless, 0 < eps <= 1 - phi0
    C0 : float      the scale, a pressure in the units of p, C0 > 0

    Raises
    ------
    TypeError, ValueError    if a parameter is not a finite number in its range

    >>> packing = Compaction(phi0=0.5, eps=0.1, C0=1.0)
    >>> print(f"{packing.C(0.55):.4f} {packing.phi(1.0):.4f}")
    1.0000 0.5500
    """

    phi0: float
    eps: float
    C0: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "phi0", real("phi0", self.phi0, above=0, below=1))
        object.__setattr__(self, "eps", real("eps", self.eps, above=0))
        object.__setattr__(self, "C0", real("C0", self.C0, above=0))
        if self.phi0 + self.eps > 1:
            raise ValueError(f"eps must be <= 1 - phi0 (a solids fraction is at most 1), got {self.eps!r}")

    def C(self, phi: ArrayLike) -> Numbers:
        """C(phi), of the shape of phi: 0 at phi0, infinite as phi -> phi0 + eps.

        Raises
        ------
        ValueError    if phi is outside phi0 <= phi < phi0 + eps
        """
        z = self._z(phi)
        return self.C0 * (z / (1 - z))

    def dC(self, phi: ArrayLike) -> Numbers:
        """C'(phi) = (C0/eps)/(1 - z)^2."""
        z = self._z(phi)
        return self.C0 / self.eps / (1 - z) ** 2

    def phi(self, C: ArrayLike) -> Numbers:
        """The solids fraction at which the strength is C >= 0: the inverse function, as eq. (phi-of-tau) needs it."""
        C = real_array("C", C)
        if (C < 0).any():
            raise ValueError(f"C must be >= 0 everywhere, got {shown(C)}")
        return self.phi0 + self.eps * (C / (self.C0 + C))

    def _z(self, phi):
        phi = real_array("phi", phi)
        z, top = (phi - self.phi0) / self.eps, self.phi0 + self.eps
        if ((phi < self.phi0) | (phi >= top) | (z >= 1)).any():
            raise ValueError(f"phi must satisfy phi0 = {self.phi0:g} <= phi < phi0 + eps = {top:g}, got {shown(phi)}")
        return z


def has_C(compaction: object) -> None:
    """Raise TypeError unless there are the functions C(phi) and dC(phi)."""
    if isinstance(compaction, type) or not all(callable(getattr(compaction, name, None)) for name in ("C", "dC")):
        raise TypeError(f"compaction must be a Compaction(phi0, eps, C0), got {shown(compaction)}")
