"""The answers of notebook 08 by other routes than the checkers take."""

import re

import numpy as np

from primer import exercises, growth_rates, verdict
from primer.study.cure import cut_off
from truths.reading import numbers


def truth_08_1(seed):
    """The largest growth of the equation as text, over many wavenumbers."""
    nu, delta = numbers(exercises.ask_08_1(seed))
    rates = growth_rates("u_t = -nu*u_xx - delta*u_xxxx", np.linspace(0.1, 100, 3001), nu=nu, delta=delta)
    return float(np.max(np.real(rates)))


def truth_08_2(seed):
    """By bisection on what marching back does to a wave."""
    t, noise = numbers(exercises.ask_08_2(seed))[:2]
    low, high = 0.0, 50.0
    while high - low > 1e-9 * high:
        k = (low + high) / 2
        low, high = (k, high) if noise * cut_off(t, k)(np.array([k]))[0] < 1 else (low, k)
    return low


def truth_08_3(seed):
    """The one term that the verdict calls well posed."""
    text = exercises.ask_08_3(seed)
    equation = text.split(" is ill posed")[0]
    terms = re.findall(r"'(.*?)'", text)
    (right,) = [term for term in terms if verdict(f"{equation} {term}", delta=1e-3).kind == "well-posed"]
    assert verdict(equation).kind == "ill-posed"
    return right
