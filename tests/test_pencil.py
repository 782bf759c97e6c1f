"""Guards the pencils: finite eigenvalues of singular pencils, their digits at large |xi|, and the best direction.

Second routes: closed forms, and eigenvalues from multiprecision polynomial roots.
"""

import mpmath as mp
import numpy as np
import pytest
import sympy

import primer.analysis.directions as directions
import primer.analysis.eigen as eigen
from primer import Pencil, growth, max_growth


def granular(A, B, C, Gamma, tau, tau_phi, f_phi, phi=0.6):
    """The pencil (e24) of the granular equations (21), with rho* = ||D*|| = 1 and u* = 0."""

    def S(xi):
        x, y = xi
        i, o = 1j, 0 * x
        rows = [
            [A * x * x, -A * x * y, i * tau_phi * x, (1 + B) * i * x, 2 * i * tau * y],
            [-A * x * y, A * y * y, -i * tau_phi * y, (1 - B) * i * y, 2 * i * tau * x],
            [i * phi * x, i * phi * y, o, o, o],
            [(1 + C) * i * x, (1 - C) * i * y, -2 * f_phi + o, Gamma + o, o],
            [i * y, i * x, o, o, 4 + o],
        ]
        return np.moveaxis(np.array([[entry + 0j for entry in row] for row in rows]), (0, 1), (-2, -1))

    return Pencil(S, np.diag([phi, phi, 1, 0, 0]), dim=2)


def critical_state(p, mu=0.5, C=1.0, C_phi=10.0):
    """The same for critical-state soil mechanics: Y = 2 mu p - p^2/C, f = Y_p."""
    Y_p = 2 * mu - 2 * p / C
    return granular(0, Y_p, Y_p, 4 / C, 2 * mu * p - p**2 / C, p**2 / C**2 * C_phi, 2 * p / C**2 * C_phi)


def navier_stokes(nu=0.1):
    """Incompressible, at rest, in two dimensions; written for one wavevector only."""

    def S(xi):
        x, y = xi
        k2 = x**2 + y**2
        return [[nu * k2, 0, 1j * x], [0, nu * k2, 1j * y], [1j * x, 1j * y, 0]]

    return Pencil(S, np.diag([1, 1, 0]), dim=2)


def multiprecision(pencil, xi):
    """Eigenvalues by decreasing real part, as roots of det(lambda E + S) interpolated with 250 digits."""
    S, E = (mp.matrix(a.tolist()) for a in pencil.matrices(xi))
    with mp.workdps(250):
        nodes = [mp.mpf(j) for j in range(pencil.size + 1)]
        coefficients = mp.lu_solve(
            mp.matrix([[t**j for j in range(len(nodes))] for t in nodes]), mp.matrix([mp.det(t * E + S) for t in nodes])
        )
        roots = mp.polyroots([coefficients[j] for j in range(pencil.count, -1, -1)], maxsteps=500, extraprec=2000)
        return sorted(roots, key=lambda root: -root.real)


@pytest.mark.parametrize("k", [1, 1e2, 1e4, 1e6, 1e8])
def test_small_eigenvalues_keep_their_digits_beside_large_ones(k):
    pencil = granular(0.3, 0.2, 0.2, 0.7, 0.4, 0.6, -0.8)
    xi = k * np.array([np.cos(0.7), np.sin(0.7)])
    lam = pencil.eigenvalues(xi)
    assert len(lam) == 3
    for computed, exact in zip(lam, multiprecision(pencil, xi), strict=True):
        assert abs(mp.mpc(complex(computed)) - exact) < 1e-13 * abs(exact)


def test_incompressible_flow_has_one_finite_eigenvalue():
    pencil = navier_stokes()
    xi = np.array([[1.0, -3e3, 1e8], [2.0, 0.0, 1e8]])
    assert pencil.count == 1
    np.testing.assert_allclose(growth(pencil, xi), -0.1 * (xi**2).sum(axis=0), rtol=1e-14)
    assert np.isnan(growth(pencil, [0.0, 0.0]))  # a uniform pressure is undetermined


def test_shapes_and_ways_to_write_the_symbol():
    many = Pencil(
        lambda xi: np.stack([np.stack([xi**2, 1j * xi], -1), np.stack([-1j * xi, 0 * xi], -1)], -2), np.eye(2)
    )
    one = Pencil(lambda xi: [[xi**2, 1j * xi], [-1j * xi, 0]], np.eye(2))
    awkward = Pencil(lambda xi: np.array([[xi**2, 1j * xi], [-1j * xi, 0 * xi]]), np.eye(2))  # shape (2, 2) + s
    xi = np.array([[0.0, 1.0, -2.0], [1.0, 2.0, 3.0]])
    expected = (np.sqrt(xi**4 + 4 * xi**2) - xi**2) / 2  # lam^2 + xi^2 lam - xi^2 = 0
    for pencil in (many, one, awkward):
        np.testing.assert_allclose(growth(pencil, xi), expected, rtol=1e-14)
        assert growth(pencil, 2).shape == ()
        assert pencil.eigenvalues(xi).shape == (2, 3, 2)
    constant = Pencil([[1, 2], [0, 3]], [[1, 0], [0, 1]])
    np.testing.assert_allclose(constant.eigenvalues([5, 7]), [[-1, -3], [-1, -3]])


def test_time_derivatives_of_space_derivatives():
    benjamin = Pencil(lambda xi: [[1j * xi + xi**2]], lambda xi: [[1 + xi**2]])
    xi = np.array([0.5, 3.0, 1e8])
    np.testing.assert_allclose(growth(benjamin, xi), -(xi**2) / (1 + xi**2))


def test_zero_and_multiple_eigenvalues():
    zero = Pencil(lambda xi: [[1j * xi, 2j * xi], [2j * xi, 4j * xi]], np.eye(2))  # eigenvalues 0 and -5 i xi
    np.testing.assert_allclose(zero.eigenvalues([1e-3, 7.0, 1e9]).imag.min(axis=1), [-5e-3, -35, -5e9])
    assert np.all(np.abs(zero.eigenvalues([1e-3, 7.0])).min(axis=1) < 1e-15)
    twice = Pencil(lambda xi: [[xi**2, 0, 0], [0, xi**2, 0], [0, 0, xi**4]], np.eye(3))
    np.testing.assert_allclose(twice.eigenvalues(3.0), [-9, -9, -81])
    jordan = Pencil(lambda xi: [[xi**2, xi], [0, xi**2]], np.eye(2))
    np.testing.assert_allclose(jordan.eigenvalues(3.0), [-9, -9], rtol=1e-7)  # a double root: half the digits


def test_an_eigenvalue_found_twice_is_sought_again():
    """Two starting values that ran into one: the eigenvalue that was missed is found, a double zero stays."""
    E = np.eye(3, dtype=complex)[None]
    for eigenvalues, start in (([0, 1e-5, 1], [0, 0, 1]), ([0, 0, 1], [0, 0, 1]), ([1, 2, 3], [2, 2, 1])):
        S = -np.diag(eigenvalues).astype(complex)[None]
        found = eigen._told_apart(S, E, np.array([start], dtype=complex))
        np.testing.assert_allclose(np.sort(found[0].real), eigenvalues, rtol=1e-12, atol=0)


def test_best_direction_of_an_anisotropic_diffusion():
    # lambda = -(2 x^2 + 3 x y - y^2): the largest eigenvalue of the quadratic form
    pencil = Pencil(lambda xi: [[2 * xi[0] ** 2 + 3 * xi[0] * xi[1] - xi[1] ** 2]], [[1]], dim=2)
    k = np.array([0.1, 1.0, 1e4])
    best = max_growth(pencil, k)
    np.testing.assert_allclose(best.growth, (np.sqrt(18) - 1) / 2 * k**2, rtol=1e-14)
    np.testing.assert_allclose(growth(pencil, k * best.direction), best.growth, rtol=1e-14)
    assert best.direction.shape == (2, 3)
    assert max_growth(pencil, 2.0).growth.shape == ()


def test_one_sided_growth_in_one_dimension():
    pencil = Pencil(lambda xi: [[-xi]], [[1]])  # u_t = -i u_x: a complex coefficient, growth for xi > 0 only
    assert not pencil.is_real
    best = max_growth(pencil, [1.0, 5.0])
    np.testing.assert_array_equal(best.growth, [1, 5])
    np.testing.assert_array_equal(best.direction, [1, 1])


def test_drifting_direction_of_the_critical_state():
    """Growth ~ |xi|^{2/3} in a window of that width's inverse, which a scan of a thousand fixed directions misses."""
    pencil, k = critical_state(0.5), np.array([1e6, 1e8])
    best = max_growth(pencil, k).growth
    assert np.log(best[1] / best[0]) / np.log(100) == pytest.approx(2 / 3, abs=5e-4)
    fixed = np.linspace(0.01, np.pi, 1000)
    scan = growth(pencil, 1e8 * np.stack([np.cos(fixed), np.sin(fixed)])).max()
    assert scan < 0.01 * best[1]


def test_dilating_and_contracting_soil():
    # dilating: |xi| sqrt(Y_p Y_phi/rho*); contracting: a bound that a narrow window attains
    assert max_growth(critical_state(0.3), 1e8).growth == pytest.approx(1e8 * np.sqrt(0.4 * 0.9), rel=1e-7)
    np.testing.assert_allclose(max_growth(critical_state(0.7), [1e5, 1e7]).growth, -5.6, rtol=1e-6)


@pytest.mark.parametrize(
    ("make", "error", "word"),
    [
        (lambda: Pencil([[1, 2]], [[1]]), ValueError, "square"),
        (lambda: Pencil(lambda xi: [[xi, 0], [0, 1]], [[1]]), ValueError, "same size"),
        (lambda: Pencil([[1, 0], [0, 0]], np.diag([1, 0])), ValueError, "determine"),
        (lambda: Pencil("S", [[1]]), TypeError, "matrix"),
        (lambda: Pencil([[1]], [[1]], dim=3), ValueError, "dim"),
        (lambda: growth(navier_stokes(), [1.0, 2.0, 3.0]), ValueError, "shape"),
        (lambda: growth(navier_stokes(), 1.0), ValueError, "shape"),
        (lambda: max_growth(navier_stokes(), 0.0), ValueError, "positive"),
        (lambda: growth(navier_stokes(), [np.inf, 0]), ValueError, "finite"),
    ],
)
def test_bad_input_is_named(make, error, word):
    with pytest.raises(error, match=word):
        make()


def test_the_number_of_space_variables_is_seen():
    assert Pencil(lambda xi: [[xi**2]], [[1]]).dim == 1
    assert Pencil(lambda xi: [[xi[0] ** 2 - xi[1] ** 2]], [[1]]).dim == 2

    def unpacking(xi):
        xi1, xi2 = xi
        return [[xi1**2 + xi2]]

    assert Pencil(unpacking, [[1]]).dim == 2
    assert growth(Pencil(unpacking, [[1]]), [1.0, 2.0]) == pytest.approx(-3)


def test_sympy_matrices_are_symbols():
    xi = sympy.Symbol("xi", real=True)
    pencil = Pencil(sympy.Matrix([[0, -sympy.I * xi], [-sympy.I * xi, 1]]), sympy.eye(2))
    np.testing.assert_allclose(growth(pencil, [0.0, 10.0]), [0, -0.5], atol=1e-12)
    xi1, xi2 = sympy.symbols("xi_1 xi_2")
    plane = Pencil(sympy.Matrix([[xi1**2 - xi2]]), sympy.eye(1))
    np.testing.assert_allclose(growth(plane, [[1.0, 2.0], [5.0, 0.0]]), [4, -4])
    pseudo = Pencil(sympy.Matrix([[xi**2]]), sympy.Matrix([[1 + xi**2]]))
    assert growth(pseudo, 3.0) == pytest.approx(-0.9)
    with pytest.raises(ValueError, match="S must be a matrix in xi, or in xi_1 and xi_2, alone, got symbols a, xi"):
        Pencil(sympy.Matrix([[sympy.Symbol("a") * xi]]), sympy.eye(1))


def test_local_maxima_of_a_periodic_scan():
    angle = np.array([[0.0, 0.1, 0.3, 0.6, 1.0, 1.5, 2.1, 2.8]])
    f = np.array([[1.0, 2.0, 5.0, 4.0, 3.0, 2.0, 7.0, 1.5]])
    peaks, spacing = directions._highest(angle, f, np.pi, 4)
    assert peaks.tolist() == [[2.1, 0.3]]  # the highest first, and no more than there are
    np.testing.assert_allclose(spacing, [[0.7, 0.3]])
    round_the_corner, spacing = directions._highest(angle, -np.abs(angle - 3.1), np.pi, 1)
    assert round_the_corner.tolist() == [[2.8]]
    np.testing.assert_allclose(spacing, [[0.7]])
    across, spacing = directions._highest(angle, -angle, np.pi, 1)
    assert across.tolist() == [[0.0]]
    np.testing.assert_allclose(spacing, [[np.pi - 2.8]])


def test_branches_that_meet_or_vanish_are_told_by_a_product():
    pencil = Pencil(lambda xi: [[xi[0] ** 2, 0, 0], [0, 2 + 0 * xi[0], 0], [0, 0, 5]], np.eye(3), dim=2)
    rate, meeting = directions._rate_and_meeting(pencil, np.array([1.0, 3.0]), np.zeros((2, 1)))
    np.testing.assert_allclose(rate, [[-1], [-2]])  # eigenvalues -1, -2, -5 and -9, -2, -5
    np.testing.assert_allclose(np.exp(meeting), [[1 * 4 * 3 * 1 * 2 * 5], [7 * 4 * 3 * 9 * 2 * 5]])


def test_following_a_peak_goes_to_rounding_level_and_stops_where_nothing_moves():
    seen = []

    def hill(pencil, k, angle):
        seen.append(angle.shape)
        return -np.abs(angle - 0.3)

    def follow(start):
        seen.clear()
        return directions._followed(None, np.ones(1), np.array([[start]]), 0.1, hill).item()

    assert follow(0.3) == 0.3
    assert len(seen) == 5
    assert follow(0.2265433) == pytest.approx(0.3, abs=1e-15)
    assert 20 < len(seen) <= 36
