"""Pictures of a region: each kind with a colour, a hatch and a word, and the boundary between them."""

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch

#: What a region can show, with a colour, a hatch and a word each; weak is well posed with a loss of derivatives.
LOOK = (
    ("well posed", "#DCEAF4", ""),
    ("weakly well posed", "#8FBDDD", ".."),
    ("ill posed", "#E69F00", "///"),
    ("undecided", "#BBBBBB", "xx"),
)


def draw_region(axes, region):
    """Draw a ``Region`` on matplotlib axes: bands along one name, or a map of two; returns the handles of a legend.

    Colours have a hatch and a word each; black dots are boundaries, bisected, and rings isolated points.
    """
    code = classes(region)
    colours, edges = ListedColormap([colour for _, colour, _ in LOOK]), np.arange(5) - 0.5
    x = region.axes[0]
    y = region.axes[1] if len(region.axes) == 2 else np.array([0.0, 1.0])
    z = code.T if len(region.axes) == 2 else np.tile(code, (2, 1))
    logs = [len(v) > 2 and v[0] > 0 and np.allclose(np.diff(np.log(v)), np.log(v[1] / v[0])) for v in (x, y)]
    axes.pcolormesh(x, y, z, cmap=colours, norm=BoundaryNorm(edges, 4), shading="nearest", rasterized=True)
    for k in np.unique(z):
        if LOOK[k][2] and min(z.shape) > 1:
            inside = (z == k).astype(float)
            filled = axes.contourf(x, y, inside, levels=[0.5, 1.5], colors="none", hatches=[LOOK[k][2]])
            filled.set(edgecolor="0.35", linewidth=0)
    if len(region.axes) == 2:
        axes.plot(*region.boundaries.T, ".", color="black", ms=1.6)
        for place, _ in region.isolated:
            axes.plot(*(place[name] for name in region.names), "o", color="black", mfc="none", ms=6)
        axes.set_ylabel(region.names[1])
    else:
        for value in region.boundaries:
            axes.axvline(value, color="black", lw=1.2)
            words = axes.annotate(f" {value:.6g} ", (value, 0.97), ha="left", va="top", fontsize=8)
            words.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 1})
        for place, _ in region.isolated:
            axes.plot(place[region.names[0]], 0.5, "o", color="black", mfc="none", ms=8)
        axes.set_yticks([])
    axes.set(xlabel=region.names[0], xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    axes.set(xscale="log" if logs[0] else "linear", yscale="log" if logs[1] and len(region.axes) == 2 else "linear")
    return [
        Patch(facecolor=LOOK[k][1], hatch=LOOK[k][2], edgecolor="0.35", lw=0.4, label=LOOK[k][0]) for k in np.unique(z)
    ]


def classes(region):
    """Integers of the region's shape, the places in ``LOOK``."""
    code = np.where(region.kind == "ill-posed", 2, np.where(region.kind == "undecided", 3, 0))
    return np.where((code == 0) & (np.nan_to_num(region.loss) > 0), 1, code)
