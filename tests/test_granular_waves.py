"""Guards plane waves that are marched: their right-hand side, growth and convergence, each by a second route."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigvals
from scipy.optimize import brentq

from primer import CENTRAL, CENTRAL_4, FOURIER, RK4, diagnose, examine, march_lines
from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    Ansatz,
    BaseState,
    Coulomb,
    IncompressibleMuI,
    critical_state,
    linearise,
    stress,
)
from primer.granular.march import Outcome, march_waves
from primer.granular.mode_growth import mode_growth
from primer.granular.system import System
from primer.granular.waves import PlaneWave
from primer.scenes.granular_march import refine_wave
from primer.schemes.grid import Grid

BEADS, PACKING = GLASS_BEADS.friction, EXAMPLE_COMPACTION
# mu = 0.4 + 0.3 I^(1/2): Lemma 1 by hand, so that no series of the package stands in its way.
OWN = Ansatz(
    lambda I: 0.8 + 0.4 * np.sqrt(I),
    lambda I: 0.2 / np.sqrt(I),
    lambda I: 0.8 + 0.2 * np.sqrt(I),
    lambda I: 0.1 / np.sqrt(I),
    PACKING,
)
STATE = BaseState(0.37, 0.55, 0.01)  # that of figure granular_noise
CASES = [
    (CIDR(BEADS, PACKING), STATE),
    (CSSM(BEADS.mu1, PACKING), STATE),
    (OWN, BaseState(0.3, 0.56, 0.05, 0.7, 1.7)),
    (Coulomb(BEADS.mu1), STATE),
    (IncompressibleMuI(BEADS), STATE),
]
EVERY_LAW = pytest.mark.parametrize(("law", "state"), CASES, ids=["CIDR", "CSSM", "own", "Coulomb", "mu(I)"])


def differences(problem, x, state, derivative):
    """The Jacobian of the semi-discrete right-hand side, one column after the other."""
    scale = np.repeat(problem.scale, x.size)
    columns = []
    for j in range(state.size):
        change = np.zeros(state.size)
        change[j] = 1e-6 * scale[j]
        up, down = (problem.rhs(x, state + sign * change.reshape(state.shape), derivative) for sign in (1, -1))
        columns.append((np.array(up) - np.array(down)).ravel() / (2e-6 * scale[j]))
    return np.array(columns).T


def worst_gap(found, wanted):
    """The largest distance from an eigenvalue that is wanted to the nearest that was found, over the largest."""
    return np.abs(found[:, None] - wanted).min(axis=0).max() / np.abs(wanted).max()


@EVERY_LAW
@pytest.mark.parametrize("space", [CENTRAL, FOURIER], ids=["central", "Fourier"])
@pytest.mark.parametrize("angle", [0.0, 52.0, -38.0, 90.0])
def test_the_semi_discrete_equations_have_the_eigenvalues_of_the_pencil(law, state, space, angle):
    problem, n = PlaneWave(law, state, angle), 8
    grid = Grid(n, problem.period)
    derivative = lambda f, m: space[m](f, grid.h)  # noqa: E731
    base = np.array(problem.initial(grid.x))
    found = np.linalg.eigvals(differences(problem, grid.x, base, derivative))
    pencil, direction = linearise(law, state), np.array([math.cos(math.radians(angle)), math.sin(math.radians(angle))])
    wanted = []
    for k in range(1, 4):
        xi = 2 * np.pi * k / problem.period
        S, E = pencil.matrices((np.sin(xi * grid.h) / grid.h if space is CENTRAL else xi) * direction)
        alpha, beta = eigvals(-S, E, homogeneous_eigvals=True)
        order = np.argsort(np.abs(beta) / (np.abs(alpha) + np.abs(beta)))[::-1][: len(problem.fields)]
        wanted += list(alpha[order] / beta[order])
    assert worst_gap(found, np.array(wanted)) < 2e-5


@EVERY_LAW
@pytest.mark.parametrize("space", [CENTRAL, FOURIER], ids=["central", "Fourier"])
@pytest.mark.parametrize("shear", [False, True])
def test_the_jacobian_of_the_march_is_that_of_its_right_hand_side(law, state, space, shear):
    if shear and not getattr(law, "incompressible", False):
        state = critical_state(law, state.phi, state.I, state.d, state.rho)
    problem = PlaneWave(law, state, None if shear else 50.0, amplitude=0.3, modes=3, simple_shear=shear)
    grid = Grid(16, problem.period)
    system = System(problem, grid.x, lambda f, m: space[m](f, grid.h), None)
    fields = np.array(problem.initial(grid.x))
    made = system.jacobian(0.0, fields.ravel() - system.base)
    made = made if isinstance(made, np.ndarray) else made.toarray()
    scale = np.repeat(problem.scale, 16)
    wanted = differences(problem, grid.x, fields, system.derivative) * scale / scale[:, None]
    np.testing.assert_allclose(made * scale / scale[:, None], wanted, atol=2e-5 * np.abs(wanted).max())


@pytest.mark.parametrize("angle", [45.0, -45.0])
@pytest.mark.parametrize("law", [CASES[0][0], OWN, CASES[4][0]], ids=["CIDR", "own", "mu(I)"])
def test_in_simple_shear_a_wave_satisfies_all_of_the_equations_in_the_plane(law, angle):
    """(22) and (1) in two dimensions by differences, at random points: nothing is held and nothing left out."""
    one = BaseState(0.3, 0.56, 0.05, 0.7, 1.7)
    state = one if getattr(law, "incompressible", False) else critical_state(law, one.phi, one.I, one.d, one.rho)
    problem = PlaneWave(law, state, angle, amplitude=0.5, modes=2, simple_shear=True, period=20.0)
    n, m, D = problem.frame.n, problem.frame.m, float(state.D)
    L = 2 * D * np.outer(m, n)
    assert np.allclose((L + L.T) / 2, np.diag([-D, D]))  # the base flow, compressed along x_1
    x = Grid(256, 20.0).x
    derivative = lambda f, k: FOURIER[k](f, 20.0 / 256)  # noqa: E731
    w_t = np.array(problem.rhs(x, np.array(problem.initial(x)), derivative))

    def fields(X):
        found = problem.initial(np.array([n @ X]))
        if problem.incompressible:
            return L @ X + found[0][0] * m, state.phi
        return L @ X + np.array([found[0][0], found[1][0]]), found[2][0]

    def gradient(f, X, h=1e-3):
        shifts = [[f(X + s * h * e) for s in (-2, -1, 1, 2)] for e in np.eye(2)]
        return np.array([(a - 8 * b + 8 * c - d) / (12 * h) for a, b, c, d in shifts]).T  # (..., j) d_j

    def stress_at(X):
        grad = gradient(lambda Z: fields(Z)[0], X)
        sym = (grad + grad.T) / 2
        dev = sym - np.eye(2) * np.trace(sym) / 2
        norm = math.sqrt((dev * dev).sum() / 2)
        phi = fields(X)[1]
        if problem.incompressible:  # the normal stress on the fronts is what it was
            load = float(state.p + law.Y(state.p, phi, state.I) * problem.frame.x)
            inertial = lambda p: 2 * state.d * norm / math.sqrt(p / state.rho)  # noqa: E731
            p = brentq(lambda p: p - law.Y(p, phi, inertial(p)) * (n @ dev @ n) / norm - load, 1e-6, 10, xtol=1e-15)
            return law.Y(p, phi, inertial(p)) * dev / norm - p * np.eye(2)
        found = stress(law, np.trace(grad), norm, phi, state.d, state.rho)
        return found.T * dev / norm - found.p * np.eye(2)

    for j in (3, 77, 200):
        X = x[j] * n + 1.3 * m
        u, phi = fields(X)
        grad_sigma = np.array([gradient(lambda Z, i=i: stress_at(Z)[i], X) for i in range(2)])  # (i, j, d)
        force = np.array([grad_sigma[i, 0, 0] + grad_sigma[i, 1, 1] for i in range(2)])
        u_t = force / (state.rho * phi) - gradient(lambda Z: fields(Z)[0], X) @ u
        if problem.incompressible:
            assert m @ u_t == pytest.approx(w_t[0][j], rel=1e-5, abs=1e-8)
            assert n @ u_t == pytest.approx(0, abs=1e-7)
        else:
            np.testing.assert_allclose(u_t, w_t[:2, j], rtol=1e-5, atol=1e-7)
            flux = gradient(lambda Z: fields(Z)[1] * fields(Z)[0], X)
            assert -np.trace(flux) == pytest.approx(w_t[2, j], rel=1e-6, abs=1e-10)


@pytest.mark.slow
def test_a_plain_method_of_lines_gives_the_same_run():
    """np.roll, a root finder at each point and solve_ivp: of the package only the law's Y and f."""
    law, state = CASES[0]
    problem = PlaneWave(law, state, 50.0, amplitude=0.2, modes=3, period=40.0)
    n, t_end = 16, 0.05 / state.D
    run = march_waves(problem, n, t_end, rtol=1e-9, times=2)
    h, D0, div0 = 40.0 / n, float(state.D), float(state.div_u(law))
    a, b = math.cos(math.radians(50)), math.sin(math.radians(50))
    slope = lambda f: (np.roll(f, -1) - np.roll(f, 1)) / (2 * h)  # noqa: E731

    def rhs(t, y):
        u, v, phi = y.reshape(3, n)
        u_s, v_s = slope(u), slope(v)
        grad = np.array([[a * u_s - D0 + div0 / 2, b * u_s], [a * v_s, b * v_s + D0 + div0 / 2]])
        div = grad[0, 0] + grad[1, 1]
        e, o = (grad[0, 0] - grad[1, 1]) / 2, (grad[0, 1] + grad[1, 0]) / 2
        norm = np.sqrt(e * e + o * o)
        p = np.array(
            [
                brentq(lambda p, j=j: law.f(p, phi[j], 2 * norm[j] / math.sqrt(p)) - div[j] / (2 * norm[j]), 0.01, 3)
                for j in range(n)
            ]
        )
        T = law.Y(p, phi, 2 * norm / np.sqrt(p)) / norm
        fx, fy = (T * e - p) * a + T * o * b, T * o * a + (-T * e - p) * b
        c = a * u + b * v
        return np.concatenate([slope(fx) / phi - c * u_s, slope(fy) / phi - c * v_s, -slope(phi * c)])

    start = np.array(problem.initial(-20 + h * np.arange(n))).ravel()
    plain = solve_ivp(rhs, (0, t_end), start, method="LSODA", rtol=1e-7, atol=1e-11)
    gap = (run.states[-1] - plain.y[:, -1].reshape(3, n)) / problem.scale[:, None]
    assert run.size[-1] > 0.3
    assert np.abs(gap).max() < 2e-4 * run.size[-1]


def manufactured(problem):
    """(w_1, w_2, phi)(x, t) that are no solution, and the source that makes them one, by sums of exact derivatives."""
    k, D, phi0 = 2 * np.pi / problem.period, float(problem.state.D), problem.state.phi

    def fields(x, t):
        q = D * t
        return np.array([D * np.sin(k * x + q), D * np.cos(2 * k * x - q) / 2, phi0 + 0.004 * np.sin(k * x - q)])

    def d_dt(x, t):
        q = D * t
        return D * np.array([D * np.cos(k * x + q), D * np.sin(2 * k * x - q) / 2, -0.004 * np.cos(k * x - q)])

    fine = Grid(512, problem.period)
    spectral = lambda f, m: FOURIER[m](f, fine.h)  # noqa: E731

    def source(x, t):
        exact = d_dt(fine.x, t) - np.array(problem.rhs(fine.x, fields(fine.x, t), spectral))
        return exact[:, :: 512 // x.size]

    return fields, source


@pytest.mark.slow
@pytest.mark.parametrize(("space", "order"), [(CENTRAL, 2), (CENTRAL_4, 4)], ids=["2", "4"])
def test_cidr_converges_to_a_manufactured_solution_with_the_order_of_the_scheme(space, order):
    law, state = CIDR(BEADS, PACKING), BaseState(0.42, 0.55, 0.1)
    problem = PlaneWave(law, state, 50.0, period=50.0)
    fields, source = manufactured(problem)
    errors, t_end = [], 0.2 / state.D
    for n in (32, 64, 128):
        x = Grid(n, 50.0).x
        run = march_waves(problem, n, t_end, space, rtol=1e-9, times=2, source=source, start=fields(x, 0.0))
        errors.append(np.abs((run.states[-1] - fields(x, t_end)) / problem.scale[:, None]).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, order, atol=0.1)


@EVERY_LAW
@pytest.mark.parametrize("space", [CENTRAL, FOURIER], ids=["central", "Fourier"])
def test_each_mode_grows_as_its_symbol_says_while_it_is_small(law, state, space):
    problem = PlaneWave(law, state, amplitude=1e-5, modes=15, period=40 * state.d)
    grid = Grid(48, problem.period)
    unit = np.zeros(48)
    unit[0] = 1
    fastest = np.linalg.eigvals(problem.symbol(np.fft.fft(space[1](unit, grid.h)))).real.max()
    run = march_waves(problem, 48, 3 / fastest, space, times=4)
    found = mode_growth(run, space, small=1e-2)
    assert np.isfinite(found.measured[:15]).all()
    assert found.error < 0.01
    assert found.symbol.max() == pytest.approx(fastest, rel=1e-9)
    if space is FOURIER:
        np.testing.assert_allclose(found.symbol, found.continuum, rtol=1e-9)


@pytest.mark.slow
def test_refined_cidr_converges_and_the_others_are_lost_the_sooner_the_finer_the_grid():
    ns, t = (64, 128, 256), 0.15 / STATE.D

    def runs(law):
        problem = PlaneWave(law, STATE, amplitude=1e-3, modes=6, period=60.0)
        return [march_waves(problem, n, t, times=7) for n in ns]

    cidr = runs(CIDR(BEADS, PACKING))
    coarse, middle, fine = (run.states[-1][:, :: run.n // 64] for run in cidr)
    assert math.log2(np.abs(coarse - middle).max() / np.abs(middle - fine).max()) == pytest.approx(2, abs=0.1)
    assert [run.outcome for run in cidr] == [Outcome.REACHED_END] * 3
    assert max(run.mass_drift for run in cidr) < 1e-14
    cssm = runs(CSSM(BEADS.mu1, PACKING))
    assert {run.outcome for run in cssm[1:]} == {Outcome.RIGID}
    assert cssm[2].t_stop < 0.6 * cssm[1].t_stop < cssm[1].t_stop < cssm[0].t_stop * (1 + 1e-12)
    assert max(run.mass_drift for run in cssm) < 1e-14
    for law in (Coulomb(BEADS.mu1), IncompressibleMuI(BEADS)):
        large = [run.t[np.argmax(run.size > 0.5)] if run.size.max() > 0.5 else t for run in runs(law)]
        assert large[2] < large[0]


@pytest.mark.slow
def test_the_scene_says_what_the_grids_do():
    cidr = refine_wave(*CASES[0], n=32, strain=0.1)
    assert cidr.order == pytest.approx(2, abs=0.1)
    assert cidr.parted == math.inf
    assert "converge with order" in cidr.verdict
    lost = refine_wave(CASES[4][0], STATE, n=32, strain=0.1)
    assert math.isnan(lost.order)
    assert 0 < lost.parted < 0.1
    assert "not the same wave" in lost.verdict
    assert max(each.error for each in (*cidr.growth, *lost.growth)) < 0.01
    ended = refine_wave(CASES[1][0], STATE, n=64, strain=0.12)
    assert "shear stops" in ended.verdict


def test_what_a_wave_leaves_is_named():
    law = CIDR(BEADS, PACKING)
    loose = PlaneWave(law, BaseState(0.01, 0.502, 0.1), amplitude=3.0, modes=2)
    assert march_waves(loose, 16, 100.0).outcome == Outcome.PHI  # before the first step
    away = march_waves(PlaneWave(law, BaseState(0.2, 0.55, 0.1), 52.0, amplitude=1e-2), 32, 300.0)
    assert away.outcome == Outcome.PHI
    assert "phi out of range" in away.reason
    assert 0 < away.t_stop < 300
    assert np.isfinite(away.states).all()
    torn = march_waves(PlaneWave(CSSM(0.4, PACKING), BaseState(0.2, 0.55, 0.1), 0.0, amplitude=40.0), 32, 1.0)
    assert torn.outcome == Outcome.NO_PRESSURE
    assert "expands too fast" in torn.reason or "no yield stress" in torn.reason


def test_explicit_steps_of_the_package_march_it_as_well():
    problem = PlaneWave(*CASES[0], amplitude=0.1, modes=3)
    implicit = march_waves(problem, 16, 5.0, rtol=1e-9, times=2)
    explicit = march_lines(problem, 16, 0.02, 5.0, CENTRAL, RK4)
    gap = (implicit.states[-1] - np.array(explicit.final)) / problem.scale[:, None]
    assert np.abs(gap).max() < 1e-5


@pytest.mark.parametrize(
    ("law", "state", "kind", "fault"),
    [
        (CIDR(BEADS, PACKING), BaseState(0.42, 0.55, 0.1), "converges", "stable"),
        (CSSM(BEADS.mu1, PACKING), STATE, "ill-posed", "ill-posed"),
        (IncompressibleMuI(BEADS), STATE, "ill-posed", "ill-posed"),
        (IncompressibleMuI(BEADS), BaseState(0.37, 0.55, 0.1), "converges", "stable"),
        (Coulomb(0.4), STATE, "ill-posed", "ill-posed"),
    ],
    ids=["CIDR", "CSSM", "mu(I) slow", "mu(I)", "Coulomb"],
)
def test_diagnose_and_examine_agree_with_the_verdict(law, state, kind, fault):
    problem = PlaneWave(law, state, period=40.0)
    dt = 1e-3 / float(state.D)
    assert diagnose(problem, 16, dt / 10, 20 / float(state.D), seed=1e-6, time=RK4).kind == kind

    def step(fields, dt):
        h = problem.period / fields.shape[-1]
        derivative = lambda f, m: CENTRAL[m](f, h)  # noqa: E731
        x = Grid(fields.shape[-1], problem.period).x
        return RK4.step(lambda y: np.array(problem.rhs(x, y, derivative)), fields, dt)

    def state_on(n):
        return np.array(problem.initial(Grid(n, problem.period).x))

    assert examine(step, state_on, n=(16, 32, 64), dt=dt / 100).kind == fault


@pytest.mark.parametrize(
    ("change", "kind", "words"),
    [
        ({"state": BaseState(0.9, 0.55, 0.1)}, ValueError, "p must be < "),
        ({"state": BaseState([0.1, 0.2], 0.55, 0.1)}, ValueError, "state must be a single state"),
        ({"state": 3}, TypeError, "state must be a BaseState"),
        ({"law": "CIDR"}, TypeError, "law must have the functions"),
        ({"angle": math.nan}, ValueError, "angle must be a finite number"),
        ({"amplitude": -1.0}, ValueError, "amplitude must be"),
        ({"modes": 1.5}, TypeError, "modes must be an integer"),
        ({"period": 0}, ValueError, "period must be"),
        ({"simple_shear": True, "angle": 30.0}, ValueError, "angle must be 45 or -45"),
        ({"simple_shear": True}, ValueError, "state must be critical"),
    ],
)
def test_bad_waves_are_refused_in_a_sentence(change, kind, words):
    with pytest.raises(kind, match=words) as caught:
        PlaneWave(**({"law": CIDR(BEADS, PACKING), "state": BaseState(0.2, 0.55, 0.1)} | change))
    assert "\n" not in str(caught.value)


def test_bad_marches_are_refused_in_a_sentence():
    problem = PlaneWave(*CASES[0])
    for kind, words, given in (
        (TypeError, "problem must be a PlaneWave", (3, 16, 1.0)),
        (TypeError, "n must be an integer", (problem, 16.5, 1.0)),
        (ValueError, "t_end must be", (problem, 16, 0.0)),
        (TypeError, "space must be", (problem, 16, 1.0, 3)),
        (ValueError, "rtol must be", (problem, 16, 1.0, CENTRAL, 2.0)),
        (ValueError, "times must rise", (problem, 16, 1.0, CENTRAL, 1e-6, [0.5, 0.2])),
        (ValueError, "start must have shape", (problem, 16, 1.0, CENTRAL, 1e-6, 4, None, np.zeros((2, 16)))),
    ):
        with pytest.raises(kind, match=words):
            march_waves(*given)
