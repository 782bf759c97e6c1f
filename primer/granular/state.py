"""The base state at which the equations are frozen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from primer.checks import instance, real_array, shown
from primer.types import Law, Numbers

_LAW = "Y", "Y_p", "Y_phi", "Y_I", "f", "f_p", "f_phi", "f_I"


@dataclass(frozen=True, eq=False)
class BaseState:
    """A state of flow at one point, or many: arrays of states broadcast against each other.

    Parameters
    ----------
    p      pressure, p > 0, in units of pressure (Pa, say)
    phi    solids fraction, dimensionless, 0 < phi <= 1
    I      inertial number, dimensionless, I > 0
    d      particle diameter, d > 0, in units of length
    rho    intrinsic density of the grains (rho_* in the paper), rho > 0, in units of mass per volume

    With d = rho = 1 (the defaults) everything is measured in particle diameters and sqrt(rho d^2/pressure unit).

    Raises
    ------
    TypeError, ValueError    if a number is not finite or outside its range, or if the shapes do not broadcast

    The scales are those of eqs. (dfn-norm) and (dfn-I).

    >>> state = BaseState(p=0.2, phi=0.55, I=0.1)
    >>> print(f"{state.D:.5f}")
    0.02236
    """

    p: Numbers
    phi: Numbers
    I: Numbers
    d: Numbers = 1.0
    rho: Numbers = 1.0

    def __post_init__(self) -> None:
        names = "p", "phi", "I", "d", "rho"
        for name in names:
            value = real_array(name, getattr(self, name))
            if not (value > 0).all():
                raise ValueError(f"{name} must be > 0{_where(value)}, got {shown(getattr(self, name))}")
            object.__setattr__(self, name, value if value.ndim else float(value))
        if np.any(self.phi > 1):
            raise ValueError(f"phi must be <= 1{_where(self.phi)}, being a solids fraction, got {shown(self.phi)}")
        try:
            np.broadcast_shapes(*(np.shape(getattr(self, name)) for name in names))
        except ValueError:
            shapes = ", ".join(f"{name} {np.shape(getattr(self, name))}" for name in names)
            raise ValueError(f"the shapes of p, phi, I, d and rho must broadcast, got {shapes}") from None

    @property
    def shape(self) -> tuple[int, ...]:
        """The broadcast shape: () for one state."""
        return np.broadcast_shapes(*(np.shape(v) for v in (self.p, self.phi, self.I, self.d, self.rho)))

    @property
    def D(self) -> Numbers:
        """||D|| = I sqrt(p/rho)/(2 d), eq. (dfn-I); the norm is sqrt(D_ij D_ij/2), eq. (dfn-norm)."""
        return self.I * np.sqrt(self.p / self.rho) / (2 * self.d)

    def tau(self, law: Law) -> Numbers:
        """||tau|| = Y(p, phi, I)."""
        a_law(law)
        return law.Y(self.p, self.phi, self.I)

    def div_u(self, law: Law) -> Numbers:
        """div u = 2 f(p, phi, I) ||D||: positive where the material expands."""
        a_law(law)
        return 2 * law.f(self.p, self.phi, self.I) * self.D


def a_law(law: object) -> None:
    """Raise TypeError unless the law has the eight functions of (p, phi, I)."""
    if isinstance(law, type) or not all(callable(getattr(law, name, None)) for name in _LAW):
        raise TypeError(f"law must have the functions {', '.join(_LAW)} of (p, phi, I), as CIDR has, got {shown(law)}")


def admit(law: Law, state: BaseState) -> Numbers:
    """Return Y at the state, or say in one sentence why the law does not admit it.

    The Theorem of the paper uses, without saying so, that the yield stress is positive: 0 < p < alpha(I) C(phi) in
    CIDR and 0 < p < 2 mu C(phi) in CSSM. At phi = phi0 itself C = 0, and no pressure is admissible.

    Raises
    ------
    ValueError    if phi is outside the law's range or Y(p, phi, I) is not a positive number
    """
    a_law(law)
    instance("state", state, BaseState)
    with np.errstate(over="ignore", invalid="ignore"):
        Y = np.broadcast_to(law.Y(state.p, state.phi, state.I), state.shape)
    bad = ~((Y > 0) & (np.inf > Y))
    if bad.any():
        p, phi, I = (np.broadcast_to(v, state.shape)[bad][0] for v in (state.p, state.phi, state.I))
        at = f"p = {p:g}, phi = {phi:g}, I = {I:g}"
        if hasattr(law, "p_max"):
            raise ValueError(f"p must be < {law.p_max(phi, I):g} for the yield stress to be positive, got {at}")
        raise ValueError(f"the yield stress Y(p, phi, I) must be positive and finite, got {Y[bad][0]:g} at {at}")
    return Y[()]


def _where(value):
    return " everywhere" if np.ndim(value) else ""
