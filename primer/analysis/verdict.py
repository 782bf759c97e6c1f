"""The verdict: does the growth of short waves stay bounded? (Section A2.1 of the paper.)"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, TypeAlias, overload

import mpmath as mp
import numpy as np

from primer.analysis.directions import MaxGrowth, max_growth
from primer.analysis.drift import BEYOND, worst_law
from primer.analysis.each import each
from primer.analysis.factors import factors
from primer.analysis.fitted import computed
from primer.analysis.half_lines import half_lines
from primer.analysis.laws import NotPolynomialError, determined, exact_symbol
from primer.analysis.loss import loss
from primer.analysis.outcome import Kind, Verdict, undecided
from primer.analysis.pencil import Pencil
from primer.analysis.poles import of_law, on_curves, undetermined
from primer.analysis.puiseux import Law, branches
from primer.analysis.quadratic import quadratic
from primer.analysis.roots import DIGITS
from primer.analysis.scales import homogeneity, scales
from primer.analysis.supremum import along_line, exact_growth, in_plane, rate, ray
from primer.analysis.symbolic import Symbol
from primer.analysis.symmetry import reduced
from primer.types import SympyEquation

#: What can be judged.
Judged: TypeAlias = str | SympyEquation | Sequence[str] | Sequence[SympyEquation] | Symbol | Pencil


@overload
def verdict(
    pde: Judged,
    /,
    *,
    at: dict[str, complex] | None = None,
    order: str = "full",
    uniform: bool = False,
    space: Any = None,
    time: str | None = None,
    **parameters: complex | str | Callable[..., Any],
) -> Verdict: ...


@overload
def verdict(
    pde: Judged,
    /,
    *,
    at: dict[str, Any] | None = None,
    order: str = "full",
    uniform: bool = False,
    space: Any = None,
    time: str | None = None,
    **parameters: Any,
) -> Any: ...


def verdict(
    pde: Judged,
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
        equations such as "u_t = -u_xx", in x, y and z, as people write them (``primer help equations``); ``at``,
        ``order``, ``uniform``, ``space``, ``time`` and ``parameters``, for text only, are those of
        :func:`primer.linearise`. Where a pencil's entries are polynomials in xi its verdict is as good as they are in
        double precision; where they are not it is a fit, ``exact`` is False, and it may be undecided: beside
        logarithms, exponentials, or oscillations without bound. So it is in three space variables, unless growth is the
        same in all directions or about an axis, as it is about a state at rest or in one magnetic field; and for absD
        in more than one. H and absD in one space variable are exact: polynomials for xi > 0, and for xi < 0.

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
        if problem.symbol is None:
            return computed(pde)
        exact = problem.symbol
        found = _with_operators(exact) if exact.dim == 1 else computed(exact.pencil())
    else:
        found = _judged(exact) if exact.dim < 3 else _in_space(exact)
    if exact.uniform:
        return found
    note = "The base state varies: this is about short waves at a point."
    return replace(found, unstable=False, reason=f"{found.reason} {note}")


def _with_operators(symbol):
    """H(u) and absD(u) in one space variable: exactly, from the half lines."""
    found = []
    for half, sign in half_lines(symbol):
        one = _judged(determined(half), half=True)
        if one.kind == Kind.UNDECIDED:
            return one
        found.append(replace(one, direction=(float(sign),)))
    fastest = max(found, key=lambda one: Law(one.exponent, one.coefficient))
    if fastest.kind != Kind.WELL_POSED:
        return fastest
    highest = max(found, key=lambda one: one.bound)
    losses = [one.loss for one in found]
    lost = math.nan if any(map(math.isnan, losses)) else max(losses)
    told = {"bound": highest.bound, "unstable": highest.unstable, "reason": highest.reason, "loss": lost}
    return replace(fastest, **told)


def _in_space(symbol):
    """Three space variables: exactly where symmetry, or a quadratic form, leaves fewer; else by computation."""
    fewer = reduced(symbol)
    if fewer:
        return _judged(*fewer)
    return quadratic(symbol) or computed(symbol.pencil())


def _judged(symbol, basis=None, half=False):
    """The verdict in one or two space variables; ``basis`` are the vectors along which they lie in space.

    ``half``: only xi > 0 counts, in one space variable.
    """
    D = symbol.determinant
    real = _is_real(D)
    signs = (1,) if half or real else (1, -1)
    if symbol.dim == 2:
        limit, k = on_curves(D)
        if math.isinf(limit) and limit > 0:
            return undecided(f"growth is unbounded near |xi| = {k:.4g}, on a curve where a time derivative drops out")
    law, direction, drift, doubt = _along_line(symbol, signs) if symbol.dim == 1 else _in_plane(symbol, real)
    direction = _in_their_space(direction, basis)
    where = "" if symbol.dim == 1 else f" in the direction {_written(direction)}"
    if law.exponent > BEYOND / 20:
        reason = (
            f"Growth is unbounded at every |xi|, near the direction{where[17:]}, where a time derivative drops out."
        )
        return Verdict(Kind.ILL_POSED, math.inf, math.inf, direction, math.inf, True, reason, math.inf)
    if not law.is_bounded:
        where += f", approached like |xi|^-{drift}" if drift else ""
        reason = f"{law} as |xi| -> infinity{where}: the shorter the wave the faster it grows, without bound{doubt}."
        return Verdict(Kind.ILL_POSED, law.exponent, law.coefficient, direction, math.inf, True, reason, math.inf)
    if doubt:
        return undecided(f"the Newton polygon gives {law}{doubt}")
    if symbol.dim == 2 and (free := undetermined(D)):
        toward = _written(_in_their_space(free, basis))
        return undecided(f"waves in the direction {toward} are left free, as det M vanishes there; elsewhere {law}")
    bound, k = _supremum(symbol, law, real, signs)
    short = f"for short waves {law}" if law.coefficient else "for short waves Re lambda vanishes"
    if math.isinf(bound):
        at = f"near |xi| = {k:.4g}, where a time derivative drops out" if k else "as |xi| -> 0"
        return undecided(f"growth is unbounded {at} ({short})")
    lost = loss(symbol, half)
    if bound > 0:
        place = f"near |xi| = {k:.4g}" if math.isfinite(k) else "as |xi| -> infinity"
        what = "an instability, but not ill-posedness" if symbol.uniform else "no ill-posedness"
        reason = f"Growth is bounded by {bound:.6g}, reached {place} ({short}): {what}."
    else:
        grows = "No exponential grows" if lost else "No perturbation grows"
        reason = f"{grows}: Re lambda <= {bound:.6g} ({short})."
    if lost > 0:
        reason += f" Only weakly well-posed: bounded data may grow like {_power(lost)} in a time of order one, and "
        reason += "lower-order terms can make it ill-posed."
    if math.isnan(lost):
        reason += " Whether it is weakly or strongly well-posed was not decided."
    return Verdict(Kind.WELL_POSED, law.exponent, law.coefficient, direction, bound, bound > 0, reason, lost)


def _in_their_space(direction, basis):
    if not basis:
        return direction
    return tuple(float(sum(d * b[j] for d, b in zip(direction, basis, strict=True))) + 0.0 for j in range(3))


def _written(direction):
    return f"({', '.join(f'{x:.4g}' for x in direction)})"


def _power(q):
    return "|xi|" if q == 1 else f"|xi|^{q}" if q.denominator == 1 else f"|xi|^({q})"


def _along_line(symbol, signs):
    found = []
    for sign in signs:
        found += [(branches(P)[0].law, sign) for P in _on_line(symbol, sign)]
    law, sign = max(found, key=lambda item: (item[0], item[1]))
    return law, (float(sign),), Fraction(0), ""


def _on_line(symbol, sign):
    """The factors of det M as polynomials in lambda and k = xi > 0, or -xi."""
    with mp.workdps(DIGITS):
        return [{(n, a): c * sign**a for (n, a, _), c in part.items()} for part in factors(symbol.determinant)]


def _supremum(symbol, law, real, signs):
    """(sup Re lambda, |xi| where), given that the fastest ``law`` is bounded."""
    D = symbol.determinant
    known = []
    with mp.workdps(DIGITS):  # at xi = 0, where P(lambda, 0) may say less than the limit
        P = {(n, 0): c for (n, a, b), c in D.items() if a == b == 0}
        if max(P, default=(0, 0))[0] == max(D)[0]:
            known.append((float(rate(P, mp.mpf(0))), 0.0))
    known.append((of_law(law), math.inf))
    if symbol.dim == 2 and (power := homogeneity(D)) is not None and power > 0:
        return 0.0, 0.0  # growth is |xi|^power times that of the direction, which is not positive: 0 as |xi| -> 0
    if symbol.dim == 1:
        lines = [P for sign in signs for P in _on_line(symbol, sign)]
        found = [along_line(P, real, known) for P in lines]
        return max(found, key=lambda item: item[0])
    known.insert(0, (of_law(worst_law(D, real, inward=True).law), 0.0))
    known.append(on_curves(D))
    return in_plane(symbol, real, known)


def _in_plane(symbol, real):
    """The fastest law, found exactly, and whether the largest growth at two large wavenumbers exceeds it."""
    D, pencil = symbol.determinant, symbol.pencil()
    far = [math.exp(s) for angle in (0.3, 1.9) for s, _, _ in scales(ray(D, angle))]  # past all scales of the equations
    k = max([1.0, *far]) * np.array([1e5, 1e7])
    if homogeneity(D) is not None:  # the same directions are the fastest at each |xi|
        angle = float(max_growth(pencil, k[:1]).angle[0])
        best = MaxGrowth(k, k, np.outer([math.cos(angle), math.sin(angle)], [1, 1]))
    else:
        best = max_growth(pencil, k)
    worst = worst_law(D, real, best.angle)
    seen = [max(exact_growth(symbol, xi), 0.0) for xi in (k * best.direction).T]  # without rounding errors
    law = worst.law
    allowed = 2 * seen[0]
    if not law.is_bounded and law.exponent < BEYOND / 20:
        allowed = 1.2 * law.coefficient * k[1] ** float(law.exponent)
    doubt = ""
    if seen[1] > allowed and seen[1] > 2 * seen[0]:
        doubt = f", but growth of {seen[0]:.4g} at |xi| = {k[0]:g} and {seen[1]:.4g} at {k[1]:g} was computed"
    return law, worst.direction, worst.drift, doubt


def _is_real(D):
    """Whether growth is the same at xi and -xi: det M(conj lambda, -xi) is conj det M(lambda, xi) up to a factor."""
    top = max(D)
    with mp.workdps(DIGITS):
        ratio = D[top].conjugate() * (-1) ** sum(top[1:]) / D[top]
        return all(abs(c.conjugate() * (-1) ** (a + b) - ratio * c) <= 1e-30 * abs(c) for (_, a, b), c in D.items())
