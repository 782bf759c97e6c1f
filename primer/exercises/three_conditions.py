"""Exercises of notebook 11, the three conditions."""

import math

from primer.exercises.answers import Feedback, check, variant


def _first(seed):
    return variant("11_1", seed, t=(0.5, 0.7, 0.4, 0.8, 1.2))


def ask_11_1(seed: int = 0) -> str:
    """The question: a derivative of Tychonoff's solution."""
    return f"Tychonoff's solution has u(0, t) = exp(-1/t^2). How large is u_xx at x = 0 and t = {_first(seed)['t']}?"


def check_11_1(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is 2 t^-3 exp(-1/t^2), for u_xx = u_t, to one per cent; a ``Feedback``."""
    t = _first(seed)["t"]
    g = math.exp(-1 / t**2)
    return check(
        answer,
        2 * g / t**3,
        "the equation hands you the series, one derivative in t for two in x.",
        {
            "that is u itself.": g,
            "that is the coefficient of x^2 in the series, half of u_xx.": g / t**3,
            "the derivative of -1/t^2 is not that.": (-2 * g / t**3, 2 * g / t, g / t**2),
        },
        "it solves the heat equation: what is u_xx equal to, and do you know that along x = 0?",
    )


def _second(seed):
    return variant("11_2", seed, k=(2, 3, 5, 4))


def ask_11_2(seed: int = 0) -> str:
    """The question: from which wave on data are small in BC^k."""
    k = _second(seed)["k"]
    return (
        f"The data e^(-sqrt n) sin(n x) have the norm n^k e^(-sqrt n) in BC^k. For k = {k}: at which n is it largest? "
        "(After that it tends to 0.)"
    )


def check_11_2(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is (2 k)^2, where k ln n - sqrt n is largest, to 5 in 1000; a ``Feedback``."""
    k = _second(seed)["k"]
    return check(
        answer,
        (2 * k) ** 2,
        "a larger k only puts it off: no number of derivatives makes backward heat continuous.",
        {
            "that is its square root.": 2 * k,
            "the derivative of sqrt n is 1/(2 sqrt n).": k**2,
            "the square of 2 k, not 2 k^2.": 2 * k**2,
        },
        "take the logarithm, k ln n - sqrt n, and its derivative.",
        rtol=5e-3,
    )
