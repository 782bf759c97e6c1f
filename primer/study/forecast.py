"""When a run of the toy system will blow up, and from what, without running it: the growth on the smooth solution.

The smooth solution is carried on the grid by long strides (:mod:`primer.study.leap`), every harmonic below ``_FILTER``
being put back to zero (Krasny's filter, J. Fluid Mech. 167, 1986), so that round-off does not grow on it: it is what
exact arithmetic would give. On it the linearised equations carry two perturbations, each with a logarithm of its own so
that nothing overflows: the stated seed, and noise, injected at every stride at the level of round-off. The run is lost
once, together, they are as large as u itself, about 1: from there on it is a matter of moments.
"""

import math
from dataclasses import dataclass

import numpy as np

from primer.problems.toy import tendency
from primer.schemes.discrete import discrete_steady
from primer.schemes.grid import Grid
from primer.study.leap import Half
from primer.study.spectrum import Parity, growing, rate
from primer.study.stability import frozen_dt

_FILTER = 1e-12  # well over the round-off of a solve, well under anything smooth
_STRIDE = 0.05  # the longest stride: the solution moves on a time scale of 1
_GROWTH = 0.3  # most growth in a stride: R(z) is off by z^2/12 there
_WAVE = 0.5  # the longest stride over h where waves grow: they oscillate at 1/h
_SETTLED = 1e-4  # distance from the steady state at which the solution stands still: e^{-t/2} at t = 18
_AFTER = 5.0  # how long to march on from there before each mode that grows goes its own way
_ROUNDING = 0.2  # standard deviation of a rounding error over epsilon |u|: uniform within half a unit of the last place


@dataclass(frozen=True)
class Forecast:
    """What the linearised march says.

    Attributes
    ----------
    t_blow_up          when the run will blow up, also where that is after t_end; infinite if never
    seeded             whether at the end the stated seed is larger than what has grown from round-off
    smooth             whether it is the smooth solution itself that runs away
    t_first_negative   the first time with u <= 0 somewhere on the smooth solution, or None
    """

    t_blow_up: float
    seeded: bool
    smooth: bool
    t_first_negative: float | None


def forecast(toy, n, dt, t_end, seed=None, epsilon=2.0**-52, blow_up_at=1e3, locks=True, smooth_too=True):
    """March the smooth solution and its perturbations towards ``t_end``; see :class:`Forecast`.

    ``seed`` is a ``Seed`` or None, ``epsilon`` the distance from 1 to the next number of the run's arithmetic, and
    ``locks`` whether a change that is lost in the last bit is lost, and ``smooth_too`` whether what is left of the
    smooth solution as it comes to rest is a perturbation too; it is known to double precision only.
    """
    smooth = _Smooth(toy, n)
    waves = _Waves(toy, n, seed, epsilon)
    steps, last, t_negative, t_still, solvers = 0, round(t_end / dt), None, math.inf, None
    while True:
        t, m = steps * dt, min(_stride(toy.eps, smooth.u, smooth.half.h, dt), last - steps)
        if t_negative is None and smooth.u.min() <= 0:
            t_negative = t
        away = smooth.away()
        size_u, size_v = waves.log_sizes()
        if not away < blow_up_at or max(size_u, size_v - math.log(blow_up_at)) > 0:
            # From 1 on, a perturbation feeds on itself: a step or so later Dist is beyond any bound.
            cause = _SMOOTH if not away < blow_up_at else waves.largest()
            return Forecast(t + dt, cause == _SEED, cause == _SMOOTH, t_negative)
        if m == 0 or t > t_still + _AFTER:
            left, cause = min(waves.outlook(mode, dt, t, locks) for mode in growing(toy, n, dt))
            return Forecast(t + left, cause == _SEED, cause == _SMOOTH, t_negative)
        if away < _SETTLED and not smooth.still:  # from here on the linear equations serve for everything
            t_still = t
            left = smooth.settle()
            if smooth_too:
                waves.take(left)
            solvers = None
        if solvers is None or m != solvers[0] or not smooth.still:
            solvers = m, [half.factored(toy.eps, smooth.u, smooth.v_xx, (m - 1) / 2 * dt) for half in waves.halves]
        waves.advance(smooth, *solvers, m * dt)
        smooth.advance(solvers[1][0], m * dt)
        steps += m


_SEED, _NOISE, _SMOOTH = range(3)  # where a perturbation comes from


class _Smooth:
    """The smooth solution (u, v) on the half grid, u even and v odd."""

    def __init__(self, toy, n):
        grid = Grid(n)
        self.eps, self.half, self.still = toy.eps, Half(n, grid.h, 1), False
        self.u, self.v = self.half.part(np.array(toy.initial(grid.x)))
        self.steady = self.half.part(np.array(discrete_steady(toy, grid.x, grid.h)))
        self.sin_x = toy.forcing(grid.x)[: self.u.size]
        self._differentiate()

    def _differentiate(self):
        (self.u_x, self.v_x), (_, self.v_xx) = self.half.differences(np.stack((self.u, self.v)))

    def away(self):
        return np.abs((self.u, self.v) - self.steady).max()

    def settle(self):
        """Stand still on the steady state; return what was left to go."""
        left, self.still = (self.u, self.v) - self.steady, True
        self.u, self.v = self.steady
        self._differentiate()
        return left

    def advance(self, solve, stride):
        if self.still:
            return
        rates = tendency(self.u, self.v, self.u_x, self.v_x, self.v_xx, self.sin_x, self.eps)
        full = self.half.full(np.stack((self.u, self.v)) + solve(stride * np.stack(rates)))
        waves = np.fft.rfft(full)
        waves[np.abs(waves) < _FILTER * full.shape[-1]] = 0
        self.u, self.v = self.half.part(np.fft.irfft(waves, full.shape[-1]))
        self._differentiate()


class _Waves:
    """Perturbations on the two half grids, (3, 2, n//2 + 1) each: of the seed, of round-off, of the smooth solution."""

    def __init__(self, toy, n, seed, epsilon):
        grid = Grid(n)
        self.halves = Half(n, grid.h, 1), Half(n, grid.h, -1)
        self.random, self.eps, self.n = np.random.default_rng(0), toy.eps, n
        full = np.zeros((3, 2, n))
        self.logs = np.array([0.0, math.log(epsilon), 0.0])
        if seed is not None and seed.amplitude:
            full[_SEED, toy.fields.index(seed.field)] = seed(grid.x) / seed.amplitude
            self.logs[_SEED] = math.log(abs(seed.amplitude))
        self.fields = [half.part(full) for half in self.halves]
        self.round_off(np.abs(toy.initial(grid.x)).max(axis=-1), 1.0, epsilon)
        self.epsilon = epsilon

    def round_off(self, level, times, epsilon):
        """Add that of so many steps where u and v are of this level."""
        noise = self.random.standard_normal((2, self.n)) * (_ROUNDING * math.sqrt(times) * level[:, None])
        scale = math.exp(math.log(epsilon) - self.logs[_NOISE])
        for half, field in zip(self.halves, self.fields, strict=True):
            field[_NOISE] += half.part(noise) * scale

    def take(self, left):
        self.fields[0][_SMOOTH] = left

    def advance(self, smooth, m, solve, stride):
        level = np.abs((smooth.u, smooth.v)).max(axis=-1)
        for half, field, solved in zip(self.halves, self.fields, solve, strict=True):
            field += solved(stride * half.rate(self.eps, smooth.u, smooth.v_xx, field))
        self.round_off(level, m, self.epsilon)
        sizes = np.maximum(*(np.abs(field).max(axis=(1, 2)) for field in self.fields))
        factors = np.where(sizes > 1e6, sizes, 1.0)
        self.logs += np.log(factors)
        for field in self.fields:
            field /= factors[:, None, None]

    def _amplitudes(self):
        """(3, 2) logarithms of max |u| and max |v|."""
        sizes = np.maximum(*(np.abs(field).max(axis=-1) for field in self.fields))
        return np.log(np.maximum(sizes, 1e-300)) + self.logs[:, None]

    def log_sizes(self):
        return np.logaddexp.reduce(self._amplitudes(), axis=0)

    def outlook(self, mode, dt, t, locks):
        """(time left until ``mode`` takes over, where most of it comes from) by steps of dt; infinite if never.

        That is at about 1, or sooner where its own growth is slow: at size A, the square of A counts against it.

        Once the smooth solution's own steps, dt e^{-t/2}, are lost in the last bit, nothing else moves u either unless
        its steps dt |lam| |u| are about that bit: a slow mode that has not come so far by then is held still.
        """
        i = list(Parity).index(mode.parity)
        contents = np.array([abs(mode.content(*self.halves[i].full(field))) for field in self.fields[i]])
        logs = np.log(np.maximum(2 * contents * np.abs(mode.u).max(), 1e-300)) + self.logs
        size, cause, growth = float(np.logaddexp.reduce(logs)), int(np.argmax(logs)), float(rate(mode.lam, dt))
        t_lock = max(2 * math.log(2 * dt / self.epsilon), t)
        held = size + growth * (t_lock - t) + math.log(dt * abs(mode.lam)) < math.log(self.epsilon)
        if growth <= 0 or (locks and held):
            return math.inf, cause
        return max((min(0.0, math.log(growth) / 2) - size) / growth, 0.0), cause

    def largest(self):
        return int(np.argmax(self._amplitudes()[:, 0]))


def _stride(eps, u, h, dt):
    """How many steps of dt to take at once."""
    stride, sawtooth = _STRIDE, -4 * eps * u.min() / h**2 - 1
    if sawtooth > 0:
        stride = min(stride, _GROWTH / sawtooth)
    if dt > frozen_dt(h, u.min(), eps):  # waves grow, by dt or by u
        stride = min(stride, _WAVE * h)
    if dt * (1 + 4 * eps * u.max() / h**2) > 1.9:  # the stiffest modes overshoot: only the scheme does as it does
        stride = dt
    return max(1, int(stride / dt))
