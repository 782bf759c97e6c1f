"""The answers of notebook 02 by other routes than the checkers take."""

import re

from scipy.optimize import brentq

from primer import exercises, growth_rates, verdict
from primer.exercises.testing_a_pde import ILL, STABLE, UNSTABLE

TOY = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"


def _pde(text):
    """The equation of a question, in the notation of ``verdict``."""
    return re.sub(r"(\d) u", r"\1*u", re.match(r"(u_t = .*?)(,| is)", text)[1])


def truth_02_1(seed):
    """By bisection on the verdict, about states with a slope and a curvature."""
    pde, low, high = _pde(exercises.ask_02_1(seed)), 0.0, 5.0
    while high - low > 1e-3:
        u = (low + high) / 2
        ill = verdict(pde, at={"u": u, "u_x": 0.3, "u_xx": -1.2}).kind == "ill-posed"
        low, high = (u, high) if ill else (low, u)
    return (low + high) / 2


def truth_02_2(seed):
    """From the supremum that the verdict gives."""
    return verdict(_pde(exercises.ask_02_2(seed)), at={"u": 0, "u_x": 0, "u_xx": 0}).bound


def truth_02_3(seed):
    """By bracketing the zero of the growth rate."""
    u, eps = map(float, re.search(r"u\* = (-[\d.]+),.*eps = ([\d.]+\d)", exercises.ask_02_3(seed)).groups())
    rate = lambda xi: growth_rates(TOY, xi, at={"u": u, "v_xx": 0}, eps=eps)[0].real  # noqa: E731
    return brentq(rate, 1, 100)


def truth_02_4(seed):
    """From the verdict."""
    found = verdict(re.search(r"is '(.*?)': '", exercises.ask_02_4(seed))[1])
    return ILL if found.kind == "ill-posed" else UNSTABLE if found.unstable else STABLE
