"""The stress of a plane wave, point by point: from the wave's shear and stretch to the forces on its fronts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.granular.flow_rule import FlowRule, NoPressure, polish
from primer.granular.pressure import has_strength, solve

_QUICK = 12  # steps of Newton's method from the base state's pressure, before a bracket is looked for


@dataclass(frozen=True, eq=False)
class Frame:
    """A direction n and the base flow, in the axes of the base state's stress (xi_1 is compressed most).

    Attributes
    ----------
    n, m    (2,) along the wave, and along its fronts
    x       cos 2 theta = n_1^2 - n_2^2
    D       ||D|| of the base flow, whose trace-free part is diag(-D, D)
    div     its div u
    """

    n: np.ndarray
    m: np.ndarray
    x: float
    D: float
    div: float

    @classmethod
    def of(cls, D: float, div: float, theta: float) -> Frame:
        """The frame of a direction at the angle theta (radians) from the compressive axis.

        m is such that a base flow of simple shear moves the fronts towards +m.
        """
        n = np.array([math.cos(theta), math.sin(theta)])
        m = np.array([-n[1], n[0]]) * (-1.0 if n[0] * n[1] < 0 else 1.0)
        return cls(n, m, float((n[0] - n[1]) * (n[0] + n[1])), float(D), float(div))

    def rates(self, slope: np.ndarray) -> tuple[Any, Any, Any]:
        """(D_11 = -D_22, D_12, div u) from the s-derivatives of the velocity, (2, ...), or (1, ...) along m."""
        g1, g2 = slope if len(slope) == 2 else (self.m[0] * slope[0], self.m[1] * slope[0])
        n1, n2 = self.n
        div = self.div + (n1 * g1 + n2 * g2 if len(slope) == 2 else 0.0)
        return (n1 * g1 - n2 * g2) / 2 - self.D, (n1 * g2 + n2 * g1) / 2, div


@dataclass(frozen=True, eq=False)
class Local:
    """At each point: P, T, ||D||, I, the force T D n/||D|| - P n on a front (along m alone: (1, ...)), and reasons."""

    p: np.ndarray
    T: np.ndarray
    D: np.ndarray
    I: np.ndarray
    flux: np.ndarray
    reason: np.ndarray


@dataclass(frozen=True, eq=False)
class Load:
    """g(p) = load - p - q Y(p, phi, I): that the normal stress on the fronts is the load; for arrays of points."""

    law: Any
    load: float
    q: np.ndarray
    phi: np.ndarray
    scale: np.ndarray

    def at(self, index):
        """Some of the points."""
        return Load(self.law, self.load, self.q[index], self.phi[index], self.scale[index])

    def value(self, p):
        """g(p)."""
        return self.load - p - self.q * self.law.Y(p, self.phi, np.sqrt(self.scale / p))

    def slope(self, p):
        """p g'(p) = -p (1 + q B)."""
        I = np.sqrt(self.scale / p)
        return -p - self.q * (p * self.law.Y_p(p, self.phi, I) - I / 2 * self.law.Y_I(p, self.phi, I))


def local_stress(law, state, frame, slope, phi):
    """The ``Local`` stress of a wave in a base flow ``frame`` whose pressure is about that of ``state``."""
    slope = np.asarray(slope, dtype=float)
    e, o, div = frame.rates(slope)
    D = np.hypot(e, o)
    phi, div = np.broadcast_to(phi, D.shape).astype(float), np.broadcast_to(div, D.shape)
    along = len(slope) == 1
    find = _of_load if along else _of_flow
    p, T, I, reason = find(law, state, frame, div, D, phi)
    with np.errstate(all="ignore"):
        e, o = T * e / D, T * o / D
    n, m = frame.n, frame.m
    if along:
        flux = np.array([e * (m[0] * n[0] - m[1] * n[1]) + o * (m[0] * n[1] + m[1] * n[0])])
    else:
        flux = np.array([e * n[0] + o * n[1] - p * n[0], o * n[0] - e * n[1] - p * n[1]])
    return Local(p, T, D, I, flux, reason)


def forces(law, state, a, b, phi, creep=0.0):
    """The ``Local`` stress of a layer that is sheared at rates a and stretched across at rates b, force (2, n).

    Of the force on its planes the first part is along them, the second across; it does not stretch along itself.
    ``creep`` is added to ||D|| as the root of a sum of squares, so that the stress has no jump where shear stops.
    """
    D = np.hypot(np.hypot(a, b) / 2, creep)
    p, T, I, reason = _of_flow(law, state, None, b, D, phi)
    with np.errstate(all="ignore"):
        flux = np.array([T * a / (2 * D), T * b / (2 * D) - p])
    return Local(p, T, D, I, flux, reason)


def _of_flow(law, state, frame, div, D, phi):
    """P by the flow rule: Newton's method from the base state's, and ``solve`` where that does not settle."""
    n = D.size
    with np.errstate(all="ignore"):
        X, scale = div / (2 * D), state.rho * (2 * state.d * D) ** 2
    fine = np.isfinite(X) & np.isfinite(phi) & (scale > 0) & (scale < np.inf)
    fine &= has_strength(law, phi, fine)
    p, T, I = (np.full(n, np.nan) for _ in range(3))
    reason = np.full(n, NoPressure.NONE, dtype=object)
    index = np.flatnonzero(fine)
    rule = FlowRule(law, X[index], phi[index], scale[index])
    quick, settled = _newton(rule, np.full(index.size, float(state.p)))
    index, quick = index[settled], quick[settled]
    inertial = np.sqrt(scale[index] / quick)
    stress = law.Y(quick, phi[index], inertial)
    good = stress > 0
    index = index[good]
    p[index], T[index], I[index] = quick[good], stress[good], inertial[good]
    rest = np.setdiff1d(np.arange(n), index)
    if rest.size:
        one = np.ones(rest.size)
        p[rest], T[rest], I[rest], reason[rest] = solve(
            law, div[rest], D[rest], phi[rest], state.d * one, state.rho * one
        )
    return p, T, I, reason


def _of_load(law, state, frame, div, D, phi):
    """P of an incompressible law, by the momentum along n."""
    load = float(state.p + frame.x * law.Y(state.p, state.phi, state.I))
    n = D.size
    p, T, I = (np.full(n, np.nan) for _ in range(3))
    reason = np.full(n, NoPressure.NONE, dtype=object)
    reason[~np.isfinite(D)] = NoPressure.NOT_FINITE
    reason[np.isfinite(D) & ~(D > 0)] = NoPressure.NO_SHEAR
    index = np.flatnonzero(reason == NoPressure.NONE)
    scale = state.rho * (2 * state.d * D) ** 2
    rule = Load(law, load, frame.D * frame.x / D[index], phi[index], scale[index])
    found, settled = _newton(rule, np.full(index.size, float(state.p)))
    found[~settled] = np.nan
    if not settled.all():
        left = np.flatnonzero(~settled)
        found[left] = _bracketed(rule.at(left), state.p)
    lost = ~(found > 0)
    reason[index[lost]] = NoPressure.LOAD
    index, found = index[~lost], found[~lost]
    p[index], I[index] = found, np.sqrt(scale[index] / found)
    T[index] = law.Y(found, phi[index], I[index])
    return p, T, I, reason


def _newton(rule, start):
    """(p, settled) after a few steps from ``start``; p is kept positive."""
    p, todo = start, np.arange(start.size)
    settled = np.zeros(p.size, bool)
    for _ in range(_QUICK):
        if not todo.size:
            break
        part, at = rule.at(todo), p[todo]
        with np.errstate(all="ignore"):
            slope = part.slope(at)
            change = np.where(slope < 0, -part.value(at) / slope, np.nan)
            new = np.clip(at * (1 + change), at / 8, 8 * at)
        ok = np.isfinite(new) & (new > 1e-280) & (new < 1e280)
        p[todo[ok]] = new[ok]
        done = ok & (np.abs(change) <= 1e-13)
        settled[todo[done]] = True
        todo = todo[ok & ~done]
    return p, settled


def _bracketed(rule, start):
    """The root of a ``Load`` in a bracket about ``start``; nan where there is none within 60 factors of 4."""
    n = rule.q.size
    low, high = np.full(n, start / 4.0**60), np.full(n, float(start))
    for _ in range(60):
        up = rule.value(high) > 0
        if not up.any():
            break
        low[up], high[up] = high[up], 4 * high[up]
    good = (rule.value(low) > 0) & (rule.value(high) <= 0)
    p = np.full(n, np.nan)
    p[good] = polish(rule.at(np.flatnonzero(good)), low[good], high[good])
    return p
