"""The answers of notebook 10 by other routes than the checkers take."""

import math

from primer import exercises
from truths.reading import numbers


def truth_10_1(seed):
    """On the wave that attains the bound: E e^(-c s) with E e^(-c T) = delta, T = 1."""
    E, noise, part = (x for x in numbers(exercises.ask_10_1(seed)) if x != 0)
    return E * math.exp(-math.log(E / noise) * part)


def truth_10_2(seed):
    """By bisection on ln delta."""
    part, better = (x for x in numbers(exercises.ask_10_2(seed)) if x != 0)
    low, high = 0.0, 100.0
    while high - low > 1e-12:
        middle = (low + high) / 2
        low, high = (middle, high) if math.exp(-middle * part) > 1 / better else (low, middle)
    return math.exp(low)
