"""Three dimensions: the frozen equations of a law on the whole sphere of directions, for many states at once.

With D' the deviator of D, ||D||^2 = D'_ij D'_ij/2, N = D'/||D|| (trace 0, N:N = 2), sigma = -p + Y N and
div u = 2 f ||D||, put e = xi/|xi|, q = N e, m = e.N e, s = |q|^2 and h^2 = s - m^2. Linearised, with k = |xi|::

    rho phi lam u = -k^2 V u + i k v dphi,    lam dphi = -i k phi e.u
    V = A q q' + (1/Gamma)(e - B q)(e - C q)' + t (1 + e e'/3 - q q'),    v = Y_phi q - (g/Gamma)(e - B q)

with the A, B, C, Gamma, t, g of two dimensions. e x q is an eigenvector of V, of eigenvalue t; the rest is a 2 x 2
problem on e and q, with the cubic of ``dispersion`` and, times Gamma::

    T     = Gamma [A s + t (7/3 - s)] + 1 - (B + C) m + BC s
    Delta = Gamma t [4t/3 + (A - t)(4s - m^2)/3] + t [(1 - Bm)(1 - Cm) + 4/3 BC h^2] + (A - t) h^2
    Sigma = (1 - Bm) g - Gamma m Y_phi
    N     = (g A - C Y_phi - t g) h^2 + t [(1 - Bm) g - Gamma m Y_phi]

m and s are linear in the squares of the components of e, so directions fill a triangle with the corners (N_i, N_i^2).
At fixed m all four are linear in s: T, Delta and N/Delta take their extremes on its sides, the planes of two principal
axes, where they are quadratics. So they are found without a scan.

The proof (section 1 of the paper anticipates it): let B = C, A > 0, Gamma > 0, t > 0. Then V is a sum of two squares
and of t (1 + e e'/3 - q q'); u'(1 + e e'/3)u - (q.u)^2 = 2 |E'|^2 - (N:E')^2 >= 0 by Cauchy-Schwarz, E' the deviator
of (e u' + u e')/2. If u'V u = 0 then q.u = 0 and e.u = B q.u = 0, so |u|^2 = 0. Hence V is positive definite in all
directions, two growth rates fall like -k^2, and the third tends to phi e.V^-1 v, which is bounded.

Without rates (A = 0, CSSM) a null vector needs E' along N and e.u = B q.u, so that e u' + u e', whose middle eigenvalue
is 0, is along N + 2B/3: it exists only if the middle eigenvalue of N is -2B/3. With B = C = f that is plane strain.
"""

from dataclasses import dataclass

import numpy as np

from primer.granular.dispersion import at, rightmost
from primer.granular.limits import Leading, quotient_maximum

#: Delta, T or N counts as zero below this, relative to its terms.
_ZERO = 1e-12
_SIDES = ((0, 1), (0, 2), (1, 2))  # pairs of axes: compressive, extensional, intermediate


@dataclass(frozen=True, eq=False)
class Sphere:
    """T, Delta, Sigma and N (each times Gamma) at directions with m = e.N e and s = |N e|^2."""

    T: np.ndarray
    Delta: np.ndarray
    Sigma: np.ndarray
    N: np.ndarray


def principal(lode):
    """The eigenvalues of N = D'/||D||: along the axis of compression, of extension, and between, shape (3,) + shape.

    (2/sqrt 3) (sin(lode - 2 pi/3), sin(lode + 2 pi/3), sin(lode)): 0 is (-1, 1, 0), pi/6 is compression along one axis,
    -pi/6 extension along one axis.
    """
    lode = np.asarray(lode, dtype=float)
    third = 2 * np.pi / 3
    return 2 / np.sqrt(3) * np.stack([np.sin(lode - third), np.sin(lode + third), np.sin(lode)])


def sphere(c, m, s):
    """The ``Sphere`` of ``Coefficients`` c, of the broadcast shape."""
    A, B, C, G, t, Y, g = c.A, c.B, c.C, c.Gamma, c.t, c.Y_phi, 2 * c.D * c.f_phi
    hh = s - m * m
    Sigma = (1 - B * m) * g - G * m * Y
    deviator = t * (4 * t / 3 + (A - t) * (4 * s - m * m) / 3)
    dilation = t * ((1 - B * m) * (1 - C * m) + 4 / 3 * B * C * hh)
    return Sphere(
        T=G * (A * s + t * (7 / 3 - s)) + 1 - (B + C) * m + B * C * s,
        Delta=G * deviator + dilation + (A - t) * hh,
        Sigma=Sigma,
        N=(g * A - C * Y - t * g) * hh + t * Sigma,
    )


def growth_rate(c, k, m, s):
    """The largest real part at wavenumber k in the directions (m, s), of the broadcast shape."""
    shear, q = -np.square(k) * c.t / c.density, sphere(c, m, s)
    if c.incompressible:
        with np.errstate(divide="ignore"):
            return np.maximum(shear, -np.square(k) / c.density * q.Delta / q.T)
    kk = np.square(k) / c.density
    rest = rightmost(c.Gamma, kk * q.T, kk**2 * q.Delta + np.square(k) / c.rho * q.Sigma, c.phi * kk**2 * q.N)
    return np.maximum(shear, rest)


def leading(c, lode):
    """The ``Leading`` behaviour in three dimensions; its x is the direction, unit vectors of shape (3,) + shape."""
    values = principal(np.broadcast_to(lode, np.broadcast_shapes(np.shape(c.A), np.shape(lode))))
    sides = [_side(c, values[i], values[j]) for i, j in _SIDES]
    exponent, coefficient, w, ill, limit, lost = (np.stack(column) for column in zip(*sides, strict=True))
    rank = np.where(lost, 0.5, np.where(ill, exponent, 0.0))  # what is lost might grow, slower than what is seen to
    best = rank + np.where(rank == rank.max(axis=0), 0, -np.inf)
    size = np.where(np.isnan(coefficient), -np.inf, coefficient)
    pick = np.lexsort((size, best), axis=0)[-1][None]

    def chosen(array):
        return np.take_along_axis(array, pick, 0)[0]

    unsure = chosen(lost)
    compressed = np.stack([1 - chosen(w), chosen(w)])
    e = np.zeros(values.shape)
    for number, (i, j) in enumerate(_SIDES):
        here = pick[0] == number
        e[i], e[j] = np.where(here, compressed[0], e[i]), np.where(here, compressed[1], e[j])
    return Leading(
        exponent=np.where(unsure, np.nan, chosen(exponent))[()],
        coefficient=np.where(unsure, np.nan, chosen(coefficient))[()],
        x=np.sqrt(e),
        ill_posed=(chosen(ill) & ~unsure)[()],
        limit=np.where(unsure, np.nan, chosen(limit))[()],
    )


def _side(c, a, b):
    """(exponent, coefficient, w, ill posed, limit, lost) over the directions e^2 = (1 - w, w) on two axes."""
    quad = [
        _quadratic(*(getattr(sphere(c, *_ms(a, b, w)), name) for w in (0.0, 0.5, 1.0))) for name in ("T", "Delta", "N")
    ]
    T, Delta, N = quad
    sign = np.where(c.Gamma == 0, 1.0, np.sign(c.Gamma))
    if c.incompressible:
        turned = np.minimum(at(T, 0.0), at(T, 1.0)) <= 0
        top, w = quotient_maximum([-v for v in Delta], T, 0.0)
        top = np.where(turned, np.inf, np.maximum(top, -c.t) / c.density)
        w = np.where(turned, np.where(at(T, 0.0) < at(T, 1.0), 0.0, 1.0), w)
        ill = top > 0
        limit = np.where(ill, np.inf, np.where(top < 0, -np.inf, 0.0))
        return 2.0 + 0 * top, top, w, ill, limit, np.zeros(ill.shape, bool)
    low, w0 = _least([sign * v for v in Delta])
    scale = c.t * (1 + np.abs(c.B)) * (1 + np.abs(c.C)) + np.abs(c.A) + np.abs(c.Gamma) * c.t * (c.t + np.abs(c.A))
    turned = np.minimum(sign * at(T, 0.0), sign * at(T, 1.0)) <= 0
    quadratic = turned | (low < -_ZERO * scale)
    touching = ~quadratic & (low <= _ZERO * scale)
    T0, N0, slope = at(T, w0), at(N, w0), N[1] + 2 * N[2] * w0
    size = np.abs(N[0]) + np.abs(N[1]) + np.abs(N[2])
    zero = np.abs(N0) <= 1e-9 * size  # w0 is the place of a minimum
    linear = touching & (sign * N0 < 0) & ~zero
    lost = touching & zero & (size > 0)
    drifting = lost & (w0 > 0) & (w0 < 1) & (np.abs(slope) > 1e-9 * size) & (sign * Delta[2] > 0)
    lost = (lost & ~drifting) | (touching & ~zero & (sign * N0 > 0))
    top, w2 = _eigenvalue(c, T, Delta)
    with np.errstate(divide="ignore", invalid="ignore"):
        limit, w3 = quotient_maximum([-c.phi * sign * v for v in N], [sign * v for v in Delta], 0.0)
        one = np.sqrt(-N0 / (c.rho * T0))
        third = np.cbrt(c.phi * slope**2 / (4 * c.rho * T0 * Delta[2]))
    cases = [quadratic, linear, drifting]
    ill = quadratic | linear | drifting
    return (
        np.select(cases, [2.0, 1.0, 2 / 3], 0.0),
        np.select(cases, [top, one, third], limit),
        np.select(cases, [w2, w0, w0], w3),
        ill,
        np.where(ill, np.inf, limit),
        lost,
    )


def _eigenvalue(c, T, Delta):
    """max over w of -Re of an eigenvalue of V/(rho phi), by refining a scan; inf where Gamma = 0 and T turns."""
    G = np.where(c.Gamma == 0, 1.0, c.Gamma)
    w = np.linspace(0, 1, 65).reshape(65, *[1] * np.ndim(T[0]))
    width = 1 / 64
    for _ in range(12):
        trace, det = at(T, w) / G, at(Delta, w) / G
        value = -trace / 2 + np.sqrt(np.maximum(trace**2 / 4 - det, 0))
        best = np.argmax(value, axis=0)[None]
        top, where = np.take_along_axis(value, best, 0)[0], np.take_along_axis(w + 0 * value, best, 0)[0]
        w = np.clip(where + width * np.linspace(-1, 1, 17).reshape(17, *[1] * np.ndim(where)), 0, 1)
        width /= 8
    return np.where(c.Gamma == 0, np.inf, top / c.density), where


def _ms(a, b, w):
    return a + w * (b - a), a * a + w * (b * b - a * a)


def _quadratic(left, middle, right):
    """The coefficients (1, w, w^2) of the quadratic through values at 0, 1/2 and 1."""
    bend = 2 * (left + right) - 4 * middle
    return left, right - left - bend, bend


def _least(poly):
    """The minimum of a quadratic over [0, 1] and where."""
    vertex = np.divide(-poly[1], 2 * poly[2], out=np.zeros(np.shape(poly[1])), where=poly[2] > 0)
    w = np.stack([np.clip(vertex, 0, 1), 0 * vertex, 1 + 0 * vertex])
    value = at(poly, w)
    best = np.argmin(value, axis=0)[None]
    return np.take_along_axis(value, best, 0)[0], np.take_along_axis(w, best, 0)[0]
