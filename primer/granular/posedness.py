"""Well posed or ill posed: the verdict on a law at a base state."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from primer.granular.dispersion import at, dispersion, growth_rate
from primer.granular.fastest import fastest
from primer.granular.limits import leading
from primer.granular.linearisation import coefficients
from primer.granular.state import BaseState
from primer.types import ArrayLike, Law, Numbers

if TYPE_CHECKING:
    from primer.analysis.verdict import Verdict


def verdict(law: Law, state: BaseState) -> Verdict:
    """Whether the frozen equations of a law are linearly well posed at a base state, and how fast they grow if not.

    Linearly well posed is eq. (wellp-first-formula).

    Returns
    -------
    primer.analysis.verdict.Verdict, with the fields it has there for a single state. For an array of states the fields
    are arrays of the states' shape (direction: (2,) + shape). direction is in the frame of the major compressive axis;
    coefficient is inf if the growth is unbounded already at finite |xi| (an incompressible law with |B| >= 1).
    ``unstable`` is said of the frozen equations: something grows. They do not say whether the sheared flow itself,
    which is not uniform, is unstable.

    Raises
    ------
    ValueError    if the law does not admit the state
    """
    from primer.analysis.verdict import Kind, Verdict

    c = coefficients(law, state)
    lead = leading(c)
    bound = np.where(lead.ill_posed, np.inf, np.where(np.isnan(lead.limit), np.nan, np.maximum(lead.limit, 0)))
    bound = _with_long_waves(c, bound)
    kind: Any = np.where(
        lead.ill_posed, Kind.ILL_POSED, np.where(np.isnan(lead.exponent), Kind.UNDECIDED, Kind.WELL_POSED)
    )
    rows = zip(*(np.ravel(v) for v in (kind, lead.exponent, lead.coefficient, lead.limit, bound, lead.x)), strict=True)
    reason: Any = np.array([_reason(c.incompressible, *row) for row in rows], dtype=object).reshape(kind.shape)
    direction = _direction(lead.x)
    if kind.ndim:
        return Verdict(kind, lead.exponent, lead.coefficient, direction, bound, bound > 0, reason)
    exponent = float(lead.exponent)
    return Verdict(
        kind=Kind(str(kind)),
        exponent=exponent if math.isnan(exponent) else Fraction(exponent).limit_denominator(3),
        coefficient=float(lead.coefficient),
        direction=tuple(direction.tolist()),
        bound=float(bound),
        unstable=bool(bound > 0),
        reason=reason[()],
    )


def growth_limit(law: Law, state: BaseState) -> Numbers:
    """The largest growth rate over all directions as |xi| -> infinity, in closed form, of the state's shape.

    lambda_3 -> -phi N(x)/Delta(x), see ``dispersion``, a quotient of quadratics in x = cos 2 theta. inf where the law
    is ill posed; -inf where every mode is damped without bound (a well-posed incompressible law).

    Section 4: the limit of the third growth rate, see (wellp-first-formula).

    >>> from primer import CIDR, BaseState
    >>> from primer.granular import EXAMPLE_COMPACTION, GLASS_BEADS
    >>> law = CIDR(GLASS_BEADS.friction, EXAMPLE_COMPACTION)
    >>> print(f"{growth_limit(law, BaseState(p=0.2, phi=0.55, I=0.1)):.6f}")  # something grows, yet it is well posed
    1.000070
    """
    return leading(coefficients(law, state), search=False).limit


def largest_growth(law: Law, state: BaseState, k: ArrayLike) -> tuple[Numbers, np.ndarray]:
    """(growth, direction): the largest growth rate at |xi| = k over all directions, and a unit vector (2,) + shape.

    The growth rates are those of eq. (e24).
    """
    rate, x = fastest(coefficients(law, state), k)
    return rate, _direction(x)


def _direction(x):
    """(cos theta, sin theta) from x = cos 2 theta, 0 <= theta <= 90 degrees."""
    return np.stack([np.sqrt((1 + x) / 2), np.sqrt((1 - x) / 2)])


def _with_long_waves(c, bound):
    """The bound, raised where the growth at some finite |xi| exceeds its limit as |xi| -> infinity."""
    bound = np.array(bound, dtype=float)
    if c.incompressible or not np.isfinite(bound).any():
        return bound
    viscous = np.sqrt(np.abs(c.D * c.density * c.Gamma / at(dispersion(c).T, 0.0)))
    angles = np.cos(np.linspace(0, np.pi, 9)).reshape(9, *[1] * np.ndim(viscous))
    scale = np.maximum(bound, 1e-9 * c.D)
    powers = 10.0 ** np.arange(-4.0, 5)
    peaks = np.array([growth_rate(c, viscous * s, angles).max(axis=0) for s in powers])
    over = np.isfinite(bound) & (peaks.max(axis=0) > bound + 1e-6 * scale)
    for index in np.argwhere(over):
        one = _pick(c, tuple(index))
        centre = viscous[tuple(index)] * powers[np.argmax(peaks[(slice(None), *index)])]
        width = 0.5
        for _ in range(12):
            trial = centre * 10 ** np.linspace(-width, width, 9)
            rate = fastest(one, trial)[0]
            centre, width = trial[np.argmax(rate)], width / 3
        bound[tuple(index)] = max(bound[tuple(index)], rate.max())
    return bound


def _pick(c, index):
    """One state of an array of coefficients."""
    return replace(c, **{f.name: getattr(c, f.name)[index] for f in fields(c) if f.name != "incompressible"})


def _reason(incompressible, kind, exponent, coefficient, limit, bound, x):
    where = f"at {np.degrees(np.arccos(x)) / 2:.4g} degrees from the major compressive axis"
    if kind == "undecided":
        return "the leading terms vanish together at a knife edge: the orders kept here do not decide"
    if coefficient == np.inf:
        return f"the growth is unbounded already at finite |xi|, {where}, because the pressure cannot keep div u = 0"
    if kind == "ill-posed":
        power = {2.0: "|xi|^2", 1.0: "|xi|", 2 / 3: "|xi|^(2/3)"}[exponent]
        drift = ", a direction it drifts to" if exponent == 2 / 3 else ""
        return f"the growth rate rises like {coefficient:.6g} {power} {where}{drift}"
    if incompressible:
        return "every direction is damped, or neutral, as |xi| -> infinity"
    state = "growth, but bounded" if bound > 0 else "damped"
    return f"the largest growth rate tends to {limit:.6g} as |xi| -> infinity, {where}: {state}"
