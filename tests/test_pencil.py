"""Guards the pencils: finite eigenvalues of singular pencils, their digits at large |xi|, and the best direction.

Second routes: closed forms, and eigenvalues from multiprecision polynomial roots.
"""

import mpmath as mp
import numpy as np
import pytest
import sympy

import primer.analysis.directions as directions
import primer.analysis.eigen as eigen
import primer.checks as checks
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
        (lambda: Pencil([[1]], [[1]], dim=4), ValueError, "dim"),
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
    with pytest.raises(ValueError, match="S must be a matrix in xi, or in xi_1, xi_2, xi_3, alone, got symbols a, xi"):
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


# ---------------------------------------------------------------- sentences and limits

EYE = np.eye(2)


@pytest.mark.parametrize(
    ("make", "error", "sentence"),
    [
        (lambda: Pencil([[1, 2]], EYE), ValueError,
         "S must give one square matrix for one wavevector, got shape (1, 2)"),
        (lambda: Pencil(EYE, [1, 2]), ValueError, "E must give one square matrix for one wavevector, got shape (2,)"),
        (lambda: Pencil(lambda xi: [[1, 2]], EYE, dim=1), ValueError,
         "S must give one square matrix for one wavevector, got shape (1, 2)"),
        (lambda: Pencil(EYE, lambda xi: [[]]), ValueError,
         "E must give one square matrix for one wavevector, got shape (1, 0)"),
        (lambda: Pencil(np.zeros((0, 0)), EYE), ValueError,
         "S must give one square matrix for one wavevector, got shape (0, 0)"),
        (lambda: Pencil("S", EYE), TypeError, "S must give a matrix of numbers, got str"),
        (lambda: Pencil([[1, 2], [3]], EYE), TypeError, "S must give a matrix of numbers, got list"),
        (lambda: Pencil([[np.nan, 2], [3, 1]], EYE), ValueError,
         "S must be finite everywhere, got array([[nan+0.j, 2.+0.j], [ 3.+0.j, 1.+0.j]])"),
        (lambda: Pencil(np.eye(3), EYE), ValueError,
         "S and E must be square matrices of the same size, got (3, 3) and (2, 2)"),
        (lambda: Pencil(np.eye(13), np.eye(13)), ValueError, "S and E must be no larger than 12 x 12, got 13 x 13"),
        (lambda: Pencil(np.diag([1, 0]), np.diag([1, 0])), ValueError,
         "the pencil is singular: det(lambda E + S) vanishes identically, so the equations do not determine the "
         "unknowns"),
        (lambda: Pencil(EYE, EYE, dim=4), ValueError, "dim must be an integer >= 1 and <= 3, got 4"),
        (lambda: Pencil(EYE, EYE, dim=0), ValueError, "dim must be an integer >= 1 and <= 3, got 0"),
        (lambda: growth(navier_stokes(), [1.0, 2.0, 3.0]), ValueError,
         "xi must have shape (2, ...) for two space variables, got shape (3,)"),
        (lambda: growth(navier_stokes(), 1.0), ValueError,
         "xi must have shape (2, ...) for two space variables, got shape ()"),
        (lambda: growth(EYE, 1.0), TypeError,
         "pencil must be a Pencil (for equations as text there is growth_rates), got array([[1., 0.], [0., 1.]])"),
        (lambda: max_growth("u_t = u", 1.0), TypeError,
         "pencil must be a Pencil (for equations as text there is growth_rates), got 'u_t = u'"),
        (lambda: max_growth(navier_stokes(), [1.0, 0.0]), ValueError,
         "k must be positive everywhere, being the length of the wavevector, got array([1., 0.])"),
        (lambda: growth(navier_stokes(), [1e80, 1.0]), ValueError,
         "xi must leave S and E finite, and below 1e+150, got array([1.e+80, 1.e+00])"),
    ],
)  # fmt: skip
def test_bad_input_gets_the_whole_sentence(make, error, sentence):
    with pytest.raises(error) as caught:
        make()
    assert str(caught.value) == sentence


def test_matrices_are_finite_and_below_a_limit_both_of_them():
    for pencil in (
        Pencil(lambda xi: [[xi]], lambda xi: [[1 + 0 * xi]], dim=1),
        Pencil(lambda xi: [[1 + 0 * xi]], lambda xi: [[xi]], dim=1),
    ):
        S, E = pencil.matrices([3.0, 0.99e150])
        assert {S[1].item(), E[1].item()} == {1, 0.99e150}
        for xi in ([3.0, 1e150], [-1e150]):
            with pytest.raises(ValueError, match=r"xi must leave S and E finite, and below 1e\+150"):
                pencil.matrices(xi)
    overflowing = Pencil(lambda xi: [[xi**3]], [[1]], dim=1)
    with pytest.raises(ValueError, match="finite"):  # and no warning
        overflowing.matrices([1.0, 1e149])


@pytest.mark.parametrize("dim", [1, 2])
def test_memory_is_limited_before_it_is_taken(monkeypatch, dim):
    pencil = Pencil(np.diag([1.0, 2, 3]), np.eye(3), dim=dim)
    monkeypatch.setattr(checks, "MAX_BYTES", 128 * 7 * 9)
    assert pencil.matrices(np.ones(7) if dim == 1 else np.ones((2, 7)))[0].shape == (7, 3, 3)
    with pytest.raises(
        ValueError, match=r"^xi: the matrices of all wavevectors must fit into 0 GiB of memory, got shape"
    ):
        pencil.matrices(np.ones(8) if dim == 1 else np.ones((2, 8)))
    room = 1 if dim == 1 else 2 * directions.SPECIAL * directions.FAN.size
    monkeypatch.setattr(checks, "MAX_BYTES", 128 * 7 * 9 * room - 1)
    sentence = "^k: all directions of its wavenumbers must fit into 0 GiB of memory, got shape "
    with pytest.raises(ValueError, match=sentence + r"\(1, 7\)$"):
        max_growth(pencil, np.ones((1, 7)))
    monkeypatch.setattr(checks, "MAX_BYTES", 2 * 128 * 9 * room)
    assert max_growth(pencil, np.ones((1, 1))).growth.shape == (1, 1)


def test_the_largest_pencil():
    pencil = Pencil(np.diag(np.arange(1.0, 13)), np.eye(12))
    np.testing.assert_allclose(pencil.eigenvalues(1.0), -np.arange(1.0, 13), rtol=1e-14)


# ---------------------------------------------------------------- how a symbol is called


def test_a_symbol_that_serves_many_is_called_once_and_one_that_does_not_for_each():
    calls = []

    def spied(S):
        def f(xi):
            calls.append(np.shape(xi))
            return S(xi)

        return f

    def many(xi):
        return np.reshape(np.asarray(xi) ** 2 + 5, (*np.shape(xi), 1, 1))

    xi = np.array([0.1, 2.0, 30.0])
    one_for_all = Pencil(spied(many), [[1]], dim=1)
    one_for_all.matrices(xi)
    calls.clear()
    np.testing.assert_array_equal(one_for_all.matrices(xi)[0].ravel(), xi**2 + 5)
    assert calls == [(3,)]
    # Of the right shape, but with numbers that are not those of one wavevector alone, if only by a little.
    for wrong in (
        lambda xi: many(xi) + 0.1 * np.max(xi),
        lambda xi: 1e-3 * (many(xi) + np.max(xi)),
        lambda xi: many(xi) * (1 + 1e-9 * np.max(xi)),
    ):
        expected = [wrong(x).item() for x in xi]
        by_one = Pencil(spied(wrong), [[1]], dim=1)
        by_one.matrices(xi)
        calls.clear()
        np.testing.assert_array_equal(by_one.matrices(xi)[0].ravel(), expected)
        assert calls == [()] * 3
        swapped = Pencil([[1]], spied(wrong), dim=1)
        np.testing.assert_array_equal(swapped.matrices(xi)[1].ravel(), expected)


def test_equations_are_real_if_both_matrices_are_conjugate_at_the_opposite_wavevector():
    def real(S, E=1.0, dim=1):
        return Pencil(
            lambda xi: [[S(xi) if callable(S) else S]], lambda xi: [[E(xi) if callable(E) else E]], dim
        ).is_real

    assert real(lambda xi: xi**2 + 3j * xi**3 + 1)
    assert real(lambda xi: xi**2 / 3 + 1j * np.sin(xi) * (1 + 1e-14j), lambda xi: 1 + 1j * xi)
    assert real(lambda xi: 1j * xi[0] + xi[0] * xi[1], dim=2)
    for S, E in (
        (1 + 0.1j, 1), (1 + 1e-9j, 1), (1e-3j, 1), (lambda xi: xi, 1), (lambda xi: 1j * xi**2, 1), (1, 1 + 0.01j),
        (1, lambda xi: 3 + xi),
    ):  # fmt: skip
        assert not real(S, E)
    assert not real(lambda xi: 1j * xi[0] + xi[1], dim=2)


def test_which_call_of_a_symbol_works_says_the_number_of_space_variables():
    assert Pencil(EYE, EYE).dim == 1
    assert Pencil(lambda xi: [[xi]], [[1]]).dim == 1

    def nowhere(xi):
        raise RuntimeError("not for any wavevector")

    with pytest.raises(RuntimeError, match="not for any wavevector"):
        Pencil(nowhere, [[1]])
    xi_1, xi_2, xi = sympy.symbols("xi_1 xi_2 xi")
    one = sympy.eye(1)
    assert [Pencil(sympy.Matrix([[f]]), one).dim for f in (xi, xi_1, xi_2, xi_1 + xi_2, sympy.Integer(3))] == [
        1, 2, 2, 2, 1
    ]  # fmt: skip
    with pytest.raises(
        ValueError, match=r"^E must be a matrix in xi, or in xi_1, xi_2, xi_3, alone, got symbols xi, xi_1$"
    ):
        Pencil(one, sympy.Matrix([[xi + xi_1]]))
    plane = Pencil(sympy.Matrix([[xi_1 + 2 * sympy.I * xi_2]]), sympy.Matrix([[2]]))
    np.testing.assert_allclose(plane.eigenvalues([[1.0, 5.0], [3.0, -1.0]]), [[-0.5 - 3j], [-2.5 + 1j]])


def test_eigenvalues_are_sorted_and_what_is_undetermined_comes_last():
    pencil = Pencil(lambda xi: np.diag([xi, 3, -1, 0]), lambda xi: np.diag([xi - 1, 1, 1, 1]), dim=1)
    np.testing.assert_allclose(pencil.eigenvalues([2.0, 0.5]), [[1, 0, -2, -3], [1, 1, 0, -3]], atol=1e-15)
    np.testing.assert_allclose(pencil.eigenvalues(1.0), [1, 0, -3, np.nan], atol=1e-15)
    assert growth(pencil, 1.0) == 1


def test_without_time_derivatives_nothing_grows():
    for dim, xi in ((1, np.ones(3)), (2, np.ones((2, 3)))):
        pencil = Pencil(np.eye(2), np.zeros((2, 2)), dim=dim)
        assert pencil.count == 0
        np.testing.assert_array_equal(growth(pencil, xi), [-np.inf] * 3)
        np.testing.assert_array_equal(max_growth(pencil, np.ones(3)).growth, [-np.inf] * 3)


# ---------------------------------------------------------------- directions


def test_the_angle_of_a_direction():
    line = max_growth(Pencil(lambda xi: [[xi]], [[1]]), [[1.0, 2.0]])  # grows for xi < 0
    assert (line.direction.tolist(), line.angle.tolist()) == ([[-1, -1]], [[np.pi, np.pi]])
    line = max_growth(Pencil(lambda xi: [[-xi]], [[1]]), 3.0)
    assert (line.direction, line.angle) == (1, 0)


@pytest.mark.parametrize("towards", [0.0, 0.3, 2.0, np.pi, 4.0, 6.2])
def test_one_sided_growth_in_the_plane_is_found_all_round(towards):
    """u_t = -i d . grad u grows like xi . d, most of all for xi along d."""
    c, s = np.cos(towards), np.sin(towards)
    best = max_growth(Pencil(lambda xi: [[-(c * xi[0] + s * xi[1])]], [[1]], dim=2), [[1.0, 1e3], [2.0, 5.0]])
    np.testing.assert_allclose(best.growth, [[1.0, 1e3], [2.0, 5.0]], rtol=1e-15)
    np.testing.assert_allclose(np.exp(1j * best.angle), np.exp(1j * towards), rtol=1e-7)


def test_a_sign_without_eigenvalues_is_not_the_best():
    """(xi - 2) w = 0 and v_t = v (or -i v): at xi = 2 w is undetermined, at xi = -2 it is not."""
    pencil = Pencil(lambda xi: np.diag([xi - 2, -1 + 0 * xi]), np.diag([0, 1]), dim=1)
    best = max_growth(pencil, [1.0, 2.0])
    np.testing.assert_allclose(best.growth, [1, 1])
    assert best.direction.tolist() == [1, -1]
    nowhere = Pencil(lambda xi: np.diag([xi**2 - 4, -1 + 0 * xi]), np.diag([0, 1]), dim=1)
    assert np.isnan(max_growth(nowhere, 2.0).growth)


def test_a_direction_without_eigenvalues_counts_as_lowest():
    """w_x = 0 and v_t = v - v_yy: along y the unknown w is undetermined."""
    pencil = Pencil(lambda xi: np.diag([xi[0], -1 - xi[1] ** 2]), np.diag([0, 1]), dim=2)
    angle = np.array([[0.0, np.pi / 4]])
    pencil_along = Pencil(lambda xi: np.diag([xi[1], -1 - xi[0] ** 2]), np.diag([0, 1]), dim=2)
    rate, meeting = directions._rate_and_meeting(pencil_along, np.array([2.0]), angle)
    np.testing.assert_allclose(rate, [[directions.LOWEST, 3]])
    np.testing.assert_allclose(meeting, [[-directions.LOWEST, np.log(3)]])
    best = max_growth(pencil, 10.0)
    assert best.growth == pytest.approx(101, rel=1e-9)  # as near to y as can be
    none = Pencil(np.eye(1), np.zeros((1, 1)), dim=2)
    rate, meeting = directions._rate_and_meeting(none, np.ones(2), np.zeros((2, 3)))
    np.testing.assert_array_equal(rate, np.full((2, 3), directions.LOWEST))
    np.testing.assert_array_equal(meeting, np.zeros((2, 3)))
    together = Pencil(-np.eye(2), np.eye(2), dim=2)
    _, meeting = directions._rate_and_meeting(together, np.ones(1), np.zeros((1, 1)))
    np.testing.assert_allclose(meeting, np.log(np.finfo(float).tiny))


def test_of_too_few_local_maxima_the_first_is_repeated():
    angle = np.tile(np.arange(6) * np.pi / 6, (3, 1))
    f = np.array([[0.0, 3, 0, 5, 0, 1], [0, 3, 0, 0, 0, 0], [7, 7, 7, 7, 7, 7.0]])
    peaks, spacing = directions._highest(angle, f, np.pi, 3)
    np.testing.assert_allclose(peaks * 6 / np.pi, [[3, 1, 5], [1, 1, 1], [0, 1, 2]])
    np.testing.assert_allclose(spacing, np.pi / 6)
    peaks, _ = directions._highest(angle[:1], f[:1], np.pi, 2)
    np.testing.assert_allclose(peaks * 6 / np.pi, [[3, 1]])
    rounding = np.array([[1, 1 + 1e-12, 1, 1.5, 1, 1 + 1e-6]])
    peaks, _ = directions._highest(angle[:1], rounding, np.pi, 6)
    np.testing.assert_allclose(peaks * 6 / np.pi, [[3, 5]])
    negative = np.array([[-9, -2, -9, -9, -3, -9.0]])
    peaks, _ = directions._highest(angle[:1], negative, np.pi, 6)
    np.testing.assert_allclose(peaks * 6 / np.pi, [[1, 4]])


def test_local_maxima_of_random_scans_one_by_one():
    """Higher than both neighbours, the circle closed, or as high as any; the highest first, the earlier of equals."""
    random = np.random.default_rng(21)
    for number in (1, 2, 3, 9):
        angle = np.sort(random.uniform(0, np.pi, (12, 7)), axis=1)
        f = random.integers(-3, 4, angle.shape).astype(float)
        peaks, spacing = directions._highest(angle, f, np.pi, number)
        expected = []
        for row in f:
            found = [n for n in range(7) if row[n] > max(row[n - 1], row[(n + 1) % 7]) or row[n] == row.max()]
            expected.append(sorted(found, key=lambda n, row=row: -row[n])[:number])
        width = min(number, max(map(len, expected)))
        for x, found, top, wide in zip(angle, expected, peaks, spacing, strict=True):
            found += found[:1] * (width - len(found))
            np.testing.assert_array_equal(top, x[found])
            beside = [max((x[n] - x[n - 1]) % np.pi, (x[(n + 1) % 7] - x[n]) % np.pi) for n in found]
            np.testing.assert_allclose(wide, beside)


def test_each_peak_is_followed_by_itself():
    """Two wavenumbers and two peaks each, of width and height that differ, from places of their own."""
    tops = np.array([[0.3, 1.2], [2.0, -0.5]])

    def hills(pencil, k, angle):
        nearest = np.abs(angle[:, :, None] - tops[:, None, :]).min(axis=2)
        return 7 * k[:, None] - nearest

    start = np.array([[0.32, 1.17], [2.04, -0.5]])
    found = directions._followed(None, np.array([1.0, 5.0]), start, np.array([[0.1, 0.05], [0.05, 0.1]]), hills)
    np.testing.assert_allclose(found, tops, atol=2e-15)
    level = directions._followed(None, np.ones(2), start, 0.1, lambda *a: np.ones(a[2].shape))
    np.testing.assert_array_equal(level, start)


@pytest.mark.parametrize("towards", [1e-4, 0.70002, 3.1415, 4.00003])
@pytest.mark.parametrize("power", [1, 2])
def test_a_narrow_window_of_growth_is_found_wherever_it_is(towards, power):
    """lambda = (d . xi)^power +- sqrt(eps^2 (d . xi)^2 - (n . xi)^2): 1 + eps along d, in a window eps wide."""
    c, s, eps = np.cos(towards), np.sin(towards), 1e-5

    def S(xi):
        along, across = c * xi[0] + s * xi[1], c * xi[1] - s * xi[0]
        return [[-(along**power), -((eps * along) ** 2 - across**2)], [-1, -(along**power)]]

    best = max_growth(Pencil(S, np.eye(2), dim=2), 1.0)
    assert best.growth == pytest.approx(1 + eps, abs=1e-10)
    assert best.direction @ [c, s] * (1 if power == 1 else np.sign(best.direction @ [c, s])) == pytest.approx(1)
