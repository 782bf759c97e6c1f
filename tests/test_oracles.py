"""Guards the numbers against other people's code: scipy, mpmath and, where it is installed, py-pde.

Equations are typed here once more, by hand from the paper; nothing of the package is used on the oracle's side.
"""

import math
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
import scipy.linalg
from scipy.integrate import quad, solve_ivp
from scipy.optimize import fsolve, minimize_scalar
from test_pencil import granular, navier_stokes

from primer import (
    CENTRAL,
    RK8,
    BackwardHeat,
    Friction,
    MuI,
    Pencil,
    Toy,
    ftcs,
    growth,
    growth_rates,
    march_lines,
    max_growth,
    reference,
)
from primer.problems.heat import abs_sin_coefficients, abs_sin_log_norms
from primer.schemes.discrete import dist_floor

BEADS = MuI(math.tan(math.radians(21)), math.tan(math.radians(33)), 0.279)


def by_hand(a, eps, n):
    """(x, f, y0): eq. (toy-pde) with central differences, as a system of ordinary differential equations."""
    h = 2 * math.pi / n
    x = -math.pi + h * np.arange(n)

    def f(t, y):
        u, v = y[:n], y[n:]
        v_xx = (np.roll(v, -1) - 2 * v + np.roll(v, 1)) / h**2
        v_x, u_x = ((np.roll(w, -1) - np.roll(w, 1)) / (2 * h) for w in (v, u))
        return np.concatenate([v_x, eps * u * v_xx + u_x - v - np.sin(x)])

    return x, f, np.concatenate([np.full(n, a), -np.sin(x) / 2])


@pytest.mark.parametrize(("a", "eps", "n", "t"), [(1.5, 0.01, 24, 5.0), (0.5, 0.01, 30, 3.0), (-0.5, 0.0, 17, 2.0)])
def test_the_method_of_lines_against_solve_ivp(a, eps, n, t):
    x, f, y0 = by_hand(a, eps, n)
    truth = solve_ivp(f, (0, t), y0, "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    run = march_lines(Toy(a, eps), n, 0.02, t, CENTRAL, RK8)
    np.testing.assert_allclose(run.x, x, atol=1e-15)
    np.testing.assert_allclose(np.concatenate(run.final), truth, atol=1e-10)


@pytest.mark.parametrize(("a", "eps"), [(1.5, 0.01), (0.5, 0.05)])
def test_the_scheme_tends_to_solve_ivp_as_its_step_shrinks(a, eps):
    """On the same grid what is left is the error of forward Euler: it halves with dt."""
    n, t = 20, 2.0
    _, f, y0 = by_hand(a, eps, n)
    truth = solve_ivp(f, (0, t), y0, "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    errors = [np.abs(np.concatenate(ftcs(Toy(a, eps), n, dt, t).final) - truth).max() for dt in (2e-3, 1e-3)]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(1, abs=0.02)
    assert errors[1] < 2e-3


def test_backward_heat_against_the_matrix_exponential():
    """On a grid of 12 points the semi-discrete backward heat equation is solved by expm of minus the Laplacian."""
    n, t = 12, 0.3
    h = 2 * math.pi / n
    laplacian = (np.roll(np.eye(n), 1, 0) - 2 * np.eye(n) + np.roll(np.eye(n), -1, 0)) / h**2
    run = march_lines(BackwardHeat(2, 0.5), n, 1e-3, t, CENTRAL, RK8)
    (start,) = BackwardHeat(2, 0.5).initial(run.x)
    np.testing.assert_allclose(run.final[0], scipy.linalg.expm(-t * laplacian) @ start, atol=1e-11)


def test_the_reference_against_a_spectral_solve_ivp():
    """Two expansions: Fourier series of the fields by FFT, marched by an implicit method of another family."""
    a, eps, n, t = 1.5, 0.01, 32, 5.0
    k = 1j * np.fft.fftfreq(n, 1 / n) * (np.arange(n) != n // 2)
    x = -math.pi + 2 * math.pi / n * np.arange(n)

    def f(_, y):
        u, v = y[:n], y[n:]
        u_x, v_x = (np.fft.ifft(k * np.fft.fft(w)).real for w in (u, v))
        v_xx = np.fft.ifft(k**2 * np.fft.fft(v)).real
        return np.concatenate([v_x, eps * u * v_xx + u_x - v - np.sin(x)])

    y = solve_ivp(f, (0, t), np.concatenate([np.full(n, a), -np.sin(x) / 2]), "Radau", rtol=1e-9, atol=1e-11).y[:, -1]
    answer = reference(Toy(a, eps), t, 1e-12)
    for field, mine in ((y[:n], answer.u[0]), (y[n:], answer.v[0])):
        modes = np.fft.rfft(mine) / len(mine)  # both grids begin at -pi
        np.testing.assert_allclose((np.fft.rfft(field) / n)[:6], modes[:6], atol=1e-8)


@pytest.mark.slow
def test_the_scheme_against_py_pde():
    """Its own differences and its own Euler step, on a grid shifted by half a cell: each wave is the same to round-off.

    The waves that the two grids cannot tell apart in the same way are not there: they have decayed to nothing.
    """
    pde = pytest.importorskip("pde", reason="py-pde is not installed (extra 'bench')")
    a, eps, n, dt, t = 1.5, 0.05, 32, 1e-3, 0.5
    grid = pde.CartesianGrid([[-math.pi, math.pi]], n, periodic=True)
    equations = pde.PDE({"u": "d_dx(v)", "v": f"{eps} * u * laplace(v) + d_dx(u) - v - sin(x)"})
    start = pde.FieldCollection([pde.ScalarField(grid, a), pde.ScalarField.from_expression(grid, "-sin(x)/2")])
    theirs = equations.solve(start, t, dt, tracker=None, solver="euler", backend="numpy", adaptive=False).data
    run, (x,) = ftcs(Toy(a, eps), n, dt, t), grid.axes_coords
    np.testing.assert_allclose(x, run.x + math.pi / n, atol=1e-14)
    k = np.arange(6)[:, None]
    waves = [fields @ np.exp(-1j * k * points).T / n for fields, points in ((run.final, run.x), (theirs, x))]
    np.testing.assert_allclose(*waves, atol=1e-13)
    assert np.abs(waves[0][:, 1:3]).min() > 1e-5


def largest_finite(S, E):
    """Eigenvalues of lambda E q = -S q by QZ, those at infinity left out."""
    alpha, beta = scipy.linalg.eig(-S, E, right=False, homogeneous_eigvals=True)
    finite = np.abs(beta) > 1e-10 * np.abs(alpha)
    return np.sort_complex(alpha[finite] / beta[finite])


@pytest.mark.parametrize("seed", range(8))
def test_finite_eigenvalues_against_qz(seed):
    """Random complex pencils, some of them with constraints, at moderate wavenumbers, where QZ has its digits."""
    random = np.random.default_rng(seed)
    k = 2 + seed % 4
    S = random.normal(size=(k, k)) + 1j * random.normal(size=(k, k))
    E = random.normal(size=(k, k)) + 1j * random.normal(size=(k, k))
    if seed % 2:
        E[-1] = 0
    lam = Pencil(S, E).eigenvalues(1.0)
    np.testing.assert_allclose(np.sort_complex(lam), largest_finite(S, E), rtol=1e-9)


@pytest.mark.parametrize("pencil", [granular(0.3, 0.2, 0.2, 0.7, 0.4, 0.6, -0.8), navier_stokes()])
def test_growth_of_pencils_in_the_plane_against_qz(pencil):
    for xi in ([1.0, 0.4], [-3.0, 2.0], [0.2, -5.0]):
        S, E = pencil.matrices(np.array(xi))
        assert growth(pencil, xi) == pytest.approx(largest_finite(S, E).real.max(), rel=1e-9)


@pytest.mark.parametrize("xi", [0.5, 3.0, 100.0, 1e6])
def test_growth_rates_of_text_against_mpmath(xi):
    """Eq. (toy-mat) typed as a matrix, its eigenvalues with 50 digits."""
    u, v_xx, eps = -0.5, 0.3, 0.01
    text = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"
    rates = growth_rates(text, xi, at={"u": u, "v_xx": v_xx}, eps=eps)
    with mp.workdps(50):
        k, e = mp.mpf(xi), mp.mpf("0.01")
        matrix = mp.matrix([[0, 1j * k], [1j * k + e * mp.mpf("0.3"), -e * mp.mpf("-0.5") * k**2 - 1]])
        exact = sorted(mp.eig(matrix, left=False, right=False), key=lambda z: -z.real)
        for mine, theirs in zip(rates, exact, strict=True):
            assert abs(mp.mpc(complex(mine)) - theirs) <= 1e-13 * abs(theirs)


@pytest.mark.slow
def test_the_best_direction_against_brents_method():
    pencil = granular(0.3, 0.5, 0.1, 0.7, 0.4, 0.6, 0.8)

    def fall(angle):
        return -growth(pencil, 50 * np.array([math.cos(angle), math.sin(angle)]))

    starts = np.linspace(0, math.pi, 41)
    best = min(
        minimize_scalar(fall, bounds=bounds, method="bounded", options={"xatol": 1e-12}).fun
        for bounds in pairwise(starts)
    )
    assert max_growth(pencil, 50.0).growth == pytest.approx(-best, rel=1e-9)


@pytest.mark.parametrize("I", [1e-3, 0.279, 40.0])
def test_lemma_1_against_quadrature_of_its_integrals(I):
    """The linear equations (5/2) I alpha' + alpha = 2 (I mu)', alpha - beta/2 = mu, regular at 0, solved by quadrature.

    alpha = (4/5) I^{-2/5} int_0^I s^{-3/5} (s mu)' ds, with scipy's rule for the algebraic weight s^{-3/5}.
    """

    def slope(s):
        return BEADS.mu1 + (BEADS.mu2 - BEADS.mu1) * (1 - (BEADS.I0 / (s + BEADS.I0)) ** 2)  # (s mu)'

    integral, _ = quad(slope, 0, I, weight="alg", wvar=(-0.6, 0), epsabs=1e-14, epsrel=1e-13)
    alpha = 0.8 * I**-0.4 * integral
    mu = BEADS.mu1 + (BEADS.mu2 - BEADS.mu1) / (BEADS.I0 / I + 1)
    for law in (BEADS, Friction(BEADS.mu, BEADS.dmu)):
        assert law.alpha(I) == pytest.approx(alpha, rel=1e-12)
        assert law.beta(I) == pytest.approx(2 * (alpha - mu), rel=1e-12)


@pytest.mark.parametrize("p", [1, 2.5, 3])
def test_norms_of_abs_sin_against_a_sum_with_fifty_digits(p):
    """Coefficients by the gamma functions, the sum of e^{2 n^2 t} |c_n|^2 term by term: far beyond double precision."""
    t, m_max = 0.5, 30
    with mp.workdps(50):
        P = mp.mpf(p)
        c = [
            (-1) ** m * mp.gamma(P + 1) / 2**P * mp.rgamma(1 + P / 2 + m) * mp.rgamma(1 + P / 2 - m)
            for m in range(m_max + 1)
        ]
        total = sum((1 if m == 0 else 2) * mp.exp(2 * (2 * m) ** 2 * mp.mpf(t)) * c[m] ** 2 for m in range(m_max + 1))
        exact = float(mp.log(total))
    assert abs_sin_log_norms(p, t, m_max)[-1] == pytest.approx(exact, rel=1e-13)
    np.testing.assert_allclose(abs_sin_coefficients(p, m_max), [float(x) for x in c], rtol=1e-12)


@pytest.mark.parametrize("n", [9, 12])
def test_the_floor_is_where_a_root_finder_comes_to_rest(n):
    """The steady state of the differences, by scipy's fsolve from the paper's; its mean, free otherwise, is held."""
    a, eps = 1.5, 0.3
    x, f, _ = by_hand(a, eps, n)

    def rest(y):
        rates = f(0, y)
        if n % 2 == 0:  # u's sawtooth, which central differences do not see, is held at zero too
            rates[1] = (-1.0) ** np.arange(n) @ y[:n]
        rates[0] = y[:n].mean() - a
        return rates

    y = fsolve(rest, np.concatenate([a - np.cos(x), np.zeros(n)]), xtol=1e-13)
    assert np.abs(rest(y)).max() < 1e-10
    distance = np.sqrt((y[:n] - (a - np.cos(x))) ** 2 + y[n:] ** 2).max()
    assert distance == pytest.approx(dist_floor(n), rel=1e-8)
