"""Guards round-off as the seed: precision, one unit in the last place, order of operations, a line through seeds."""

import math

import numpy as np
import pytest

from primer import Seed, Stop, Toy, diagnose, ftcs
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


@pytest.mark.slow
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


@pytest.mark.parametrize("n", [4, 5, 8, 13, 14])
@pytest.mark.parametrize(("toy", "dt"), [(Toy(-1.0, 0.1), 0.02), (Toy(0.3, 0.5), 0.05), (Toy(0.5, 0.0), 0.05)])
def test_in_the_mirror_symmetric_order_dist_passes_each_bound_at_the_same_step(toy, n, dt):
    """Dist is what the plain scheme says, step by step: to 1.05, where all may be at once, 1.2, 2, and a blow-up."""
    for bound in (0.9, 1.1, 1.2, 2.0, 50.0):
        run = ftcs(toy, n, dt, 6.0, blow_up_at=bound)
        assert mirror_symmetric(toy, n, dt, 6.0, bound) == pytest.approx(blow_up_time(run))
        if run.stop is Stop.BLEW_UP and run.t_stop > 0:
            assert mirror_symmetric(toy, n, dt, run.t_stop, bound) == pytest.approx(run.t_stop)  # at the very end, too
            assert mirror_symmetric(toy, n, dt, run.t_stop - 0.6 * dt, bound) == math.inf


def test_a_bound_that_is_met_is_no_blow_up():
    """At the start Dist^2 is the largest of cos^2 x + sin^2 x/4."""
    for n in (4, 16):
        x = -math.pi + 2 * math.pi / n * np.arange(n)
        dist = np.sqrt(np.max(np.cos(x) ** 2 + np.sin(x) ** 2 / 4))
        assert mirror_symmetric(Toy(0.5), n, 0.1, 0.0, dist * (1 + 1e-12)) == math.inf
        assert mirror_symmetric(Toy(0.5), n, 0.1, 0.0, dist * (1 - 1e-12)) == 0.0


def test_the_ladder_of_precisions_is_what_it_is_called():
    assert {
        "float32": {"dtype": np.float32},
        "float64": {"dtype": np.float64},
        "longdouble": {"dtype": np.longdouble},
        "30 digits": {"digits": 30},
        "60 digits": {"digits": 60},
    } == PRECISIONS
    runs = precision_ladder(Toy(1.5), 4, 0.1, 0.3)
    assert list(runs) == list(PRECISIONS)
    for name, run in runs.items():
        same = ftcs(Toy(1.5), 4, 0.1, 0.3, **PRECISIONS[name])
        assert run.final[0].dtype == same.final[0].dtype
        np.testing.assert_array_equal(run.final, same.final)
    with pytest.raises(ValueError, match=r"^precisions must be of float32, .*, 60 digits, got '8 digits'$"):
        precision_ladder(Toy(1.5), 4, 0.1, 0.3, ["float32", "8 digits"])


def test_seeds_are_in_the_mode_next_to_the_sawtooth_of_v_unless_another_is_asked_for():
    for n, options, seed in (
        (64, {}, (31, "v")),
        (65, {}, (31, "v")),
        (64, {"mode": 32, "field": "u"}, (32, "u")),
        (64, {"mode": 5}, (5, "v")),
    ):
        found = seed_ladder(Toy(-3.0), n, 1e-3, 10.0, [1e-4, 1e-6, 1e-8], **options)
        assert [run.seed for run in found.runs] == [Seed(seed[0], x, seed[1]) for x in (1e-4, 1e-6, 1e-8)]
        assert found.times.tolist() == [run.t_stop for run in found.runs]
        slope, c = np.polyfit([math.log(1 / x) for x in (1e-4, 1e-6, 1e-8)], found.times, 1)
        assert (found.slope, found.c) == (pytest.approx(slope), pytest.approx(c))
    for bad, sentence in (
        ({"mode": 33}, "mode must be an integer >= 0 and <= 32, got 33"),
        ({"mode": -1}, "mode must be an integer >= 0 and <= 32, got -1"),
    ):
        with pytest.raises(ValueError, match=r"^mode") as caught:
            seed_ladder(Toy(-3.0), 64, 1e-3, 10.0, [1e-4, 1e-6], **bad)
        assert str(caught.value) == sentence
    for bad in ([1e-4], 1e-4, [1e-4, 0.0], [[1e-4, 1e-6]]):
        with pytest.raises(ValueError, match=r"^amplitudes must be a sequence of two or more numbers > 0, got "):
            seed_ladder(Toy(-3.0), 64, 1e-3, 10.0, bad)


def test_runs_that_live_are_left_out_of_the_line():
    found = seed_ladder(Toy(-3.0), 48, 1e-3, 5.0, [1e-4, 1e-6, 1e-300])
    assert np.isfinite(found.times).tolist() == [True, True, False]
    assert found.slope == pytest.approx(np.diff(found.times)[0] / math.log(100))
    assert found.c == pytest.approx(found.times[0] - found.slope * math.log(1e4))


def test_points_are_counted_from_either_end():
    toy, n = Toy(-3.0, 0.1), 24
    times = one_ulp(toy, n, 5e-3, 30.0, [0, 7, n - 1, -n, -1])
    assert np.isfinite(times).all()
    assert (times[0], times[2]) == (times[3], times[4])
    for k, time in ((0, times[0]), (7, times[1])):
        assert time == blow_up_time(ftcs(Nudged(toy, k, 1), n, 5e-3, 30.0))
    for wrong in (n, -n - 1):
        with pytest.raises(ValueError, match=r"^points") as caught:
            one_ulp(toy, n, 5e-3, 30.0, [0, wrong])
        assert str(caught.value) == f"points must be an integer >= -24 and <= 23, got {wrong}"
    u, v = Nudged(toy, -2, 3).initial(np.linspace(0, 1, 5))
    assert u[3] == -3 + 3 * np.spacing(-3.0)
    np.testing.assert_array_equal(v, toy.initial(np.linspace(0, 1, 5))[1])
    assert Nudged(toy, 0).eps == toy.eps
