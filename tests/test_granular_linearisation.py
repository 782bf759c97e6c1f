"""Guards the pencil (e26), its reduction to 3 x 3 and the closed-form dispersion relation, each by a second route."""

from dataclasses import fields, replace

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

from primer import Pencil, growth, max_growth
from primer.analysis.eigen import finite_eigenvalues
from primer.analysis.puiseux import branches
from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    BaseState,
    Coulomb,
    IncompressibleMuI,
    coefficients,
    linearise,
    proof,
)
from primer.granular.dispersion import at, cubic, dispersion, growth_rate, growth_rates
from primer.granular.equations import derive
from primer.granular.fastest import fastest
from primer.granular.linearisation import M, N, V, mass, reduced, symbol

BEADS = GLASS_BEADS.friction
LAWS = [Coulomb(0.4), IncompressibleMuI(BEADS), CSSM(0.4, EXAMPLE_COMPACTION), CIDR(BEADS, EXAMPLE_COMPACTION)]
EVERY_LAW = pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
STATE = BaseState(p=0.3, phi=0.56, I=0.2, d=0.7, rho=1.7)


class Unaligned:
    """A made-up law with B != C and every partial derivative different from zero."""

    def Y(self, p, phi, I):
        return (0.5 + 0.3 * I) * p * phi**2

    def Y_p(self, p, phi, I):
        return (0.5 + 0.3 * I) * phi**2

    def Y_phi(self, p, phi, I):
        return 2 * (0.5 + 0.3 * I) * p * phi

    def Y_I(self, p, phi, I):
        return 0.3 * p * phi**2

    def f(self, p, phi, I):
        return 0.2 * I + phi - p

    def f_p(self, p, phi, I):
        return -1.0

    def f_phi(self, p, phi, I):
        return 1.0

    def f_I(self, p, phi, I):
        return 0.2


def random_cidr(n, seed, low=-5, high=3):
    """n random admissible states of CIDR."""
    rng = np.random.default_rng(seed)
    law = LAWS[3]
    phi, I = rng.uniform(0.501, 0.599, n), 10 ** rng.uniform(low, high, n)
    return law, BaseState(law.p_max(phi, I) * rng.uniform(1e-3, 0.999, n), phi, I)


@pytest.mark.parametrize("law", [*LAWS, Unaligned()], ids=lambda law: type(law).__name__)
def test_the_pencil_is_what_differentiating_the_equations_of_motion_gives(law):
    automatic, written = derive(law, STATE), linearise(law, STATE)
    xi = np.random.default_rng(0).normal(size=(2, 40))
    for ours, theirs in zip(written.matrices(xi), automatic.matrices(xi), strict=True):
        assert ours.shape == (40, written.size, written.size)
        np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-13)


@EVERY_LAW
def test_the_terms_of_lower_order_change_the_growth_by_a_bounded_amount(law):
    full, maximal = derive(law, STATE, order="full"), derive(law, STATE)
    angle = np.linspace(0.05, 3.0, 25)
    xi = np.stack([np.cos(angle), np.sin(angle)])
    change = [np.abs(growth(full, k * xi) - growth(maximal, k * xi)).max() for k in (1e2, 1e4, 1e6)]
    assert max(change) < 2 * STATE.D
    assert np.ptp(change) < 0.01 * STATE.D


@pytest.mark.parametrize("law", [*LAWS, Unaligned()], ids=lambda law: type(law).__name__)
def test_a_uniform_change_feels_only_the_base_flow(law):
    """xi = 0: what is left of the full equations is rho phi u.grad u*, phi div u*, and what f says of p and phi."""
    pencil, c = derive(law, STATE, order="full"), coefficients(law, STATE)
    S, E = pencil.matrices(np.zeros(2))
    spread = STATE.div_u(law) / 2
    expected = np.zeros((5, 5))
    expected[0, 0], expected[1, 1] = c.density * (spread - c.D), c.density * (spread + c.D)
    expected[2, 2] = 2 * spread
    expected[3, 2], expected[3, 3], expected[4, 4] = -2 * c.D * c.f_phi, c.Gamma, 4 * c.D
    if c.incompressible:
        expected = expected[[0, 1, 3, 4]][:, [0, 1, 3, 4]]
    np.testing.assert_allclose(S, expected, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(E, mass(c), rtol=1e-14)


def test_the_equations_are_derived_at_a_single_state_to_one_of_two_orders():
    with pytest.raises(ValueError, match=r"^order must be 'maximal' or 'full', got 'half'$"):
        derive(LAWS[0], STATE, order="half")
    for make in (derive, linearise):
        with pytest.raises(ValueError, match=r"^state must be a single state to make a pencil, got shape \(2,\)$"):
            make(LAWS[3], BaseState([0.1, 0.2], 0.55, 0.1))
    with pytest.raises(ValueError, match="yield stress"):
        derive(LAWS[3], BaseState(2.0, 0.55, 0.1))


def test_the_coefficients_of_the_linearised_equations_are_their_definitions():
    for law in (*LAWS, Unaligned()):
        p, phi, I = np.array([[0.3], [0.2]]), 0.56, np.array([0.1, 0.2, 0.3])
        state = BaseState(p, phi, I, d=0.7, rho=1.7)
        c, D = coefficients(law, state), I * np.sqrt(p / 1.7) / 1.4
        at = {name: getattr(law, name)(p, phi, I) for name in ("Y", "Y_p", "Y_phi", "Y_I", "f", "f_p", "f_phi", "f_I")}
        expected = {
            "A": I * at["Y_I"] / (2 * D),
            "B": at["Y_p"] - I / (2 * p) * at["Y_I"],
            "C": at["f"] + I * at["f_I"],
            "Gamma": -2 * D * (at["f_p"] - I / (2 * p) * at["f_I"]),
            "t": at["Y"] / (2 * D),
            "tau": at["Y"],
            "Y_phi": at["Y_phi"],
            "f_phi": at["f_phi"],
            "D": D,
            "phi": phi,
            "rho": 1.7,
            "density": 1.7 * phi,
        }
        for name, value in expected.items():
            np.testing.assert_allclose(getattr(c, name), np.broadcast_to(value, (2, 3)), rtol=1e-14, err_msg=name)
        assert c.incompressible == (law in LAWS[:2])
        one = coefficients(law, BaseState(0.2, phi, 0.3, d=0.7, rho=1.7))
        assert (one.A, one.B, one.Gamma) == pytest.approx((c.A[1, 2], c.B[1, 2], c.Gamma[1, 2]), rel=1e-14)
        assert np.shape(one.A) == ()


@pytest.mark.parametrize("law", [*LAWS, Unaligned()], ids=lambda law: type(law).__name__)
def test_matrices_of_many_states_and_wavevectors_are_those_of_each(law):
    states = BaseState(np.array([[0.3], [0.2]]), 0.56, np.array([0.1, 0.2, 0.3]))
    xi = np.random.default_rng(8).normal(size=(2, 4, 2, 3))
    c = coefficients(law, states)
    S, E = symbol(c, xi), mass(c)
    size = 4 if c.incompressible else 5
    assert S.shape == (4, 2, 3, size, size)
    assert E.shape == (2, 3, size, size)
    for i, j in ((0, 0), (1, 2)):
        one = coefficients(law, BaseState(states.p[i, 0], 0.56, states.I[j]))
        np.testing.assert_allclose(symbol(one, xi[:, 1, i, j]), S[1, i, j], rtol=1e-14)
        np.testing.assert_allclose(mass(one), E[i, j], rtol=1e-14)
        if not c.incompressible:
            for part in (reduced, M, N, V):
                np.testing.assert_allclose(part(one, xi[:, 1, i, j]), part(c, xi)[1, i, j], rtol=1e-13, atol=1e-15)
    for wrong, shape in ((1.0, "()"), (np.ones(3), "(3,)")):
        with pytest.raises(ValueError, match="xi must have shape") as error:
            symbol(c, wrong)
        assert str(error.value) == f"xi must have shape (2, ...), got shape {shape}"


def test_without_Gamma_no_pressure_can_be_eliminated():
    c = coefficients(LAWS[3], BaseState([0.2, 0.3], 0.55, 0.1))
    c = replace(c, Gamma=c.Gamma * [1, 0])
    said = "^Gamma must not be 0: the pressure of an incompressible law is not a function of the flow$"
    for part in (N, V, reduced):
        with pytest.raises(ValueError, match=said):
            part(c, np.ones(2))


def test_incompressible_pencils_have_four_unknowns_and_div_u_as_a_row():
    pencil = linearise(LAWS[0], STATE)
    S, E = pencil.matrices(np.array([0.3, 0.7]))
    np.testing.assert_allclose(S[2], [0.3j, 0.7j, 0, 0], rtol=1e-15)
    np.testing.assert_allclose(np.diag(E), [1.7 * 0.56, 1.7 * 0.56, 0, 0], rtol=1e-15)
    assert pencil.count == 1


@pytest.mark.parametrize("law", [LAWS[2], LAWS[3], Unaligned()], ids=lambda law: type(law).__name__)
def test_the_reduction_is_the_schur_complement(law):
    c = coefficients(law, STATE)
    xi = np.random.default_rng(1).normal(size=(2, 30))
    S, E = symbol(c, xi), mass(c)
    corner = S[:, :3, :3] - S[:, :3, 3:] @ np.linalg.solve(S[:, 3:, 3:], S[:, 3:, :3])
    np.testing.assert_allclose(reduced(c, xi), np.linalg.solve(E[:3, :3], corner), rtol=1e-12, atol=1e-12)


def test_M_N_and_V_are_as_printed():
    c = coefficients(LAWS[3], STATE)
    x, y = 0.6, -1.3
    B, G, t, D = c.B, c.Gamma, c.tau / (2 * c.D), c.D
    xi = np.array([x, y])
    np.testing.assert_allclose(M(c, xi), c.A * np.array([[x * x, -x * y], [-x * y, y * y]]), rtol=1e-13)
    off = ((1 - B**2) / G + t) * x * y
    printed = [[(1 + B) ** 2 / G * x**2 + t * y**2, off], [off, (1 - B) ** 2 / G * y**2 + t * x**2]]
    np.testing.assert_allclose(N(c, xi), printed, rtol=1e-13)
    g = 2 * D * c.f_phi / G
    np.testing.assert_allclose(V(c, xi), [(c.Y_phi + (1 + B) * g) * x, (-c.Y_phi + (1 - B) * g) * y], rtol=1e-13)


@pytest.mark.slow
def test_the_dispersion_relation_is_the_determinant_of_the_pencil():
    A, B, C, G, t, Y, f, D, phi, rho, lam, x1, x2 = sp.symbols("A B C Gamma t Y_phi f_phi D phi rho lam x1 x2")
    R = rho * phi
    S = sp.Matrix(
        [
            [A * x1**2, -A * x1 * x2, sp.I * Y * x1, (1 + B) * sp.I * x1, 4 * sp.I * t * D * x2],
            [-A * x1 * x2, A * x2**2, -sp.I * Y * x2, (1 - B) * sp.I * x2, 4 * sp.I * t * D * x1],
            [sp.I * phi * x1, sp.I * phi * x2, 0, 0, 0],
            [(1 + C) * sp.I * x1, (1 - C) * sp.I * x2, -2 * D * f, G, 0],
            [sp.I * x2, sp.I * x1, 0, 0, 4 * D],
        ]
    )
    determinant = (S + lam * sp.diag(R, R, 1, 0, 0)).det(method="berkowitz")
    from types import SimpleNamespace

    c = SimpleNamespace(A=A, B=B, C=C, Gamma=G, t=t, Y_phi=Y, f_phi=f, D=D)
    d, k2 = dispersion(c), x1**2 + x2**2
    x = (x1**2 - x2**2) / k2
    T, Delta, Sigma, N_ = (at(p, x) for p in (d.T, d.Delta, d.Sigma, d.N))
    ours = (
        G * lam**3 + k2 / R * T * lam**2 + ((k2 / R) ** 2 * Delta + k2 / rho * Sigma) * lam + phi * (k2 / R) ** 2 * N_
    )
    assert sp.simplify(determinant - 4 * D * R**2 * ours) == 0


def test_five_by_five_three_by_three_and_closed_form_agree_at_10_000_random_states():
    # At I = 1e-5 the entries of the 5 x 5 matrix, rounded, no longer hold nine digits of lambda_3.
    law, states = random_cidr(10_000, seed=2, low=-4, high=2)
    c = coefficients(law, states)
    rng = np.random.default_rng(3)
    k, angle = 10 ** rng.uniform(0, 6, 10_000), rng.uniform(0, np.pi, 10_000)
    xi = k * np.stack([np.cos(angle), np.sin(angle)])
    five = finite_eigenvalues(symbol(c, xi), mass(c).astype(complex), 3)
    three = finite_eigenvalues(reduced(c, xi), np.broadcast_to(np.eye(3, dtype=complex), (10_000, 3, 3)), 3)
    closed = growth_rates(c, k, np.cos(2 * angle))
    for other in (five, three):
        nearest = np.abs(other[:, None, :] - closed[:, :, None]).min(axis=2)
        assert (nearest / np.abs(closed)).max() < 1e-9


def test_the_growth_laws_at_infinity_agree_with_the_eigenvalues_and_with_the_newton_polygon():
    law, states = random_cidr(10_000, seed=4, low=-4, high=2)
    c = coefficients(law, states)
    x = np.random.default_rng(5).uniform(-1, 1, 10_000)
    # Corrections are O((k_v/k)^2) with k_v^2 = R ||D||/viscosity: far below the digits compared.
    k = 1e9 * np.sqrt(c.density * c.D * c.Gamma * proof.trace_MN(c, x) / at(dispersion(c).Delta, x))
    lam = growth_rates(c, k, x).real
    lam = np.take_along_axis(lam, np.argsort(np.abs(lam), axis=1), axis=1)
    ours = np.column_stack([proof.lambda_3(c, x), proof.Lambda(c, x) * k[:, None] ** 2])
    np.testing.assert_allclose(lam, ours, rtol=1e-9)
    for j in range(0, 10_000, 200):
        one = replace(c, **{f.name: getattr(c, f.name)[j] for f in fields(c) if f.name != "incompressible"})
        found = branches(polynomial(one, x[j]))
        assert [branch.law.exponent for branch in found if branch.law.coefficient < 0][-1] == 2
        theirs = sorted((abs(b.law.coefficient), float(b.law.exponent), b.law.coefficient) for b in found)
        expected = [proof.lambda_3(one, x[j]), *proof.Lambda(one, x[j])]
        np.testing.assert_allclose([v[2] for v in theirs], sorted(expected, key=abs), rtol=1e-9)


def polynomial(c, x):
    """The dispersion relation as {(power of lambda, power of k): coefficient}."""
    d, R = dispersion(c), c.density
    return {
        (3, 0): c.Gamma,
        (2, 2): at(d.T, x) / R,
        (1, 4): at(d.Delta, x) / R**2,
        (1, 2): at(d.Sigma, x) / c.rho,
        (0, 4): c.phi * at(d.N, x) / R**2,
    }


def test_closed_form_agrees_with_multiprecision_roots_for_every_law():
    for law in LAWS:
        c = coefficients(law, STATE)
        for k in (1e-4, 1.0, 1e3, 1e6, 1e12):
            for x in (-0.97, -0.3, 0.41, 1.0):
                c3, c2, c1, c0 = (mp.mpf(float(v)) for v in cubic(c, k, x))
                if law in LAWS[:2]:
                    exact = [-c1 / c2]
                else:
                    with mp.workdps(80):
                        exact = mp.polyroots([c3, c2, c1, c0], maxsteps=2000, extraprec=400)
                exact = sorted((complex(z) for z in exact), key=lambda z: -z.real)
                ours = growth_rates(c, k, x)
                np.testing.assert_allclose(ours.real, [z.real for z in exact], rtol=1e-12)
                assert growth_rate(c, k, x) == pytest.approx(exact[0].real, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS[:2] + LAWS[2:], ids=lambda law: type(law).__name__)
def test_the_best_direction_is_that_of_the_general_search(law):
    c, pencil = coefficients(law, STATE), linearise(law, STATE)
    for k in (1.0, 1e3):
        rate, x = fastest(c, k)
        search = max_growth(pencil, k)
        assert rate == pytest.approx(float(search.growth), rel=1e-9)
        assert growth_rate(c, k, x) == pytest.approx(rate, rel=1e-12)


def test_many_states_at_once_are_the_same_as_one_by_one():
    law, states = random_cidr(40, seed=5)
    c = coefficients(law, states)
    rate, _ = fastest(c, 100.0)
    alone = [
        fastest(coefficients(law, BaseState(p, f, i)), 100.0)[0]
        for p, f, i in zip(states.p, states.phi, states.I, strict=True)
    ]
    np.testing.assert_allclose(rate, alone, rtol=1e-13)


def test_an_array_of_states_is_no_pencil():
    with pytest.raises(ValueError, match="single state"):
        linearise(LAWS[3], BaseState([0.1, 0.2], 0.55, 0.1))
    with pytest.raises(ValueError, match="Gamma must not be 0"):
        reduced(coefficients(LAWS[0], STATE), np.array([1.0, 0.0]))
    with pytest.raises(ValueError, match="k must be > 0"):
        fastest(coefficients(LAWS[0], STATE), 0.0)


def test_a_pencil_of_the_reduced_matrix_has_the_same_growth():
    c = coefficients(LAWS[3], STATE)
    small = Pencil(lambda xi: reduced(c, xi), np.eye(3), dim=2)
    xi = np.random.default_rng(7).normal(size=(2, 20)) * 1e4
    np.testing.assert_allclose(growth(small, xi), growth(linearise(LAWS[3], STATE), xi), rtol=1e-9)
