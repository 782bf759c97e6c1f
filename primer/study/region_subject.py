"""What a region is asked of: a text, a family of pencils, or a granular law, each with a verdict at any one point."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from primer.analysis.family import family
from primer.analysis.outcome import Kind, Verdict, undecided
from primer.analysis.puiseux import hull_of
from primer.analysis.roots import DIGITS
from primer.analysis.signature import signatures
from primer.analysis.symbol import Symbol
from primer.analysis.verdict import verdict
from primer.checks import shown
from primer.equations.error import PDEError

KINDS = (Kind.WELL_POSED, Kind.ILL_POSED, Kind.UNDECIDED)
_GONE = ("divide by zero", "not a number to work with", "has no slope", "of a number above")  # at this point alone


@dataclass(frozen=True, eq=False)
class Subject:
    """Something with a verdict at each value of ``names``; ``found`` is the Family of a text, where it has one."""

    pde: Any
    names: tuple
    at: dict
    options: dict
    found: Any = None
    numbered: dict = field(default_factory=dict)

    def verdict(self, point) -> Verdict:
        """The verdict at one point; undecided, and why, where the equations have no linearisation or state there."""
        values = dict(zip(self.names, (x if isinstance(x, sp.Expr) else float(x) for x in point), strict=True))
        if is_law(self.pde):
            return _of_law(self.pde, self.at | values)
        if callable(self.pde) and not isinstance(self.pde, str):
            made = self.pde(**self.at, **values)
            return made if isinstance(made, Verdict) else verdict(made)
        try:
            return verdict(self.pde, at=self.at | values, **self.options)
        except PDEError as error:
            if any(words in str(error) for words in _GONE):
                return undecided(str(error).splitlines()[0].rstrip("."))
            raise

    def exact(self, point) -> Verdict:
        """The verdict at a point of sympy's numbers, where what cancels does so exactly, as x^2 - 2 at sqrt(2)."""
        if self.found is None or all(not isinstance(x, sp.Expr) or x.is_Rational for x in point):
            return self.verdict(point)
        exact = (x if isinstance(x, sp.Expr) else sp.Rational(repr(float(x))) for x in point)
        here = dict(zip(self.found.symbols, exact, strict=True))
        terms = {p: sp.simplify(c.xreplace(here)) for p, c in self.found.determinant.items()}
        terms = {p: mp.mpmathify((c / sp.I ** sum(p[1:])).evalf(DIGITS)) for p, c in terms.items() if c != 0}
        return verdict(Symbol(((terms,),), self.found.dim))

    @property
    def has_labels(self) -> bool:
        """Whether many points can be told apart at once."""
        return is_law(self.pde) or (self.found is not None and self.found.dim == 1)

    def labels(self, points):
        """(labels, growth) of points (m, names), see :func:`primer.analysis.signature.signatures`."""
        if is_law(self.pde):
            return _leading(self.pde, self.at | dict(zip(self.names, np.transpose(points), strict=True)))
        return signatures(self.found, list(np.transpose(points)), self.numbered)

    def special(self, name, others):
        """Values of one name, ascending, at which a coefficient vanishes or two leading roots meet, the others fixed.

        Zeros of polynomials and of quotients of them, as sympy's numbers: exact where a factor is of degree one or two.
        What other functions vanish at is not known here.
        """
        if self.found is None:
            return []
        x = self.found.symbols[self.found.names.index(name)]
        fixed = {
            s: sp.Rational(repr(float(others[n])))
            for n, s in zip(self.found.names, self.found.symbols, strict=True)
            if n != name
        }
        values: set = set()
        for expression in invariants(self.found):
            for part in sp.fraction(sp.together(expression.xreplace(fixed))):
                for real in sp.expand(part).as_real_imag():
                    if real.has(x) and real.is_polynomial(x):
                        values.update(_zeros(real, x))
        return sorted(values, key=float)


def _zeros(polynomial, x):
    """The real zeros of a polynomial in x with coefficients that are numbers."""
    if not all(c.is_number for c in sp.Poly(polynomial, x).all_coeffs()):
        return []
    found = []
    for factor, _ in sp.factor_list(polynomial, x)[1]:
        p = sp.Poly(factor, x)
        if p.degree() <= 2:
            found += [z for z in sp.roots(p) if z.is_real]
        else:
            with suppress(sp.PolynomialError, ValueError):
                found += [z for z in p.nroots(n=30, maxsteps=200) if z.is_real]
    return found


def invariants(found):
    """The coefficients of det M, and the discriminants of the edges of its Newton polygon in general position."""
    D = found.determinant
    yield from D.values()
    if found.dim > 1:
        return
    P = {(n, a): c for (n, a, _), c in D.items()}
    hull, z = hull_of(P), sp.Dummy("z")
    for (i, j), (i2, j2) in pairwise(hull):
        edge = sum(P.get((i + m, j + (j2 - j) * sp.Rational(m, i2 - i)), 0) * z**m for m in range(i2 - i + 1))
        if 2 <= i2 - i <= 4:
            yield sp.discriminant(sp.Poly(edge, z), z)


def subject(pde, names, at, options) -> Subject:
    """The :class:`Subject` of whatever was given."""
    if not isinstance(at, dict):
        raise TypeError(f"at must be a dict of values such as {{'v_xx': 0.3}}, got {shown(at)}")
    if twice := [name for name in names if name in at or name in options]:
        raise ValueError(f"{twice[0]} is varied and has a value: give one of them")
    if is_law(pde) or callable(pde):
        given = {name: value for name, value in options.items() if name not in _DEFAULTS}
        if any(options[name] != value for name, value in _DEFAULTS.items()):
            raise ValueError("order, uniform, space and time go with equations as text only")
        return Subject(pde, names, at | given, {})
    if not isinstance(pde, (str, list, sp.Basic)):
        raise TypeError(f"pde must be a text, a function that gives a Pencil, or a granular law, got {shown(pde)}")
    try:
        found = family(pde, names, at, **options)
    except NotImplementedError:
        found = None
    return Subject(pde, names, at, options, found)


_DEFAULTS = {"order": "full", "uniform": False, "space": None, "time": None}


def is_law(pde) -> bool:
    """Whether this is a granular law: it has Y(p, phi, I) and f(p, phi, I)."""
    return all(callable(getattr(pde, name, None)) for name in ("Y", "f", "Y_p"))


def _state(law, values):
    from primer.granular.state import BaseState

    try:
        return BaseState(**values)
    except TypeError:
        raise ValueError(
            f"a granular law is asked at values of p, phi and I, all of them, got {', '.join(values)}"
        ) from None


def _of_law(law, values):
    from primer.granular.posedness import verdict as judged

    state = _state(law, values)
    if not law.Y(state.p, state.phi, state.I) > 0:
        return undecided("the law does not admit this state: Y <= 0")
    return judged(law, state)


def _leading(law, values):
    from primer.granular.limits import leading
    from primer.granular.linearisation import coefficients
    from primer.granular.state import BaseState

    values = dict(zip(values, np.broadcast_arrays(*values.values()), strict=True))
    size = np.size(next(iter(values.values())))
    labels, growth = np.full(size, -2), np.full(size, math.nan)
    inside = np.broadcast_to(law.Y(values["p"], values["phi"], values["I"]) > 0, size)
    if inside.any():
        lead = leading(coefficients(law, BaseState(**{name: v[inside] for name, v in values.items()})))
        exponent = np.broadcast_to(lead.exponent, inside.sum())
        grows = np.broadcast_to(lead.ill_posed, inside.sum())
        labels[inside] = np.where(np.isnan(exponent), 99, np.round(6 * np.nan_to_num(exponent))) + 100 * grows
        growth[inside] = np.where(grows, lead.coefficient, math.nan)
    return labels, growth
