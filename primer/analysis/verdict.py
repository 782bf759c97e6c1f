"""The verdict: does the growth of short waves stay bounded? (Section A2.1 of the paper.)"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, TypeAlias, overload

from primer.analysis.drift import BEYOND
from primer.analysis.each import each
from primer.analysis.extremes import is_real, law_along_line, law_in_plane, supremum_of
from primer.analysis.fitted import computed
from primer.analysis.half_lines import half_lines
from primer.analysis.laws import NotPolynomialError, determined, exact_symbol
from primer.analysis.loss import loss
from primer.analysis.outcome import Kind, Verdict, undecided
from primer.analysis.pencil import Pencil
from primer.analysis.poles import on_curves, undetermined
from primer.analysis.puiseux import Law
from primer.analysis.quadratic import quadratic
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
    real = is_real(D)
    signs = (1,) if half or real else (1, -1)
    if symbol.dim == 2:
        limit, k = on_curves(D)
        if math.isinf(limit) and limit > 0:
            return undecided(f"growth is unbounded near |xi| = {k:.4g}, on a curve where a time derivative drops out")
    law, direction, drift, doubt = law_along_line(symbol, signs) if symbol.dim == 1 else law_in_plane(symbol, real)
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
    bound, k = supremum_of(symbol, law, real, signs)
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
