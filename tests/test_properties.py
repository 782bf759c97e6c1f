"""Guards the mathematics by its symmetries, scalings, conserved quantities and limits, on random examples."""

import math

import numpy as np
import pytest
import sympy as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import primer.study.round_off as round_off
from primer import (
    CENTRAL,
    CENTRAL_4,
    CENTRAL_6,
    CIDR,
    FOURIER,
    RK8,
    BackwardHeat,
    BaseState,
    Compaction,
    MuI,
    Seed,
    Stop,
    Toy,
    ftcs,
    growth,
    growth_limit,
    growth_rates,
    linearise,
    march_lines,
    verdict,
)
from primer.equations.text import FUNCTIONS, Node, parse
from primer.granular import IncompressibleMuI
from primer.granular import linearise as linearise_law
from primer.granular.criteria import incompressible_criterion
from primer.schemes.discrete import dist_floor
from primer.schemes.grid import Grid

few, some = (settings(max_examples=n, deadline=None) for n in (8, 30))
SPACES = [CENTRAL, CENTRAL_4, CENTRAL_6, FOURIER]
a_values, eps_values = st.floats(-2, 3), st.floats(0, 0.1)


@st.composite
def grids_and_seeds(draw, least=4):
    """A number of points, and a seed that such a grid can tell from a mean."""
    n = draw(st.integers(least, 60))
    mode, size, phase = draw(st.integers(1, n // 2)), draw(st.floats(-0.1, 0.1)), draw(st.floats(-math.pi, math.pi))
    return n, Seed(mode, size, draw(st.sampled_from("uv")), phase)


def mirrored(f):
    """f at -x: on the grid the point j goes to -j."""
    return np.roll(f[..., ::-1], 1, axis=-1)


# ---------------------------------------------------------------- the toy system and its schemes


@some
@given(a_values, eps_values, grids_and_seeds())
def test_the_scheme_conserves_the_mean_of_u(a, eps, grid_and_seed):
    """u_t = v_x sums to zero over the grid: the sum of u changes by round-off alone, whatever v does."""
    (n, seed), steps = grid_and_seed, 300
    run = ftcs(Toy(a, eps), n, 1e-2, steps * 1e-2, 1, snapshots=(0.0,), seed=seed, blow_up_at=100.0)
    size = 102 + abs(a)
    sums = [math.fsum(u) for u, _ in (run.snapshots[0.0], run.final)]
    assert abs(sums[1] - sums[0]) <= steps * n * size * np.finfo(float).eps
    assert sums[0] == pytest.approx(n * a, abs=n * 1e-14 * (1 + abs(a)))


def random_fields(seed, n):
    """(u, v): periodic, of any size, and in no way symmetric."""
    return np.random.default_rng(seed).normal(size=(2, n)) * [[1], [10]]


@pytest.mark.parametrize("space", SPACES)
@some
@given(st.integers(8, 200), st.integers(0, 10**6), a_values, eps_values)
def test_the_equations_commute_with_reflection(space, n, seed, a, eps):
    """(u(-x), -v(-x)) solves the toy system if (u, v) does, and u(-x) the backward heat equation if u does."""
    grid, (u, v) = Grid(n), random_fields(seed, n)

    def derivative(f, m):
        return space[m](f, grid.h)

    toy, heat = Toy(a, eps), BackwardHeat()
    sin_x = (toy.forcing(grid.x) - mirrored(toy.forcing(grid.x))) / 2  # odd, but for rounding; now to the bit
    u_t, v_t = toy.rhs(grid.x, (u, v), derivative, sin_x)
    other = toy.rhs(grid.x, (mirrored(u), -mirrored(v)), derivative, sin_x)
    slack = 1e-13 * (1 + np.abs(u).max()) * n**2
    np.testing.assert_allclose(other, (mirrored(u_t), -mirrored(v_t)), rtol=1e-12, atol=slack)
    (w_t,) = heat.rhs(grid.x, (u,), derivative)
    np.testing.assert_allclose(heat.rhs(grid.x, (mirrored(u),), derivative)[0], mirrored(w_t), rtol=1e-12, atol=slack)


@pytest.mark.parametrize("space", SPACES)
@some
@given(st.integers(8, 200), st.integers(1, 199), st.integers(0, 10**6))
def test_constant_coefficients_commute_with_shifts_of_the_grid(space, n, shift, seed):
    grid, state = Grid(n), random_fields(seed, n)

    def derivative(f, m):
        return space[m](f, grid.h)

    def rolled(fields):
        return np.roll(fields, shift, axis=-1)

    heat, toy = BackwardHeat(), Toy(0.5)
    slack = 1e-13 * n**2
    moved, there = heat.rhs(grid.x, rolled(state[:1]), derivative), rolled(heat.rhs(grid.x, state[:1], derivative))
    np.testing.assert_allclose(moved, there, rtol=1e-12, atol=slack)
    assert (space is FOURIER) or np.array_equal(moved, there)
    # The toy system's one coefficient that depends on x is the forcing: it must be shifted along.
    forcing = toy.forcing(grid.x)
    moved = toy.rhs(grid.x, rolled(state), derivative, rolled(forcing))
    np.testing.assert_allclose(moved, rolled(toy.rhs(grid.x, state, derivative, forcing)), rtol=1e-12, atol=30 * slack)


@few
@given(st.floats(1.3, 3), eps_values, grids_and_seeds(8))
def test_a_mirrored_seed_makes_a_mirrored_run(a, eps, grid_and_seed):
    """Well posed, so that round-off, which is not symmetric, stays round-off."""
    n, seed = grid_and_seed
    sign = 1 if seed.field == "u" else -1
    runs = [
        ftcs(Toy(a, eps), n, 2e-3, 1.0, seed=s)
        for s in (seed, Seed(seed.mode, sign * seed.amplitude, seed.field, -seed.phase))
    ]
    u, v = runs[0].final
    np.testing.assert_allclose(runs[1].final, (mirrored(u), -mirrored(v)), atol=1e-12)


@few
@given(a_values, eps_values, st.integers(4, 80))
def test_a_symmetric_order_of_operations_keeps_parity_to_the_bit(a, eps, n):
    """u even and v odd at every step of ``mirror_symmetric``, blow-up or not; in ``ftcs`` rounding breaks it."""
    seen = []

    def spy(u, v, *others):
        assert np.array_equal(u, mirrored(u))
        assert np.array_equal(v, -mirrored(v))
        seen.append(others)
        return tendency(u, v, *others)

    tendency = round_off.tendency
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(round_off, "tendency", spy)
        round_off.mirror_symmetric(Toy(a, eps), n, 5e-3, 2.0, blow_up_at=1e3)
    assert seen


@few
@given(a_values, eps_values, st.integers(8, 60))
def test_the_symmetric_order_is_the_same_scheme(a, eps, n):
    """One step at a time its fields agree with those of ``ftcs`` to round-off."""
    last = []
    with pytest.MonkeyPatch.context() as patch:
        tendency = round_off.tendency
        patch.setattr(round_off, "tendency", lambda u, v, *rest: last.append((u, v)) or tendency(u, v, *rest))
        round_off.mirror_symmetric(Toy(a, eps), n, 1e-3, 0.051)
    run = ftcs(Toy(a, eps), n, 1e-3, 0.05)
    np.testing.assert_allclose(last[50], run.final, atol=1e-12)


# ---------------------------------------------------------------- equations as text


@st.composite
def systems(draw):
    """Linear equations with constant coefficients, {(unknown, order): coefficient} for u_t, v_t (and w_t)."""
    size = draw(st.integers(1, 3))
    numbers = st.sampled_from([-3, -2, -1, 1, 2])
    return [
        {
            (c, m): draw(numbers)
            for c in range(size)
            for m in sorted(draw(st.sets(st.integers(0, 4 if size < 3 else 2), min_size=c == r, max_size=2)))
        }
        for r in range(size)
    ]


def written(system, names="uvw", order=None, factors=(1, 1, 1), scales=(1, 1, 1)):
    """The text of a system: ``order`` of the equations, a factor on each, and unknowns measured in other units."""
    lines = []
    for r in order or range(len(system)):
        terms = [f"({value * factors[r]})*{scales[c]}*" + at(names[c], m) for (c, m), value in system[r].items()]
        lines.append(f"{factors[r]}*{scales[r]}*{names[r]}_t = {' + '.join(terms)}")
    return "; ".join(lines)


def at(name, m):
    return f"{name}_{'x' * m}" if m else name


def assert_same(found, expected, scale=1.0):
    """The same verdict, wavenumbers being measured in other units: xi there is scale xi here."""
    assert (found.kind, found.exponent, found.unstable) == (expected.kind, expected.exponent, expected.unstable)
    stretch = scale ** float(expected.exponent)
    assert found.coefficient == pytest.approx(expected.coefficient * stretch, rel=1e-9, abs=1e-12)
    assert found.bound == pytest.approx(expected.bound, rel=1e-9, abs=1e-9)


@pytest.mark.slow
@few
@given(systems(), st.permutations(range(3)), st.sampled_from([(2, -3, 5), (-1, 1, 7)]), st.data())
def test_a_verdict_does_not_depend_on_how_the_equations_are_written(system, places, factors, data):
    """Order and names of equations and unknowns, factors on equations, units of unknowns, the sense of x."""
    expected = verdict(written(system))
    order = [r for r in places if r < len(system)]
    names = ["".join(n) for n in data.draw(st.permutations(["u", "v", "w"]))]
    assert_same(verdict(written(system, names, order)), expected)
    assert_same(verdict(written(system, factors=factors)), expected)
    assert_same(verdict(written(system, scales=factors)), expected)
    reflected = [{(c, m): (-1) ** m * value for (c, m), value in row.items()} for row in system]
    assert_same(verdict(written(reflected)), expected)  # real coefficients: xi and -xi grow alike


@pytest.mark.slow
@few
@given(systems(), st.sampled_from([2, 3]))
def test_a_verdict_knows_the_unit_of_length(system, s):
    """x = x'/s turns d/dx into s d/dx', and so lambda(xi) into lambda(s xi)."""
    stretched = [{(c, m): s**m * value for (c, m), value in row.items()} for row in system]
    assert_same(verdict(written(stretched)), verdict(written(system)), s)
    xi = np.array([0.3, 1.0, 17.0])
    here, there = growth_rates(written(stretched), xi)[:, 0].real, growth_rates(written(system), s * xi)[:, 0].real
    np.testing.assert_allclose(here, there, rtol=1e-6, atol=1e-6 * s**4 * 17.0**2)


@pytest.mark.slow
@few
@given(*[st.integers(-3, 3)] * 5, st.integers(-2, 2))
def test_a_verdict_in_the_plane_does_not_depend_on_the_axes(a, b, c, d, e, f):
    """x and y exchanged; x turned round; the plane turned by the angle whose tangent is 3/4, in whole numbers."""
    assume(a or b or c)
    lower = f"({d})*u_x + ({e})*u_y + ({f})*u"

    def quadratic(a, b, c, lower=lower):
        return verdict(f"u_t = ({a})*u_xx + ({b})*u_xy + ({c})*u_yy + {lower}")

    expected = quadratic(a, b, c)
    assert_same(quadratic(c, b, a, f"({d})*u_y + ({e})*u_x + ({f})*u"), expected)
    assert_same(quadratic(a, -b, c, f"-({d})*u_x + ({e})*u_y + ({f})*u"), expected)
    # d/dx = 4 d/dX - 3 d/dY, d/dy = 3 d/dX + 4 d/dY: a turn, and lengths five times as large.
    turned = (16 * a + 12 * b + 9 * c, -24 * a + 7 * b + 24 * c, 9 * a - 12 * b + 16 * c)
    assert_same(quadratic(*turned, f"({4 * d + 3 * e})*u_x + ({4 * e - 3 * d})*u_y + ({f})*u"), expected, 5.0)


@some
@given(st.integers(0, 10**6), st.integers(1, 3), st.floats(0.01, 1e4))
def test_maximal_order_growth_is_homogeneous_of_degree_two(seed, size, s):
    """u_t = A u_xx + B u_xy + C u_yy and lower orders: without those, growth at s xi is s^2 that at xi."""
    random = np.random.default_rng(seed)
    names, lines = "uvw"[:size], []
    for name in names:
        terms = [
            f"({random.integers(1, 9) * random.choice([-1, 1])})*{other}_{letters}"
            for other in names
            for letters in ("xx", "xy", "yy", "x", "y")
        ]
        lines.append(f"{name}_t = {' + '.join(terms)} + 2*{name}*{name}_x")
    values = {name: 1.0 for name in names} | {f"{name}_x": 0.5 for name in names}
    xi = random.normal(size=(2, 5))
    rates = [growth_rates("; ".join(lines), k, at=values, order="maximal")[..., 0].real for k in (xi, s * xi)]
    np.testing.assert_allclose(rates[1], s**2 * rates[0], rtol=1e-6, atol=1e-9 * s**2)
    full = growth_rates("; ".join(lines), xi, at=values)[..., 0].real
    assert np.abs(full - rates[0]).max() > 1e-3  # the lower orders were there


@some
@given(st.integers(0, 10**6), st.floats(0.1, 100))
def test_incompressible_growth_is_homogeneous_of_degree_two(seed, s):
    """The maximal-order parts of the granular equations scale as |xi|^2: growth depends on direction alone."""
    random = np.random.default_rng(seed)
    law = IncompressibleMuI(MuI(0.3, 0.6, 0.3))
    state = BaseState(random.uniform(0.1, 2), 0.55, 10 ** random.uniform(-3, 1))
    xi = random.normal(size=(2, 4))
    pencil = linearise_law(law, state)
    np.testing.assert_allclose(growth(pencil, s * xi), s**2 * growth(pencil, xi), rtol=1e-9)


SYMBOLS = {name: sp.Symbol(name) for name in ("u", "u_x", "u_xx", "a", "x")}


def expressions():
    """Random sympy expressions in u, u_x, u_xx, a parameter and x."""
    leaves = st.sampled_from([*SYMBOLS.values(), sp.Integer(2), sp.Rational(-3, 7), sp.Rational(1, 2)])
    functions = [sp.sin, sp.cos, sp.tanh, sp.exp]

    def longer(children):
        return st.one_of(
            st.tuples(children, children).map(lambda p: p[0] + p[1]),
            st.tuples(children, children).map(lambda p: p[0] * p[1]),
            st.tuples(children, st.integers(2, 3)).map(lambda p: p[0] ** p[1]),
            st.tuples(st.sampled_from(functions), children).map(lambda p: p[0](p[1])),
            st.tuples(children, children).map(lambda p: p[0] / (3 + p[1] ** 2)),
        )

    return st.recursive(leaves, longer, max_leaves=6)


@some
@given(expressions())
def test_what_sympy_prints_is_read_back_as_the_same_symbol(F):
    """u_t = F as text: its symbol is that of sympy's own derivatives of F, sum_m F_{u_m} (i xi)^m."""
    xi = sp.Symbol("xi")
    expected = sum(sp.diff(F, SYMBOLS[at("u", m)]) * (sp.I * xi) ** m for m in range(3))
    found = linearise(f"u_t = {F} + a*u") - sp.Matrix([[SYMBOLS["a"]]])  # a name that drops out would want a value
    point = dict(zip(SYMBOLS.values(), (0.37, -0.61, 0.23, 1.31, 0.83), strict=True)) | {xi: 0.7}
    assert found.shape == (1, 1)
    difference = complex(sp.N((found[0] - expected).subs(point)))
    assert abs(difference) <= 1e-12 * (1 + abs(complex(sp.N(expected.subs(point)))))


def printed(node):
    """A node as text, every operation in brackets."""
    parts = [printed(operand) for operand in node.operands]
    if node.kind == "number":
        return node.value[0] + "i" * node.value[1]
    if node.kind == "name":
        return node.value
    if node.kind in "+*":  # a difference is a sum with a sign, a quotient a product with a reciprocal
        return "(" + node.kind.join(parts).replace("*1/", "/").replace("+-", "-") + ")"
    if node.kind == "/":
        return f"1/{parts[0]}"
    if node.kind == "-":
        return f"-{parts[0]}"
    if node.kind == "^":
        return f"({parts[0]})^({parts[1]})"
    return f"{node.value}({parts[0]})" if node.kind == "call" else f"({parts[0]})_{node.value}"


def without_places(node):
    return Node(node.kind, 0, node.value, tuple(map(without_places, node.operands)))


@st.composite
def formulas(draw, depth=4):
    """Texts of the grammar with no more brackets than needed."""
    if depth == 0 or draw(st.integers(0, 3)) == 0:
        return draw(st.sampled_from(["u", "v_xx", "a", "2", "0.5", "3i", "1e-3", "pi", "x"]))
    one, two = draw(formulas(depth - 1)), draw(formulas(depth - 1))
    function = draw(st.sampled_from(FUNCTIONS))
    shape = st.sampled_from(
        ["{}+{}", "{}-{}", "{}*{}", "{}/{}", "({})^{}", "({})**-({})", "-({})*({})", "{f}({})+({})_x"]
    )
    return draw(shape).format(one, two, f=function)


@some
@given(formulas())
def test_a_printed_tree_is_read_back_as_the_same_tree(formula):
    ((_, tree),) = parse(f"u_t = {formula}")
    ((_, again),) = parse(f"u_t = {printed(tree)}")
    assert without_places(again) == without_places(tree)


# ---------------------------------------------------------------- units, and limits


@some
@given(*[st.floats(-1, 1)] * 3, st.integers(0, 10**6))
def test_granular_growth_has_the_units_of_a_shear_rate(log_p, log_d, log_rho, seed):
    """Pressures in other units, and grains of other size and density: growth goes as sqrt(p/rho)/d."""
    random = np.random.default_rng(seed)
    s, q, r = 10.0**log_p, 10.0**log_d, 10.0**log_rho
    friction, phi, I = MuI(0.38, 0.65, 0.28), random.uniform(0.51, 0.58), 10 ** random.uniform(-2, 0)
    laws = [CIDR(friction, Compaction(0.5, 0.1, C0)) for C0 in (1.0, s)]
    p = random.uniform(0.2, 0.8) * float(friction.alpha(I) * laws[0].compaction.C(phi))
    limits = [
        growth_limit(law, state)
        for law, state in zip(laws, (BaseState(p, phi, I), BaseState(s * p, phi, I, q, r)), strict=True)
    ]
    assert limits[1] == pytest.approx(limits[0] * math.sqrt(s / r) / q, rel=1e-9)


@some
@given(st.floats(0.1, 0.6), st.floats(0.05, 0.6), st.floats(0.05, 2))
def test_lemma_1_as_I_vanishes(mu1, more, I0):
    """alpha = 2 mu1 + 8/7 mu'(0) I + O(I^2) and beta = 2 mu1 + 2/7 mu'(0) I + O(I^3).

    The coefficients of (I/I0)^n in beta carry 24/25/(n + 2/5) - 2/5, which is zero for n = 2.
    """
    law, I = MuI(mu1, mu1 + more, I0), I0 * np.array([2e-3, 1e-3])
    for f, slope, order in ((law.alpha, 8 / 7, 2), (law.beta, 2 / 7, 3)):
        rest = f(I) - 2 * mu1 - slope * law.dmu(0) * I
        assert np.log2(rest[0] / rest[1]) == pytest.approx(order, abs=0.02)


@some
@given(st.floats(0.1, 0.9), st.floats(0.05, 0.6), st.floats(0.05, 2))
def test_the_incompressible_criterion_becomes_coulombs_as_I_vanishes(mu1, more, I0):
    """n -> 0: growth tends to tan^2(asin(mu1)/2) > 0, ill posed as Coulomb's law, with an error of order I."""
    law, I = MuI(mu1, mu1 + more, I0), I0 * np.array([2e-6, 1e-6])
    found = incompressible_criterion(law, I)
    coulomb = math.tan(math.asin(mu1) / 2) ** 2
    assert not found.well_posed.any()
    assert np.log2((found.growth[0] - coulomb) / (found.growth[1] - coulomb)) == pytest.approx(1, abs=0.01)


def test_the_floor_of_dist_on_fine_grids():
    """h/sin h - 1 = h^2/6 + 7 h^4/360 + O(h^6)."""
    n = np.array([20, 40, 80])
    h = 2 * math.pi / n
    rest = np.array([dist_floor(k) for k in n.tolist()]) - h**2 / 6
    np.testing.assert_allclose(rest / (7 * h**4 / 360), 1, atol=0.03)
    np.testing.assert_allclose(np.log2(rest[:-1] / rest[1:]), 4, atol=0.05)


@few
@given(st.floats(1.3, 3), st.floats(0.2, 5))
def test_the_solution_without_diffusion_is_the_limit_of_small_diffusion(a, t):
    """The distance to the closed form of eps = 0 halves with eps."""
    distance = []
    for eps in (2e-4, 1e-4):
        answer = march_lines(Toy(a, eps), 24, 0.02, t, FOURIER, RK8)
        distance.append(np.abs(np.array(answer.final) - Toy(a, 0).exact(answer.x, t)).max())
    assert math.log2(distance[0] / distance[1]) == pytest.approx(1, abs=0.02)


@some
@given(st.floats(-2, 2), st.floats(-1, 1), st.floats(0.5, 20), eps_values)
def test_the_discrete_symbol_tends_to_the_continuums(u, v_xx, xi, eps):
    """With the square of the spacing, entry by entry: N -> infinity."""
    toy = Toy(1.0, eps)
    exact = toy.symbol(xi, u, v_xx)
    errors = [np.abs(toy.symbol(xi, u, v_xx, Grid(n).multiplier) - exact).max() for n in (2000, 4000)]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.02)


@few
@given(st.floats(-2, -0.2))
def test_blow_up_of_a_seeded_run_comes_sooner_on_a_finer_grid(a):
    """Ill posedness, against every numerical instability: half the spacing, and the same seed grows faster."""
    runs = [ftcs(Toy(a), n, 1e-3, 30.0, seed=Seed(n // 2 - 1, 1e-6, "v")) for n in (40, 80)]
    assert runs[1].stop is Stop.BLEW_UP
    assert runs[0].stop is not Stop.BLEW_UP or runs[1].t_stop < runs[0].t_stop
