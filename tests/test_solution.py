"""Guards the reference for any equation: its error bar covers the true error, and it refuses what is ill posed.

Second routes: solutions in closed form, the toy system's own reference, times of shocks.
"""

import numpy as np
import pytest
from test_equations import CASES

from primer import PDE, PastHorizon, Toy, reference
from primer.problems.heat import abs_sin_coefficients

KNOWN = (
    *("derivative 1", "derivative 2", "derivative 3", "derivative 4", "Burgers, conserved", "wave equation"),
    *(
        "forced nonlinear diffusion, in brackets",
        "Korteweg-de Vries",
        "travelling wave of a forced Kuramoto-Sivashinsky",
    ),
)


@pytest.mark.parametrize("name", KNOWN)
def test_the_error_bar_covers_the_true_error(name):
    case = CASES[name]
    t = np.array([case.t_end, 0.0, case.t_end / 3, case.t_end])  # in any order, repeated
    for tol in (1e-3, 1e-8):
        answer = reference(case.pde, t, tol)
        true = [np.abs(u - case.exact(answer.x, time)).max() for u, time in zip(answer.fields[0], t, strict=True)]
        image = 5e-12 if name == "Korteweg-de Vries" else 0.0  # the soliton's tail, a period away
        assert (np.array(true) <= answer.error + image).all()
        assert (answer.error <= tol).all()
        off = np.linspace(-1, 1, 7)
        assert np.abs(answer.at(off)[0][0] - case.exact(off, t[0])).max() <= answer.error[0] + image + 1e-13


def test_rough_data_are_covered_or_refused():
    """|sin x|^3 under heat against its Fourier series; a step in the data is not answered to 1e-3 at t = 0."""
    fold = PDE("u_t = u_xx", {"u": "abs(sin(x))^3"})
    answer = reference(fold, [0.0, 0.1], 1e-4)
    c = abs_sin_coefficients(3, 60)
    waves = (2 * c[m] * np.exp(-4 * m**2 * 0.1) * np.cos(2 * m * answer.x) for m in range(1, 61))
    series = c[0] + sum(waves)
    assert np.abs(answer.fields[0][1] - series).max() <= answer.error[1]
    assert np.abs(answer.at(0.37)[0][0] - abs(np.sin(0.37)) ** 3) <= answer.error[0]
    with pytest.raises(PastHorizon, match="512 points are not enough"):
        reference(PDE("u_t = u_x", {"u": "x/abs(x + 0.01)"}), 0.1, 1e-3)


def test_the_toys_text_has_the_toys_reference():
    text = PDE("u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)", {"u": "a", "v": "-sin(x)/2"}, a=1.5, eps=0.01)
    ours, own = reference(text, [1.0, 5.0], 1e-9), reference(Toy(1.5), [1.0, 5.0])
    assert np.abs(ours.at(own.x)[0] - own.u).max() <= (ours.error + own.error).max()
    with pytest.raises(PastHorizon, match="frozen about the solution, the equations are ill posed") as refusal:
        reference(text.replace(a=0.5), 2.0)
    assert 0.5 <= refusal.value.horizon <= 0.8252  # u first touches 0 at 0.825


@pytest.mark.parametrize(
    ("text", "start", "least", "most"),
    [
        ("u_t = -u_xx", {"u": "sin(x)"}, 0, 0),
        ("u_tt = -u_xx", {"u": "sin(x)", "u_t": 0}, 0, 0),
        ("u_t = v_x; v_t = -u_x", {"u": "sin(x)", "v": 0}, 0, 0),
        ("u_t = (u*u_x)_x", {"u": "0.5 + cos(x)"}, 0, 0),
        ("u_t = i*u + u_xxx - u_xx", {"u": "exp(i*x)"}, 0, 0),
        ("u_t = -(u^2/2)_x", {"u": "sin(x)"}, 0.7, 1.0),  # the shock is at t = 1
        ("u_t = u^2", {"u": "1 + 0*x"}, 0.8, 1.0),  # blows up at t = 1
    ],
)
def test_what_is_ill_posed_or_breaks_is_refused_after_its_time(text, start, least, most):
    with pytest.raises(PastHorizon) as refusal:
        reference(PDE(text, start), 2.0, 1e-6)
    assert least <= refusal.value.horizon <= most


def test_bad_input_gets_one_sentence():
    heat = PDE("u_t = u_xx", {"u": "sin(x)"})
    for t, tol, what in (
        (-1.0, 1e-6, "t must be"),
        (1.0, 0.0, "tol must be"),
        ("1", 1e-6, "t must be"),
        ([], 1e-6, "t"),
    ):
        with pytest.raises((TypeError, ValueError), match=f"^{what}"):
            reference(heat, t, tol)
    with pytest.raises(ValueError, match="300000 steps on 16 points"):
        reference(heat, 1e9)
    with pytest.raises(ValueError, match="abs of a complex field"):
        reference(PDE("i*u_t + u_xx + abs(u)^2*u = 0", {"u": "exp(i*x)"}), 0.1)
