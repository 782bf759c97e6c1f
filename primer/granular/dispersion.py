"""Growth rates in closed form: the characteristic polynomial of the frozen equations in |xi| and x = cos 2 theta.

With k = |xi| and x = (xi_1^2 - xi_2^2)/k^2 in [-1, 1], det(lambda E + S) = 0 is, for every law::

    Gamma lam^3 + (k^2/R) T lam^2 + [(k^4/R^2) Delta + (k^2/rho) Sigma] lam + (phi k^4/R^2) N = 0,    R = rho phi

    T     = Gamma (A + t) + 1 + BC + (B + C) x                                    [tr(M + N) Gamma/k^2]
    Delta = t (x + B)(x + C) + A (1 - x^2) + A t Gamma                            [det(M + N) Gamma/k^4]
    Sigma = Gamma Y_phi x + g (1 + B x),     g = 2 ||D|| f_phi                    [xi.V Gamma/k^2]
    N     = (g A - C Y_phi)(1 - x^2) + t x [Gamma Y_phi + g (x + B)]              [xi.adj(M + N) V Gamma/k^4]

This is a second route to the growth rates: no matrix is formed, and no digit of the small root is lost at large k.
"""

from dataclasses import dataclass

import numpy as np

from primer.checks import real_array


@dataclass(frozen=True, eq=False)
class Dispersion:
    """The four polynomials in x, as tuples of coefficients (constant, x, x^2), each of the shape of the states."""

    T: tuple
    Delta: tuple
    Sigma: tuple
    N: tuple


def dispersion(c):
    """The ``Dispersion`` of ``Coefficients`` c."""
    A, B, C, G, t, Y = c.A, c.B, c.C, c.Gamma, c.t, c.Y_phi
    g = 2 * c.D * c.f_phi
    side = g * A - C * Y
    return Dispersion(
        T=(G * (A + t) + 1 + B * C, B + C, 0 * A),
        Delta=(t * B * C + A * (1 + t * G), t * (B + C), t - A),
        Sigma=(g, G * Y + g * B, 0 * A),
        N=(side, t * (G * Y + g * B), t * g - side),
    )


def at(poly, x):
    """A polynomial of ``Dispersion`` at x."""
    return poly[0] + x * (poly[1] + x * poly[2])


def Delta(c, x):
    """Delta at x, summed so that it does not cancel near x = -B, where CSSM has its zero."""
    return c.t * (x + c.B) * (x + c.C) + c.A * ((1 - x) * (1 + x) + c.t * c.Gamma)


def cubic(c, k, x):
    """The coefficients (c3, c2, c1, c0) of the polynomial in lambda, real, of the broadcast shape."""
    d, k2 = dispersion(c), np.square(real_array("k", k))
    c2 = k2 / c.density * at(d.T, x)
    c1 = (k2 / c.density) ** 2 * Delta(c, x) + k2 / c.rho * at(d.Sigma, x)
    c0 = c.phi * (k2 / c.density) ** 2 * at(d.N, x)
    return c.Gamma, c2, c1, c0


def growth_rate(c, k, x):
    """The largest real part of the growth rates at wavenumber k > 0 and x = cos 2 theta, of the broadcast shape.

    Incompressible laws have a single one, -(k^2/R) Delta/T.
    """
    d = dispersion(c)
    if c.incompressible:
        with np.errstate(divide="ignore"):
            return -np.square(k) / c.density * Delta(c, x) / at(d.T, x)
    return rightmost(*cubic(c, k, x))


def growth_rates(c, k, x):
    """All growth rates: complex, of the broadcast shape + (3,) or, incompressible, + (1,); rightmost first."""
    if c.incompressible:
        return growth_rate(c, k, x)[..., None] + 0j
    r, b, q = split(*cubic(c, k, x))
    root = np.sqrt(b * b / 4 - q + 0j)
    far = -b / 2 - np.where(b >= 0, root, -root)  # the one without cancellation
    near = np.divide(q, far, out=np.zeros_like(far), where=far != 0)
    lam = np.stack([r + 0j, far, np.where(root.imag != 0, far.conj(), near)], axis=-1)
    return np.take_along_axis(lam, np.argsort(-lam.real, axis=-1, kind="stable"), axis=-1)


def rightmost(c3, c2, c1, c0):
    """The largest real part of the roots of c3 lam^3 + c2 lam^2 + c1 lam + c0, real coefficients."""
    r, b, q = split(c3, c2, c1, c0)
    disc = b * b / 4 - q
    root = np.sqrt(np.maximum(disc, 0))
    total = np.abs(b) / 2 + root
    near = np.divide(-q, total, out=np.zeros_like(q), where=total != 0)
    return np.maximum(r, np.where(disc < 0, -b / 2, np.where(b > 0, near, -b / 2 + root)))


def split(c3, c2, c1, c0):
    """A real root r and the quadratic lam^2 + b lam + q of the other two roots, each to full relative accuracy.

    r = -inf where c3 = 0. The root found first is the outermost of three real ones, or the only real one; it is divided
    out from the end at which the division does not cancel.
    """
    c3, c2, c1, c0 = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (c3, c2, c1, c0)))
    lead = np.where(c3 == 0, np.where(c2 == 0, 1, c2), c3)
    c2, c1, c0 = c2 / lead, c1 / lead, c0 / lead
    shape = c2.shape
    r = _real_root(*(np.atleast_1d(v) for v in (c2, c1, c0))).reshape(shape)
    outer = np.abs(r) ** 3 >= np.abs(c0)
    safe = np.where(r == 0, 1, r)
    q = np.where(outer, np.where(r == 0, c1, -c0 / safe), c1 + (c2 + r) * r)
    b = np.where(outer & (r != 0), (q - c1) / safe, c2 + r)
    flat = c3 == 0
    return np.where(flat, -np.inf, r)[()], np.where(flat, c1, b)[()], np.where(flat, c0, q)[()]


def _real_root(c2, c1, c0):
    """A real root of lam^3 + c2 lam^2 + c1 lam + c0 by Viete's or Cardano's formula; Newton's method if it cancels."""
    Q, P = c2 * c2 / 9 - c1 / 3, c2 * (c2 * c2 / 27 - c1 / 6) + c0 / 2
    cube, size = Q * Q * Q, np.abs(P)
    only = cube <= P * P
    root = np.sqrt(np.where(only, 1, Q))
    y = 2 * root * np.cos(np.arccos(np.minimum(size / (root * root * root), 1)) / 3)
    if only.any():
        pair = np.cbrt(size[only] + np.sqrt(P[only] ** 2 - cube[only]))
        y[only] = pair + np.divide(Q[only], pair, out=np.zeros_like(pair), where=pair != 0)
    r = np.copysign(y, -P) - c2 / 3
    small = only | (np.abs(r) < y)
    if small.any():
        r[small] = _newton(r[small], c2[small], c1[small], c0[small])
    return r


def _newton(r, c2, c1, c0):
    for _ in range(4):
        slope = (3 * r + 2 * c2) * r + c1
        value = ((r + c2) * r + c1) * r + c0
        r = r - np.divide(value, slope, out=np.zeros_like(r), where=slope != 0)
    return r
