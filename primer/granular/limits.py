"""What the growth rates do as |xi| -> infinity, in closed form, for many states at once."""

from dataclasses import dataclass, fields, replace

import numpy as np

from primer.granular.dispersion import Delta, at, dispersion
from primer.granular.fastest import fastest

#: A quantity that decides the case counts as zero below this, relative to its terms: rounding in Y, f and partials.
_ZERO = 1e-12


@dataclass(frozen=True, eq=False)
class Leading:
    """Re lambda ~ coefficient |xi|^exponent for the fastest branch over all directions, arrays of the states' shape.

    Attributes
    ----------
    exponent       2, 1, 2/3 or 0; nan where undecided
    coefficient    inf if the growth is unbounded already at finite |xi|
    x              cos 2 theta of the direction (its limit, where it drifts)
    ill_posed      whether limsup Re lambda = +infinity
    limit          limsup of the largest Re lambda: +inf if ill posed, -inf if every mode is damped without bound
    """

    exponent: np.ndarray
    coefficient: np.ndarray
    x: np.ndarray
    ill_posed: np.ndarray
    limit: np.ndarray


def leading(c, search=True):
    """The ``Leading`` behaviour of ``Coefficients`` c; without the search for it, no coefficient and x of |xi|^2.

    Divide the characteristic polynomial (see ``dispersion``) by Gamma, or by T where Gamma = 0:

    * T or Delta negative for some x: growth ~ |xi|^2.
    * Delta touching zero at x0, as in CSSM: growth |xi| sqrt(-N/(rho T)) if N(x0) < 0. If N(x0) = 0, |xi|^{2/3} times
      [phi N'^2/(4 rho T (t - A))]^{1/3}, at x - x0 ~ |xi|^{-2/3}. If N(x0) > 0, bounded.
    * otherwise bounded: lambda_3 -> -phi N/Delta.
    """
    return _incompressible(c) if c.incompressible else _compressible(c, search)


def quotient_maximum(n, d, low=-1.0, high=1.0):
    """The largest value of n(x)/d(x) on [low, high] and where, for quadratics as coefficient triples, d >= 0 there.

    (n/d)' = 0 is a quadratic equation: its roots and the two ends are compared.
    """
    q2, q1, q0 = n[2] * d[1] - n[1] * d[2], n[2] * d[0] - n[0] * d[2], n[1] * d[0] - n[0] * d[1]
    root = np.sqrt(np.maximum(q1 * q1 - q2 * q0, 0))
    outer = -q1 - np.where(q1 >= 0, root, -root)
    first = np.divide(outer, q2, out=np.zeros_like(outer), where=q2 != 0)
    second = np.divide(q0, outer, out=np.zeros_like(outer), where=outer != 0)
    x = np.stack([np.clip(v, low, high) for v in (first, second, low + 0 * outer, high + 0 * outer)])
    value = np.divide(at(n, x), at(d, x), out=np.full(x.shape, -np.inf), where=at(d, x) > 0)
    best = np.argmax(value, axis=0)[None]
    return np.take_along_axis(value, best, 0)[0], np.take_along_axis(x, best, 0)[0]


def _incompressible(c):
    n, T = c.A / c.t, np.tan(np.arcsin(np.clip(c.B, -1, 1)) / 2)
    coefficient = np.where(np.abs(c.B) < 1, c.t / c.density * ((1 - n) * T**2 - n), np.inf)
    ill = coefficient > 0
    limit = np.where(ill, np.inf, np.where(coefficient < 0, -np.inf, 0.0))
    x = np.where(np.abs(c.B) < 1, -T, -np.sign(c.B) / np.maximum(np.abs(c.B), 1))
    return Leading(*(v[()] for v in (np.full(np.shape(c.A), 2.0), coefficient, x, ill, limit)))


def _compressible(c, search):
    d = dispersion(c)
    T_low, T_high = d.T[0] - np.abs(d.T[1]), d.T[0] + np.abs(d.T[1])
    sign = np.where(c.Gamma == 0, np.sign(d.T[0]), np.sign(c.Gamma))
    least, x0 = least_Delta(c, sign)
    scale = c.t * (1 + np.abs(c.B)) * (1 + np.abs(c.C)) + np.abs(c.A)
    turned = np.minimum(sign * T_low, sign * T_high) <= 0
    quadratic = turned | (least < -(_ZERO**2) * scale)
    touching = ~quadratic & (least <= _ZERO**2 * scale)
    T0, N0, slope = at(d.T, x0), at(d.N, x0), d.N[1] + 2 * d.N[2] * x0
    size = np.abs(d.N[0]) + np.abs(d.N[1]) + np.abs(d.N[2])
    zero = np.abs(N0) <= _ZERO * size
    linear = touching & (sign * N0 < 0) & ~zero
    drifting = touching & zero & (size > 0)
    lost = drifting & ((np.abs(x0) == 1) | (np.abs(slope) <= _ZERO * size) | (c.t <= c.A))
    drifting &= ~lost
    bounded = ~(quadratic | linear | drifting | lost)

    fast, x2 = _quadratic(c, quadratic & search)
    fast = np.where((c.Gamma == 0) & turned, np.inf, fast)
    with np.errstate(divide="ignore", invalid="ignore"):
        limit, x3 = _bounded_limit(c, d, sign, touching, x0)
        one = np.sqrt(-N0 / (c.rho * T0))
        third = np.cbrt(c.phi * slope**2 / (4 * c.rho * T0 * (c.t - c.A)))
    cases = [quadratic, linear, drifting, lost]
    return Leading(
        exponent=np.select(cases, [2.0, 1.0, 2 / 3, np.nan], 0.0)[()],
        coefficient=np.select(cases, [fast, one, third, np.nan], limit)[()],
        x=np.select(cases, [x2, x0, x0, x0], x3)[()],
        ill_posed=(quadratic | linear | drifting)[()],
        limit=np.where(bounded, limit, np.where(lost, np.nan, np.inf))[()],
    )


def _quadratic(c, where):
    """(growth/|xi|^2, x) of the fastest direction in the states chosen: a search, so of no others (there nan)."""
    found = np.full((2, *np.shape(where)), np.nan)
    fast, x = found[0, ...], found[1, ...]
    if np.any(where):
        of = {f.name: np.broadcast_to(getattr(c, f.name), fast.shape)[where] for f in fields(c)[:-1]}
        zero = np.zeros_like(of["A"])
        fast[where], x[where] = fastest(replace(c, **of | {"Y_phi": zero, "f_phi": zero}), 1.0)
    return fast, x


def least_Delta(c, sign):
    """The minimum of sign Delta over x in [-1, 1], and where, with no cancellation where A and B - C are small."""
    m, h, bend = (c.B + c.C) / 2, (c.B - c.C) / 2, c.t - c.A
    safe = np.where(bend == 0, 1, bend)
    vertex = -c.t * m / safe
    inside = (sign * bend > 0) & (np.abs(vertex) <= 1)
    bottom = c.A * (1 + c.t * c.Gamma - c.t * m * m / safe) - c.t * h * h
    ends = np.array([-1.0, 1.0]).reshape(2, *[1] * np.ndim(c.A))
    values = sign * Delta(c, ends)
    low = np.argmin(values, axis=0)
    return np.where(inside, sign * bottom, values.min(axis=0)), np.where(inside, vertex, 2.0 * low - 1)


def _bounded_limit(c, d, sign, touching, x0):
    """limsup of the growth where it is finite, and the x that attains it."""
    limit, x = quotient_maximum([-c.phi * sign * v for v in d.N], [sign * v for v in _rounded(d, touching, x0)])
    T0, N0, S0 = at(d.T, x0), at(d.N, x0), at(d.Sigma, x0)
    square = c.phi * N0 / (c.density * T0)  # lambda = +-i k sqrt(square) + pair
    pair = (c.density * c.Gamma * square - c.phi * S0) / (2 * T0)
    none = (d.N[0] == 0) & (d.N[1] == 0) & (d.N[2] == 0)  # then lambda_3 = 0, and one real root instead of the pair
    pair = np.where(none, np.maximum(-c.phi * S0 / T0, 0), pair)
    better = touching & (pair > limit)
    return np.where(better, pair, limit), np.where(better, x0, x)


def _rounded(d, touching, x0):
    """Delta's coefficients, as an exact square where it touches zero."""
    square = d.Delta[2] * x0**2, -2 * d.Delta[2] * x0, d.Delta[2]
    return [np.where(touching, s, v) for s, v in zip(square, d.Delta, strict=True)]
