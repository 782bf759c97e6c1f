"""Guards the numbers put in for names: what is taken and how exactly, what is refused and in which words.

Second route: sympy's own substitution and evaluation.
"""

import re
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

from primer import linearise, verdict
from primer.equations.linear import read
from primer.equations.text import PDEError
from primer.equations.values import checked, evaluated, substituted

SYSTEM = read("u_t = a*u_xy + v; v_t = b*u + x*y*v*t")
a, b, u, v = sp.symbols("a b u v")


def says(sentence):
    """A pattern for the whole of a message."""
    return "^" + re.escape(sentence) + "$"


def checked_number(value):
    return checked(SYSTEM, {"u": value}, {})["u"]


@pytest.mark.parametrize(
    ("value", "exact"),
    [
        (0.1, sp.Rational(1, 10)),
        (-2.5e-30, -sp.Rational(5, 2 * 10**30)),
        (np.float64(0.3), sp.Rational(3, 10)),
        (np.float32(0.5), sp.Rational(1, 2)),
        (3, sp.Integer(3)),
        (10**400, sp.Integer(10) ** 400),
        (np.int64(-7), sp.Integer(-7)),
        (Fraction(-2, 7), sp.Rational(-2, 7)),
        (0.1 - 0.2j, sp.Rational(1, 10) - sp.I / 5),
        (np.complex128(2j), 2 * sp.I),
        (sp.sqrt(2), sp.sqrt(2)),
        (sp.Rational(1, 3), sp.Rational(1, 3)),
        (sp.pi * sp.I, sp.pi * sp.I),
    ],
)
def test_a_value_is_taken_exactly_and_a_float_as_its_shortest_decimal(value, exact):
    assert checked_number(value) == exact


@pytest.mark.parametrize(
    ("value", "error", "sentence"),
    [
        ("1", TypeError, "u must be a number, got '1' (str)"),
        (None, TypeError, "u must be a number, got None (NoneType)"),
        (True, TypeError, "u must be a number, got True (bool)"),
        (np.bool_(False), TypeError, f"u must be a number, got False ({np.bool_.__name__})"),
        ([1.0], TypeError, "u must be a number, got [1.0] (list)"),
        (float("nan"), ValueError, "u must be a finite number, got nan"),
        (-np.inf, ValueError, "u must be a finite number, got -inf"),
        (complex(0, np.inf), ValueError, "u must be a finite number, got infj"),
        (sp.oo, ValueError, "u must be a finite number, got oo"),
        (sp.nan, ValueError, "u must be a finite number, got nan"),
        (sp.Symbol("z"), ValueError, "u must be a finite number, got z"),
        (sp.Symbol("z", real=True), ValueError, "u must be a finite number, got z"),  # finite, yet no number
    ],
)
def test_what_is_no_number_is_refused(value, error, sentence):
    with pytest.raises(error, match=says(sentence)):
        checked_number(value)


def test_names_and_their_values():
    assert checked(SYSTEM, None, {}) == {}
    found = checked(SYSTEM, {"u": 1, "u_yxx": 2, "v_t": 3, "x": 4, "t": 5, "a": 6}, {"b": 7, "y": 8})
    assert found == {"u": 1, "u_xxy": 2, "v_t": 3, "x": 4, "t": 5, "a": 6, "b": 7, "y": 8}


@pytest.mark.parametrize(
    ("at", "parameters", "error", "sentence"),
    [
        ([1], {}, TypeError, "at must be a dict of base-state values such as {'u': -0.5}, got [1]"),
        ({}, {"u": 1}, PDEError, "u is an unknown or its derivative: give its base value as at={'u': ...}"),
        ({}, {"v_xx": 1}, PDEError, "v_xx is an unknown or its derivative: give its base value as at={'v_xx': ...}"),
        ({"w": 1}, {}, PDEError, "'w' has a value but does not occur in the equations, which name u, v, a, b"),
        ({"a_x": 1}, {}, PDEError, "'a_x' has a value but does not occur in the equations, which name u, v, a, b"),
        ({}, {"nu": 1}, PDEError, "'nu' has a value but does not occur in the equations, which name u, v, a, b"),
        ({3: 1}, {}, PDEError, "3 has a value but does not occur in the equations, which name u, v, a, b"),
        ({"a": 1}, {"a": 1}, PDEError, "a has two values"),
        ({"u_xy": 1, "u_yx": 1}, {}, PDEError, "u_xy has two values"),
    ],
)
def test_names_that_cannot_have_a_value(at, parameters, error, sentence):
    with pytest.raises(error, match=says(sentence)):
        checked(SYSTEM, at, parameters)


EXPRESSIONS = [
    a**2 * u - 3 * v / (2 + b),
    sp.sin(a * u) + sp.exp(v) * sp.I - sp.pi,
    sp.sqrt(a + b) ** 3 / (u - v) ** 2,
    sp.tanh(u) ** sp.Rational(-2, 3) + sp.log(b),
    a**u + sp.cosh(v - sp.Rational(1, 7)),
    sp.Rational(22, 7) * a + sp.E,
    a,
    sp.Integer(3),
    sp.sqrt(u**2),
]


@pytest.mark.parametrize("expression", EXPRESSIONS, ids=str)
def test_expressions_have_the_values_that_sympy_gives_them(expression):
    values = {"a": sp.Rational(3, 7), "b": sp.Integer(2), "u": sp.Rational(-5, 4) + sp.I / 3, "v": sp.pi / 5}
    exact = expression.subs({name: number for name, number in zip("abuv", values.values(), strict=True)})
    assert sp.simplify(substituted(expression, values) - exact) == 0
    with mp.workdps(60):
        found = evaluated(expression, values)
        assert isinstance(found, mp.mpc)
        assert abs(found - mp.mpmathify(sp.N(exact, 70))) <= mp.mpf(10) ** -58 * (1 + abs(found))
    some = substituted(expression, {"a": values["a"]})  # the others stay
    assert sp.simplify(some - expression.subs(a, values["a"])) == 0


def test_sums_of_rational_numbers_and_their_powers_cancel_exactly():
    with mp.workdps(50):
        assert evaluated(a**2 - 4, {"a": sp.Integer(2)}) == 0
        assert evaluated(a**-3 * 27 - 8, {"a": sp.Rational(3, 2)}) == 0
        assert evaluated(2 * a - b, {"a": sp.Rational(1, 2), "b": sp.Integer(1)}) == 0


@pytest.mark.parametrize(
    ("base", "bits"),
    [(sp.Integer(2), 2), (sp.Integer(-3), 2), (sp.Rational(3, 7), 5), (sp.pi, 1), (2 + sp.sqrt(5), 3)],
)
def test_a_power_may_have_a_hundred_thousand_bits_and_no_more(base, bits):
    """So many as the longest rational number p/q in it, |p| q, times the exponent."""
    n = sp.Integer(100_000 // bits)
    for sign in (1, -1):
        assert substituted(u**v, {"u": base, "v": sign * n}) == base ** (sign * n)
        with pytest.raises(PDEError, match=says("the base state makes u**v a power that is too large to write out")):
            substituted(u**v, {"u": base, "v": sign * (n + 1)})
    assert substituted(u**v, {"u": base, "v": sp.sqrt(10**12 + 1)}).is_Pow  # an irrational exponent writes nothing out


DIVIDES = " divide by zero: it cannot be linearised there"
NO_NUMBER = ": not a number to work with"


@pytest.mark.parametrize(
    ("expression", "values", "sentence"),
    [
        (1 / u, {"u": 0}, "the base state makes 1/u" + DIVIDES),
        (u**v, {"u": 0, "v": sp.Rational(-1, 2)}, "the base state makes u**v" + DIVIDES),
        (sp.log(u), {"u": 0}, "the base state makes log(u) (-inf + 0.0j)" + NO_NUMBER),
        (v * sp.log(u), {"u": 0, "v": 0}, "the base state makes v*log(u) (nan + nanj)" + NO_NUMBER),
        (u**3, {"u": sp.Integer(12345 * 10**30)}, "the base state makes u**3 (1.88e+102 + 0.0j)" + NO_NUMBER),
        (sp.sin(u), {"u": 10**6 + 1}, "sin of a number above 1e+06 in the linearised equations"),
        (1 + sp.exp(-u), {"u": 10**6 + 1}, "exp of a number above 1e+06 in the linearised equations"),
    ],
)
def test_what_is_no_number_to_work_with(expression, values, sentence):
    with pytest.raises(PDEError, match=says(sentence)):
        evaluated(expression, {name: sp.sympify(value) for name, value in values.items()})


def test_what_is_just_a_number_to_work_with():
    with mp.workdps(150):
        assert evaluated(u, {"u": sp.Integer(int(1e100))}) == mp.mpf(1e100)
        assert evaluated(sp.cos(u), {"u": sp.Integer(-(10**6))}) == mp.cos(10**6)


def test_a_long_expression_is_shown_in_part():
    for length, shown in ((58, "u" * 58), (59, "u" * 55 + "...")):  # 60 characters in all, or 57 and three dots
        with pytest.raises(PDEError, match=says(f"the base state makes 1/{shown}{DIVIDES}")):
            evaluated(1 / sp.Symbol("u" * length), {"u" * length: sp.Integer(0)})


@pytest.mark.parametrize("text", ["u_t = u_x/u", "u_t = (u_x/(a*a - x/u))_x", "u_t = c*u_x/(u - u^2) + k*u_xx"])
def test_a_division_by_zero_is_said_with_or_without_the_other_values(text):
    for ask in (linearise, verdict):
        with pytest.raises(PDEError, match="divide by zero: it cannot be linearised there"):
            ask(text, at={"u": 0, "u_x": 1, "u_xx": 1, "x": 1}, **{k: 0 for k in "ac" if f"{k}*" in text})
