"""The form of Y and f that CSSM and CIDR share, eq. (Cmu-ansatz-for-aux-fcn), with any a(I) and b(I)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from primer.checks import function, shown
from primer.granular.compaction import Compaction, has_C
from primer.granular.friction import numbers
from primer.types import ArrayLike, Numbers


class Compressible:
    """Y = a(I) p - p^2/C(phi) and f = b(I) - 2 p/C(phi), eq. (Cmu-ansatz-for-aux-fcn); a and b are the subclass's."""

    incompressible: ClassVar[bool] = False
    compaction: Compaction  # this and a(I), b(I) with their derivatives are the subclass's
    a: Callable
    da: Callable
    b: Callable
    db: Callable

    def Y(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """a(I) p - p^2/C(phi)."""
        p, phi, I = numbers(p, phi, I)
        return p * (self.a(I) - p / self._C(phi))

    def Y_p(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """a(I) - 2 p/C(phi)."""
        p, phi, I = numbers(p, phi, I)
        return self.a(I) - 2 * p / self._C(phi)

    def Y_phi(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """p^2 C'(phi)/C(phi)^2."""
        p, phi, I = numbers(p, phi, I)
        return (p / self._C(phi)) ** 2 * self.compaction.dC(phi) + 0 * np.asarray(I)

    def Y_I(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """a'(I) p."""
        p, phi, I = numbers(p, phi, I)
        return self.da(I) * p + 0 * self._C(phi)

    def f(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """b(I) - 2 p/C(phi)."""
        p, phi, I = numbers(p, phi, I)
        return self.b(I) - 2 * p / self._C(phi)

    def f_p(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """-2/C(phi)."""
        p, phi, I = numbers(p, phi, I)
        return -2 / self._C(phi) + 0 * np.asarray(p) * np.asarray(I)

    def f_phi(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """2 p C'(phi)/C(phi)^2."""
        p, phi, I = numbers(p, phi, I)
        return 2 * p * self.compaction.dC(phi) / self._C(phi) ** 2 + 0 * np.asarray(I)

    def f_I(self, p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """b'(I)."""
        p, phi, I = numbers(p, phi, I)
        return self.db(I) + 0 * np.asarray(p) * self._C(phi)

    def p_max(self, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """a(I) C(phi): Y > 0 for 0 < p < p_max."""
        _, phi, I = numbers(0.0, phi, I)
        return self.a(I) * self.compaction.C(phi)

    def p_critical(self, phi: ArrayLike, I: ArrayLike) -> Numbers:
        """b(I) C(phi)/2: there f = 0, and the material shears without a change of volume."""
        _, phi, I = numbers(0.0, phi, I)
        return self.b(I) * self.compaction.C(phi) / 2

    def _C(self, phi):
        C = self.compaction.C(phi)
        if (np.asarray(C) == 0).any():
            raise ValueError(
                f"phi must be > phi0 = {self.compaction.phi0:g}: there C(phi) = 0 and no pressure can be carried, "
                f"got {shown(phi)}"
            )
        return C


@dataclass(frozen=True)
class Ansatz(Compressible):
    """Eq. (Cmu-ansatz-for-aux-fcn) with any a(I) and b(I), to break the theorem's hypotheses one at a time::

        Y = a(I) p - p^2/C(phi),    f = b(I) - 2 p/C(phi)

    Parameters
    ----------
    a, da, b, db : callable    a(I), a'(I), b(I), b'(I), each taking and giving arrays
    compaction : Compaction    C(phi)
    """

    a: Callable
    da: Callable
    b: Callable
    db: Callable
    compaction: Compaction

    def __post_init__(self) -> None:
        for name in ("a", "da", "b", "db"):
            function(name, getattr(self, name), "I")
        has_C(self.compaction)
