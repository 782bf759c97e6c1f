"""The verdict: does the growth of short waves stay bounded? (Section A2.1 of the paper.)"""

import math
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from typing import Any

import numpy as np

from primer.analysis.directions import max_growth
from primer.analysis.drift import worst_law
from primer.analysis.each import each
from primer.analysis.laws import NotPolynomialError, exact_symbol
from primer.analysis.puiseux import branches
from primer.analysis.supremum import exact_growth, supremum


class Kind(StrEnum):
    """What the test can say."""

    WELL_POSED = "well-posed"
    ILL_POSED = "ill-posed"
    UNDECIDED = "undecided"


@dataclass(frozen=True)
class Verdict:
    """The outcome of the test for linear ill-posedness.

    Attributes
    ----------
    kind : Kind
        "ill-posed" if limsup Re lambda = +infinity as |xi| -> infinity, "well-posed" if Re lambda is bounded from above
        (linearly, in the paper's sense), or "undecided"
    exponent : Fraction
    coefficient : float
        the largest growth, over branches and directions, is Re lambda ~ coefficient |xi|^exponent as |xi| -> infinity.
        For a well-posed system that is the branch that decays least; both are 0 where Re lambda is. nan if undecided
    direction : tuple
        the unit vector to which xi/|xi| tends there; in one space variable (1.0,) or (-1.0,)
    bound : float
        the supremum of Re lambda over all xi: inf if ill-posed, nan if undecided
    unstable : bool
        whether anything grows, bound > 0; with a finite bound that is instability, not ill-posedness
    reason : str
        one sentence

    The definition of linear ill-posedness is that of section A2.1.

    >>> found = verdict("u_t = -u_xx - u_xxxx")
    >>> print(found.kind, found.unstable, found.bound)  # an instability, but not ill-posedness
    well-posed True 0.25
    """

    kind: Kind
    exponent: Fraction | float
    coefficient: float
    direction: tuple
    bound: float
    unstable: bool
    reason: str


def verdict(
    pde: Any,
    /,
    *,
    at: dict[str, Any] | None = None,
    order: str = "full",
    uniform: bool = False,
    space: Any = None,
    time: str | None = None,
    **parameters: Any,
) -> Any:
    """Whether a PDE is linearly ill-posed, about a base state and frozen at a point: steps 1 to 3 of section A2.1.

    Parameters
    ----------
    pde : str, Symbol or Pencil
        equations such as "u_t = -u_xx", in x or in x and y, as people write them (``primer help equations``); ``at``,
        ``order``, ``uniform``, ``space``, ``time`` and ``parameters``, for text only, are those of
        :func:`primer.linearise`. A pencil's entries must be polynomials in xi, and its verdict is as good
        as they are in double precision.

    Returns
    -------
    Verdict; where values of ``at`` or parameters are arrays, an array of Verdicts of their shape, whose attributes
    ``kind``, ``exponent``, ``coefficient``, ``bound``, ``unstable`` are arrays too

    Raises
    ------
    PDEError    (a ValueError) for text that cannot be used or values that are not given

    >>> print(verdict("u_t = u_xxx - u_xx").kind)
    ill-posed
    >>> toy = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"
    >>> [str(verdict(toy, at={"u": u, "v_xx": 0.3}, eps=0.01).kind) for u in (1.5, -0.5)]  # eq. (toy-pde)
    ['well-posed', 'ill-posed']
    """
    options = {"order": order, "uniform": uniform, "space": space, "time": time}
    return each(at, parameters, lambda at, parameters: _verdict(pde, at=at, **options, **parameters))


def _verdict(pde, **arguments):
    try:
        exact = exact_symbol(pde, **arguments)
    except NotPolynomialError as problem:
        return _undecided(str(problem))
    return _judged(exact)


def _judged(symbol):
    D = symbol.determinant
    real = _is_real(D)
    law, direction, drift, doubt = (_along_line if symbol.dim == 1 else _in_plane)(symbol, real)
    if not law.is_bounded:
        where = "" if symbol.dim == 1 else f" in the direction ({direction[0]:.4g}, {direction[1]:.4g})"
        where += f", approached like |xi|^-{drift}" if drift else ""
        reason = f"{law} as |xi| -> infinity{where}: the shorter the wave the faster it grows, without bound{doubt}."
        return Verdict(Kind.ILL_POSED, law.exponent, law.coefficient, direction, math.inf, True, reason)
    if doubt:
        return _undecided(f"the Newton polygon gives {law}{doubt}")
    bound, k = supremum(symbol, law, real)
    short = f"for short waves {law}" if law.coefficient else "for short waves Re lambda vanishes"
    if math.isinf(bound):
        return _undecided(f"growth is unbounded near |xi| = {k:.4g}, where a time derivative drops out ({short})")
    if bound > 0:
        place = f"near |xi| = {k:.4g}" if math.isfinite(k) else "as |xi| -> infinity"
        reason = f"Growth is bounded by {bound:.6g}, reached {place} ({short}): an instability, but not ill-posedness."
    else:
        reason = f"No perturbation grows: Re lambda <= {bound:.6g} ({short})."
    return Verdict(Kind.WELL_POSED, law.exponent, law.coefficient, direction, bound, bound > 0, reason)


def _along_line(symbol, real):
    found = []
    for sign in (1,) if real else (1, -1):
        P = {(n, a): c * sign**a for (n, a, _), c in symbol.determinant.items()}
        found.append((branches(P)[0].law, sign))
    law, sign = max(found, key=lambda item: (item[0], item[1]))
    return law, (float(sign),), Fraction(0), ""


def _in_plane(symbol, real):
    """The fastest law, found exactly, and whether the largest growth at two large wavenumbers exceeds it."""
    pencil, k = symbol.pencil(), np.array([1e5, 1e7])
    best = max_growth(pencil, k)
    worst = worst_law(symbol.determinant, real, best.angle)
    seen = [max(exact_growth(symbol, xi), 0.0) for xi in (k * best.direction).T]  # without rounding errors
    law = worst.law
    allowed = 2 * seen[0] if law.is_bounded else 1.2 * law.coefficient * k[1] ** float(law.exponent)
    doubt = ""
    if seen[1] > allowed and seen[1] > 2 * seen[0]:
        doubt = f", but growth of {seen[0]:.4g} at |xi| = {k[0]:g} and {seen[1]:.4g} at {k[1]:g} was computed"
    return law, worst.direction, worst.drift, doubt


def _is_real(D):
    """Whether growth is the same at xi and -xi: det M(conj lambda, -xi) is conj det M(lambda, xi) up to a factor."""
    top = max(D)
    ratio = D[top].conjugate() * (-1) ** sum(top[1:]) / D[top]
    return all(abs(c.conjugate() * (-1) ** (a + b) - ratio * c) <= 1e-30 * abs(c) for (_, a, b), c in D.items())


def _undecided(reason):
    nan = math.nan
    return Verdict(Kind.UNDECIDED, nan, nan, (), nan, False, reason[0].upper() + reason[1:] + ".")
