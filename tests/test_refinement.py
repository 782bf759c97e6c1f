"""Guards the grid-refinement studies: orders, blow-up times, the onset of the sawtooth; and their bad input."""

import math

import numpy as np
import pytest

from primer import BackwardHeat, Seed, Stop, Toy, ftcs
from primer.schemes.discrete import amplification
from primer.schemes.grid import Grid
from primer.study.refinement import heat_onset, refine


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: refine(Toy(1.5), 16), "ns must be a sequence of grids, such as [50, 100], got 16"),
        (lambda: refine(Toy(1.5), "16"), "ns must be a sequence of grids, such as [50, 100], got '16'"),
        (lambda: heat_onset(16), "ns must be a sequence of grids, such as [50, 100], got 16"),
        (lambda: heat_onset([16, 30]), "ns must be multiples of four points, got 30"),
        (lambda: heat_onset([16.0]), "ns must be an integer >= 4, got 16.0 (float)"),
        (lambda: heat_onset([16], courant=0), "courant must be a finite number >= 1e-06 and <= 1e+06, got 0"),
        (lambda: heat_onset([16], tolerance=0), "tolerance must be a finite number >= 1e-15 and <= 1, got 0"),
        (lambda: heat_onset([16], sawtooth=0.01), "sawtooth must be a finite number >= 0 and < 0.01, got 0.01"),
    ],
)
def test_bad_input_gets_one_sentence(call, sentence):
    with pytest.raises((TypeError, ValueError)) as caught:
        call()
    assert str(caught.value) == sentence


def test_a_well_posed_run_gains_and_an_ill_posed_one_loses_by_refinement():
    """Well posed: Dist comes to rest on h/sin h - 1, a quarter for half the spacing. Ill posed: blow-up ever sooner."""
    well = refine(Toy(1.5), [16, 32, 64], dt=5e-3, t_end=40.0)
    assert well.n.tolist() == [16, 32, 64]
    np.testing.assert_allclose(well.dist_end, well.h / np.sin(well.h) - 1, rtol=1e-4)
    assert np.isinf(well.t_blow_up).all()
    ill = refine(Toy(-3.0), (32, 64, 128), dt=lambda n: 0.1 / n, seed=lambda n: Seed(n // 2 - 1, 1e-6), t_end=40.0)
    assert [run.dt for run in ill.runs] == [0.1 / n for n in (32, 64, 128)]
    assert [run.seed.mode for run in ill.runs] == [15, 31, 63]
    assert all(run.stop is Stop.BLEW_UP for run in ill.runs)
    assert (np.diff(ill.t_blow_up) < 0).all()


def test_the_onset_of_the_sawtooth_in_the_backward_heat_equation():
    """Seeded, it has grown to the tolerance at the time the amplification says; half the spacing, a quarter of it."""
    found = heat_onset([16, 32, 64], courant=0.05, tolerance=1e-2, sawtooth=1e-9)
    h = 2 * math.pi / np.array([16, 32, 64])
    rate = math.log1p(4 * 0.05) / (0.05 * h**2)  # sin^2(xi h/2) = 1
    np.testing.assert_allclose(found.predicted, math.log(1e7) / rate, rtol=1e-12)
    np.testing.assert_allclose(found.t, found.predicted, rtol=0.02)
    for run, departure in zip(found.refinement.runs, found.departure, strict=True):
        late = run.t > 0.9 * run.t[-1]
        assert np.polyfit(run.t[late], np.log(departure[late]), 1)[0] == pytest.approx(
            rate[h == 2 * np.pi / run.n], rel=1e-3
        )
    unseeded = heat_onset([16, 32])
    assert np.isinf(unseeded.predicted).all()
    assert 2.5 < unseeded.t[0] / unseeded.t[1] < 5  # round-off seeds it: a quarter, but for a logarithm


def test_each_run_is_that_of_the_scheme_and_the_last_record_is_its_end():
    found = refine(Toy(0.5), [8, 11], dt=0.01, t_end=1.0, seed=Seed(2, 1e-3))
    for run, n in zip(found.runs, (8, 11), strict=True):
        np.testing.assert_array_equal(run.final, ftcs(Toy(0.5), n, 0.01, 1.0, seed=Seed(2, 1e-3)).final)
    assert found.dist_end.tolist() == [run.dist[-1] for run in found.runs]
    assert found.dist_end.dtype == float
    assert refine(Toy(0.5), [8], 0.01, (2, 1e-3), t_end=1.0).dist_end[0] == found.dist_end[0]
    np.testing.assert_allclose(found.h, [math.pi / 4, 2 * math.pi / 11])


@pytest.mark.parametrize("sawtooth", [1e-9, 0.0])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_left_to_itself_a_run_ends_when_the_grid_has_surely_taken_over(sawtooth, tolerance):
    """At ten thousand times the tolerance, round-off being 1e-18 to be sure, or at Dist = 100 if that is before."""
    courant = 0.05
    found = heat_onset([16, 20], courant, tolerance, sawtooth)
    steps = math.log(1e4 * tolerance / (sawtooth or 1e-18)) / math.log1p(4 * courant)
    for run, n, departure, t in zip(found.refinement.runs, (16, 20), found.departure, found.t, strict=True):
        assert run.dt == pytest.approx(courant * Grid(n).h ** 2)
        assert run.blow_up_at == 100
        assert round(run.t_stop / run.dt) == round(steps) or run.stop is Stop.BLEW_UP
        assert run.stop is Stop.REACHED_END or tolerance == 1e-2  # where Dist ends at about 1 it is not stopped before
        assert run.t.size == round(run.t_stop / run.dt) + 1  # each step is kept
        factor = amplification(BackwardHeat().symbol(1.0, Grid(n).multiplier), run.dt)[0].real
        np.testing.assert_allclose(departure, np.abs(run.dist - factor ** np.arange(run.t.size)), atol=1e-14)
        first = next(i for i, each in enumerate(departure) if each > tolerance)
        assert t == run.t[first]
    assert found.tolerance == tolerance
    if sawtooth:
        assert [run.seed for run in found.refinement.runs] == [Seed(n // 2, sawtooth, phase=0.0) for n in (16, 20)]
    else:
        assert [run.seed for run in found.refinement.runs] == [None, None]


def test_what_has_not_taken_over_by_the_end_never_does():
    found = heat_onset([8], courant=0.1, t_end=0.5, snapshots=[0.25])
    assert found.t.tolist() == [math.inf]
    (run,) = found.refinement.runs
    assert run.t_stop == pytest.approx(0.5, abs=run.dt)
    assert list(run.snapshots) == [0.25]
    assert heat_onset([8], courant=1e6, t_end=0.0).t.tolist() == [math.inf]
    with pytest.raises(ValueError, match=r"^courant must be a finite number >= 1e-06 and <= 1e[+]06, got 1000000.5$"):
        heat_onset([8], courant=1e6 + 0.5, t_end=0.0)
