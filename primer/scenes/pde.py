"""The scene of any PDE: type it, freeze it at a base state, and see what its short waves do, on a grid too."""

import math
import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from primer.analysis.sphere import directions
from primer.analysis.symbol import Symbol
from primer.analysis.symbolic import linearise, symbol
from primer.analysis.verdict import Kind, Verdict, verdict
from primer.checks import integer, real, shown
from primer.equations.text import PDEError
from primer.schemes.grid import Grid

MAX_N = 1024
XI = np.geomspace(1e-2, 1e3, 121)
TOY = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"
_ANGLES = np.arange(32) * np.pi / 16  # of the wavevector, in two space variables
_NOISE = 1e-11  # a real part so small, relative to its eigenvalue, is rounding
_WAVES = ("lambda", "xi", "xi_1", "xi_2", "xi_3")


@dataclass(frozen=True, eq=False)
class PDEAnswer:
    """What :func:`pde` found.

    Attributes
    ----------
    n, cut_off     points on the period, and the xi of the grid's shortest wave, n/2 on 2 pi
    has_lambda     whether ``matrix`` is M of M q = 0, with lambda inside, and not A of lambda q = A q
    matrix         rows of texts: the symbol, as :func:`primer.linearise` gives it
    xi, rate       (k,) wavenumbers |xi| and max Re lambda, in two space variables the largest of 32 directions and that
                   of the verdict
    grid_xi, grid_rate    the same as the grid sees it, up to its cut-off n/2
    found          the :class:`primer.Verdict`
    verdict        the same in words, with what the grid makes of it
    """

    n: int
    cut_off: float
    has_lambda: bool
    matrix: tuple
    xi: np.ndarray
    rate: np.ndarray
    grid_xi: np.ndarray
    grid_rate: np.ndarray
    found: Verdict
    verdict: str


def pde(
    pde: str = TOY,
    at: str = "u=-0.5 v_xx=0.3 eps=0.01",
    order: str = "full",
    n: int = 64,
    uniform: bool = False,
    period: float = 2 * math.pi,
) -> PDEAnswer:
    """Is a PDE linearly ill-posed, frozen at a base state, and does a grid of spacing period/n show it?

    Parameters
    ----------
    pde      equations as :func:`primer.linearise` reads them, such as "u_t = -u_xx", parted by ";"
    at       base-state values and parameters parted by blanks: "u=-0.5 eps=0.01"; a function f(u) of the equations as
             a text without blanks, "f=u^3-u"; and what the variables are called, "space=r", "space=x,z", "time=tau"
    order    "full", or "maximal": the highest derivatives alone
    uniform  whether all derivatives of the base state are 0
    n        4 to 1024, on this period; derivatives above the second are products of the central differences of first
             and second order

    Raises
    ------
    TypeError, ValueError    in one sentence, for equations that cannot be read, for base-state values that are missing
                             or belong to nothing, and for n outside its range
    """
    for name, value in (("pde", pde), ("at", at)):
        if not isinstance(value, str):
            raise TypeError(f"{name} must be a text, got {shown(value)}")
    if order not in ("full", "maximal"):
        raise ValueError(f"order must be full or maximal, got {shown(order)}")
    if not isinstance(uniform, bool):
        raise TypeError(f"uniform must be True or False, got {shown(uniform)}")
    n = integer("n", n, least=4, most=MAX_N)
    try:
        known = _known(pde, at, order, uniform)
    except PDEError as error:
        problem = _one_line(error)
        if "has a value but does not occur" in problem:
            raise ValueError(f"{problem}: take it out of at, the base state") from None
        raise ValueError(f"pde or at cannot be used: {problem}") from None
    cut_off = math.pi * n / real("period", period, above=0)
    grid_xi = np.geomspace(min(XI[0], cut_off / 10), cut_off, 121 if known.symbol.dim == 1 else 41)
    rates = [_growth(known.symbol, grid_xi * m / n, known.found, Grid(m, period)) for m in (n, 2 * n)]
    spacing = f"{period / math.pi:.4g}π/{n}"
    text = f"{_judged(known.found, pde, order)} {_seen(known.found, spacing, *(np.nanmax(rate) for rate in rates))}"
    return PDEAnswer(n, cut_off, known.has_lambda, known.matrix, XI, known.rate, grid_xi, rates[0], known.found, text)


@dataclass(frozen=True, eq=False)
class _Known:
    """What does not depend on the grid."""

    symbol: Symbol
    has_lambda: bool
    matrix: tuple
    rate: np.ndarray
    found: Verdict


@lru_cache(maxsize=16)
def _known(pde, at, order, uniform):
    found = read_values(at)
    values = {name: value for name, value in found.items() if not isinstance(value, str)}
    options = {name: value for name, value in found.items() if name not in values} | {"uniform": uniform}
    matrix = linearise(pde, at=values, order=order, **options)
    missing = sorted(s.name for s in matrix.free_symbols if s.name not in _WAVES)
    if missing:
        loose = linearise(pde, at=values, order=order, **options | {"uniform": True})
        derived = len(loose.free_symbols) < len(matrix.free_symbols) and not uniform
        first = "uniform must be yes if all derivatives of the base state are 0, or " if derived else ""
        raise ValueError(
            f"{first}at must also give a value to {', '.join(missing)}, as in {missing[0]}=1, got {shown(at)}"
        )
    exact = symbol(pde, at=values, order=order, **options)
    found = verdict(exact)
    has_lambda = any(s.name == "lambda" for s in matrix.free_symbols)
    texts = tuple(tuple(_written(entry) for entry in row) for row in matrix.tolist())
    return _Known(exact, has_lambda, texts, _growth(exact, XI, found), found)


def read_values(text):
    """Name -> number, or text, from "u=-0.5 eps=0.01 f=u^2".

    Raises
    ------
    ValueError    if it is not of this form, or gives a name twice
    """
    values = {}
    for part in re.sub(r"\s*=\s*", "=", text).split():
        name, equals, value = part.partition("=")
        try:
            number: Any = float(value) if equals and name else None
        except ValueError:
            number = value if re.fullmatch(r"[^=]*[^\W\d_][^=]*", value) else None  # a function, or a variable
        if number is None or name in values:
            raise ValueError(f"at must be NAME=NUMBER parted by blanks, each name once, got {shown(part)}")
        values[name] = number
    return values


def _growth(exact, k, found, grid=None):
    """max Re lambda at |xi| = k over both signs, or over directions; nan where some unknown is undetermined."""
    pencil = exact.pencil(_multiplier(grid) if grid else None)
    if exact.dim == 1:
        xi = np.multiply.outer(k, [1.0, -1.0])
    elif exact.dim == 3:
        all_around = np.column_stack([directions(), found.direction]) if found.direction else directions()
        xi = np.multiply.outer(k, all_around).transpose(1, 0, 2)
    else:
        angle = np.append(_ANGLES, np.arctan2(*found.direction[::-1]) if found.direction else 0.0)
        xi = np.stack([np.multiply.outer(k, np.cos(angle)), np.multiply.outer(k, np.sin(angle))])
    lam = pencil.eigenvalues(xi)
    real = np.where(np.abs(lam.real) <= _NOISE * np.abs(lam), 0, lam.real)
    best = np.where(np.isnan(lam), -np.inf, real).max(axis=(-2, -1))
    return np.where(np.isinf(best), np.nan, best)


def _multiplier(grid):
    """Of the m-th derivative: (second difference)^(m/2), times a first difference if m is odd."""
    return lambda xi, m: grid.multiplier(xi, 2) ** (m // 2) * (grid.multiplier(xi, 1) if m % 2 else 1)


def _written(entry):
    import sympy

    text = str(entry.xreplace({sympy.I: sympy.Symbol("i")}))
    for old, new in (("**", "^"), ("*", " "), ("lambda", "λ"), ("xi", "ξ")):
        text = re.sub(rf"\b{old}(?=\b|_)", new, text) if old.isalpha() else text.replace(old, new)
    return text


def _one_line(error):
    """The message, with the place in the text in words in place of a caret."""
    problem, *place = error.said("explorer").split("\n")
    if len(place) != 2:
        return problem
    rest = place[0][place[1].index("^") :].strip()
    return f"{problem}, at {shown(rest)}" if rest else f"{problem}, at the end"


def _judged(found, pde, order):
    reason = found.reason.replace("lambda", "λ").replace("|xi|", "|ξ|").replace("->", "→")
    if not reason.startswith("Re "):
        reason = reason[0].lower() + reason[1:]
    kind = {Kind.ILL_POSED: "Ill posed", Kind.UNDECIDED: "Undecided", Kind.WELL_POSED: "Well posed"}[found.kind]
    if found.kind is Kind.WELL_POSED and found.grows:
        kind = "Well posed but unstable" if found.unstable else "Well posed, with growth"
    if 0 < found.loss < math.inf:
        kind = f"Weakly {kind[0].lower()}{kind[1:]}"
    alone = ", with the highest derivatives alone" if order == "maximal" else ""
    text = " ".join(pde.split())
    return f"{kind} ({text if len(text) <= 60 else text[:57] + '...'}{alone}): {reason}"


def _seen(found, spacing, rate, finer):
    grid = f"a grid of spacing {spacing}"
    if found.kind is not Kind.ILL_POSED:
        return f"On {grid} no wave grows faster than e^({rate:.3g} t)." if rate > 0 else f"On {grid} nothing grows."
    if not rate > 0:
        return f"On {grid} nothing grows: it is too coarse to show it."
    return f"On {grid} the fastest wave grows like e^({rate:.3g} t), on one twice as fine like e^({finer:.3g} t)."
