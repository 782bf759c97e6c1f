"""Well posed or ill posed: the verdict on a law at a base state."""

from dataclasses import dataclass, fields, replace

import numpy as np

from primer.granular.dispersion import at, dispersion, growth_rate
from primer.granular.fastest import fastest
from primer.granular.limits import leading
from primer.granular.linearisation import coefficients


@dataclass(frozen=True, eq=False)
class Verdict:
    kind: str
    exponent: float
    coefficient: float
    direction: np.ndarray
    bound: float
    unstable: bool
    reason: str


def verdict(law, state):
    """Whether the frozen equations of a law are linearly well posed at a base state, and how fast they grow if not.

    Returns
    -------
    Verdict, whose fields have the state's shape:
        kind           "well-posed", "ill-posed" or "undecided"
        exponent       Re lambda ~ coefficient |xi|^exponent for the fastest branch as |xi| -> infinity
        coefficient    inf if the growth is unbounded already at finite |xi| (an incompressible law with |B| >= 1)
        direction      unit vector(s) in the frame of the major compressive axis, of shape (2,) + shape
        bound          the supremum of the growth over all wavevectors, at least 0; inf if ill posed
        unstable       whether it is positive: bounded growth is instability, not ill-posedness
        reason         a sentence

    Raises
    ------
    ValueError    if the law does not admit the state
    """
    c = coefficients(law, state)
    lead = leading(c)
    bound = np.where(lead.ill_posed, np.inf, np.where(np.isnan(lead.limit), np.nan, np.maximum(lead.limit, 0)))
    bound = _with_long_waves(c, bound)
    kind = np.where(lead.ill_posed, "ill-posed", np.where(np.isnan(lead.exponent), "undecided", "well-posed"))
    theta = np.arccos(np.clip(lead.x, -1, 1)) / 2
    numbers = np.broadcast_arrays(kind, lead.exponent, lead.coefficient, lead.limit, bound, theta)
    reason = np.array([_reason(c.incompressible, *row) for row in zip(*(v.ravel() for v in numbers), strict=True)])
    return Verdict(
        kind=_scalar(kind, str),
        exponent=_scalar(lead.exponent, float),
        coefficient=_scalar(lead.coefficient, float),
        direction=np.stack([np.cos(theta), np.sin(theta)]),
        bound=_scalar(bound, float),
        unstable=_scalar(bound > 0, bool),
        reason=_scalar(reason.reshape(np.shape(kind)), str),
    )


def growth_limit(law, state):
    """The largest growth rate over all directions as |xi| -> infinity, in closed form, of the state's shape.

    lambda_3 -> -phi N(x)/Delta(x), see ``dispersion``, a quotient of quadratics in x = cos 2 theta. inf where the law
    is ill posed; -inf where every mode is damped without bound (a well-posed incompressible law).
    """
    return leading(coefficients(law, state)).limit


def largest_growth(law, state, k):
    """(growth, direction): the largest growth rate at |xi| = k over all directions, and a unit vector (2,) + shape."""
    rate, x = fastest(coefficients(law, state), k)
    theta = np.arccos(np.clip(x, -1, 1)) / 2
    return rate, np.stack([np.cos(theta), np.sin(theta)])


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


def _scalar(value, kind):
    return kind(value) if np.ndim(value) == 0 else value


def _reason(incompressible, kind, exponent, coefficient, limit, bound, theta):
    where = f"at {np.degrees(theta):.4g} degrees from the major compressive axis"
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
    state = "unstable but bounded" if bound > 0 else "damped"
    return f"the largest growth rate tends to {limit:.6g} as |xi| -> infinity, {where}: {state}"
