"""The backward heat equation, eq. (backward-heat): the classic ill-posed problem, solved mode by mode."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from primer.arithmetic import constant, points, sin
from primer.checks import affordable, broadcast, function, integer, real, real_array, shown
from primer.equations.evaluate import Known, Scalars, tendencies
from primer.equations.slopes import about
from primer.equations.stages import Evolution, evolution
from primer.types import ArrayLike, Derivative, Multiplier, Numbers

_NOTHING = Known(Scalars(np.dtype(float)), (), ())  # what the right-hand side needs of x: it depends on u_xx alone


@dataclass(frozen=True)
class BackwardHeat:
    """The backward heat equation u_t = -u_xx, eq. (backward-heat), from u = amplitude sin(xi x) (dimensionless).

    On the circle x in [-pi, pi) of the computations the wavenumber xi is a whole number.

    Parameters
    ----------
    xi : int             the wavenumber of the initial data, xi >= 1
    amplitude : float    its amplitude

    Raises
    ------
    TypeError, ValueError    if xi is not an integer from 1 to 2^53 or amplitude is not a finite real number

    >>> heat = BackwardHeat(xi=3)
    >>> (u,) = heat.exact(0.5, t=0.1)  # sin(3/2) e^{0.9}
    >>> print(f"{u:.4f}")
    2.4534
    """

    xi: int = 1
    amplitude: float = 1.0
    fields: ClassVar[tuple[str, ...]] = ("u",)
    text: ClassVar[str] = "u_t = -u_xx"
    parameters: ClassVar[dict] = {}

    def __post_init__(self) -> None:
        object.__setattr__(self, "xi", integer("xi", self.xi, least=1))
        if self.xi > 2**53:
            raise ValueError(f"xi must be an integer <= 2^53, got {shown(self.xi)}")
        object.__setattr__(self, "amplitude", real("amplitude", self.amplitude))

    def initial(self, x: ArrayLike) -> tuple[np.ndarray]:
        """(u,) at t = 0; x of any shape."""
        return (self.amplitude * sin(self.xi * points(x)),)

    def steady(self, x: ArrayLike) -> tuple[np.ndarray]:
        """(0,): the trivial solution that the paper perturbs."""
        return (constant(x, 0),)

    def exact(self, x: ArrayLike, t: ArrayLike) -> tuple[Numbers]:
        """(u,) at time t: the mode of the initial data, grown by e^{xi^2 t}."""
        return (self.amplitude * mode(self.xi, x, t),)

    def forcing(self, x: ArrayLike) -> None:
        """Nothing: the equation does not depend on x."""

    def rhs(
        self, x: ArrayLike, state: Sequence[np.ndarray], derivative: Derivative, forcing: None = None
    ) -> tuple[np.ndarray]:
        """(u_t,) of eq. (backward-heat), where ``derivative(f, m)`` gives the m-th x-derivative of a field on x."""
        (u_t,) = tendencies(self.evolution, {}, state, derivative, _NOTHING)
        return (u_t,)

    def known(self, x: ArrayLike) -> Known:
        """What a time loop computes once: nothing."""
        return _NOTHING

    @property
    def evolution(self) -> Evolution:
        """The right-hand side as stages, made from the text."""
        return evolution(self.text)

    def symbol(self, xi: ArrayLike, multiplier: Multiplier | None = None) -> np.ndarray:
        """The 1 x 1 symbol [[xi^2]]: e^{i xi x + lam t} grows at lam = xi^2, without bound in xi.

        ``multiplier(xi, m)`` is what the m-th derivative does to e^{i xi x}; left out, it is that of the continuum.
        Complex, of the shape of xi + (1, 1).
        """
        xi = real_array("xi", xi)
        if multiplier is not None:
            function("multiplier", multiplier, "xi and m")
        with np.errstate(over="ignore", invalid="ignore"):
            frozen = about(self.evolution, {}, [{(0, 2): 0.0}], _NOTHING)
            S = frozen.symbol(lambda m: multiplier(xi, m) if multiplier else (1j * xi) ** m)
        if not np.isfinite(S).all():
            raise ValueError(f"xi must leave the symbol finite, got {shown(xi)}")
        return S


def mode(xi: ArrayLike, x: ArrayLike, t: ArrayLike) -> Numbers:
    """sin(xi x) e^{xi^2 t}, eq. (backward-heat-growing-sln), of the broadcast shape of its arguments.

    Infinite where it is beyond the largest number, and 0 where sin(xi x) is, however large t.
    """
    xi, x, t = broadcast(xi=real_array("xi", xi), x=real_array("x", x), t=real_array("t", t))
    wave = np.sin(xi * x)
    with np.errstate(over="ignore", invalid="ignore"):
        return np.where(wave == 0, 0.0, wave * np.exp(xi**2 * t))[()]


def scaled_amplitude(xi: ArrayLike, t: ArrayLike, p: float) -> Numbers:
    """sup over x of |xi|^-p |sin(xi x)| e^{xi^2 t}, eq. (backward-heat-blow-up).

    At t = 0 it tends to zero as xi -> infinity (in C^k if p > k); at any t > 0 to infinity: Hadamard's third condition
    fails.
    """
    xi, t = broadcast(xi=real_array("xi", xi), t=real_array("t", t))
    p = real("p", p, least=0)
    if (xi == 0).any():
        raise ValueError(f"xi must not be 0, got {shown(xi.tolist())}")
    with np.errstate(over="ignore"):
        return np.abs(xi) ** -p * np.exp(xi**2 * t)


def abs_sin_coefficients(p: float, m_max: int) -> np.ndarray:
    """Fourier coefficients c_0, c_2, ..., c_{2 m_max} of |sin x|^p = sum c_n e^{inx}; those of odd n are zero.

    In closed form::

        c_{2m} = (-1)^m Gamma(p+1) / (2^p Gamma(1+p/2+m) Gamma(1+p/2-m))

    computed from c_0 = B((p+1)/2, 1/2)/pi and c_{2m+2}/c_{2m} = (m - p/2)/(m + 1 + p/2), which overflows nowhere and
    ends exactly in zeros for even p. For other p, c_{2m} ~ -(sin(pi p/2) Gamma(p+1)/(pi 2^p)) m^{-p-1}.

    Parameters
    ----------
    p : float      the power, p >= 0
    m_max : int    the last m, m_max >= 0

    Returns
    -------
    array of shape (m_max + 1,)
    """
    from scipy.special import beta  # which takes longer to load than a run to t = 100

    p, m_max = real("p", p, least=0), integer("m_max", m_max, least=0)
    affordable("m_max + 1 coefficients", 64 * m_max, f"m_max = {shown(m_max)}")
    m = np.arange(m_max)
    ratios = (m - p / 2) / (m + 1 + p / 2)
    return np.cumprod(np.concatenate([[beta((p + 1) / 2, 0.5) / np.pi], ratios]))


def abs_sin_log_norms(p: float, t: float, m_max: int) -> np.ndarray:
    """ln of sum_{|n| <= 2M} e^{2 n^2 t} |c_n|^2 for M = 0 ... m_max: the partial sums of eq. (L2norm-sln).

    A solution of the backward heat equation from |sin x|^p that lives to time t needs them to converge. They do for
    every t when p is an even integer (the series ends) and for no t > 0 otherwise.

    Returns
    -------
    array of shape (m_max + 1,)
    """
    c, t = abs_sin_coefficients(p, m_max), real("t", t, least=0)
    n = 2 * np.arange(m_max + 1)
    twice = np.where(n == 0, 1, 2)  # n and -n
    terms = np.full(n.shape, -np.inf)
    np.log(twice * c**2, out=terms, where=c != 0)
    return np.logaddexp.accumulate(terms + 2.0 * n**2 * t)
