"""The paper's own pictures: stress axes, C(phi) and yield loci, the base flow, and the erratum in (42b)."""

import numpy as np
from matplotlib.patches import Polygon

from primer.granular.dispersion import growth_rates
from primer.granular.proof import bad_directions, chi, chi_as_printed, det_MN, lambda_3
from primer.view.style import ILL, STEADY, U, V, legend_below

GREEN = "#009E73"


def draw_stress_axes(ax, angle=0.35):
    """Figure 1a: the principal axes of a stress, -(p + ||tau||) along the major and -(p - ||tau||) along the minor."""
    _square(ax, np.eye(2), angle)
    for axis, length, name in ((0, 1.0, "major"), (1, 0.55, "minor")):
        direction = _turn(angle)[:, axis]
        for sign in (-1, 1):
            tip, tail = 0.78 * sign * direction, (0.78 + length) * sign * direction
            ax.annotate("", tip, tail, arrowprops={"arrowstyle": "-|>", "color": U if axis == 0 else V, "lw": 2})
        label = rf"{name} axis" + "\n" + rf"$-(p {'+' if axis == 0 else '-'} \|\tau\|)$"
        x, y = (0.82 + length) * direction
        ax.annotate(
            label, (x, y), ha="left" if axis == 0 else "center", va="center" if axis == 0 else "bottom", fontsize=9
        )
    _bare(ax, 1.9)


def draw_deformation(ax, angle=0.35, shortening=0.28, lengthening=0.22):
    """Figure 1b: a deformation that fits: the square shortens along the major axis and expands along the minor one."""
    _square(ax, np.eye(2), angle, ls="--", facecolor="none")
    _square(ax, np.diag([1 - shortening, 1 + lengthening]), angle)
    turn = _turn(angle)
    for axis, sign_out, colour in ((0, -1, U), (1, 1, V)):
        for sign in (-1, 1):
            near, far = 0.85 * sign * turn[:, axis], 1.35 * sign * turn[:, axis]
            start, end = (far, near) if sign_out < 0 else (near, far)
            ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 2})
    ax.annotate("contractive", 1.45 * turn[:, 0], ha="left", va="center", fontsize=9)
    ax.annotate("expansive", 1.45 * turn[:, 1], ha="center", va="bottom", fontsize=9)
    _bare(ax, 1.9)


def draw_compaction(ax, compaction, marked):
    """Figure 2a: C(phi) of eq. (form-of-C), with its asymptote and marked solids fractions."""
    phi = compaction.phi0 + compaction.eps * np.linspace(0, 0.86, 200)
    ax.plot(phi, compaction.C(phi) / compaction.C0, color="black")
    ax.axvline(compaction.phi0 + compaction.eps, color=STEADY, ls="--", lw=1)
    for j, value in enumerate(marked, 1):
        height = compaction.C(value) / compaction.C0
        ax.plot(value, height, "o", color=U)
        ax.annotate(rf"$\phi_{j}$", (value, height), xytext=(-14, 4), textcoords="offset points")
    ends = [compaction.phi0, compaction.phi0 + compaction.eps]
    ax.set_xticks(ends, [r"$\phi_0$", r"$\phi_0 + \varepsilon$"])
    ax.set(xlabel=r"$\phi$", ylabel=r"$C(\phi)/C_0$", ylim=(0, 6.2), xlim=(ends[0], ends[1] + 0.1 * compaction.eps))


def draw_loci(ax, law, marked, I, between=(0.62, 1.42)):
    """Figure 2b: yield loci Y(p) at fixed I for growing phi, and the line of critical states through their tops.

    State A, beyond the top of the middle locus, contracts and strengthens; B, before it, dilates and weakens.
    """
    scale = law.compaction.C0
    for j, phi in enumerate(marked, 1):
        top = law.p_max(phi, I)
        p = np.linspace(0, top, 200)
        ax.plot(
            p / scale, np.append(p[:-1] * (law.a(I) - p[:-1] / law.compaction.C(phi)), 0) / scale, color="black", lw=1.2
        )
        ax.annotate(
            rf"$\phi_{j}$",
            (0.9 * top / scale, law.Y(0.9 * top, phi, I) / scale),
            xytext=(6, 2),
            textcoords="offset points",
        )
    ends = [law.p_critical(phi, I) for phi in marked]
    slope = law.Y(ends[1], marked[1], I) / ends[1]
    ax.plot(
        [0, 1.12 * ends[2] / scale],
        [0, 1.12 * slope * ends[2] / scale],
        color=U,
        lw=2,
        label=r"critical states, $\|\tau\| = \mu p$",
    )
    for name, factor, target, offset in (("B", between[0], 0, (-5, 7)), ("A", between[1], 2, (10, 1))):
        p = factor * ends[1]
        start = p / scale, law.Y(p, marked[1], I) / scale
        end = ends[target] / scale, law.Y(ends[target], marked[target], I) / scale
        ax.plot(*start, "o", color=V)
        ax.annotate(name, start, xytext=offset, textcoords="offset points", ha="center", fontweight="bold", color=V)
        ax.annotate(
            "", end, start, arrowprops={"arrowstyle": "-|>", "ls": "--", "color": V, "shrinkA": 4, "shrinkB": 3}
        )
    ax.set(xlabel=r"$p/C_0$", ylabel=r"$Y/C_0$", xlim=(0, None), ylim=(0, None))
    ax.set_ylim(0, 1.25 * law.Y(ends[2], marked[2], I) / scale)
    legend_below(ax)


def draw_base_flow(ax, shrink=-1.0, stretch=0.5):
    """Figure 3: u = (shrink x_1, stretch x_2) near the frozen point, compressed along x_1, the major stress axis."""
    side = np.linspace(-1, 1, 9)
    x, y = np.meshgrid(side, side)
    u, v = shrink * x, stretch * y
    ax.quiver(x, y, u, v, np.hypot(u, v), cmap="cividis", scale=9, width=0.006)
    ax.set(
        xlabel=r"$x_1$, the major compressive axis",
        ylabel=r"$x_2$",
        aspect="equal",
        xlim=(-1.25, 1.25),
        ylim=(-1.25, 1.25),
    )
    ax.set_xticks([0])
    ax.set_yticks([0])


def draw_erratum(ax, c, label, color, ls="-"):
    """chi(M, N)/|xi|^4 over direction: (42b) corrected, and dotted as printed, without its factor A."""
    theta = np.linspace(0, 180, 361)
    x = np.cos(2 * np.radians(theta))
    (line,) = ax.plot(theta, chi(c, x) / c.t**2, color=color, ls=ls, label=f"{label}: correct")
    (printed,) = ax.plot(theta, chi_as_printed(c, x) / c.t, color=color, ls=":", lw=1.3, label=f"{label}: as printed")
    ax.set(xlabel=r"direction of $\xi$ (degrees from the major axis)", xlim=(0, 180), xticks=[0, 45, 90, 135, 180])
    return line, printed


def draw_determinant(ax, c, label, color, ls="-"):
    """det(M + N)/|xi|^4 in units of t/Gamma over direction, with the bad directions (e44) marked."""
    theta = np.linspace(0, 180, 721)
    ax.plot(theta, det_MN(c, np.cos(2 * np.radians(theta))) * c.Gamma / c.t, color=color, ls=ls, label=label)
    xi = bad_directions(c)
    for angle in np.degrees(np.arctan2(xi[1], xi[0])):
        ax.plot(angle, det_MN(c, np.cos(2 * np.radians(angle))) * c.Gamma / c.t, "o", color=color, mfc="white")
    ax.axhspan(-1, 0, color=ILL)
    ax.set(xlabel=r"direction of $\xi$ (degrees from the major axis)", xlim=(0, 180), xticks=[0, 45, 90, 135, 180])


def draw_cross_terms(ax, rows):
    """``draw_erratum`` for several laws, each row (coefficients, name, colour, line style)."""
    for row in rows:
        draw_erratum(ax, *row)
    ax.set(
        title=r"(a) cross terms $\chi$, over $|\xi|^4 t^2$; as printed, over $|\xi|^4 t$",
        ylabel=r"$\chi(M, N)$",
        ylim=(-0.4, 7.5),
    )
    legend_below(ax, fontsize=8.5)


def draw_determinants(ax, rows):
    """``draw_determinant`` for several laws, each row (coefficients, name, colour, line style)."""
    for row in rows:
        draw_determinant(ax, *row)
    ax.set(title=r"(b) $\det(M+N)$ over $|\xi|^4 t/\Gamma$", ylabel=r"$\det(M+N)$", ylim=(-0.15, 2.2))
    legend_below(ax, fontsize=8.5)
    text = "○ bad directions (e44): zero in CSSM,\nlifted by A > 0 in CIDR"
    ax.annotate(text, (0.5, 0.6), xycoords="axes fraction", ha="center", fontsize=8.5)


def draw_third_root(ax, c, k):
    """lambda_3 over direction, in units of ||D||: as |xi| -> infinity (line), and the least eigenvalue at k (marks)."""
    theta = np.linspace(0, 90, 181)
    ax.plot(theta, lambda_3(c, np.cos(2 * np.radians(theta))) / c.D, color="black", label=r"$|\xi| \to \infty$")
    for value, marker in zip(k, "s^ov", strict=False):
        rates = growth_rates(c, value, np.cos(2 * np.radians(theta[::10])))
        small = np.take_along_axis(rates, np.abs(rates).argmin(axis=-1)[:, None], axis=-1)[:, 0].real
        ax.plot(theta[::10], small / c.D, marker, ms=4.5, mfc="none", ls="", label=rf"$|\xi|\,d$ = {value:g}")
    ax.axhline(0, color=STEADY, lw=0.8, ls=":")
    ax.set(xlabel=r"direction of $\xi$ (degrees from the major axis)", ylabel=r"$\lambda_3/\|D\|$", xlim=(0, 90))
    legend_below(ax)


def _turn(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _square(ax, stretch, angle, ls="-", facecolor="0.93"):
    corners = 0.55 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    ax.add_patch(
        Polygon(corners @ stretch @ _turn(angle).T, closed=True, facecolor=facecolor, edgecolor="black", ls=ls)
    )


def _bare(ax, reach):
    ax.set(xlim=(-reach, 1.35 * reach), ylim=(-0.85 * reach, 0.85 * reach), aspect="equal")
    ax.set_axis_off()
