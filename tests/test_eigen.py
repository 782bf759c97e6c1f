"""Guards the finite eigenvalues from within: equilibration, starting values, the iteration, and what is told apart.

Second routes: pencils made of eigenvalues chosen beforehand, and sums over those.
"""

import numpy as np
import pytest

import primer.analysis.eigen as eigen

INF = np.inf


def unitary(random, size):
    return np.linalg.qr(random.normal(size=(size, size)) + 1j * random.normal(size=(size, size)))[0]


def with_eigenvalues(random, eigenvalues):
    """(S, E), each of shape (1, k, k), with det(lambda E + S) = 0 at these lambda, of which some may be infinite."""
    values = np.array(eigenvalues, dtype=complex)
    finite = np.isfinite(values)
    left, right = unitary(random, len(values)), unitary(random, len(values))
    size = np.abs(values[finite]).max()
    return (left @ np.diag(np.where(finite, -values, size)) @ right)[None], (left @ np.diag(finite) @ right)[None]


def some_eigenvalues(random, size):
    """Their real parts well apart, so that they can be sorted."""
    return random.permutation(np.arange(size) - 1.3) * 2 + 1j * random.normal(size=size)


def batch(pairs):
    return tuple(np.concatenate(matrices) for matrices in zip(*pairs, strict=True))


def test_an_inverse_that_cannot_be_computed_with_is_zero():
    z = np.array([0, 1e-151, 1e-150, 1e-149, 2j, -4, 1e149j, 1e150, 1e151, INF, np.nan], dtype=complex)
    np.testing.assert_allclose(eigen._inverse(z), [0, 0, 0, 1e149, -0.5j, -0.25, -1e-149j, 0, 0, 0, 0], rtol=1e-14)


def test_the_logarithmic_derivative_is_a_sum_over_eigenvalues():
    """f'/f = sum of 1/(lambda - lambda_j), whatever the size of rows and columns, and infinite eigenvalues left out."""
    random = np.random.default_rng(21)
    for size in (1, 2, 3, 4):
        values = [some_eigenvalues(random, size) for _ in range(3)]
        given = [np.append(one, [INF] * extra) for one, extra in zip(values, (0, 0, 0), strict=True)]
        S, E = batch([with_eigenvalues(random, one) for one in given])
        lam = random.normal(size=(3, 2)) + 5j + 1j * random.normal(size=(3, 2))
        expected = [[(1 / (x - one)).sum() for x in row] for row, one in zip(lam, values, strict=True)]
        np.testing.assert_allclose(eigen._log_derivative(S, E, lam), expected, rtol=1e-12)
        rows, columns = (10.0 ** random.uniform(-40, 40, size) for _ in "rc")
        S, E = (rows[:, None] * columns * a for a in (S, E))
        np.testing.assert_allclose(eigen._log_derivative(S, E, lam), expected, rtol=1e-12)
    S, E = with_eigenvalues(random, [2, INF, -3, INF])
    np.testing.assert_allclose(eigen._log_derivative(S, E, np.array([[1, 1j]])), [[-0.75, 1 / (1j - 2) + 1 / (1j + 3)]])


def test_at_an_eigenvalue_the_logarithmic_derivative_is_infinite():
    S, E = -np.array([np.diag([1, 2]), np.diag([5, 7])]).astype(complex), np.array([np.eye(2), np.eye(2)])
    found = eigen._log_derivative(S, E, np.array([[1, 3], [6, 7]], dtype=complex))
    np.testing.assert_allclose(found, [[INF, 1.5], [0, INF]], atol=1e-15)


def test_equilibration_divides_rows_and_columns_by_powers_of_two():
    random = np.random.default_rng(22)
    for size in (1, 2, 4):
        powers = random.integers(-80, 80, (2, 5, size))
        near_one = random.uniform(0.5, 1, (5, size, size)) * np.exp(1j * random.normal(size=(5, size, size)))
        A = near_one * np.exp2(powers[0])[:, :, None] * np.exp2(powers[1])[:, None]
        scaled, rows, columns = eigen._scaled(A)
        np.testing.assert_array_equal(scaled, rows[:, :, None] * A * columns[:, None, :])
        for factors in (rows, columns):
            np.testing.assert_array_equal(np.log2(factors), np.round(np.log2(factors)))
        columns, rows = (np.log2(np.abs(scaled).max(axis=axis)) for axis in (1, 2))
        assert (np.abs(columns) <= 0.5).all()  # to the nearest power
        assert (rows <= 0.5).all()
        assert (rows > -20).all()  # of -80 to 80, halved with each of three sweeps


def test_equilibration_leaves_zeros_and_goes_no_further_than_can_be_inverted():
    scaled, rows, columns = eigen._scaled(np.array([[0, 8.0, 0], [0, 0, 0], [0, 0, 2.0**-20]]))
    np.testing.assert_array_equal(scaled, np.diag([1, 1], 1)[[0, 2, 1]] * [[0, 1, 0], [0, 0, 0], [0, 0, 1]])
    assert (rows[1], columns[0]) == (1, 1)
    for size in (2.0**-1000, 2.0**1000):
        scaled, rows, columns = eigen._scaled(np.full((2, 2), size))
        assert ((rows >= eigen.LEAST) & (rows <= 1 / eigen.LEAST)).all()
        assert ((columns >= eigen.LEAST) & (columns <= 1 / eigen.LEAST)).all()
        np.testing.assert_array_equal(scaled, rows[:, None] * columns * size)


def test_the_first_guess_of_a_size():
    S, E = (
        np.array(sizes)[:, None, None] * np.array([[0.5, 0], [0, -1j]])
        for sizes in ([6, 0, 5, 0, 0.5], [2, 4, 0, 0, 0.25])
    )
    np.testing.assert_array_equal(eigen._size(S, E), [3, 0.25, 1, 1, 2])


@pytest.mark.parametrize("scale", [1e-30, 1.0, 1e30])
def test_pencils_are_singular_only_if_their_determinant_vanishes_for_every_lambda(scale):
    random = np.random.default_rng(23)
    one, two = (random.normal(size=(4, 4)) + 1j * random.normal(size=(4, 4)) for _ in "SE")
    shared = one.copy()
    shared[3] = (1 + 2j) * shared[0]
    both = two.copy()
    both[3] = (1 + 2j) * both[0]
    E_singular = np.diag([1.0, 1, 0, 0])
    nearly = both.copy()
    nearly[3, 2] *= 1 + 1e-12
    pairs = [(shared, both), (one, two), (one, E_singular), (shared, two), (shared, nearly), (0 * one, 0 * two)]
    S, E = (np.array(matrices).astype(complex) for matrices in zip(*pairs, strict=True))
    np.testing.assert_array_equal(eigen._singular(scale * S, E), [True, False, False, False, False, True])
    np.testing.assert_array_equal(eigen._singular(S, scale * E), [True, False, False, False, False, True])


def test_a_pencil_is_not_singular_for_an_eigenvalue_where_that_is_tried():
    for lam in (0.83 + 0.61j, -0.29 + 1.37j):
        S, E = np.array([np.diag([-lam / 2, 1])]), np.array([np.diag([0.5, 1])])
        assert eigen._size(S, E) == 1
        assert not eigen._singular(S, E)[0]
        np.testing.assert_allclose(np.sort_complex(eigen.finite_eigenvalues(S, E, 2)[0]), np.sort_complex([lam, -1]))


@pytest.mark.parametrize("infinite", [0, 1, 2])
def test_starting_values_are_the_eigenvalues_of_a_library(infinite):
    random = np.random.default_rng(24)
    for size in (1, 2, 3):
        values = [some_eigenvalues(random, size) * scale for scale in (1.0, 1e-6, 1e6)]
        S, E = batch([with_eigenvalues(random, np.append(one, [INF] * infinite)) for one in values])
        for solvable in (False,) if infinite else (False, True):
            found = eigen._start(S, E, size, solvable)
            assert found.shape == (3, size)
            np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(values), rtol=1e-7)


def steps(monkeypatch):
    """A list that grows by the number of pencils with each step of the iteration."""
    seen, inner = [], eigen._log_derivative
    monkeypatch.setattr(eigen, "_log_derivative", lambda S, *rest: seen.append(len(S)) or inner(S, *rest))
    return seen


def test_the_iteration_takes_few_steps_to_rounding_level_and_moves_the_active_only(monkeypatch):
    random, seen = np.random.default_rng(25), steps(monkeypatch)
    exact = np.array([[1.0, 1e-8, -3e8], [2.0, -5.0, 7.0]]) * np.exp(0.3j)
    S, E = -np.array([np.diag(row) for row in exact]), np.array([np.eye(3)] * 2)
    S[0, 0, 1], S[1, 0, 2] = 7e3, -2.0  # triangular: the same eigenvalues, not normal
    off = exact * (1 + 0.1 * random.normal(size=exact.shape))
    found = eigen._polished(S, E, off.copy(), np.full(exact.shape, True))
    assert (np.abs(found - exact) <= 4 * eigen.EPS * np.abs(exact)).all()
    assert 4 <= len(seen) <= 8
    seen.clear()
    np.testing.assert_array_equal(eigen._polished(S, E, exact.copy(), np.full(exact.shape, True)), exact)
    assert len(seen) == 1
    active = np.array([[False, True, False], [False] * 3])
    some = np.where(active, off, exact)
    found = eigen._polished(S, E, some.copy(), active.copy())
    np.testing.assert_array_equal(found[~active], some[~active])
    assert abs(found[0, 1] - exact[0, 1]) <= 4 * eigen.EPS * abs(exact[0, 1])
    assert set(seen[1:]) == {1}  # the second pencil takes no part
    seen.clear()
    eigen._polished(S, E, some.copy(), np.full(active.shape, False))
    assert not seen


def test_a_double_eigenvalue_ends_the_iteration_where_it_gets_no_better(monkeypatch):
    seen = steps(monkeypatch)
    S, E = -np.array([[[2.0, 1.0], [0.0, 2.0]]], dtype=complex), np.eye(2)[None]
    found = eigen._polished(S, E, np.array([[1.5 + 0.3j, 3.0]]), np.full((1, 2), True))
    np.testing.assert_allclose(found, [[2, 2]], rtol=1e-7)
    assert len(seen) < 50


def test_what_runs_away_to_infinity_is_not_a_number():
    """Two are sought where one is finite, beside a pencil that has both."""
    for finite in (3 + 1j, -2e5, 1e-4j, 2e-30, 3e30):
        S = -np.array([np.diag([finite, 1]), np.diag([1, finite])]).astype(complex)
        E = np.array([np.diag([1.0, 0]), np.eye(2)])
        found = eigen.finite_eigenvalues(S[:, :, ::-1] * [[2], [3]], E[:, :, ::-1] * [[2], [3]], 2)
        assert np.isnan(found[0]).sum() == 1
        assert found[0][~np.isnan(found[0])] == pytest.approx([finite], rel=1e-14)
        assert sorted(found[1], key=abs) == pytest.approx(sorted([1, finite], key=abs), rel=1e-14)
    for values, E in (([1.0, 3, -1, 0], [0, 1, 1, 1]), ([2.0, 1e-3, 1e5, 1], [1, 1, 1, 0])):
        found = eigen.finite_eigenvalues(np.diag(values)[None], np.diag(E)[None], 4)[0]
        expected = [-value for value, e in zip(values, E, strict=True) if e]
        np.testing.assert_allclose(np.sort(found.real), np.sort([*expected, np.nan]), rtol=1e-14, atol=1e-300)
    found = eigen.finite_eigenvalues(np.diag([1.0, 1, -5])[None], np.diag([0, 0, 1.0])[None], 3)[0]
    assert np.isnan(found).sum() == 2
    assert found[~np.isnan(found)] == pytest.approx([5], rel=1e-14)


@pytest.mark.parametrize("infinite", [0, 1, 2])
def test_finite_eigenvalues_are_those_chosen(infinite):
    random = np.random.default_rng(27)
    for size in (1, 2, 3, 4):
        values = [some_eigenvalues(random, size) * scale for scale in (1.0, 1e-9, 1e9)]
        S, E = batch([with_eigenvalues(random, np.append(one, [INF] * infinite)) for one in values])
        assert [eigen.degree(s, e) for s, e in zip(S[:1], E[:1], strict=True)] == [size]
        found = eigen.finite_eigenvalues(S, E, size)
        np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(values), rtol=1e-12)
        rows, columns = (10.0 ** random.uniform(-20, 20, S.shape[1]) for _ in "rc")
        again = eigen.finite_eigenvalues(*(rows[:, None] * columns * a for a in (S, E)), size)
        np.testing.assert_allclose(np.sort_complex(again), np.sort_complex(values), rtol=1e-11)


def test_singular_pencils_among_others_and_none_at_all():
    S, E = np.array([np.diag([-3, 1]), np.diag([-3, 0])]).astype(complex), np.array([np.diag([1.0, 0])] * 2)
    np.testing.assert_allclose(eigen.finite_eigenvalues(S, E, 1), [[3], [np.nan]])
    np.testing.assert_array_equal(eigen.finite_eigenvalues(S[1:], E[1:], 1), [[np.nan]])
    assert eigen.finite_eigenvalues(S[:1], 0 * E[:1], 0).shape == (1, 0)
    assert eigen.finite_eigenvalues(S[:0], E[:0], 1).shape == (0, 1)
    assert eigen.finite_eigenvalues(np.array([[[5.0]]]), np.array([[[0.0]]]), 0).shape == (1, 0)
    whole = np.array([np.eye(2), np.diag([1.0, 0])])
    np.testing.assert_allclose(np.sort_complex(eigen.finite_eigenvalues(S[[0, 1]], whole, 2)[0]), [-1, 3])
    assert np.isnan(eigen.finite_eigenvalues(S[[0, 1]], whole, 2)[1]).all()


def test_the_degree_of_a_determinant():
    eye, shift, none = np.eye(2), np.array([[0, 1], [0, 0]]), np.zeros((2, 2))
    assert [eigen.degree(eye, E) for E in (eye, shift, none)] == [2, 0, 0]
    assert [eigen.degree(none, E) for E in (eye, shift, none)] == [2, -1, -1]
    assert eigen.degree(shift, shift.T) == 1
    for gap, degree in ((1e-11, 0), (1e-13, -1)):  # below that it is rounding
        assert eigen.degree(np.array([[1, 1], [1, 1 + gap]]), none) == degree


def test_values_that_ran_into_one_are_told_apart_and_others_left():
    E = np.array([np.eye(3, dtype=complex)] * 4)
    exact = np.array([[1, 2, 3], [1, 2, 3], [1, 1 + 1e-7, 3], [5, 5, 5]])
    S = -np.array([np.diag(row) for row in exact]).astype(complex)
    start = np.array([[2, 2, 2], [1, 2, 3.5], [1, 1 + 1e-7, 3], [5, 5, 5]], dtype=complex)
    found = eigen._told_apart(S, E, start.copy())
    np.testing.assert_allclose(np.sort(found[0].real), [1, 2, 3], rtol=1e-12)
    assert found[0, 0] == 2  # the first keeps its place
    np.testing.assert_array_equal(found[1:], start[1:])
    assert eigen._told_apart(S[1:2], E[:1], start[1:2]) is not None


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("small", [1e-3, 1e-9, 1e-15])
def test_a_small_eigenvalue_taken_for_a_second_zero_is_found(small, scale):
    S, E = -scale * np.array([np.diag([0, small, 1])]).astype(complex), np.eye(3, dtype=complex)[None]
    found = eigen._told_apart(S, E, scale * np.array([[0, 0, 1]], dtype=complex))
    np.testing.assert_allclose(np.sort(found[0].real), [0, scale * small, scale], rtol=1e-12, atol=0)
    S = -scale * np.array([np.diag([0, 0, 1])]).astype(complex)
    found = eigen._told_apart(S, E, scale * np.array([[0, 0, 1]], dtype=complex))
    np.testing.assert_array_equal(found, scale * np.array([[0, 0, 1]]))


def test_eigenvalues_that_nearly_meet_are_as_near_as_rounding_lets_them_be():
    """[[c, c d], [c, c]] has c (1 +- sqrt d); an error e of its entries moves them by e/sqrt d, or sqrt e at most."""
    random = np.random.default_rng(28)
    c, d = random.uniform(0.5, 2, 600), 10 ** random.uniform(-20, -4, 600) * random.choice([-1, 1], 600)
    M = c[:, None, None] * np.stack([np.stack([d**0, d], -1), np.ones((600, 2))], 1)
    found = eigen.finite_eigenvalues(-M.astype(complex), np.tile(np.eye(2), (600, 1, 1)), 2)
    root = c * np.sqrt(d.astype(complex))
    gaps = [np.abs(found - c[:, None] - sign * np.stack([root, -root], 1)).max(axis=1) for sign in (1, -1)]
    assert (np.min(gaps, axis=0) <= 8 * np.minimum(np.sqrt(eigen.EPS), eigen.EPS / np.abs(root))).all()


@pytest.mark.parametrize(("last", "end"), [(1e-9, 2.0), (1e-3, 2.0 - 1e-2)])
def test_a_step_that_grows_again_at_rounding_level_is_not_taken(monkeypatch, last, end):
    """f'/f is rounding where two eigenvalues meet. Steps of 0.1, then ``last``, then ten times as much or more."""
    steps = iter([0.1, last, 1e-2, 1e-300])
    monkeypatch.setattr(eigen, "_log_derivative", lambda S, E, lam: np.array([[1 / next(steps)]]) + 0j)
    one = np.ones((1, 1, 1), dtype=complex)
    found = eigen._polished(one, one, np.array([[2.1 + last + 0j]]), np.array([[True]]))
    assert found.item() == pytest.approx(end, abs=1e-12)
