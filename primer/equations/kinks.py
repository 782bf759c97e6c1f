"""Slopes at a kink: where their formula divides by zero and the equation has one all the same, as |z| z at z = 0."""

from random import Random

import mpmath as mp
import sympy as sp

from primer.equations.error import PDEError
from primer.equations.text import split_name
from primer.equations.values import LARGEST_SLOPE, evaluated

# Difference quotients over these distances, in so many digits; what tends to zero like their p-th power, p > 0.04, is
# less than a millionth at the second of what it is at the first. Base values may differ by less than the third.
_FAR, _NEAR, _HERE, _DIGITS = 150, 300, 650, 800
_VANISHES, _AGREES, _NOTHING = mp.mpf("1e-6"), mp.mpf("1e-12"), mp.mpf("1e-200")


def slope_at(system, equation, place, values):
    """The slope of an equation by (unknown, power), a number, at a base state that gives all that it needs.

    Raises
    ------
    PDEError    where there is no slope
    """
    try:
        return evaluated(system.slopes[equation][place], values)
    except PDEError:
        found = slope_at_kink(system, equation, place, values)
        if found is None:
            raise
        return found


def slope_at_kink(system, equation, place, values):
    """The same where the formula divides by zero, or None where there is no slope.

    It is the limit of difference quotients, provided that the equation (continued, if it divides by zero itself) is
    differentiable there: in each of many directions the quotient must tend to the sum of the slopes along it. So |z| z
    and z^2/|z|^(1/2) have the slope 0 at z = 0, and |z| has none.
    """
    slopes = _gradient(system.sides[equation], system.unknowns, values)
    found = None if slopes is None else slopes[_name(*place)]
    return found if found is None or abs(found) <= LARGEST_SLOPE else None


def _name(unknown, power):
    letters = "".join(sorted(letter * n for letter, n in zip("txyz", power, strict=False)))
    return f"{unknown}_{letters}" if letters else unknown


def _gradient(F, unknowns, values):
    """{name: slope} of F by each unknown and derivative in it, or None where F is not differentiable."""
    names = sorted(symbol.name for symbol in F.free_symbols)
    moved = [name for name in names if split_name(name)[0] in unknowns]
    # What no slope contains is added to the rest, and any number will do for it.
    base = {name: values.get(name, sp.Rational(1, 3)) for name in names}
    if F.has(sp.I) or any(number.is_real is not True for number in base.values()):
        return None
    if all(power.exp.is_Integer for power in F.atoms(sp.Pow)):  # without a kink it is a pole, or a formula to rewrite
        return None
    steps = _steps(len(moved))
    try:
        with mp.workdps(_DIGITS):
            far, near, here = ([_beside(F, base, moved, step, k) for step in steps] for k in (_FAR, _NEAR, _HERE))
            if any(map(mp.im, [*far, *near, *here])):
                return None
            rise = max(abs(one - two) for one, two in zip(near, here, strict=True))
            if max(map(mp.re, here)) - min(map(mp.re, here)) > _VANISHES * rise:  # not even continuous
                return None
            quotients = (
                mp.matrix([(one - two) * mp.mpf(10) ** k for one, two in zip(values, here, strict=True)])
                for k, values in ((_FAR, far), (_NEAR, near))
            )
            return _fitted(moved, mp.matrix(steps), *quotients)
    except PDEError:
        return None


def _steps(size):
    """Directions in which no unknown stays what it is, since F may have no formula there; the same each time."""
    draw = Random(1)
    return [
        [draw.choice((-1, 1)) * mp.mpf(draw.randint(10, 99)) / 64 for _ in range(size)] for _ in range(3 * size + 8)
    ]


def _beside(F, base, moved, step, k):
    """F at 10^-k times the step from the base state."""
    shifts = (sp.Rational(int(part * 64), 64 * 10**k) for part in step)
    return evaluated(F, base | {name: base[name] + shift for name, shift in zip(moved, shifts, strict=True)})


def _fitted(names, steps, far, near):
    """{name: slope}, from the first directions; None unless it holds in the others too."""
    size, scale = len(names), max(map(abs, near))
    slopes = mp.matrix(size, 1)
    for j, (one, two) in enumerate(zip(*(mp.lu_solve(steps[:size, :], q[:size, :]) for q in (far, near)), strict=True)):
        if abs(two) > _VANISHES * abs(one) and abs(two) > _NOTHING * scale:
            if abs(two - one) > _AGREES * abs(two):
                return None
            slopes[j] = two
    told = steps * slopes
    for one, two, all_told in zip(far - told, near - told, told, strict=True):
        if abs(two) > max(_VANISHES * abs(one), _AGREES * abs(all_told), _NOTHING * scale):
            return None
    return dict(zip(names, slopes, strict=True))
