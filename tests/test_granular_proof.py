"""Guards the proof's steps against matrices, the erratum in (42b), Lemmas 2 and 3, and the window about B = C."""

from dataclasses import replace

import numpy as np
import pytest

from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    BaseState,
    Compaction,
    Friction,
    IncompressibleMuI,
    coefficients,
    critical_state,
    growth_limit,
    incompressible_criterion,
    neutral_inertial_numbers,
    proof,
)
from primer.granular.dispersion import growth_rate, growth_rates
from primer.granular.fastest import fastest
from primer.granular.limits import leading
from primer.granular.linearisation import M, N, reduced

BEADS, PACKING = GLASS_BEADS.friction, EXAMPLE_COMPACTION
STATE = BaseState(0.3, 0.56, 0.2, d=0.7, rho=1.7)
ANGLE = np.linspace(0.01, 3.1, 60)
XI, X = np.stack([np.cos(ANGLE), np.sin(ANGLE)]), np.cos(2 * ANGLE)


def cross_terms(M, N):
    """chi of (42a)."""
    m11, m12, m21, m22 = np.moveaxis(M.reshape(-1, 4), 1, 0)
    n11, n12, n21, n22 = np.moveaxis(N.reshape(-1, 4), 1, 0)
    return m22 * n11 + m11 * n22 - m12 * n21 - m21 * n12


@pytest.mark.parametrize("kappa", [0.0, 0.3])
def test_determinants_and_traces_are_those_of_the_matrices(kappa):
    c = coefficients(CIDR(BEADS, PACKING), STATE)
    c = replace(c, C=c.B + kappa)
    m, n = M(c, XI), N(c, XI)
    np.testing.assert_allclose(np.linalg.det(m), 0, atol=1e-15)
    np.testing.assert_allclose(np.linalg.det(n), proof.det_N(c, X), rtol=1e-10, atol=1e-14)
    np.testing.assert_allclose(cross_terms(m, n), proof.chi(c, X), rtol=1e-12)
    np.testing.assert_allclose(np.linalg.det(m + n), proof.det_MN(c, X), rtol=1e-11)
    np.testing.assert_allclose(np.trace(m + n, axis1=-2, axis2=-1), proof.trace_MN(c, X), rtol=1e-13)


def test_42b_as_printed_is_wrong_where_it_matters():
    c = coefficients(CSSM(0.4, PACKING), BaseState(0.2, 0.55, 0.1))
    assert c.A == 0
    np.testing.assert_allclose(cross_terms(M(c, XI), N(c, XI)), 0, atol=1e-15)
    np.testing.assert_array_equal(proof.chi(c, X), 0)
    assert proof.chi_as_printed(c, X).min() > 0  # as printed, M + N would be positive definite and CSSM well posed


def test_the_lemma_holds_with_rate_dependence_and_fails_without():
    assert proof.is_positive_definite(coefficients(CIDR(BEADS, PACKING), STATE))
    assert not proof.is_positive_definite(coefficients(CSSM(0.4, PACKING), STATE))


def test_the_bad_directions_are_where_det_N_vanishes():
    c = coefficients(CSSM(0.4, PACKING), BaseState([0.1, 0.5], 0.55, 0.1))
    xi = proof.bad_directions(c)
    np.testing.assert_allclose((xi**2).sum(axis=0), 1, rtol=1e-15)
    np.testing.assert_allclose(xi[0, 0] / xi[1, 0], np.sqrt((1 - c.B) / (1 + c.B)), rtol=1e-14)
    np.testing.assert_allclose(np.linalg.det(N(c, xi)), 0, atol=1e-14)
    steep = coefficients(CIDR(BEADS, PACKING), BaseState(1e-3, 0.55, 1e3))
    assert steep.B > 1
    with pytest.raises(ValueError, match=r"\|B\| must be < 1"):
        proof.bad_directions(steep)


def test_eigenvalues_approach_those_of_the_comparison_problem_faster_than_the_paper_says():
    c = coefficients(CIDR(BEADS, PACKING), STATE)
    for x in (-0.6, 0.2, 0.9):
        gaps, third = [], []
        for k in (1e3, 1e4):
            lam = np.sort(growth_rates(c, k, x).real)
            gaps.append(np.abs(lam[1] - proof.Lambda(c, x)[0] * k**2))
            third.append(np.abs(lam[2] - proof.lambda_3(c, x)))
        assert gaps[1] == pytest.approx(gaps[0], rel=1e-2)  # O(1)
        assert third[0] / third[1] == pytest.approx(100, rel=0.1)  # O(|xi|^-2)


def test_Lambda_is_minus_the_eigenvalues_of_M_plus_N():
    c = coefficients(CIDR(BEADS, PACKING), STATE)
    exact = np.linalg.eigvalsh(M(c, XI) + N(c, XI)) / -c.density
    np.testing.assert_allclose(proof.Lambda(c, X), exact, rtol=1e-10)
    assert np.isrealobj(proof.Lambda(c, X))
    for x, xi in zip(X[::20], XI.T[::20], strict=True):
        nu = np.linalg.det(reduced(c, xi)).real  # det P
        L = proof.Lambda(c, x)
        assert proof.lambda_3(c, x) == pytest.approx(-nu / (L[0] * L[1]), rel=1e-9)


def test_positive_definite_is_what_the_eigenvalues_of_the_symmetric_matrices_say():
    """B = C leaves M + N symmetric: both eigenvalues positive in every direction, or not."""
    rng = np.random.default_rng(1)
    c = coefficients(CIDR(BEADS, PACKING), BaseState(np.full(300, 0.3), 0.56, 0.2))
    B, A, t, Gamma = rng.uniform(-1.5, 1.5, 300), rng.normal(size=300), rng.normal(size=300), rng.normal(size=300)
    c = replace(c, A=A, B=B, C=B, t=t, Gamma=Gamma)
    angle = np.linspace(0, np.pi, 721)
    xi = np.stack([np.cos(angle), np.sin(angle)])[..., None]
    least = np.linalg.eigvalsh(M(c, xi) + N(c, xi)).min(axis=(0, -1))
    says = proof.is_positive_definite(c)
    clear = np.abs(least) > 1e-4
    np.testing.assert_array_equal(says[clear], least[clear] > 0)
    assert 10 < says.sum() < 290


def test_Lambda_is_complex_where_the_matrix_has_no_real_eigenvalues():
    c = replace(coefficients(CIDR(BEADS, PACKING), STATE), B=2.0, C=0.0, t=0.1, A=0.2, Gamma=0.05)
    found = proof.Lambda(c, X)
    exact = np.linalg.eigvals(M(c, XI) + N(c, XI)) / -c.density
    for ours, theirs in zip(found.round(9), exact.round(9), strict=True):
        np.testing.assert_allclose(np.sort_complex(ours), np.sort_complex(theirs), atol=1e-8)
    assert np.iscomplexobj(found)
    many = coefficients(CIDR(BEADS, PACKING), BaseState([0.2, 0.3], 0.56, [0.2, 0.3]))
    both = proof.Lambda(many, X[:, None])
    assert both.shape == (60, 2, 2)
    one = coefficients(CIDR(BEADS, PACKING), BaseState(0.3, 0.56, 0.3))
    np.testing.assert_allclose(both[:, 1], proof.Lambda(one, X), rtol=1e-13)


def test_lemma_2_and_its_constants():
    I = np.logspace(-6, 6, 200)
    says = proof.lemma_2(BEADS, I)
    assert (says.dmu > 0).all()
    assert (says.alpha_ratio > 0).all()
    assert (says.beta_ratio > 0).all()
    assert says.alpha_ratio[0] == pytest.approx(0, abs=1e-5)
    np.testing.assert_allclose(says.alpha_ratio, BEADS.dalpha(I) / BEADS.dmu(I) - 8 / 7, atol=1e-14)
    np.testing.assert_allclose(says.beta_ratio, BEADS.dbeta(I) / BEADS.dmu(I) - 2 / 7, atol=1e-14)
    for name in ("dmu", "dalpha", "dbeta"):
        np.testing.assert_array_equal(getattr(says, name), getattr(BEADS, name)(I))
    convex = Friction(lambda I: 0.3 + 0.1 * I**4, lambda I: 0.4 * I**3)  # mu'' > 0: the premise fails
    assert proof.lemma_2(convex, 1.0).beta_ratio < 0


def test_lemma_3_for_growth_rates():
    """At a critical state and fixed wavevector, eps -> 0 gives the mu(I) growth; the cap rises like 1/eps."""
    I, z, k = 0.005, 0.5, 1.0  # ill posed as an incompressible law
    eps = np.array([1e-3, 1e-4, 1e-5, 1e-6])
    x = -0.2
    flat, caps = [], []
    for e in eps:
        packing = Compaction(0.55, e, 1.0)
        law = CIDR(BEADS, packing)
        state = critical_state(law, 0.55 + e * z, I)
        c = coefficients(law, state)
        inc = coefficients(IncompressibleMuI(BEADS), state)
        exact = growth_rate(inc, k, x)
        assert proof.lemma_3(c, k, x) == pytest.approx(exact, rel=1e-8)
        slow = growth_rates(c, k, x)
        flat.append(np.abs(slow - exact).min() / np.abs(exact))
        caps.append(growth_limit(law, state) * e)
    assert flat[-1] < 1e-2
    assert flat[2] / flat[3] == pytest.approx(10, rel=0.2)
    np.testing.assert_allclose(caps, caps[-1], rtol=2e-3)
    assert caps[-1] > 0


def test_the_incompressible_limit_is_ill_posed_where_the_criterion_says():
    low, high = neutral_inertial_numbers(BEADS)
    packing = Compaction(0.55, 1e-7, 1.0)
    law = CIDR(BEADS, packing)
    for I, sign in ((low * 0.8, 1), (low * 1.2, -1), (high * 0.8, -1), (high * 1.2, 1)):
        c = coefficients(law, critical_state(law, 0.55 + 5e-8, I))
        x = np.cos(np.linspace(0, np.pi, 400))
        assert np.sign(proof.lemma_3(c, 1.0, x).max()) == sign
        assert np.sign(incompressible_criterion(BEADS, I).growth) == sign


def test_the_window_about_the_equality():
    rng = np.random.default_rng(0)
    law = CIDR(BEADS, PACKING)
    phi, I = rng.uniform(0.51, 0.59, 400), 10 ** rng.uniform(-5, 1, 400)
    state = BaseState(law.p_max(phi, I) * rng.uniform(0.2, 0.95, 400), phi, I)
    c = coefficients(law, state)
    keep = np.abs(c.B) < 0.99
    c = coefficients(law, BaseState(state.p[keep], phi[keep], I[keep]))
    low, high = proof.kappa_window(c)
    assert (low < 0).all()
    assert (high > 0).all()
    for edge in (low, high):
        assert not leading(replace(c, C=c.B + edge * (1 - 1e-6))).ill_posed.any()
        assert leading(replace(c, C=c.B + edge * (1 + 1e-6))).ill_posed.all()
    wide = replace(c, C=c.B + high * 1.01)
    assert (fastest(wide, 1e6 * np.sqrt(c.density * c.Gamma * c.D))[0] > 0).all()


def test_the_window_by_bisection_where_the_minimum_is_at_an_end():
    """|B + reach| > 1: the determinant first vanishes at x = -1 or 1."""
    rng = np.random.default_rng(3)
    c = coefficients(CIDR(BEADS, PACKING), BaseState(np.full(200, 0.3), 0.56, 0.2))
    B, A, t, Gamma = rng.uniform(-0.95, 0.95, 200), *rng.uniform(0, 3, (3, 200))
    c = replace(c, A=A, B=B, t=t, Gamma=Gamma)
    c = replace(c, A=np.where(np.arange(200) % 20, c.A, c.t))  # t = A: the determinant is a line
    low, high = proof.kappa_window(c)
    x = np.linspace(-1, 1, 2001)[:, None]
    for edge, at_end in ((low, 0), (high, -1)):
        inner, outer = (proof.det_MN(replace(c, C=B + edge * f), x).min(axis=0) for f in (0.999, 1.001))
        assert (inner > 0).all()
        assert (outer < 0).all()
        lowest = proof.det_MN(replace(c, C=B + edge), x).argmin(axis=0)
        assert 20 < ((lowest == 0) | (lowest == 2000)).sum() < 190, at_end
    for wrong in ({"B": c.B * 0 + 1}, {"B": c.B * 0 - 1}, {"A": c.A - 3}, {"Gamma": 0 * c.Gamma}):
        with pytest.raises(ValueError, match=r"^the window needs \|B\| < 1, A >= 0 and Gamma > 0$"):
            proof.kappa_window(replace(c, **wrong))
    still = proof.kappa_window(replace(c, A=0 * c.A))
    np.testing.assert_array_equal(still, np.zeros((2, 200)))
    one = coefficients(CIDR(BEADS, PACKING), STATE)
    assert np.shape(proof.kappa_window(one)) == (2,)


def test_the_window_closes_without_rate_dependence():
    law = CIDR(BEADS, PACKING)
    I = np.array([1e-3, 1e-5, 1e-7])
    c = coefficients(law, BaseState(law.p_critical(0.55, I), 0.55, I))
    low, high = proof.kappa_window(c)
    np.testing.assert_allclose((high - low)[1:] / (high - low)[:-1], 0.1, rtol=0.05)  # like sqrt(A)
    with pytest.raises(ValueError, match="window needs"):
        proof.kappa_window(replace(c, A=-c.A))
