"""The paper's hypotheses and the classical criteria, each as a closed form that reports what holds."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from primer.checks import real, shown
from primer.granular.friction import as_friction, inertial
from primer.granular.linearisation import coefficients
from primer.granular.state import BaseState
from primer.types import ArrayLike, FrictionLaw, HasCriticalState, Law, Numbers


@dataclass(frozen=True, eq=False)
class Conditions:
    """The hypotheses of the theorem at a base state; arrays of the state's shape.

    Attributes
    ----------
    B, C       the two sides of eq. (Cmu-well-posed-cond), Y_p - I/(2p) Y_I and f + I f_I
    equality   whether they agree, to 1e-9 of the size of the terms
    Y_I        the left-hand side of (ineq-for-thm a), in units of pressure
    a          whether Y_I > 0
    slope      the left-hand side of (ineq-for-thm b), f_p - I/(2p) f_I, in units of 1/pressure
    b          whether slope < 0
    """

    B: np.ndarray
    C: np.ndarray
    equality: np.ndarray
    Y_I: np.ndarray
    a: np.ndarray
    slope: np.ndarray
    b: np.ndarray

    @property
    def theorem(self) -> Numbers:
        """Whether all three hold: then the paper's theorem says linearly well posed."""
        return self.equality & self.a & self.b


def conditions(law: Law, state: BaseState) -> Conditions:
    """Which of (Cmu-well-posed-cond) and (ineq-for-thm a, b) hold for a law at a base state.

    Returns
    -------
    Conditions

    Raises
    ------
    ValueError    if the law does not admit the state
    """
    c = coefficients(law, state)
    p, phi, I = state.p, state.phi, state.I
    size = np.abs(law.Y_p(p, phi, I)) + np.abs(law.f(p, phi, I)) + c.tau / p
    Y_I, slope = 2 * c.D * c.A / I, -c.Gamma / (2 * c.D)
    return Conditions(c.B, c.C, np.abs(c.B - c.C) <= 1e-9 * size, Y_I, Y_I > 0, slope, slope < 0)


@dataclass(frozen=True, eq=False)
class IncompressibleCriterion:
    """The criterion for the incompressible mu(I)-rheology at inertial numbers I; arrays of the shape of I.

    Attributes
    ----------
    n             I mu'/mu
    B             mu (1 - n/2)
    C             4n^2 - 4n + mu^2 (1 - n/2)^2, the C of Barker et al. (2015)
    well_posed    |B| < 1 and (C <= 0 or n >= 1/2); C <= 0 alone is exact only for n < 1/2
    growth        [(1-n) T^2 - n] with T = tan(asin(B)/2): times |xi|^2 tau/(2 rho phi ||D||) it is the largest growth
                  rate, at x = cos 2 theta = -T; inf where |B| >= 1
    """

    n: np.ndarray
    B: np.ndarray
    C: np.ndarray
    well_posed: np.ndarray
    growth: np.ndarray


def incompressible_criterion(friction: FrictionLaw, I: ArrayLike) -> IncompressibleCriterion:
    """The ``IncompressibleCriterion`` of a friction law with mu(I) and dmu(I), for eq. (mu(I)-system-mom)."""
    friction, I = as_friction(friction), inertial("I", I)
    mu = friction.mu(I)
    n = I * friction.dmu(I) / mu
    B = mu * (1 - n / 2)
    C = 4 * n * (n - 1) + B**2
    T = np.tan(np.arcsin(np.clip(B, -1, 1)) / 2)
    growth = np.where(np.abs(B) < 1, (1 - n) * T**2 - n, np.inf)[()]
    return IncompressibleCriterion(n, B, C, (np.abs(B) < 1) & ((C <= 0) | (n >= 0.5)), growth)


def neutral_inertial_numbers(friction: FrictionLaw, low: float = 1e-12, high: float = 1e12) -> np.ndarray:
    """The inertial numbers at which the incompressible mu(I)-rheology changes between ill posed and well posed.

    Returns
    -------
    array in increasing order, each to a relative 1e-13: for ``MuI`` with ordinary parameters two, between which the
    rheology is well posed; empty if there is none in low <= I <= high.

    A scan in log I of 200 points a decade finds the sign changes of the largest growth rate, and minima in between that
    dip below zero; then bisection.

    The criterion is that of Barker et al., J. Fluid Mech. 779 (2015); see section 2.2.

    >>> from primer import MuI
    >>> print(neutral_inertial_numbers(MuI(0.383, 0.643, 0.279)).round(6))
    [0.019713 0.845783]
    """
    friction = as_friction(friction)
    low, high = real("low", low, above=0), real("high", high, above=0)
    if low > high:
        raise ValueError(f"low must be <= high, got low = {low:g} and high = {high:g}")

    def growth(s):
        return np.minimum(incompressible_criterion(friction, np.exp(s)).growth, 1)

    s = np.linspace(np.log(low), np.log(high), 1 + math.ceil(200 * (math.log10(high) - math.log10(low))))
    s = np.unique(np.concatenate([s, _dips(growth, s)]))
    positive = growth(s) > 0
    left, right = s[:-1][positive[1:] != positive[:-1]], s[1:][positive[1:] != positive[:-1]]
    start = growth(left) > 0
    for _ in range(60):
        middle = (left + right) / 2
        same = (growth(middle) > 0) == start
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    return np.exp((left + right) / 2)


def critical_state(
    law: HasCriticalState, phi: ArrayLike, I: ArrayLike = 0.1, d: ArrayLike = 1.0, rho: ArrayLike = 1.0
) -> BaseState:
    """The base state at which a compressible law shears without a change of volume, f = 0, eq. (crit-state-cond).

    p = mu C(phi) in CSSM, whatever I, and p = beta(I) C(phi)/2 in CIDR.

    Parameters
    ----------
    law                a law with p_critical(phi, I), such as ``CSSM`` or ``CIDR``
    phi, I, d, rho     as in ``BaseState``, numbers or arrays

    Raises
    ------
    TypeError    if the law is incompressible (every state is critical) or has no p_critical

    >>> from primer import CSSM, Compaction
    >>> state = critical_state(CSSM(0.4, Compaction(phi0=0.5, eps=0.1, C0=1.0)), phi=0.55)
    >>> print(f"{state.p:.4f}")  # mu C(phi)
    0.4000
    """
    if isinstance(law, type) or not hasattr(law, "p_critical"):
        raise TypeError(f"law must have a critical state, as CSSM and CIDR do, got {shown(law)}")
    return BaseState(law.p_critical(phi, I), phi, I, d, rho)


def _dips(growth, s):
    """Where a positive local minimum of a scanned function lies, refined by trisection."""
    g = growth(s)
    j = 1 + np.flatnonzero((g[1:-1] < g[:-2]) & (g[1:-1] <= g[2:]) & (g[1:-1] > 0) & (g[1:-1] < 1))
    left, right = s[j - 1], s[j + 1]
    for _ in range(60):
        a, b = left + (right - left) / 3, right - (right - left) / 3
        lower = growth(a) < growth(b)
        left, right = np.where(lower, left, a), np.where(lower, b, right)
    return (left + right) / 2
