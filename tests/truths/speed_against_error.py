"""The answers of notebook 05 by other routes than the checkers take."""

import math
import re

from primer import CENTRAL_4, CENTRAL_6, FOURIER, exercises
from primer.schemes.grid import Grid
from truths.reading import numbers


def truth_05_1(seed):
    """By bisection on C h^p through both points."""
    e1, n1, e2, n2 = numbers(exercises.ask_05_1(seed))
    low, high = 0.0, 20.0
    while high - low > 1e-9:
        p = (low + high) / 2
        low, high = (p, high) if e1 * (n1 / n2) ** p > e2 else (low, p)
    return low


def truth_05_2(seed):
    """By counting points and steps on two fine grids."""
    order, ratio = re.search(r"of order (\d+) .* error (\d+) times", exercises.ask_05_2(seed)).groups()
    n = 10**5
    finer = next_grid(n, int(order), int(ratio))
    return finer * (Grid(finer).h ** -2 // 0.25) / (n * (Grid(n).h ** -2 // 0.25))


def next_grid(n, order, ratio):
    """The first grid on which h^order is at least ratio times smaller, by bisection over whole numbers."""
    low, high = n, 100 * n
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if middle**order >= ratio * n**order else (middle, high)
    return high


def truth_05_3(seed):
    """By bisection on what the package's stencil makes of the sawtooth."""
    text = exercises.ask_05_3(seed)
    a, eps = numbers(text)[:2]
    space = CENTRAL_4 if "fourth" in text else CENTRAL_6 if "sixth" in text else FOURIER
    low, high = 4.0, 1e4
    while high - low > 1e-9 * high:
        n = (low + high) / 2
        h = 2 * math.pi / n
        low, high = (low, n) if 1 - eps * (a - 1) * space[2].multiplier(n / 2, h) < 0 else (n, high)
    return low
