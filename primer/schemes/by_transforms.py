"""The method of lines on many Fourier points: one transform there and one back for all derivatives of a stage."""

import math

import numpy as np

from primer.equations.evaluate import tendencies
from primer.schemes.fourier import Fourier
from primer.schemes.grid import Grid


class Batch:
    """``derivative(f, m)`` of a problem that is a text, where all that a state is asked for is made at once.

    Call ``of(state)`` for each new state of shape (fields, n); derivatives of its rows are then looked up, those of
    anything else (a product, say) are made one by one.
    """

    def __init__(self, evolution, space, grid, is_complex):
        from scipy import fft

        n, self.n, self.space, self.h = grid.n, grid.n, space, grid.h
        wanted = [(s, m) for s, m in evolution.stages[0].slots if m and isinstance(space[m], Fourier)]
        self.place = {slot: i for i, slot in enumerate(wanted)}
        self.rows = np.array([s for s, _ in wanted], dtype=int)
        self.there, self.back = (fft.fft, fft.ifft) if is_complex else (fft.rfft, fft.irfft)
        waves = np.fft.fftfreq(n, 1 / n) if is_complex else np.arange(n // 2 + 1)
        self.factors = np.empty((len(wanted), waves.size), dtype=complex)
        for row, (_, m) in zip(self.factors, wanted, strict=True):
            row[:] = (2j * math.pi / (n * grid.h) * waves) ** m
            if n % 2 == 0 and m % 2:
                row[n // 2] = 0
        self.state: list = []
        self.found = np.zeros((0, n))

    def of(self, state):
        """Make all derivatives of the rows of a state."""
        self.state = list(state)
        if self.place:
            # Without its first value a constant has no derivative, and a large mean leaves no rounding.
            amplitudes = self.there(state - state[:, :1])
            self.found = self.back(amplitudes[self.rows] * self.factors, self.n)
        return self.state

    def __call__(self, f, m):
        for s, row in enumerate(self.state):
            if f is row and (s, m) in self.place:
                return self.found[self.place[s, m]]
        return self.space[m](f, self.h)


def slope_by_transforms(problem, x, space, is_complex):
    """f(state, t): the time derivatives of a problem that is a text, of the shape of the state (fields, n)."""
    with np.errstate(all="ignore"):
        given = problem.known(x)
    evolution, parameters = problem.evolution, problem.parameters
    batch = Batch(evolution, space, Grid(x.size, getattr(problem, "period", 2 * math.pi)), is_complex)

    def slope(state, t):
        return np.array(tendencies(evolution, parameters, batch.of(state), batch, given, t))

    return slope


def step_by_products(time, y):
    """``time.exact_step`` for states like y, its sums of slopes as products of a row of the table with all slopes."""
    A, b = time.table
    slopes = np.zeros((len(b), y.size), dtype=y.dtype)

    def step(f, y, lost, dt, t):
        for i, node in enumerate(time.nodes):
            at = y + dt * (A[i, :i] @ slopes[:i]).reshape(y.shape) if i else y
            slopes[i] = f(at, t + node * dt).ravel()
        change = lost + dt * (b @ slopes).reshape(y.shape)
        new = y + change
        return new, change - (new - y)

    return step
