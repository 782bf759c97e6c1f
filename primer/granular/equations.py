"""The equations themselves, (12a-e), linearised by machine: a route to the pencil that shares nothing with (e26)."""

import numpy as np

from primer.granular.state import admit

# The order of derivatives that is maximal in each equation (row) for u_1, u_2, phi, p, psi (columns).
_MAXIMAL = ((2, 2, 1, 1, 1), (2, 2, 1, 1, 1), (1, 1, 1, 1, 1), (1, 1, 0, 0, 0), (1, 1, 0, 0, 0))


def motion(fields, Y, f, X, t, d, rho):
    """The left minus the right-hand sides of (12a-e), with g = 0, for sympy expressions.

    Parameters
    ----------
    fields           u_1, u_2, phi, p, psi as expressions in X = (x_1, x_2) and t
    Y, f             functions of (p, phi, I)
    d, rho           particle diameter and density
    """
    import sympy as sp

    u1, u2, phi, p, psi = fields
    d1, d2 = (lambda q, x=x: sp.diff(q, x) for x in X)

    def moving(q):
        return sp.diff(q, t) + u1 * d1(q) + u2 * d2(q)

    D = sp.sqrt((d1(u1) - d2(u2)) ** 2 + (d2(u1) + d1(u2)) ** 2) / 2
    I = 2 * d * D / sp.sqrt(p / rho)
    tau, cos, sin = Y(p, phi, I), sp.cos(2 * psi), sp.sin(2 * psi)
    return (
        rho * phi * moving(u1) + d1(p + tau * cos) + d2(tau * sin),
        rho * phi * moving(u2) + d1(tau * sin) + d2(p - tau * cos),
        moving(phi) + phi * (d1(u1) + d2(u2)),
        d1(u1) + d2(u2) - 2 * f(p, phi, I) * D,
        (d2(u1) + d1(u2)) * cos + (d2(u2) - d1(u1)) * sin,
    )


def derive(law, state, order="maximal"):
    """The pencil at a base state, by substituting base + small exponential into (12a-e) and differentiating.

    The base flow is the uniform one with this p, phi, I: psi = 0, u = (d_1 u_1 x_1, d_2 u_2 x_2) with the ||D|| and
    div u of the state. Y and f enter as their tangents, which is exact for a linearisation.

    Parameters
    ----------
    law, state        as in ``linearise``, a single state; incompressible laws lose phi here too
    order             "maximal" drops all but the highest derivatives, as the paper does; "full" keeps every term

    Returns
    -------
    primer.analysis.pencil.Pencil in two space variables
    """
    import sympy as sp

    from primer.analysis.pencil import Pencil

    if order not in ("maximal", "full"):
        raise ValueError(f'order must be "maximal" or "full", got {order!r}')
    if state.shape != ():
        raise ValueError(f"state must be a single state to make a pencil, got shape {state.shape}")
    admit(law, state)
    here = state.p, state.phi, state.I
    X, t, xi, lam, small = sp.symbols("x1 x2"), sp.Symbol("t"), sp.symbols("xi1 xi2"), sp.Symbol("lam"), sp.Symbol("h")
    shrink = -state.D + state.div_u(law) / 2, state.D + state.div_u(law) / 2
    base = float(shrink[0]) * X[0], float(shrink[1]) * X[1], state.phi, state.p, 0
    q = sp.symbols("q0:5")
    wave = sp.exp(sp.I * (xi[0] * X[0] + xi[1] * X[1]) + lam * t)
    fields = [b + small * amplitude * wave for b, amplitude in zip(base, q, strict=True)]
    Y, f = (_tangent(law, name, here) for name in ("Y", "f"))
    at_rest = {X[0]: 0, X[1]: 0, t: 0}
    rows = [
        sp.expand(sp.diff(e, small).subs(small, 0).subs(at_rest))
        for e in motion(fields, Y, f, X, t, state.d, state.rho)
    ]
    matrix = sp.Matrix([[sp.expand(row.coeff(unknown)) for unknown in q] for row in rows])
    E = matrix.applyfunc(lambda entry: entry.coeff(lam))
    S = matrix.applyfunc(lambda entry: entry.coeff(lam, 0))
    if order == "maximal":
        S = sp.Matrix(5, 5, lambda i, j: _of_degree(S[i, j], xi, _MAXIMAL[i][j]))
    keep = [0, 1, 3, 4] if getattr(law, "incompressible", False) else list(range(5))
    rows_kept = [0, 1, 3, 4] if len(keep) == 4 else list(range(5))
    numeric = sp.lambdify(xi, S.extract(rows_kept, keep), "numpy")
    return Pencil(lambda k: numeric(*k), np.array(E.extract(rows_kept, keep), dtype=complex).real, dim=2)


def _tangent(law, name, here):
    """The law's function as its tangent at a state, which takes sympy expressions."""
    value, *slopes = (float(getattr(law, name + partial)(*here)) for partial in ("", "_p", "_phi", "_I"))
    return lambda *now: value + sum(s * (n - h) for s, n, h in zip(slopes, now, here, strict=True))


def _of_degree(entry, xi, degree):
    import sympy as sp

    scale = sp.Symbol("s")
    return sp.expand(entry.subs({k: scale * k for k in xi}, simultaneous=True)).coeff(scale, degree)
