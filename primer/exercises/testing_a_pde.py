"""Exercises of notebook 02, testing a PDE."""

import math

from primer.exercises.answers import Feedback, check, choose, variant

STABLE, UNSTABLE, ILL = "well posed, and nothing grows", "well posed, but unstable", "ill posed"


def _first(seed):
    return variant("02_1", seed, c=(1.5, 0.6, 2.4, 0.9, 6))


def ask_02_1(seed: int = 0) -> str:
    """The question: for which base states a nonlinear diffusion is ill posed."""
    c = _first(seed)["c"]
    return f"u_t = (u^3 - {c} u)_xx is ill posed about u* if |u*| < m, and well posed if |u*| > m. What is m?"


def check_02_1(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is sqrt(c/3), to one per cent; a ``Feedback``.

    The steps of section A2.1 give Re lambda ~ (c - 3 u*^2) xi^2.
    """
    c = _first(seed)["c"]
    return check(
        answer,
        math.sqrt(c / 3),
        "and of these base states only the value of u matters, not its slope or curvature.",
        {
            "that is where the bracket vanishes. It is its derivative in u that multiplies u_xx.": math.sqrt(c),
            "that is the square of it.": c / 3,
            "the derivative of u^3 is 3 u^2: who divides by whom?": math.sqrt(3 / c),
            "m is a size: take the other root.": -math.sqrt(c / 3),
        },
        "linearise: (3 u*^2 - c) multiplies the second derivative of the perturbation. Which sign is diffusion?",
    )


def _second(seed):
    return variant("02_2", seed, c=(3, 1, 1.5, 5), k=(0.2, 0.1, 0.25))


def ask_02_2(seed: int = 0) -> str:
    """The question: the ceiling of a growth rate."""
    given = _second(seed)
    return f"u_t = (u^3 - {given['c']} u)_xx - {given['k']} u_xxxx, about u* = 0: what is the largest growth rate?"


def check_02_2(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is c^2/(4k), the largest of c xi^2 - k xi^4, to one per cent; a ``Feedback``.

    Bounded growth is linear well-posedness, section A2.1.
    """
    given = _second(seed)
    c, k = given["c"], given["k"]
    return check(
        answer,
        c**2 / (4 * k),
        "a ceiling: unstable, and well posed. Without the fourth derivative there is none.",
        {
            "that is the wavenumber of the fastest wave. How fast does it grow?": math.sqrt(c / (2 * k)),
            "that is xi squared for the fastest wave. Put it into the growth rate.": c / (2 * k),
            "you have left out -k xi^4 when you put the wavenumber in.": c**2 / (2 * k),
            "that wavenumber is where growth ends. Between 0 and it lies the largest.": math.sqrt(c / k),
        },
        "lambda = c xi^2 - k xi^4 is a parabola in xi^2. Where is its top?",
    )


def _third(seed):
    return variant("02_3", seed, u=(-0.5, -0.2, -0.8, -1.2), eps=(0.02, 0.01, 0.005))


def ask_02_3(seed: int = 0) -> str:
    """The question: from which wavenumber on the toy system grows."""
    given = _third(seed)
    return (
        f"The toy system, frozen at u* = {given['u']}, v_xx* = 0, with eps = {given['eps']}: from which wavenumber xi "
        "on do waves grow?"
    )


def check_02_3(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is 1/sqrt(eps |u*|), to one per cent; a ``Feedback``.

    There the trace -eps u* xi^2 - 1 of eq. (toy-mat) vanishes while its determinant xi^2 is positive.
    """
    given = _third(seed)
    x = given["eps"] * -given["u"]
    return check(
        answer,
        1 / math.sqrt(x),
        "below it the term -v wins. A grid with no shorter waves than this shows nothing.",
        {
            "that is xi squared.": 1 / x,
            "that is from where on (toy-eig) is a good estimate. Growth begins long before.": 2 / x,
            "with the terms of highest order alone every wave grows. Keep -v.": 0.0,
            "that leaves out u*.": 1 / math.sqrt(given["eps"]),
            "that leaves out eps.": 1 / math.sqrt(-given["u"]),
        },
        "the eigenvalues are a complex pair there, so Re lambda is half the trace of (toy-mat). When is that zero?",
    )


_EQUATIONS = {
    "u_t = u_x + v_x; v_t = v_x + 2*u": (ILL, "(lambda - i xi)^2 = 2 i xi. What is the real part of its root?"),
    "u_t = u_xxx + u_xx": (STABLE, "lambda = -i xi^3 - xi^2. Only the real part counts."),
    "u_tt = u_xx + u": (UNSTABLE, "lambda^2 = 1 - xi^2. For which xi is that positive, and how large does it get?"),
    "u_t = u_xxxx + u_xx": (ILL, "lambda = xi^4 - xi^2: what becomes of it for short waves?"),
    "a_t = b_xx; b_t = 3*a_x - a_xx": (ILL, "lambda^2 = -xi^4 - 3 i xi^3. Expand its root for large xi, to two terms."),
    "u_t = -u_xxxx - 2*u_xx": (UNSTABLE, "lambda = 2 xi^2 - xi^4. Does anything grow, and is there a ceiling?"),
    "u_t = v_x; v_t = u_x - v": (STABLE, "the two eigenvalues have the sum -1 and the product xi^2."),
}


def _fourth(seed):
    return variant("02_4", seed, pde=tuple(_EQUATIONS))["pde"]


def ask_02_4(seed: int = 0) -> str:
    """The question: what an equation is."""
    return f"By hand, then by verdict: is '{_fourth(seed)}': '{STABLE}', '{UNSTABLE}' or '{ILL}'?"


def check_02_4(answer: str, seed: int = 0) -> Feedback:
    """Whether ``answer`` is what section A2.1 makes of the equation; a ``Feedback``."""
    truth, hint = _EQUATIONS[_fourth(seed)]
    hints = {option: hint for option in (STABLE, UNSTABLE, ILL) if option != truth}
    return choose(
        answer,
        truth,
        "only the real part counts, and only whether it has a ceiling.",
        hints,
        also={"stable": STABLE, "unstable": UNSTABLE},
        half=("well posed", (STABLE, UNSTABLE), "well posed, and does anything grow?"),
    )
