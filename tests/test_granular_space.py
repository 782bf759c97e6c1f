"""Guards three dimensions: the stress differentiated, a generalised eigenvalue problem, against the closed forms."""

import numpy as np
import pytest
from scipy.linalg import eigvals

from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    BaseState,
    Coulomb,
    IncompressibleMuI,
    coefficients,
    critical_state,
    growth_limit,
    verdict,
)
from primer.granular.linearisation import Coefficients
from primer.granular.space import growth_rate, leading, principal

BEADS = GLASS_BEADS.friction
LAWS = {
    "cidr": CIDR(BEADS, EXAMPLE_COMPACTION),
    "cssm": CSSM(0.45, EXAMPLE_COMPACTION),
    "mui": IncompressibleMuI(BEADS),
    "coulomb": Coulomb(0.5),
}


def pencil(law, p, phi, I, lode, e, k):
    """(S, E) in (u, phi, p), nothing typed but the equations: stress and flow rule by central differences."""
    D = I * np.sqrt(p) / 2
    angles = lode + np.array([-2, 2, 0]) * np.pi / 3
    D0 = np.diag(2 / np.sqrt(3) * np.sin(angles)) * D

    def response(strain, phi, p):
        dev = strain - np.eye(3) * np.trace(strain) / 3
        size = np.sqrt((dev * dev).sum() / 2)
        I = 2 * size / np.sqrt(p)
        stress = -p * np.eye(3) + law.Y(p, phi, I) * dev / size
        return stress, np.trace(strain) - 2 * law.f(p, phi, I) * size

    def slope(strain=0, dphi=0, dp=0):
        h = 1e-6
        up, down = (response(D0 + s * h * strain, phi + s * h * dphi, p + s * h * dp) for s in (1, -1))
        return [(a - b) / (2 * h) for a, b in zip(up, down, strict=True)]

    base = np.trace(D0)
    assert abs(base) < 1e-12
    S = np.zeros((5, 5), complex)
    for j in range(3):
        u = np.eye(3)[j]
        stress, rule = slope(strain=(np.outer(e, u) + np.outer(u, e)) / 2)
        S[:3, j], S[4, j] = k * k * stress @ e, 1j * k * rule
        S[3, j] = 1j * k * phi * u @ e
    for column, change in ((3, {"dphi": 1.0}), (4, {"dp": 1.0})):
        stress, rule = slope(**change)
        S[:3, column], S[4, column] = -1j * k * stress @ e, rule
    return S, np.diag([phi, phi, phi, 1.0, 0.0])


def oracle(law, p, phi, I, lode, e, k):
    S, E = pencil(law, p, phi, I, lode, e, k)
    if getattr(law, "incompressible", False):  # phi is a constant
        keep = np.ix_([0, 1, 2, 4], [0, 1, 2, 4])
        S, E = S[keep], E[keep]
    alpha, beta = eigvals(-S, E, homogeneous_eigvals=True)
    finite = np.abs(beta) > 1e-6 * np.abs(alpha)
    return (alpha[finite] / beta[finite]).real.max()


def random_states(law, rng, size):
    I, phi = 10 ** rng.uniform(-3, 0.5, size), rng.uniform(0.51, 0.59, size)
    top = law.p_max(phi, I) if hasattr(law, "p_max") else 1.0
    return BaseState(p=rng.uniform(0.05, 0.95, size) * top, phi=phi, I=I), rng.uniform(-np.pi / 6, np.pi / 6, size)


def sphere(rng, size):
    e = rng.normal(size=(size, 3))
    e[: size // 2, rng.integers(3)] = 0
    return e / np.linalg.norm(e, axis=1)[:, None]


@pytest.mark.parametrize("name", LAWS)
def test_the_growth_of_random_states_is_that_of_the_differentiated_equations(name):
    law, rng = LAWS[name], np.random.default_rng(5)
    states, lodes = random_states(law, rng, 12)
    for j, lode in enumerate(lodes):
        p, phi, I = (float(getattr(states, n)[j]) for n in ("p", "phi", "I"))
        c = coefficients(law, BaseState(p, phi, I))
        for e in sphere(rng, 6):
            N = np.diag(principal(lode))
            k = 3.0
            expected = oracle(law, p, phi, I, lode, e, k)
            found = growth_rate(c, k, e @ N @ e, e @ N @ N @ e)
            assert found == pytest.approx(expected, rel=2e-4, abs=2e-4 * k * k * float(c.t) / phi)


@pytest.mark.parametrize("name", ["coulomb", "mui"])
def test_incompressible_laws_in_plane_strain_have_the_verdict_of_two_dimensions(name):
    states, _ = random_states(LAWS[name], np.random.default_rng(1), 200)
    two, three = verdict(LAWS[name], states), verdict(LAWS[name], states, dim=3)
    assert (two.kind == three.kind).all()
    ill = two.kind == "ill-posed"
    assert ill.any()
    np.testing.assert_allclose(three.coefficient[ill], two.coefficient[ill], rtol=1e-9)
    np.testing.assert_allclose(three.direction[:2, ill], two.direction[:, ill], atol=1e-6)


def test_without_rates_it_is_ill_posed_in_plane_strain_alone():
    soil = LAWS["cssm"]
    state = BaseState(p=0.2, phi=0.55, I=0.1)
    plane = -np.arcsin(soil.f(0.2, 0.55, 0.1) / np.sqrt(3))
    found = verdict(soil, state, dim=3, lode=plane)
    assert (found.kind, found.exponent) == ("ill-posed", 1)
    e, k, N = found.direction, 1e7, principal(plane)
    c = coefficients(soil, state)
    rate = growth_rate(c, k, np.square(e) @ N, np.square(e) @ N**2)
    assert rate == pytest.approx(found.coefficient * k, rel=1e-2)
    for lode in (0.0, plane + 0.01, plane - 0.01, 0.3):
        assert verdict(soil, state, dim=3, lode=lode).kind == "well-posed"
    contracting = BaseState(p=0.8, phi=0.55, I=0.1)
    assert np.isfinite(growth_limit(soil, contracting, dim=3))


def test_exactly_critical_it_grows_like_the_power_two_thirds():
    soil = LAWS["cssm"]
    found = verdict(soil, critical_state(soil, 0.55), dim=3)
    assert found.kind == "ill-posed"
    assert float(found.exponent) == pytest.approx(2 / 3)
    assert found.direction == pytest.approx((np.sqrt(0.5), np.sqrt(0.5), 0), abs=1e-6)


@pytest.mark.parametrize("name", LAWS)
def test_the_limit_is_the_largest_over_a_dense_sphere(name):
    law, rng = LAWS[name], np.random.default_rng(3)
    states, lodes = random_states(law, rng, 25)
    w = np.linspace(0, 1, 2001)
    sides = [np.insert(np.stack([w, 1 - w]), axis, 0, axis=0).T for axis in range(3)]
    e = np.concatenate([sphere(rng, 2000) ** 2, *sides])
    for j, lode in enumerate(lodes):
        state = BaseState(*(float(getattr(states, n)[j]) for n in ("p", "phi", "I")))
        c, N = coefficients(law, state), principal(lode)
        rate = growth_rate(c, 1e6, e @ N, e @ N**2).max()
        limit = growth_limit(law, state, dim=3, lode=lode)
        v = verdict(law, state, dim=3, lode=lode)
        if v.kind == "ill-posed":
            assert rate <= v.coefficient * 1e6 ** float(v.exponent) * (1 + 1e-6)
            if v.exponent == 2 and v.coefficient > 1e-6:
                assert rate > 0.5 * v.coefficient * 1e12
        else:
            if limit == -np.inf:
                assert rate < 0
                continue
            assert rate <= limit + 1e-6 * (1 + abs(limit))
            assert rate == pytest.approx(limit, rel=0.05, abs=0.02)


@pytest.mark.slow
def test_the_theorem_in_three_dimensions_at_100_000_random_states():
    law, rng = LAWS["cidr"], np.random.default_rng(21)
    states, lodes = random_states(law, rng, 100_000)
    assert np.isfinite(growth_limit(law, states, dim=3, lode=lodes)).all()
    n = 100_000
    one, zero = np.ones(n), np.zeros(n)
    A, G, t = (10 ** rng.uniform(-3, 2, n) for _ in range(3))
    B = rng.normal(size=n) * 2
    c = Coefficients(A, B, B, G, t, 2 * t, zero, zero, one, one, one)
    assert not leading(c, lodes).ill_posed.any()
    N, e = principal(lodes), sphere(rng, n).T
    q = N * e
    V = A * np.einsum("in,jn->ijn", q, q) + np.einsum("in,jn->ijn", e - B * q, e - B * q) / G
    V += t * (np.eye(3)[..., None] + np.einsum("in,jn->ijn", e, e) / 3 - np.einsum("in,jn->ijn", q, q))
    assert (np.linalg.eigvalsh(np.moveaxis(V, -1, 0)) > -1e-12 * np.abs(V).max(axis=(0, 1))[:, None]).all()


@pytest.mark.parametrize(
    ("options", "word"),
    [
        ({"dim": 4}, "dim"),
        ({"dim": 3, "lode": 1.0}, "lode"),
        ({"dim": 3, "lode": np.nan}, "lode"),
        ({"lode": 0.1}, "lode"),
    ],
)
def test_what_is_out_of_range_is_named(options, word):
    for ask in (verdict, growth_limit):
        with pytest.raises((ValueError, TypeError), match=word):
            ask(LAWS["cidr"], BaseState(0.2, 0.55, 0.1), **options)
    with pytest.raises(ValueError, match="p must be <"):
        verdict(LAWS["cidr"], BaseState(20.0, 0.55, 0.1), dim=3)
