"""Guards examine on every equation that diagnose is tested on, handed over as a step of which nothing is known."""

import numpy as np
import pytest
from test_diagnose_any import PROBLEMS

from primer import RK4, examine, stable_dt
from primer.schemes.grid import CENTRAL

# Of the data at t = 0, held still: with a step of RK4 that is allowed; and with one too large.
KINDS = {
    "Cahn-Hilliard": ("unstable", 1e-5),
    "layers, slow": ("stable", 1e-3),
    "layers, fast": ("ill-posed", 1e-3),
    "Kuramoto-Sivashinsky": ("unstable", 1e-2),
    "Burgers": ("stable", 1e-3),
    "Burgers backwards": ("ill-posed", 1e-4),
    "KdV": ("stable", 1e-5),
    "bad Boussinesq": ("ill-posed", 1e-5),
    "good Boussinesq": ("stable", 1e-4),
    "Perona-Malik, gentle": ("stable", 1e-4),
    "Perona-Malik, steep": ("ill-posed", 1e-5),
    "a fourth derivative": ("unstable", 1e-6),
    "too small a one": ("ill-posed", 1e-6),  # as these grids see it
    "heat": ("stable", 1e-4),
    "freezing lies": ("stable", 1e-4),
}
TOO_LARGE = {"Cahn-Hilliard": 4e-4, "heat": 5e-3, "layers, slow": 0.5, "good Boussinesq": 5e-3, "KdV": 2e-3}


def box(problem, euler=False):
    """(step, state) of an equation by central differences."""

    def grid(n):
        return problem.period * np.arange(n) / n - problem.period / 2

    def slope(fields):
        x = grid(fields.shape[-1])
        return np.array(problem.rhs(x, tuple(fields), lambda f, m: CENTRAL[m](f, x[1] - x[0])))

    def step(u, dt):
        a = slope(u)
        if euler:
            return u + dt * a
        b = slope(u + dt / 2 * a)
        c = slope(u + dt / 2 * b)
        return u + dt / 6 * (a + 2 * b + 2 * c + slope(u + dt * c))

    kind = complex if problem.is_complex else float
    return step, lambda n: np.array(problem.initial(grid(n)), dtype=kind)


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS)
def test_each_as_a_black_box(name):
    kind, dt = KINDS[name]
    found = examine(*box(PROBLEMS[name][0]), (32, 64, 128), dt)
    assert found.kind == kind, found.reason


@pytest.mark.slow
@pytest.mark.parametrize("name", TOO_LARGE)
def test_a_step_too_large_is_told_with_the_one_that_would_do(name):
    """That of ``stable_dt``, which knows the equations, to some percent."""
    problem = PROBLEMS[name][0]
    found = examine(*box(problem), (32, 64, 128), TOO_LARGE[name])
    assert found.kind == "scheme", found.reason
    known = stable_dt(problem, 128, problem.initial(problem.period * np.arange(128) / 128 - problem.period / 2), RK4)
    assert found.stable_dt == pytest.approx(known, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["KdV", "freezing lies", "good Boussinesq"])
def test_forward_euler_on_waves_is_the_schemes(name):
    assert examine(*box(PROBLEMS[name][0], euler=True), (32, 64, 128), 1e-6).kind == "scheme"


def test_every_equation_is_there():
    assert set(KINDS) == set(PROBLEMS) - {"KdV by Euler"}
