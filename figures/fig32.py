"""The paper's Figure 6 (fig32): a coarse grid hides that the equations are ill posed.

The same ill-posed system as in Figure 5 (a = 0.5) on 30 points instead of 100. The modes that grow are too short for
this grid, Dist comes to rest on the floor h/sin h - 1, and the run looks as good as the well-posed one, with u < 0 in
plain sight.
"""

from sidecar import close, same

from primer import Toy, ftcs
from primer.schemes.discrete import dist_floor
from primer.view.runs import draw_dist, draw_fields
from primer.view.style import new_figure


def compute():
    return ftcs(Toy(a=0.5, eps=0.01), n=30, dt=1e-3, t_end=100)


def numbers(run):
    return {
        "stop": same(run.stop, "this grid cannot see the growing modes"),
        "dist_end": close(run.dist[-1], rtol=1e-9, why="the floor; rounding moves it by 1e-13 or so"),
        "floor": close(dist_floor(run.n), rtol=1e-12, why="h/sin h - 1, a closed form"),
        "t_first_negative": close(run.t_first_negative, atol=2e-3, why="one or two steps of 0.001"),
        "u_min_end": close(run.u_min[-1], rtol=1e-9, why="a - h/sin h, negative: an ill-posed base state"),
    }


def draw(run):
    figure, (left, right) = new_figure(
        title="Ill posed, and the coarse grid looks fine: a = 0.5, ε = 0.01, Δx = 2π/30, Δt = 0.001   (paper: Figure 6)"
    )
    draw_dist(left, run, floor=dist_floor(run.n))
    left.set(title="(a) distance from the steady state", xlim=(0, 100), ylim=(3e-3, 2))
    draw_fields(right, run, run.final, run.t_stop)
    return figure
