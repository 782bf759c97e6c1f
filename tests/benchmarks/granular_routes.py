"""Speed against error of the routes to a growth rate, and of a map against a loop over scipy.linalg.eig.

``python tests/benchmarks/granular_routes.py [PICTURE]`` prints both tables, and draws the first into PICTURE (svg, png
or pdf).
Times are of this machine; compare the ratios.
"""

import sys
import time
from dataclasses import replace

import numpy as np
from scipy.linalg import eig

from primer.granular import CIDR, EXAMPLE_COMPACTION, GLASS_BEADS, BaseState, coefficients
from primer.granular.linearisation import mass, symbol
from primer.granular.maps import growth_map
from primer.granular.routes import ROUTES, multiprecision, wavevector

LAW = CIDR(GLASS_BEADS.friction, EXAMPLE_COMPACTION)
STATE = BaseState(p=0.2, phi=0.55, I=1e-3)
DIRECTIONS = np.cos(2 * np.radians(np.linspace(0.5, 89.5, 60)))
DIRECTIONS_OF_A_LOOP = 60  # what a scan in steps of three degrees costs; the map below finds the best direction besides


def median_time(work, repeats=5):
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return float(np.median(times))


def routes_table():
    c = coefficients(LAW, STATE)
    wavenumbers = np.geomspace(1, 1e6, 7)
    exact = multiprecision(c, wavenumbers[:, None], DIRECTIONS)
    small = np.take_along_axis(exact, np.abs(exact).argmin(axis=-1)[..., None], axis=-1)
    rows = []
    for name, route in ROUTES:
        seconds = median_time(
            lambda route=route: route(c, wavenumbers[:, None], DIRECTIONS), 1 if "multi" in name else 5
        )
        found = route(c, wavenumbers[:, None], DIRECTIONS)
        error = (np.abs(found - small).min(axis=-1) / np.abs(small[..., 0])).max(axis=1)
        rows.append((name, seconds / exact[..., 0].size, error))
    return wavenumbers, rows


def print_routes(wavenumbers, rows):
    print(
        f"{'relative error of lambda_3 at |xi| d =':32s}"
        + "".join(f"{k:9.0e}" for k in wavenumbers)
        + "   time, ratio to QZ"
    )
    for name, seconds, error in rows:
        ratio = rows[0][1] / seconds
        print(f"{name:32s}" + "".join(f"{e:9.1e}" for e in error) + f"   {1e6 * seconds:9.2f} us  {ratio:8.3g}x faster")


def print_map():
    I, ratio = np.geomspace(1e-4, 10, 200), np.linspace(0.005, 1, 200)
    fast = median_time(lambda: growth_map(LAW, I, ratio, EXAMPLE_COMPACTION, 0.55), 3)
    states = int(np.isfinite(growth_map(LAW, I, ratio, EXAMPLE_COMPACTION, 0.55).growth).sum())
    c = coefficients(LAW, replace(STATE, I=0.1))
    S, E = symbol(c, wavevector(1e4, DIRECTIONS)), mass(c)

    def loop():
        for matrix in S:
            eig(-matrix, E, right=False)

    slow = median_time(loop) / len(S) * DIRECTIONS_OF_A_LOOP * states
    print(f"map of 200 x 200, {states} admissible states, best direction: {fast:.2f} s")
    print(
        f"loop over scipy.linalg.eig, {DIRECTIONS_OF_A_LOOP} directions, timed on {len(S)} calls: {slow:.0f} s",
        end=", ",
    )
    print(f"{slow / fast:.0f} times slower")


def draw(wavenumbers, rows, path):
    from primer.view.style import new_figure, save, styled

    with styled():
        figure, ax = new_figure(columns=1, width=7, height=4.4, title="Speed against error of λ₃, |ξ|d from 1 to 10⁶")
        for (name, seconds, error), marker in zip(rows[:-1], "os^Dv", strict=True):
            ax.loglog(np.full(error.size, 1e6 * seconds), np.maximum(error, 1e-17), marker, ls="-", ms=5, label=name)
        ax.set(xlabel="microseconds a wavevector", ylabel="relative error of λ₃, one point for each |ξ|")
        figure.legend(loc="outside lower center", ncols=3, fontsize=8.5)
        save(figure, path)


if __name__ == "__main__":
    table = routes_table()
    print_routes(*table)
    print_map()
    if sys.argv[1:]:
        draw(*table, sys.argv[1])
