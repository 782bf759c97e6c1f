"""Guards error against work: counts by hand, orders of accuracy, and the turn that ill-posed equations take."""

import numpy as np
import pytest

from primer import PastHorizon, Toy
from primer.study.effort import effort
from primer.view.growth import draw_growths
from primer.view.style import new_figure, styled
from primer.view.work_precision import draw_effort


def test_work_is_points_times_stages_times_steps():
    paper, fourth, best = effort(Toy(1.5), 2.0, (25, 50), ("FTCS", "central 4 + RK4", "Fourier + RK8"))
    assert paper.work.tolist() == [n * np.ceil(2.0 / ((2 * np.pi / n) ** 2 / 4)) for n in (25, 50)]
    for found, stages in ((fourth, 4), (best, 12)):
        steps = found.work / (stages * found.n)
        np.testing.assert_array_equal(steps, np.round(steps))
        np.testing.assert_allclose(steps * found.dt, 2.0)


@pytest.mark.parametrize(("method", "order"), [("FTCS", 2), ("central 2 + RK4", 2), ("central 4 + RK4", 4)])
def test_orders_of_accuracy(method, order):
    (found,) = effort(Toy(1.5), 2.0, (40, 80, 160), (method,))
    assert found.order == pytest.approx(order, abs=0.1)


def test_where_the_equations_are_ill_posed_more_work_is_lost():
    for found in effort(Toy(0.5), 5.0, (32, 64, 256)):
        assert found.error[1] < 3e-3
        assert found.error[2] == np.inf
    for found in effort(Toy(1.5), 5.0, (64, 256)):
        assert found.error[1] < max(found.error[0], 1e-11)


def test_a_run_that_blew_up_is_drawn_as_a_cross():
    found = effort(Toy(0.5), 5.0, (64, 256), ("FTCS", "Fourier + RK8"))
    with styled():
        _, (ax, other) = new_figure()
        draw_effort(ax, found)
        draw_growths(other, np.arange(3.0), {"one": np.array([-1.0, 0, 9])}, title="rates")
    crosses = [line for line in ax.lines if line.get_marker() == "x"]
    assert [line.get_xdata().tolist() for line in crosses] == [[one.work[1]] for one in found]
    assert other.get_title(loc="left") == "rates"


def test_bad_input_gets_one_sentence():
    with pytest.raises(ValueError, match=r"methods must be of FTCS, .*, got 'reference'"):
        effort(Toy(1.5), methods=["reference"])
    with pytest.raises(ValueError, match="t_end must be a finite number > 0, got 0"):
        effort(Toy(1.5), 0)
    with pytest.raises(PastHorizon, match="the horizon of"):
        effort(Toy(0.5), 50.0)
