"""The paper's toy system, eq. (toy-pde): well posed where u > 0, ill posed where u < 0."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from primer.arithmetic import constant, cos, sin
from primer.checks import broadcast, function, real, real_array, shown
from primer.equations.evaluate import Known, Scalars, tendencies
from primer.equations.slopes import about
from primer.equations.stages import Evolution, evolution
from primer.types import ArrayLike, Derivative, Multiplier, Numbers


def tendency(u, v, u_x, v_x, v_xx, sin_x, eps):
    """(u_t, v_t) of eq. (toy-pde), point by point.

    The one text of the equation: arrays, machine numbers inside the compiled kernel, multiprecision numbers and symbols
    all pass through it, in this order of operations.
    """
    return v_x, eps * u * v_xx + u_x - v - sin_x


@dataclass(frozen=True)
class Toy:
    """The toy system of eq. (toy-pde), on x in [-pi, pi) with period 2 pi (dimensionless)::

        u_t = v_x
        v_t = eps u v_xx + u_x - v - sin x

    from u = a, v = -sin(x)/2, eq. (toy-initial). The steady state u = a - cos x, v = 0 of eq. (toy-steady) is positive
    everywhere when a > 1; for a < 1 it dips below zero, and there the equations are ill posed.

    Parameters
    ----------
    a : float      the base state: the mean of u, which the equations conserve
    eps : float    the coefficient of the second derivative, eps >= 0

    Raises
    ------
    TypeError, ValueError    if a or eps is not a finite real number, or eps < 0

    >>> toy = Toy(a=0.5, eps=0.01)
    >>> u, v = toy.steady(0.0)  # u = a - cos x is negative here
    >>> print(f"{u:.1f}, {v:.1f}")
    -0.5, 0.0
    >>> growth = np.linalg.eigvals(toy.symbol(1e4, u=-0.5)).real.max()
    >>> print(f"{growth:.0f}")  # -eps u xi^2 - 1 + 1/(eps u), eq. (toy-eig)
    499799
    """

    a: float
    eps: float = 0.01
    fields: ClassVar[tuple[str, ...]] = ("u", "v")
    text: ClassVar[str] = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"

    def __post_init__(self) -> None:
        object.__setattr__(self, "a", real("a", self.a))
        object.__setattr__(self, "eps", real("eps", self.eps, least=0))

    def initial(self, x: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """(u, v) at t = 0, eq. (toy-initial); x of any shape."""
        return constant(x, self.a), -sin(x) / 2

    def steady(self, x: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """(u, v) as t -> infinity, eq. (toy-steady); a steady state for every eps, stable only where u > 0."""
        return self.a - cos(x), constant(x, 0)

    def exact(self, x: ArrayLike, t: ArrayLike) -> tuple[Numbers, Numbers]:
        """(u, v) at time t for eps = 0, eq. (toy-sln), of the broadcast shape of x and t.

        With w = sqrt(3)/2 the paper's sums of cosines are products::

            u = a - cos x + e^{-t/2} cos(x) cos(w t)
            v = -e^{-t/2} sin(x) sin(w t + pi/6)

        Raises
        ------
        ValueError    if eps is not 0: no closed form is known there
        """
        if self.eps != 0:
            raise ValueError(f"eps must be 0 for the exact solution (toy-sln), got {self.eps!r}; use a numerical one")
        x, t = broadcast(x=real_array("x", x), t=real_array("t", t))
        w, decay = math.sqrt(3) / 2, np.exp(-t / 2)
        u = self.a - np.cos(x) + decay * np.cos(x) * np.cos(w * t)
        v = -decay * np.sin(x) * np.sin(w * t + math.pi / 6)
        return u, v

    def forcing(self, x: ArrayLike) -> np.ndarray:
        """sin x: what the right-hand side needs of x alone, so that a time loop computes it once."""
        return sin(x)

    def rhs(
        self, x: ArrayLike, state: Sequence[np.ndarray], derivative: Derivative, forcing: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """(u_t, v_t) of eq. (toy-pde).

        ``derivative(f, m)`` gives the m-th x-derivative of a field on x; ``forcing`` is ``self.forcing(x)``, where it
        is at hand.
        """
        sin_x = self.forcing(x) if forcing is None else forcing
        u_t, v_t = tendencies(self.evolution, self.parameters, state, derivative, self._known(sin_x))
        return u_t, v_t

    @property
    def evolution(self) -> Evolution:
        """The right-hand side as stages, made from the text."""
        return evolution(self.text, ("eps",))

    @property
    def parameters(self) -> dict[str, float]:
        """The parameters that occur in the equations."""
        return {"eps": self.eps}

    def known(self, x: ArrayLike) -> Known:
        """What a time loop computes once: eps, in the numbers of x, and sin x."""
        return self._known(self.forcing(x))

    def _known(self, sin_x):
        scalars = Scalars.of(sin_x)
        return Known(scalars, (scalars.number(self.eps),), (sin_x,))

    def symbol(
        self, xi: ArrayLike, u: ArrayLike, v_xx: ArrayLike = 0.0, multiplier: Multiplier | None = None
    ) -> np.ndarray:
        """The frozen-coefficient matrix of eq. (toy-mat): perturbations e^{i xi x + lam t} grow at its eigenvalues lam.

        Parameters
        ----------
        xi : array        wavenumbers, of shape s
        u, v_xx : array   the base state (u*, v_xx*) at the frozen point, broadcast against xi
        multiplier        ``multiplier(xi, m)`` is what the m-th derivative does to e^{i xi x}; left out, it is that of
                          the continuum, (i xi)^m, and a grid's ``Grid.multiplier`` gives the discrete symbol

        Returns
        -------
        complex array of shape s + (2, 2), with det(lam - S) = lam^2 + (1 + eps u* xi^2) lam + xi^2 - i eps xi v_xx*
        """
        xi, u, v_xx = broadcast(xi=real_array("xi", xi), u=real_array("u", u), v_xx=real_array("v_xx", v_xx))
        if multiplier is not None:
            function("multiplier", multiplier, "xi and m")
        base = {(0, 0): u, (1, 2): v_xx}
        slots = [{slot: base.get(slot, 0.0) for slot in stage.slots} for stage in self.evolution.stages]
        with np.errstate(over="ignore", invalid="ignore"):
            frozen = about(self.evolution, self.parameters, slots, self._known(np.zeros(1)))
            S = frozen.symbol(lambda m: multiplier(xi, m) if multiplier else (1j * xi) ** m)
        if not np.isfinite(S).all():
            raise ValueError(f"xi, u and v_xx must leave the symbol finite, got xi = {shown(xi)} and u = {shown(u)}")
        return S
