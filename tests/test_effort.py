"""Guards error against work: counts by hand, orders of accuracy, and the turn that ill-posed equations take."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import primer.study.effort as effort_module
from primer import FOURIER, RK8, PastHorizon, Toy, march_lines, reference
from primer.study.contestants import Method
from primer.study.effort import Effort, effort
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


def agreed(t_end=5.0):
    """What Fourier on few points makes of a = 0.5: past the first u = 0, and so no reference."""
    return march_lines(Toy(0.5), 24, 0.05, t_end, FOURIER, RK8)


def test_where_the_equations_are_ill_posed_more_work_is_lost():
    for found in effort(Toy(0.5), 5.0, (32, 64, 256), against=agreed()):
        assert found.error[1] < 3e-3
        assert found.error[2] == np.inf
    for found in effort(Toy(1.5), 5.0, (64, 256)):
        assert found.error[1] < max(found.error[0], 1e-11)


def test_a_run_that_blew_up_is_drawn_as_a_cross():
    found = effort(Toy(0.5), 5.0, (64, 256), ("FTCS", "Fourier + RK8"), against=agreed())
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
        effort(Toy(0.5), 5.0)
    with pytest.raises(ValueError, match="against must be a march to t_end = 5, got one to 4"):
        effort(Toy(0.5), 5.0, against=agreed(4.0))
    with pytest.raises(TypeError, match="against must be a Lines"):
        effort(Toy(0.5), 5.0, against=3)


def test_against_a_march_the_difference_is_that_of_its_interpolant():
    toy = Toy(1.5)
    close = march_lines(toy, 32, 0.05, 2.0, FOURIER, RK8)
    for by_march, by_reference in zip(
        effort(toy, 2.0, (16, 50), against=close), effort(toy, 2.0, (16, 50)), strict=True
    ):
        np.testing.assert_allclose(by_march.error, by_reference.error, rtol=1e-3, atol=1e-11)


def test_the_order_is_the_slope_of_the_errors():
    h = 2 * math.pi / np.array([10, 30, 70])
    assert Effort("m", 2 * math.pi / h, h, h, 7 * h**3).order == pytest.approx(3)


def test_an_error_is_the_largest_of_u_and_v_and_a_thousand_is_a_blow_up():
    truth, toy = reference(Toy(1.5), 1.0, 1e-10), Toy(1.5)

    def march(toy, n, t_end):
        x = np.linspace(-3, 3, n)
        fields = np.array([f[0] for f in truth.at(x)])
        fields[n % 2, 1] -= {8: 0.5, 9: 999.0, 10: 1000.5, 11: np.nan}[n]
        return x, fields, 0.3

    found = effort_module._march(toy, 1.0, (8, 9, 10, 11), Method("m", march, (), True, 5), truth)
    np.testing.assert_allclose(found.error, [0.5, 999, np.inf, np.inf])
    assert found.work.tolist() == [n * 5 * 3 for n in (8, 9, 10, 11)]
    assert (found.method, found.n.tolist(), found.dt.tolist()) == ("m", [8, 9, 10, 11], 4 * [0.3])


def test_the_reference_is_asked_for_the_tolerance_stated(monkeypatch):
    asked = []
    truth = reference(Toy(1.5), 0.5, 1e-12)
    monkeypatch.setattr(effort_module, "reference", lambda *of: asked.append(of) or truth)
    monkeypatch.setattr(effort_module, "_march", lambda *of: SimpleNamespace(of=of))
    found = effort(Toy(1.5), 0.5, (8, 16))
    assert asked == [(Toy(1.5), 0.5, 1e-12)]
    assert [(each.of[0], each.of[1], each.of[2], each.of[3].name) for each in found] == [
        (Toy(1.5), 0.5, (8, 16), name) for name in ("FTCS", "central 4 + RK4", "central 6 + RK8", "Fourier + RK8")
    ]
    for wrong in ("FTCS and more", 3, "solve_ivp RK45, central 2"):
        with pytest.raises(ValueError, match=r"methods must be of FTCS, central 2 [+] RK4, .*, Fourier [+] RK8, got "):
            effort(Toy(1.5), 0.5, (8,), ["FTCS", wrong])
    with pytest.raises(TypeError, match="toy must be a Toy, got 3"):
        effort(3)
