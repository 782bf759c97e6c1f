"""The equations of motion (12a-e) as text, linearised by machine: a second route to the pencil, apart from (e26)."""

from dataclasses import replace
from typing import Any

from primer.checks import shown
from primer.granular.state import admit

_I = "d*sqrt(((u_x - v_y)^2 + (u_y + v_x)^2)*rho/p)"  # 2 d ||D||/sqrt(p/rho), (dfn-I)
_Y = f"(Y + Y_p*(p - p_0) + Y_phi*(phi - phi_0) + Y_I*({_I} - I_0))"
_f = f"(f + f_p*(p - p_0) + f_phi*(phi - phi_0) + f_I*({_I} - I_0))"

#: (12a) to (12e) with g = 0, u = u_1, v = u_2, x = x_1, y = x_2; Y and f as their tangents at the base state.
EQUATIONS = (
    f"(u_t + u*u_x + v*u_y)*rho*phi + p_x + ({_Y}*cos(2*psi))_x + {_Y}_y*sin(2*psi) + 2*{_Y}*cos(2*psi)*psi_y = 0",
    f"(v_t + u*v_x + v*v_y)*rho*phi + p_y + ({_Y}*sin(2*psi))_x - {_Y}_y*cos(2*psi) + 2*{_Y}*sin(2*psi)*psi_y = 0",
    "phi_t + u*phi_x + v*phi_y + phi*(u_x + v_y) = 0",
    f"u_x + v_y = {_f}*sqrt((u_x - v_y)^2 + (u_y + v_x)^2)",
    "(u_y + v_x)*cos(2*psi) + (v_y - u_x)*sin(2*psi) = 0",
)

# The space derivatives kept by the paper, Table 1: of u_1, u_2, phi, p, psi (columns) in each equation (rows). Beside
# d_t* it drops what is of order zero, u.grad u* and phi div u*.
_ORDER = ((2, 2, 1, 1, 1), (2, 2, 1, 1, 1), (1, 1, 1, 1, 1), (1, 1, 0, 0, 0), (1, 1, 0, 0, 0))


def derive(law, state, order="maximal"):
    """The pencil of a law at a base state, by the general route from the text of its equations.

    The base flow is uniform, with psi = 0 and the d_1 u_1, d_2 u_2 that give the state its ||D|| and div u.

    Parameters
    ----------
    law, state    as in ``linearise``, a single state; for an incompressible law phi is a parameter
    order         "maximal" drops all but the highest derivatives, as the paper does; "full" keeps every term

    Returns
    -------
    primer.analysis.pencil.Pencil in two space variables, of the unknowns (u_1, u_2, phi, p, psi)
    """
    from primer.analysis.symbolic import symbol

    if order not in ("maximal", "full"):
        raise ValueError(f"order must be 'maximal' or 'full', got {shown(order)}")
    admit(law, state)
    if state.shape != ():
        raise ValueError(f"state must be a single state to make a pencil, got shape {state.shape}")
    incompressible = getattr(law, "incompressible", False)
    kept = [j for j in range(5) if not (incompressible and j == 2)]
    here = state.p, state.phi, state.I
    names = [name + partial for name in ("Y", "f") for partial in ("", "_p", "_phi", "_I")]
    numbers: dict[str, Any] = {name: float(getattr(law, name)(*here)) for name in names}
    numbers |= {"p_0": state.p, "phi_0": state.phi, "I_0": state.I, "d": state.d, "rho": state.rho}
    shear, spread = float(state.D), float(state.div_u(law)) / 2
    fields = [name for name in ("u", "v", "phi", "p", "psi") if not (incompressible and name == "phi")]
    at = {f"{name}_{letters}": 0.0 for name in fields for letters in ("x", "y", "t", "xx", "xy", "yy")}
    at |= {"u": 0.0, "v": 0.0, "phi": state.phi, "p": state.p, "psi": 0.0, "u_x": spread - shear, "v_y": spread + shear}
    full = symbol("\n".join(EQUATIONS[j] for j in kept), at=at, order="full", **numbers)
    if order == "full":
        return full.pencil()
    entries = tuple(
        tuple(_of_order(entry, _ORDER[r][c]) for entry, c in zip(row, kept, strict=True))
        for row, r in zip(full.entries, kept, strict=True)
    )
    return replace(full, entries=entries).pencil()


def _of_order(entry, order):
    """The time derivatives, and the space derivatives of this order."""
    return {(n, a, b): value for (n, a, b), value in entry.items() if n or a + b == order}
