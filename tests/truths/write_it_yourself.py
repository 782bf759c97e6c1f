"""The answers of notebook 09 by other routes than the checkers take."""

import math

import numpy as np

from primer import exercises
from truths.reading import numbers


def truth_09_1(seed):
    """The scheme point by point, with the paper's indices."""

    def step(u, v, x, h, eps, dt):
        n, u_new, v_new = len(u), [], []
        for j in range(n):
            left, right = j - 1, (j + 1) % n
            u_new.append(u[j] + dt * ((v[right] - v[left]) * (1 / (2 * h))))
            v_xx = ((v[right] - 2 * v[j]) + v[left]) * (1 / h**2)
            u_x = (u[right] - u[left]) * (1 / (2 * h))
            v_new.append(v[j] + dt * (eps * u[j] * v_xx + u_x - v[j] - math.sin(x[j])))
        return np.array(u_new), np.array(v_new)

    return step


def truth_09_2(seed):
    """By counting which values hang on the one, step by step, field by field."""
    n, m = (int(value) for value in numbers(exercises.ask_09_2(seed)) if value > 1)
    u, v = np.zeros(n, dtype=bool), np.arange(n) == n // 2
    for _ in range(m):
        reach_u, reach_v = (np.roll(f, 1) | np.roll(f, -1) for f in (u, v))
        u, v = u | reach_v, v | reach_v | u | reach_u
    return float(v.sum())
