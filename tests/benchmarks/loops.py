"""Speed of the loops made from texts: ``python tests/benchmarks/loops.py`` prints ratios, measured side by side.

``ftcs`` on 10^7 points times steps with 1000 records, against the same scheme in C written by hand (march_loops.c,
where there is a C compiler), to the bit the same; the first answer for a text that was never seen; runs as an explorer
makes them; and, with ``--py-pde``, six equations by py-pde (the extra ``bench``): error for error, time for time.
"""

import ctypes
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from kernel import c_loop, seconds

from primer import CENTRAL, FOURIER, PDE, RK8, Toy, ftcs, march_lines
from primer.schemes.fourier import interpolate
from primer.schemes.grid import Grid

EQUATIONS = {
    "burgers": (PDE("u_t = nu*u_xx - u*u_x", {"u": "2 + sin(x)"}, nu=0.1), 0.1),
    "kuramoto_sivashinsky": (PDE("u_t = -u_xxxx - u_xx - u*u_x", {"u": "sin(x)/10"}), 0.0),
    "cahn_hilliard": (PDE("u_t = (u^3 - u - g*u_xx)_xx", {"u": "cos(x)/10"}, g=0.5), 0.5),
}


def by_hand(name, pde, parameter, n, dt, steps):
    """A function that marches in C, or None without a compiler."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        return None
    library = Path(tempfile.mkdtemp()) / "loops.so"
    source = Path(__file__).with_name("march_loops.c")
    flags = ["-O3", "-march=native", "-ffp-contract=off", "-shared", "-fPIC"]
    subprocess.run([compiler, *flags, str(source), "-o", str(library), "-lm"], check=True)
    function = getattr(ctypes.CDLL(str(library)), name)
    grid = Grid(n)
    scales = np.array([CENTRAL[m].scale(grid.h) for m in (1, 2, 4)])

    def march():
        w, scratch, records = np.zeros((2, n + 4)), np.zeros(n + 4), np.zeros((2, 2000))
        w[0, 2:-2] = start = np.array(pde.initial(grid.x)[0])
        pointer, long, double = (lambda a: a.ctypes.data_as(ctypes.c_void_p)), ctypes.c_long, ctypes.c_double
        function(
            pointer(w), pointer(start), long(n), double(dt), long(steps), long(steps // 1000), pointer(records[0]),
            pointer(records[1]), pointer(scratch), pointer(scales), double(parameter),
        )  # fmt: skip
        return w[steps % 2, 2:-2]

    return march


def said(ratios):
    """The median and the spread."""
    return f"{np.median(ratios):6.2f} times as long as C ({min(ratios):.2f} ... {max(ratios):.2f})"


def against_c():
    for n in (32, 100, 400):
        steps, h = 10**7 // n, 2 * np.pi / n
        for name, (pde, parameter) in EQUATIONS.items():
            dt = h**2 / 8 if name == "burgers" else h**4 / 40
            loop = by_hand(name, pde, parameter, n, dt, steps)
            if loop is None:
                continue

            def own(pde=pde, n=n, dt=dt, steps=steps):
                return ftcs(pde, n, dt, steps * dt)

            assert np.array_equal(own().final[0], loop()), "C and the loop made from the text must agree to the bit"
            ratios = [seconds(own, 3) / seconds(loop, 3) for _ in range(7)]
            print(f"{name:22s} N = {n:4d}: {said(ratios)}")
    loop, toy = c_loop(), Toy(1.5)
    if loop:
        ratios = [seconds(lambda: ftcs(toy, 100, 1e-3, 100.0), 3) / seconds(loop, 3) for _ in range(7)]
        print(f"{'toy':22s} N =  100: {said(ratios)}")


def first_answers():
    start = time.perf_counter()
    code = "from primer import Toy, ftcs; ftcs(Toy(1.5))"
    subprocess.run([sys.executable, "-c", code], check=True)
    print(f"a new process, the paper's run of 10^5 steps: {time.perf_counter() - start:.2f} s in all")
    for text in (
        "u_t = u_xx/9 - u^2*u_x",
        "u_t = -(u_x/(1 + u_x^2))_xxx - u_xx",
        "u_tt = u_xx + (u^2)_xx/9 - u_xxxx/99",
    ):
        data = {"u": "cos(x)/10"} | ({"u_t": "0"} if "tt" in text else {})
        start = time.perf_counter()
        ftcs(PDE(text, data), 128, 1e-7, 1e-3)
        first = time.perf_counter() - start
        start = time.perf_counter()
        ftcs(PDE(text, data), 128, 1e-7, 1e-3)
        second = time.perf_counter() - start
        print(f"first answer, 10^4 steps on 128 points: {first:.3f} s, the second {second:.3f} s: {text}")
    times = []
    for k in range(12):  # N, 2N and 4N points, 2000 steps each, the parameter moved
        start = time.perf_counter()
        for n in (32, 64, 128):
            ftcs(PDE("u_t = nu*u_xx - (u^2/2)_x + u/7", {"u": "sin(x)"}, nu=0.1 + k / 100), n, 1e-3, 2.0)
        times.append(time.perf_counter() - start)
    print(f"an explorer's call, three grids: {times[0]:.3f} s at first, then {max(times[1:]):.3f} s at most")


#: For py-pde: our text, its own, the step over h^2 (h^4 where there are fourth derivatives), the end.
RIVALS = [
    ("diffusion", "u_t = u_xx", "laplace(u)", (0.25, 2), 1.0, {}),
    ("advection", "u_t = nu*u_xx - c*u_x", "0.1*laplace(u) - 1.0*d_dx(u)", (0.2, 2), 1.0, {"nu": 0.1, "c": 1.0}),
    ("Burgers", "u_t = nu*u_xx - u*u_x", "0.1*laplace(u) - u*d_dx(u)", (0.2, 2), 1.0, {"nu": 0.1}),
    ("Kuramoto-Sivashinsky", "u_t = -(u_xx)_xx - u_xx - u*u_x", "-laplace(laplace(u)) - laplace(u) - u*d_dx(u)",
     (0.02, 4), 0.5, {}),
    ("Cahn-Hilliard", "u_t = (u^3 - u - g*u_xx)_xx", "laplace(u**3 - u - 0.5*laplace(u))", (0.02, 4), 0.5, {"g": 0.5}),
    ("Fisher", "u_t = nu*u_xx + u*(1 - u)", "0.1*laplace(u) + u*(1 - u)", (0.2, 2), 1.0, {"nu": 0.1}),
]  # fmt: skip


def against_py_pde(n=64):
    import pde

    for name, text, theirs, (part, power), t_end, parameters in RIVALS:
        own = PDE(text, {"u": "1/2 + sin(x)/5"}, **parameters)
        steps = int(np.ceil(t_end / (part * (2 * np.pi / n) ** power)))
        truth = march_lines(own, 48, 2e-5 if power == 4 else 2e-3, t_end, FOURIER, RK8).final[0]
        grid = pde.CartesianGrid([[-np.pi, np.pi]], [n], periodic=True)
        x = grid.axes_coords[0]
        start, equation = pde.ScalarField(grid, own.initial(x)[0]), pde.PDE({"u": theirs})

        def rival(count, equation=equation, start=start, dt=t_end / steps):
            return equation.solve(start, t_range=count * dt, dt=dt, solver="euler", tracker=None, backend="numba")

        times, more = [], 50_000
        for count in (steps + more, steps):  # the difference has no compiling in it
            begin = time.perf_counter()
            final = rival(count)
            times.append(time.perf_counter() - begin)
        marching = (times[0] - times[1]) / more * steps
        run = ftcs(own, n, t_end / steps, t_end, record_every=steps)
        mine = seconds(lambda own=own, n=n, steps=steps, end=t_end: ftcs(own, n, end / steps, end, steps), 5)
        errors = [np.abs(f - interpolate(truth, at)).max() for f, at in ((run.final[0], run.x), (final.data, x))]
        ratios = times[1] / mine, max(marching, 0) / mine
        print(
            f"{name:22s} {steps:6d} steps: error {errors[0]:.2e}, py-pde {errors[1]:.2e}; "
            f"py-pde takes {ratios[0]:8.0f} times as long, {ratios[1]:6.0f} times without its compiling"
        )


if __name__ == "__main__":
    if "--py-pde" in sys.argv:
        against_py_pde()
    else:
        against_c()
        first_answers()
