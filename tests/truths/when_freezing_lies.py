"""The answers of notebook 12 by other routes than the checkers take."""

import numpy as np
from scipy.linalg import expm

from primer import exercises
from truths.reading import numbers


def truth_12_1(seed):
    """By how much the turned equation grows on more and more waves, extrapolated."""
    b, c = numbers(exercises.ask_12_1(seed))[:2]
    slopes = []
    for K in (40, 80):
        k, x = np.arange(-K, K + 1), np.arange(4 * K) * np.pi / (2 * K)
        beta, waves = b + c * np.cos(x), np.exp(1j * np.outer(x, k))  # w = z exp(-c sin(x)/2)
        rest = c * np.sin(x) / 2 + (c * np.cos(x)) ** 2 / 4 - beta * c * np.cos(x) / 2
        z_t = 1j * waves * (-(k**2) + 1j * b * k) + 1j * rest[:, None] * waves
        slopes.append(np.linalg.eigvals(waves.conj().T @ z_t / x.size).real.max() / K)
    return float(2 * slopes[1] - slopes[0])


def truth_12_2(seed):
    """By the exponential of the matrix of the wave."""
    text = exercises.ask_12_2(seed)
    found = [x for x in numbers(text) if x != 0]
    c, xi, t = found[0], found[1], found[-1]
    moved = expm(t * 1j * xi * np.array([[1, c], [0, 1]])) @ np.array([0, 1])
    return float(abs(moved[0]))
