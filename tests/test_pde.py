"""Guards ``PDE``: data of every kind, what it refuses, how it prints; and that every scheme marches it.

Second routes: exact solutions, the Toy's own runs to the bit, and the same problem written as an object of one's own.
"""

import pickle

import numpy as np
import pytest

from primer import CENTRAL, CENTRAL_4, CENTRAL_6, FOURIER, PDE, RK4, RK8, Seed, Toy, ftcs, ftcs_ensemble, march_lines
from primer.equations.text import PDEError
from primer.schemes.grid import Grid
from primer.schemes.weights import central

TOY = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"
START, END = {"u": "a", "v": "-sin(x)/2"}, {"u": "a - cos(x)", "v": "0"}
HEAT = "u_t = u_xx"


def toy(a=0.5, eps=0.01):
    return PDE(TOY, START, steady=END, a=a, eps=eps)


@pytest.mark.parametrize("kind", [{"dtype": np.float32}, {}, {"dtype": np.longdouble}, {"digits": 30}], ids=str)
def test_the_toys_text_is_the_toy_to_the_bit(kind):
    much = {"n": 12, "t_end": 0.02} if "digits" in kind else {"n": 100, "t_end": 1.0}
    options = {**much, **kind, "seed": Seed(3, 1e-3), "snapshots": [much["t_end"] / 2]}
    of_text, own = ftcs(toy(), **options), ftcs(Toy(0.5), **options)
    assert (np.array(of_text.final) == np.array(own.final)).all()
    assert (of_text.dist == own.dist).all()
    assert (of_text.u_min == own.u_min).all()


def test_it_prints_as_the_text_that_makes_it_again():
    for pde in (
        toy(),
        PDE("i*u_t + c*u_xx = 0", {"u": "exp(-x^2)*exp(i*k*x)"}, period=20.0, k=2, c=1 - 0.5j),
        PDE("u_tt = u_xx", {"u": [0, 1.5, 0, -1.5], "u_t": 0}),
    ):
        again = eval(repr(pde))
        assert again == pde
        assert hash(again) == hash(pde)
        assert pickle.loads(pickle.dumps(pde)) == pde
    assert toy() != toy(a=0.6)
    assert toy().replace(a=0.6) == toy(a=0.6)
    assert toy().replace(steady=None, period=4).dist_from == "initial"
    with pytest.raises(PDEError, match="'b' is no parameter"):
        toy().replace(b=1)


def test_data_of_every_kind_are_the_same_data():
    x = Grid(24).x
    kinds = ("sin(3*x)/2", np.sin(3 * x) / 2, lambda x: np.sin(3 * x) / 2, list(np.sin(3 * x) / 2))
    finer = Grid(36).x
    for kind in kinds:
        pde = PDE(HEAT, {"u": kind})
        assert np.abs(pde.initial(x)[0] - np.sin(3 * x) / 2).max() < 1e-15
        assert np.abs(pde.initial(finer)[0] - np.sin(3 * finer) / 2).max() < 1e-14
        assert pde.initial(x.reshape(2, 3, 4))[0].shape == (2, 3, 4)
    samples = np.random.default_rng(1).normal(size=24)
    pde = PDE(HEAT, {"u": samples})
    assert (pde.initial(x)[0] == samples).all()  # its own grid: as they are
    assert (pde.initial(x.astype(np.float32))[0] == samples.astype(np.float32)).all()
    assert float(ftcs(pde, n=24, dt=1e-3, t_end=0.0, digits=20).final[0][5]) == samples[5]
    sawtooth = PDE(HEAT, {"u": [1, -1] * 12}).initial(x + 0.1)[0]
    np.testing.assert_allclose(sawtooth, np.cos(12 * (x + np.pi + 0.1)), atol=1e-13)
    assert PDE(HEAT, {"u": 2}).initial(x)[0].tolist() == [2.0] * 24
    wave = PDE("u_t = i*u_xx", {"u": np.exp(2j * x)}).initial(finer)[0]
    np.testing.assert_allclose(wave, np.exp(2j * finer), atol=1e-13)


def test_another_period_and_many_digits():
    pde = PDE(HEAT, {"u": "cos(x/2)"}, period=4 * np.pi)
    run = ftcs(pde, n=8, dt=1e-2, t_end=0.05, digits=40)
    h, x = 4 * np.pi / 8, run.x
    assert x[0] == -2 * np.pi
    factor = 1 - 1e-2 * 4 / h**2 * np.sin(h / 4) ** 2
    np.testing.assert_allclose(run.final[0].astype(float), np.cos(x / 2) * factor**5, atol=1e-15)
    assert abs(run.final[0][0] + run.final[0][4]) < 1e-39  # cos(-pi) = -cos(0) to all digits: the period is 4 pi itself
    seeded = ftcs(PDE(HEAT, {"u": 0}, period=3.0), n=12, dt=1e-3, t_end=0, seed=(2, 0.5, "u", 0.0))
    np.testing.assert_allclose(seeded.final[0], 0.5 * np.cos(2 * 2 * np.pi / 3 * seeded.x), atol=1e-15)


def test_dist_is_from_the_steady_state_or_else_from_the_initial_data_and_says_so():
    with_steady = ftcs(PDE(HEAT, {"u": "1 + cos(x)"}, steady={"u": 1}), n=16, dt=0.01, t_end=1.0)
    without = ftcs(PDE(HEAT, {"u": "1 + cos(x)"}), n=16, dt=0.01, t_end=1.0)
    assert (with_steady.dist_from, without.dist_from, ftcs(Toy(1.5), t_end=0).dist_from) == (
        "steady",
        "initial",
        "steady",
    )
    assert with_steady.dist[0] == 1.0
    assert without.dist[0] == 0.0
    assert with_steady.dist[-1] + without.dist[-1] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("make", "what"),
    [
        (lambda: PDE(HEAT, {}), "initial must have data for u, got none for u"),
        (lambda: PDE("u_tt = u_xx", {"u": 1}), "none for u_t"),
        (lambda: PDE(HEAT, {"u": 1, "v": 2}), "only, got some for 'v'"),
        (lambda: PDE(HEAT, {"u": 1}, steady={"v": 2}), "steady must have data for u"),
        (lambda: PDE(HEAT, "sin(x)"), "initial must be a dict"),
        (lambda: PDE("u_t = c*u_xx", {"u": 1}), "c has no value"),
        (lambda: PDE(HEAT, {"u": "b*x"}), "b has no value"),
        (lambda: PDE(HEAT, {"u": 1}, c=2), "'c' has a value but occurs in no equation"),
        (lambda: PDE(HEAT, {"u": 1}, u=2), "'u' has a value but is a field"),
        (lambda: PDE(HEAT, {"u": 1}, pi=3), "pi has a meaning of its own"),
        (lambda: PDE("u_t = period*u", {"u": 1}), "period is what an argument is called"),
        (lambda: PDE("u_t = c*u_xx", {"u": 1}, c="1"), "c must be a finite number"),
        (lambda: PDE("u_t = c*u_xx", {"u": 1}, c=True), "c must be a finite number"),
        (lambda: PDE("u_t = c*u_xx", {"u": 1}, c=np.inf), "c must be a finite number"),
        (lambda: PDE("u_t = c*u_xx", {"u": 1}, c=complex(1, np.nan)), "c must be a finite number"),
        (lambda: PDE("u_t = u_xx/c", {"u": 1}, c=0), "a division by zero"),
        (lambda: PDE("u_t = 1/c*u_xx", {"u": 1}, c=0), "must leave the constants in the text finite"),
        (lambda: PDE("c*u_t = u_xx", {"u": 1}, c=0), "a division by zero"),
        (lambda: PDE(HEAT, {"u": "1/x"}), "must be finite everywhere, got '1/x', which is not at x = 0"),
        (lambda: PDE(HEAT, {"u": "t"}), "t has no place in the data"),
        (lambda: PDE(HEAT, {"u": "u"}), "u is a field"),
        (lambda: PDE(HEAT, {"u": "sin(x"}), "expected '\\)'"),
        (lambda: PDE(HEAT, {"u": "x = 3"}), "expected an operator"),
        (lambda: PDE(HEAT, {"u": None}), "initial u must be a text, a number"),
        (lambda: PDE(HEAT, {"u": [1, 2]}), "samples on at least 4 points"),
        (lambda: PDE(HEAT, {"u": [1, 2, np.nan, 3]}), "initial u must be finite"),
        (lambda: PDE(HEAT, {"u": [[1, 2], [3]]}), "initial u must be a text"),
        (lambda: PDE(HEAT, {"u": lambda x: x[:2]}), "a number for each x"),
        (lambda: PDE(HEAT, {"u": lambda: 3}), "it raised 'TypeError"),
        (lambda: PDE(HEAT, {"u": 1}, period=0), "period must be a finite number > 0"),
        (lambda: PDE("u_t + v_x = 0; 0 = v - u_x", {"u": 1, "v": 0}), "not marched"),
        (lambda: PDE("u_xt = u", {"u": 1}), "not marched"),
        (lambda: PDE(3, {"u": 1}), "must be a string"),
    ],
)  # fmt: skip
def test_bad_input_is_refused_when_it_is_made(make, what):
    with pytest.raises((ValueError, TypeError), match=what):
        make()


def test_central_differences_of_every_order():
    """The Taylor conditions, exactly; and those of the paper's scheme are what they were."""
    assert (CENTRAL[1].offsets, CENTRAL[1].weights, CENTRAL[2].offsets) == ((1, -1), (1, -1), (1, 0, -1))
    for table, order in ((CENTRAL, 2), (CENTRAL_4, 4), (CENTRAL_6, 6)):
        for m, stencil in table.items():
            moments = [
                sum(w * o**k for o, w in zip(stencil.offsets, stencil.weights, strict=True))
                for k in range(m + order + 1)
            ]
            factorial = int(np.prod(np.arange(1, m + 1)))
            expected = [stencil.denominator * factorial if k == m else 0 for k in range(m + order)]
            assert moments[:-1] == expected
            assert moments[-1] != 0  # and no more than that
    assert central(2, 4) == ((0, 1, -1, 2, -2), (-30, 16, 16, -1, -1), 12)


@pytest.mark.parametrize("n", [8, 9, 130])
@pytest.mark.parametrize("period", [2 * np.pi, 5.0])
def test_fourier_derivatives_of_every_order(n, period):
    grid, w = Grid(n, period), 2 * np.pi / period
    for m, derivative in FOURIER.items():
        for k in (1, 3):
            f = np.exp(1j * k * w * (grid.x + 0.3))
            found = derivative(f, grid.h)
            assert np.abs(found - (1j * k * w) ** m * f).max() < 1e-14 * (n / 2 * w) ** m
            assert np.abs(derivative(f.real, grid.h) - found.real).max() < 1e-14 * (n / 2 * w) ** m


class Wave:
    """u_tt = u_xx with a forcing in time, on a period of 4, as an object of one's own."""

    fields = ("u", "u_t")
    period = 4.0
    autonomous = False

    def initial(self, x):
        return np.cos(np.pi / 2 * x), 0 * x

    steady = initial

    def forcing(self, x):
        return np.cos(np.pi / 2 * x)

    def rhs(self, x, state, derivative, forcing, t):
        return state[1], derivative(state[0], 2) + np.sin(t) * forcing


def test_an_object_of_ones_own_with_a_period_and_a_clock_is_the_same_as_the_text():
    text = PDE("u_tt = u_xx + sin(t)*cos(pi/2*x)", {"u": "cos(pi/2*x)", "u_t": 0}, period=4.0)
    for march in (lambda p: ftcs(p, 32, 1e-3, 0.5), lambda p: march_lines(p, 32, 1e-2, 0.5, FOURIER, RK8)):
        for ours, theirs in zip(march(text).final, march(Wave()).final, strict=True):
            np.testing.assert_allclose(ours, theirs, atol=1e-13)


@pytest.mark.parametrize("kind", [{}, {"dtype": np.float32}, {"dtype": np.longdouble}, {"digits": 20}], ids=str)
def test_complex_fields_in_every_arithmetic(kind):
    """Schroedinger's equation: forward Euler's factor of one mode, to the last digit."""
    run = ftcs(PDE("i*u_t + u_xx = 0", {"u": "exp(i*x)"}), n=12, dt=1e-3, t_end=0.005, **kind)
    factor = (1 - 1j * 1e-3 * 4 / (np.pi / 6) ** 2 * np.sin(np.pi / 12) ** 2) ** 5
    np.testing.assert_allclose(run.final[0].astype(complex), factor * np.exp(1j * run.x), atol=1e-6)
    assert run.dist.dtype == (np.dtype(object) if "digits" in kind else kind.get("dtype", np.float64))
    assert abs(float(run.dist[-1]) - abs(factor - 1)) < 1e-6
    assert abs(float(run.u_min[0]) + 1) < 1e-6


def test_an_ensemble_is_each_alone():
    problems = [PDE("u_t = nu*u_xx - (u^2/2)_x", {"u": "sin(x)"}, nu=nu) for nu in (0.1, 0.5)]
    for together, alone in zip(
        ftcs_ensemble(problems, 24, 1e-3, 0.1), [ftcs(p, 24, 1e-3, 0.1) for p in problems], strict=True
    ):
        assert (together.final[0] == alone.final[0]).all()


def test_a_table_without_a_derivative_is_refused():
    with pytest.raises(TypeError, match="got one without order 4"):
        march_lines(PDE("u_t = -u_xxxx", {"u": "sin(x)"}), 8, 1e-3, 0.1, {m: CENTRAL[m] for m in (1, 2)}, RK4)


DIFFUSES = "c_tau = (f(c))_rr - (c^2/2)_r"


def test_the_variables_may_have_other_names_and_functions_come_by_keyword():
    plain = PDE("u_t = (nu*u + u^3)_xx - (u^2/2)_x", {"u": "a - cos(x)"}, steady={"u": "a"}, nu=0.1, a=0.3)
    own = {"space": "r", "time": "tau", "nu": 0.1, "a": 0.3}
    texts = PDE(DIFFUSES, {"c": "a - cos(r)"}, steady={"c": "a"}, f="nu*c + c^3", **own)
    of_python = {"space": "r", "time": "tau", "a": 0.3, "f": lambda c: 0.1 * c + c**3}
    function = PDE(DIFFUSES, {"c": "a - cos(r)"}, steady={"c": "a"}, **of_python)
    runs = [ftcs(problem, 24, t_end=0.1) for problem in (plain, texts, function)]
    assert runs[0].final[0] == pytest.approx(runs[1].final[0], rel=1e-12, abs=1e-13)
    assert runs[0].final[0] == pytest.approx(runs[2].final[0], rel=1e-12, abs=1e-13)
    assert eval(repr(texts)) == texts
    slower = texts.replace(f="nu*c/2 + c^3/2", a=0.1)
    assert (slower.parameters["a"], slower.space, slower.functions) == (0.1, "r", (("f", "nu*c/2 + c^3/2"),))


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: PDE(DIFFUSES, {"c": "sin(x)"}, space="r", time="tau", f="c"), "x has no value"),
        (lambda: PDE(DIFFUSES, {"c": "sin(r)"}, space="r", time="tau"), "f"),
        (lambda: PDE(HEAT, {"u": "sin(x)"}, f="u"), "'f' is given but does not occur"),
        (lambda: PDE(HEAT, {"u": "sin(x)"}, space="r"), "x"),
        (lambda: PDE("u_t = u_xx + space*u", {"u": "sin(x)"}), "space is what an argument is called"),
    ],
)
def test_what_variables_and_functions_refuse(call, words):
    with pytest.raises(PDEError, match=words):
        call()
