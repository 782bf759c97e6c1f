"""Plane waves in a uniform flow as a problem in one space variable: the evolution equations (22), to be marched."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from primer.checks import instance, integer, real, shown
from primer.granular.dispersion import growth_rate
from primer.granular.linearisation import coefficients, reduced
from primer.granular.pointwise import Frame, Local, local_stress
from primer.granular.posedness import verdict
from primer.granular.state import BaseState
from primer.types import ArrayLike, Derivative, Law


@dataclass(frozen=True)
class PlaneWave:
    """u = L x + w(s, t) and phi(s, t), s = n.x, in eqs. (cons-mom-no-expl-stress) and (c-mass)::

        w_t + (n.w) w_s = [T D n/||D|| - P n]_s/(rho phi),    phi_t + (phi n.w)_s = 0
        D = D0 + the trace-free symmetric part of n w_s,      div u = div L + n.w_s

    with P and T of ``primer.granular.stress``: nonlinear in the wave. It is a problem for ``ftcs``, ``march_lines``,
    ``diagnose`` and ``march_waves``, with the fields (u_1, u_2, phi), u being w. The base state is uniform and steady.

    What is held, as the dispersion analysis holds it: the base flow L, the direction n and the mean of phi. So this
    leaves out that n turns and the wavelength changes (n_t = -L'n), that the mean of phi drifts with div L, and the
    term L w; it is true for times short against 1/||D||. With ``simple_shear`` nothing is left out: L shears along the
    wave fronts, n is its gradient (45 degrees from the compressive axis) and div L = 0; then L w is kept.

    An incompressible law has n.w = 0, one field u, the velocity along the front, phi constant, and the pressure from
    the momentum along n, which says that the normal stress on the fronts P - T n.D n/||D|| is that of the base state::

        u_t = [T m.D n/||D||]_s/(rho phi),    m = (-n_2, n_1)

    Parameters
    ----------
    law            a law, as in ``linearise``
    state          one ``BaseState`` that it admits; a critical one (div u = 0) for ``simple_shear``
    angle          degrees from the major compressive axis to n; None is the direction in which the shortest waves grow
                   fastest (decay slowest), as ``verdict`` names it; 45 for ``simple_shear``
    period         of the wave in s, in the unit of d; None is 100 d
    amplitude      of the longest wave in the initial data, times ||D|| d for a velocity and 1/1000 for phi
    modes          how many waves there are: k = 1, 2, ... in the period, of amplitude k^-2 and phases of their own
    simple_shear   keep all terms, where that is possible

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not as above

    >>> from primer.granular import CSSM, EXAMPLE_COMPACTION, BaseState
    >>> wave = PlaneWave(CSSM(0.4, EXAMPLE_COMPACTION), BaseState(p=0.2, phi=0.55, I=0.1), angle=50.0)
    >>> print(wave.fields, wave.period, f"{wave.growth(0.5):.4f}")
    ('u_1', 'u_2', 'phi') 100.0 0.2546
    """

    law: Law
    state: BaseState
    angle: Any = None
    period: Any = None
    amplitude: float = 0.0
    modes: int = 8
    simple_shear: bool = False

    def __post_init__(self) -> None:
        instance("state", self.state, BaseState)
        if self.state.shape != ():
            raise ValueError(f"state must be a single state, got shape {self.state.shape}")
        put = object.__setattr__
        self.coefficients  # the law must admit the state  # noqa: B018
        put(self, "angle", self._worst() if self.angle is None else real("angle", self.angle))
        period = 100 * self.state.d if self.period is None else real("period", self.period, above=0)
        put(self, "period", period)
        put(self, "amplitude", real("amplitude", self.amplitude, least=0))
        put(self, "modes", integer("modes", self.modes, least=1))
        if self.simple_shear and abs(abs(self.angle) - 45) > 1e-9:
            raise ValueError(f"angle must be 45 or -45 for simple_shear (n is the gradient), got {self.angle:g}")
        if self.simple_shear and abs(float(self.state.div_u(self.law))) > 1e-12 * float(self.state.D):
            raise ValueError(
                "state must be critical, div u = 0, for simple_shear; critical_state(law, phi, I) makes one"
            )

    def _worst(self):
        if self.simple_shear:
            return 45.0
        first, second = verdict(self.law, self.state).direction
        return math.degrees(math.atan2(second, first))

    @cached_property
    def coefficients(self) -> Any:
        """The ``Coefficients`` of the law at the base state."""
        return coefficients(self.law, self.state)

    @cached_property
    def frame(self) -> Frame:
        """The directions n and m in the axes of the base state's stress, and the base flow."""
        return Frame.of(self.state.D, float(self.state.div_u(self.law)), math.radians(self.angle))

    @property
    def incompressible(self) -> bool:
        """Whether the law is, so that the only field is the velocity along the fronts."""
        return self.coefficients.incompressible

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of the fields."""
        return ("u",) if self.incompressible else ("u_1", "u_2", "phi")

    @property
    def base(self) -> np.ndarray:
        """The fields of the base state: no wave, and its phi."""
        return np.zeros(1) if self.incompressible else np.array([0.0, 0.0, self.state.phi])

    @property
    def scale(self) -> np.ndarray:
        """The units of the fields: ||D|| d for a velocity, 1/1000 for phi, as in ``primer.granular.noise``."""
        speed = float(self.state.D * self.state.d)
        return np.array([speed] if self.incompressible else [speed, speed, 1e-3])

    def initial(self, x: ArrayLike) -> tuple[np.ndarray, ...]:
        """The base state, and waves of the given amplitude."""
        x = np.asarray(x, dtype=float)
        k = np.arange(1, self.modes + 1)
        out = []
        for j, (mean, unit) in enumerate(zip(self.base, self.scale, strict=True)):
            angle = 2 * np.pi / self.period * np.multiply.outer(x, k) + 2.4 * k * k + 2.1 * j
            wave = (np.cos(angle) / k**2).sum(axis=-1)
            out.append(mean + self.amplitude * unit * wave if self.amplitude else np.full(x.shape, mean))
        return tuple(out)

    def steady(self, x: ArrayLike) -> tuple[np.ndarray, ...]:
        """The base state."""
        return tuple(np.full(np.shape(x), mean) for mean in self.base)

    def forcing(self, x: ArrayLike) -> float:
        """Nothing is needed of x."""
        return 0.0

    def local(self, slope: ArrayLike, phi: ArrayLike) -> Local:
        """The stress at points where the fields' s-derivatives (velocities only) and phi are given."""
        return local_stress(self.law, self.state, self.frame, slope, phi)

    def rhs(self, x: ArrayLike, state: Any, derivative: Derivative, forcing: Any = None) -> tuple[np.ndarray, ...]:
        """The time derivatives of the fields; nan at points without a pressure (and at their neighbours)."""
        state = np.asarray(state)
        rho = self.state.rho
        if self.incompressible:
            found = self.local(derivative(state, 1), self.state.phi)
            return (derivative(found.flux[0], 1) / (rho * self.state.phi),)
        w, phi = state[:2], state[2]
        w_s = derivative(w, 1)
        found = self.local(w_s, phi)
        n = self.frame.n
        across = n[0] * w[0] + n[1] * w[1]
        w_t = derivative(found.flux, 1) / (rho * phi) - across * w_s
        if self.simple_shear:
            w_t = w_t - 2 * self.state.D * self.frame.m[:, None] * across
        return (*w_t, -derivative(phi * across, 1))

    def symbol(self, multiplier: ArrayLike) -> np.ndarray:
        """The linearised right-hand side for waves of which d/ds makes i s: shape (k, fields, fields) for (k,) such.

        From the ``reduced`` equations (e33), not from ``rhs``; s = xi in the continuum and sin(xi h)/h on a grid.
        """
        s = np.imag(np.asarray(multiplier, dtype=complex))
        if self.incompressible:
            return growth_rate(self.coefficients, s, self.frame.x)[..., None, None] + 0j
        A = -reduced(self.coefficients, s * self.frame.n.reshape(2, *[1] * s.ndim))
        if self.simple_shear:
            A[..., :2, :2] -= 2 * self.state.D * np.outer(self.frame.m, self.frame.n)
        return A

    def growth(self, xi: ArrayLike) -> Any:
        """The largest growth rate of a wave of wavenumber xi in the continuum, of the shape of xi."""
        return np.linalg.eigvals(self.symbol(1j * np.asarray(xi, dtype=float))).real.max(axis=-1)[()]

    def replace(self, **changes: Any) -> PlaneWave:
        """The same with other arguments."""
        given = {name: getattr(self, name) for name in self.__dataclass_fields__}
        unknown = [name for name in changes if name not in given]
        if unknown:
            raise TypeError(f"{shown(unknown[0])} must be one of {', '.join(given)}")
        return PlaneWave(**{**given, **changes})
