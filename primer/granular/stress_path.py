"""The stress path of Appendix 1.2: uniform shear under a load, from any state to the critical state."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from primer.checks import affordable, instance, integer, real, shown
from primer.granular.pressure import stress
from primer.granular.state import BaseState, admit
from primer.types import Law

_CLOSE = 1e-9  # of div u/(2 ||D||): nearer to its ends -1 and 1 than this no layer is looked at


@dataclass(frozen=True, eq=False)
class StressPath:
    """Uniform shear of a layer under a load; arrays of shape (r,).

    Attributes
    ----------
    law, load, shear    the law, the normal stress on the layer, and the rate of shear gamma
    t, phi              times, and the solids fraction then
    p, tau, I           pressure, shear stress ||tau|| and inertial number
    div                 div u: above 0 the layer expands
    """

    law: Any
    load: float
    shear: float
    t: np.ndarray = field(repr=False)
    phi: np.ndarray = field(repr=False)
    p: np.ndarray = field(repr=False)
    tau: np.ndarray = field(repr=False)
    I: np.ndarray = field(repr=False)
    div: np.ndarray = field(repr=False)


def stress_path(law: Law, state: BaseState, strain: float = 5.0, points: int = 100) -> StressPath:
    """Shear a uniform layer at a constant rate under a constant load, and follow phi' = -phi div u.

    Section A1.2 says that deformation drives the stress to a critical state, eq. (crit-state-line). What is held it
    leaves open; here it is what a shear box holds: the rate of shear gamma along the layer, and the normal stress on
    it, p - f ||tau|| = load, both those of the state at the start. The layer does not stretch along itself, so that
    ||D||^2 (1 - f^2) = gamma^2/4. At the end f = 0 and p is the load: less than in a state B that dilates, and more
    than in a state A that contracts.

    Parameters
    ----------
    law      a compressible law, as in ``linearise``
    state    one ``BaseState`` with |f| < 1
    strain   gamma t at the end, > 0
    points   how many times are recorded, evenly spaced

    Raises
    ------
    TypeError, ValueError    if the law does not admit the state, is incompressible, or |f| >= 1 there

    >>> from primer.granular import CSSM, EXAMPLE_COMPACTION, BaseState
    >>> path = stress_path(CSSM(0.4, EXAMPLE_COMPACTION), BaseState(p=0.25, phi=0.55, I=0.1))
    >>> print(f"{path.p[0]:.3f} to {path.p[-1]:.3f}, tau/p from {path.tau[0] / path.p[0]:.3f} to 0.400")
    0.250 to 0.209, tau/p from 0.550 to 0.400
    """
    from scipy.integrate import solve_ivp

    instance("state", state, BaseState)
    strain, points = real("strain", strain, above=0), integer("points", points, least=2)
    affordable("points: six numbers at each", 48 * points, shown(points))
    tau = admit(law, state)
    if state.shape != ():
        raise ValueError(f"state must be a single state, got shape {state.shape}")
    if getattr(law, "incompressible", False):
        raise ValueError(
            f"law must be compressible, as no volume changes on the way to a critical state, got {shown(law)}"
        )
    f = float(law.f(state.p, state.phi, state.I))
    if not abs(f) < 1:
        raise ValueError(f"state must have |f| < 1, or no layer shears like this, got f = {f:g}")
    shear, load = 2 * float(state.D) * math.sqrt(1 - f * f), float(state.p - f * tau)
    layer = ShearBox(law, shear, load, float(state.d), float(state.rho))
    end = strain / shear
    near = [np.array([state.p, f])]  # the last solution, from which the next one is looked for

    def slope(t, y):
        near[0] = layer.solve(y[0], near[0])
        return -y * layer.rate(near[0][1])

    times = np.linspace(0, end, points)
    found = solve_ivp(slope, (0, end), [state.phi], method="LSODA", rtol=1e-9, atol=1e-12, t_eval=times)
    phi = found.y[0]
    div = np.array([layer.rate(layer.solve(each, near[0])[1]) for each in phi])
    at = stress(law, div, np.hypot(shear, div) / 2, phi, state.d, state.rho)
    return StressPath(law, load, shear, found.t, phi, at.p, at.T, at.I, div)


@dataclass(frozen=True)
class ShearBox:
    """A uniform layer that is sheared at the rate ``shear`` under ``load``."""

    law: Any
    shear: float
    load: float
    d: float
    rho: float

    def rate(self, X: float) -> float:
        """div u from X = div u/(2 ||D||)."""
        return self.shear * X / math.sqrt(1 - X * X)

    def solve(self, phi: float, near: np.ndarray) -> np.ndarray:
        """(p, X) at this phi: the flow rule, and p - X ||tau|| = load."""
        from scipy.optimize import brentq, fsolve

        def gaps(unknown):
            p, X = unknown
            I = self.d * self.shear / math.sqrt(max(1 - X * X, _CLOSE) * max(p, _CLOSE * self.load) / self.rho)
            f, Y = self.law.f(p, phi, I), self.law.Y(p, phi, I)
            return [X - float(f), float(p - X * Y) / self.load - 1]

        try:
            found, _, good, _ = fsolve(gaps, near, xtol=1e-13, full_output=True)
        except ValueError:  # a p or I on the way that the law does not take
            good = 0
        if good == 1 and abs(found[1]) < 1 and found[0] > 0 and max(map(abs, gaps(found))) < 1e-9:
            return found
        X = brentq(self.excess, -1 + _CLOSE, 1 - _CLOSE, args=(phi,), xtol=1e-15, rtol=1e-14)
        D = self.shear / (2 * math.sqrt(1 - X * X))
        return np.array([stress(self.law, 2 * X * D, D, phi, self.d, self.rho).p, X])

    def excess(self, X: float, phi: float) -> float:
        """p - X ||tau|| - load over the load, falling with X; 1 where the law has no yield stress any more."""
        D = self.shear / (2 * math.sqrt(1 - X * X))
        found = stress(self.law, 2 * X * D, D, phi, self.d, self.rho)
        if found.reason == "none":
            return float(np.clip((found.p - X * found.T) / self.load - 1, -1, 1))
        return 1.0 if X < 0 else -1.0  # too fast a contraction is held by any load, too fast an expansion by none
