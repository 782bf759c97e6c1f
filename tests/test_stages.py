"""Guards the right-hand side made from a text: order of operations, arithmetics, brackets, what can be marched, slopes.

Second routes: the same equations written in NumPy by hand, complex steps and difference quotients, sympy's own system.
"""

import mpmath
import numpy as np
import pytest
import sympy as sp

from primer import BackwardHeat, Toy, growth_rates
from primer.arithmetic import arithmetic
from primer.equations.evaluate import known, power, tendencies
from primer.equations.latex import latex
from primer.equations.linear import read
from primer.equations.slopes import linearised
from primer.equations.stages import evolution
from primer.equations.text import PDEError
from primer.schemes.grid import CENTRAL

N = 12
H = 2 * np.pi / N
X = -np.pi + H * np.arange(N)
ONE_BY_ONE = {
    "toy": ("u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)", {"eps": 0.01}),
    "shallow water": ("h_t + (h*u)_x = 0; (h*u)_t + (h*u^2 + g*h^2/2)_x = 0", {"g": 9.81}),
    "Boussinesq": ("u_tt = u_xx - u_xx*u + (u^2)_xx", {}),
    "nested": ("u_t = (u_x^3/(1 + u_x^2))_x + (sqrt(u)*(u^2*cos(x))_x)_x", {}),
    "calls": ("u_t = tan(u/9) + exp(-u)*cosh(u) - sinh(u)/cos(u/5) + log(u)^-2 + u^1.5 + 2^u + u^u", {}),
    "coupled": ("u_t + a*v_t = u_x*v; u_t - v_t = v_x", {"a": 3.0}),
    "x and t": ("u_t = cos(x - c*t)*u_x + x^2*sin(t)*u", {"c": 0.5}),
}


def derivative(f, m):
    return CENTRAL[m](f, H)


def right_hand_side(text, parameters, state, x=X, t=0.7):
    form = evolution(text, tuple(parameters))
    return np.array(tendencies(form, parameters, state, derivative, known(form, x, parameters), t))


def state_of(text, parameters, seed=1):
    fields = len(evolution(text, tuple(parameters)).fields)
    return np.random.default_rng(seed).uniform(1, 2, (fields, N))


def by_hand(name, state, t=0.7):
    """The same in NumPy, written from the equations on paper."""

    def d(f, m=1):
        return derivative(f, m)

    if name == "toy":
        u, v = state
        return d(v), 0.01 * u * d(v, 2) + d(u) - v - np.sin(X)
    if name == "shallow water":
        h, u = state
        h_t = -d(h * u)
        return h_t, (-d(h * (u * u) + 9.81 * (h * h) / 2) - u * h_t) / h
    if name == "Boussinesq":
        u, u_t = state
        return u_t, d(u, 2) - d(u, 2) * u + d(u * u, 2)
    if name == "coupled":
        u, v = state
        v_t = (d(u) * v - d(v)) / 4
        return d(v) + v_t, v_t
    (u,) = state
    if name == "nested":
        u_x = d(u)
        return (d(u_x**3 / (1 + u_x**2)) + d(np.sqrt(u) * d(u * u * np.cos(X))),)
    if name == "calls":
        first = np.tan(u / 9) + np.exp(-u) * np.cosh(u) - np.sinh(u) / np.cos(u / 5)
        return (first + 1 / np.log(u) ** 2 + u**1.5 + 2**u + u**u,)
    return (np.cos(X - 0.5 * t) * d(u) + X**2 * np.sin(t) * u,)


@pytest.mark.parametrize("name", ONE_BY_ONE)
def test_right_hand_side_is_that_written_by_hand(name):
    text, parameters = ONE_BY_ONE[name]
    state = state_of(text, parameters)
    np.testing.assert_allclose(right_hand_side(text, parameters, state), by_hand(name, state), rtol=2e-13, atol=1e-12)


@pytest.mark.parametrize("name", ["toy", "Boussinesq"])
def test_products_and_sums_are_bit_for_bit_those_written_by_hand(name):
    text, parameters = ONE_BY_ONE[name]
    state = state_of(text, parameters)
    assert (right_hand_side(text, parameters, state) == np.array(by_hand(name, state))).all()


@pytest.mark.parametrize("numbers", [np.float32, np.longdouble, 30])
@pytest.mark.parametrize("name", ONE_BY_ONE)
def test_every_arithmetic_agrees_to_its_last_digits(name, numbers):
    """With 40 digits for a judge; and a result has the numbers that went in."""
    text, parameters = ONE_BY_ONE[name]
    system = arithmetic(digits=numbers) if isinstance(numbers, int) else arithmetic(numbers)
    judge = arithmetic(digits=40)
    answers = []
    for kind in (system, judge):
        h, x = kind.grid(N)
        form = evolution(text, tuple(parameters))
        state = [kind.array(f) for f in state_of(text, parameters).astype(np.float32).astype(float)]
        given = known(form, x, parameters)
        answers.append(
            tendencies(form, parameters, state, lambda f, m, h=h: CENTRAL[m](f, h), given, kind.number(0.75))
        )
    tolerance = 1e-27 if numbers == 30 else max(1000 * float(np.finfo(numbers).eps), 1e-14)
    for found, true in zip(*answers, strict=True):
        assert found.dtype == system.dtype
        written = [mpmath.nstr(z, 35) if numbers == 30 else str(z) for z in found]
        error = max(abs(judge.number(z) - t) for z, t in zip(written, true, strict=True))
        assert error < tolerance * (1 + max(abs(t) for t in true))


def test_numbers_of_a_text_are_decimals_and_whole_powers_are_products():
    _, x = arithmetic(digits=40).grid(4)
    form = evolution("u_t = 0.1*u^5")
    (u_t,) = tendencies(form, {}, [x * 0 + 1], lambda f, m: f, known(form, x, {}))
    assert u_t[0] == x[0].context.mpf("0.1")
    u = np.float32(1.1)
    assert power(u, 7) == ((u * u) * u) * ((u * u) * u) * u
    assert right_hand_side("u_t = u^4", {}, [X])[0].tolist() == ((X * X) * (X * X)).tolist()
    assert right_hand_side("u_t = u^-2", {}, [X + 9])[0].tolist() == (1 / ((X + 9) * (X + 9))).tolist()
    assert (right_hand_side("u_t = u^0 + u^1 + u^(1/2)", {}, [X + 9])[0] == (1 + (X + 9)) + np.sqrt(X + 9)).all()


def test_what_has_no_value_is_not_a_number_also_with_many_digits():
    _, x = arithmetic(digits=20).grid(4)
    form = evolution("u_t = log(-u) + sqrt(-u) + 1/(u - u) + (-u)^0.3")
    (u_t,) = tendencies(form, {}, [x * 0 + 1], lambda f, m: f, known(form, x, {}))
    assert all(z != z for z in u_t)
    with np.errstate(all="ignore"):
        assert np.isnan(right_hand_side("u_t = log(-u) + sqrt(-u)", {}, [X * 0 + 1])).all()


def test_complex_coefficients_and_fields():
    """Schroedinger's equation, with i on the left, and the cubic one with |u|^2."""
    u = np.exp(1j * X) * 2
    (u_t,) = right_hand_side("i*u_t + u_xx + abs(u)^2*u = 0", {}, [u])
    np.testing.assert_allclose(u_t, 1j * (derivative(u, 2) + 4 * u), rtol=1e-14)
    assert evolution("i*u_t + u_xx = 0").imaginary
    assert not evolution("u_t = u_xx").imaginary


def test_a_differentiated_bracket_is_differenced_as_it_is_written():
    """So that the sum over the grid of (u^3/3)_x is zero to rounding, which that of u^2*u_x is not; (u)_x is u_x."""
    u = np.random.default_rng(3).uniform(1, 2, N)
    conserved, expanded = (abs(right_hand_side(f"u_t = {flux}", {}, [u]).sum()) for flux in ("(u^3/3)_x", "u^2*u_x"))
    assert conserved < 1e-12 < 1e-2 < expanded
    assert evolution("u_t = (u)_xx").stages == evolution("u_t = u_xx").stages
    assert [len(stage.values) for stage in evolution("u_t = ((u^2)_x*u + (u^2)_x)_x + (u^2)_xx").stages] == [1, 1, 1]


def test_what_depends_on_no_field_is_computed_once():
    form = evolution("u_t = 2*pi*a*u_x + sin(x/a)*exp(-x^2) + cos(2*t)*u + (x^2*u)_x")
    assert [len(part) for part in (form.constants, form.fixed, form.clocks)] == [1, 2, 1]
    assert form.autonomous is False
    assert form.orders == (1,)


@pytest.mark.parametrize(
    "text",
    [
        "u_t = v_x; 0 = u + v_x",
        "u_xt = u",
        "u_t - u_xxt = u_xx",
        "(u_x)_t = u",
        "u_t = u_yy",
        "u_t = (u*y)_x",
        "u_t^2 = u_x",
        "sin(u_t) = u_x",
        "u_t*v_t = u; v_t = u_x",
        "u_t = 0*v_t; u_t = v_x",
    ],
)
def test_what_can_be_judged_only_is_refused_in_a_sentence(text):
    with pytest.raises(PDEError, match=r"judged \(primer.verdict\), not marched$|not marched\n"):
        evolution(text)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("i_t = i_x", "meaning of its own"),
        ("u_t = c_x*u", "unknown"),
        ("u_t = u^1001", "power above"),
        ("u_t = u/0", "division by zero"),
        ("u_t = u_xxxxxxxxxxxxx", "derivative of order 13"),
        ("u_t = (u^2)_xxxxxxxxxxxxx", "derivative of order 13"),
        ("u_t = 1e999*u", "number with more digits"),
        ("u_t = u_x; u_t = u_xx", "unknown"),
    ],
)
def test_bad_texts_are_refused_in_a_sentence(text, what):
    with pytest.raises(PDEError, match=what):
        evolution(text)


@pytest.mark.parametrize("name", [*ONE_BY_ONE, "abs"])
def test_linearisation_is_the_complex_step(name):
    """As an operator and as a matrix, through brackets; abs, which has no complex step, by a difference quotient."""
    text, parameters = ONE_BY_ONE.get(name, ("u_t = abs(u)*u_xx + abs(u_x)", {}))
    state = state_of(text, parameters)
    change = np.random.default_rng(2).normal(size=state.shape)
    if name == "abs":
        ahead, back = (right_hand_side(text, parameters, state + sign * 1e-6 * change) for sign in (1, -1))
        expected, tolerance = (ahead - back) / 2e-6, 1e-8
    else:
        expected = right_hand_side(text, parameters, state + 1e-30j * change).imag / 1e-30
        tolerance = 1e-12
    form = evolution(text, tuple(parameters))
    found = linearised(form, parameters, state, derivative, known(form, X, parameters), 0.7)
    scale = np.abs(expected).max()
    assert np.abs(found.apply(change, derivative) - expected).max() < tolerance * scale
    assert np.abs(found.matrix(N, derivative) @ change.ravel() - expected.ravel()).max() < tolerance * scale


def test_linearisation_with_many_digits_and_its_refusal():
    h, x = arithmetic(digits=30).grid(8)
    form = evolution("u_t = sin(u)*u_x + tanh(u)/u + abs(u)^3")
    state = [x + 5]
    found = linearised(form, {}, state, lambda f, m: CENTRAL[m](f, h), known(form, x, {}))
    (slopes,) = found.slopes[0]
    z = state[0][3]
    context = z.context
    by_hand = context.cos(z) * CENTRAL[1](state[0], h)[3] + context.sech(z) ** 2 / z - context.tanh(z) / z**2 + 3 * z**2
    assert abs(slopes[0, 0][3] - by_hand) < 1e-27
    with pytest.raises(ValueError, match="abs of a complex field"):
        linearised(
            evolution("u_t = i*abs(u)*u"), {}, [np.exp(1j * X)], derivative, known(evolution("u_t = i*u"), X, {})
        )


@pytest.mark.parametrize("name", ["toy", "shallow water", "nested"])
def test_symbol_about_a_smooth_state_is_that_of_the_expanded_equations(name):
    """With exact derivatives of a state of few waves, the frozen matrix at each point is that which sympy derives."""
    text, parameters = ONE_BY_ONE[name]
    form = evolution(text, tuple(parameters))
    n = 64
    x = -np.pi + 2 * np.pi / n * np.arange(n)

    def exact(f, m):
        return np.fft.ifft((1j * np.fft.fftfreq(n, 1 / n)) ** m * np.fft.fft(f)).real

    state = [2 + (0.1 + 0.1 * k) * np.cos(x + k) for k in range(len(form.fields))]
    found = linearised(form, parameters, state, exact, known(form, x, parameters))
    xi, at = 7.0, 11
    S = found.symbol(lambda m: (1j * xi) ** m, exact)[at]
    base = {"x": x[at]}
    rates = tendencies(form, parameters, state, exact, known(form, x, parameters))
    for field, values, rate in zip(form.fields, state, rates, strict=True):
        base |= {f"{field}_{'x' * m}" if m else field: exact(values, m)[at] for m in range(5)} | {
            f"{field}_t": rate[at]
        }
    names = {
        str(name)
        for row in read(text, tuple(parameters)).slopes
        for c in row.values()
        for name in sp.sympify(c).free_symbols
    }
    expected = growth_rates(text, xi, at={name: base[name] for name in names if name in base}, **parameters)
    np.testing.assert_allclose(np.sort_complex(np.linalg.eigvals(S)), np.sort_complex(np.ravel(expected)), rtol=1e-8)


def test_toy_and_heat_are_texts():
    assert evolution(Toy.text, ("eps",)) is Toy(0.5).evolution
    assert (Toy(0.5).symbol(2.0, -0.5, 0.3) == [[0, 2j], [2j + 0.003, -0.01 * -0.5 * 4 - 1]]).all()
    assert BackwardHeat().symbol(3.0) == 9


def test_latex():
    assert latex("u_t = -u*v_xx/(1 + u_x^2) + (u^2/2)_x - 2*3.5e-3*eps*sqrt(a_0)") == (
        r"u_{t} = \frac{-u v_{xx}}{1 + \left(u_{x}\right)^{2}} + \left(\frac{u^{2}}{2}\right)_{x} - "
        r"2 \cdot 3.5 \cdot 10^{-3} \varepsilon \sqrt{a_{0}}",
    )
