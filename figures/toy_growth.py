"""Growth rates of the toy system: where the equations are ill posed, what a grid sees of it, and when asymptotics hold.

About a uniform state u*, eq. (toy-mat). With u* = 0.5 every wave decays. With u* = -0.5 growth changes sign at
xi = 1/sqrt(-eps u*) = 14.1 and then knows no bound; a grid of N points ends at xi = pi/h = N/2, and the coarsest
ends before anything grows. At the cut-off itself the central first difference sees nothing (the sawtooth), and the
eigenvalues are 0 and -(1 + 4 eps u*/h^2). The estimates (toy-eig) hold beyond xi = 2/(eps |u*|) = 400 only: up to
there the two eigenvalues are a complex pair with Re lambda = -(1 + eps u* xi^2)/2, half as much.
"""

import numpy as np
from sidecar import close, same

from primer import growth_laws, growth_rates, verdict
from primer.schemes.grid import Grid
from primer.view.growth import draw_growth, shade_growing
from primer.view.style import new_figure, ticks

TOY = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"
EPS, POINTS = 0.01, (30, 100, 200)


def compute():
    found = {}
    for u in (0.5, -0.5):
        state = {"at": {"u": u, "v_xx": 0}, "eps": EPS}
        xi = np.geomspace(1, 1e4, 800)
        found[u] = {"xi": xi, "exact": growth_rates(TOY, xi, **state)[:, 0].real, "verdict": verdict(TOY, **state)}
        found[u]["laws"] = [branch.law for branch in growth_laws(TOY, **state)]
        for n in POINTS:
            k = np.linspace(0.2, n / 2, 600)
            found[u][n] = k, growth_rates(TOY, k, multiplier=Grid(n).multiplier, **state)[:, 0].real
    return found


def numbers(found):
    claims = {}
    for u, name in ((0.5, "well"), (-0.5, "ill")):
        law = found[u]["verdict"]
        claims[f"{name}_kind"] = same(str(law.kind), "u* > 0 well posed, u* < 0 ill posed")
        claims[f"{name}_exponent"] = close(law.exponent, why="Newton polygon")
        claims[f"{name}_coefficient"] = close(law.coefficient, rtol=1e-12, why="-eps u* if u* < 0, else -1/(eps u*)")
        for n in POINTS:
            rate = found[u][n][1][-1]
            claims[f"{name}_at_cut_off_{n}"] = close(rate, rtol=1e-8, atol=1e-8, why="0 or -(1 + eps u* 4/h^2)")
    xi, exact = found[-0.5]["xi"], found[-0.5]["exact"]
    claims["grows_from"] = close(np.interp(0, exact, xi), rtol=1e-3, why="1/sqrt(-eps u*), by interpolation")
    near = xi[np.flatnonzero(exact < 0.9 * EPS * 0.5 * xi**2)[-1]]
    claims["asymptotic_within_10_percent_from"] = close(near, rtol=0.02, why="a few times 2/(eps |u*|), to the spacing")
    return claims


def draw(found):
    figure, (well, ill, zoom) = new_figure(
        1,
        3,
        width=12.0,
        height=4.1,
        title="Growth rates of the toy system about a uniform state, ε = 0.01, eq. (toy-mat)",
    )
    for ax, u in ((well, 0.5), (ill, -0.5)):
        _curves(ax, found[u])
        xi, law = found[u]["xi"], found[u]["laws"][0]
        asymptote = law.coefficient * xi ** float(law.exponent)
        ax.plot(xi, asymptote, color="0.45", ls=":", lw=1.6, label="estimate (toy-eig)")
        ax.set(xscale="log", xlim=(1, 1e4))
        ax.set_yscale("asinh", linear_width=1)
    well.set(title="(a) u* = 0.5: well posed", ylim=(-3e3, 10))
    ill.set(title="(b) u* = $-$0.5: ill posed", ylim=(-3, 3e5))
    ticks(well.yaxis, [-1000, -100, -10, -1, 0, 1])
    ticks(ill.yaxis, [-1, 0, 1, 10, 100, 1000, 1e4, 1e5])
    _curves(zoom, found[-0.5])
    zoom.set(title="(c) the same near the change of sign", xlim=(0, 60), ylim=(-1, 6))
    for ax, top in ((well, 10), (ill, 3e5), (zoom, 6)):
        shade_growing(ax, top)
    lines, labels = well.get_legend_handles_labels()
    figure.legend(lines, [*labels[:-1], f"{labels[-1]}; dots: the grids' cut-off"], loc="outside lower center", ncols=5)
    return figure


def _curves(ax, curves):
    draw_growth(ax, curves["xi"], curves["exact"], label="continuum", color="black", lw=2)
    for n, ls in zip(POINTS, ("-", "--", "-."), strict=True):
        draw_growth(ax, *curves[n], label=f"N = {n}", cut_off=n / 2, ls=ls)
