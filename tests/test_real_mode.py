"""Guards the quick search for a real fastest mode: it names the fastest of the whole Jacobian, or says nothing."""

import numpy as np
import pytest

from primer import Toy
from primer.study.real_mode import form, nothing_grows, surely_fastest
from primer.study.spectrum import Parity, jacobian, leader


def scenes(count, seed):
    random = np.random.default_rng(seed)
    for _ in range(count):
        dt = 10 ** random.uniform(-5, -1.7) * (random.random() < 0.7)
        yield Toy(random.uniform(-1, 2), 10 ** random.uniform(-3, -0.5)), int(random.integers(8, 81)), dt


def dense(toy, n, dt):
    """Growth per unit time of all modes of the matrix in x, but those that are exactly neutral, fastest first."""
    lam = np.linalg.eigvals(jacobian(toy, n))
    lam = lam[np.abs(lam) > 1e-6]
    return np.sort(np.log(np.abs(1 + dt * lam)) / dt if dt else lam.real)[::-1]


def test_it_is_the_fastest_of_the_whole_jacobian_or_nothing_is_said():
    said = []
    for toy, n, dt in scenes(300, 11):
        found = surely_fastest(toy, n, dt)
        said.append(found is not None)
        if found:
            rate = np.log(np.abs(1 + dt * found[0])) / dt if dt else found[0]
            assert rate == pytest.approx(dense(toy, n, dt)[0], rel=1e-6, abs=1e-8), (toy, n, dt)
    assert 100 < sum(said) < 300


def test_its_vector_solves_the_quadratic_problem():
    for toy, n, dt in scenes(60, 12):
        found = surely_fastest(toy, n, dt)
        if found:
            lam, parity, y = found
            _, s, d, e = form(toy, n, parity)
            B = np.diag(d) + np.diag(e, 1) + np.diag(e, -1)
            terms = np.array([lam**2 * y, lam * B @ y, s**2 * y])
            assert np.abs(terms.sum(axis=0)).max() < 1e-6 * np.abs(terms).max()


def test_where_nothing_grows_no_eigenvalue_is_on_the_right():
    plain = [nothing_grows(toy, n) for toy, n, _ in scenes(100, 13)]
    for (toy, n, _), nothing in zip(scenes(100, 13), plain, strict=True):
        assert not nothing or dense(toy, n, 0.0)[0] <= 1e-9
    assert 20 < sum(plain) < 80
    assert nothing_grows(Toy(0.5, 0.0), 40)


def test_the_leader_is_the_same_by_either_way():
    for toy, n, dt in scenes(100, 14):
        lam = leader(toy, n, dt)[0]
        rate = np.log(np.abs(1 + dt * lam)) / dt if dt else lam.real
        assert rate == pytest.approx(dense(toy, n, dt)[0], rel=1e-6, abs=1e-8)


@pytest.mark.parametrize("n", [4, 5, 6, 7])
def test_the_coarsest_grids(n):
    assert nothing_grows(Toy(1.5), n)
    assert leader(Toy(0.5), n)[0].real < 0
    assert surely_fastest(Toy(1.5, 0.0), n) is None
    assert len(form(Toy(1.5), n, Parity.OPPOSITE)[0]) == n // 2
