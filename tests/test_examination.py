"""Guards examine: a zoo of black boxes with known answers, and steps that would mislead who trusts them."""

import inspect
import math
import re
import textwrap
import time

import numpy as np
import pytest
from boxes import (
    L,
    adaptive,
    cahn_hilliard,
    curved,
    d1,
    d2,
    euler,
    flat,
    galerkin,
    hidden_well_posed,
    imex,
    implicit,
    jacobian,
    kdv,
    kuramoto_sivashinsky,
    laplacian,
    perona_malik,
    rk4,
    shallow_water,
    spectral,
    toy,
    waves,
    x_of,
)

import primer.study.black_box as black_box
from primer import examine
from primer.view.examination import draw_examination
from primer.view.style import new_figure

GRIDS = (32, 64, 128)
STEADY_TOY = curved(lambda x: 0.5 - np.cos(x), lambda x: 0 * x)
WELL = curved(lambda x: 1.5 - np.cos(x), lambda x: 0 * x)
QUIET = flat(0.0, 0.0)


def zero(n):
    return np.zeros((1, n), dtype=complex)


def exact(f, base, n):
    """The fastest growth of the semi-discrete equations."""
    return np.linalg.eigvals(jacobian(f, base(n))).real.max()


@pytest.mark.parametrize(
    ("f", "step", "base", "dt", "exponent"),
    [
        (lambda u: -d2(u), euler, flat(0.0), 1e-4, 2),
        (lambda u: -u * d1(u) - 0.1 * d2(u), euler, flat(1.0), 1e-4, 2),
        (lambda z: np.array([z[1], d2(z[0]) + d2(d2(z[0]))]), rk4, QUIET, 1e-6, 2),
        (shallow_water, rk4, flat(0.5, 1.5), 1e-3, 1),
        (lambda u: (u - np.roll(u, -1, -1)) * u.shape[-1] / L, euler, flat(1.0), 1e-4, 1),  # against the wind
        (lambda u: -d2(u) - 1e-6 * d2(d2(u)), rk4, flat(0.0), 1e-5, 2),  # too small a fourth derivative
        (perona_malik, euler, curved(lambda x: 2 * np.sin(x)), 1e-5, 2),
    ],
)
def test_ill_posed_as_these_grids_see_it(f, step, base, dt, exponent):
    found = examine(step(f), base, GRIDS, dt)
    assert found.kind == "ill-posed"
    assert found.exponent == pytest.approx(exponent, abs=0.05)
    np.testing.assert_allclose(found.growth, [exact(f, base, n) for n in GRIDS], rtol=1e-2)
    assert (np.abs(found.growth - [exact(f, base, n) for n in GRIDS]) < 2 * found.error + 1e-6).all()
    assert "the program, which need not be the equations" in found.reason
    assert math.isnan(found.stable_dt)
    k = 1 / found.wavelength[-1]
    assert found.coefficient * k**found.exponent == pytest.approx(found.growth[-1])


@pytest.mark.parametrize(
    ("f", "step", "base", "dt"),
    [
        (kuramoto_sivashinsky, rk4, flat(1.0), 1e-5),
        (cahn_hilliard, rk4, flat(0.1), 1e-5),
        (lambda u: u - u**3 + 0.01 * d2(u), euler, flat(0.0), 1e-3),
    ],
)
def test_unstable_but_bounded(f, step, base, dt):
    found = examine(step(f), base, GRIDS, dt)
    assert found.kind == "unstable"
    np.testing.assert_allclose(found.growth, [exact(f, base, n) for n in GRIDS], rtol=1e-4)
    assert abs(found.exponent) < 0.1
    assert "bounded" in found.reason


@pytest.mark.parametrize(
    ("step", "base", "dt"),
    [
        (euler(d2), flat(1.0), 1e-4),
        (rk4(lambda u: -d1(u)), flat(1.0), 2e-2),
        (rk4(waves), flat(1.0, 0.0), 1e-2),
        (rk4(lambda z: np.array([z[1], d2(z[0])])), QUIET, 1e-2),
        (rk4(lambda z: np.array([z[1], d2(z[0]) - d2(d2(z[0]))])), QUIET, 1e-5),
        (rk4(kdv), flat(1.0), 1e-5),
        (rk4(shallow_water), flat(0.5, 0.5), 1e-3),
        (implicit(lambda k: -(k**2)), flat(0.0), 0.1),
        (euler(perona_malik), curved(lambda x: 0.5 * np.sin(x)), 1e-4),
        (euler(lambda u: -u * d1(u) + 0.1 * d2(u)), flat(1.0), 1e-4),
        (adaptive(d2, rtol=1e-8, atol=1e-10), flat(1.0), 1e-2),
    ],
)
def test_stable(step, base, dt):
    found = examine(step, base, GRIDS, dt)
    assert found.kind == "stable"
    assert (found.growth <= found.error).all()
    assert found.reason.startswith("Nothing grows")


@pytest.mark.parametrize(
    ("step", "base", "dt", "limit"),
    [
        (euler(d2), flat(1.0), 2e-3, 2 / (4 / (L / 128) ** 2)),
        (rk4(lambda u: -d1(u)), flat(1.0), 0.2, 2.828427 * L / 128),
        (rk4(cahn_hilliard), flat(0.1), 1e-4, None),
        (euler(waves), flat(0.0, 0.0), 1e-3, 0.0),
        (euler(kdv), flat(1.0), 1e-6, 0.0),
        pytest.param(euler(toy(1.5)), WELL, 0.07, None, marks=pytest.mark.slow),
    ],
)
def test_the_scheme_and_the_step_that_would_do(step, base, dt, limit):
    found = examine(step, base, GRIDS, dt)
    assert found.kind == "scheme"
    assert found.amplification[-1] > 1
    if limit is not None:
        assert limit * 0.97 <= found.stable_dt <= limit * 1.001
    if found.stable_dt:
        for dt, kind in ((found.stable_dt, False), (1.1 * found.stable_dt, True)):
            assert (examine(step, base, GRIDS, dt).kind == "scheme") == kind
    else:
        assert "no step would do" in found.reason


def test_the_scheme_and_then_the_model():
    found = examine(rk4(cahn_hilliard), flat(0.1), GRIDS, 1e-4)
    assert "what is left then is the model's own growth, 11.8" in found.reason


def yee(z, dt):
    """E and H on grids half a step apart: stable up to dt = h, where the shortest waves are multiplied by -1."""
    e, h = z
    h = h + dt * (np.roll(e, -1) - e) * e.size / L
    return np.array([e + dt * (h - np.roll(h, 1)) * e.size / L, h])


def leapfrog(f):
    """The fields and those a step before."""
    return lambda z, dt: np.array([z[1] + 2 * dt * f(z[0]), z[0]])


def lax_wendroff(u, dt):
    return u - dt * d1(u) + dt**2 / 2 * d2(u)


@pytest.mark.parametrize(
    ("step", "base", "limit"),
    [
        (yee, QUIET, L / 128),
        (leapfrog(lambda u: -d1(u)), flat(1.0, 1.0), L / 128),
        (lax_wendroff, flat(1.0), L / 128),
    ],
)
def test_waves_that_do_not_grow_up_to_a_limit(step, base, limit):
    """The modes of a step beyond it are others than those of small steps."""
    assert examine(step, base, GRIDS, 0.9 * limit).kind == "stable"
    for times in (1.05, 1.5):
        found = examine(step, base, GRIDS, times * limit)
        assert found.kind == "scheme"
        assert 0.97 * limit <= found.stable_dt <= 1.001 * limit


def test_leapfrog_of_the_heat_equation_grows_whatever_the_step():
    """Its second mode grows at the rate at which the first decays: no smaller dt helps, it is the program."""
    found = examine(leapfrog(d2), flat(1.0, 1.0), GRIDS, 1e-4)
    assert found.kind == "ill-posed"
    np.testing.assert_allclose(found.growth, [4 * (n / L) ** 2 for n in GRIDS], rtol=1e-2)


def test_waves_in_the_plane_with_one_sign_wrong():
    """Growth sqrt(l^2 - k^2), largest where k is 0 or blind; beside them are triple roots 0 with one mode only."""

    def f(z):
        x, y = ((np.roll(z, -1, a) - np.roll(z, 1, a)) * z.shape[-1] / (2 * L) for a in (-1, -2))
        return np.array([-x[1] - y[2], -x[0], y[0]])

    found = examine(rk4(f), lambda n: np.zeros((3, n, n)), (8, 16, 32), 1e-3)
    assert found.kind == "ill-posed"
    np.testing.assert_allclose(found.growth, [n / L for n in found.n], rtol=1e-6)


def test_an_implicit_step_hides_nothing():
    """Backward Euler of the backward heat equation with so large a step damps what should grow fastest."""
    for dt in (10.0, 0.1, 1e-5):
        found = examine(implicit(lambda k: k**2), flat(0.0), GRIDS, dt)
        assert found.kind == "ill-posed"
        assert found.exponent == pytest.approx(2, abs=0.02)


@pytest.mark.parametrize("dt", [0.1, 0.6385, 0.8845, 1.2254, 1.4422, 7.06])
@pytest.mark.parametrize("damping", [0.0, 5e-4, 5e-2])
def test_growth_is_known_as_well_as_it_is_said_to_be(dt, damping):
    """Three large steps of an implicit method may look as if they converged, with a power of chance."""
    found = examine(implicit(lambda k: 1.06 - damping * k**2), flat(0.0), (16, 32, 64), dt)
    assert found.kind in ("unstable", "scheme")
    assert (np.abs(found.growth - 1.06) <= found.error + 1e-9).all()


@pytest.mark.slow
def test_a_frozen_verdict_is_not_asked_for():
    """The equation is well posed, and so are its central differences; a Galerkin matrix of it is not."""
    fine = examine(rk4(hidden_well_posed), zero, GRIDS, 1e-4)
    program = examine(rk4(galerkin), zero, GRIDS, 1e-4)
    assert fine.kind == "stable"
    assert program.kind == "ill-posed"
    np.testing.assert_allclose(program.growth, [exact(galerkin, zero, n) for n in GRIDS], rtol=1e-3)
    assert program.exponent == pytest.approx(1, abs=0.05)


@pytest.mark.slow
def test_the_toy_system_on_its_steady_state():
    """Growth from its Jacobian: nothing on 32 points, 0.02 on 64 (section A2.2.2)."""
    found = examine(euler(toy(0.5)), STEADY_TOY, (64, 100, 200), 1e-4)
    assert found.kind == "ill-posed"
    np.testing.assert_allclose(found.growth, [exact(toy(0.5), STEADY_TOY, n) for n in (64, 100, 200)], rtol=1e-3)
    assert examine(euler(toy(0.5)), STEADY_TOY, (16, 32, 48), 1e-4).kind == "stable"
    once = examine(euler(toy(0.5)), STEADY_TOY, (16, 32, 80), 1e-4)
    assert once.kind == "undecided"
    assert "Only n = 80 shows growth" in once.reason


@pytest.mark.slow
def test_aliasing():
    """No mode grows, but the wrapped products amplify the shortest waves like n."""
    step = rk4(lambda u: -spectral(u * u / 2, 1))
    found = examine(step, curved(np.sin), GRIDS, 1e-3)
    assert found.kind == "undecided"
    assert "as aliasing makes them" in found.reason
    cured = examine(
        rk4(lambda u: -spectral(u * u / 2, 1, keep=2 / 3) + 1e-2 * spectral(u, 2)), curved(np.sin), GRIDS, 1e-3
    )
    assert cured.kind in ("stable", "unstable")


def test_a_sign_error_makes_the_program_ill_posed():
    found = examine(rk4(lambda u: -u * d1(u) - 0.05 * d2(u)), curved(lambda x: 1 + 0.3 * np.sin(x)), (16, 32, 64), 1e-4)
    assert found.kind == "ill-posed"
    assert found.exponent == pytest.approx(2, abs=0.05)


@pytest.mark.parametrize("base", [flat(0.1), curved(lambda x: 0.1 + 0.3 * np.cos(x))])
def test_imex(base):
    found = examine(imex, base, GRIDS, 1e-3)
    assert found.kind == "unstable"
    u = base(64)
    J = [spectral((3 * u**2 - 1) * e, 2) - 0.02 * spectral(e, 4) for e in np.eye(64)]
    rate = np.linalg.eigvals(np.concatenate(J)).real.max()
    assert found.growth[1] == pytest.approx(rate, abs=3 * found.error[1])


@pytest.mark.parametrize(
    ("f", "dt", "kind"),
    [
        (laplacian, 1e-5, "stable"),
        (laplacian, 1e-2, "scheme"),
        (lambda u: -laplacian(u), 1e-5, "ill-posed"),
        (lambda u: 0.01 * laplacian(u) + u - u**3, 1e-3, "unstable"),
    ],
)
def test_two_space_variables(f, dt, kind):
    found = examine(euler(f), lambda n: np.zeros((1, n, n)), (16, 32, 64), dt)
    assert found.kind == kind
    if kind == "ill-posed":
        np.testing.assert_allclose(found.growth, [8 * (n / L) ** 2 for n in found.n], rtol=1e-2)
        np.testing.assert_allclose(found.wavelength * found.n, math.sqrt(2))


@pytest.mark.slow
@pytest.mark.parametrize(("dt", "kind"), [(1e-2, "scheme"), (1e-4, "stable")])
def test_two_space_variables_where_no_matrix_is_formed(dt, kind):
    def base(n):
        x = x_of(n)
        return (np.cos(x)[:, None] * np.cos(x))[None]

    assert examine(euler(laplacian), base, (16, 32, 48), dt).kind == kind


# Steps that would mislead


def with_memory():
    """Adams-Bashforth, with the last slope where nobody sees it."""
    last = {}

    def step(u, dt):
        slope = d2(u)
        before = last.get(u.shape, slope)
        last[u.shape] = slope
        return u + dt * (1.5 * slope - 0.5 * before)

    return step


def with_a_clock():
    t = [0.0]

    def step(u, dt):
        t[0] += dt
        return u + dt * (d2(u) + np.cos(3 * t[0]))

    return step


def random(u, dt, generator=np.random.default_rng(1)):  # noqa: B008 - a generator that goes on, on purpose
    return u + dt * d2(u) + 1e-7 * generator.standard_normal(u.shape)


@pytest.mark.parametrize(
    ("step", "word"), [(with_memory(), "memory of its own"), (with_a_clock(), "memory of its own"), (random, "random")]
)
def test_memory_clocks_and_chance_are_seen(step, word):
    for base in (flat(1.0), curved(np.sin)):
        found = examine(step, base, GRIDS, 1e-4)
        assert found.kind == "undecided"
        assert word in found.reason
        assert np.isnan(found.growth).all()


def test_what_a_step_does_to_its_arrays_is_its_own_affair():
    def in_place(u, dt):
        u += dt * d2(u)
        return u

    kept = {}

    def buffered(u, dt):
        out = kept.setdefault(u.shape, np.empty_like(u))
        out[:] = u + dt * d2(u)
        return out

    plain = examine(euler(d2), flat(1.0), GRIDS, 2e-3)
    for step in (in_place, buffered, lambda u, dt: list(u + dt * d2(u))):
        found = examine(step, flat(1.0), GRIDS, 2e-3)
        assert found.kind == "scheme"
        np.testing.assert_allclose(found.growth, plain.growth, atol=1e-8)
        assert found.stable_dt == pytest.approx(plain.stable_dt)


def test_single_precision_is_noise_and_said_to_be():
    def step(u, dt):
        return (u + np.float32(dt) * d2(u)).astype(np.float32)

    found = examine(step, lambda n: np.ones((1, n), np.float32), GRIDS, 1e-4)
    assert found.kind == "stable"
    assert found.error[-1] > 1e-2
    assert found.error[-1] > 1e4 * examine(euler(d2), flat(1.0), GRIDS, 1e-4).error[-1]


def test_a_tolerance_that_swallows_small_perturbations_is_seen():
    """As a linear solver does that starts from the last fields and finds them good enough."""

    def step(u, dt):
        new = u - 0.1 * dt * d2(u)
        return new if np.abs(new - u).max() > 1e-5 else u

    for base in (flat(1.0), curved(lambda x: 1 + 1e-9 * np.sin(x))):
        found = examine(step, base, GRIDS, 1e-4)
        assert found.kind == "undecided" or found.kind == "ill-posed"
    assert "tighten the tolerances" in examine(step, flat(1.0), GRIDS, 1e-6).reason


def test_noise_that_hides_everything_is_said():
    found = examine(lambda u, dt: np.round(u + dt * d2(u), 3), curved(np.sin), GRIDS, 1e-4)
    assert found.kind == "undecided"


def test_complex_fields_are_two_real_ones():
    found = examine(rk4(lambda w: 1j * spectral(w, 2)), zero, (16, 32, 64), 1e-4)
    assert found.kind == "stable"
    assert examine(rk4(lambda w: -1j * spectral(w, 1)), zero, (16, 32, 64), 1e-4).kind == "ill-posed"  # one sign of k


def test_a_base_state_that_is_lost_at_once_is_not_called_unstable():
    found = examine(lambda u, dt: u + dt * (d2(u) + 1e3 * u**3), flat(1.0), GRIDS, 1e-4)
    assert found.kind == "undecided"
    assert "the march from state(128) itself is lost" in found.reason


def test_a_step_that_fails_where_it_is_perturbed():
    def step(u, dt):
        if np.ptp(u) > 1e-12:
            raise RuntimeError("no convergence")
        return u

    found = examine(step, flat(1.0), GRIDS)
    assert found.kind == "undecided"
    assert "RuntimeError" in found.reason


@pytest.mark.parametrize(
    ("step", "text"),
    [
        (lambda u, dt: u + 1e-4 * d2(u), "step does the same whatever dt is"),
        (lambda u, dt: u - 1e-4 * d2(u), "step does the same whatever dt is"),
        (lambda u, dt: d2(u), "step does the same whatever dt is"),
        (lambda u, dt: dt * d2(u), "as dt -> 0 what step returns vanishes"),
        (lambda u, dt: np.floor(u + dt * d2(u)), "it is not smooth (it rounds, or counts)"),
        (lambda u, dt: u, "step gives back what it is given"),
        (
            lambda u, dt: u + dt * d2(u) if np.ptp(u, axis=1).max() < 1e-12 else u * np.nan,
            "from some perturbed state it is not fin",
        ),
    ],
)
def test_what_is_no_step_of_a_time_dt_is_not_judged(step, text):
    for base in (flat(1.0), flat(1.0, 0.5)):
        found = examine(step, base, GRIDS, 1e-3)
        assert found.kind == "undecided"
        assert text in found.reason


def test_a_large_implicit_step_is_a_step():
    """It undoes a perturbation altogether, with dt = 1e3 as with a quarter of it, and not with a tiny one."""
    assert examine(implicit(lambda k: -1 - k**2), flat(1.0), GRIDS, 1e3).kind == "stable"


def test_what_has_no_derivative_is_said_to_be_rough():
    """It rounds what it adds; what it is given it leaves as it is."""
    found = examine(lambda u, dt: u + np.round(dt * d2(u), 3), curved(np.sin), GRIDS, 1e-2)
    assert found.kind == "undecided"


def test_numbers_may_come_in_any_wrapping():
    plain = examine(euler(d2), flat(1.0), GRIDS, 1e-3)
    wrapped = (
        lambda u, dt: (u + dt * d2(u)).astype(object),
        lambda u, dt: np.ma.masked_array(u + dt * d2(u)),
        lambda u, dt: [[float(each) for each in row] for row in u + dt * d2(u)],
        lambda u, dt: (u + dt * d2(u)).astype(complex),
    )
    for step in wrapped:
        found = examine(step, lambda n: [[1.0] * n], GRIDS, 1e-3)
        assert (found.kind, found.calls) == (plain.kind, plain.calls)
        np.testing.assert_array_equal(found.growth, plain.growth)


def test_a_state_that_is_shared_and_changed_in_place_stays_what_it_was():
    shared = {n: np.ones((1, n)) for n in GRIDS}

    def step(u, dt):
        u -= dt * d2(u)
        return u

    assert examine(step, shared.__getitem__, GRIDS, 1e-4).kind == "ill-posed"
    assert all((state == 1).all() for state in shared.values())


@pytest.mark.parametrize(
    ("step", "base", "text"),
    [
        (lambda u, dt: u[:, :-1], flat(1.0), r"step must return fields of the shape that it is given, \(1, 32\), got"),
        (lambda u, dt: u * np.nan, flat(1.0), r"after one step from state\(32\) with dt = 0.001 it is not finite"),
        (lambda u, dt: 1 / 0, flat(1.0), "it fails, ZeroDivisionError: 'division by zero'"),
        (lambda u, dt: u * 1j, flat(1.0), "let state give complex fields"),
        (euler(d2), lambda n: np.zeros(n), r"state\(32\) must give fields of shape \(m, n\) or \(m, ny, nx\)"),
        (euler(d2), lambda n: np.full((1, n), np.inf), r"state\(32\) must be finite"),
        (euler(d2), lambda n: 1 / 0, r"state\(32\) fails, ZeroDivisionError: 'division by zero'"),
        (
            euler(d2),
            lambda n: np.ones((1 if n < 64 else 2, n)),
            r"the same fields on each grid.*\(1, 32\) for n = 32 and",
        ),
        (euler(d2), lambda n: np.ones((1, 64)), "on more points for a larger n"),
        (
            lambda u, dt: u.T,
            flat(1.0),
            r"step must return fields of the shape that it is given, \(1, 32\), got \(32, 1\)",
        ),
        (lambda u, dt: u if u.shape[-1] < 128 else u * np.nan, flat(1.0), r"after one step from state\(128\)"),
    ],
)
def test_wrong_input_is_one_sentence(step, base, text):
    with pytest.raises(ValueError, match=text):
        examine(step, base, GRIDS)


@pytest.mark.parametrize(
    ("arguments", "error", "text"),
    [
        ((None, flat(1.0)), TypeError, "step must be a function of fields and dt"),
        ((euler(d2), 1), TypeError, "state must be a function of n"),
        ((euler(d2), flat(1.0), 64), TypeError, "n must be a sequence"),
        ((euler(d2), flat(1.0), (64,)), ValueError, "n must be two grids or more, from coarse to fine"),
        ((euler(d2), flat(1.0), (64, 32)), ValueError, "n must be two grids or more, from coarse to fine"),
        ((euler(d2), flat(1.0), GRIDS, 0), ValueError, "dt must be a finite number > 0"),
        ((lambda u, dt: None, flat(1.0)), TypeError, "step must return the new fields, got None"),
        ((lambda u, dt: "u", flat(1.0)), TypeError, "step must return an array of numbers"),
        ((euler(d2), lambda n: "u"), TypeError, r"state\(64\) must give an array of numbers"),
    ],
)
def test_arguments(arguments, error, text):
    with pytest.raises(error, match=text):
        examine(*arguments)


def test_what_would_take_too_long_is_not_started():
    calls = []

    def step(u, dt):
        calls.append(1)
        time.sleep(0.1)
        return u

    with pytest.raises(ValueError, match=r"at least 80 calls a grid, together some 2\d seconds: more"):
        examine(step, flat(1.0), GRIDS, patience=2.0)
    assert len(calls) <= 2


def test_a_minute_a_call_is_an_estimate_in_minutes(monkeypatch):
    """By a clock of the test's own: 60 s a call, three grids, 80 calls each, four hours."""
    clock = [0.0]
    monkeypatch.setattr(black_box.time, "perf_counter", lambda: clock[0])
    calls = []

    def step(u, dt):
        calls.append(1)
        clock[0] += 60.0
        return u + dt * d2(u)

    with pytest.raises(ValueError, match=r"step takes 60 s a call on n = 32, .* together some 240 minutes: more than"):
        examine(step, flat(1.0), GRIDS)
    assert len(calls) == 1


def test_a_step_that_is_slow_on_the_finest_grid_alone_is_not_started_either(monkeypatch):
    clock = [0.0]
    monkeypatch.setattr(black_box.time, "perf_counter", lambda: clock[0])

    def step(u, dt):
        clock[0] += 5.0 if u.shape[-1] == 128 else 1e-3
        return u + dt * d2(u)

    with pytest.raises(ValueError, match=r"step takes 5 s a call on n = 128"):
        examine(step, flat(1.0), GRIDS)


def test_the_picture_shows_each_step_and_the_limit():
    _, axes = new_figure()
    found = examine(euler(lambda u: -d2(u)), flat(0.0), (16, 32, 64), 1e-4)
    artists = draw_examination(axes[0, 0] if axes.ndim == 2 else axes[0], found)
    assert len(artists) == 5
    np.testing.assert_array_equal(artists[0].get_ydata(), found.growths[:, 0])
    lost = examine(random, flat(1.0), (16, 32), 1e-4)
    (text,) = draw_examination(axes[-1], lost)
    assert text.get_text() == "cannot tell"


# The adapters of the module's docstring


ADAPTERS = dict(re.findall(r"    # (.*)\n((?:    .*\n)+)", inspect.getdoc(black_box) + "\n"))
EXPECTED = {
    "NumPy": ("", (16, 32, 64), 5e-2, "scheme"),
    "solve_ivp": ("scipy", (16, 32, 64), 1e-3, "ill-posed"),
    "py-pde": ("pde", (16, 32), 1e-5, "unstable"),
    "py-pde in two dimensions": ("pde", (8, 16), 1e-3, "stable"),
    "FiPy": ("fipy", (16, 32), 1e-2, "ill-posed"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", EXPECTED)
def test_adapters_of_the_documentation(name):
    needs, grids, dt, kind = EXPECTED[name]
    names = {"np": np}
    if needs == "scipy":
        from scipy.integrate import solve_ivp

        names["solve_ivp"] = solve_ivp
    elif needs:
        names[needs] = pytest.importorskip(needs, reason=f"{needs} is not installed (extra 'bench')")
    exec(textwrap.dedent(ADAPTERS[name]), names)
    assert examine(names["step"], names["state"], grids, dt, patience=600).kind == kind


def test_the_adapters_are_all_tested():
    assert set(ADAPTERS) == set(EXPECTED)
