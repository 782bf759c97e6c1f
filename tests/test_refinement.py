"""Guards the grid-refinement studies: orders, blow-up times, the onset of the sawtooth; and their bad input."""

import math

import numpy as np
import pytest

from primer import Seed, Stop, Toy
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
