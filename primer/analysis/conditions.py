"""For which values equations are ill posed, in symbols: names without a value stay, and the answer is conditions."""

from __future__ import annotations

import random
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations
from typing import Any

import numpy as np
import sympy as sp

from primer.analysis.all_directions import cases_all_around
from primer.analysis.cases import Found, cases
from primer.analysis.family import family
from primer.analysis.laws import growth_laws
from primer.analysis.outcome import Kind
from primer.analysis.puiseux import Law
from primer.analysis.simpler import joined, short
from primer.analysis.verdict import verdict
from primer.checks import integer, real, real_array, shown
from primer.equations.error import PDEError


@dataclass(frozen=True)
class Case:
    """Where ``condition`` holds, what follows.

    Attributes
    ----------
    condition    of sympy, in the names that were left open
    kind         ill-posed, or undecided
    growth       of sympy: Re lambda ~ growth |xi|^exponent; None where it has no closed form here
    exponent     of |xi|, Fraction
    """

    condition: Any
    kind: Kind
    growth: Any
    exponent: Fraction

    def __str__(self):
        said = str(self.condition).replace("**", "^")
        if self.kind is Kind.UNDECIDED:
            return f"undecided where {said}"
        power = "|xi|" if self.exponent == 1 else f"|xi|^{self.exponent}"
        power = power if self.exponent.denominator == 1 else f"|xi|^({self.exponent})"
        law = power if self.growth is None else f"({self.growth}) {power}".replace("**", "^")
        return f"ill posed where {said}; growth {law}"


@dataclass(frozen=True)
class Conditions:
    """The conditions for ill-posedness of equations, in symbols.

    Attributes
    ----------
    names        that were left open
    cases        of ``Case``: ill posed where any of those holds, undecided where one of these does; else ``otherwise``
    otherwise    well-posed; undecided if the check has found that false
    checked      at how many random points the verdict has agreed
    withdrawn    cases that it contradicted, and which are not among the cases

    Of the test of section A2.1, see ``conditions``.

    >>> from primer import conditions
    >>> found = conditions("u_tt = c*u_xx")
    >>> print(found.cases[0].condition, found.kind(c=-2.0), found.kind(c=1.0))
    c < 0 ill-posed well-posed
    """

    names: tuple
    cases: tuple
    otherwise: Kind
    checked: int
    withdrawn: tuple

    def kind(self, **values: float) -> Kind:
        """What the conditions say at a point; names of which no condition speaks may be left out.

        Raises
        ------
        ValueError    for a name that was not left open, or without one that a condition needs
        """
        needed = {str(name) for case in self.cases for name in case.condition.free_symbols}
        if not needed <= set(values) <= set(self.names):
            raise ValueError(f"values must be of {', '.join(self.names) or 'nothing'}, got {shown(sorted(values))}")
        return _kind(self.cases, self.otherwise, {n: sp.Rational(repr(real(n, v))) for n, v in values.items()})[0]

    def __str__(self):
        return "\n".join([*map(str, self.cases), f"{self.otherwise.replace('-', ' ')} otherwise"])


def conditions(
    text: Any,
    /,
    *,
    at: dict[str, Any] | None = None,
    order: str = "full",
    uniform: bool = False,
    space: Any = None,
    time: str | None = None,
    direction: Any = None,
    check: int = 60,
    **parameters: Any,
) -> Conditions:
    """For which values of the names that have none equations are ill posed: the conditions themselves.

    Of each branch of the Newton polygon: the sign of its leading coefficient, a discriminant, or the inequality of
    Routh and Hurwitz; case by case where a coefficient vanishes; and of what follows where a leading part is imaginary.
    Up to five unknowns; in one space variable, or along one ``direction`` of two; over all directions of two where the
    leading part is a quadratic form, or two, as of M + N in eq. (matrix). What is beyond this is an undecided case, as
    a leading part of the fourth degree in lambda may be. All names are taken to be real.

    Parameters
    ----------
    direction    two numbers: only waves along it, in two space variables
    check        at how many random points the conditions are held to ``verdict``, or to :func:`primer.growth_laws`
                 along a direction; a case that fails is withdrawn
    others       as for :func:`primer.verdict`

    Kinds of well-posedness, weak or strong, are not told apart.

    Raises
    ------
    PDEError      (a ValueError) for text that cannot be used
    ValueError    for what is beyond this, which says so: :func:`primer.region` answers it in numbers

    >>> print(conditions("u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"))  # eq. (toy-pde)
    ill posed where eps*u < 0; growth (-eps*u) |xi|^2
    well posed otherwise
    """
    check = integer("check", check, least=1)
    if at is not None and not isinstance(at, dict):
        raise TypeError(f"at must be a dict of base-state values such as {{'u': -0.5}}, got {shown(at)}")
    options = {"at": at, "order": order, "uniform": uniform, "space": space, "time": time, **parameters}
    try:
        of = family(text, None, **options)
    except NotImplementedError as problem:
        raise ValueError(f"conditions cannot be had here ({problem}): region answers in numbers") from None
    found = _found(of, direction)
    made = list(dict.fromkeys(case for one in found if (case := _case(one)).condition != sp.false))
    return _checked(of, tuple(_merged(made)), text, options, direction, check)


def _found(of, direction):
    if of.dim == 3:
        raise ValueError("conditions are for one or two space variables: region answers three in numbers")
    if of.dim == 1 and direction is not None:
        raise ValueError("direction is for two space variables, and these equations have one")
    if not any(n for n, *_ in of.determinant):
        raise PDEError("the constraints leave nothing that evolves: no perturbation has a growth rate")
    if of.dim == 1:
        lines = [{(n, a): c for (n, a, _), c in of.determinant.items()}]
    elif direction is None:
        found = cases_all_around(of.determinant)
        if found is None:
            raise ValueError("conditions over all directions are for quadratic forms: give a direction, or ask region")
        return found
    else:
        d = real_array("direction", direction)
        if d.shape != (2,) or not d.any():
            raise ValueError(f"direction must be 2 numbers, not both zero, got {shown(direction)}")
        x, y = (sp.Rational(repr(float(z))) for z in d)
        length = sp.sqrt(x**2 + y**2)
        line: dict = {}
        for (n, a, b), c in of.determinant.items():
            line[n, a + b] = line.get((n, a + b), 0) + c * (x / length) ** a * (y / length) ** b
        lines = [line]
    mirror = {(n, a): c * (-1) ** a for (n, a), c in lines[0].items()}
    top = max(lines[0])
    ratio = sp.conjugate(mirror[top]) / lines[0][top]
    if any(sp.simplify(sp.conjugate(mirror[p]) - ratio * c) != 0 for p, c in lines[0].items()):
        lines.append(mirror)  # growth differs at xi and -xi
    return [one for line in lines for one in cases(line)]


def _case(one: Found):
    condition = short(one.condition)
    if one.growth is None:
        return Case(condition, Kind.UNDECIDED, None, one.exponent)
    return Case(condition, Kind.ILL_POSED, None if one.growth is sp.nan else one.growth, one.exponent)


def _merged(made):
    """Cases without those pairs that differ in x = 0 and x != 0 alone."""
    for one, other in combinations(made, 2):
        same = (one.kind, one.growth, one.exponent) == (other.kind, other.growth, other.exponent)
        if same and (condition := joined(one.condition, other.condition)) is not None:
            rest = [case for case in made if case is not one and case is not other]
            return _merged([*rest, replace(one, condition=condition)])
    return made


def _kind(made, otherwise, values):
    """(kind, the case that says so or None) at exact values."""
    here = {sp.Symbol(name, real=True): value for name, value in values.items()}
    for kind in (Kind.ILL_POSED, Kind.UNDECIDED):
        for case in made:
            if case.kind is kind:
                try:
                    holds = case.condition.subs(here)
                except TypeError:  # an order of numbers that are not real, as beyond the range of a root
                    continue
                if holds == True:  # noqa: E712  # sympy's true, and no relation that is left
                    return kind, case
    return otherwise, None


def _checked(of, made, text, options, direction, check):
    draw, agreed, withdrawn, otherwise = random.Random(7), 0, [], Kind.WELL_POSED
    for _ in range(check if of.names else 1):
        point = {name: _number(draw) for name in of.names}
        try:
            truth = _truth(text, options, point, direction)
        except PDEError:  # no linearisation at this point
            continue
        if truth is Kind.UNDECIDED:
            continue
        said, case = _kind(made, otherwise, point)
        while said not in (truth, Kind.UNDECIDED):
            if case is None:
                otherwise = Kind.UNDECIDED
            else:
                made = tuple(other for other in made if other is not case)
                withdrawn.append(case)
            said, case = _kind(made, otherwise, point)
        agreed += said is truth
    return Conditions(of.names, made, otherwise, agreed, tuple(withdrawn))


def _number(draw):
    """Often a small whole number, for the special cases; else any with two digits."""
    return sp.Rational(draw.choice([-1, 0, 1])) if draw.random() < 0.3 else sp.Rational(draw.randint(-200, 200), 100)


def _truth(text, options, point, direction):
    given = dict(options)
    given["at"] = {**(options["at"] or {}), **{name: Fraction(int(v.p), int(v.q)) for name, v in point.items()}}
    if direction is None:
        return verdict(text, **given).kind
    law: Law = growth_laws(text, np.asarray(direction, dtype=float), **given)[0].law
    return Kind.WELL_POSED if law.is_bounded else Kind.ILL_POSED
