"""From a law and a base state to the frozen, linearised equations: the pencil (e26), (e25) and its 3 x 3 reduction.

Everything is in the frame of the base state's stress: xi_1 runs along the major compressive axis (psi* = 0). The mean
flow only turns lambda into lambda + i <u*, xi> and is left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from primer.checks import real_array
from primer.granular.state import BaseState, admit
from primer.types import Law, Numbers

if TYPE_CHECKING:
    from primer.analysis.pencil import Pencil


@dataclass(frozen=True, eq=False)
class Coefficients:
    """The numbers in the linearised equations (21a-e), for one state or an array of them; eqs. (e22-a) and (e22-b)::

        A = I Y_I/(2 ||D||),    B = Y_p - I/(2p) Y_I,    C = f + I f_I,    Gamma = -2 ||D|| (f_p - I/(2p) f_I)

    and t = tau/(2 ||D||). A and t are viscosities, Gamma an inverse viscosity, B and C dimensionless. The paper's
    hypothesis (Cmu-well-posed-cond) is B = C; it is not assumed here.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    Gamma: np.ndarray
    t: np.ndarray
    tau: np.ndarray
    Y_phi: np.ndarray
    f_phi: np.ndarray
    D: np.ndarray
    phi: np.ndarray
    rho: np.ndarray
    incompressible: bool = False

    @property
    def density(self) -> Numbers:
        """rho* phi*, the mass per volume."""
        return self.rho * self.phi


def coefficients(law: Law, state: BaseState) -> Coefficients:
    """The ``Coefficients`` of a law at a base state, eqs. (e22-a) and (e22-b), arrays of the state's shape.

    Raises
    ------
    ValueError    if the law does not admit the state (see ``admit``)
    """
    tau = admit(law, state)
    p, phi, I, D = state.p, state.phi, state.I, state.D
    Y_p, Y_phi, Y_I = law.Y_p(p, phi, I), law.Y_phi(p, phi, I), law.Y_I(p, phi, I)
    f, f_p, f_phi, f_I = law.f(p, phi, I), law.f_p(p, phi, I), law.f_phi(p, phi, I), law.f_I(p, phi, I)
    values = {
        "A": I * Y_I / (2 * D),
        "B": Y_p - I * Y_I / (2 * p),
        "C": f + I * f_I,
        "Gamma": -2 * D * (f_p - I * f_I / (2 * p)),
        "t": tau / (2 * D),
        "tau": tau,
        "Y_phi": Y_phi,
        "f_phi": f_phi,
        "D": D,
        "phi": phi,
        "rho": state.rho,
    }
    arrays = {name: np.broadcast_to(real_array(name, value), state.shape)[()] for name, value in values.items()}
    return Coefficients(**arrays, incompressible=getattr(law, "incompressible", False))


def linearise(law: Law, state: BaseState) -> Pencil:
    """The pencil lambda E q = -S(xi) q of eqs. (e24) to (e26) for one base state.

    The unknowns are q = (u_1, u_2, phi, p, psi), and S is 5 x 5; the column of p carries B and the fourth row C, which
    the paper takes to be equal. For an incompressible law phi is a constant, not an unknown: q = (u_1, u_2, p, psi),
    S is 4 x 4 and its third row is div u = 0.

    Returns
    -------
    primer.analysis.pencil.Pencil in two space variables

    Raises
    ------
    ValueError    if the law does not admit the state, or state is an array of states (``symbol`` serves those)
    """
    from primer.analysis.pencil import Pencil

    c = coefficients(law, state)
    if state.shape != ():
        raise ValueError(f"state must be a single state to make a pencil, got shape {state.shape}")
    return Pencil(lambda xi: symbol(c, xi), mass(c), dim=2)


def symbol(c, xi):
    """S(xi) of eq. (e26).

    Parameters
    ----------
    c : Coefficients
    xi : array of shape (2,) + s    wavevectors, s broadcast against the shape of the coefficients

    Returns
    -------
    complex array of shape broadcast + (5, 5), or (4, 4) for an incompressible law
    """
    x1, x2 = wavevectors(c, xi)
    S = np.zeros((*x1.shape, 5, 5), dtype=complex)
    S[..., 0, 0], S[..., 0, 1], S[..., 1, 1] = c.A * x1**2, -c.A * x1 * x2, c.A * x2**2
    S[..., 1, 0] = S[..., 0, 1]
    S[..., 0, 2], S[..., 1, 2] = 1j * c.Y_phi * x1, -1j * c.Y_phi * x2
    S[..., 0, 3], S[..., 1, 3] = 1j * (1 + c.B) * x1, 1j * (1 - c.B) * x2
    S[..., 0, 4], S[..., 1, 4] = 2j * c.tau * x2, 2j * c.tau * x1
    S[..., 2, 0], S[..., 2, 1] = 1j * c.phi * x1, 1j * c.phi * x2
    S[..., 3, 0], S[..., 3, 1] = 1j * (1 + c.C) * x1, 1j * (1 - c.C) * x2
    S[..., 3, 2], S[..., 3, 3] = -2 * c.D * c.f_phi, c.Gamma
    S[..., 4, 0], S[..., 4, 1], S[..., 4, 4] = 1j * x2, 1j * x1, 4 * c.D
    return _without_phi(S) if c.incompressible else S


def mass(c):
    """E of eq. (e25), of the shape of the coefficients + (5, 5), or (4, 4) for an incompressible law."""
    E = np.zeros((*np.shape(c.density), 5, 5))
    E[..., 0, 0] = E[..., 1, 1] = c.density
    E[..., 2, 2] = 1
    return _without_phi(E) if c.incompressible else E


def reduced(c, xi):
    """P(xi) of eqs. (e33) and (matrix): the growth rates are the eigenvalues of -P, with q = (u_1, u_2, phi).

    The Schur complement S11 - S12 S22^{-1} S21 over the pressure and the stress angle, divided by E11::

        P = [[(M + N)/(rho phi), i V/(rho phi)], [i phi xi^T, 0]]

    Returns
    -------
    complex array of shape broadcast + (3, 3)

    Raises
    ------
    ValueError    if Gamma = 0, as for an incompressible law: then no pressure can be eliminated
    """
    x1, x2 = wavevectors(c, xi)
    P = np.zeros((*x1.shape, 3, 3), dtype=complex)
    P[..., :2, :2] = (M(c, xi) + N(c, xi)) / np.expand_dims(c.density, (-1, -2))
    P[..., :2, 2] = 1j * V(c, xi) / np.expand_dims(c.density, -1)
    P[..., 2, 0], P[..., 2, 1] = 1j * c.phi * x1, 1j * c.phi * x2
    return P


def M(c, xi):
    """M of eq. (e39): what the rate dependence of Y adds, of shape broadcast + (2, 2)."""
    x1, x2 = wavevectors(c, xi)
    w = np.stack([x1, -x2], axis=-1)
    return np.expand_dims(c.A, (-1, -2)) * w[..., :, None] * w[..., None, :]


def N(c, xi):
    """N of eq. (new-formula-N): what the elimination of p and psi adds, of shape broadcast + (2, 2).

    Not symmetric unless B = C, which the paper assumes.
    """
    _needs_gamma(c)
    x1, x2 = wavevectors(c, xi)
    b = np.stack([(1 + c.B) * x1, (1 - c.B) * x2], axis=-1)
    d = np.stack([(1 + c.C) * x1, (1 - c.C) * x2], axis=-1)
    s = np.stack([x2, x1], axis=-1)
    gamma, t = np.expand_dims(c.Gamma, (-1, -2)), np.expand_dims(c.t, (-1, -2))
    return b[..., :, None] * d[..., None, :] / gamma + t * s[..., :, None] * s[..., None, :]


def V(c, xi):
    """V of eq. (e36): how solids fraction drives the flow, of shape broadcast + (2,)."""
    _needs_gamma(c)
    x1, x2 = wavevectors(c, xi)
    g = 2 * c.D * c.f_phi / c.Gamma
    return np.stack([(c.Y_phi + (1 + c.B) * g) * x1, (-c.Y_phi + (1 - c.B) * g) * x2], axis=-1)


def wavevectors(c, xi):
    """(xi_1, xi_2), broadcast against the coefficients."""
    xi = real_array("xi", xi)
    if xi.ndim == 0 or len(xi) != 2:
        raise ValueError(f"xi must have shape (2, ...), got shape {xi.shape}")
    shape = np.broadcast_shapes(xi.shape[1:], np.shape(c.A))
    return np.broadcast_to(xi[0], shape), np.broadcast_to(xi[1], shape)


def _needs_gamma(c):
    if np.any(np.asarray(c.Gamma) == 0):
        raise ValueError("Gamma must not be 0: the pressure of an incompressible law is not a function of the flow")


def _without_phi(matrix):
    keep = [0, 1, 3, 4]
    return matrix[..., keep, :][..., keep]
