"""Guards sentences of the paper that no other test shows, in its order: each against a second route."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from primer import Seed, Toy, ftcs
from primer import verdict as verdict_of
from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    Ansatz,
    BaseState,
    Compaction,
    Coulomb,
    Friction,
    coefficients,
    conditions,
    critical_state,
    proof,
    verdict,
)
from primer.granular.dispersion import growth_rate, growth_rates
from primer.granular.linearisation import Coefficients, reduced
from primer.problems.heat import abs_sin_coefficients, abs_sin_log_norms
from primer.schemes.grid import Grid
from primer.study.refinement import refine
from primer.study.spectrum import growth

BEADS, PACKING = GLASS_BEADS.friction, EXAMPLE_COMPACTION
LAW = CIDR(BEADS, PACKING)
STATE = BaseState(0.3, 0.56, 0.2, d=0.7, rho=1.7)


def deviator(psi):
    """tau/||tau|| of (interpret-psi)."""
    return -np.array([[math.cos(2 * psi), math.sin(2 * psi)], [math.sin(2 * psi), -math.cos(2 * psi)]])


def norm(T):
    """(dfn-norm)."""
    return math.sqrt((T * T).sum() / 2)


def random_flow(random):
    """(N, e): D/||D|| of a flow in space, with N_ij N_ij = 2 and no trace, and a unit vector."""
    D = random.normal(size=(3, 3))
    D = D + D.T - 2 / 3 * np.trace(D) * np.eye(3)
    e = random.normal(size=3)
    return D / norm(D), e / np.linalg.norm(e)


def leading_matrix(N, e, c):
    """V of rho phi lambda u = -|xi|^2 V u: its three terms, for B = C."""
    q = N @ e
    b = e - c.B * q
    return c.A * np.outer(q, q) + np.outer(b, b) / c.Gamma + c.t * (np.eye(3) + np.outer(e, e) / 3 - np.outer(q, q))


# Section 1: what is anticipated


def test_in_three_dimensions_the_leading_matrix_is_positive_definite():
    """Its formula against differences of the stress -p + Y N, with p from div u = 2 f ||D||; then at random."""
    random = np.random.default_rng(7)
    c, phi, d, rho = coefficients(LAW, STATE), STATE.phi, STATE.d, STATE.rho

    def stress(gradient):
        D = (gradient + gradient.T) / 2
        expansion = np.trace(D)
        D = D - expansion / 3 * np.eye(3)
        size = norm(D)

        def off(p):
            return LAW.f(p, phi, 2 * d * size / math.sqrt(p / rho)) - expansion / (2 * size)

        p = brentq(off, 0.5 * STATE.p, 2 * STATE.p, xtol=1e-15, rtol=1e-14)
        return -p * np.eye(3) + LAW.Y(p, phi, 2 * d * size / math.sqrt(p / rho)) * D / size

    for _ in range(4):
        N, e = random_flow(random)
        base = c.D * N + 2 * LAW.f(STATE.p, phi, STATE.I) * c.D / 3 * np.eye(3)
        h = 1e-5 * c.D
        V = np.empty((3, 3))
        for k in range(3):
            step = h * np.outer(np.eye(3)[k], e)
            V[:, k] = -(stress(base - step) - stress(base + step)) @ e / (2 * h)
        np.testing.assert_allclose(V, leading_matrix(N, e, c), rtol=1e-6, atol=1e-6 * np.abs(V).max())
    least = []
    for _ in range(20_000):
        A, Gamma, t = 10 ** random.uniform(-3, 3, 3)
        some = replace(c, A=A, B=random.uniform(-2, 2), Gamma=Gamma, t=t)
        V = leading_matrix(*random_flow(random), some)
        least.append(np.linalg.eigvalsh(V)[0] / np.linalg.eigvalsh(V)[-1])
    assert min(least) > -1e-13
    assert np.quantile(least, 0.001) > 0


# Section 2: constitutive relations


@pytest.mark.parametrize("seed", range(5))
def test_the_major_stress_axis_carries_p_plus_tau(seed):
    """Figure 1a and (interpret-psi): sigma = -p + tau has the eigenvalues -p -+ ||tau||, the first along psi."""
    p, tau, psi = np.random.default_rng(seed).uniform(0.1, 2, 3)
    sigma = -p * np.eye(2) + tau * deviator(psi)
    assert norm(sigma + p * np.eye(2)) == pytest.approx(tau)
    np.testing.assert_allclose(np.linalg.eigvalsh(sigma), [-p - tau, -p + tau])
    axis = np.array([math.cos(psi), math.sin(psi)])
    np.testing.assert_allclose(sigma @ axis, -(p + tau) * axis, atol=1e-14)


@pytest.mark.parametrize("seed", range(5))
def test_two_ways_to_say_that_stress_and_strain_rate_are_aligned(seed):
    """(align-coulomb) is (align-CSSM) with (align-ineq); without the inequality D may be opposite to tau."""
    grad = np.random.default_rng(seed).normal(size=(2, 2))  # grad[i, j] = d_j u_i
    D = (grad + grad.T) / 2 - np.trace(grad) / 2 * np.eye(2)
    stretch, shear = grad[0, 0] - grad[1, 1], grad[0, 1] + grad[1, 0]
    np.testing.assert_allclose(D, [[stretch / 2, shear / 2], [shear / 2, -stretch / 2]])  # (dev-strain-rate)
    psi = math.atan2(-shear, -stretch) / 2
    for angle, sign in ((psi, 1), (psi + math.pi / 2, -1)):
        np.testing.assert_allclose(D / norm(D), sign * deviator(angle), atol=1e-14)
        assert shear * math.cos(2 * angle) - stretch * math.sin(2 * angle) == pytest.approx(0, abs=1e-14)
        assert bool(stretch * math.cos(2 * angle) <= 0) is (sign == 1)
        assert bool(shear * math.sin(2 * angle) <= 0) is (sign == 1)
    np.testing.assert_allclose([stretch, shear], -2 * norm(D) * np.array([math.cos(2 * psi), math.sin(2 * psi)]))


def test_friction_rises_and_is_concave():
    I, step = np.logspace(-4, 3, 30), 1e-3
    slope = (BEADS.mu(I * (1 + step)) - BEADS.mu(I * (1 - step))) / (2 * step * I)
    bend = (BEADS.dmu(I * (1 + step)) - BEADS.dmu(I * (1 - step))) / (2 * step * I)
    np.testing.assert_allclose(BEADS.dmu(I), slope, rtol=1e-5)
    np.testing.assert_allclose(BEADS.ddmu(I), bend, rtol=1e-5)
    assert (slope > 0).all()
    assert (bend < 0).all()


def test_yield_loci_are_nested_and_convex():
    """Figure 2b: at fixed I each curve Y(p) bends down, and a denser packing's lies outside."""
    phi, s = np.array([[0.52], [0.55], [0.58]]), np.linspace(0, 1, 50)[1:-1]
    for law in (LAW, CSSM(0.4, PACKING)):
        Y = law.Y(s * law.p_max(phi, 0.1), phi, 0.1)
        assert (np.diff(Y, 2, axis=1) < 0).all()
        p = s * law.p_max(phi[0], 0.1)
        assert (np.diff(law.Y(p, phi, 0.1), axis=0) > 0).all()


def slopes(f, values):
    """Central differences of f in each of its arguments."""
    out = []
    for j, value in enumerate(values):
        h = 1e-6 * abs(value)
        ends = [f(*(v + s * h * (i == j) for i, v in enumerate(values))) for s in (1, -1)]
        out.append((np.array(ends[0]) - np.array(ends[1])) / (2 * h))
    return np.transpose(out)


def test_the_flow_rule_gives_the_pressure_and_with_it_the_viscous_form():
    """Section 2.4: eliminating p from the equations of motion and linearising gives the same 3 x 3 matrix as (e33)."""
    s = STATE

    def inertial(p, D):
        return 2 * s.d * D / math.sqrt(p / s.rho)

    def excess(p, phi, D, div):
        return LAW.f(p, phi, inertial(p, D)) - div / (2 * D)

    def stresses(phi, D, div):  # T and P of (cons-mom-no-expl-stress)
        p = brentq(excess, s.p / 3, 3 * s.p, (phi, D, div), xtol=1e-15, rtol=1e-15)
        return LAW.Y(p, phi, inertial(p, D)), p

    div, D = float(s.div_u(LAW)), float(s.D)
    (along_p, *_) = slopes(lambda p: [excess(p, s.phi, D, div)], [s.p])[0]
    assert along_p == pytest.approx(conditions(LAW, s).slope, rel=1e-7)  # (partial-der-for-IFT), negative by (b)
    T, p = stresses(s.phi, D, div)
    assert p == pytest.approx(s.p, rel=1e-12)
    (T_phi, T_D, T_div), (P_phi, P_D, P_div) = slopes(stresses, [s.phi, D, div])
    x, y = 1.3, -0.7
    hat_D, hat_div = -0.5j * np.array([x, -y, 0]), 1j * np.array([x, y, 0])  # on (u_1, u_2, phi); (15b)
    hat_phi = np.array([0, 0, 1])
    hat_T, hat_P = (a * hat_phi + b * hat_D + c * hat_div for a, b, c in ((T_phi, T_D, T_div), (P_phi, P_D, P_div)))
    shear = T / D * 0.5j * np.array([y, x, 0])
    force = [1j * x * (-hat_T - hat_P) + 1j * y * shear, 1j * x * shear + 1j * y * (hat_T - hat_P)]
    P = -np.array([force[0] / (s.rho * s.phi), force[1] / (s.rho * s.phi), -s.phi * hat_div])
    np.testing.assert_allclose(P, reduced(coefficients(LAW, s), np.array([x, y])), rtol=1e-6, atol=1e-9)


def test_the_strain_rate_expands_as_in_15b():
    base, hat = np.array([-0.3, 0.3]), np.random.default_rng(0).normal(size=3)

    def D(e):
        stretch = base[0] - base[1] + e * (hat[0] - hat[1])
        return math.hypot(stretch, e * hat[2]) / 2

    left = [abs(D(e) - D(0) + e * (hat[0] - hat[1]) / 2) for e in (1e-3, 5e-4)]
    assert left[0] / left[1] == pytest.approx(4, rel=0.01)  # the rest is of second order


# Section 2.5: Lemmas 1 to 3


@pytest.mark.parametrize("I", [0.01, 0.279, 3.0])
def test_the_integrals_in_the_proof_of_lemma_1(I):
    first = quad(lambda y: 2.5 * BEADS.mu(y**2.5), 0, I**0.4)[0]  # s = y^{5/2}: no singularity left
    second = quad(lambda s: s**0.4 * BEADS.dmu(s), 0, I)[0]
    assert I**0.4 * BEADS.alpha(I) == pytest.approx(0.8 * (first + second), rel=1e-9)
    assert BEADS.alpha(I) == pytest.approx(0.8 * BEADS.mu(I) + 0.48 * I**-0.4 * first, rel=1e-9)
    assert BEADS.beta(I) == pytest.approx(-0.4 * BEADS.mu(I) + 0.96 * I**-0.4 * first, rel=1e-9)


def test_lemma_1_needs_regularity_at_rest():
    """alpha + k I^{-2/5} meets both conditions of Lemma 1 as well, and is ill posed at small I."""
    k, state = 1e-3, BaseState(0.3, 0.55, 1e-4)
    law = Ansatz(
        lambda I: BEADS.alpha(I) + k * I**-0.4,
        lambda I: BEADS.dalpha(I) - 0.4 * k * I**-1.4,
        lambda I: BEADS.beta(I) + 2 * k * I**-0.4,
        lambda I: BEADS.dbeta(I) - 0.8 * k * I**-1.4,
        PACKING,
    )
    assert law.a(state.I) - law.b(state.I) / 2 == pytest.approx(BEADS.mu(state.I), rel=1e-14)
    assert conditions(law, state).equality
    assert not conditions(law, state).a
    assert (verdict(law, state).kind, verdict(LAW, state).kind) == ("ill-posed", "well-posed")


def test_the_yield_condition_gives_phi_and_the_flow_rule_its_incompressible_form():
    """(phi-of-tau), and (flow-rule-form-for-limit): 2 f = 4 (tau/p - mu)."""
    p, I = np.array([0.05, 0.2, 0.6]), np.array([1e-3, 0.1, 5.0])
    tau = LAW.Y(p, 0.56, I)
    np.testing.assert_allclose(PACKING.phi(p**2 / (BEADS.alpha(I) * p - tau)), 0.56, rtol=1e-12)
    np.testing.assert_allclose(2 * LAW.f(p, 0.56, I), 4 * (tau / p - BEADS.mu(I)), rtol=1e-12, atol=1e-13)


def test_without_rate_dependence_cidr_is_cssm_and_its_limit_is_coulomb():
    still = Friction(lambda I: 0.4 + 0 * I, lambda I: 0 * I)
    for state in (BaseState(0.2, 0.55, 0.1), BaseState(0.6, 0.57, 2.0)):
        a, b = coefficients(CIDR(still, PACKING), state), coefficients(CSSM(0.4, PACKING), state)
        for name in ("A", "B", "C", "Gamma", "t", "Y_phi", "f_phi"):
            assert getattr(a, name) == pytest.approx(getattr(b, name), rel=1e-12, abs=1e-14), name
        assert b.B == b.C  # normality (flow-rule-CSSM) is (Cmu-well-posed-cond)
    law = CSSM(0.4, Compaction(0.55, 1e-7, 1.0))
    state = critical_state(law, 0.55 + 5e-8, 0.1)
    dry = growth_rate(coefficients(Coulomb(0.4), state), 1.0, -0.2)
    c = coefficients(law, state)
    assert proof.lemma_3(c, 1.0, -0.2) == pytest.approx(dry, rel=1e-6)
    assert np.abs(growth_rates(c, 1.0, -0.2) - dry).min() < 1e-4 * dry


# Sections 3 and 4


def test_the_theorem_needs_a_positive_yield_stress():
    """Beyond p = alpha C the equality, (a) and (b) still hold, but Y < 0 and short waves grow like |xi|^2."""
    phi, I, D = 0.55, 0.1, 1.0
    p = 1.05 * LAW.p_max(phi, I)
    Y, Y_p, Y_I = LAW.Y(p, phi, I), LAW.Y_p(p, phi, I), LAW.Y_I(p, phi, I)
    f, f_p, f_I = LAW.f(p, phi, I), LAW.f_p(p, phi, I), LAW.f_I(p, phi, I)
    B, slope = Y_p - I / (2 * p) * Y_I, f_p - I / (2 * p) * f_I
    assert pytest.approx(f + I * f_I, rel=1e-12) == B
    assert Y_I > 0 > slope
    assert Y < 0
    partials = {"Y_phi": LAW.Y_phi(p, phi, I), "f_phi": LAW.f_phi(p, phi, I)}
    c = Coefficients(I * Y_I / (2 * D), B, B, -2 * D * slope, Y / (2 * D), Y, **partials, D=D, phi=phi, rho=1.0)
    angle = np.linspace(0, np.pi, 181)
    for k in (1e3, 1e6):
        P = reduced(c, k * np.stack([np.cos(angle), np.sin(angle)]))
        assert np.linalg.eigvals(-P).real.max() > 0.01 * k**2
    with pytest.raises(ValueError, match="p must be <"):
        coefficients(LAW, BaseState(p, phi, I))


@pytest.mark.parametrize("p", [0.1, 0.3, 0.4])
def test_cssm_is_bounded_in_every_fixed_direction_but_e44(p):
    law = CSSM(0.4, PACKING)
    c = coefficients(law, BaseState(p, 0.55, 0.1))
    x = np.linspace(-1, 1, 41)
    x = x[np.abs(x + c.B) > 0.04]
    near, far = (np.array([growth_rate(c, k, value) for value in x]) for k in (1e8, 1e10))
    np.testing.assert_allclose(near, far, rtol=1e-3, atol=1e-6)


# Appendix 1


@pytest.mark.parametrize(("p", "sign"), [(0.2, -1), (0.6, 1)])
def test_uniform_flow_of_a_soil_ends_at_the_critical_state(p, sign):
    """From B of Figure 2b (dilating) and from A (contracting), marched as d phi/dt = -phi div u at fixed p, ||D||."""
    law = CSSM(0.4, PACKING)
    start = 0.55
    assert -np.sign(law.f(p, start, 0.1)) == sign  # the sign of d phi/dt
    for eps in (0.1, 0.001):
        soil = CSSM(0.4, Compaction(0.5, eps, 1.0))
        first = 0.5 + eps / 2
        steps = {"first_step": 1e-3 * eps, "rtol": 1e-9, "atol": 1e-10 * eps}
        phi = solve_ivp(lambda t, y, s=soil: -y * 2 * s.f(p, y, 0.1), (0, 600 * eps), [first], **steps).y[0]
        tau = soil.Y(p, phi, 0.1)
        assert (sign * np.diff(tau) > -1e-5).all()  # stronger from A, weaker from B
        assert tau[-1] == pytest.approx(0.4 * p, rel=1e-6)  # (crit-state-line)
        assert abs(phi[-1] - first) == pytest.approx(eps * abs(PACKING.phi(p / 0.4) - start) / 0.1, rel=1e-5)


def test_the_soils_yield_stress_is_a_function_of_phi():
    """Appendix 1 prints Y(p, tau) once: at one p, two solids fractions have two yield stresses."""
    law = CSSM(0.4, PACKING)
    Y = law.Y(0.2, np.array([0.53, 0.57]), 0.1)
    np.testing.assert_allclose(Y, [(0.8 - 0.2 / PACKING.C(phi)) * 0.2 for phi in (0.53, 0.57)], rtol=1e-14)
    assert Y[1] > 1.2 * Y[0]


# Appendix 2


def test_small_in_k_derivatives_and_large_at_once():
    """|xi|^-p sin(xi x): its k-th derivative has the size |xi|^{k-p}, and 0.01 later it is large all the same."""
    x = np.linspace(-np.pi, np.pi, 100001)
    for k, p in ((0, 1), (2, 3), (4, 5)):
        sizes = [np.abs(xi**-p * xi**k * np.sin(xi * x + k * np.pi / 2)).max() for xi in (8.0, 16.0, 32.0)]
        np.testing.assert_allclose(np.divide(sizes[1:], sizes[:-1]), 2.0 ** (k - p), rtol=1e-5)
        assert 64.0**-p * math.exp(64**2 * 0.01) > 1e8


def test_toy_eigenvectors_are_complex():
    """The eigenvectors of (toy-mat) lie in C^2 and not, as printed, in R^2: no multiple of one is real."""
    lam, vectors = np.linalg.eig(Toy(1.0, 0.01).symbol(7.0, -0.5, 0.3))
    ratio = vectors[1] / vectors[0]
    np.testing.assert_allclose(ratio, lam / 7j, rtol=1e-12)  # u_t = v_x
    assert (np.abs(ratio.imag) > 0.05).all()


def test_toy_eigenvalues_to_the_order_they_hold():
    """lambda_1 = -eps u xi^2 - 1 + 1/(eps u) - i v_xx/(u xi) + O(xi^-2), and lambda_2 = -1/(eps u) + i v_xx/(u xi)."""
    eps, u, v_xx = 0.3, -0.5, 0.7
    rest = []
    for xi in (1e2, 1e3):
        fast, slow = sorted(np.linalg.eigvals(Toy(1.0, eps).symbol(xi, u, v_xx)), key=abs, reverse=True)
        turn = 1j * v_xx / (u * xi)
        assert fast * slow == pytest.approx(xi**2 - 1j * eps * xi * v_xx, rel=1e-9)  # det S
        assert slow.imag == pytest.approx(turn.imag, rel=0.05)  # no better than O(1/xi)
        rest.append([abs(fast - (-eps * u * xi**2 - 1 + 1 / (eps * u) - turn)), abs(slow + 1 / (eps * u) - turn)])
    np.testing.assert_allclose(np.divide(*rest), 100, rtol=0.05)


@pytest.mark.parametrize(("p", "k"), [(1, 1), (3, 3), (0.5, 1), (1.5, 2), (2.5, 3), (1, 2), (3, 4)])
def test_derivatives_of_abs_sin_are_square_integrable_below_p_plus_a_half_and_not_at_it(p, k):
    """sum n^{2k} |c_n|^2 for |sin x|^p: convergent for k < p + 1/2, and not even at k = p + 1/2."""
    c = abs_sin_coefficients(p, 2**16)
    n = 2 * np.arange(c.size)
    partial = np.cumsum(n ** (2.0 * k) * c**2)
    ends = partial[[2**m for m in range(12, 17)]]
    steps = np.diff(ends)
    growth = 2.0 ** (2 * k - 2 * p - 1)  # from one octave to the next
    np.testing.assert_allclose(steps[1:] / steps[:-1], growth, rtol=1e-2)
    assert (growth < 1) is (k < p + 0.5)


@pytest.mark.parametrize("p", [1, 2, 3.5])
def test_parseval_for_abs_sin(p):
    """(L2norm-sln) at t = 0: the sum of the squares is the mean of |sin x|^{2p}."""
    mean = quad(lambda x: math.sin(x) ** (2 * p), 0, math.pi)[0] / math.pi
    assert math.exp(abs_sin_log_norms(p, 0.0, 4000)[-1]) == pytest.approx(mean, rel=1e-9)


def test_a_well_posed_steady_state_may_be_reached_through_u_below_zero():
    """For 1 < a < 1.191 the steady state is positive but the transient is not."""
    for a, dips in ((1.1, True), (1.25, False)):
        run = ftcs(Toy(a), 60, 1e-3, 5.0)
        assert (run.t_first_negative is not None) is dips
        assert Toy(a).steady(run.x)[0].min() > 0


@pytest.mark.slow
def test_every_grid_from_64_points_on_sees_it_and_no_coarser_one_does():
    """About the discrete steady state of a = 0.5."""
    assert [n for n in range(4, 201) if growth(Toy(0.5), n) > 1e-9] == list(range(64, 201))


def test_finer_is_sooner():
    """The same seed, 10^-6 of the mode below each grid's shortest: the blow-up comes sooner on each finer grid."""
    times = refine(Toy(0.5), (80, 100, 150), 1e-3, seed=lambda n: Seed(n // 2 - 1, 1e-6), t_end=30.0).t_blow_up
    assert (np.diff(times) < -2).any()
    assert (np.diff(times) < -0.5).all()
    assert np.isfinite(times).all()


def test_an_exceptional_example_frozen_ill_posed_and_well_posed():
    """w_t = i w_xx + i beta w_x, beta = 3 cos x: the verdict at a point, the change of unknown, and differences."""
    real = "p_t = -q_xx - b*q_x; q_t = p_xx + b*p_x"  # w = p + i q
    frozen = verdict_of(real, b=3.0)
    assert (frozen.kind, frozen.exponent) == ("ill-posed", 1)
    assert frozen.coefficient == pytest.approx(3)

    def largest(n, mean=0.0):
        grid = Grid(n)
        first, second = (grid.derivative(np.eye(n), m).T for m in (1, 2))
        return np.linalg.eigvals(1j * second + 1j * (3 * np.cos(grid.x) + mean)[:, None] * first).real.max()

    for n in (16, 32, 64, 128):  # 3h/2 < 1
        assert abs(largest(n)) < 1e-6 * n
        assert largest(n, mean=1.0) > 0.15 * n**0.5
    # w = z e^{-3 sin(x)/2} makes it z_t = i z_xx - i (beta'/2 + beta^2/4) z: Schroedinger's equation, a real potential.
    x, k = np.linspace(-3, 3, 7), 5
    beta, bend = 3 * np.cos(x), -3 * np.sin(x)
    w_x = 1j * k - beta / 2  # over w, as z = e^{ikx}
    np.testing.assert_allclose(
        1j * (w_x**2 - bend / 2) + 1j * beta * w_x, -1j * (k**2 + bend / 2 + beta**2 / 4), atol=1e-12
    )
