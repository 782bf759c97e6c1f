"""Hadamard's second and third condition, for PDEs: a solution from nothing, and norms that do not help.

(a) Tychonoff's solution of the heat equation on the whole line: 0 at t = 0, and not 0 later. (It grows too fast in x
for any class in which there is one solution only, such as bounded functions.) (b) The data e^{-sqrt n} sin(n x) tend to
0 in every BC^k, and what backward heat makes of them by t = 0.01 grows without bound.
"""

from sidecar import close

from primer.study.bounded import log_hadamard
from primer.study.tychonoff import tychonoff
from primer.view.conditions import draw_norms, draw_tychonoff
from primer.view.style import new_figure

TIMES, ORDERS, T = (0.25, 0.4, 0.7, 1.2), (0, 2, 4), 0.01


def compute():
    return None


def numbers(_):
    claims = {
        f"u(1.5, {t:g})": close(tychonoff(1.5, t), rtol=1e-9, why="a sum with a bound on its tail") for t in TIMES
    }
    claims["ln_data_BC4_n1000"] = close(log_hadamard(1000, 4), rtol=1e-12, why="a formula")
    claims["ln_solution_n100"] = close(log_hadamard(100, 0, T), rtol=1e-12, why="a formula")
    return claims


def draw(_):
    figure, (left, right) = new_figure(height=3.8, title="Uniqueness, and continuous dependence")
    draw_tychonoff(left, TIMES)
    left.set(title="(a) the heat equation, from u = 0")
    draw_norms(right, ORDERS, T)
    right.set(title="(b) backward heat, in $BC^k$")
    return figure
