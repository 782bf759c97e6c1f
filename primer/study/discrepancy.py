"""What can be saved of an ill-posed problem when a bound is known beforehand: backward heat, honestly.

A profile w(0) with rms ||w(0)|| <= E has diffused, w_s = w_xx, for a time T; samples of w(T) are known with an error of
rms delta. Asked for is w(s), marched back by u_t = -u_xx, eq. (backward-heat), for a time T - s. As s goes on, the
logarithm of ||w(s)|| is convex for every solution (by Cauchy and Schwarz on its waves), so two of them that are E apart
at s = 0 and delta apart at s = T are no further apart than E^{1-s/T} delta^{s/T} between: the bound gives back what is
lost, all but s = 0 itself.

What the bound promises, Tikhonov's method keeps, without the true profile and without E. The free number, alpha, or K
of a cut-off, is taken by the *discrepancy principle*: the answer, diffused again, may miss the data by tau delta, tau a
little over 1, and not by less, for less would be fitted to the noise. Sources: V. A. Morozov, *Methods for solving
incorrectly posed problems* (1984); K. Miller, SIAM J. Math. Anal. 1 (1970).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from primer.checks import affordable, function, real, real_array, shown
from primer.schemes.grid import Grid
from primer.study.cure import cut_off, march_back

TAU = 1.1  # how many times the error of the data an answer may miss them by
_LEAST, _MOST = -600.0, 600.0  # ln alpha of Tikhonov: with less, or more, a double knows no difference


def log_convex(early, late, fraction):
    """early^(1-f) late^f: no solution of the heat equation is larger at that fraction f of the time between.

    Parameters
    ----------
    early, late    rms of a solution at the two ends, >= 0; arrays are broadcast
    fraction       s/T, in [0, 1]

    >>> print(f"{log_convex(1.0, 1e-6, 0.5):.0e}")
    1e-03
    """
    early, late, fraction = (real_array(n, v) for n, v in (("early", early), ("late", late), ("fraction", fraction)))
    if (early < 0).any() or (late < 0).any():
        raise ValueError(f"early and late must be >= 0, got {shown(early)} and {shown(late)}")
    if not ((fraction >= 0) & (fraction <= 1)).all():
        raise ValueError(f"fraction must be in [0, 1], got {shown(fraction)}")
    return early ** (1 - fraction) * late**fraction


def rms(samples):
    """Root mean square over the last axis: the L2 norm over the circle, divided by sqrt(2 pi)."""
    return np.sqrt(np.mean(np.square(real_array("samples", samples)), axis=-1))


def diffuse(t):
    """The multiplier of the heat equation after a time t >= 0: a function of the wavenumbers k."""
    t = real("t", t, least=0)
    return lambda k: np.exp(-(k**2) * t)


def tikhonov(T, alpha):
    """The multiplier that gives the profile w(0) of least ||diffused w - data||^2 + alpha ||w||^2; alpha > 0.

    Wave k of the data is multiplied by g/(g^2 + alpha), g = e^{-k^2 T}: at most 1/(2 sqrt(alpha)).
    """
    T, alpha = real("T", T, least=0), real("alpha", alpha, above=0)

    def multiplier(k):
        g = np.exp(-(k**2) * T)
        return g / (g**2 + alpha)

    return multiplier


@dataclass(frozen=True, eq=False)
class Choice:
    """What the discrepancy principle took.

    Attributes
    ----------
    parameter    alpha of Tikhonov, or the cut-off K
    profile      (n,) the answer at s = 0; diffuse it for any s
    missed       rms by which it misses the data when diffused again: tau delta or less
    """

    parameter: float
    profile: np.ndarray
    missed: float


def by_discrepancy(data, delta, T, method=tikhonov, tau=TAU):
    """Take alpha or K so that the answer misses ``data`` by tau delta, and no true profile is asked for.

    Parameters
    ----------
    data      (n,) samples of w(T) on the periodic grid, n even, with an error of rms ``delta``
    delta     > 0; too small a value gives nonsense, as no principle can tell noise that it is not told of
    T         > 0, how long the profile has diffused
    method    ``tikhonov`` or ``primer.study.cure.cut_off``
    tau       > 1

    Raises
    ------
    ValueError    in one sentence; also if no profile misses the data by as little as tau delta

    Where the data are no larger than tau delta the answer is 0: nothing can be told from noise.
    """
    data, delta = real_array("data", data), real("delta", delta, above=0)
    T, tau = real("T", T, above=0), real("tau", tau, above=1)
    if method not in (tikhonov, cut_off):
        raise ValueError(f"method must be tikhonov or cut_off, got {shown(method)}")
    if data.ndim != 1 or data.size < 4 or data.size % 2:
        raise ValueError(f"data must have shape (n,) with n even and >= 4, got {data.shape}")

    k = np.arange(data.size // 2 + 1.0)
    waves = np.abs(np.fft.rfft(data)) / data.size * np.where((k == 0) | (2 * k == data.size), 1, math.sqrt(2))
    g = diffuse(T)(k)

    def missed_by(parameter):  # wave by wave: samples would mix the rounding of huge waves into small ones
        return float(np.linalg.norm((1 - g * method(T, parameter)(k)) * waves))

    if rms(data) <= tau * delta:
        return Choice(math.inf if method is tikhonov else -1.0, np.zeros_like(data), float(rms(data)))
    most, last = tau * delta, data.size // 2
    parameter = _alpha(missed_by, most) if method is tikhonov else _first_cut(missed_by, most, last)
    missed = missed_by(parameter)
    if not missed <= tau * delta * (1 + 1e-6):
        raise ValueError(
            f"delta must be no less than what is to be had on {data.size} samples, got {delta:g}: the data are missed "
            f"by {missed:.3g} at least"
        )
    return Choice(float(parameter), march_back(data, method(T, parameter)), missed)


def _alpha(missed_by, most):
    """The largest alpha with which the data are missed by ``most``: what is missed rises with alpha."""
    low, high = _LEAST, _MOST
    while high - low > 1e-10:
        middle = (low + high) / 2
        low, high = (middle, high) if missed_by(math.exp(middle)) <= most else (low, middle)
    return math.exp(low)


def _first_cut(missed_by, most, last):
    """The smallest K in 0, 1, ..., last with which the data are missed by ``most``, or the last."""
    return next((K for K in range(last + 1) if missed_by(K) <= most), last)


@dataclass(frozen=True, eq=False)
class Saved:
    """Errors of profiles saved from noisy data, without knowing the truth; rms over the grid.

    Attributes
    ----------
    noise         (d,) delta, the rms of the noise in the data
    s, T          (m,) times asked for, and that of the data
    parameter     (d,) what the discrepancy principle took
    error         (d, m) measured
    bound         (d, m) (2 ||w(0)||)^{1-s/T} ((1+tau) delta)^{s/T}: a theorem for Tikhonov's method
    least         (d, m) error with the best parameter of many, that only who knows the truth can take
    """

    noise: np.ndarray
    s: np.ndarray
    T: float
    parameter: np.ndarray
    error: np.ndarray
    bound: np.ndarray
    least: np.ndarray

    @property
    def order(self):
        """(m,) the power of delta with which the measured error falls, fitted over all levels of noise."""
        return np.polyfit(np.log(self.noise), np.log(self.error), 1)[0]


def save(profile, noise, s, T=0.05, method=tikhonov, tau=TAU, seed=0):
    """Diffuse ``profile`` for a time T, add noise of each rms, and save what can be saved at times s: a :class:`Saved`.

    Parameters
    ----------
    profile    a function of x, on 256 points
    noise      rms of the noise, each > 0
    s          times, in [0, T]
    """
    noise, s, T = np.atleast_1d(real_array("noise", noise)), np.atleast_1d(real_array("s", s)), real("T", T, above=0)
    if not (noise > 0).all() or not noise.size:
        raise ValueError(f"noise must be numbers > 0, got {shown(noise)}")
    if not ((s >= 0) & (s <= T)).all():
        raise ValueError(f"s must be in [0, T], got {shown(s)} and T = {T:g}")
    affordable("noise", 8.0 * 256 * noise.size * s.size * 60, f"{noise.size} of them")
    true = real_array("profile(x)", function("profile", profile, "x")(Grid(256).x))
    draw = np.random.default_rng(seed).standard_normal(256)
    draw /= rms(draw)
    exact = march_back(true, diffuse(T))
    chosen = [by_discrepancy(exact + delta * draw, delta, T, method, tau) for delta in noise]

    def errors(answer) -> list:
        return [float(rms(march_back(answer - true, diffuse(time)))) for time in s]

    many: np.ndarray = np.arange(0.0, 41) if method is cut_off else np.geomspace(1e-20, 1, 61)
    gains: list[Callable] = [method(T, parameter) for parameter in many]
    least = [np.min([errors(march_back(exact + delta * draw, gain)) for gain in gains], axis=0) for delta in noise]
    return Saved(
        noise=noise,
        s=s,
        T=T,
        parameter=np.array([choice.parameter for choice in chosen]),
        error=np.array([errors(choice.profile) for choice in chosen]),
        bound=log_convex(2 * rms(true), (1 + tau) * noise[:, None], s / T),
        least=np.array(least),
    )
