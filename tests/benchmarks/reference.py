"""Speed of the reference: ``python tests/benchmarks/reference.py`` prints ratios of medians of one process.

The toy system with a = 1.5, eps = 0.01 to t = 5. The reference within 1e-10, its error estimate included, against FTCS
as the paper runs it (N = 100, dt = 0.001) and against the quickest of scipy's ``solve_ivp`` methods that is within
1e-10 on the same right-hand side; the reference within 1e-6 against FTCS on the grid that brings it there.
"""

import sys
import time
from functools import partial

import numpy as np
from kernel import seconds

from primer import Toy, ftcs, reference
from primer.study.contestants import solve_ivp

TOY, T_END, TOL = Toy(1.5, 0.01), 5.0, 1e-10
FINE = 3100  # grid points that bring FTCS to 1e-6; checked below


def error(x, fields, truth):
    return np.abs(np.array(fields) - [f[0] for f in truth.at(x)]).max()


def quickest_solve_ivp(truth):
    """(name, call) of the quickest solve_ivp within TOL, over methods, grids and tolerances."""
    best, least = None, np.inf
    for method in ("RK45", "DOP853", "LSODA", "Radau", "BDF"):
        for n in (12, 14, 16):
            for digits in range(8, 14):
                call = partial(solve_ivp, TOY, 10.0**-digits, T_END, method, n)
                start = time.perf_counter()
                x, fields, _ = call()
                once = time.perf_counter() - start
                if error(x, fields, truth) <= TOL:
                    spent = seconds(call, 5)
                    if spent < least:
                        best, least = (f"solve_ivp {method}, N = {n}, rtol = atol = 1e-{digits}", call), spent
                    break
                if once > 0.2:
                    break
    return best


def main():
    truth = reference(TOY, T_END, tol=3.5e-13)
    answer = reference(TOY, T_END, TOL)
    own = partial(reference, TOY, T_END, TOL)
    off = error(answer.x, (answer.u[0], answer.v[0]), truth)
    assert off <= answer.error[0] <= TOL
    print(f"reference: error {off:.1e}, estimated {answer.error[0]:.1e}, {seconds(own, 300) * 1e3:.3f} ms")
    name, rival = quickest_solve_ivp(truth)
    for label, other, repeats in (
        ("FTCS, N = 100, dt = 0.001", partial(ftcs, TOY, 100, 1e-3, T_END), 30),
        (name, rival, 15),
    ):
        ratios = [seconds(other, repeats) / seconds(own, 60) for _ in range(7)]
        print(f"{np.median(ratios):10.2f} times as long: {label}")
    dt = (2 * np.pi / FINE) ** 2 / 4
    start = time.perf_counter()
    run = ftcs(TOY, FINE, dt, T_END, record_every=10**9)
    spent = time.perf_counter() - start
    loose = partial(reference, TOY, T_END, 1e-6)
    off = error(run.x, run.final, truth)
    print(
        f"{spent / seconds(loose, 100):10.0f} times as long: FTCS, N = {FINE}, dt = {dt:.2g}, error {off:.2e}, at 1e-6"
    )
    assert off <= 1e-6


if __name__ == "__main__":
    sys.exit(main())
