"""The proof of well-posedness, step by step, as numbers (sections 2.5 and 4 of the paper).

Determinants and traces are divided by the power of |xi| they carry, so they depend on x = cos 2 theta alone. B and C
are kept apart: the paper's formulae are the case B = C.
"""

from dataclasses import dataclass

import numpy as np

from primer.checks import real_array
from primer.granular.dispersion import Delta, at, dispersion
from primer.granular.friction import as_friction, inertial
from primer.granular.limits import least_Delta


def det_N(c, x):
    """det N/|xi|^4 = (t/Gamma)(x + B)(x + C), eq. (43): a square if B = C, zero in the bad directions (e44)."""
    return c.t / c.Gamma * (x + c.B) * (x + c.C)


def chi(c, x):
    """chi(M, N)/|xi|^4 = A [t + (1 - x^2)/Gamma], with t = tau/(2 ||D||).

    Erratum: eq. (42b) of the paper lacks the factor A. It is what rate dependence adds, and without it (A = 0, as in
    CSSM) the bad directions are not mended.
    """
    return c.A * chi_as_printed(c, x)


def chi_as_printed(c, x):
    """The right-hand side of (42b) as printed, over |xi|^4: positive even at A = 0, where it should vanish."""
    return c.t + (1 - np.square(x)) / c.Gamma


def det_MN(c, x):
    """det(M + N)/|xi|^4 = det N + chi, eq. (e41) with det M = 0."""
    return Delta(c, x) / c.Gamma


def trace_MN(c, x):
    """tr(M + N)/|xi|^2 = A + t + [(1+B)(1+C)(1+x) + (1-B)(1-C)(1-x)]/(2 Gamma)."""
    return at(dispersion(c).T, x) / c.Gamma


def is_positive_definite(c):
    """Whether trace and determinant of M + N are positive in every direction (the Lemma of section 4, if B = C)."""
    T = dispersion(c).T
    least, _ = least_Delta(c, np.sign(c.Gamma))
    return (least > 0) & ((T[0] - np.abs(T[1])) / c.Gamma > 0)


def bad_directions(c):
    """The two directions (e44), xi_1/xi_2 = +-sqrt((1 - B)/(1 + B)), where det N = 0.

    Returns
    -------
    unit vectors of shape (2, 2) + shape: components first, then the two signs

    Raises
    ------
    ValueError    if |B| >= 1: the paper does not say so, but then there are none
    """
    if np.any(np.abs(c.B) >= 1):
        raise ValueError(f"|B| must be < 1 for the directions (e44) to exist, got B = {c.B}")
    one, two = np.sqrt((1 - c.B) / 2), np.sqrt((1 + c.B) / 2)
    return np.stack([np.stack([one, -one]), np.stack([two, two])])


def Lambda(c, x):
    """(Lambda_1, Lambda_2)/|xi|^2: the growth rates of the comparison problem (evalue-comparison), the larger first.

    Minus the eigenvalues of (M + N)/(rho phi). lambda_j = Lambda_j + O(1), sharper than the O(|xi|) of the paper.
    """
    trace, det = trace_MN(c, x), det_MN(c, x)
    outer = trace / 2 + np.sqrt(trace**2 / 4 - det + 0j)
    pair = np.stack([-det / outer, -outer], axis=-1) / np.expand_dims(c.density, -1)
    return pair.real if np.all(pair.imag == 0) else pair


def lambda_3(c, x):
    """-det P/(Lambda_1 Lambda_2), the bounded third growth rate; its error is O(|xi|^-2), sharper than the paper's."""
    return -c.phi * at(dispersion(c).N, x) / Delta(c, x)


@dataclass(frozen=True, eq=False)
class Lemma2:
    """Lemma 2 at inertial numbers I: the premises mu' > 0 and, through concavity, the two conclusions.

    Attributes
    ----------
    dmu                 mu'(I), premise: > 0
    dalpha, dbeta       alpha'(I) and beta'(I): (ineq-for-thm a) is dalpha > 0, and dbeta > 0 gives (b)
    alpha_ratio         alpha'/mu' - 8/7, >= 0 where mu'' <= 0 on (0, I)
    beta_ratio          beta'/mu' - 2/7, >= 0 likewise
    """

    dmu: np.ndarray
    dalpha: np.ndarray
    dbeta: np.ndarray
    alpha_ratio: np.ndarray
    beta_ratio: np.ndarray


def lemma_2(friction, I):
    """The inequalities of ``Lemma2`` for a friction law."""
    friction, I = as_friction(friction), inertial("I", I)
    dmu, dalpha, dbeta = friction.dmu(I), friction.dalpha(I), friction.dbeta(I)
    return Lemma2(dmu, dalpha, dbeta, dalpha / dmu - 8 / 7, dbeta / dmu - 2 / 7)


def lemma_3(c, k, x):
    """Lemma 3 for growth rates: the limit eps -> 0 of one growth rate at fixed k and x, for C(phi) of form (form-of-C).

    As eps -> 0 at fixed p, I and z = (phi - phi0)/eps, Y_phi and f_phi rise like 1/eps, and with them Sigma and N (see
    ``dispersion``). Two growth rates go to infinity like +-sqrt(-k^2 Sigma/(rho Gamma)), sound if Sigma > 0; the third
    tends to -(k^2/R) N/Sigma, which at a critical state (f = 0) is that of the incompressible mu(I)-rheology. With
    |xi| -> infinity first it is bounded instead, by a cap proportional to 1/eps.
    """
    d = dispersion(c)
    return -np.square(real_array("k", k)) / c.density * at(d.N, x) / at(d.Sigma, x)


def kappa_window(c):
    """How far the equality B = C of (Cmu-well-posed-cond) may fail: well posed for low < C - B < high.

    With A, B, Gamma and t fixed, from the discriminant of det(M + N) as a quadratic in x::

        kappa = (2/t) [-A B -+ sqrt(A (t - A)(1 + t Gamma - B^2))]

    or, where its minimum is at x = -+1, from det(M + N) = 0 there. The window closes (to C = B alone) as A -> 0.

    Returns
    -------
    (low, high), of the shape of the states

    Raises
    ------
    ValueError    if |B| >= 1, A < 0 or Gamma <= 0
    """
    if np.any((np.abs(c.B) >= 1) | (c.A < 0) | (c.Gamma <= 0)):
        raise ValueError("the window needs |B| < 1, A >= 0 and Gamma > 0")
    gap = c.t - c.A
    root = np.sqrt(np.maximum(c.A * gap * (1 + c.t * c.Gamma - c.B**2), 0))
    reach = np.divide(root, gap, out=np.full(np.shape(root), np.inf), where=gap > 0)
    low, high = 2 / c.t * (-c.A * c.B - root), 2 / c.t * (-c.A * c.B + root)
    low = np.where(np.abs(c.B - reach) <= 1, low, -(1 + c.B) - c.A * c.Gamma / (1 + c.B))
    high = np.where(np.abs(c.B + reach) <= 1, high, 1 - c.B + c.A * c.Gamma / (1 - c.B))
    return low[()], high[()]
