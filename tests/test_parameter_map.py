"""Guards the map of blow-up times over any two parameters: against the toy system's own map, and against verdicts."""

import numpy as np
import pytest

from primer import PDE, blow_up_map

TOY = PDE(
    "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)",
    {"u": "a", "v": "-sin(x)/2"}, steady={"u": "a - cos(x)", "v": "0"}, a=0.5, eps=0.01,
)  # fmt: skip


def test_the_toys_text_has_the_toys_map():
    own = blow_up_map([0.5, 1.5], [30, 100], t_end=20.0, progress=False)
    found = blow_up_map(TOY, vary={"a": [0.5, 1.5], "n": [30, 100]}, t_end=20.0)
    assert (np.isfinite(found.t_blow_up) == np.isfinite(own.t_blow_up)).all()
    assert found.t_blow_up[0, 1] == pytest.approx(own.t_blow_up[0, 1], rel=0.15)  # of round-off, at another dt
    assert found.t_seeded[0, 1] == pytest.approx(own.t_seeded[0, 1], rel=0.01)
    assert (found.from_round_off == own.from_round_off).all()
    assert found.names == ("a", "n")
    assert (found.dt == 1e-3).all()


def test_diffusion_of_either_sign_over_two_parameters_none_of_which_is_the_grid():
    """u_t = k u_xx + s u_x: only k < 0 blows up, whatever s, and no step is to blame."""
    pde = PDE("u_t = k*u_xx + s*u_x", {"u": "sin(x)"}, steady={"u": 0}, k=1, s=0)
    found = blow_up_map(pde, vary={"k": [-1.0, 0.5, 2.0], "s": [0.0, 1.0]}, n=32, t_end=5.0, dt=0.1)
    assert np.isfinite(found.t_blow_up).tolist() == [[True, True], [False, False], [False, False]]
    h = 2 * np.pi / 32
    assert (found.dt[1:] <= h**2 / 2 / np.array([[0.5], [2.0]])).all()
    assert found.t_seeded[0, 0] < found.t_blow_up[0, 0]


@pytest.mark.parametrize(
    ("call", "what"),
    [
        (lambda: blow_up_map(TOY, vary={"a": [1.0]}), "vary must be a dict of two"),
        (lambda: blow_up_map(TOY), "vary must be a dict of two"),
        (
            lambda: blow_up_map(TOY, vary={"a": [1.0], "b": [2.0]}),
            "vary must name parameters of the PDE, or n",
        ),
        (lambda: blow_up_map(TOY, vary={"a": [1.0], "n": [2]}), "vary n must be an integer >= 4, got 2"),
        (lambda: blow_up_map(TOY, vary={"a": ["x"], "n": [8]}), "vary a must be"),
        (lambda: blow_up_map(TOY, vary={"a": [1.0], "n": [8]}, dt=0), "dt must be"),
        (lambda: blow_up_map([0.5], [8], vary={"a": [1.0], "n": [8]}), "vary goes with a PDE"),
    ],
)
def test_bad_input_gets_one_sentence(call, what):
    with pytest.raises((TypeError, ValueError), match=what):
        call()
