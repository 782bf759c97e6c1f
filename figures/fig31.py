"""The paper's Figure 4 (fig31): the well-posed toy system settles down.

With a = 1.5 the steady state u = a - cos x is positive everywhere and the equations are well posed. Dist(t) decays
like e^{-t/2} until it comes to rest, not at zero: the central differences have a steady state of their own, a -
(h/sin h) cos x, and Dist ends on the floor h/sin h - 1.
"""

from sidecar import close, same

from primer import Toy, ftcs
from primer.schemes.discrete import dist_floor
from primer.view.runs import draw_dist, draw_fields
from primer.view.style import new_figure


def compute():
    return ftcs(Toy(a=1.5, eps=0.01), n=100, dt=1e-3, t_end=100)


def numbers(run):
    floor = dist_floor(run.n)
    return {
        "stop": same(run.stop, "a well-posed run reaches its end"),
        "dist_end": close(run.dist[-1], rtol=1e-9, why="the floor; rounding moves it by 1e-13 or so"),
        "floor": close(floor, rtol=1e-12, why="h/sin h - 1, a closed form"),
        "u_min": close(run.u_min.min(), rtol=1e-6, why="the deepest u on the way, far from 0"),
    }


def draw(run):
    figure, (left, right) = new_figure(
        title="Well posed: a = 1.5, ε = 0.01, Δx = 2π/100, Δt = 0.001   (paper: Figure 4, system (toy-pde))"
    )
    draw_dist(left, run, floor=dist_floor(run.n))
    left.set(title="(a) distance from the steady state", xlim=(0, 100), ylim=(5e-5, 2))
    draw_fields(right, run, run.final, run.t_stop)
    return figure
