"""Guards the grid threshold: its spectrum against the dense Jacobian, that against finite differences and runs."""

import itertools
import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

from primer import Toy, checks, ftcs, grid_threshold
from primer.schemes.discrete import discrete_steady
from primer.schemes.grid import Grid
from primer.study import spectrum, threshold
from primer.study.lanczos import grows
from primer.study.spectrum import Parity, depth, fastest, growing, growth, jacobian, rate
from primer.study.stability import frozen_dt
from primer.study.threshold import _first_unstable, _quarter_ratio, _sawtooth_ratio, unstable


def dense_rates(toy, n):
    """All growth rates but the neutral ones: the constant u and, for even n, the sawtooth of u."""
    lam = np.linalg.eigvals(jacobian(toy, n))
    neutral = np.argsort(np.abs(lam))[: 1 + (n % 2 == 0)]
    assert np.abs(lam[neutral]).max() < 1e-6  # a double zero, to the square root of round-off
    return np.delete(lam, neutral)


@pytest.mark.parametrize("n", [4, 7, 12, 31])
def test_jacobian_is_the_derivative_of_the_right_hand_side(n):
    """Against central differences of rhs, exact but for round-off since rhs is quadratic; about no special state."""
    grid, toy, step = Grid(n), Toy(0.3, 0.2), 1e-3
    state = np.random.default_rng(n).normal(size=(2, n))

    def rates(z):
        return np.concatenate(toy.rhs(grid.x, z.reshape(2, n), grid.derivative))

    columns = [(rates(state.ravel() + step * e) - rates(state.ravel() - step * e)) / (2 * step) for e in np.eye(2 * n)]
    np.testing.assert_allclose(jacobian(toy, n, state), np.transpose(columns), atol=1e-9)
    np.testing.assert_array_equal(jacobian(toy, n), jacobian(toy, n, discrete_steady(toy, grid.x, grid.h)))


@pytest.mark.parametrize(("n", "expected"), [(64, 0.02465), (80, 0.613077), (100, 2.727232), (200, 18.17513)])
def test_growth_is_that_of_the_reference(n, expected):
    """physics.md, section 1."""
    assert growth(Toy(0.5), n) == pytest.approx(expected, rel=2e-5)


@pytest.mark.parametrize("seed", range(30))
def test_fastest_mode_is_the_dense_one(seed):
    random = np.random.default_rng(seed)
    toy, n = Toy(random.uniform(-2, 1.2), 10 ** random.uniform(-3, 0)), int(random.integers(4, 90))
    lam = dense_rates(toy, n)
    mode = fastest(toy, n)
    assert mode.lam.real == pytest.approx(lam.real.max(), abs=1e-8 * np.abs(lam).max())
    z = np.concatenate([mode.u, mode.v])
    J = jacobian(toy, n)
    assert np.abs(J @ z - mode.lam * z).max() < 1e-9 * np.abs(J).max()
    sign = 1 if mode.parity is Parity.DATA else -1
    mirrored = -np.arange(n) % n
    np.testing.assert_allclose(mode.u[mirrored], sign * mode.u, atol=1e-8)
    np.testing.assert_allclose(mode.v[mirrored], -sign * mode.v, atol=1e-8)


def test_the_growing_modes_are_all_of_the_jacobian():
    random = np.random.default_rng(8)
    for _ in range(12):
        toy, n = Toy(random.uniform(-2, 1.2), 10 ** random.uniform(-2.5, -1)), int(random.integers(20, 70))
        J, modes = jacobian(toy, n), growing(toy, n)
        assert modes[0].lam == fastest(toy, n).lam
        for mode in modes:
            z = np.concatenate([mode.u, mode.v])
            assert np.abs(J @ z - mode.lam * z).max() < 1e-9 * np.abs(J).max()
        lam = dense_rates(toy, n)
        found = np.array([mode.lam for mode in modes])
        for one in lam[(lam.real > 1e-6) & (lam.imag >= 0)]:
            assert np.abs(found - one).min() < 1e-7 * np.abs(lam).max()
        assert (found.real > 0).all() or len(found) == 1
        assert (np.diff(found.real) <= 0).all()


@pytest.mark.slow
def test_structured_search_finds_what_the_dense_one_does(monkeypatch):
    """On fine grids a few inverse iterations replace all eigenvalues: with and without a time step."""
    random, cases = np.random.default_rng(1), []
    for _ in range(25):
        toy, n = Toy(random.uniform(-1, 2), 10 ** random.uniform(-3, -1)), int(random.integers(101, 190))
        cases += [(toy, n, 0.0), (toy, n, 10 ** random.uniform(-5, -1.7))]
    quick = [growth(*case) for case in cases]
    monkeypatch.setattr(spectrum, "_DENSE", 10**6)
    dense = [growth(*case) for case in cases]
    assert sum(g > 0 for g in dense) > 15
    for (_, _, dt), a, b in zip(cases, quick, dense, strict=True):
        assert (a > 0) == (b > 0)
        if b > 0 or dt == 0:
            assert a == pytest.approx(b, rel=1e-6)


@pytest.mark.parametrize("n", [101, 128, 200])
@pytest.mark.parametrize("eps", [1e-3, 0.01, 0.1])
def test_what_decays_last_is_found_too(n, eps):
    """Where nothing grows: against all eigenvalues of the dense Jacobian but those that are exactly neutral."""
    for a in (0.5, 0.97, 1.5, 8.0):
        lam = np.linalg.eigvals(jacobian(Toy(a, eps), n)).real
        assert growth(Toy(a, eps), n) == pytest.approx(lam[np.abs(lam) > 1e-9].max(), rel=1e-6), a


def test_the_structured_search_starts_near_what_it_seeks():
    """The fastest sawtooth, a packet near k = n/4, the wave first to grow at x = 0, the stiffest mode at x = -pi."""
    toy, n, dt = Toy(-0.5, 0.02), 150, 1e-3
    lam = np.linalg.eigvals(jacobian(toy, n))
    sawtooth = spectrum._shifts(toy, n, 0.0)[0]
    assert sawtooth == pytest.approx(lam[np.argmax(lam.real)], rel=1e-2)
    assert abs(sawtooth - lam[np.argmax(lam.real)]) < abs(sawtooth - depth(toy, n))  # nearer than the frozen one
    toy, n, dt = Toy(1.2, 0.01), 120, 1e-2
    lam, h = np.linalg.eigvals(jacobian(toy, n)), Grid(n).h
    _, packet, first, stiffest = spectrum._shifts(toy, n, dt)
    assert np.abs(lam - packet).min() < 0.02 * abs(packet)
    assert stiffest == pytest.approx(lam.real.min(), rel=0.02)
    u = toy.a - h / math.sin(h)
    xi = np.linspace(0, math.pi / h, 20001)
    frozen = np.linalg.eigvals(toy.symbol(xi, u, multiplier=Grid(n).multiplier))
    limit = frozen_dt(h, u, toy.eps)  # at this step one wave is neutral, and the others decay
    waves = frozen[frozen.imag > 1]
    neutral = waves[np.argmax(np.abs(1 + limit * waves))]
    assert abs(1 + limit * neutral) == pytest.approx(1, abs=1e-3)
    assert abs(first - 1e-3j - neutral) < 1e-4 * abs(first)


def test_content_is_the_expansion_in_eigenvectors():
    toy, n = Toy(0.5), 64
    mode, z = fastest(toy, n), np.random.default_rng(0).normal(size=2 * n)
    lam, vectors = np.linalg.eig(jacobian(toy, n))
    k = np.argmin(np.abs(lam - mode.lam))
    expected = np.linalg.solve(vectors, z)[k] * vectors[:, k]
    np.testing.assert_allclose(mode.content(z[:n], z[n:]) * np.concatenate([mode.u, mode.v]), expected, atol=1e-10)


def test_nothing_grows_where_the_frozen_sawtooth_does_not():
    """The proof is in the module; here dense eigenvalues on 60 grids below the frozen estimate."""
    random, seen = np.random.default_rng(2), 0
    while seen < 60:
        toy, n = Toy(random.uniform(-1, 1.1), 10 ** random.uniform(-3, -1)), int(random.integers(4, 60))
        if depth(toy, n) <= 0:
            assert dense_rates(toy, n).real.max() < 1e-8
            seen += 1


def test_threshold_of_the_paper():
    found = grid_threshold(a=0.5, eps=0.01)
    assert found.frozen == pytest.approx(44.4288293816, rel=1e-10)
    assert found.n == 64
    assert found.mode.lam.real == pytest.approx(0.02465, abs=1e-5)
    assert found.mode.parity is Parity.OPPOSITE


@pytest.mark.parametrize(
    ("a", "eps"), [(0.5, 0.02), (0.0, 0.01), (-0.88, 0.0013), (-1.9, 0.009), (0.75, 0.03), (0.95, 0.06), (0.3, 1.5)]
)
def test_threshold_is_the_first_of_all_grids(a, eps):
    toy, n = Toy(a, eps), 4
    while dense_rates(toy, n).real.max() <= 1e-9:
        n += 1
    assert grid_threshold(a, eps).n == n


def test_odd_and_even_grids_have_thresholds_of_their_own():
    toy = Toy(-0.8798, 0.0013)
    assert [unstable(toy, n) for n in (73, 74, 75, 76, 77)] == [False, False, True, False, True]


@pytest.mark.parametrize(("a", "eps"), [(1.0, 0.01), (1.0, 1.0), (1.5, 0.1), (7, 3), (0.5, 0), (2, 0)])
def test_no_threshold(a, eps):
    found = grid_threshold(a, eps)
    assert found.frozen == math.inf
    assert found.n is None
    assert found.mode is None


def test_near_a_1_the_first_mode_is_near_a_quarter_of_the_grid():
    found = grid_threshold(0.9, 1e-3)
    spectrum_of_v = np.abs(np.fft.fft(found.mode.v))[: found.n // 2]
    assert np.argmax(spectrum_of_v) == pytest.approx(found.n / 4, rel=0.1)
    assert found.mode.lam.imag == pytest.approx(found.n / (2 * math.pi), rel=0.02)


@dataclass(frozen=True)
class FromSteady:
    """The toy system from its discrete steady state, with a little of its fastest mode."""

    toy: Toy
    n: int
    amplitude: float
    fields: ClassVar[tuple[str, ...]] = ("u", "v")

    def initial(self, x):
        mode = fastest(self.toy, self.n)
        u, v = discrete_steady(self.toy, x, Grid(self.n).h)
        return u + self.amplitude * mode.u.real, v + self.amplitude * mode.v.real

    def __getattr__(self, name):
        return getattr(self.toy, name)


@pytest.mark.parametrize(("n", "dt"), [(66, 1e-3), (80, 1e-3), (100, 1e-3), (100, 4e-3), (57, 1e-3)])
def test_runs_grow_at_the_rate_of_the_eigenvalue(n, dt):
    """Slope of ln(perturbation), to 1 %; what is measured is how much of the mode there is in u, v - steady."""
    toy = Toy(0.5)
    mode = fastest(toy, n, dt)
    times = tuple(np.linspace(0.2, 2.2, 9))
    run = ftcs(FromSteady(toy, n, 1e-7), n, dt, times[-1], snapshots=times)
    steady = np.array(discrete_steady(toy, run.x, Grid(n).h))
    size = [abs(mode.content(*(run.snapshots[t] - steady))) for t in times]
    slope = np.polyfit(np.round(np.array(times) / dt) * dt, np.log(size), 1)[0]
    assert slope == pytest.approx(growth(toy, n, dt), rel=0.01)


def test_bad_input_gets_one_sentence():
    with pytest.raises(TypeError, match="a must be a finite number, got 'x'"):
        grid_threshold("x")
    with pytest.raises(ValueError, match="eps must be a finite number >= 0, got -1"):
        grid_threshold(0.5, -1)
    with pytest.raises(ValueError, match="must be more than about"):
        grid_threshold(0.5, 1e-14)


@pytest.mark.parametrize("a", [-3.0, 0.0, 0.5, 0.9])
def test_where_the_sawtooth_begins_to_grow(a):
    """The equation of which the search takes the root: 2 (r - 1)^3 = r/(2 (1 - a))."""
    r = _sawtooth_ratio(a)
    assert r > 1
    assert 2 * (r - 1) ** 3 == pytest.approx(r / (2 * (1 - a)), rel=1e-12)


@pytest.mark.parametrize(("eps", "frozen"), [(0.01, 100.0), (1e-3, 314.0), (0.1, 40.0)])
def test_where_packets_near_a_quarter_of_the_grid_begin_to_grow(eps, frozen):
    """(r - 2)/4 = sqrt(eps n/(16 pi)) with n = frozen sqrt(r)."""
    r = _quarter_ratio(eps, frozen)
    assert (r - 2) / 4 == pytest.approx(math.sqrt(eps * frozen * math.sqrt(r) / (16 * math.pi)), rel=1e-12)


def test_the_search_finds_the_first_of_any_unstable_grids(monkeypatch):
    """Whatever the threshold of each n mod 4, six points apart at most, against looking at every grid."""
    random = np.random.default_rng(0)
    for _ in range(400):
        starts = np.repeat(random.integers(4, 300, size=2), 2).reshape(2, 2) + random.integers(0, 2, size=(2, 2)) * 6
        monkeypatch.setattr(threshold, "unstable", lambda toy, n, starts=starts: n >= starts[n % 2, n // 2 % 2])
        first = next(n for n in itertools.count(4) if threshold.unstable(None, n))
        assert _first_unstable(Toy(0.5), random.uniform(5, 400)) == first


def test_coarse_grids_are_looked_at_one_by_one(monkeypatch):
    """The seeing of these needs not grow with n: one of them, and then none up to 100."""
    for single in range(4, 33):
        monkeypatch.setattr(threshold, "unstable", lambda toy, n, single=single: n == single or n >= 100)
        assert _first_unstable(Toy(0.5), 70.0) == single


def test_grids_over_a_million_points_are_not_looked_at(monkeypatch):
    toy, tried = Toy(0.75, 1e-2), []
    monkeypatch.setattr(threshold, "unstable", lambda toy, n: tried.append(n) or n > 999_000)
    r = _sawtooth_ratio(0.75)  # the quarter's comes later there
    assert _first_unstable(toy, 0.99999e6 / math.sqrt(r)) == 999_001
    assert max(tried) < 1.03e6
    assert r < _quarter_ratio(1e-2, 1e6)
    with pytest.raises(ValueError, match=r"^eps") as caught:
        _first_unstable(toy, 1.00001e6 / math.sqrt(r))
    assert str(caught.value) == "eps (1 - a) must be more than about 2e-11, got 0.0025"


def test_rate_is_what_steps_make_of_an_eigenvalue():
    assert rate(2.0) == 2.0
    assert rate(-1 + 3j) == -1
    assert rate(2.0, 0.1) == pytest.approx(math.log(1.2) / 0.1)
    np.testing.assert_allclose(rate(np.array([3j, -30.0]), 0.1), [5 * math.log(1.09), 10 * math.log(2)])


@pytest.mark.parametrize("n", [4, 5, 6, 7, 30, 41, 150])
@pytest.mark.parametrize("dt", [0.0, 0.05, 0.3])
def test_without_a_second_derivative_each_wave_is_by_itself(n, dt):
    """lam^2 + lam + s^2 = 0, but for s = 0: the constant, and the sawtooth of an even grid."""
    k = np.arange(1, (n + 1) // 2)
    s, h = np.sin(2 * np.pi * k / n) / (2 * np.pi / n), 2 * np.pi / n
    lam = np.concatenate([np.roots([1, 1, each**2]) for each in s])
    toy, mode = Toy(0.3, 0.0), fastest(Toy(0.3, 0.0), n, dt)
    assert growth(toy, n, dt) == pytest.approx(rate(lam, dt).max(), abs=1e-12)
    assert rate(mode.lam, dt) == pytest.approx(rate(lam, dt).max(), abs=1e-12)
    z, J = np.concatenate([mode.u, mode.v]), jacobian(toy, n)
    np.testing.assert_allclose(J @ z, mode.lam * z, atol=1e-10 / h)


@pytest.mark.parametrize("eps", [1.0, 1e-6])
def test_with_any_second_derivative_they_are_not(eps):
    toy = Toy(0.3, eps)
    assert growth(toy, 21) == pytest.approx(dense_rates(toy, 21).real.max(), abs=1e-9)
    assert growth(toy, 21) != growth(Toy(0.3, 0.0), 21)


def test_a_mode_is_given_with_the_largest_v_at_one_and_turning_forward(monkeypatch):
    """Whichever of a pair of conjugates the search comes upon."""
    eig = np.linalg.eig
    for turned in (False, True):
        if turned:
            monkeypatch.setattr(np.linalg, "eig", lambda m: tuple(part.conj() for part in eig(m)))
        for toy, n in ((Toy(0.5), 66), (Toy(-1.0, 0.1), 13), (Toy(0.5), 100), (Toy(1.5), 30), (Toy(0.9, 0.01), 21)):
            mode = fastest(toy, n)
            assert mode.lam.imag >= 0
            assert mode.v[np.argmax(np.abs(mode.v))] == pytest.approx(1, abs=1e-15)
            np.testing.assert_allclose(mode.lam * mode.u, Grid(n).derivative(mode.v, 1), atol=1e-9)
            z = np.concatenate([mode.u, mode.v])
            np.testing.assert_allclose(jacobian(toy, n) @ z, mode.lam * z, atol=1e-7)
            assert "array" not in repr(mode)
            assert "lam=" in repr(mode)


@pytest.mark.parametrize("seed", range(8))
def test_the_search_near_a_shift_finds_eigenvalues_and_the_nearest_of_all(seed):
    """Of [[0, S], [-S, -T]], T tridiagonal, against all of them by the dense route: of few unknowns and of many."""
    random = np.random.default_rng(seed)
    m = int(random.integers(3, 60))
    r = m - int(random.integers(0, 2))
    s, diagonal, off = random.uniform(0.1, 2, r), random.normal(size=m), random.normal(size=m - 1)
    S = np.eye(r, m) * s[:, None]
    M = np.block([[np.zeros((r, r)), S], [-S.T, -(np.diag(diagonal) + np.diag(off, 1) + np.diag(off, -1))]])
    dense, shift = np.linalg.eigvals(M), complex(*random.normal(size=2))
    lam, vectors = spectrum._near(s, diagonal, off, shift)
    assert vectors.shape == (r + m, lam.size)
    assert np.abs(dense[:, None] - lam).min(axis=0).max() < 1e-6
    assert np.abs(lam - dense[np.argmin(np.abs(dense - shift))]).min() < 1e-6
    for each, z in zip(lam, vectors.T, strict=True):
        assert np.linalg.norm(M @ z - each * z) < 1e-5 * np.linalg.norm(z)
    assert lam.size > 1


def test_the_search_stops_where_it_has_found_all_there_is():
    """With equal coefficients it never leaves two dimensions: lam^2 + 3 lam + 4 = 0."""
    lam, vectors = spectrum._near(np.full(6, 2.0), np.full(6, 3.0), np.zeros(5), 0.4 + 0.3j)
    np.testing.assert_allclose(sorted(lam, key=np.imag), sorted(np.roots([1, 3, 4]), key=np.imag), atol=1e-12)
    np.testing.assert_allclose(2 * vectors[6:], lam * vectors[:6], atol=1e-12)
    np.testing.assert_allclose(vectors[:6], vectors[:1] * np.ones((6, 1)), atol=1e-12)


def test_what_does_not_fit_into_memory_is_refused_by_its_size(monkeypatch):
    """80 n^2 bytes for a Jacobian, 600 n for a search: with the limit at 40 points, and at one byte less."""
    for call, size, what in (
        (jacobian, 80 * 40**2, "n: the Jacobian"),
        (growth, 600 * 40, "n: the search for eigenvalues"),
        (fastest, 600 * 40, "n: the search for eigenvalues"),
    ):
        monkeypatch.setattr(checks, "MAX_BYTES", size)
        call(Toy(0.5), 40)
        monkeypatch.setattr(checks, "MAX_BYTES", size - 1)
        with pytest.raises(ValueError, match=f"^{what} must fit into 0 GiB of memory, got n = 40$"):
            call(Toy(0.5), 40)


def test_bad_input_of_the_spectrum_gets_one_sentence():
    for call, sentence in (
        (lambda: growth(Toy(1), 8, -0.5), "dt must be a finite number >= 0, got -0.5"),
        (lambda: fastest(Toy(1), 8, -0.5), "dt must be a finite number >= 0, got -0.5"),
        *((lambda f=f: f(3, 8), "toy must be a Toy, got 3") for f in (growth, fastest, depth, jacobian)),
    ):
        with pytest.raises((TypeError, ValueError)) as caught:
            call()
        assert str(caught.value) == sentence


@pytest.mark.parametrize("seed", range(6))
def test_grows_against_all_eigenvalues(seed):
    """On grids beyond the dense ones, about as many that grow as do not; the oracle is the whole Jacobian."""
    rng = np.random.default_rng(seed)
    said = []
    for _ in range(8):
        a, n = rng.uniform(-1, 0.95), int(rng.integers(101, 140))
        toy = Toy(a, (math.pi / n) ** 2 / (1 - a) * rng.uniform(1.2, 2.6))
        largest = np.linalg.eigvals(jacobian(toy, n)).real
        largest = largest[np.abs(largest) > 1e-6].max()  # the neutral modes, as rounded
        said.append(grows(toy, n))
        assert said[-1] == (largest > 0), (toy, n, largest)
    assert len(set(said)) == 2
