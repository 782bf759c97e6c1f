"""Guards diagnose for any problem: against the runs themselves, with smaller steps and on finer grids."""

import json
import math
from itertools import pairwise

import numpy as np
import pytest

from primer import EULER, PDE, RK4, BackwardHeat, Seed, Toy, diagnose, ftcs
from primer.__main__ import main
from primer.schemes.jacobian import rates
from primer.study.companions import march
from primer.study.where import frozen

KEEPS = {"h_t": "-(h*(1-h)*s)_x", "s_t": "-(s^2*(1-2*h)/2 + h)_x"}
LAYERS = "; ".join(f"{left} = {right}" for left, right in KEEPS.items())
CAHN_HILLIARD = "u_t = (u^3 - u - 0.01*u_xx)_xx"


def burgers(nu):
    return PDE("u_t = nu*u_xx - (u^2/2)_x", {"u": "sin(x)"}, nu=nu)


PROBLEMS = {
    "Cahn-Hilliard": (PDE(CAHN_HILLIARD, {"u": "0.1 + 0.01*cos(3*x)"}), 100, RK4),
    "layers, slow": (PDE(LAYERS, {"h": "0.5 + 0.01*cos(x)", "s": "0.5"}), 64, RK4),
    "layers, fast": (PDE(LAYERS, {"h": "0.5 + 0.01*cos(x)", "s": "1.5"}), 64, RK4),
    "Kuramoto-Sivashinsky": (
        PDE("u_t = -u*u_x - u_xx - u_xxxx", {"u": "cos(x/16)*(1 + sin(x/16))"}, period=32 * np.pi), 96, RK4,
    ),
    "Burgers": (burgers(0.1), 64, EULER),
    "Burgers backwards": (burgers(-0.1), 48, EULER),
    "KdV by Euler": (PDE("u_t = -6*u*u_x - u_xxx", {"u": "1 + 0.1*cos(x)"}), 48, EULER),
    "KdV": (PDE("u_t = -6*u*u_x - u_xxx", {"u": "1 + 0.1*cos(x)"}), 48, RK4),
    "bad Boussinesq": (PDE("u_tt = u_xx + u_xxxx", {"u": "0.01*cos(x)", "u_t": "0"}), 48, RK4),
    "good Boussinesq": (PDE("u_tt = u_xx - u_xxxx", {"u": "0.01*cos(x)", "u_t": "0"}), 48, RK4),
    "Perona-Malik, gentle": (PDE("u_t = (u_x/(1 + u_x^2))_x", {"u": "0.5*sin(x)"}), 48, EULER),
    "Perona-Malik, steep": (PDE("u_t = (u_x/(1 + u_x^2))_x", {"u": "2*sin(x)"}), 48, EULER),
    "a fourth derivative": (PDE("u_t = -u_xx - 0.02*u_xxxx", {"u": "0.01*sin(x)"}), 64, RK4),
    "too small a one": (PDE("u_t = -u_xx - 1e-4*u_xxxx", {"u": "0.01*sin(x)"}), 64, RK4),
    "heat": (PDE("u_t = u_xx", {"u": "sin(x)"}), 48, EULER),
    "freezing lies": (PDE("w_t = i*w_xx + 3*i*cos(x)*w_x", {"w": "exp(cos(x))"}), 48, RK4),
}  # fmt: skip
STEPS = {  # dt and t_end
    "Cahn-Hilliard": [(2e-5, 1.0), (7e-5, 1.0), (2.5e-4, 1.0), (4e-4, 1.0), (7e-5, 0.05)],
    "layers, slow": [(1e-3, 3.0), (1e-2, 3.0), (0.1, 3.0), (0.4, 40.0), (0.8, 40.0)],
    "layers, fast": [(1e-3, 3.0), (1e-3, 8.0), (1e-2, 8.0), (3e-2, 8.0), (1e-3, 12.0)],
    "Kuramoto-Sivashinsky": [(1e-2, 30.0), (0.05, 30.0), (0.2, 30.0), (0.4, 30.0), (0.05, 60.0)],
    "Burgers": [(1e-3, 3.0), (1e-2, 3.0), (4e-2, 3.0), (6e-2, 3.0), (1e-2, 6.0)],
    "Burgers backwards": [(1e-3, 3.0), (1e-4, 3.0), (5e-3, 3.0), (1e-3, 0.1), (1e-3, 2.0)],
    "KdV by Euler": [(1e-4, 2.0), (1e-5, 1.0), (1e-3, 2.0), (3e-4, 2.0), (1e-4, 3.0)],
    "KdV": [(1e-4, 1.0), (1e-3, 1.0), (4e-3, 1.0), (8e-3, 1.0), (1e-4, 2.0)],
    "bad Boussinesq": [(1e-4, 1.0), (1e-3, 1.0), (1e-5, 1.0), (1e-4, 0.01), (3e-4, 2.0)],
    "good Boussinesq": [(1e-4, 1.0), (1e-3, 1.0), (1e-2, 4.0), (2e-2, 4.0), (1e-3, 2.0)],
    "Perona-Malik, gentle": [(1e-3, 1.0), (5e-3, 1.0), (2e-2, 3.0), (4e-2, 3.0), (1e-3, 2.0)],
    "Perona-Malik, steep": [(1e-3, 1.0), (1e-4, 0.02), (5e-3, 3.0), (2e-2, 3.0), (1e-3, 8.0)],
    "a fourth derivative": [(1e-4, 0.5), (1e-3, 0.5), (3e-3, 0.5), (1e-3, 2.0), (3e-4, 4.0)],
    "too small a one": [(1e-4, 0.02), (1e-4, 0.3), (3e-4, 0.3), (1e-3, 0.3), (1e-4, 1.0)],
    "heat": [(1e-3, 2.0), (5e-3, 2.0), (1.1e-2, 9.0), (3e-2, 3.0), (1e-3, 4.0)],
    "freezing lies": [(1e-3, 1.0), (5e-3, 1.0), (1.5e-2, 3.0), (3e-2, 3.0), (1e-3, 3.0)],
}


def apart(problem, n, t_end):
    """Differences at the end of runs on n, 2 n and 4 n points, by a step that heat would need; and the size."""
    ends = [np.array(ftcs(problem, m, 2e-3 * (48 / m) ** 2, t_end, progress=False).final[0]) for m in (n, 2 * n, 4 * n)]
    return [np.abs(a - b[::2]).max() for a, b in pairwise(ends)], np.abs(ends[0]).max()


def lost(problem, n, dt, t_end, time):
    return march(problem, n, dt, t_end, None, np.float64, time).t_lost


@pytest.mark.slow
@pytest.mark.parametrize("name", PROBLEMS)
def test_against_the_runs(name):
    """At (n, dt), (n, dt/4), (2 n, dt/4) and (4 n, dt/16), as far as each of them can say something."""
    problem, n, time = PROBLEMS[name]
    for dt, t_end in STEPS[name]:
        found = diagnose(problem, n, dt, t_end, time=time)
        here, gentle = lost(problem, n, dt, t_end, time), lost(problem, n, dt / 4, t_end, time)
        assert (found.blow_up is not None) == (here < math.inf), (dt, found)
        if here < math.inf:
            assert found.blow_up[0] <= here <= found.blow_up[1]
            assert found.kind in ("scheme", "ill-posed", "unstable", "undecided")
            if gentle == math.inf:
                assert found.kind == "scheme", (dt, found)
        elif found.kind == "scheme":
            assert found.stable_dt < dt
            assert "though nothing is lost by then" in found.reason
        elif found.kind == "ill-posed":
            assert "filled with waves of two to four spacings" in found.reason
            (first, second), size = apart(problem, n, t_end)
            assert second > 0.6 * first > 0.02 * size  # refining does not bring the grids together
            continue
        else:
            assert found.kind in ("converges", "hidden", "transient", "unstable"), (dt, found)
        if found.kind == "scheme" and here < math.inf:
            assert gentle > 1.5 * here
            if found.stable_dt:
                assert lost(problem, n, found.stable_dt, t_end, time) > 1.5 * here
        if found.kind == "ill-posed":
            assert gentle < math.inf
            assert lost(problem, 2 * n, dt / 4, t_end, time) < 1.05 * gentle
            assert lost(problem, 4 * n, dt / 16, t_end, time) < 1.05 * gentle
        if found.kind == "hidden":
            later = max(30 * t_end, 3.0)
            if lost(problem, 4 * n, dt / 16, later, time) == math.inf:  # growth saturates: the grids part, then
                (first, second), size = apart(problem, n, later)
                assert second > 0.6 * first > 0.02 * size


def kinds(name, *settings):
    problem, n, time = PROBLEMS[name]
    return [str(diagnose(problem, n, dt, t_end, time=time).kind) for dt, t_end in settings]


def test_kinds():
    assert kinds("Cahn-Hilliard", (7e-5, 1.0), (4e-4, 1.0)) == ["unstable", "scheme"]
    assert kinds("Burgers", (1e-3, 3.0), (6e-2, 3.0)) == ["converges", "scheme"]
    assert kinds("Burgers backwards", (1e-3, 3.0), (1e-3, 0.1)) == ["ill-posed", "hidden"]
    assert kinds("layers, slow", (1e-3, 3.0)) == ["converges"]
    assert kinds("layers, fast", (1e-3, 8.0)) == ["ill-posed"]
    assert kinds("KdV by Euler", (1e-4, 2.0)) == ["scheme"]
    assert kinds("Perona-Malik, steep", (1e-3, 1.0), (1e-4, 0.02)) == ["ill-posed", "hidden"]
    assert kinds("a fourth derivative", (1e-3, 0.5), (3e-4, 4.0)) == ["scheme", "unstable"]


def test_equations_that_become_ill_posed_in_time():
    """u_t = cos(t) u_xx is ill posed from t = pi/2 to 3 pi/2; with a hundredth of it, a coarse grid recovers."""
    found = diagnose(PDE("u_t = cos(t)*u_xx", {"u": "sin(x)"}), 32, 1e-3, 6.0)
    assert found.kind == "ill-posed"
    assert "for all x, from about t = " in found.reason
    since = float(found.reason.split("from about t = ")[1].split()[0])
    assert math.pi / 2 - 0.1 < since < math.pi / 2 + 0.6
    gentle = PDE("u_t = 0.01*cos(t)*u_xx", {"u": "sin(x)"})
    assert diagnose(gentle, 32, 1e-2, 6.0).kind == "transient"
    assert diagnose(gentle, 32, 1e-2, 1.5).kind == "converges"


def test_what_only_the_scheme_lets_grow_is_its_fault_before_anything_is_lost():
    """Forward Euler multiplies the shortest waves of i a_t = -a_xx by e^(2.7 t) here."""
    problem = PDE("i*a_t = -a_xx", {"a": "exp(cos(x))"})
    found = diagnose(problem, 48, 1e-4, 2.0)
    assert (found.kind, found.stable_dt) == ("scheme", 0.0)
    rate = 4 / (2 * np.pi / 48) ** 2
    assert f"e^({np.log1p((1e-4 * rate) ** 2) / 2e-4:.3g} t)" in found.reason
    assert diagnose(problem, 48, 1e-5, 0.1).kind == "converges"


def test_a_front_that_no_grid_resolves_is_not_called_the_solutions_own():
    """Viscous Burgers has a solution for ever; central differences lose it where u h exceeds the viscosity by far."""
    steep = PDE("u_t = u_xx - (u^2/2)_x", {"u": "1000*sin(x)"})
    found = diagnose(steep, 64, 1e-4, 0.1)
    assert found.kind == "undecided"
    assert "a front that no such grid resolves" in found.reason
    assert diagnose(PDE("u_t = u_xx + u^2", {"u": "1 + 0.1*cos(x)"}), 32, 1e-3, 2.0).kind == "unstable"


@pytest.mark.parametrize(("text", "data"), [("u_t = 2*u", "0"), ("u_t = v; v_t = -u", "0"), ("u_t = 0*u", "1")])
def test_equations_without_derivatives(text, data):
    """About uniform states, and such as vary, every wave does the same."""
    fields = [part.split("_t")[0].strip() for part in text.split(";")]
    for initial in (float(data), "sin(x)"):
        found = diagnose(PDE(text, dict.fromkeys(fields, initial)), 32, 1e-2, 3.0)
        factor = {"u_t = 2*u": 1.02, "u_t = v; v_t = -u": math.hypot(1, 1e-2), "u_t = 0*u": 1.0}[text]
        np.testing.assert_allclose(found.amplification, factor)


def test_freezing_lies_and_central_differences_do_not():
    problem, n, time = PROBLEMS["freezing lies"]
    found = diagnose(problem, n, 1e-3, 1.0, time=time)
    assert found.kind == "converges"
    assert "freezing lies here" in found.reason
    assert found.where


def test_a_fourth_derivative_too_small_for_the_grids():
    """u_t = -u_xx - e u_xxxx: growth is at most 1/(4 e), at k = 1/sqrt(2 e), which a grid sees from n = pi k on."""
    e = 1e-4
    found = diagnose(PDE("u_t = -u_xx - e*u_xxxx", {"u": "sin(x)"}, e=e), 64, 1e-4, 1.0)
    assert found.kind == "unstable"
    assert "these grids cannot tell" in found.reason
    n = int(found.reason.split("about n = ")[1].split()[0])
    assert 0.7 < n / (math.pi / math.sqrt(2 * e)) < 1.4
    assert "bounded, by 2.5e+03" in found.reason


@pytest.mark.parametrize(
    ("text", "at", "dt", "time", "kind"),
    [
        (CAHN_HILLIARD, {"u": 0.1}, 2e-5, RK4, "unstable"),
        (CAHN_HILLIARD, {"u": 0.1}, 4e-4, RK4, "scheme"),
        ("u_t = -u_xx", {"u": 0.0}, 1e-4, EULER, "ill-posed"),
        ("u_t = u_xx", {"u": 1.0}, 1e-3, EULER, "converges"),
        ("u_t = u_x", {"u": 1.0}, 1e-2, EULER, "scheme"),
        (LAYERS, {"h": 0.5, "s": 1.5}, 1e-3, RK4, "ill-posed"),
        (LAYERS, {"h": 0.5, "s": 0.5}, 1e-3, RK4, "converges"),
    ],
)
def test_uniform_states(text, at, dt, time, kind):
    problem = PDE(text, at)
    found = diagnose(problem, 100, dt, 50.0, time=time)
    assert found.kind == kind
    assert not found.ran
    expected = [max(rates(problem, n).real.max(), 0.0) for n in (100, 200, 400)]
    np.testing.assert_allclose(found.growths, expected, rtol=1e-9, atol=1e-9)


def test_a_uniform_state_is_lost_when_the_linear_equations_say():
    """The seed is the sawtooth's neighbour: e^(growth t) of it is 1 at the middle of the interval."""
    problem, seed = PDE("u_t = -u_xx", {"u": 0.0}), Seed(20, 1e-6)
    found = diagnose(problem, 40, 1e-4, 5.0, seed)
    run = march(problem, 40, 1e-4, 5.0, seed, np.float64, EULER)
    assert found.blow_up[0] <= run.t_lost <= 1.5 * found.blow_up[1]
    assert found.seeded


def test_the_amplification_of_each_wave_of_a_uniform_state():
    n, dt = 40, 1.4e-2
    k, h = np.arange(n // 2 + 1), 2 * np.pi / n
    found = diagnose(PDE("u_t = u_xx + u_x", {"u": 1.0}), n, dt, 50.0)
    lam = -((2 * np.sin(k * h / 2) / h) ** 2) + 1j * np.sin(k * h) / h
    np.testing.assert_allclose(found.amplification, np.abs(1 + dt * lam), rtol=1e-12)
    assert found.wavelength == pytest.approx(2 * np.pi / np.argmax(found.amplification))
    runge_kutta = diagnose(PDE("u_t = -u_xxx", {"u": 1.0}), n, dt, 50.0, time=RK4)
    z = dt * 1j * np.sin(k * h) / h * (2 * np.sin(k * h / 2) / h) ** 2
    np.testing.assert_allclose(runge_kutta.amplification, np.abs(1 + z + z**2 / 2 + z**3 / 6 + z**4 / 24), rtol=1e-9)
    one_sided = diagnose(PDE("w_t = -i*w_x", {"w": "0"}), n, dt, 5.0)  # of w, k grows and -k decays
    np.testing.assert_allclose(one_sided.amplification, 1 + dt * np.sin(k * h) / h, atol=1e-12)


@pytest.mark.parametrize("nu", [0.1, -0.1])
def test_the_amplification_and_the_fastest_wave_of_a_state_that_varies(nu):
    """Frozen at each x by hand; the strongest wave of the Jacobian's fastest mode, the mean apart, by complex steps."""
    n, dt = 48, 1e-3
    found = diagnose(burgers(nu), n, dt, 2 * dt)
    x, h = 2 * np.pi * np.arange(n) / n - np.pi, 2 * np.pi / n
    k, u = np.arange(n // 2 + 1)[:, None], np.sin(x)
    u_x = np.cos(x) * np.sin(h) / h
    lam = -nu * (2 * np.sin(k * h / 2) / h) ** 2 - u * 1j * np.sin(k * h) / h - u_x
    np.testing.assert_allclose(found.amplification, np.abs(1 + dt * lam).max(axis=1), atol=1e-4)

    def slope(u):
        plus, minus = np.roll(u, -1), np.roll(u, 1)
        return nu * (plus - 2 * u + minus) / h**2 - (plus**2 - minus**2) / (4 * h)

    J = np.array([slope(u + 1e-30j * e).imag / 1e-30 for e in np.eye(n)]).T
    factors, vectors = np.linalg.eig(np.eye(n) + dt * J)
    strongest = 1 + np.argmax(np.abs(np.fft.fft(vectors[:, np.argmax(np.abs(factors))]))[1 : n // 2 + 1])
    assert found.wavelength == pytest.approx(2 * np.pi / strongest)
    assert strongest == (1 if nu > 0 else n // 2)


def test_backward_heat_and_problems_of_ones_own():
    found = diagnose(BackwardHeat(), 32, 1e-4, 5.0)
    assert found.kind == "ill-posed"


def test_where_it_is_ill_posed_in_words():
    toy = PDE("u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)", {"u": "a - cos(x)", "v": "0"}, a=0.5, eps=0.01)
    x = 2 * np.pi * np.arange(200) / 200 - np.pi
    found = frozen(toy, 200, [np.array(toy.initial(x))])
    assert found.text == "where u < 0, for |x| < 1.05"  # acos(0.5)
    heat = PDE("u_t = c*u_xx", {"u": "sin(x)"}, c=-1.0)
    assert frozen(heat, 32, [np.array(heat.initial(x[:32]))]).text == "for all x"
    assert frozen(heat.replace(c=1.0), 32, [np.array(heat.initial(x[:32]))]).text == ""


@pytest.mark.slow
def test_the_toy_system_as_a_text_is_diagnosed_as_itself():
    for a, n in ((0.5, 100), (1.5, 100), (0.5, 30)):
        text = PDE(
            "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)", {"u": "a", "v": "-sin(x)/2"},
            steady={"u": "a - cos(x)", "v": "0"}, a=a, eps=0.01,
        )  # fmt: skip
        assert diagnose(text, n, 1e-3, 30.0).kind == diagnose(Toy(a), n, 1e-3, 30.0).kind


def test_what_is_too_long_is_refused_and_digits_are_the_toys():
    with pytest.raises(ValueError, match="n t_end/dt must be <= 3e\\+09 for a diagnosis"):
        diagnose(burgers(0.1), 1000, 1e-6, 100.0)
    with pytest.raises(ValueError, match="digits must be None but for a Toy"):
        diagnose(burgers(0.1), 32, 1e-3, 1.0, digits=30)
    with pytest.raises(ValueError, match="seed field must be one of u, got 'w'"):
        diagnose(burgers(0.1), 32, 1e-3, 1.0, seed=(3, 1e-6, "w"))


def test_the_command(capsys):
    assert main(["diagnose", "u_t = -u_xx", "--at", "u=0.1", "--n", "128", "--dt", "1e-3"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("kind:     ill-posed\nblow-up:  t = ")
    command = ["diagnose", CAHN_HILLIARD, "--at", "u=0.1", "--n", "100", "--dt", "4e-4", "--time", "rk4", "--json"]
    assert main(command) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["kind"] == "scheme"
    assert 2e-4 < found["stable_dt"] < 4e-4
    assert len(found["growths"]) == 3
    initial = ["diagnose", "u_t = nu*u_xx - (u^2/2)_x", "--initial", "u = sin(x)", "--at", "nu=0.1", "--t-end", "2"]
    assert main(initial) == 0
    assert capsys.readouterr().out.startswith("kind:     converges")
    assert main(["diagnose", "u_t = nu*u_xx", "--at", "u=0.1"]) == 2
    assert "nu" in capsys.readouterr().err
