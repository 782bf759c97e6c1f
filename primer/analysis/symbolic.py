"""A PDE as text: linearise, freeze, and look for exponentials (the three steps of section A2.1)."""

from __future__ import annotations

from itertools import product
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from primer.analysis.each import Each, each
from primer.analysis.frozen import frozen, is_lower, is_uniform
from primer.analysis.pencil import Pencil
from primer.analysis.roots import DIGITS
from primer.analysis.symbol import Symbol
from primer.checks import shown
from primer.equations.error import PDEError, ask
from primer.equations.kinks import slope_at, slope_at_kink
from primer.equations.missing import dropped, not_given
from primer.equations.values import evaluated, substituted
from primer.types import ArrayLike, Multiplier


def symbol(
    text: Any,
    *,
    at: dict[str, Any] | None = None,
    order: str = "full",
    uniform: bool = False,
    space: Any = None,
    time: str | None = None,
    **parameters: Any,
) -> Symbol:
    """The exact :class:`Symbol` of a PDE, linearised about a base state and frozen.

    Parameters
    ----------
    text : str          equations such as "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)", as people write them, also
                        in LaTeX: ``primer help equations``. A list of texts, sympy equations and lists of these, too
    at : dict           base-state values by name: {"u": -0.5, "v_xx": 0.3}, and where x, y, t are frozen
    order : str         "full", or "maximal": in each equation only the highest space derivatives of each unknown are
                        kept, as in eq. (toy-pde-lin)
    uniform : bool      whether all derivatives of the base state are 0
    space, time         what the text calls its variables, such as space="r", or "x, z", and time="tau"
    **parameters        the values of the other names; a function f(u) of the text is given as a text, f="u^3 - u", or
                        as a function of Python, f=lambda u: u**3 - u

    Raises
    ------
    PDEError    (a ValueError) for text that cannot be used, or for values that matter and are not given, all of them
    """
    system, values = frozen(text, at, order, uniform, space, time, parameters)
    missing, entries = dict.fromkeys(dropped(system, values)), []
    with mp.workdps(DIGITS):
        for r, slopes in enumerate(system.slopes):
            row: dict[str, dict] = {name: {} for name in system.unknowns}
            for (name, power), slope in sorted(slopes.items(), key=lambda item: -sum(item[0][1][1:])):
                if order == "maximal" and is_lower(power, row[name]):
                    continue
                unset = {s.name for s in slope.free_symbols if s.name not in values}
                missing.update(dict.fromkeys(sorted(unset)))
                coefficient = mp.mpf(1) if unset else slope_at(system, r, (name, power), values)
                if coefficient != 0:
                    row[name][power] = coefficient
            entries.append(tuple(row.values()))
    if missing:
        raise PDEError(not_given(missing, system))
    if not any(n for row in entries for entry in row for n, *_ in entry):
        raise PDEError("no equation contains a time derivative (u_t), so nothing evolves")
    return Symbol(tuple(entries), system.dim, is_uniform(system, values), system.operators)


def growth_rates(
    text: Any,
    xi: ArrayLike,
    *,
    at: dict[str, Any] | None = None,
    order: str = "full",
    multiplier: Multiplier | None = None,
    uniform: bool = False,
    space: Any = None,
    time: str | None = None,
    **parameters: Any,
) -> np.ndarray:
    """The growth rates lambda of the perturbations e^{i xi x + lambda t} of a PDE at wavenumbers xi.

    Parameters
    ----------
    text, at, order, uniform, space, time, parameters    as for :func:`symbol`; where values are arrays, of shape s0,
                        the answer is of shape s0 + s + (number of finite branches,)
    xi : array          of shape s; in two space variables of shape (2,) + s
    multiplier          ``multiplier(xi, m)`` is what the m-th derivative does to e^{i xi x}: left out, (i xi)^m; a
                        grid's ``Grid.multiplier`` gives the growth of the equations on that grid. A mixed derivative is
                        the product of one in x and one in y.

    Returns
    -------
    complex array of shape s + (number of finite branches,), sorted by decreasing real part

    The eigenvalues of eq. (toy-mat), for the toy system.

    >>> print(growth_rates("u_t = u_xxx - u_xx", [1.0, 10.0]).real.ravel())
    [  1. 100.]
    """
    options = {"order": order, "multiplier": multiplier, "uniform": uniform, "space": space, "time": time}
    found = each(at, parameters, lambda at, parameters: pencil(text, at=at, **options, **parameters).eigenvalues(xi))
    if not isinstance(found, Each):
        return found
    if len({rates.shape for rates in found.flat}) > 1:
        raise ValueError("the number of branches differs between these base states: ask for one at a time")
    return (
        np.stack(list(found.flat)).reshape(*found.shape, *found.flat[0].shape) if found.size else np.empty(found.shape)
    )


def pencil(
    text: Any,
    *,
    at: dict[str, Any] | None = None,
    order: str = "full",
    multiplier: Multiplier | None = None,
    uniform: bool = False,
    space: Any = None,
    time: str | None = None,
    **parameters: Any,
) -> Pencil:
    """The symbol of a PDE as a :class:`Pencil` of numbers; arguments as for :func:`growth_rates`."""
    if multiplier is not None and not callable(multiplier):
        raise TypeError(f"multiplier must be a function of xi and m, got {shown(multiplier)}")
    exact = symbol(text, at=at, order=order, uniform=uniform, space=space, time=time, **parameters)
    for m in sorted(
        {m for row in exact.entries for entry in row for power in entry for m in _orders(exact, power)} - {0}
    ):
        try:
            multiplier is None or multiplier(np.array([1.0]), m)
        except (LookupError, ValueError, NotImplementedError):
            raise PDEError(
                f"the multiplier does not know the derivative of order {m} that the equations contain"
            ) from None
    return exact.pencil(multiplier)


def _orders(symbol, power):
    return power[1:-2] if symbol.operators else power[1:]


def linearise(
    text: Any,
    *,
    at: dict[str, Any] | None = None,
    order: str = "full",
    uniform: bool = False,
    space: Any = None,
    time: str | None = None,
    **parameters: Any,
) -> Any:
    """The symbol of a PDE as a sympy matrix, for eq. (toy-mat).

    Names without a value stay symbols, though one that nothing would be left of, as of a forcing, must have a value;
    so do the wavenumber xi, or xi_1, xi_2 (and xi_3) in more space variables. Other arguments are those of
    :func:`symbol`.

    Returns
    -------
    sympy.Matrix    A, with lambda q = A q, where the equations give the first time derivatives (or, up to three, can be
                    solved for them); otherwise, as with constraints or a second time derivative, M, with M q = 0,
                    whose entries contain lambda. The unknowns q are in the order in which they occur, those with a time
                    derivative first. Where values are arrays, an array of such matrices, of their shape.

    >>> print(linearise("u_t = u*u_x + u_xx", at={"u": 2, "u_x": 0}))
    Matrix([[-xi**2 + 2*I*xi]])
    """
    return each(at, parameters, lambda at, parameters: _matrix(text, at, order, uniform, space, time, parameters))


def _matrix(text, at, order, uniform, space, time, parameters):
    system, values = frozen(text, at, order, uniform, space, time, parameters)
    for name in dropped(system, values):
        said = system.said(name)
        problem = (
            f"{said} has no value, and nothing is left of it in the linearised equations: give {ask('value', said)}"
        )
        raise PDEError(problem, system.text, system.places[name])
    lam, *xi = sp.symbols("lambda xi" if system.dim == 1 else f"lambda xi_1:{system.dim + 1}")
    size = len(system.unknowns)
    parts: dict = {}
    for r, slopes in enumerate(system.slopes):
        row: dict[str, dict] = {name: {} for name in system.unknowns}
        for name, power in sorted(slopes, key=lambda place: -sum(place[1][1:])):
            coefficient = _spoken(_in_symbols(system, r, (name, power), values), system, {lam, *xi})
            if not (order == "maximal" and is_lower(power, row[name])) and coefficient != 0:
                row[name][power] = coefficient
                n, *orders = power
                wave = sp.prod((sp.I * k) ** m for k, m in zip(xi, orders[: len(xi)], strict=True))
                if system.operators:
                    length = sp.Abs(xi[0]) if system.dim == 1 else sp.sqrt(sum(k**2 for k in xi))
                    wave *= (-sp.I * sp.sign(xi[0])) ** orders[-2] * length ** orders[-1]
                entry = parts.setdefault(n, sp.zeros(size))
                entry[r, system.unknowns.index(name)] += coefficient * wave
    S, E = (parts.get(n, sp.zeros(size)) for n in (0, 1))
    if max(parts, default=0) == 1 and sp.eye(size) == E:
        return -S
    if max(parts, default=0) == 1 and size <= 3 and _regular(E):
        return (E.adjugate() * -S / E.det()).applyfunc(_tidied)  # up to 3 x 3 by formula: E.inv() simplifies for ever
    return sum((lam**n * part for n, part in parts.items()), sp.zeros(size))


def _in_symbols(system, r, place, values):
    """A slope, where names without a value stay."""
    slope = system.slopes[r][place]
    try:
        return substituted(slope, values)
    except PDEError:
        if any(symbol.name not in values for symbol in slope.free_symbols):
            raise
        found = slope_at_kink(system, r, place, values)
        if found is None:
            raise
        return sp.nsimplify(sp.sympify(found), rational=True)


def _spoken(expression, system, waves):
    """The expression in the names of the text, which must not be those of the wave."""
    names = {symbol: sp.Symbol(system.outside(symbol.name)) for symbol in expression.free_symbols}
    for own in names.values():
        if own in waves:
            raise PDEError(f"{own} stands for the growth rate or the wavenumber: give {ask('value', own.name)}")
    return expression.xreplace(names)


def _regular(E):
    """Whether det E does not vanish identically: at a point in general position, to many digits."""
    names = sorted(symbol.name for symbol in E.free_symbols)
    point = {name: sp.Rational(2 * j + 3, 3 * j + 4) for j, name in enumerate(names)}
    try:
        with mp.workdps(60):
            numbers = mp.matrix(E.rows, E.cols)
            for place in product(range(E.rows), repeat=2):
                numbers[place] = evaluated(E[place], point)
            scale = mp.norm(numbers, mp.inf) ** E.rows
            return bool(abs(mp.det(numbers)) > mp.mpf(10) ** -40 * scale)
    except PDEError:  # not to be had in numbers
        return False


def _tidied(entry):
    return sp.cancel(entry) if entry.count_ops() < 100 else entry
