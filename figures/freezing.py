"""Where freezing lies, and where eigenvalues do: w_t = i w_xx + 3 i cos(x) w_x, and a derivative lost.

(a) Frozen at x = pi the shortest wave of a grid grows at 3 N/2. The truth is that nothing grows without bound; central
differences say so, a Galerkin matrix of N waves does not. (b) Lax
and Friedrichs' scheme, dt = 0.9 h, for u_t = u_x + v_x, v_t = v_x: no eigenvalue is beyond 1, and powers grow with the
number of steps; for v_t = v_x alone they are bounded.
"""

import numpy as np
from sidecar import close, within

from primer.study.freezing import central, fastest, galerkin, lax_friedrichs, powers
from primer.view.conditions import draw_powers, draw_rates
from primer.view.style import new_figure

N = np.array([16, 32, 64, 128, 256])
WAVES = np.linspace(0, np.pi, 401)


def compute():
    rates = {
        "frozen at x = π": 3 * N / 2,
        "Galerkin, N waves": [fastest(galerkin(n)) for n in N],
        "central differences": [fastest(central(n)) for n in N],
    }
    norms = {
        "coupled by v_x": powers(lax_friedrichs(WAVES, 0.9), 256).max(axis=-1),
        "not coupled": powers(lax_friedrichs(WAVES, 0.9, 0.0), 256).max(axis=-1),
    }
    return rates, norms


def numbers(result):
    rates, norms = result
    claims = {}
    for n, found, central_ in zip(N, rates["Galerkin, N waves"], rates["central differences"], strict=True):
        claims[f"galerkin_{n}"] = within(found, 0.3 * n, 0.5 * n, "eigenvalues of a matrix far from normal")
        claims[f"central_{n}"] = within(central_, -1e-8 * n**2, 1e-8 * n**2, "0, to rounding")
    for name, values in norms.items():
        claims[f"power 256, {name}"] = close(values[-1], rtol=1e-6, why="401 waves")
    return claims


def draw(result):
    rates, norms = result
    figure, (left, right) = new_figure(height=3.9, title="Frozen coefficients, and eigenvalues, are not everything")
    draw_rates(left, N, rates)
    left.set(title="(a) $w_t = i w_{xx} + 3i\\,\\cos x\\,w_x$")
    draw_powers(right, norms)
    right.set(title="(b) $u_t = u_x + v_x,\\ v_t = v_x$: Lax-Friedrichs")
    return figure
