"""Guards the order of accuracy of every scheme, in space and in time, and the tables of numbers they are made of."""

from fractions import Fraction
from functools import cache
from itertools import combinations_with_replacement

import numpy as np
import pytest
from scipy.linalg import expm

from primer import CENTRAL, CENTRAL_4, CENTRAL_6, FOURIER, RK4, RK8, BackwardHeat, Toy, march_lines, reference
from primer.schemes import lines
from primer.schemes.grid import Grid

SPACES = {2: CENTRAL, 4: CENTRAL_4, 6: CENTRAL_6, "spectral": FOURIER}


def largest_error(fields, truth):
    return np.abs(np.array(fields) - np.array(truth)).max()


@pytest.mark.parametrize("time", [RK4, RK8], ids=lambda time: time.name)
@pytest.mark.parametrize(("order", "n"), [(2, 100), (4, 60), (6, 40)])
def test_order_in_space(order, n, time):
    toy, t_end = Toy(1.5, 0.1), 2.0
    truth = reference(toy, t_end, tol=1e-12)
    errors = []
    for points in (n, 2 * n):
        run = march_lines(toy, points, 0.002, t_end, SPACES[order], time)
        errors.append(largest_error(run.final, [f[0] for f in truth.at(run.x)]))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.1)


@pytest.mark.parametrize("time", [RK4, RK8], ids=lambda time: time.name)
def test_fourier_converges_faster_than_any_power(time):
    toy, t_end = Toy(1.5, 0.1), 2.0
    truth = reference(toy, t_end, tol=1e-12)
    errors = []
    for points in (8, 12, 16, 20):
        run = march_lines(toy, points, 0.002, t_end, FOURIER, time)
        errors.append(largest_error(run.final, [f[0] for f in truth.at(run.x)]))
    falls = np.array(errors[:-1]) / errors[1:]
    assert (falls > 5).all()
    assert errors[0] / errors[2] > 2**10  # doubling n gains more than a tenth order would


def semidiscrete(toy, space, n, t):
    """The exact solution for eps = 0 of the equations in which only space is discrete, from the multiplier of d/dx.

    With u = a + c cos x and v = s sin x they are c' = m s, s' = -m c - s - 1, where d/dx e^{ix} becomes i m e^{ix}.
    """
    x, h = Grid(n).x, 2 * np.pi / n
    m = space[1].multiplier(1, h).imag
    c, s, _ = expm(t * np.array([[0, m, 0], [-m, -1, -1], [0, 0, 0]])) @ [0, -0.5, 1]
    return toy.a + c * np.cos(x), s * np.sin(x)


@pytest.mark.parametrize(("time", "steps"), [(RK4, (36, 72)), (RK8, (9, 12))], ids=["RK4", "RK8"])
@pytest.mark.parametrize("space", SPACES.values(), ids=SPACES.keys())
def test_order_in_time(space, time, steps):
    toy, n, t_end = Toy(1.5, 0), 8, 3.6
    truth = semidiscrete(toy, space, n, t_end)
    errors = [largest_error(march_lines(toy, n, t_end / k, t_end, space, time).final, truth) for k in steps]
    assert np.log(errors[0] / errors[1]) / np.log(steps[1] / steps[0]) == pytest.approx(time.order, abs=0.1)


@pytest.mark.parametrize("time", [RK4, RK8], ids=lambda time: time.name)
@pytest.mark.parametrize("space", SPACES.values(), ids=SPACES.keys())
def test_compiled_and_plain_loop_agree(space, time, monkeypatch):
    toy = Toy(1.3, 0.2)
    compiled = march_lines(toy, 20, 0.02, 1, space, time)
    monkeypatch.setattr(lines, "compiled", lambda module: None)
    plain = march_lines(toy, 20, 0.02, 1, space, time)
    assert largest_error(compiled.final, plain.final) < 1e-13


@pytest.mark.parametrize("space", [CENTRAL, CENTRAL_4, CENTRAL_6], ids=[2, 4, 6])
@pytest.mark.parametrize("m", [1, 2])
def test_stencils_are_exact_for_polynomials_and_true_to_their_multiplier(space, m):
    stencil = space[m]
    for power in range(stencil.order + m):
        value = sum(w * Fraction(o) ** power for o, w in zip(stencil.offsets, stencil.weights, strict=True))
        assert value / stencil.denominator == (1 if power == m == 1 else 2 if power == m == 2 else 0)
    value = sum(w * o ** (stencil.order + m) for o, w in zip(stencil.offsets, stencil.weights, strict=True))
    assert value != 0  # and no further
    grid = Grid(16)
    waves = np.exp(3j * grid.x)
    assert np.abs(stencil(waves, grid.h) - stencil.multiplier(3, grid.h) * waves).max() < 1e-12


@cache
def trees(nodes):
    """The rooted trees with so many nodes, each the tuple of its branches."""
    if nodes == 1:
        return [()]
    return [branches for sizes in partitions(nodes - 1) for branches in forests(sizes)]


def partitions(total, largest=None):
    if total == 0:
        return [()]
    top = min(total, largest or total)
    return [(part, *rest) for part in range(top, 0, -1) for rest in partitions(total - part, part)]


def forests(sizes):
    if not sizes:
        return [()]
    count = sizes.count(sizes[0])
    return [
        first + rest
        for first in combinations_with_replacement(trees(sizes[0]), count)
        for rest in forests(sizes[count:])
    ]


def size(tree):
    return 1 + sum(map(size, tree))


def density(tree):
    return size(tree) * int(np.prod([density(branch) for branch in tree], dtype=object))


def stage_weights(tree, A):
    product = np.ones(len(A))
    for branch in tree:
        product = product * (A @ stage_weights(branch, A))
    return product


@pytest.mark.parametrize("time", [RK4, RK8], ids=lambda time: time.name)
def test_butchers_order_conditions(time):
    A, b = time.table
    assert [len(trees(nodes)) for nodes in range(1, 10)] == [1, 1, 2, 4, 9, 20, 48, 115, 286]
    for nodes in range(1, time.order + 1):
        assert max(abs(b @ stage_weights(tree, A) - 1 / density(tree)) for tree in trees(nodes)) < 1e-14
    misses = [abs(b @ stage_weights(tree, A) - 1 / density(tree)) for tree in trees(time.order + 1)]
    assert max(misses) > 1e-6  # and no higher order


def test_rk8_has_the_numbers_of_scipys_dop853():
    theirs = pytest.importorskip("scipy.integrate._ivp.dop853_coefficients")
    A, b = RK8.table
    assert (theirs.A[:12, :12] == A).all()
    assert (b == theirs.B).all()


@pytest.mark.parametrize("time", [RK4, RK8], ids=lambda time: time.name)
def test_the_half_disc_of_stability(time):
    A, b = time.table
    z = np.exp(1j * np.linspace(np.pi / 2, 3 * np.pi / 2, 721))

    def growth(radius):
        states = np.array([b @ np.linalg.solve(np.eye(len(b)) - w * A, np.ones(len(b))) * w + 1 for w in radius * z])
        return np.abs(states).max()

    assert max(growth(radius) for radius in np.linspace(0.1, 1, 10) * time.reach) <= 1 + 1e-12
    assert growth(1.05 * time.reach) > 1


def test_any_problem_can_be_marched():
    heat = BackwardHeat(2, 3.0)
    run = march_lines(heat, 8, 0.01, 0.25, FOURIER, RK8)  # on more points round-off outgrows the solution
    (exact,) = heat.exact(run.x, 0.25)
    assert np.abs(run.final[0] - exact).max() < 1e-11 * np.abs(exact).max()


def test_the_end_is_met_and_a_blow_up_is_an_outcome():
    toy = Toy(1.5, 0.05)
    run = march_lines(toy, 16, 0.3, 1.0, FOURIER, RK8)
    assert run.dt == 0.25
    assert largest_error(run.final, [f[0] for f in reference(toy, 1.0).at(run.x)]) < 1e-8
    assert not run.blew_up
    assert march_lines(toy, 16, 0.1, 0.3).dt == pytest.approx(0.1)
    assert largest_error(march_lines(toy, 8, 1, 0).final, toy.initial(Grid(8).x)) == 0
    for problem in (toy, BackwardHeat(3)):
        run = march_lines(problem, 64, 2.0, 2000.0, CENTRAL_6, RK4)
        assert run.blew_up
        assert all(np.isnan(f).all() for f in run.final)


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ((3, 0.1, 1), ValueError, "n must be"),
        ((16, 0, 1), ValueError, "dt must be"),
        ((16, 0.1, -1), ValueError, "t_end must be"),
        ((16, 1e-300, 1), ValueError, "dt must be"),
        ((16, 0.1, 1, 4), TypeError, "space must be"),
        ((16, 0.1, 1, {1: 1, 2: 2}), TypeError, "space must be"),
        ((16, 0.1, 1, CENTRAL, 4), TypeError, "time must be"),
    ],
)
def test_bad_input_is_named(arguments, error, words):
    with pytest.raises(error, match=words):
        march_lines(Toy(1.5), *arguments)
