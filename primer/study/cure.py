"""The cure and its price: backward heat made well posed, and what that does to the answer.

A smooth-enough profile w has diffused for a time t; measured with noise, it is to be marched back by u_t = -u_xx, eq.
(backward-heat). Mode k of the answer is e^{k^2 t} times that of the data, noise included. Two ways to stop that::

    a cut-off            e^{k^2 t} for |k| <= K, nothing beyond
    a fourth derivative  u_t = -u_xx - beta u_xxxx: e^{(k^2 - beta k^4) t}, at most e^{t/(4 beta)}

Each is well posed, and each has a number in it, K or beta, that the equation does not know. A small K or a large beta
leaves w's finer modes out, the opposite lets the noise in; the best one depends on the noise.
"""

from dataclasses import dataclass

import numpy as np

from primer.checks import affordable, function, integer, real, real_array, shown
from primer.schemes.grid import Grid


def cut_off(t, K):
    """The multiplier of a Fourier cut-off: a function of the wavenumbers k."""
    t, K = real("t", t, least=0), real("K", K, least=0)
    return lambda k: np.where(np.abs(k) <= K, np.exp(np.minimum(np.abs(k), K) ** 2 * t), 0.0)


def fourth_derivative(t, beta):
    """The multiplier of u_t = -u_xx - beta u_xxxx after time t: a function of the wavenumbers k."""
    t, beta = real("t", t, least=0), real("beta", beta, above=0)
    return lambda k: np.exp((k**2 - beta * k**4) * t)


def march_back(data, multiplier):
    """Samples of the profile that ``data``, (..., n) samples on the periodic grid, has come from."""
    data = real_array("data", data)
    function("multiplier", multiplier, "the wavenumbers")
    n = data.shape[-1] if data.ndim else 0
    if n < 2:
        raise ValueError(f"data must have shape (..., n) with n >= 2 samples, got {data.shape}")
    return np.fft.irfft(multiplier(np.arange(n // 2 + 1.0)) * np.fft.rfft(data), n)


@dataclass(frozen=True, eq=False)
class Recovery:
    """Errors of profiles marched back from noisy data, as root mean squares over the grid.

    Attributes
    ----------
    x, profile, data    (n,) grid, the true profile w, and w after diffusing for time t, without noise
    t                   how long
    noise               (s,) standard deviations of the noise in each sample of the data
    parameters          (p,) the cut-offs K or the betas
    error               (s, p) measured, each from one draw of the noise
    bias                (p,) the part that is there without noise: what the multiplier does to w
    expected            (s, p) root of bias^2 + the mean square of the noise let through, in closed form
    """

    x: np.ndarray
    profile: np.ndarray
    data: np.ndarray
    t: float
    noise: np.ndarray
    parameters: np.ndarray
    error: np.ndarray
    bias: np.ndarray
    expected: np.ndarray

    @property
    def best(self):
        """(s,) the parameter of least measured error at each level of noise."""
        return self.parameters[np.argmin(self.error, axis=1)]


def recover(regularise, parameters, noise, t=0.05, n=256, seed=0):
    """Diffuse the tent profile pi/2 - |x| for time t, add noise, march back, and compare: a :class:`Recovery`.

    Parameters
    ----------
    regularise     ``cut_off`` or ``fourth_derivative``, or any function of (t, parameter) that gives a multiplier
    parameters     its cut-offs or betas
    noise          standard deviations of the noise
    t, n           time, and grid points, an even number >= 4
    seed           of the random noise; the same noise, to scale, at every level
    """
    t, noise, parameters = real("t", t, above=0), real_array("noise", noise), real_array("parameters", parameters)
    function("regularise", regularise, "t and the parameter")
    if noise.ndim != 1 or parameters.ndim != 1 or not noise.size or not parameters.size or (noise < 0).any():
        raise ValueError(
            "noise and parameters must be non-empty sequences of numbers, the noise >= 0, "
            f"got noise = {shown(noise)} and parameters = {shown(parameters)}"
        )
    grid, seed = Grid(n), integer("seed", seed, least=0)
    if grid.n % 2:
        raise ValueError(f"n must be even, got {grid.n}")
    affordable("n, noise and parameters", 64 * grid.n * noise.size * parameters.size, f"n = {grid.n}")
    k = np.arange(grid.n // 2 + 1.0)
    profile = np.pi / 2 - np.abs(grid.x)
    data = march_back(profile, lambda k: np.exp(-(k**2) * t))
    draw = np.random.default_rng(seed).standard_normal(grid.n)
    multipliers = [regularise(t, parameter) for parameter in parameters]
    answers = np.array([march_back(data + noise[:, None] * draw, multiplier) for multiplier in multipliers])
    bias = np.array([_rms(march_back(data, multiplier) - profile) for multiplier in multipliers])
    weight = np.where((k == 0) | (2 * k == grid.n), 1, 2)  # real wave k stands for k and -k
    through = np.array([np.sqrt(np.sum(weight * multiplier(k) ** 2) / grid.n) for multiplier in multipliers])
    return Recovery(
        x=grid.x,
        profile=profile,
        data=data,
        t=t,
        noise=noise,
        parameters=parameters,
        error=_rms(answers - profile).T,
        bias=bias,
        expected=np.hypot(bias, noise[:, None] * through),
    )


def _rms(f):
    return np.sqrt(np.mean(np.square(f), axis=-1))
