"""Exercises of notebook 08, living with ill-posedness."""

import math

from primer.exercises.answers import Feedback, check, choose, variant
from primer.exercises.forms import term


def _first(seed):
    return variant("08_1", seed, nu=(3, 4, 1.5, 5), delta=(0.05, 0.02, 0.1, 0.04))


def ask_08_1(seed: int = 0) -> str:
    """The question: the fastest wave of a regularised equation."""
    given = _first(seed)
    return (
        f"u_t = -nu u_xx - delta u_xxxx with nu = {given['nu']} and delta = {given['delta']}: at which rate does the "
        "fastest wave grow?"
    )


def check_08_1(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is nu^2/(4 delta), the largest nu xi^2 - delta xi^4, to 5 in 1000; a ``Feedback``."""
    given = _first(seed)
    nu, delta = given["nu"], given["delta"]
    return check(
        answer,
        nu**2 / (4 * delta),
        "so a small delta makes it well posed, and leaves growth that is as fast as you please.",
        {
            "that is the wavenumber of the fastest wave. How fast does it grow?": math.sqrt(nu / (2 * delta)),
            "that is the square of the wavenumber of the fastest wave.": nu / (2 * delta),
            "that is for nu = 1.": 1 / (4 * delta),
            "that leaves out what the fourth derivative takes away from that wave.": nu**2 / (2 * delta),
            "that is where growth ends, not where it is fastest.": math.sqrt(nu / delta),
        },
        "growth is nu xi^2 - delta xi^4. Where is its derivative zero, and how large is it there?",
        rtol=5e-3,
    )


def _second(seed):
    return variant("08_2", seed, t=(0.05, 0.02, 0.1), noise=(1e-4, 1e-6, 1e-3, 1e-2))


def ask_08_2(seed: int = 0) -> str:
    """The question: how many waves noise leaves."""
    given = _second(seed)
    return (
        f"A profile has diffused for t = {given['t']}, and each of its waves is measured with an error of "
        f"{given['noise']:g}. It is marched back by u_t = -u_xx. From which wavenumber on is that error larger than 1? "
        "(A real number.)"
    )


def check_08_2(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is sqrt(ln(1/noise)/t), where noise e^(k^2 t) = 1, to one per cent; a ``Feedback``."""
    given = _second(seed)
    t, noise = given["t"], given["noise"]
    return check(
        answer,
        math.sqrt(math.log(1 / noise) / t),
        "and a thousand times better instrument moves it by a few waves: the logarithm under a square root.",
        {
            "that is the square of it: a wave grows like exp(k^2 t), not exp(k t).": math.log(1 / noise) / t,
            "growth is exp(k^2 t), not 10^(k^2 t).": math.sqrt(math.log10(1 / noise) / t),
        },
        "marched back, wave k of the noise is exp(k^2 t) times what it was. When is that the inverse of the noise?",
    )


_SHIFT = "a term without derivatives does the same to every wave, and the short ones outgrow it."
_TURNS = "an odd derivative is imaginary for a wave: it makes it travel, and does not damp it."
_SIGN = "the right derivative with the wrong sign: the m-th is (i xi)^m for a wave. Now short waves grow faster still."
_SMALL = "it is of the same order as what grows, and delta is small: a little less of too much."
_TERMS = {
    "u_t = -u_xx": ("-delta*u_xxxx", {"+delta*u_xxxx": _SIGN, "+delta*u_xxx": _TURNS, "-delta*u": _SHIFT}),
    "u_t = u_xxxx": ("+delta*u_xxxxxx", {"-delta*u_xxxxxx": _SIGN, "-delta*u_xxxx": _SMALL, "-delta*u": _SHIFT}),
    "u_t = u_xxx - u_xx": ("-delta*u_xxxx", {"+delta*u_xxxx": _SIGN, "-delta*u_xxxxx": _TURNS, "-delta*u": _SHIFT}),
    "u_tt = u_xx + u_xxxx": (
        "+delta*u_xxxxxx",
        {"-delta*u_xxxxxx": _SIGN, "-delta*u_xxxx": _SMALL, "-delta*u": _SHIFT},
    ),
    "u_tt = -u_xx": ("-delta*u_xxxx", {"+delta*u_xxxx": _SIGN, "+delta*u_xx": _SMALL, "-delta*u": _SHIFT}),
}


def _third(seed):
    return variant("08_3", seed, equation=tuple(_TERMS))["equation"]


def ask_08_3(seed: int = 0) -> str:
    """The question: which term makes it well posed."""
    equation = _third(seed)
    right, wrong = _TERMS[equation]
    options = ", ".join(f"'{term}'" for term in sorted([right, *wrong]))
    return f"{equation} is ill posed. Which term, added on the right with a small delta > 0, cures that: {options}?"


def check_08_3(answer: str, seed: int = 0) -> Feedback:
    """Whether ``answer`` is the term that bounds the growth as xi -> infinity; a ``Feedback``."""
    right, wrong = _TERMS[_third(seed)]
    praise = "growth is bounded now, and the bound goes to infinity as delta goes to zero."
    return choose(answer, right, praise, wrong, form=term)
