"""Well posed or ill posed: the verdict on a law at a base state."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from primer.checks import integer, real_array, shown
from primer.granular import space
from primer.granular.dispersion import at, dispersion, growth_rate
from primer.granular.fastest import fastest
from primer.granular.limits import leading
from primer.granular.linearisation import coefficients
from primer.granular.state import BaseState
from primer.types import ArrayLike, Law, Numbers

if TYPE_CHECKING:
    from primer.analysis.verdict import Verdict


def verdict(law: Law, state: BaseState, dim: int = 2, lode: ArrayLike = 0.0) -> Verdict:
    """Whether the frozen equations of a law are linearly well posed at a base state, and how fast they grow if not.

    Linearly well posed is eq. (wellp-first-formula).

    Parameters
    ----------
    dim     2, or 3: over all directions of the sphere, of which ``primer.granular.space`` gives the mathematics
    lode    the Lode angle of D in radians, -pi/6 <= lode <= pi/6, a number or an array that broadcasts against the
            states. The eigenvalues of N = D'/||D||, D' the deviator of D and N:N = 2, are (2/sqrt 3) times
            sin(lode - 2 pi/3), sin(lode + 2 pi/3) and sin(lode), in this order along the axes 1 (compression),
            2 (extension) and 3. 0, where they are (-1, 1, 0), is plane strain if div u = 0; plane strain with
            div u = 2 f ||D|| has sin(lode) = -f/sqrt 3. pi/6 is compression along one axis, -pi/6 extension.

    In the plane of 1 and 2 the third axis carries stress as well, and D' loses a third of div u, not a half: the two
    verdicts may differ. Incompressible laws at lode = 0 have the same; CSSM is ill posed in three dimensions only in
    plane strain, so where it dilates not at lode = 0.

    Returns
    -------
    primer.analysis.verdict.Verdict, with the fields it has there for a single state. For an array of states the fields
    are arrays of the states' shape (direction: (dim,) + shape). direction is in the frame of the compressive
    axis; coefficient is inf if the growth is unbounded already at finite |xi| (an incompressible law with |B| >= 1).
    ``unstable`` is said of the frozen equations: something grows. They do not say whether the sheared flow itself,
    which is not uniform, is unstable. With dim=3 a bound at finite |xi| is the largest of a scan.

    Raises
    ------
    ValueError    if the law does not admit the state, dim is not 2 or 3, or lode is out of its range or not for dim
    """
    from primer.analysis.verdict import Kind, Verdict

    c, angle = _frozen(law, state, dim, lode)
    lead = leading(c) if angle is None else space.leading(c, angle)
    bound = np.where(lead.ill_posed, np.inf, np.where(np.isnan(lead.limit), np.nan, np.maximum(lead.limit, 0)))
    bound = _with_long_waves(c, bound) if angle is None else _with_long_waves_in_space(c, bound, angle)
    kind: Any = np.where(
        lead.ill_posed, Kind.ILL_POSED, np.where(np.isnan(lead.exponent), Kind.UNDECIDED, Kind.WELL_POSED)
    )
    direction = _direction(lead.x) if angle is None else lead.x
    first = direction[0]
    rows = zip(*(np.ravel(v) for v in (kind, lead.exponent, lead.coefficient, lead.limit, bound, first)), strict=True)
    reason: Any = np.array([_reason(c.incompressible, *row) for row in rows], dtype=object).reshape(kind.shape)
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


def growth_limit(law: Law, state: BaseState, dim: int = 2, lode: ArrayLike = 0.0) -> Numbers:
    """The largest growth rate over all directions as |xi| -> infinity, in closed form, of the state's shape.

    lambda_3 -> -phi N(x)/Delta(x), see ``dispersion``, a quotient of quadratics in x = cos 2 theta. inf where the law
    is ill posed; -inf where every mode is damped without bound (a well-posed incompressible law). With dim=3 over the
    directions of the sphere, at the Lode angle ``lode`` (see ``verdict``).

    Section 4: the limit of the third growth rate, see (wellp-first-formula).

    >>> from primer import CIDR, BaseState
    >>> from primer.granular import EXAMPLE_COMPACTION, GLASS_BEADS
    >>> law = CIDR(GLASS_BEADS.friction, EXAMPLE_COMPACTION)
    >>> print(f"{growth_limit(law, BaseState(p=0.2, phi=0.55, I=0.1)):.6f}")  # something grows, yet it is well posed
    1.000070
    """
    c, angle = _frozen(law, state, dim, lode)
    return leading(c, search=False).limit if angle is None else space.leading(c, angle).limit


def largest_growth(law: Law, state: BaseState, k: ArrayLike) -> tuple[Numbers, np.ndarray]:
    """(growth, direction): the largest growth rate at |xi| = k over all directions, and a unit vector (2,) + shape.

    The growth rates are those of eq. (e24).
    """
    rate, x = fastest(coefficients(law, state), k)
    return rate, _direction(x)


def _frozen(law, state, dim, lode):
    """(coefficients, None), or in three dimensions (coefficients, lode), of one shape."""
    dim, angle = integer("dim", dim, least=2, most=3), real_array("lode", lode)
    if (np.abs(angle) > np.pi / 6 + 1e-12).any():
        raise ValueError(f"lode must be an angle between -pi/6 and pi/6 in radians, got {shown(lode)}")
    if dim == 2:
        if angle.any():
            raise ValueError(
                f"lode must be left out where dim is 2: it is a matter of three dimensions, got {shown(lode)}"
            )
        return coefficients(law, state), None
    c = coefficients(law, state)
    try:
        shape = np.broadcast_shapes(angle.shape, np.shape(c.A))
    except ValueError:
        raise ValueError(f"lode must broadcast against the states' shape {np.shape(c.A)}, got {angle.shape}") from None
    names = [f.name for f in fields(c) if f.name != "incompressible"]
    spread: dict[str, Any] = {name: np.broadcast_to(getattr(c, name), shape) for name in names}
    return replace(c, **spread), np.broadcast_to(angle, shape)


def _with_long_waves_in_space(c, bound, lode):
    """The bound, raised to the largest growth in a scan of |xi| and of directions where that exceeds it."""
    bound = np.array(bound, dtype=float)
    if c.incompressible or not np.isfinite(bound).any():
        return bound
    steps = np.linspace(0, 1, 7)
    weights = np.array([(a, b, 1 - a - b) for a in steps for b in steps if a + b <= 1 + 1e-9]).clip(0, 1)
    N = space.principal(lode)
    m, s = np.tensordot(weights, N, 1), np.tensordot(weights, N * N, 1)
    viscous = np.sqrt(np.abs(c.D * c.density / (c.t + c.A + 1 / np.abs(c.Gamma))))
    peak = np.full(bound.shape, -np.inf)
    for power in 10.0 ** np.linspace(-4, 4, 33):
        peak = np.maximum(peak, space.growth_rate(c, viscous * power, m, s).max(axis=0))
    over = np.isfinite(bound) & (peak > bound + 1e-6 * np.maximum(bound, 1e-9 * c.D))
    return np.where(over, peak, bound)


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


def _reason(incompressible, kind, exponent, coefficient, limit, bound, first):
    where = f"at {np.degrees(np.arccos(min(first, 1.0))):.4g} degrees from the major compressive axis"
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
