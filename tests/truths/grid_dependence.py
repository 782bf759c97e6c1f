"""The answers of notebook 03 by other routes than the checkers take."""

import math
import re

import numpy as np

from primer import Toy, exercises, ftcs
from primer.study.spectrum import jacobian
from truths.reading import numbers


def truth_03_1(seed):
    """By marching the scheme to its rest."""
    n = int(re.search(r"N = (\d+)", exercises.ask_03_1(seed))[1])
    return ftcs(Toy(1.5), n, 2e-3, 60).dist[-1]


def truth_03_2(seed):
    """By bisection on the discrete symbol at the sawtooth."""
    a, eps = numbers(exercises.ask_03_2(seed))[:2]
    low, high = 1.0, 1e4
    while high - low > 1e-9 * high:
        n = (low + high) / 2
        h = 2 * math.pi / n
        S = Toy(a, eps).symbol(math.pi / h, a - 1, multiplier=lambda xi, m, h=h: {1: 0 * xi, 2: 0 * xi - 4 / h**2}[m])
        low, high = (low, n) if np.linalg.eigvals(S).real.max() > 1e-13 else (n, high)
    return low


def truth_03_3(seed):
    """From the spectrum of the dense Jacobian."""
    text = exercises.ask_03_3(seed)
    n, digits = int(re.search(r"N = (\d+)", text)[1]), int(re.search(r"with (\d+) more", text)[1])
    return digits * math.log(10) / np.linalg.eigvals(jacobian(Toy(0.5), n)).real.max()


def truth_03_5(seed):
    """By a search over the growth of waves e^{i xi x}, and a grid whose cut-off is that wave."""
    D, K = numbers(exercises.ask_03_5(seed))[:2]
    low, high = 0.0, math.sqrt(D / K)
    for _ in range(200):  # of one maximum, by thirds
        a, b = low + (high - low) / 3, high - (high - low) / 3
        growing = [D * xi**2 - K * xi**4 for xi in (a, b)]
        low, high = (a, high) if growing[0] < growing[1] else (low, b)
    return low + high
