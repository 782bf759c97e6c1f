"""Guards the scenes of granular laws and of typed PDEs: what they say against eigenvalues found by another route."""

import math

import numpy as np
import pytest

from primer import Toy, growth
from primer import verdict as verdict_of
from primer.granular import EXAMPLE_COMPACTION, linearise
from primer.granular.maps import growth_map
from primer.scenes.pde import TOY, XI, pde, read_values
from primer.scenes.rheology import LAWS, PHI, Kind, rheology, rheology_map
from primer.schemes.grid import Grid
from primer.view.granular_growth import classify


def eigenvalue_growth(answer, k, theta):
    """Growth in ||D|| from the 5x5 (or 3x3) symbol itself, in directions theta."""
    xi = k * np.array([np.cos(theta), np.sin(theta)])
    return growth(linearise(answer.law, answer.state), xi) / answer.state.D


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
def test_the_kind_of_random_states_is_what_eigenvalues_do(law):
    rng, seen = np.random.default_rng(3), set()
    for _ in range(25):
        answer = rheology(law, 10 ** rng.uniform(-2.5, 1), rng.uniform(0.05, 0.95), rng.uniform(12, 30))
        seen.add(answer.kind)
        if answer.kind is Kind.NOT_ADMITTED:
            assert not answer.law.Y(answer.state.p, PHI, answer.state.I) > 0
            continue
        there = math.atan2(*answer.found.direction[::-1])
        theta = np.append(np.linspace(0, np.pi / 2, 181), there)
        if answer.kind is Kind.ILL_POSED:
            low, high = (eigenvalue_growth(answer, k, there) for k in (1e4, 1e5))
            assert math.log10(high / low) == pytest.approx(float(answer.found.exponent), abs=0.02)
            law_of_growth = answer.found.coefficient / answer.state.D * 1e5 ** float(answer.found.exponent)
            assert high == pytest.approx(law_of_growth, rel=0.05)
            continue
        rates = np.array([eigenvalue_growth(answer, k, theta) for k in (0.1, 10, 1e6)])
        bound = answer.found.bound / answer.state.D
        assert rates.max() <= bound + 1e-5 * max(1, bound)
        if answer.kind is Kind.UNSTABLE and answer.limit > 0:
            assert rates[-1].max() == pytest.approx(answer.limit, rel=0.05)
    expected = {"Coulomb": {Kind.ILL_POSED}, "mu(I)": {Kind.ILL_POSED, Kind.STABLE}}
    expected |= {"CSSM": {Kind.ILL_POSED, Kind.STABLE, Kind.NOT_ADMITTED}}
    expected |= {"CIDR": {Kind.UNSTABLE, Kind.STABLE, Kind.NOT_ADMITTED}}
    assert seen - {Kind.UNSTABLE} == expected[law] - {Kind.UNSTABLE}
    assert (Kind.ILL_POSED in seen) is (law != "CIDR")


@pytest.mark.parametrize("law", LAWS)
def test_the_map_is_what_eigenvalues_say_on_it(law):
    known = rheology_map(law, 21.0)
    made = rheology(law).law
    low, high = (growth_map(made, known.I, known.ratio, EXAMPLE_COMPACTION, PHI, k) for k in (1e6, 1e8))
    assert np.array_equal(known.kind, classify(low, high), equal_nan=True)
    assert np.isnan(known.kind).any() == (law in ("CSSM", "CIDR"))


def test_the_edges_are_where_the_verdict_changes():
    (low, _), (high, _) = rheology_map("mu(I)", 21.0).edges
    assert low[0] == pytest.approx(0.0194016579336, rel=1e-10)
    for I, inside in ((low[0], 1.0001), (high[0], 0.9999)):
        assert rheology("mu(I)", I * inside).kind is Kind.STABLE
        assert rheology("mu(I)", I / inside).kind is Kind.ILL_POSED
    ((_, mu),) = rheology_map("CSSM", 21.0).edges
    assert rheology("CSSM", ratio=mu[0] * 0.999).kind is Kind.ILL_POSED
    assert rheology("CSSM", ratio=mu[0] * 1.001).kind is not Kind.ILL_POSED
    for (_, edge), step in zip(rheology_map("CSSM", 32.0).edges, (1e-3, -1e-3), strict=True):
        inside, outside = (rheology("CSSM", ratio=edge[0] * (1 + s), angle=32.0) for s in (step, -step))
        assert (inside.kind, outside.kind) == (Kind.ILL_POSED, Kind.UNSTABLE)
        assert "ill posed for 0.125 < p/C <= 0.625" in inside.verdict
    ((I, ratio),) = rheology_map("CIDR", 21.0).edges
    for j in (0, 20, 40):
        below, above = (rheology("CIDR", I[j], ratio[j] * (1 + step)).limit for step in (-1e-5, 1e-5))
        assert below > 0 > above


@pytest.mark.parametrize(
    ("law", "angle"), [("CSSM", 21.0), ("CSSM", 32.0), ("CSSM", 10.0), ("mu(I)", 21.0), ("mu(I)", 15.0)]
)
def test_no_cell_of_the_map_is_painted_across_a_straight_edge(law, angle):
    """A cell reaches half-way to the next one: what is painted changes on the edge itself."""
    known = rheology_map(law, angle)
    axis, kinds = (known.ratio, known.kind[:, 0]) if law == "CSSM" else (known.I, known.kind[0])
    changes = np.flatnonzero(np.diff(kinds >= 2))
    painted = (axis[changes] + axis[changes + 1]) / 2
    edges = [edge[1 if law == "CSSM" else 0][0] for edge in known.edges]
    np.testing.assert_allclose(painted, edges, rtol=1e-12)
    assert (np.diff(axis) > 0).all()


def test_a_steep_friction_law_is_ill_posed_at_every_inertial_number_as_it_is_said():
    said = [rheology("mu(I)", I, angle=32.0) for I in np.geomspace(1e-4, 100, 40)]
    assert {answer.kind for answer in said} == {Kind.ILL_POSED}
    assert all("at every I" in answer.verdict for answer in said)


def test_the_words_follow_the_conditions():
    for law in LAWS:
        for ratio in (0.1, 0.5):
            answer = rheology(law, ratio=ratio)
            assert ("theorem promises it" in answer.verdict) == bool(answer.conditions.theorem)
            assert answer.verdict.startswith("Ill posed") == (answer.found.kind == "ill-posed")
    assert "p/C < 0.8509" in rheology("CIDR", 0.1, 0.95).verdict
    assert rheology("CIDR", 0.1, 0.95).law.p_max(PHI, 0.1) == pytest.approx(0.8509, abs=5e-5)  # C(0.55) = 1


@pytest.mark.parametrize(
    ("name", "value"), [("law", "Mohr"), ("I", 0.0), ("ratio", -1.0), ("angle", 45.0), ("angle", float("nan"))]
)
def test_rheology_names_what_is_wrong(name, value):
    with pytest.raises(ValueError, match=rf"{name} must be .* got"):
        rheology(**{name: value})


@pytest.mark.parametrize("u", [0.5, -0.5, -0.03])
@pytest.mark.parametrize("n", [16, 100])
def test_growth_of_the_toy_system_is_that_of_its_own_symbol(u, n):
    answer, toy = pde(TOY, f"u={u} v_xx=0.3 eps=0.01", n=n), Toy(0.5, 0.01)
    exact = np.linalg.eigvals(toy.symbol(XI, u, 0.3)).real.max(axis=-1)
    assert np.allclose(answer.rate, exact, rtol=1e-8, atol=1e-9)
    symbol = toy.symbol(answer.grid_xi, u, 0.3, multiplier=Grid(n).multiplier)
    assert np.allclose(answer.grid_rate, np.linalg.eigvals(symbol).real.max(axis=-1), rtol=1e-8, atol=1e-9)
    assert answer.grid_xi[-1] == pytest.approx(n / 2)
    assert answer.verdict.startswith("Ill posed" if u < 0 else "Well posed")


@pytest.mark.parametrize(
    ("text", "rate"),
    [
        ("u_t = u_xxx - u_xx", lambda q, s: q),
        ("u_t = -u_xx - u_xxxx", lambda q, s: q - q**2),
        ("u_tt = -u_xxxx", lambda q, s: 0 * q),
        ("u_tt = -u_xx", lambda q, s: np.sqrt(q)),
        ("u_t = -i*u_xxx", lambda q, s: np.abs(s) * q),  # grows for xi < 0 only: both signs are asked
    ],
)
def test_growth_of_scalar_equations_in_closed_form(text, rate):
    answer, h = pde(text, "", n=40), 2 * np.pi / 40
    assert np.allclose(answer.rate, rate(XI**2, XI), rtol=1e-9, atol=1e-9)
    q, s = (2 / h * np.sin(answer.grid_xi * h / 2)) ** 2, np.sin(answer.grid_xi * h) / h
    assert np.allclose(answer.grid_rate, rate(q, s), rtol=1e-9, atol=1e-9)


def test_two_space_variables_take_the_best_direction():
    answer = pde("u_t = u_xx - 2*u_yy", "")
    assert np.allclose(answer.rate, 2 * XI**2, rtol=1e-12)
    assert answer.found.direction == pytest.approx((0, 1), abs=1e-6)


def test_what_a_grid_makes_of_it_is_said_in_numbers():
    assert f"e^({(64 / np.pi) ** 2:.3g} t)" in pde("u_t = -u_xx", "").verdict
    assert f"e^({(128 / np.pi) ** 2:.3g} t)" in pde("u_t = -u_xx", "").verdict
    hidden = pde(TOY, "u=-0.5 v_xx=0 eps=0.01", n=16)  # grows where 0.01 0.5 q > 1, q < (16/pi)^2 = 25.9
    assert "too coarse" in hidden.verdict
    assert hidden.grid_rate.max() <= 0 < hidden.rate.max()
    full, maximal = (pde("u_t = u_xxx - u_xx", "", order) for order in ("full", "maximal"))
    assert (full.found.kind, maximal.found.kind) == ("ill-posed", "well-posed")
    assert pde("u_tt = u_xx", "").found == verdict_of("u_tt = u_xx")


def test_values_left_out_are_named():
    with pytest.raises(ValueError, match=r"at must also give a value to eps, u, v_xx, as in eps=1, got ''"):
        pde(TOY, "")
    with pytest.raises(ValueError, match="'zeta' has a value but does not occur"):
        pde("u_t = u_xx", "zeta=3")
    assert read_values(" u = -0.5\teps=1e-2 ") == {"u": -0.5, "eps": 0.01}


@pytest.mark.parametrize(
    "text",
    [
        "",
        "u",
        "u_t = ",
        "u_t = $",
        "((((",
        "u_t = u_xx, 3",
        "u_x = 0",
        "u = u_zz",
        "__import__('os')",
        "中_t=1/0",
    ],
)
@pytest.mark.parametrize("at", ["", "u=1=2", "u", "=3", "u=1 u=2", "u=nan", "u=1e999", "\\"])
def test_texts_that_make_no_sense_are_answered_in_one_line(text, at):
    with pytest.raises(ValueError, match=r"\A[^\n]+\Z"):
        pde(text, at)


@pytest.mark.parametrize(("name", "value"), [("n", 3), ("n", 10**9), ("order", "some")])
def test_pde_names_what_is_wrong(name, value):
    with pytest.raises(ValueError, match=rf"{name} must be .* got"):
        pde(**{name: value})
    with pytest.raises(TypeError, match="at must be a text"):
        pde(at=None)
