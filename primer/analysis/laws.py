"""Growth laws along one direction, for equations as text or as a pencil."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np

from primer.analysis.each import each
from primer.analysis.pencil import Pencil
from primer.analysis.puiseux import branches, collected
from primer.analysis.recover import recovered
from primer.analysis.roots import DIGITS
from primer.analysis.symbol import Symbol
from primer.analysis.symbolic import symbol
from primer.checks import real_array, shown
from primer.equations.text import PDEError
from primer.types import ArrayLike


class NotPolynomialError(ValueError):
    """The entries are not polynomials in xi, so that there is no Newton polygon; ``symbol`` where it is known."""

    symbol: Symbol | None = None


def growth_laws(
    pde: Any,
    /,
    direction: ArrayLike | None = None,
    *,
    at: dict[str, Any] | None = None,
    order: str = "full",
    uniform: bool = False,
    space: Any = None,
    time: str | None = None,
    **parameters: Any,
) -> Any:
    """How each branch lambda(k) behaves along xi = k direction, k -> infinity: by the Newton polygon, exactly.

    Parameters
    ----------
    direction : number, or two or three    by default 1, or (1, 0), (1, 0, 0); only its direction counts
    others                                 as for :func:`primer.verdict`

    Returns
    -------
    list of Branch, the fastest growing first: ``branch.exponent`` and ``branch.coefficient`` of its leading term, and
    ``branch.law`` for the real part of lambda, which may be of a lower order. Where values are arrays, an array of such
    lists, of their shape

    Raises
    ------
    ValueError    as for :func:`primer.verdict`, and for a pencil whose entries are not polynomials in xi

    Eq. (toy-eig) is the case of the toy system.

    >>> toy = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"
    >>> for branch in growth_laws(toy, at={"u": -0.5, "v_xx": 0}, eps=0.01):
    ...     print(branch.exponent, f"{complex(branch.coefficient).real:.4f}")
    2 0.0050
    0 200.0000
    """
    options = {"order": order, "uniform": uniform, "space": space, "time": time}
    return each(
        at, parameters, lambda at, parameters: _laws(exact_symbol(pde, at=at, **options, **parameters), direction)
    )


def _laws(exact, direction):
    along = np.atleast_1d(real_array("direction", [1, 0, 0][: exact.dim] if direction is None else direction))
    if along.shape != (exact.dim,) or not along.any():
        raise ValueError(f"direction must be {exact.dim} number(s), not all zero, got {shown(direction)}")
    with mp.workdps(DIGITS):
        d = [mp.mpf(repr(float(x))) for x in along]
        length = mp.sqrt(sum(x**2 for x in d))
        d = [*(x / length for x in d), mp.mpf(1)]
        terms = []
        for (n, *powers), c in exact.determinant.items():
            terms.append(((n, sum(powers)), c * mp.fprod(x**a for x, a in zip(d, powers, strict=False))))
        return branches(collected(terms))


def exact_symbol(
    pde: Any,
    *,
    at: dict[str, Any] | None = None,
    order: str = "full",
    uniform: bool = False,
    space: Any = None,
    time: str | None = None,
    **parameters: Any,
) -> Symbol:
    """The :class:`Symbol` of a text, a Pencil or a Symbol, its determinant checked: something evolves, and uniquely."""
    if not isinstance(pde, (Pencil, Symbol)):
        exact = symbol(pde, at=at, order=order, uniform=uniform, space=space, time=time, **parameters)
    elif at or order != "full" or uniform or space is not None or time is not None or parameters:
        raise TypeError("base-state values, order and parameters go with equations as text only")
    elif isinstance(pde, Pencil):
        exact = recovered(pde)
        if exact is None:
            raise NotPolynomialError("the entries of the pencil are not polynomials in xi of degree 8 or less")
    else:
        exact = pde
    if exact.operators:
        problem = NotPolynomialError("H and absD make a symbol that is no polynomial in xi: it has no Newton polygon")
        problem.symbol = exact
        raise problem
    return determined(exact)


def determined(exact: Symbol) -> Symbol:
    """The symbol, if its determinant says that something evolves, and uniquely; else PDEError."""
    D = exact.determinant
    if not D:
        raise PDEError("the linearised equations do not determine the unknowns: det(lambda E + S) vanishes identically")
    if not any(n for n, *_ in D):
        raise PDEError("the constraints leave nothing that evolves: no perturbation has a growth rate")
    return exact
