"""Conditions made shorter: numbers taken out of relations, parts dropped that others imply."""

from __future__ import annotations

import sympy as sp

_TURNED = {sp.Gt: sp.Lt, sp.Lt: sp.Gt, sp.Ge: sp.Le, sp.Le: sp.Ge}
_STRICT = (sp.Gt, sp.Lt)


def short(condition):
    """The condition with relations as x ? 0, x without a numeric factor; false where parts contradict each other."""
    condition = sp.sympify(condition)
    if isinstance(condition, sp.core.relational.Relational):
        return _normal(condition)
    if not isinstance(condition, (sp.And, sp.Or, sp.Not)):
        return condition
    parts = [short(part) for part in condition.args]
    whole = condition.func(*parts)
    if not isinstance(whole, sp.And):
        return whole
    relations = [part for part in whole.args if isinstance(part, sp.core.relational.Relational)]
    strict = [r for r in relations if isinstance(r, _STRICT)]
    if any(r.lhs == s.lhs and type(r) is not type(s) and not isinstance(s, sp.Ne) for r in strict for s in strict):
        return sp.false
    if any(isinstance(s, sp.Eq) and s.lhs == r.lhs for r in strict for s in relations):
        return sp.false
    known = {factor for r in strict for factor in _factors(r.lhs)}
    return sp.And(*(p for p in whole.args if not (isinstance(p, sp.Ne) and _factors(p.lhs) <= known)))


def _factors(expression):
    """Its irreducible factors but for their signs, those of a numerator and a denominator."""
    found = set()
    for part in sp.fraction(sp.together(expression)):
        found |= {max(f, sp.expand(-f), key=str) for f, _ in sp.factor_list(part)[1]}
    return found


def _normal(relation):
    x = sp.factor(relation.lhs - relation.rhs)
    number, x = x.as_coeff_Mul()
    kind = relation.func
    if number.is_negative:
        kind = _TURNED.get(kind, kind)
    x = sp.factor(x)
    if number.is_zero or x.is_number:
        return kind(number * x, 0)
    positive = [f for f in sp.Mul.make_args(x) if f.is_positive or (f.is_Pow and f.exp.is_even and f.exp < 0)]
    x = sp.Mul(*(f for f in sp.Mul.make_args(x) if f not in positive))  # a square below the line is > 0 where it is
    if x.could_extract_minus_sign():
        x, kind = sp.factor(-x), _TURNED.get(kind, kind)
    return kind(x, 0)


def joined(one, other):
    """The conditions A and x = 0, A and x != 0 as one, A; None if they are not such a pair, nor equal."""
    a, b = (set(c.args) if isinstance(c, sp.And) else {c} for c in (one, other))
    if a == b:
        return one
    if len(a - b) == len(b - a) == 1:
        (x,), (y,) = a - b, b - a
        if {type(x), type(y)} == {sp.Eq, sp.Ne} and x.lhs == y.lhs:
            return sp.And(*(a & b))
    return None
