"""The flow rule f(p, phi, I) = div u/(2 ||D||) solved for the pressure, for many states at once, eq. (20)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from primer.types import Law

_RUNGS = 10.0 ** np.array([-128, -64, -32, -16, *range(-8, 9), 16, 32, 64, 128])  # of I, in rising order
_LEAST, MOST = 1e-290, 1e290  # of p: its square root and its reciprocal are numbers


class NoPressure(StrEnum):
    """Why a flow has no pressure by eq. (flow-rule-Cmu-rewritten); ``NONE`` where it has one.

    >>> from primer.granular import CSSM, Compaction, stress
    >>> soil = CSSM(0.4, Compaction(phi0=0.5, eps=0.1, C0=1.0))
    >>> print(*stress(soil, [0.0, 9.0, -9.0, 0.0], 1.0, [0.55, 0.55, 0.55, 0.6]).reason, sep=", ")
    none, expands too fast, no yield stress, phi out of range
    """

    NONE = "none"
    NOT_FINITE = "not finite"  # div u, ||D|| or phi is nan or infinite, or ||D||^2 close to it
    NO_SHEAR = "no shear"  # ||D|| = 0, or its square is: neither I nor div u/(2 ||D||) has a value
    PHI = "phi out of range"  # the law has no C(phi) there
    TOO_FAST = "expands too fast"  # div u/(2 ||D||) is not below f at any pressure, down to the smallest
    NEVER = "contracts too fast"  # f stays above div u/(2 ||D||) at every pressure
    MANY = "not one pressure"  # f does not fall with pressure, (b) fails: several pressures, or a rising one
    YIELD = "no yield stress"  # the flow rule has a pressure, at which Y is not positive
    LOAD = "no balance"  # of an incompressible law: no pressure balances the normal stress on the fronts of a wave


@dataclass(frozen=True, eq=False)
class FlowRule:
    """g(p) = f(p, phi, sqrt(scale/p)) - X and p g'(p), for arrays of states."""

    law: Law
    X: np.ndarray
    phi: np.ndarray
    scale: np.ndarray

    def at(self, index: np.ndarray) -> Any:
        """Some of the states."""
        return FlowRule(self.law, self.X[index], self.phi[index], self.scale[index])

    def value(self, p: np.ndarray) -> np.ndarray:
        """g(p)."""
        with np.errstate(all="ignore"):
            return self.law.f(p, self.phi, np.sqrt(self.scale / p)) - self.X

    def slope(self, p: np.ndarray) -> np.ndarray:
        """p g'(p) = p f_p - I f_I/2, eq. (partial-der-for-IFT) times p."""
        I = np.sqrt(self.scale / p)
        with np.errstate(all="ignore"):
            return p * self.law.f_p(p, self.phi, I) - I / 2 * self.law.f_I(p, self.phi, I) + 0 * p


def root(rule):
    """(p, reason): one bracket from a ladder of inertial numbers, then ``polish``."""
    n = rule.X.size
    low, high = np.full(n, np.nan), np.full(n, np.nan)
    changes, rises = np.zeros(n, int), np.zeros(n, bool)
    first = before = here = np.zeros(0, bool)
    for rung in _RUNGS[::-1]:  # from the smallest pressure up
        with np.errstate(over="ignore"):
            p = np.clip(rule.scale * rung**-2.0, _LEAST, MOST)
        sign = rule.value(p) > 0
        if not first.size:
            first, here = sign, p
        else:
            new = sign != before
            changes += new
            fall = new & before
            rises |= new & ~before
            low[fall], high[fall] = here[fall], p[fall]
        before, here = sign, p
    reason = np.full(n, NoPressure.NONE, dtype=object)
    reason[(changes > 1) | rises] = NoPressure.MANY
    reason[(changes == 0) & first] = NoPressure.NEVER
    reason[(changes == 0) & ~first] = NoPressure.TOO_FAST
    p = np.full(n, np.nan)
    good = np.flatnonzero(reason == NoPressure.NONE)
    p[good] = polish(rule.at(good), low[good], high[good])
    rising = good[~(rule.at(good).slope(p[good]) < 0)]
    reason[rising], p[rising] = NoPressure.MANY, np.nan
    return p, reason


def polish(rule, low, high, start=None):
    """The root of a ``FlowRule`` between low and high, g(low) > 0 >= g(high): Newton's method, halved in log p."""
    low, high = low.copy(), high.copy()
    p = np.sqrt(low) * np.sqrt(high) if start is None else start
    todo = np.arange(p.size)
    for _ in range(200):  # halving alone takes 70 from the widest bracket
        part, at = rule.at(todo), p[todo]
        g = part.value(at)
        above = g > 0
        low[todo[above]], high[todo[~above]] = at[above], at[~above]
        with np.errstate(all="ignore"):
            new = at - at * g / part.slope(at)
        inside = (new > low[todo]) & (new < high[todo])
        halved = np.sqrt(low[todo]) * np.sqrt(high[todo])
        settled = (np.abs(new - at) <= 2e-16 * at) | (g == 0)
        new = np.where(inside, new, halved)
        p[todo] = np.where(settled, at, new)
        todo = todo[~settled & (high[todo] > low[todo] * (1 + 3e-16))]
        if not todo.size:
            break
    return p
