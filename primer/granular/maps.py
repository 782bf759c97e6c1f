"""Maps of growth over the inertial number and p/C, and the curves on which they change, in closed form."""

from dataclasses import dataclass

import numpy as np

from primer.checks import affordable, real, shown
from primer.granular.compaction import has_C
from primer.granular.fastest import fastest
from primer.granular.friction import as_friction, inertial
from primer.granular.linearisation import coefficients
from primer.granular.state import BaseState, a_law


@dataclass(frozen=True, eq=False)
class GrowthMap:
    """The largest growth rate over all directions at states with p = ratio C(phi), where the law admits them.

    Attributes
    ----------
    I : array of shape (n,)             inertial numbers
    ratio : array of shape (m,)         p/C(phi)
    k : float                           |xi|, in units of 1/d
    growth : array of shape (m, n)      max Re lambda, in units of ||D||; nan where Y <= 0
    x : array of shape (m, n)           cos 2 theta of the direction that attains it
    """

    I: np.ndarray
    ratio: np.ndarray
    k: float
    growth: np.ndarray
    x: np.ndarray


def growth_map(law, I, ratio, compaction, phi, k=1e4):
    """The ``GrowthMap`` of a law on the states (I, ratio) at one phi, with d = rho = 1, from eigenvalues at |xi| = k.

    Every direction is optimised; a state costs about 90 characteristic polynomials. The compaction gives the pressure
    scale also to laws that have none.
    """
    a_law(law)
    has_C(compaction)
    I, ratio, k, phi = inertial("I", I), inertial("ratio", ratio), real("k", k, above=0), real("phi", phi, above=0)
    for name, axis in (("I", I), ("ratio", ratio)):
        if axis.ndim != 1 or not axis.size or (axis == 0).any():
            raise ValueError(f"{name} must be a sequence of numbers > 0, got {shown(axis)}")
    affordable("I and ratio", 300 * ratio.size * I.size, f"{I.size} times {ratio.size} states")
    p = ratio[:, None] * compaction.C(phi)
    inside = np.broadcast_to(law.Y(p, phi, I) > 0, (ratio.size, I.size))
    growth, x = np.full(inside.shape, np.nan), np.full(inside.shape, np.nan)
    state = BaseState(*(np.broadcast_to(v, inside.shape)[inside] for v in (p, phi, I)))
    rate, x[inside] = fastest(coefficients(law, state), k)
    growth[inside] = rate / state.D
    return GrowthMap(I, ratio, k, growth, x)


def neutral_stress_ratio(friction, I):
    """The stress ratio T = tau/p above which short waves grow under CIDR (bounded, so well posed all the same).

    lambda_3 changes sign at the largest root of a quartic in T that knows only mu and s = I mu' (with Lemma 1's
    differential equation everything else drops out of the discriminant of N(x))::

        T^2 (2T - s)^2 = 16 (mu + s - T)(2T - mu - s)

    Returns
    -------
    array of the shape of I; in terms of pressure the curve is p/C = alpha(I) - T, and where that is negative CIDR is
    damped at every pressure; nan where the quartic has no real root, which takes a friction well above 1
    """
    friction, I = as_friction(friction), inertial("I", I)
    mu, s = np.broadcast_arrays(friction.mu(I), I * friction.dmu(I))
    q = mu + s
    companion = np.zeros((*np.shape(mu), 4, 4))
    companion[..., 1, 0] = companion[..., 2, 1] = companion[..., 3, 2] = 1
    # 4 T^4 - 4 s T^3 + (s^2 + 32) T^2 - 48 q T + 16 q^2 = 0
    for row, value in enumerate((16 * q**2, -48 * q, s**2 + 32, -4 * s)):
        companion[..., row, 3] = -value / 4
    roots = np.linalg.eigvals(companion)
    T = np.where(np.abs(roots.imag) <= 1e-9 * np.abs(roots), roots.real, -np.inf).max(axis=-1)
    with np.errstate(invalid="ignore"):  # Newton's step for the last three digits
        value = T**2 * (2 * T - s) ** 2 - 16 * (q - T) * (2 * T - q)
        slope = 2 * T * (2 * T - s) * (4 * T - s) - 16 * (3 * q - 4 * T)
        return (T - value / slope)[()]
