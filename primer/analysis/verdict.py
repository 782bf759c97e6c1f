"""The verdict: does the growth of short waves stay bounded? (Section A2.1 of the paper.)"""

import math
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

import numpy as np

from primer.analysis.directions import max_growth
from primer.analysis.drift import worst_law
from primer.analysis.laws import NotPolynomialError, exact_symbol
from primer.analysis.puiseux import branches
from primer.analysis.supremum import supremum


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
    """

    kind: Kind
    exponent: Fraction
    coefficient: float
    direction: tuple
    bound: float
    unstable: bool
    reason: str


def verdict(pde, /, *, at=None, order="full", **parameters):
    """Whether a PDE is linearly ill-posed, about a base state and frozen at a point: steps 1 to 3 of section A2.1.

    Parameters
    ----------
    pde : str, Symbol or Pencil
        equations such as "u_t = -u_xx", in x or in x and y; ``at``, ``order`` and ``parameters``, which only a text has,
        are those of :func:`primer.linearise`. A pencil's entries must be polynomials in xi, and its verdict is as good
        as they are in double precision.

    Returns
    -------
    Verdict

    Raises
    ------
    PDEError    (a ValueError) for text that cannot be used or values that are not given
    """
    try:
        exact = exact_symbol(pde, at=at, order=order, **parameters)
    except NotPolynomialError as problem:
        return _undecided(str(problem))
    return _judged(exact)


def _judged(symbol):
    D = symbol.determinant
    real = _is_real(D)
    law, direction, drift = _along_line(D, symbol.zero, real) if symbol.dim == 1 else _in_plane(D, symbol.zero, real)
    if symbol.dim == 2 and (doubt := _contradiction(symbol, law)):
        return _undecided(doubt)
    if not law.is_bounded:
        where = "" if symbol.dim == 1 else f" in the direction ({direction[0]:.4g}, {direction[1]:.4g})"
        where += f", approached like |xi|^-{drift}" if drift else ""
        reason = f"{law} as |xi| -> infinity{where}: the shorter the wave the faster it grows, without bound."
        return Verdict(Kind.ILL_POSED, law.exponent, law.coefficient, direction, math.inf, True, reason)
    bound, k = supremum(symbol, law, real)
    short = f"for short waves {law}" if law.coefficient else "for short waves Re lambda vanishes"
    if bound > 0:
        place = f"near |xi| = {k:.4g}" if math.isfinite(k) else "as |xi| -> infinity"
        reason = f"Growth is bounded by {bound:.6g}, reached {place} ({short}): an instability, but not ill-posedness."
    else:
        reason = f"No perturbation grows: Re lambda <= {bound:.6g} ({short})."
    return Verdict(Kind.WELL_POSED, law.exponent, law.coefficient, direction, bound, bound > 0, reason)


def _along_line(D, zero, real):
    found = []
    for sign in (1,) if real else (1, -1):
        P = {(n, a): c * sign**a for (n, a, _), c in D.items()}
        found.append((branches(P, zero)[0].law, sign))
    law, sign = max(found, key=lambda item: (item[0], item[1]))
    return law, (float(sign),), Fraction(0)


def _in_plane(D, zero, real):
    worst = worst_law(D, zero, real)
    return worst.law, worst.direction, worst.drift


def _is_real(D):
    """Whether growth is the same at xi and -xi: det M(conj lambda, -xi) is conj det M(lambda, xi) up to a factor."""
    top = max(D)
    ratio = D[top].conjugate() * (-1) ** sum(top[1:]) / D[top]
    return all(abs(c.conjugate() * (-1) ** (a + b) - ratio * c) <= 1e-30 * abs(c) for (_, a, b), c in D.items())


def _contradiction(symbol, law):
    """What the numbers say against a law found in the plane, or None: the largest growth at two large wavenumbers."""
    pencil, k = symbol.pencil(), np.array([1e5, 1e7])
    best = max_growth(pencil, k)
    lam = pencil.eigenvalues(k * best.direction)
    seen = np.where(best.growth > 1e-9 * np.abs(lam[..., 0]), best.growth, 0)
    if law.is_bounded:
        return "" if seen[1] <= 2 * max(seen[0], 1e-300) else _said(law, k, seen)
    off = np.abs(np.log(np.maximum(seen, 1e-300) / (law.coefficient * k ** float(law.exponent))))
    return "" if off[1] < 0.05 or off[1] < 0.8 * off[0] else _said(law, k, seen)


def _said(law, k, seen):
    return (
        f"the Newton polygon gives {law} but the largest growth computed is "
        f"{seen[0]:.4g} at |xi| = {k[0]:g} and {seen[1]:.4g} at {k[1]:g}"
    )


def _undecided(reason):
    nan = math.nan
    return Verdict(Kind.UNDECIDED, nan, nan, (), nan, False, reason[0].upper() + reason[1:] + ".")
