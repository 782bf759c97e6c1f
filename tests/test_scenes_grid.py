"""Guards the scenes of refinement and of backward heat: runs against closed forms, spectrum and forecast."""

import math

import numpy as np
import pytest

from primer import Toy, diagnose
from primer.problems.heat import scaled_amplitude
from primer.scenes.base_state import base_state
from primer.scenes.heat import TOLERANCE, heat
from primer.scenes.refinement import T_END, refinement
from primer.schemes.grid import Grid
from primer.study.diagnosis import Kind
from primer.study.spectrum import growth


def test_well_posed_grids_come_to_rest_on_their_floors_of_second_order():
    found = refinement(1.5, 40)
    ends = np.array([run.dist[-1] for run in found.runs])
    h = 2 * np.pi / np.array([40, 80, 160])
    np.testing.assert_allclose(ends, h / np.sin(h) - 1, rtol=1e-4)
    assert np.log2(ends[:-1] / ends[1:]) == pytest.approx([2, 2], abs=0.02)
    assert set(found.kinds) == {Kind.CONVERGES}
    assert found.verdict.startswith("Well posed: u stays positive. Refining helps: ")


@pytest.mark.parametrize(("a", "n"), [(0.5, 50), (0.0, 60), (-0.5, 40), (-1.0, 32)])
def test_finer_is_sooner_and_no_step_helps(a, n):
    found = refinement(a, n)
    lost = np.isfinite(found.measured)
    assert lost[-2:].all()
    times = np.array(found.measured)[lost]
    assert (np.diff(times) < 0).all()
    for run, time in zip(found.runs, found.measured, strict=True):
        if time < T_END:
            earliest, latest = diagnose(Toy(a), run.n, run.dt, T_END).blow_up
            assert earliest < time < latest
    np.testing.assert_allclose(np.array(found.gentle)[lost], times, rtol=0.25)
    for run, rate, gone in zip(found.runs, found.growth, lost, strict=True):
        assert math.isnan(rate) if not gone else rate == growth(Toy(a), run.n) > 0
    assert "finer is sooner" in found.verdict
    assert "Nor does a smaller step" in found.verdict


def test_three_grids_may_all_hide_it():
    found = refinement(0.5, 15)
    assert set(found.kinds) == {Kind.HIDDEN}
    assert all(growth(Toy(0.5), run.n) < 0 for run in found.runs)
    assert "as if all were well" in found.verdict


def test_a_step_too_large_is_told_from_bad_equations():
    found = refinement(1.5, 50, 0.02)
    assert found.kinds == (Kind.CONVERGES, Kind.CONVERGES, Kind.SCHEME)
    assert growth(Toy(1.5), 200, 0.02) > 0 > growth(Toy(1.5), 200, found.gentle_dt[-1])
    assert found.rate[-1].max() > 0 > refinement(1.5, 50, found.gentle_dt[-1]).rate[-1][1:-1].max()
    assert found.gentle_dt[-1] < found.allowed[-1] < 0.02
    assert "It is the scheme" in found.verdict
    assert growth(Toy(1.5), 100, 0.02) > 0 > growth(Toy(1.5), 50, 0.02)
    assert "too large for N = 100: perturbations of that rest grow" in found.verdict
    coarser = refinement(1.5, 25, 0.02)  # nothing has blown up yet
    assert set(coarser.kinds) == {Kind.CONVERGES}
    assert "too large for N = 100" in coarser.verdict
    assert "Refining helps" not in coarser.verdict
    both = refinement(0.5, 64, 0.03)
    assert both.kinds[0] is Kind.SCHEME
    assert both.kinds[-1] is Kind.ILL_POSED
    assert "no cure for the equations" in both.verdict


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_kinds_are_those_of_the_diagnosis(seed):
    """Marched here, foreseen there; left out are blow-ups near t = 40, where a few last bits decide."""
    draw = np.random.default_rng(seed)
    a, n, dt = draw.uniform(-1, 2), int(draw.integers(12, 65)), 10 ** draw.uniform(-3, -1.7)
    found = refinement(a, n, dt)
    for run, kind, measured, gentle in zip(found.runs, found.kinds, found.measured, found.gentle, strict=True):
        foreseen = diagnose(Toy(a), run.n, dt, T_END)
        near = any(0.7 * T_END < t < 1.6 * T_END for t in (measured, gentle, foreseen.t_blow_up))
        # Told apart by a factor of 1.5 in time, which two routes may see either side of.
        if near or 1.2 * measured < gentle < 2 * measured:
            continue
        # A smaller step only puts it off: the diagnosis names what came first, the scene what no step cures.
        both = kind is Kind.ILL_POSED and 2 * measured <= gentle < math.inf
        assert foreseen.kind in ((Kind.SCHEME, kind) if both else (kind,)), (a, run.n, dt, foreseen)


@pytest.mark.parametrize(
    ("n", "courant", "seed"), [(16, 0.05, 1e-12), (24, 0.02, 1e-8), (48, 0.2, 1e-4), (32, 1.0, 1e-2)]
)
def test_a_stated_sawtooth_is_seen_when_foretold(n, courant, seed):
    found = heat(n, courant, seed)
    h = 2 * math.pi / np.array([n, 2 * n])
    np.testing.assert_allclose(found.growth, np.log(1 + 4 * courant) / (courant * h**2), rtol=1e-12)
    np.testing.assert_allclose(found.predicted, found.onset.predicted, rtol=1e-12)
    late = found.onset.t - found.predicted
    assert (late > -1e-12).all()
    assert (late <= courant * h**2 * (1 + 1e-6)).all()  # read to a step
    # Beside e^{factor t} sin x there is the sawtooth and nothing else, and halving h makes it four times as fast.
    run, gone = found.onset.refinement.runs[0], found.onset.departure[0]
    k = np.flatnonzero((gone > 1e-3) & (gone < 10))
    np.testing.assert_allclose(gone[k], seed * (1 + 4 * courant) ** k, rtol=1e-3)
    assert run.t[1] == pytest.approx(courant * h[0] ** 2)
    assert found.growth[1] / found.growth[0] == pytest.approx(4)
    assert found.growth[0] < heat(n, courant / 2, seed).growth[0] < 4 / h[0] ** 2
    assert f"rises to 4/h^2 = {4 / h[0] ** 2:.3g}" in found.verdict
    assert f"seen at t = {found.onset.t[0]:.3g}" in found.verdict


@pytest.mark.parametrize("n", [16, 24, 32, 64])
def test_round_off_alone_is_seen_near_when_foretold(n):
    found = heat(n, 0.05, 0.0)
    seen = np.isfinite(found.onset.t)
    np.testing.assert_allclose(found.onset.t[seen], found.predicted[seen], rtol=0.12)
    assert seen[1]
    assert "the last bit" in found.verdict


def test_the_coarse_grid_looks_fine():
    found = heat(12, 0.05, 0.0)
    assert found.onset.t[0] == math.inf
    assert "looks fine" in found.verdict
    assert np.abs(found.onset.refinement.runs[0].final[0]).max() < math.e**1.5


def test_the_grid_sees_less_than_the_equation_and_in_the_limit_all_of_it():
    found = heat(64, 0.01, 1e-12)
    for grid_xi, rate, n in zip(found.grid_xi, found.grid_rate, (64, 128), strict=True):
        h = Grid(n).h
        assert grid_xi[-1] == pytest.approx(math.pi / h)
        np.testing.assert_allclose(rate, np.log1p(0.04 * np.sin(grid_xi * h / 2) ** 2) / (0.01 * h * h), rtol=1e-10)
        assert (rate < grid_xi**2).all()
        assert rate[0] == pytest.approx(1, rel=0.01)
    # The equation itself: however smooth the data, at its onset the finer grid's shortest wave is larger than 1.
    assert scaled_amplitude(64.0, 0.1, 10) > 1
    assert scaled_amplitude(64.0, 0.0, 10) < 1e-17


@pytest.mark.parametrize(
    ("scene", "values", "error", "sentence"),
    [
        (refinement, {"a": 11}, ValueError, "a must be a finite number >= -10 and <= 10, got 11"),
        (refinement, {"n": 65}, ValueError, "n must be an integer >= 6 and <= 64, got 65"),
        (refinement, {"n": 50.0}, TypeError, "n must be an integer >= 6 and <= 64, got 50.0 (float)"),
        (refinement, {"dt": 0.0}, ValueError, "dt must be a finite number >= 1e-05 and <= 0.1, got 0.0"),
        (heat, {"n": 30}, ValueError, "n must be a multiple of 4, so that pi/2 is a grid point, got 30"),
        (heat, {"n": 260}, ValueError, "n must be an integer >= 4 and <= 256, got 260"),
        (heat, {"courant": 3}, ValueError, "courant must be a finite number >= 0.005 and <= 2, got 3"),
        (heat, {"seed": "x"}, TypeError, "seed must be a finite number >= 0 and <= 0.01, got 'x' (str)"),
        (heat, {"seed": TOLERANCE}, ValueError, "seed must be a finite number >= 0 and <= 0.01, got 0.1"),
    ],
)
def test_bad_input_gets_one_sentence(scene, values, error, sentence):
    with pytest.raises(error) as caught:
        scene(**values)
    assert str(caught.value) == sentence


def test_no_time_is_foretold_for_a_mode_that_is_lost_in_the_last_bit():
    assert diagnose(Toy(0.5), n=64, t_end=2000).t_blow_up == math.inf
    found = base_state(0.5, n=64)
    assert found.kind is Kind.HIDDEN
    assert found.growth > 0
    assert "too slowly for round-off to be seen by t = 100" in found.verdict
