"""Guards the equations: exact solutions solve them, symbols linearise them, coefficients are right."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from primer import BackwardHeat, Toy
from primer.problems import heat, toy

X = -math.pi + 2 * math.pi / 64 * np.arange(64)


def spectral(f, m):
    """The m-th derivative of a periodic field by Fourier series: exact for a few modes."""
    k = np.fft.fftfreq(f.size, 1 / f.size)
    return np.fft.ifft((1j * k) ** m * np.fft.fft(f)).real


@pytest.mark.parametrize("a", [-3.0, 0.5, 1.5])
def test_exact_solution_solves_the_toy_system(a):
    problem, t, d = Toy(a, eps=0), 1.3, 1e-5
    ahead, behind = np.array(problem.exact(X, t + d)), np.array(problem.exact(X, t - d))
    rates = problem.rhs(X, problem.exact(X, t), spectral)
    # (u(t+d) - u(t-d))/2d errs by d^2/6 times a third derivative of size one, and by rounding over d.
    np.testing.assert_allclose((ahead - behind) / (2 * d), rates, atol=1e-9)
    np.testing.assert_allclose(problem.exact(X, 0), problem.initial(X), atol=1e-15)
    np.testing.assert_allclose(problem.exact(X, 200.0), problem.steady(X), atol=1e-15)


def test_exact_solution_is_the_papers_sum_of_cosines():
    """(toy-sln) as printed, against the product form."""
    t, root = 2.7, math.sqrt(3)
    u, v = Toy(0.5, eps=0).exact(X, t)
    half = math.exp(-t / 2) / 2
    paper_u = half * (np.cos(X + root * t / 2) + np.cos(X - root * t / 2)) + 0.5 - np.cos(X)
    paper_v = half * (np.cos(X + root * t / 2 + math.pi / 6) - np.cos(X - root * t / 2 - math.pi / 6))
    np.testing.assert_allclose(u, paper_u, atol=1e-15)
    np.testing.assert_allclose(v, paper_v, atol=1e-15)


def test_first_touch_and_deepest_transient_at_eps_0():
    """physics.md: u(0, t) of a = 0.5 reaches 0 at t = 0.825153642138549; the deepest u(0, t) is a - 1 - 0.19103."""
    problem = Toy(0.5, eps=0)
    assert abs(problem.exact(0.0, 0.825153642138549)[0]) < 1e-14
    t = np.linspace(0, 20, 20001)
    u = problem.exact(0.0, t)[0]
    assert t[np.argmin(u)] == pytest.approx(3.0230, abs=1e-3)
    assert u.min() == pytest.approx(-0.5 - 0.19103, abs=1e-5)


@pytest.mark.parametrize("eps", [0.0, 0.01, 0.5])
def test_steady_state_is_steady_for_every_eps(eps):
    rates = Toy(0.5, eps).rhs(X, Toy(0.5, eps).steady(X), spectral)
    np.testing.assert_allclose(rates, np.zeros((2, 64)), atol=1e-12)


def test_exact_refuses_eps():
    with pytest.raises(ValueError, match=r"eps must be 0 .* got 0\.01"):
        Toy(0.5).exact(X, 1.0)


@pytest.mark.parametrize(("u", "v_xx"), [(1.5, 0.0), (-0.5, 0.3)])
def test_toy_symbol_is_the_derivative_of_the_right_hand_side(u, v_xx):
    """Complex-step derivatives of the equation's one text, times (i xi)^m, rebuild eq. (toy-mat)."""
    problem, xi, step = Toy(1.0, eps=0.07), 3.7, 1e-30
    base = np.array([u, 0.2, 0.1, -0.4, v_xx], dtype=complex)  # u, v, u_x, v_x, v_xx
    column = {0: (0, 0), 1: (1, 0), 2: (0, 1), 3: (1, 1), 4: (1, 2)}  # argument -> field, order of derivative
    S = np.zeros((2, 2), dtype=complex)
    for k, (field, m) in column.items():
        bumped = base.copy()
        bumped[k] += 1j * step
        gradient = np.imag(toy.tendency(*bumped, 0.3, problem.eps)) / step
        S[:, field] += gradient * (1j * xi) ** m
    np.testing.assert_allclose(problem.symbol(xi, u, v_xx), S, rtol=1e-14)


def test_wavenumbers_go_up_to_the_last_that_doubles_tell_apart():
    assert BackwardHeat(2**53).xi == 2**53
    with pytest.raises(ValueError, match=r"xi must be an integer <= 2\^53"):
        BackwardHeat(2**53 + 1)


@pytest.mark.parametrize("x", [[0, 1, 2], np.arange(3), range(3), 2])
def test_whole_numbers_are_as_good_as_others(x):
    for problem in (Toy(1.5, 0), BackwardHeat(2, 0.5)):
        for fields in (problem.initial, problem.steady):
            np.testing.assert_array_equal(fields(x), fields(np.asarray(x, dtype=float)))
        np.testing.assert_allclose(problem.exact(x, 0), problem.initial(x), atol=1e-15)


def test_toy_symbol_has_the_characteristic_polynomial_of_physics():
    problem, xi, u, v_xx = Toy(1.0, eps=0.01), np.array([1.0, 7.0, 300.0]), -0.5, 0.3
    S = problem.symbol(xi, u, v_xx)
    lam = 0.3 - 0.2j
    polynomial = lam**2 + (1 + problem.eps * u * xi**2) * lam + xi**2 - 1j * problem.eps * xi * v_xx
    np.testing.assert_allclose(np.linalg.det(lam * np.eye(2) - S), polynomial, rtol=1e-12)


@pytest.mark.parametrize(("u", "growing"), [(1.5, False), (-0.5, True)])
def test_toy_eigenvalues_follow_toy_eig(u, growing):
    """lam_1 = -eps u xi^2 - 1 + 1/(eps u) + O(xi^-2) and lam_2 -> -1/(eps u): eq. (toy-eig), sharpened."""
    eps, xi = 0.01, 1e5
    lam = np.linalg.eigvals(Toy(1.0, eps).symbol(xi, u))
    fast, slow = sorted(lam, key=abs, reverse=True)
    assert fast == pytest.approx(-eps * u * xi**2 - 1 + 1 / (eps * u), rel=1e-9)
    assert slow == pytest.approx(-1 / (eps * u), rel=1e-4)
    assert bool(max(lam.real) > 1e6) is growing


def test_backward_heat_mode_solves_its_equation():
    k, t, d = 3, 0.2, 1e-6
    problem = BackwardHeat(xi=k, amplitude=0.5)
    rate = (problem.exact(X, t + d)[0] - problem.exact(X, t - d)[0]) / (2 * d)
    np.testing.assert_allclose(rate, problem.rhs(X, problem.exact(X, t), spectral)[0], rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(problem.exact(X, 0.0)[0], problem.initial(X)[0])
    np.testing.assert_allclose(problem.exact(X, t)[0], problem.initial(X)[0] * np.exp(k**2 * t))
    np.testing.assert_allclose(problem.symbol([0.0, 2.5]), [[[0.0]], [[6.25]]])


@pytest.mark.parametrize("p", [0, 1, 2, 2.5, 3, 4, 7])
def test_abs_sin_coefficients_against_quadrature(p):
    c = heat.abs_sin_coefficients(p, 5)
    for m in range(6):
        integral, _ = quad(lambda x, m=m: np.sin(x) ** p * np.cos(2 * m * x), 0, math.pi, epsabs=1e-13, epsrel=1e-13)
        assert c[m] == pytest.approx(integral / math.pi, abs=2e-12)


@pytest.mark.parametrize("p", [1, 3, 4.5])
def test_abs_sin_coefficients_against_the_gamma_form_and_its_tail(p):
    m = np.arange(9)
    gamma = np.array(
        [(-1) ** k * math.gamma(p + 1) / (2**p * math.gamma(1 + p / 2 + k) * math.gamma(1 + p / 2 - k)) for k in m]
    )
    np.testing.assert_allclose(heat.abs_sin_coefficients(p, 8), gamma, rtol=1e-12)
    last = heat.abs_sin_coefficients(p, 20000)[-1]
    tail = -math.sin(math.pi * p / 2) * math.gamma(p + 1) / (math.pi * 2**p) * 20000.0 ** (-p - 1)
    assert last == pytest.approx(tail, rel=1e-3)


def test_only_even_powers_have_a_solution():
    for p in (2, 4, 6):
        assert np.all(heat.abs_sin_coefficients(p, 50)[p // 2 + 1 :] == 0)
        assert np.ptp(heat.abs_sin_log_norms(p, 1e-3, 400)[p:]) == 0
    for p in (0.5, 1, 3, 5):
        norms = heat.abs_sin_log_norms(p, 1e-3, 400)
        assert np.all(np.diff(norms[300:]) > 1)  # runs away like e^{2 n^2 t}
    # The plain sum, where nothing overflows.
    c = heat.abs_sin_coefficients(3, 10)
    n = 2 * np.arange(-10, 11)
    assert heat.abs_sin_log_norms(3, 0.01, 10)[-1] == pytest.approx(
        math.log(np.sum(np.exp(2 * n**2 * 0.01) * c[np.abs(n) // 2] ** 2))
    )


def test_scaled_modes_vanish_at_first_and_explode_later():
    """Hadamard's third condition, eq. (backward-heat-blow-up)."""
    xi = np.array([10.0, 20.0, 40.0])
    assert np.all(np.diff(heat.scaled_amplitude(xi, 0.0, 4)) < 0)
    assert np.all(np.diff(heat.scaled_amplitude(xi, 0.1, 4)) > 0)
    np.testing.assert_array_equal(heat.scaled_amplitude(-xi, 0.1, 3.5), heat.scaled_amplitude(xi, 0.1, 3.5))
    assert heat.scaled_amplitude(100, 1, 2) == math.inf  # no warning: that it explodes is the point
    np.testing.assert_allclose(heat.scaled_amplitude(2.0, 0.5, 0), np.exp(2))
    assert heat.mode(100, [-0.01, 0, 0.01], 1).tolist() == [-math.inf, 0, math.inf]
    sup = np.abs(heat.mode(10.0, np.linspace(0, 7, 100001), 0.1)).max() * 10.0**-4
    assert heat.scaled_amplitude(10.0, 0.1, 4) == pytest.approx(sup, rel=1e-6)


@pytest.mark.parametrize(
    ("make", "error", "sentence"),
    [
        (lambda: Toy(math.nan), ValueError, "a must be a finite number, got nan"),
        (lambda: Toy("1"), TypeError, "a must be a finite number, got '1' (str)"),
        (lambda: Toy(True), TypeError, "a must be a finite number, got True (bool)"),
        (lambda: Toy(1j), TypeError, "a must be a finite number, got 1j (complex)"),
        (lambda: Toy(1, -0.1), ValueError, "eps must be a finite number >= 0, got -0.1"),
        (lambda: Toy(1, math.inf), ValueError, "eps must be a finite number >= 0, got inf"),
        (lambda: Toy(10**400), ValueError, "a must be a finite number, got 1000000"),
        (lambda: Toy(0.5, 0).exact("x", 1), TypeError, "x must be a number or an array of numbers, got 'x'"),
        (lambda: Toy(0.5, 0).exact(0.0, [math.inf]), ValueError, "t must be finite everywhere, got [inf]"),
        (lambda: BackwardHeat(xi=0), ValueError, "xi must be an integer >= 1, got 0"),
        (lambda: BackwardHeat(xi=1.5), TypeError, "xi must be an integer >= 1, got 1.5 (float)"),
        (lambda: heat.abs_sin_log_norms(1, -1, 3), ValueError, "t must be a finite number >= 0, got -1"),
        (lambda: heat.scaled_amplitude([1, 0], 1, 2), ValueError, "xi must not be 0, got [1.0, 0.0]"),
        (lambda: heat.abs_sin_coefficients(-1, 3), ValueError, "p must be a finite number >= 0, got -1"),
        (lambda: heat.abs_sin_coefficients(1, -3), ValueError, "m_max must be an integer >= 0, got -3"),
    ],
)
def test_bad_input_gets_one_sentence(make, error, sentence):
    with pytest.raises(error) as caught:
        make()
    assert str(caught.value).startswith(sentence)
    assert "\n" not in str(caught.value)
