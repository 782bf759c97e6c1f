"""Speed of the time loop: ``python tests/benchmarks/kernel.py`` prints ratios, measured in turn in one process.

FTCS for a = 1.5, N = 100, 100,000 steps and 1001 records: ``primer.ftcs`` against the scheme in np.roll, against the
best preallocated NumPy loop we could write, against a C loop (where there is a C compiler) and against py-pde's
compiled Euler solver (where it is installed). The slow ones march fewer steps and are scaled. Then 64 values of a as
an ensemble.
"""

import ctypes
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from primer import Toy, ftcs, ftcs_ensemble
from primer.schemes.grid import CENTRAL, Grid

TOY, N, DT, STEPS = Toy(1.5), 100, 1e-3, 100_000


def kernel():
    return ftcs(TOY, N, DT, STEPS * DT).final


def rolled(steps=STEPS // 50):
    """The textbook's version."""
    grid = Grid(N)
    u, v = TOY.initial(grid.x)
    s, r1, r2 = np.sin(grid.x), CENTRAL[1].scale(grid.h), CENTRAL[2].scale(grid.h)
    for _ in range(steps):
        u_x = (np.roll(u, -1) - np.roll(u, 1)) * r1
        v_x = (np.roll(v, -1) - np.roll(v, 1)) * r1
        v_xx = (np.roll(v, -1) - 2 * v + np.roll(v, 1)) * r2
        u, v = u + DT * v_x, v + DT * (TOY.eps * u * v_xx + u_x - v - s)
    return u, v


def preallocated(steps=STEPS // 50):
    """Ghost cells, views made once, every operation into an array that is already there; constants folded."""
    grid = Grid(N)
    w = np.zeros((2, N + 2))
    w[:, 1:-1] = TOY.initial(grid.x)
    ghosts, inner = w[:, :: N + 1], w[:, N : 0 : 1 - N]
    u, v, v_left, v_right = w[0, 1:-1], w[1, 1:-1], w[1, :-2], w[1, 2:]
    both, left, right = w[:, 1:-1], w[:, :-2], w[:, 2:]
    s, first, second = np.sin(grid.x), np.empty((2, N)), np.empty(N)
    r1, r2 = DT * CENTRAL[1].scale(grid.h), TOY.eps * CENTRAL[2].scale(grid.h)
    rate = np.empty((2, N))
    add, subtract, multiply = np.add, np.subtract, np.multiply
    for _ in range(steps):
        ghosts[...] = inner
        subtract(right, left, first)
        multiply(first, r1, first)
        add(v_left, v_right, second)
        subtract(second, v, second)
        subtract(second, v, second)
        multiply(second, u, second)
        multiply(second, r2, second)
        subtract(second, v, second)
        subtract(second, s, second)
        multiply(second, DT, rate[1])
        add(rate[1], first[0], rate[1])
        rate[0] = first[1]
        add(both, rate, both)
    return u, v


def c_loop():
    """A function that marches in C, or None without a compiler."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        return None
    source = Path(__file__).with_name("ftcs_loop.c")
    library = Path(tempfile.mkdtemp()) / "ftcs_loop.so"
    flags = ["-O3", "-march=native", "-ffp-contract=off", "-shared", "-fPIC"]
    subprocess.run([compiler, *flags, str(source), "-o", str(library), "-lm"], check=True)
    function = ctypes.CDLL(str(library)).march
    grid = Grid(N)

    def march():
        w = np.zeros((2, 2, N + 2))
        w[0, :, 1:-1] = TOY.initial(grid.x)
        sin_x, u_inf, dist, u_min = np.zeros(N + 2), np.zeros(N + 2), np.zeros(1001), np.zeros(1001)
        sin_x[1:-1], u_inf[1:-1] = np.sin(grid.x), TOY.steady(grid.x)[0]
        pointer, long, double = (lambda a: a.ctypes.data_as(ctypes.c_void_p)), ctypes.c_long, ctypes.c_double
        function(
            pointer(w), pointer(sin_x), pointer(u_inf), long(N), double(CENTRAL[1].scale(grid.h)),
            double(CENTRAL[2].scale(grid.h)), double(DT), double(TOY.eps), long(STEPS), long(STEPS // 1000),
            pointer(dist), pointer(u_min),
        )  # fmt: skip
        return tuple(w[STEPS % 2, :, 1:-1])

    return march


def py_pde():
    """py-pde as its documentation would have it, compiled by its numba backend, or None where it is not installed."""
    try:
        import pde
    except ImportError:
        return None
    grid = pde.CartesianGrid([[-np.pi, np.pi]], [N], periodic=True)
    x = grid.axes_coords[0]
    equation = pde.PDE(
        {"u": "d_dx(v)", "v": f"{TOY.eps} * u * laplace(v) + d_dx(u) - v - sin(x)"},
    )
    start = pde.FieldCollection([pde.ScalarField(grid, f) for f in TOY.initial(x)])

    def march(steps):
        return equation.solve(start, t_range=steps * DT, dt=DT, solver="euler", tracker=None, backend="numba")

    return march


def seconds(function, repeats=5):
    """Median wall time; one call before them does not count."""
    function()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return float(np.median(times))


def main():
    loop, pde_solve = c_loop(), py_pde()
    if loop:
        assert np.array_equal(loop(), kernel()), "the C loop and the kernel must agree to the bit"
    np.testing.assert_allclose(preallocated(1000), rolled(1000), atol=1e-12)
    own = seconds(kernel, 15)
    print(f"ftcs, N = {N}, {STEPS} steps, 1001 records: {own * 1e3:.2f} ms")
    for name, function in (("np.roll", rolled), ("preallocated NumPy", preallocated)):
        print(f"{name:24s} {seconds(function, 3) * 50 / own:8.1f} times as long")
    if pde_solve:  # each call compiles anew: that is in the whole run, and cancels in the difference of two
        few, many = (seconds(lambda steps=steps: pde_solve(steps), 1) for steps in (1000, STEPS // 10))
        marching = (many - few) / (STEPS // 10 - 1000) * STEPS
        print(f"{'py-pde, numba backend':24s} {marching / own:8.1f} times as long marching, and {few:.0f} s to compile")
    toys = [Toy(a) for a in np.linspace(1.2, 2, 64)]

    def one_by_one():
        return [ftcs(toy, N, DT, STEPS * DT) for toy in toys]

    def side_by_side():
        return ftcs_ensemble(toys, N, DT, STEPS * DT)

    shares = [seconds(side_by_side, 1) / seconds(one_by_one, 1) for _ in range(5)]
    print(f"{'64 as an ensemble':24s} {np.median(shares):8.3f} of the time of 64 runs, {os.cpu_count()} cores")
    if loop:
        pairs = [(seconds(kernel, 5), seconds(loop, 5)) for _ in range(7)]
        print(f"{'C loop':24s} {np.median([c / k for k, c in pairs]):8.3f} times as long")


if __name__ == "__main__":
    sys.exit(main())
