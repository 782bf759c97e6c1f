"""A PDE as text: linearise, freeze, and look for exponentials (the three steps of section A2.1)."""

from __future__ import annotations

from itertools import product
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from primer.analysis.pencil import Pencil
from primer.analysis.roots import DIGITS, ZERO
from primer.analysis.symbol import Symbol
from primer.checks import shown
from primer.equations.linear import dropped, read
from primer.equations.text import PDEError, split_name
from primer.equations.values import checked, evaluated, substituted
from primer.types import ArrayLike, Multiplier


def symbol(text: str, *, at: dict[str, Any] | None = None, order: str = "full", **parameters: Any) -> Symbol:
    """The exact :class:`Symbol` of a PDE, linearised about a base state and frozen.

    Parameters
    ----------
    text : str          equations such as "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"; the grammar is in
                        ``primer.equations.text``
    at : dict           base-state values by name: {"u": -0.5, "v_xx": 0.3}, and where x, y, t are frozen
    order : str         "full", or "maximal": in each equation only the highest space derivatives of each unknown are
                        kept, as in eq. (toy-pde-lin)
    **parameters        the values of the other names

    Raises
    ------
    PDEError    (a ValueError) for text that cannot be used, or for values that matter and are not given, all of them
    """
    system, values = _read(text, at, order, parameters)
    missing, entries = dict.fromkeys(dropped(system, values)), []
    with mp.workdps(DIGITS):
        for slopes in system.slopes:
            row: dict[str, dict] = {name: {} for name in system.unknowns}
            for (name, power), slope in sorted(slopes.items(), key=lambda item: -sum(item[0][1][1:])):
                if order == "maximal" and _is_lower(power, row[name]):
                    continue
                unset = {s.name for s in slope.free_symbols if s.name not in values}
                missing.update(dict.fromkeys(sorted(unset)))
                coefficient = mp.mpf(1) if unset else evaluated(slope, values)
                if coefficient != 0:
                    row[name][power] = coefficient
            entries.append(tuple(row.values()))
    if missing:
        raise PDEError(_what_is_missing(missing, system))
    if not any(n for row in entries for entry in row for n, _, _ in entry):
        raise PDEError("no equation contains a time derivative (u_t), so nothing evolves")
    return Symbol(tuple(entries), system.dim, _is_uniform(system, values))


def growth_rates(
    text: str,
    xi: ArrayLike,
    *,
    at: dict[str, Any] | None = None,
    order: str = "full",
    multiplier: Multiplier | None = None,
    **parameters: Any,
) -> np.ndarray:
    """The growth rates lambda of the perturbations e^{i xi x + lambda t} of a PDE at wavenumbers xi.

    Parameters
    ----------
    text, at, order, parameters    as for :func:`symbol`
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
    return pencil(text, at=at, order=order, multiplier=multiplier, **parameters).eigenvalues(xi)


def pencil(
    text: str,
    *,
    at: dict[str, Any] | None = None,
    order: str = "full",
    multiplier: Multiplier | None = None,
    **parameters: Any,
) -> Pencil:
    """The symbol of a PDE as a :class:`Pencil` of numbers; arguments as for :func:`growth_rates`."""
    if multiplier is not None and not callable(multiplier):
        raise TypeError(f"multiplier must be a function of xi and m, got {shown(multiplier)}")
    exact = symbol(text, at=at, order=order, **parameters)
    for m in sorted({m for row in exact.entries for entry in row for _, *orders in entry for m in orders if m}):
        try:
            multiplier is None or multiplier(np.array([1.0]), m)
        except (LookupError, ValueError, NotImplementedError):
            raise PDEError(
                f"the multiplier does not know the derivative of order {m} that the equations contain"
            ) from None
    return exact.pencil(multiplier)


def linearise(text: str, *, at: dict[str, Any] | None = None, order: str = "full", **parameters: Any) -> sp.Matrix:
    """The symbol of a PDE as a sympy matrix, for eq. (toy-mat).

    Names without a value stay symbols, though one that nothing would be left of, as of a forcing, must have a value;
    so do the wavenumber xi, or xi_1 and xi_2 in two space variables. Other arguments are those of :func:`symbol`.

    Returns
    -------
    sympy.Matrix    A, with lambda q = A q, where the equations give the first time derivatives (or, up to three, can be
                    solved for them); otherwise, as with constraints or a second time derivative, M, with M q = 0,
                    whose entries contain lambda. The unknowns q are in the order in which they occur, those with a time
                    derivative first.

    >>> print(linearise("u_t = u*u_x + u_xx", at={"u": 2, "u_x": 0}))
    Matrix([[-xi**2 + 2*I*xi]])
    """
    system, values = _read(text, at, order, parameters)
    for name in dropped(system, values):
        problem = f"{name} has no value, and nothing is left of it in the linearised equations: give {name}=..."
        raise PDEError(problem, system.text, system.places[name])
    lam, *xi = sp.symbols("lambda xi") if system.dim == 1 else sp.symbols("lambda xi_1 xi_2")
    size = len(system.unknowns)
    parts: dict = {}
    for r, slopes in enumerate(system.slopes):
        row: dict[str, dict] = {name: {} for name in system.unknowns}
        for (name, power), slope in sorted(slopes.items(), key=lambda item: -sum(item[0][1][1:])):
            coefficient = substituted(slope, values)
            if not (order == "maximal" and _is_lower(power, row[name])) and coefficient != 0:
                row[name][power] = coefficient
                n, *orders = power
                wave = sp.prod((sp.I * k) ** m for k, m in zip(xi, orders, strict=False))
                entry = parts.setdefault(n, sp.zeros(size))
                entry[r, system.unknowns.index(name)] += coefficient * wave
    S, E = (parts.get(n, sp.zeros(size)) for n in (0, 1))
    if max(parts, default=0) == 1 and sp.eye(size) == E:
        return -S
    if max(parts, default=0) == 1 and size <= 3 and _regular(E):
        return (E.adjugate() * -S / E.det()).applyfunc(_tidied)  # up to 3 x 3 by formula: E.inv() simplifies for ever
    return sum((lam**n * part for n, part in parts.items()), sp.zeros(size))


def _read(text, at, order, parameters):
    if order not in ("full", "maximal"):
        raise ValueError(f"order must be 'full' or 'maximal', got {shown(order)}")
    system = read(text, parameters)
    return system, checked(system, at, parameters)


def _is_lower(power, kept):
    """Whether a higher space derivative, of the same order in time, is among those kept."""
    return any(n == power[0] and sum(rest) > sum(power[1:]) for n, *rest in kept)


def _is_uniform(system, values):
    """Whether the base state is uniform and steady, as far as given; an unknown without a value counts as zero."""
    state = dict(values)
    names = {symbol.name for F in system.sides for symbol in F.free_symbols}
    for name in names | set(values):
        base, letters = split_name(name)
        if base in "xyt" or (base in system.unknowns and letters and values.get(name, 0) != 0):
            return False
        if base in system.unknowns:
            state.setdefault(name, sp.S.Zero)
    try:
        with mp.workdps(DIGITS):
            left = (substituted(F, state) for F in system.sides)
            return all(not F.free_symbols and abs(evaluated(F, {})) < ZERO for F in left)
    except PDEError:  # without a value at this state, as log(u) at u = 0 where u matters to no slope
        return False


def _what_is_missing(missing, system):
    parameters = [name for name in missing if name in system.parameters]
    base = [name for name in missing if name not in parameters]
    parts = []
    if base:
        parts.append("base-state values " + ", ".join(base) + " (at={" + ", ".join(f"'{n}': ..." for n in base) + "})")
    if parameters:
        parts.append("parameters " + ", ".join(f"{name}=..." for name in parameters))
    return "not given: " + " and ".join(parts)


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
