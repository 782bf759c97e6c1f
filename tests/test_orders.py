"""Guards the order of accuracy of every scheme, in space and in time, and the tables of numbers they are made of."""

from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import combinations_with_replacement

import numpy as np
import pytest
from scipy.linalg import expm

from primer import CENTRAL, CENTRAL_4, CENTRAL_6, FOURIER, RK4, RK8, BackwardHeat, Toy, march_lines, reference
from primer.schemes import lines
from primer.schemes.grid import Grid
from primer.schemes.lines import stable_step
from primer.schemes.runge_kutta import RungeKutta

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
    monkeypatch.setattr(lines, "able", lambda: False)
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
    A, b = replace(time).table  # made anew from the rows
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
    A, b = replace(time).table  # made anew from the rows
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


@pytest.mark.parametrize("space", SPACES.values(), ids=SPACES.keys())
@pytest.mark.parametrize("n", [7, 20, 129])
def test_the_stable_step_is_nine_tenths_of_the_half_disc_over_the_largest_eigenvalue(space, n):
    """Eigenvalues lie within max(d1, 1 + eps (|a| + 1.25) d2), d1 and d2 the largest multipliers on the grid."""
    xi, h = np.arange(n // 2 + 1), 2 * np.pi / n
    d1, d2 = (np.abs(space[m].multiplier(xi, h)).max() for m in (1, 2))
    if space is CENTRAL:
        assert d1 == pytest.approx(np.sin(xi * h).max() / h)
        assert d2 == pytest.approx(4 / h**2 * (np.sin(xi * h / 2) ** 2).max())
    for a, eps in ((1.5, 0.0), (-2.0, 0.3), (1.5, 1e-3), (0.0, 0.02)):
        for time, reach in ((RK4, 2.6), (RK8, 5.9)):
            expected = 0.9 * reach / max(d1, 1 + eps * (abs(a) + 1.25) * d2)
            assert stable_step(Toy(a, eps), n, space, time) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(("space", "n"), [(CENTRAL, 12), (CENTRAL_6, 12), (CENTRAL_6, 4), (FOURIER, 9), (FOURIER, 130)])
@pytest.mark.parametrize("fast", [True, False])
def test_the_states_on_the_way_and_the_depth_of_u_below_zero(space, n, fast, monkeypatch):
    """Step by step by ``RungeKutta.step``; the depth by the rectangle rule, from the state before each step."""
    toy, dt, counts = Toy(0.4, 1e-4), np.array([0.02, 0.01, 0.04]), np.array([3, 0, 50])
    if not fast:
        monkeypatch.setattr(lines, "able", lambda: False)
    states, depth = lines.trace(toy, n, space, RK8, dt, counts)
    x, h, deep = Grid(n).x, 2 * np.pi / n, 0.0
    y = np.array(toy.initial(x))

    def slope(y):
        return np.array(toy.rhs(x, y, lambda f, m: space[m](f, h)))

    for m in range(3):
        for _ in range(counts[m]):
            deep += dt[m] * max(0.0, -y[0].min())
            y = RK8.step(slope, y, dt[m])
        np.testing.assert_allclose(states[m], y, atol=1e-12)
        assert depth[m] == pytest.approx(deep, abs=1e-13)
    assert depth[0] == 0 < depth[2]


@pytest.mark.parametrize("fast", [True, False])
@pytest.mark.parametrize("space", [CENTRAL, FOURIER], ids=["central", "fourier"])
def test_states_that_a_blow_up_kept_from_being_reached_are_nan(space, fast, monkeypatch):
    if not fast:
        monkeypatch.setattr(lines, "able", lambda: False)
    toy, dt = Toy(-1.0, 0.5), np.full(4, 0.05)
    counts = np.array([2, 2, 1000, 1])
    states, depth = lines.trace(toy, 32, space, RK4, dt, counts)
    assert np.isfinite(states[:2]).all()
    assert np.isfinite(depth[:2]).all()
    assert np.isnan(states[2:]).all()
    assert (depth[2:] == np.inf).all()
    assert states.shape == (4, 2, 32)


def test_a_march_is_given_up_at_1e100_times_the_size_of_its_data(monkeypatch):
    """|y| doubles at each step of y' = y/dt by the tangent: for any problem, to the very step."""

    class Doubling:
        def initial(self, x):
            return (np.where(x < 0, 3.0, -3.0),)

        def forcing(self, x):
            return None

        def rhs(self, x, state, derivative, forcing):
            return state

    euler = RungeKutta("Euler", 1, (), (1.0,), 1.0)
    limit = 1e100 * 4  # 1 + max|y|
    last = int(np.log2(limit / 3))
    for counts, alive in ((last, True), (last + 1, False)):
        run = march_lines(Doubling(), 4, 1.0, counts, CENTRAL, euler)
        assert run.blew_up is not alive
        assert not alive or (np.abs(run.final[0]) == 3.0 * 2.0**last).all()


def test_a_march_ends_at_its_end_in_equal_steps_none_longer_than_asked():
    for dt, t_end, steps in ((0.1, 0.3, 3), (0.1, 0.31, 4), (0.3, 1.0, 4), (2.0, 1.0, 1), (1e-3, 0.0, 0)):
        run = march_lines(Toy(1.5), 4, dt, t_end)
        assert run.dt == pytest.approx(t_end / steps if steps else dt, rel=1e-15)
        assert (run.t, run.n, run.problem, run.time, run.space) == (t_end, 4, Toy(1.5), RK4, CENTRAL)
        np.testing.assert_array_equal(run.x, Grid(4).x)
        for array in (run.x, *run.final):
            assert not array.flags.writeable


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((4, 1e-7, 1.0001), "dt must be >= t_end/1e+07 (more steps take too long), got 1e-07 with t_end 1.0001"),
        ((10**6, 1e-7, 0.5), "n and dt must be such that n t_end/dt <= 1e+12, got n = 1000000 and dt = 1e-07"),
        ((10**7, 1.0, 1.0), "n: the march must fit into 2 GiB of memory, got n = 10000000"),
        ((4, 0.1, -1.0), "t_end must be a finite number >= 0, got -1.0"),
    ],
)
def test_a_march_too_long_is_refused_before_it_starts(arguments, said):
    time = RK8 if arguments[0] == 10**7 else RK4
    with pytest.raises(ValueError, match="must") as error:
        march_lines(Toy(1.5), *arguments, CENTRAL, time)
    assert str(error.value) == said


def test_the_longest_marches_allowed(monkeypatch):
    """10^7 steps, and 10^12 points times steps, are not too many: they are marched."""
    asked = []

    def trace(problem, n, space, time, dt, counts, progress):
        asked.append((n, int(counts[0])))
        return np.zeros((1, 2, n)), None

    monkeypatch.setattr(lines, "trace", trace)
    march_lines(Toy(1.5), 4, 1.0, 1e7)
    march_lines(Toy(1.5), 10**5, 1.0, 1e7)
    march_lines(Toy(1.5), 5 * 10**6, 1.0, 1.0)
    assert asked == [(4, 10**7), (10**5, 10**7), (5 * 10**6, 1)]


@pytest.mark.parametrize("wrong", [Toy, 3, object()])
def test_what_is_no_problem_is_named(wrong):
    with pytest.raises(TypeError, match=r"^problem must be a PDE, a Toy, a BackwardHeat or an object with their"):
        march_lines(wrong, 4, 0.1, 1.0)
    with pytest.raises(TypeError, match="toy must be a Toy, got"):
        stable_step(wrong, 4, CENTRAL, RK4)


@pytest.mark.parametrize("space", [4, None, {1: CENTRAL[1]}, {1: CENTRAL[1], 2: 3}, [CENTRAL[1], CENTRAL[2]]])
def test_what_is_no_space_or_time_is_named(space):
    for call in (lambda: march_lines(Toy(1.5), 4, 0.1, 1.0, space), lambda: stable_step(Toy(1.5), 4, space, RK4)):
        with pytest.raises(TypeError, match=r"^space must be a table of derivatives such as CENTRAL or FOURIER, got "):
            call()
    for call in (
        lambda: march_lines(Toy(1.5), 4, 0.1, 1.0, CENTRAL, 4),
        lambda: stable_step(Toy(1.5), 4, CENTRAL, 4),
    ):
        with pytest.raises(TypeError, match=r"^time must be a RungeKutta step such as RK4 or RK8(, or ETDRK4)?, got 4"):
            call()


def test_a_march_and_a_step_are_shown_without_their_arrays():
    run = march_lines(Toy(1.5), 4, 0.5, 1.0)
    assert repr(run) == f"Lines(problem={Toy(1.5)!r}, n=4, dt=0.5, t=1.0, time={RK4!r})"
    assert repr(RK4) == "RungeKutta(name='RK4', order=4, reach=2.6)"
    for array in RK8.table:
        assert not array.flags.writeable
