"""Four rheologies: what each says of the yield stress Y(p, phi, I) and the dilatancy f(p, phi, I).

Every law closes the same equations, ||tau|| = Y and div u = 2 f ||D|| (eqs. yield-cond-Cmu and flow-rule-Cmu), so the
analysis needs only Y, f and their partial derivatives, named Y_p, Y_phi, Y_I, f_p, f_phi, f_I. Anything with these
eight functions of (p, phi, I) is a law. p and Y are pressures in any one unit; f, phi and I are dimensionless.

A law may say more: ``p_max(phi, I)``, the pressure at which Y falls to zero, and ``incompressible = True``, by which it
declares f = 0 and phi constant.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from primer.checks import function, real, shown
from primer.granular.compaction import Compaction, has_C
from primer.granular.friction import as_friction, numbers


class _Incompressible:
    """f = 0 and no dependence on phi: eq. (incompress)."""

    incompressible: ClassVar[bool] = True

    def f(self, p, phi, I):
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
    """

    mu: float

    def __post_init__(self):
        object.__setattr__(self, "mu", real("mu", self.mu, above=0))

    def Y(self, p, phi, I):
        """mu p."""
        p, phi, I = numbers(p, phi, I)
        return self.mu * p + self.f(p, phi, I)

    def Y_p(self, p, phi, I):
        """mu."""
        p, phi, I = numbers(p, phi, I)
        return self.mu + self.f(p, phi, I)

    def Y_I(self, p, phi, I):
        """0."""
        p, phi, I = numbers(p, phi, I)
        return self.f(p, phi, I)


@dataclass(frozen=True)
class IncompressibleMuI(_Incompressible):
    """The incompressible mu(I)-rheology of section 2.2: Y = mu(I) p, f = 0.

    Parameters
    ----------
    friction    a law with mu(I) and dmu(I), such as ``MuI`` or ``Friction(mu, dmu)``
    """

    friction: Any

    def __post_init__(self):
        object.__setattr__(self, "friction", as_friction(self.friction))

    def Y(self, p, phi, I):
        """mu(I) p."""
        p, phi, I = numbers(p, phi, I)
        return self.friction.mu(I) * p + self.f(p, phi, I)

    def Y_p(self, p, phi, I):
        """mu(I)."""
        p, phi, I = numbers(p, phi, I)
        return self.friction.mu(I) + self.f(p, phi, I)

    def Y_I(self, p, phi, I):
        """mu'(I) p."""
        p, phi, I = numbers(p, phi, I)
        return self.friction.dmu(I) * p + self.f(p, phi, I)


class _Compressible:
    """Y = a(I) p - p^2/C(phi) and f = b(I) - 2 p/C(phi), eq. (Cmu-ansatz-for-aux-fcn); a and b are the subclass's."""

    incompressible: ClassVar[bool] = False

    def Y(self, p, phi, I):
        """a(I) p - p^2/C(phi)."""
        p, phi, I = numbers(p, phi, I)
        return p * (self.a(I) - p / self._C(phi))

    def Y_p(self, p, phi, I):
        """a(I) - 2 p/C(phi)."""
        p, phi, I = numbers(p, phi, I)
        return self.a(I) - 2 * p / self._C(phi)

    def Y_phi(self, p, phi, I):
        """p^2 C'(phi)/C(phi)^2."""
        p, phi, I = numbers(p, phi, I)
        return (p / self._C(phi)) ** 2 * self.compaction.dC(phi) + 0 * np.asarray(I)

    def Y_I(self, p, phi, I):
        """a'(I) p."""
        p, phi, I = numbers(p, phi, I)
        return self.da(I) * p + 0 * self._C(phi)

    def f(self, p, phi, I):
        """b(I) - 2 p/C(phi)."""
        p, phi, I = numbers(p, phi, I)
        return self.b(I) - 2 * p / self._C(phi)

    def f_p(self, p, phi, I):
        """-2/C(phi)."""
        p, phi, I = numbers(p, phi, I)
        return -2 / self._C(phi) + 0 * np.asarray(p) * np.asarray(I)

    def f_phi(self, p, phi, I):
        """2 p C'(phi)/C(phi)^2."""
        p, phi, I = numbers(p, phi, I)
        return 2 * p * self.compaction.dC(phi) / self._C(phi) ** 2 + 0 * np.asarray(I)

    def f_I(self, p, phi, I):
        """b'(I)."""
        p, phi, I = numbers(p, phi, I)
        return self.db(I) + 0 * np.asarray(p) * self._C(phi)

    def p_max(self, phi, I):
        """a(I) C(phi): Y > 0 for 0 < p < p_max."""
        _, phi, I = numbers(0.0, phi, I)
        return self.a(I) * self.compaction.C(phi)

    def p_critical(self, phi, I):
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
class CSSM(_Compressible):
    """Critical state soil mechanics, eqs. (sample-yield-cond) and (flow-rule-CSSM)::

        Y = 2 mu p - p^2/C(phi),    f = dY/dp = 2 mu - 2 p/C(phi)

    Parameters
    ----------
    mu : float                 the friction coefficient on the critical state line, dimensionless, mu > 0
    compaction : Compaction    C(phi)
    """

    mu: float
    compaction: Compaction

    def __post_init__(self):
        object.__setattr__(self, "mu", real("mu", self.mu, above=0))
        has_C(self.compaction)

    def a(self, I):
        """2 mu."""
        return 2 * self.mu + 0 * np.asarray(I)

    def da(self, I):
        """0."""
        return 0.0 * np.asarray(I)

    b, db = a, da


@dataclass(frozen=True)
class CIDR(_Compressible):
    """The paper's compressible I-dependent rheology, eq. (Cmu-ansatz-for-aux-fcn)::

        Y = alpha(I) p - p^2/C(phi),    f = beta(I) - 2 p/C(phi)

    with the alpha and beta of Lemma 1.

    Parameters
    ----------
    friction                   a law with mu(I) and dmu(I); where it has no alpha and beta of its own, by quadrature
    compaction : Compaction    C(phi)
    """

    friction: Any
    compaction: Compaction

    def __post_init__(self):
        object.__setattr__(self, "friction", as_friction(self.friction))
        has_C(self.compaction)

    def a(self, I):
        """alpha(I)."""
        return self.friction.alpha(I)

    def b(self, I):
        """beta(I)."""
        return self.friction.beta(I)

    def da(self, I):
        """alpha'(I)."""
        return self.friction.dalpha(I)

    def db(self, I):
        """beta'(I)."""
        return self.friction.dbeta(I)


@dataclass(frozen=True)
class Ansatz(_Compressible):
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

    def __post_init__(self):
        for name in ("a", "da", "b", "db"):
            function(name, getattr(self, name), "I")
        has_C(self.compaction)
