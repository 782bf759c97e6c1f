"""The first grid that sees that the toy system is ill posed."""

import math
from dataclasses import dataclass

from primer.problems.toy import Toy
from primer.study.lanczos import grows
from primer.study.spectrum import Mode, fastest

_LARGEST = 10**6  # points of the finest grid whose spectrum is worth computing
_COARSE = 32  # grids up to here are looked at one by one: there Q need not grow with n
_BELOW = 6  # how far below the first unstable grid others are looked at: those of n mod 4 may differ a little


@dataclass(frozen=True, eq=False)
class GridThreshold:
    """What :func:`grid_threshold` found.

    Attributes
    ----------
    a, eps    the toy system
    frozen    pi/sqrt(eps (1 - a)): where the frozen sawtooth at x = 0 begins to grow; infinite if a >= 1 or eps = 0
    n         the first unstable grid, or None if there is none
    mode      its unstable mode, or None: ``mode.lam``, ``mode.parity``, ``mode.u``, ``mode.v``

    It says why Figure 6 of the paper hides what Figure 5 shows.

    >>> found = grid_threshold(a=0.5, eps=0.02)
    >>> print(found.n, f"{found.frozen:.2f}", found.mode.lam.real > 0)
    45 31.42 True
    """

    a: float
    eps: float
    frozen: float
    n: int | None
    mode: Mode | None


def grid_threshold(a: float, eps: float = 0.01) -> GridThreshold:
    """The first grid on which the steady state of the toy system is unstable: smaller n hide that it is ill posed.

    ``frozen`` is the estimate eps (1 - a) n^2/pi^2 = 1 from coefficients frozen at x = 0. The perturbation must live in
    the well of U about x = 0, and that costs growth: ``n`` comes from the spectrum of the semi-discrete Jacobian
    (:mod:`primer.study.spectrum`). For small eps it is near ``frozen`` sqrt(r), where r is the lesser of two: the root
    of 2 (r - 1)^3 = r/(2 (1 - a)) for modes near the sawtooth, and that of r = 2 + sqrt(eps n/pi) for those near
    k = n/4, where the central difference D1 is flat. The first come first for a up to about 1/2, the second near a = 1.

    With a >= 1 no fine grid is unstable; a very coarse one may be where eps is large, since its own steady state
    a - (h/sin h) cos x still dips below zero.

    Raises
    ------
    TypeError, ValueError    as ``Toy`` does, and if the first unstable grid is likely to have over 10^6 points

    Section A2.2.2 gives one grid on each side, 30 and 100 points.

    >>> print(grid_threshold(a=0.5, eps=0.01).n)
    64
    """
    toy = Toy(a, eps)
    # The product of two tiny numbers may be 0; no grid is as fine as the 1e-200 then stands for.
    well = max(math.sqrt(toy.eps * (1 - toy.a)), 1e-200) if toy.a < 1 and toy.eps > 0 else 0.0
    frozen = math.pi / well if well else math.inf
    n = _first_unstable(toy, frozen)
    return GridThreshold(toy.a, toy.eps, frozen, n, None if n is None else fastest(toy, n))


def unstable(toy: Toy, n: int) -> bool:
    """Whether some perturbation of the discrete steady state grows on n points."""
    return grows(toy, n)


def _first_unstable(toy, frozen):
    for n in range(4, _COARSE + 1):
        if unstable(toy, n):
            return n
    if frozen == math.inf:
        return None
    r = min(_sawtooth_ratio(toy.a), _quarter_ratio(toy.eps, frozen))
    high = max(_COARSE + 1, round(frozen * math.sqrt(r)))
    if high > _LARGEST:
        raise ValueError(f"eps (1 - a) must be more than about {20 / _LARGEST**2:.0e}, got {toy.eps * (1 - toy.a)!r}")
    # The wavenumbers of an odd grid miss the sawtooth by half a step: odd and even grids have thresholds of their own.
    return min(_first_of_class(toy, start) for start in (high, high + 1))


def _first_of_class(toy, high):
    """The first unstable grid among those that differ from ``high`` by multiples of two, by bisection."""
    low = high
    while not unstable(toy, high):
        low, high = high, high + 2 * math.ceil(0.02 * high)
    while low > _COARSE and unstable(toy, low):
        low, high = low - 2 * math.ceil(0.02 * low), low
    while high - low > 2:
        middle = low + (high - low) // 4 * 2
        low, high = (low, middle) if unstable(toy, middle) else (middle, high)
    below = range(high - _BELOW, high, 2)
    return next((n for n in below if n > _COARSE and unstable(toy, n)), high)


def _sawtooth_ratio(a):
    """r = (n/frozen)^2 at which the modes near the sawtooth begin to grow: 2 (r - 1)^3 = r/(2 (1 - a)), r > 1."""
    q = 0.0  # r - 1, by iteration of a contraction
    for _ in range(60):
        q = ((1 + q) / (4 * (1 - a))) ** (1 / 3)
    return 1 + q


def _quarter_ratio(eps, frozen):
    """The same for the modes near k = n/4: Re lam = (r - 2)/4 - sqrt(eps n/(16 pi)) = 0, with n = frozen sqrt(r)."""
    r = 2.0
    for _ in range(60):  # a contraction for r near 2, and a fair guess elsewhere
        r = 2 + math.sqrt(eps * frozen * math.sqrt(r) / math.pi)
    return r
