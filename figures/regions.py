"""Six boundaries that the literature has by hand, each drawn over the region that was computed.

The toy system of (toy-pde); two-layer shallow water, u_1 - u_2 = 2 sqrt(g h (1 -+ sqrt r)) for equal layers; the
two-fluid model with one pressure, well posed (weakly) at equal velocities alone; a van der Waals fluid, its spinodal
4 T v^3 = (3 v - 1)^2; the abcd-Boussinesq system, a c = 0; and the firehose, p_parallel - p_perp = B^2.
"""

import numpy as np
from sidecar import close

from primer import region
from primer.view.region import draw_region
from primer.view.style import new_figure

TOY = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"
LAYERS = "h_t + (h*u)_x = 0; e_t + (e*v)_x = 0; u_t + u*u_x + (h + e)_x = 0; v_t + v*v_x + (r*h + e)_x = 0"
TWO_FLUIDS = "a_t + (a*u)_x = 0; -a_t + ((1 - a)*v)_x = 0; u_t + u*u_x = -p_x; 2*(v_t + v*v_x) = -p_x"
VAN_DER_WAALS = "v_t = u_x; u_t = -(8*T/(3*v - 1) - 3/v^2)_x"
BOUSSINESQ = "n_t + w_x + a*w_xxx - n_xxt/10 = 0; w_t + n_x + c*n_xxx - w_xxt/5 = 0"
FIREHOSE = "v_t = (B - P/B)*b_x; b_t = B*v_x"
# title, text, what is varied, the rest, and what vanishes on the boundary
CASES = (
    ("toy: u = 0", TOY, {"u": (-2, 2), "eps": (0.001, 0.1)}, {"at": {"v_xx": 0.3}}, lambda u, eps: u),
    (
        "two layers: critical shear",
        LAYERS,
        {"u": (0, 3), "r": (0.05, 0.95)},
        {"at": {"h": 1, "e": 1, "v": 0}, "uniform": True, "n": 40},
        lambda u, r: np.minimum(abs(u - 2 * np.sqrt(1 - np.sqrt(r))), abs(u - 2 * np.sqrt(1 + np.sqrt(r)))),
    ),
    (
        "two fluids: equal velocities",
        TWO_FLUIDS,
        {"u": (-1, 1.1)},
        {"at": {"a": 0.3, "v": 0.2}, "uniform": True, "n": 60},
        lambda u: u - 0.2,
    ),
    (
        "van der Waals: spinodal",
        VAN_DER_WAALS,
        {"v": (0.45, 3), "T": (0.6, 1.1)},
        {"uniform": True},
        lambda v, T: (3 * v - 1) ** 2 / (4 * v**3) - T,
    ),
    ("abcd-Boussinesq: a c = 0", BOUSSINESQ, {"a": (-1, 1.1), "c": (-1, 1.1)}, {"n": 40}, lambda a, c: a * c),
    ("firehose", FIREHOSE, {"B": (0.05, 1), "P": (0, 1)}, {}, lambda B, P: B**2 - P),
)


def compute():
    return [region(text, vary, **{"n": 80, "progress": False} | given) for _, text, vary, given, _ in CASES]


def numbers(found):
    out = {}
    for (title, *_, closed), one in zip(CASES, found, strict=True):
        places = one.boundaries.reshape(-1, len(one.names)).T
        off = float(np.abs(closed(*places)).max())
        out[f"{title}, off by"] = close(off, atol=1e-8, why="closed form, at every boundary that was bisected")
        share = float((one.kind == "ill-posed").mean())
        out[f"{title}, share of ill posed"] = close(share, atol=1e-3, why="of the points of the grid")
    return out


def draw(found):
    figure, axes = new_figure(
        rows=2, columns=3, width=11, height=6.4, title="Where equations are ill posed: computed, under closed forms"
    )
    handles = {}
    for ax, (title, *_, closed), one in zip(axes.flat, CASES, found, strict=True):
        handles |= {handle.get_label(): handle for handle in draw_region(ax, one)}
        if len(one.names) == 2:
            x, y = (np.linspace(axis[0], axis[-1], 400) for axis in one.axes)
            z = closed(*np.meshgrid(x, y))
            if (z >= 0).all():  # a distance
                for sign in (-1, 1):
                    inside = 2 * np.sqrt(1 + sign * np.sqrt(y))
                    ax.plot(inside, y, color="#0072B2", lw=1.4, ls="--")
                ax.set_xlim(x[0], x[-1])
            else:
                ax.contour(x, y, z, levels=[0], colors="#0072B2", linewidths=1.4, linestyles="--")
        ax.set_title(title)
    figure.legend(handles=list(handles.values()), loc="outside lower center", ncols=4)
    return figure
