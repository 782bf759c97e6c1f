"""One equation on several grids: against closed forms, against ``ftcs``, and against a step that is too large."""

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from primer import PDE, Toy, ftcs
from primer.__main__ import main
from primer.scenes.at_work import at_work
from primer.scenes.marched import data_of, in_words, marched
from primer.study.grid_comparison import compare_grids

TWO_LAYERS = (
    "h_t + (h*u)_x = 0; k_t + (k*w)_x = 0; u_t + u*u_x + (h + k)_x = 0; w_t + w*w_x + (r*h + k)_x = 0",
    {"h": "1 + 0.01*cos(x)", "k": "1 - 0.01*cos(x)", "u": "U/2", "w": "-U/2"},
)


@pytest.mark.parametrize(
    ("text", "initial", "rate", "speed"),
    [
        ("u_t = u_xx", {"u": "sin(2*x)"}, -4.0, 0.0),
        ("u_t = -u_x - u_xxxx", {"u": "sin(2*x)"}, -16.0, 1.0),
        ("u_t = u_xxx", {"u": "sin(2*x)"}, 0.0, 4.0),
    ],
)
def test_converges_to_the_closed_form_with_order_two(text, initial, rate, speed):
    t_end = 0.25
    found = compare_grids(PDE(text, initial), [32, 64, 128], t_end)
    errors = []
    for x, states in zip(found.x, found.states, strict=True):
        exact = np.exp(rate * found.t[:, None]) * np.sin(2 * (x - speed * found.t[:, None]))
        errors.append(np.abs(states[:, 0] - exact)[-1].max())
    assert found.order == pytest.approx(2, abs=0.1)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2, abs=0.1)
    assert np.isinf(found.lost).all()
    assert not found.by_scheme.any()
    assert "converge" in in_words(found)


def test_second_order_in_time_and_complex_fields():
    waves = compare_grids(PDE("u_tt = u_xx", {"u": "sin(x)", "u_t": "0"}), [16, 32, 64], 2.0)
    assert waves.states[2][-1, 0] == pytest.approx(np.cos(2.0) * np.sin(waves.x[2]), abs=2e-3)
    assert waves.order == pytest.approx(2, abs=0.1)
    quantum = compare_grids(PDE("i*p_t = -p_xx", {"p": "cos(x)"}), [16, 24], 1.0)  # grids that share few points
    assert quantum.gap[0, -1] == pytest.approx(np.abs(np.exp(-1j * _k2(16)) - np.exp(-1j * _k2(24))), rel=1e-3)
    assert math.isnan(quantum.order)


def _k2(n):
    return (n / np.pi * np.sin(np.pi / n)) ** 2


@pytest.mark.parametrize("shear", [0.1, 0.8])
def test_two_layers_below_and_above_the_critical_shear(shear):
    """Two fluids shear stably until the characteristics meet: from the polynomial's own roots, not from primer."""
    r, h = 0.9, 1.0
    lam = np.roots(  # ((U/2 - c)^2 - h) ((U/2 + c)^2 - h) = r h^2
        np.polysub(np.polymul(_layer(-shear / 2, h), _layer(shear / 2, h)), [r * h * h])
    )
    well = np.abs(lam.imag).max() < 1e-9
    problem = PDE(*TWO_LAYERS, r=r, U=shear)
    found = compare_grids(problem, [32, 64, 128], 10.0)
    assert well == (shear < 0.3)
    assert np.isinf(found.lost).all() == well
    assert ("converge" in in_words(found)) == well
    assert not found.by_scheme.any()


def _layer(u, h):
    return np.polysub(np.polymul([1, u], [1, u]), [h])


def test_backward_heat_is_lost_the_sooner_the_finer_and_no_step_cures_it():
    found = compare_grids(PDE("u_t = -u_xx", {"u": "exp(cos(x))"}), [16, 32, 64], 2.0)
    assert found.lost[0] > found.lost[1] > found.lost[2]
    assert not found.by_scheme.any()
    assert "the finer the grid the sooner" in in_words(found)


def test_the_toy_grows_at_the_grid_as_a_solver_of_scipy_has_it():
    toy = PDE(
        "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)",
        {"u": "a", "v": "-sin(x)/2"},
        steady={"u": "a - cos(x)", "v": "0"},
        a=1.5,
        eps=0.01,
    )
    found = compare_grids(toy, [24, 48], 3.0)
    n, h = 48, 2 * np.pi / 48
    x = -np.pi + h * np.arange(n)

    def rhs(t, y):
        u, v = y.reshape(2, n)
        first = [(np.roll(f, -1) - np.roll(f, 1)) / (2 * h) for f in (u, v)]
        v_xx = (np.roll(v, -1) - 2 * v + np.roll(v, 1)) / h**2
        return np.concatenate([first[1], 0.01 * u * v_xx + first[0] - v - np.sin(x)])

    start = np.concatenate([np.full(n, 1.5), -np.sin(x) / 2])
    truth = solve_ivp(rhs, (0, 3), start, rtol=1e-10, atol=1e-12).y[:, -1].reshape(2, n)
    assert found.states[1][-1] == pytest.approx(truth, abs=2e-4)
    run = ftcs(Toy(1.5), n=48, dt=1e-3, t_end=3.0)
    assert found.dist[1, -1] == pytest.approx(run.dist[-1], rel=2e-2)


def test_a_step_that_data_hide_is_found():
    """Nothing moves at first, so that the data allow any step; what forcing brings later does not."""
    found = compare_grids(PDE("u_t = 40*t*u_xx + sin(x)", {"u": "0"}), [16, 32, 64], 1.0)
    assert np.isinf(found.lost).all()
    assert found.dt[2] < 2.8 / (40 * 4 / (2 * np.pi / 64) ** 2) * 1.05  # RK4's limit at t = 1
    assert found.order == pytest.approx(2, abs=0.2)


def test_loss_that_is_of_the_equations():
    found = compare_grids(PDE("u_t = u^2", {"u": "1 + 0*x"}), [8, 16, 32], 2.0)
    assert found.lost == pytest.approx([1.05] * 3, abs=0.051)  # u = 1/(1 - t)
    assert "growth of the equations themselves" in in_words(found)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"ns": []}, "ns"),
        ({"ns": [64, 32]}, "ns"),
        ({"ns": 64}, "ns"),
        ({"ns": [2, 4]}, "ns"),
        ({"t_end": 0}, "t_end"),
        ({"t_end": math.nan}, "t_end"),
        ({"t_end": 1e9}, "t_end"),
        ({"problem": Toy(0.5)}, "problem"),
    ],
)
def test_bad_input(change, word):
    given = {"problem": PDE("u_t = u_xx", {"u": "sin(x)"}), "ns": [16, 32], "t_end": 1.0}
    with pytest.raises((TypeError, ValueError), match=word):
        compare_grids(**given | change)


def test_a_slider_does_not_wait():
    with pytest.raises(ValueError, match="t_end must be at most"):
        marched(PDE("u_t = -u_xxxx", {"u": "sin(x)"}), 128, 100.0)


def test_the_command(capsys, tmp_path):
    picture = tmp_path / "heat.svg"
    asked = ["run", "u_t = k*u_xx", "--initial", "u = sin(x)", "--set", "k=1", "--n", "16,32,64", "--t-end", "1"]
    assert main([*asked, "--plot", str(picture)]) == 0
    table = capsys.readouterr().out
    assert table.count("reached t = 1") == 3
    assert "order 2.0" in table
    assert "<title" in picture.read_text()
    assert main([*asked, "--json"]) == 0
    whole = json.loads(capsys.readouterr().out)
    assert whole["n"] == [16, 32, 64]
    assert whole["order"] == pytest.approx(2, abs=0.1)
    assert whole["lost"] == [None] * 3


def test_the_command_takes_names_of_variables_and_functions(capsys):
    with_names = ["run", "c_tau = f(c)_rr", "--space", "r", "--time", "tau", "--set", "f=k*c", "k=1"]
    plain = ["run", "u_t = k*u_xx", "--set", "k=1"]
    assert main([*with_names, "--initial", "c = sin(r)", "--n", "16,32", "--t-end", "0.5", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert main([*plain, "--initial", "u = sin(x)", "--n", "16,32", "--t-end", "0.5", "--json"]) == 0
    expected = json.loads(capsys.readouterr().out)
    assert found["dist"] == pytest.approx(expected["dist"], rel=1e-9)


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        (["u_t = u_xx", "--initial", "u"], "--initial"),
        (["u_t = w*u_xx", "--initial", "u=1"], "--set w=1"),
        (["u_t = u_xx", "--initial", "u=1", "u=2"], "each field once"),
        (["u_t = u_xx", "--initial", "u=1", "--plot", "x.gif"], "--plot"),
        (["u_t = u_xx", "--initial", "u=1", "--plot", "/nowhere/x.svg"], "--plot"),
        (["u_x + v_y = 0; u_t = v_x", "--initial", "u=1"], "judged"),
    ],
)
def test_the_command_says_what_is_wrong(asked, says, capsys):
    assert main(["run", *asked]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert says in said.err
    assert "Traceback" not in said.err


def test_data_of():
    assert data_of("u = a; v = -sin(x)/2") == {"u": "a", "v": "-sin(x)/2"}
    assert data_of("u = 1\nv=2;") == {"u": "1", "v": "2"}


def test_at_work_marches_with_the_parameters_of_the_base_state():
    found = at_work("u_t = nu*u_xx", at="nu=0.5", initial="u = A*sin(x)", n=16, t_end=1.0)
    assert found.marched is None
    assert "A has no value" in found.verdict  # of the data, which the frozen equations do not know
    found = at_work("u_t = nu*u_xx", at="nu=0.5", initial="u = nu*sin(x)", n=16, t_end=1.0)
    assert found.marched.states[2][-1, 0] == pytest.approx(0.5 * math.exp(-0.5) * np.sin(found.marched.x[2]), abs=1e-3)


def test_at_work_says_why_nothing_is_marched():
    assert at_work("u_t = -u_xx", at="", initial="").marched is None
    across = at_work("u_t = u_xx - u_yy", at="", initial="u = 1")
    assert across.marched is None
    assert "judged" in across.verdict
    far = at_work("u_t = -u_xxxx", at="", initial="u = sin(x)", n=512, t_end=100.0)
    assert "t_end must be at most" in far.verdict
    for wrong, name in ({"period": "pie"}, "period"), ({"t_end": -1.0}, "t_end"), ({"n": 3}, "n"):
        with pytest.raises(ValueError, match=name):
            at_work("u_t = u_xx", at="", **wrong)


def test_at_work_sees_grid_and_growth_on_one_period():
    found = at_work(
        "u_t = -(u^2/2)_x - u_xx - u_xxxx",
        at="u=0",
        uniform=True,
        initial="u = cos(x/8)",
        period="16*pi",
        n=32,
        t_end=1.0,
    )
    assert found.frozen.cut_off == pytest.approx(2.0)  # pi/h, h = 16 pi/32
    assert found.marched.x[0][1] - found.marched.x[0][0] == pytest.approx(math.pi / 2)
    assert found.frozen.grid_rate.max() == pytest.approx(0.25, abs=0.03)
