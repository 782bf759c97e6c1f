"""The paper's Figure 5 (fig33): the ill-posed toy system decays first, then blows up.

With a = 0.5 the steady state dips below zero about x = 0. Dist(t) falls just as in the well-posed case, past the
dashed line where u first touches zero, until the growing modes have come up from round-off: here the blow-up is of
the grid, not of the flow. The data keep u even and v odd, the fastest growing mode has the opposite parity, and exact
arithmetic would never excite that mode (without round-off the run is lost at t = 92, see exact.py); so the time of the
blow-up depends on the last bit and is claimed only as an interval.
"""

from sidecar import close, same, within

from primer import Toy, ftcs
from primer.view.runs import draw_dist, draw_fields
from primer.view.style import new_figure

T_FIELDS = 12.5  # the paper's


def compute():
    return ftcs(Toy(a=0.5, eps=0.01), n=100, dt=1e-3, t_end=100, record_every=10, snapshots=(T_FIELDS,))


def numbers(run):
    return {
        "stop": same(run.stop, "an ill-posed run on a grid that sees it"),
        "t_first_negative": close(
            run.t_first_negative, atol=2e-3, why="one or two steps of 0.001; before round-off matters"
        ),
        "dist_at_5": close(run.dist[run.t >= 5][0], rtol=1e-6, why="the decay is that of the smooth solution"),
        "dist_least": within(run.dist.min(), 1e-3, 0.01, "decays first: e^{-t/2} at t = 12 is 0.002"),
        "t_blow_up": within(run.t_stop, 12, 16, "seeded by round-off: 13.8 to 14.7 is usual in double precision"),
    }


def draw(run):
    figure, (left, right) = new_figure(
        title="Ill posed: a = 0.5, ε = 0.01, Δx = 2π/100, Δt = 0.001   (paper: Figure 5, system (toy-pde))"
    )
    draw_dist(left, run)
    left.set(title=f"(a) distance from the steady state; stops at t = {run.t_stop:.2f}", xlim=(0, 16), ylim=(3e-4, 1e3))
    draw_fields(right, run, run.snapshots[T_FIELDS], T_FIELDS)
    return figure
