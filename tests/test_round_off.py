"""Guards round-off as the seed: precision, one unit in the last place, order of operations, a line through seeds."""

import math

import numpy as np
import pytest

from primer import Stop, Toy, diagnose, ftcs
from primer.study.round_off import (
    PRECISIONS,
    Nudged,
    blow_up_time,
    mirror_symmetric,
    one_ulp,
    precision_ladder,
    seed_ladder,
)

PAPER = Toy(0.5)


def test_blow_up_time():
    assert blow_up_time(ftcs(PAPER, 30, t_end=1.0)) == math.inf
    assert blow_up_time(ftcs(Toy(-5.0), 100)) < 2


def test_seeds_lie_on_a_line_of_slope_one_over_growth():
    """T = c + ln(1/delta)/growth, to 2 %; times scatter by a quarter of the mode's period, 8.7."""
    amplitudes = 10.0 ** -np.arange(6, 14)
    found = seed_ladder(PAPER, 80, 1e-3, 200.0, amplitudes)
    assert found.rate == pytest.approx(0.6132, abs=1e-3)
    assert found.slope * found.rate == pytest.approx(1, rel=0.02)
    line = found.c + found.slope * np.log(1 / amplitudes)
    np.testing.assert_allclose(found.times, line, atol=8.7 / 4)


def test_two_blow_ups_make_a_line_and_one_does_not():
    two = seed_ladder(Toy(-2.0), 64, 1e-3, 20.0, [1e-4, 1e-8])
    assert np.isfinite(two.times).all()
    assert two.slope == pytest.approx(np.diff(two.times)[0] / math.log(1e4))
    with pytest.raises(ValueError, match="must make at least two runs blow up by t_end = 2, got 1"):
        seed_ladder(Toy(-2.0), 64, 1e-3, 2.0, [1e-4, 1e-8])


def test_each_precision_buys_time():
    runs = precision_ladder(Toy(-1.0), 48, 4e-3, 40.0, ("float32", "float64", "longdouble"))
    times = np.array([blow_up_time(run) for run in runs.values()])
    expected = [diagnose(Toy(-1.0), 48, 4e-3, 40.0, **PRECISIONS[name]).blow_up for name in runs]
    for time, (earliest, latest) in zip(times, expected, strict=True):
        assert earliest <= time <= latest
    if np.finfo(np.longdouble).eps < np.finfo(float).eps:
        assert times[0] < times[1] < times[2]


@pytest.mark.slow
def test_thirty_digits_blow_up_too():
    (run,) = precision_ladder(Toy(-1.0), 48, 4e-3, 40.0, ("30 digits",)).values()
    earliest, latest = diagnose(Toy(-1.0), 48, 4e-3, 40.0, digits=30).blow_up
    assert run.stop is Stop.BLEW_UP
    assert earliest <= run.t_stop <= latest


def test_one_ulp_moves_the_blow_up_by_an_e_folding_or_so():
    run = ftcs(PAPER)
    moved = one_ulp(PAPER, 100, 1e-3, 40.0, [25, 75])
    assert np.all(moved != run.t_stop)
    np.testing.assert_allclose(moved, run.t_stop, atol=4 / 2.727)
    x = np.linspace(-3, 3, 7)
    u, _ = Nudged(PAPER, 2).initial(x)
    assert np.flatnonzero(u != PAPER.a).tolist() == [2]
    assert u[2] == np.nextafter(PAPER.a, 1)


def test_a_mirror_symmetric_order_never_excites_the_fastest_mode():
    """Left with the modes of the data's own symmetry, growth 0.706 instead of 2.727, it lives three times as long."""
    assert mirror_symmetric(PAPER, 100, 1e-3, 25.0) == math.inf
    assert ftcs(PAPER).t_stop < 15


@pytest.mark.slow
def test_a_mirror_symmetric_order_blows_up_late():
    assert 35 < mirror_symmetric(PAPER, 100, 1e-3, 80.0) < 60


def test_mirror_symmetric_order_is_the_same_scheme():
    """Where the smooth solution itself runs away, on few points, an odd number, the order does not matter."""
    run = ftcs(Toy(-1.0, 0.1), 13, 1e-3, 20.0)
    assert mirror_symmetric(Toy(-1.0, 0.1), 13, 1e-3, 20.0) == pytest.approx(run.t_stop, abs=2e-3)
    assert mirror_symmetric(Toy(1.5), 30, 1e-3, 5.0, blow_up_at=1.01) == math.inf


def test_too_few_blow_ups_for_a_line():
    with pytest.raises(ValueError, match="amplitudes must make at least two runs blow up"):
        seed_ladder(PAPER, 30, 1e-2, 5.0, [1e-3, 1e-6])


def test_a_ladder_may_begin_at_the_mean():
    """Mode 0 is a mode: it is marched, and only then found not to blow up."""
    with pytest.raises(ValueError, match="at least two runs blow up"):
        seed_ladder(Toy(1.5), 16, 1e-2, 0.1, [1e-8, 1e-6], mode=0)
