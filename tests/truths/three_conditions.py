"""The answers of notebook 11 by other routes than the checkers take."""

import numpy as np

from primer import exercises
from primer.study.bounded import log_hadamard
from primer.study.tychonoff import tychonoff
from truths.reading import numbers


def truth_11_1(seed):
    """By differences in x of the series."""
    t, d = numbers(exercises.ask_11_1(seed))[-1], 1e-3
    return float((2 * tychonoff(d, t) - 2 * tychonoff(0.0, t)) / d**2)


def truth_11_2(seed):
    """Over all n up to 10^3."""
    k, n = int(numbers(exercises.ask_11_2(seed))[0]), np.arange(1.0, 1001)
    return float(n[np.argmax(log_hadamard(n, k))])
