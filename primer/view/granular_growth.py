"""Pictures of growth under the four granular laws: over direction, over |xi|, over the states, and on grids."""

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Polygon

from primer.granular.dispersion import growth_rate
from primer.granular.fastest import fastest
from primer.view.style import STEADY, legend_below

#: Colour and line style of each law, the same in every picture.
LOOK = {
    "Coulomb": ("#D55E00", "-"),
    "IncompressibleMuI": ("#E69F00", "--"),
    "CSSM": ("#CC79A7", "-."),
    "CIDR": ("#0072B2", "-"),
}
NAMES = {"Coulomb": "Coulomb", "IncompressibleMuI": r"$\mu(I)$", "CSSM": "CSSM", "CIDR": "CIDR"}

#: What a map can show, with a colour, a hatch and a text each.
KINDS = (
    ("damped", "#DCEAF4", ""),
    ("grows, bounded", "#8FBDDD", ".."),
    (r"ill posed, $|\xi|$", "#F3B48B", "///"),
    (r"ill posed, $|\xi|^2$", "#D55E00", "xx"),
)


def look(law):
    """(name, colour, line style) of a law."""
    return NAMES[type(law).__name__], *LOOK[type(law).__name__]


def draw_polar(ax, c, k, decades, name, color, ls):
    """Growth over the direction of xi at |xi| = k: log10(1 + |growth|/||D||) outwards, filled if growing."""
    theta = np.linspace(0, 2 * np.pi, 1441)
    rate = growth_rate(c, k, np.cos(2 * theta)) / c.D
    up = np.where(rate > 0, np.log10(1 + np.maximum(rate, 0)), 0)
    down = np.log10(1 + np.maximum(-rate, 0))
    petals = Polygon(np.column_stack([theta, up]), color=color, alpha=0.55, label="grows")
    petals.set_transform(ax.transData)
    ax.add_artist(petals)  # ax.fill would look, slowly, for limits that are set below
    ax.plot(theta, up, color=color, lw=1.4)
    ax.plot(theta, down, color=STEADY, ls=":", lw=1.1, label="decays")
    ax.set_title(name, fontsize=10.5, loc="center")
    frame_polar(ax, decades)


def frame_polar(ax, decades):
    """Rings at powers of ten, and the names of the principal axes."""
    step = -(-decades // 5)
    ax.set(rmax=decades, rticks=np.arange(step, decades + 1, step))
    ax.set_yticklabels([f"$10^{{{int(v)}}}$" for v in ax.get_yticks()], fontsize=7)
    ax.set_thetagrids([0, 90, 180, 270], ["major", "minor", "", ""], fontsize=8)
    ax.set_rlabel_position(22)


def draw_growth(ax, c, k, name, color, ls):
    """The largest growth rate over all directions, in units of ||D||, against |xi| (asinh: no corner at 0)."""
    rate, _ = fastest(c, k)
    ax.plot(k, rate / c.D, color=color, ls=ls, label=name)
    ax.set_xscale("log")
    ax.set_yscale("asinh", linear_width=1)
    ax.set(xlabel=r"$|\xi|\, d$", ylabel=r"largest growth rate$\,/\,\|D\|$")
    return rate / c.D


def draw_laws(ax, rows, k):
    """``draw_growth`` for several laws, each row (law, coefficients, verdict, limit in units of ||D||)."""
    for law, c, found, limit in rows:
        name, color, ls = look(law)
        power = rf"$\sim |\xi|^{{{found.exponent}}}$"
        ending = power if found.kind == "ill-posed" else rf"bounded by {limit:.3g} $\|D\|$"
        draw_growth(ax, c, k, f"{name}: {found.kind}, {ending}", color, ls)
    ax.set(title="largest growth over all directions", xlim=(k[0], k[-1]))
    legend_below(ax)


def draw_window(ax, c, k, degrees, step=1.0):
    """Growth over a few directions, in units of ||D||, one line for each |xi|; dots: what a scan by ``step`` sees.

    degrees = (low, high), from the major compressive axis.
    """
    fine = np.linspace(degrees[0], degrees[1], 2001)
    coarse = np.arange(np.ceil(degrees[0] / step), np.floor(degrees[1] / step) + 1) * step
    for value, ls in zip(k, ("-", "--", "-.", ":"), strict=False):
        (line,) = ax.plot(fine, _rate(c, value, fine), ls=ls, label=rf"$|\xi|\,d$ = {value:,.0f}")
        ax.plot(coarse, _rate(c, value, coarse), "o", ms=5, color=line.get_color(), mec="black", clip_on=False)
    ax.set(xlim=degrees, ylim=(0, None), ylabel=r"growth rate$\,/\,\|D\|$")
    ax.set(xlabel=r"direction of $\xi$ (degrees from the major axis)", title=f"dots: a scan by {step:g}°")
    legend_below(ax)


def _rate(c, k, degrees):
    return growth_rate(c, k, np.cos(2 * np.radians(degrees))) / c.D


def classify(low, high):
    """From maps at two wavenumbers, 0 to 3 as in KINDS, nan outside: how the growth changes from one to the other."""
    kind = np.where(low.growth > 0, 1.0, 0.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        slope = np.log(high.growth / low.growth) / np.log(high.k / low.k)
    growing = (low.growth > 0) & (high.growth > 0)
    kind = np.where(growing & (slope > 0.3), 2.0, kind)
    kind = np.where(growing & (slope > 1.5), 3.0, kind)
    return np.where(np.isnan(low.growth), np.nan, kind)


def draw_map(ax, I, ratio, kind):
    """The kinds of ``classify`` over (I, p/C): colour and hatch, white where the law admits no such state."""
    cmap = ListedColormap([colour for _, colour, _ in KINDS])
    mesh = ax.pcolormesh(I, ratio, kind, cmap=cmap, norm=BoundaryNorm(np.arange(-0.5, 4), 4), rasterized=True)
    for j, (_, _, hatch) in enumerate(KINDS):
        if hatch and (kind == j).any():
            inside = np.where(kind == j, 1.0, 0.0)
            ax.contourf(I, ratio, inside, levels=[0.5, 1.5], colors="none", hatches=[hatch])
    ax.set_xscale("log")
    ax.set(xlabel="inertial number I", ylim=(ratio[0], ratio[-1]))
    ax.grid(False)
    return mesh


def draw_noise(ax, noise):
    """The first velocity component of the noise at its time, on the grid's own cells, over its largest value.

    Returns the image, from -1 to 1.
    """
    u = noise.after[0]
    top = np.abs(u).max()
    look = {"cmap": "RdBu_r", "vmin": -1, "vmax": 1, "interpolation": "nearest", "extent": (0, 1, 0, 1)}
    image = ax.imshow(u.T / top, origin="lower", **look)
    ax.set(xticks=[], yticks=[])
    ax.set_title(f"{noise.n}²: noise {gain_text(noise.gain)}", fontsize=9.5)
    ax.grid(False)
    return image


def gain_text(gain):
    """A gain as plain text: ×0.91, ×740, ×10^21."""
    return rf"$\times\,{gain:.3g}$" if gain < 1e4 else rf"$\times\,10^{{{round(np.log10(gain))}}}$"


def draw_measured(ax, noises, c, color, ls):
    """Growth measured in the noise on each grid (markers, for shells of modes) over the symbol's in the best direction.

    A marker lies below the line where none of the grid's modes points in the best direction.
    """
    k = np.geomspace(noises[-1].k[0], noises[-1].k[-1], 60)
    ax.plot(k, fastest(c, k)[0] / c.D, color=color, ls=ls)
    for noise, marker, size in zip(noises, "os^", (6.5, 4.5, 2.5), strict=True):
        whole = np.flatnonzero(noise.k < np.pi * noise.n / noise.side)  # beyond are the corners of the square of modes
        pick = whole[np.unique(np.geomspace(3, whole.size - 1, 10).astype(int))]
        style = {"ms": size, "color": "black", "mfc": "none", "mew": 0.8, "ls": ""}
        ax.plot(noise.k[pick], noise.measured[pick] / c.D, marker, label=f"{noise.n}²", **style)
        ax.axvline(np.pi * noise.n / noise.side, color=STEADY, lw=0.8, ls=":")
    ax.set_xscale("log")
    ax.set_yscale("asinh", linear_width=10)
    ax.set(ylim=(-10, None), yticks=[0, 1e2, 1e4, 1e6])
    ax.minorticks_off()
    ax.tick_params(labelsize=8)


def draw_routes(ax, routes, legend=False):
    """Error of lambda_3 against |xi| for each way of computing eigenvalues; one line style and marker a way."""
    styles = zip(routes.names, ("o-", "s--", "^-.", "D:", "v-"), strict=False)
    for (name, style), error in zip(styles, routes.errors, strict=True):
        label = name.replace("|xi| -> infinity", r"$|\xi| \to \infty$")
        ax.loglog(routes.k, np.maximum(error, 1e-17), style, ms=4, label=label)
    ax.set(xlabel=r"$|\xi|\, d$", ylabel=r"relative error of $\lambda_3$")
    if legend:
        ax.legend(loc="upper center", fontsize=8.5)
