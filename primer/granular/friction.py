"""Friction laws mu(I) and the alpha(I), beta(I) that Lemma 1 makes of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.checks import affordable, broadcast, function, real, real_array, shown
from primer.types import ArrayLike, FrictionLaw, Numbers

#: The tail constant of the connection formula: pi/sin(2 pi/5) = int_0^inf s^{-3/5}/(1 + s) ds.
_TAIL = math.pi / math.sin(2 * math.pi / 5)


@dataclass(frozen=True)
class MuI:
    """The friction law of eq. (canonical-mu), with Lemma 1 in closed form (everything dimensionless)::

        mu(I) = mu1 + (mu2 - mu1)/(I0/I + 1)
        alpha = 4/5 mu + 6/5 mu1 + 12/25 (mu2 - mu1) J(I/I0)
        beta = -2/5 mu + 12/5 mu1 + 24/25 (mu2 - mu1) J(I/I0)

    where J(r) = r^{-2/5} int_0^r s^{2/5}/(1 + s) ds = (5/7) r 2F1(1, 7/5; 12/5; -r). Full accuracy for every I >= 0:
    alpha and beta rise from 2 mu1 at I = 0 to 2 mu2 as I -> infinity.

    Parameters
    ----------
    mu1, mu2 : float    the friction as I -> 0 and as I -> infinity, 0 < mu1 < mu2
    I0 : float          the inertial number half-way between, I0 > 0

    Raises
    ------
    TypeError, ValueError    if a parameter is not a finite number in its range

    >>> beads = MuI(mu1=0.383, mu2=0.643, I0=0.279)
    >>> print(f"{beads.mu(0.279):.4f}")
    0.5130
    >>> print(f"{beads.alpha(0.1) - beads.beta(0.1) / 2 - beads.mu(0.1):.12f}")  # eq. (Cmu-limit-beh-2)
    0.000000000000
    """

    mu1: float
    mu2: float
    I0: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "mu1", real("mu1", self.mu1, above=0))
        object.__setattr__(self, "mu2", real("mu2", self.mu2))
        object.__setattr__(self, "I0", real("I0", self.I0, above=0))
        if not self.mu2 > self.mu1:
            raise ValueError(f"mu2 must be > mu1 = {self.mu1!r} so that friction rises with I, got {self.mu2!r}")

    def mu(self, I: ArrayLike) -> Numbers:
        """mu(I), of the shape of I."""
        r = self._ratio(I)
        return self.mu1 + (self.mu2 - self.mu1) * (r / (1 + r))

    def dmu(self, I: ArrayLike) -> Numbers:
        """mu'(I) = (mu2 - mu1)/I0/(1 + I/I0)^2 > 0."""
        return (self.mu2 - self.mu1) / self.I0 * (1 / (1 + self._ratio(I))) ** 2

    def ddmu(self, I: ArrayLike) -> Numbers:
        """mu''(I) = -2 (mu2 - mu1)/I0^2/(1 + I/I0)^3 < 0."""
        return -2 * (self.mu2 - self.mu1) / self.I0**2 * (1 / (1 + self._ratio(I))) ** 3

    def alpha(self, I: ArrayLike) -> Numbers:
        """alpha(I) of eq. (Cmu-formulas-for-alpha)."""
        return 0.8 * self.mu(I) + 1.2 * self.mu1 + 0.48 * (self.mu2 - self.mu1) * _J(self._ratio(I))[0]

    def beta(self, I: ArrayLike) -> Numbers:
        """beta(I) of eq. (Cmu-formulas-for-beta)."""
        return -0.4 * self.mu(I) + 2.4 * self.mu1 + 0.96 * (self.mu2 - self.mu1) * _J(self._ratio(I))[0]

    def dalpha(self, I: ArrayLike) -> Numbers:
        """alpha'(I) = 4/5 mu' + 12/25 (mu2 - mu1)/I0 J'(I/I0)."""
        return 0.8 * self.dmu(I) + 0.48 * (self.mu2 - self.mu1) / self.I0 * _J(self._ratio(I))[1]

    def dbeta(self, I: ArrayLike) -> Numbers:
        """beta'(I) = -2/5 mu' + 24/25 (mu2 - mu1)/I0 J'(I/I0)."""
        return -0.4 * self.dmu(I) + 0.96 * (self.mu2 - self.mu1) / self.I0 * _J(self._ratio(I))[1]

    def _ratio(self, I):
        return inertial("I", I) / self.I0


@dataclass(frozen=True)
class Friction:
    """Any friction law, given as functions; alpha and beta of Lemma 1 by quadrature (everything dimensionless)::

        alpha = 4/5 mu + 12/25 K,    beta = -2/5 mu + 24/25 K,    K(I) = int_0^1 s^{-3/5} mu(s I) ds
        K'(I) = int_0^1 s^{2/5} mu'(s I) ds

    with s = e^{-y} and a Gauss rule on panels in y: accurate to about 1e-14 where mu is smooth on a scale of a factor
    of e in I. ``Friction(law.mu, law.dmu)`` is the quadrature route for a law that has a closed form.

    Parameters
    ----------
    mu, dmu : callable    mu(I) and its derivative mu'(I), each taking and giving arrays, for I >= 0

    >>> still = Friction(lambda I: 0.4 + 0 * I, lambda I: 0 * I)
    >>> print(f"{still.alpha(0.1):.6f} {still.beta(0.1):.6f}")  # both 2 mu: CIDR is then CSSM
    0.800000 0.800000
    """

    mu: Callable
    dmu: Callable

    def __post_init__(self) -> None:
        for name in ("mu", "dmu"):
            function(name, getattr(self, name), "I")

    def alpha(self, I: ArrayLike) -> Numbers:
        """alpha(I) of eq. (Cmu-formulas-for-alpha)."""
        return 0.8 * self.mu(inertial("I", I)) + 0.48 * _mean(self.mu, I, -3 / 5)

    def beta(self, I: ArrayLike) -> Numbers:
        """beta(I) of eq. (Cmu-formulas-for-beta)."""
        return -0.4 * self.mu(inertial("I", I)) + 0.96 * _mean(self.mu, I, -3 / 5)

    def dalpha(self, I: ArrayLike) -> Numbers:
        """alpha'(I)."""
        return 0.8 * self.dmu(inertial("I", I)) + 0.48 * _mean(self.dmu, I, 2 / 5)

    def dbeta(self, I: ArrayLike) -> Numbers:
        """beta'(I)."""
        return -0.4 * self.dmu(inertial("I", I)) + 0.96 * _mean(self.dmu, I, 2 / 5)


def as_friction(law: FrictionLaw) -> Any:
    """``law`` if it has alpha and beta, else a ``Friction`` of its mu and dmu.

    Raises
    ------
    TypeError    if it has no mu and dmu
    """
    if all(callable(getattr(law, name, None)) for name in ("mu", "dmu", "alpha", "beta", "dalpha", "dbeta")):
        return law
    if callable(getattr(law, "mu", None)) and callable(getattr(law, "dmu", None)):
        return Friction(law.mu, law.dmu)
    raise TypeError(f"friction must have the functions mu(I) and dmu(I), as MuI or Friction(mu, dmu), got {shown(law)}")


def inertial(name: str, I: ArrayLike) -> np.ndarray:
    """I as an array of finite numbers >= 0, or one sentence why not."""
    I = real_array(name, I)
    if (I < 0).any():
        raise ValueError(f"{name} must be >= 0 everywhere, got {shown(I)}")
    return I


def numbers(p: ArrayLike, phi: ArrayLike, I: ArrayLike) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(p, phi, I) as arrays of finite numbers, I >= 0, whose shapes broadcast, or one sentence why not."""
    p, phi, I = real_array("p", p), real_array("phi", phi), inertial("I", I)
    broadcast(p=p, phi=phi, I=I)
    return p[()], phi[()], I[()]


def _J(r):
    """J(r) = r^{-2/5} int_0^r s^{2/5}/(1 + s) ds and J'(r), of the shape of r.

    For r <= 1 by 2F1 at -r, for r > 1 by the connection formula to 1/r; J' = [r/(1 + r) - (2/5) J]/r is put together
    term by term, because J -> 5/2 would cancel.
    """
    r = np.asarray(r, dtype=float)
    small, big = np.minimum(r, 1), np.maximum(r, 1)
    near = 5 / 7 * _hyper(7 / 5, small)
    far = 5 / 3 * _hyper(3 / 5, 1 / big) / big
    tail = _TAIL * big**-0.4
    J = np.where(r <= 1, r * near, 2.5 - tail + far)
    dJ = np.where(r <= 1, 1 / (1 + small) - 0.4 * near, (0.4 * (tail - far) - 1 / (1 + big)) / big)
    return J, dJ


def _hyper(b, x):
    """2F1(1, b; b + 1; -x) for 0 <= x <= 1 by Pfaff's transformation: positive terms in powers of x/(1 + x) <= 1/2."""
    z = x / (1 + x)
    total = np.ones_like(z)
    for n in range(56, 0, -1):  # 2^-56 is below the last bit
        total = 1 + total * (z * (n / (b + n)))
    return total / (1 + x)


# 48 panels of width 2 in y = -log s, with 12 Gauss points each: e^{-2/5 96} = 2e-17 is what is cut off.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_Y = (2 * np.arange(48)[:, None] + 1 + _NODES).ravel()
_W = np.tile(_WEIGHTS, 48)


def _mean(g, I, power):
    """int_0^1 s^power g(s I) ds for power > -1, of the shape of I."""
    I = inertial("I", I)
    affordable("I: the quadrature at all inertial numbers", 1024 * I.size, f"shape {I.shape}")
    weights = _W * np.exp(-(power + 1) * _Y)
    blocks = []
    for part in np.array_split(I.ravel(), max(1, I.size // 4096)):  # a few MB at a time
        below = np.multiply.outer(part, np.exp(-_Y))
        blocks.append(np.broadcast_to(g(below), below.shape) @ weights)
    return np.concatenate(blocks).reshape(I.shape)[()]
