"""A time step of which nothing is known, made safe to ask: copies in and out, shapes, memory, randomness, patience.

``primer.examine`` asks a function ``step(fields, dt)``, whatever is inside: five lines adapt most programs. Each of
these is one, with a base state; ``examine(step, state, dt=...)`` does the rest.

A loop as anyone types it, on arrays of shape (n,)::

    # NumPy
    def step(fields, dt):
        u = fields[0]
        h = 2 * np.pi / u.size
        u_xx = (np.roll(u, 1) - 2 * u + np.roll(u, -1)) / h**2
        return [u + dt * u_xx]
    state = lambda n: np.ones((1, n))

A right-hand side that scipy marches (tight tolerances: what they let pass is noise to an examination)::

    # solve_ivp
    def step(fields, dt):
        u_xx = lambda u: (np.roll(u, 1) - 2 * u + np.roll(u, -1)) * u.size**2
        found = solve_ivp(lambda t, u: u - u**3 - 1e-3 * u_xx(u), (0, dt), fields[0], rtol=1e-9, atol=1e-12)
        return found.y[:, -1][None]
    state = lambda n: np.ones((1, n))

py-pde in one space variable, and in two (its first call on each grid compiles, for a minute: call it before)::

    # py-pde
    cahn_hilliard = pde.PDE({"c": "laplace(c**3 - c - 0.02*laplace(c))"})
    def step(fields, dt):
        grid = pde.CartesianGrid([(0, 2 * np.pi)], fields.shape[-1], periodic=True)
        start = pde.ScalarField(grid, fields[0])
        return cahn_hilliard.solve(start, dt, dt, tracker=None, backend="numpy").data[None]
    state = lambda n: np.full((1, n), 0.1)

    # py-pde in two dimensions
    heat = pde.PDE({"c": "laplace(c)"})
    def step(fields, dt):
        grid = pde.CartesianGrid([(0, 2 * np.pi)] * 2, fields.shape[1:], periodic=True)
        start = pde.ScalarField(grid, fields[0])
        return heat.solve(start, dt, dt, tracker=None, backend="numpy").data[None]
    state = lambda n: np.ones((1, n, n))

FiPy, with its own implicit step (its usual tolerance would leave small perturbations as they are)::

    # FiPy
    def step(fields, dt):
        mesh = fipy.PeriodicGrid1D(nx=fields.shape[-1], dx=2 * np.pi / fields.shape[-1])
        u = fipy.CellVariable(mesh=mesh, value=fields[0])
        equation = fipy.TransientTerm() == fipy.DiffusionTerm(coeff=-0.01)
        equation.solve(var=u, dt=dt, solver=fipy.LinearLUSolver(tolerance=1e-14))
        return u.value[None]
    state = lambda n: np.ones((1, n))
"""

from __future__ import annotations

import time

import numpy as np

from primer.checks import shown

_NUDGE = 1e-3  # of a field's size: a perturbation that a memory would remember
_AGAIN = 1e-6  # of what a step does to that perturbation: answers that differ by more are two answers
_BITS = 1e-13  # of a field's size: what the order of a sum, left to threads, may change


class Lost(Exception):
    """A perturbed state from which the step gives no finite answer."""


class Exhausted(Exception):
    """The calls together took much longer than was foreseen."""


class Meter:
    """How often a step was called, and for how many seconds together."""

    def __init__(self, patience):
        self.patience, self.calls, self.seconds = patience, 0, 0.0

    def left(self):
        """The seconds that are left."""
        return self.patience - self.seconds


class Box:
    """One grid of a black box: its base state, and ``step`` in real fields that are each of size about 1.

    Complex fields are two real ones, and each field is measured in units of its largest value on the base state (of the
    largest of all, where it vanishes). ``step`` gets a copy, and what it returns is copied at once.

    Attributes
    ----------
    n, shape     the number that ``state`` was given, and (r, ...) of the real fields
    base         the base state as ``state`` gave it
    state        the same in units of the fields
    uniform      whether each field of it is one number
    moved        how far one step moves it, in units of the fields
    seconds      one call's
    """

    def __init__(self, step, state, n, dt, meter):
        self._step, self.n, self.meter = step, n, meter
        try:
            given = state(n)
        except Exception as problem:
            raise ValueError(
                f"state must give the base state, but state({n}) fails, {type(problem).__name__}: {shown(str(problem))}"
            ) from problem
        self.base = _checked_base(given, n)
        self.complex = self.base.dtype.kind == "c"
        real = self._split(self.base)
        axes = tuple(range(1, real.ndim))
        sizes = np.abs(real).max(axis=axes, keepdims=True)
        if self.complex:  # of one complex field: the same unit for both of its parts
            sizes = np.tile(np.maximum(*np.split(sizes, 2)), (2, *(1 for _ in axes)))
        largest = sizes.max() or 1.0
        self.scale = np.where(sizes > 1e-12 * largest, sizes, largest)
        self.shape = real.shape
        self.uniform = bool((np.ptp(real, axis=axes) <= 1e-12 * self.scale.ravel()).all())
        before = meter.seconds
        after = self._first(dt)
        self.seconds = meter.seconds - before
        self.state = real / self.scale
        self.moved = float(np.abs(after - self.state).max())

    def step(self, change, dt):
        """One step from the base state plus ``change``, of ``shape``: the new fields in the same units.

        Raises
        ------
        Lost         if it fails from there, or is not finite
        ValueError   if what it returns is not of the shape that it was given
        """
        fields = self._join(self._split(self.base) + self.scale * change)
        start = time.perf_counter()
        try:
            with np.errstate(all="ignore"):  # a perturbation too large for the step is looked for on purpose
                found = self._step(fields, dt)
        except Exception as problem:
            raise Lost(f"it fails, {type(problem).__name__}: {shown(str(problem))}") from problem
        finally:
            self.meter.calls += 1
            self.meter.seconds += time.perf_counter() - start
        if self.meter.seconds > 3 * self.meter.patience:
            raise Exhausted
        return self._taken(found)

    def _taken(self, found):
        if found is None:
            raise TypeError("step must return the new fields, got None (if it changes them in place, return them)")
        given, found = found, numbers(found)
        if found.dtype.kind not in "iufc":
            raise TypeError(f"step must return an array of numbers, got {shown(given)}")
        if found.shape != self.base.shape:
            raise ValueError(
                f"step must return fields of the shape that it is given, {self.base.shape}, got {found.shape}"
            )
        if not np.isfinite(found).all():
            raise Lost("it is not finite (NaN or infinity)")
        if found.dtype.kind == "c" and not self.complex:
            if np.abs(found.imag).max() > 1e-9 * np.abs(found).max():
                raise ValueError("step returned complex fields from real ones: let state give complex fields")
            found = found.real
        return self._split(found) / self.scale

    def _first(self, dt):
        try:
            return self.step(np.zeros(self.shape), dt)
        except Lost as why:
            raise ValueError(
                f"step must advance the base state, but after one step from state({self.n}) with dt = {dt:g} {why}"
            ) from why.__cause__

    def _split(self, fields):
        if not self.complex:
            return fields.astype(float)
        return np.concatenate((fields.real, fields.imag)).astype(float)

    def _join(self, real):
        if self.complex:
            first, second = np.split(real, 2)
            real = first + 1j * second
        return real.astype(self.base.dtype)  # a copy, and single precision stays what it is

    def doubt(self, dt):
        """Why the step cannot be judged by asking it one state after another, or None."""
        still, nudge = np.zeros(self.shape), _NUDGE * np.random.default_rng(1).standard_normal(self.shape)
        first, second = self.step(still, dt), self.step(still, dt)
        pushed = self.step(nudge, dt)
        self.step(still, dt / 4)
        self.step(-nudge, dt)
        third, again = self.step(still, dt), self.step(nudge, dt)
        allowed = _AGAIN * np.abs(pushed - first - nudge).max() + _BITS
        if np.abs(second - first).max() > allowed:
            return (
                "asked twice for the same state, step gives two answers: it is random, or has a clock or a memory of "
                "its own; make it a function of the fields and dt alone (a fixed random seed, a fixed time)"
            )
        if np.abs(third - second).max() > allowed or np.abs(again - pushed).max() > allowed:
            return (
                "the answer of step depends on what it was asked before: it has a memory of its own; hand what it "
                "remembers over as further fields, or reset it in each call"
            )
        return None


def numbers(given):
    """A copy as an array; numbers that came as objects are numbers. What is none is left as it is."""
    try:
        found = np.array(given)
        if found.dtype == object:
            found = found.astype(complex if any(isinstance(each, complex) for each in found.flat) else float)
    except (TypeError, ValueError):
        found = np.array(None)
    return found


def _checked_base(fields, n):
    given, fields = fields, numbers(fields)
    if fields.dtype.kind not in "iufc":
        raise TypeError(f"state({n}) must give an array of numbers, got {shown(given)}")
    if fields.ndim not in (2, 3) or min(fields.shape[1:]) < 4 or not fields.shape[0]:
        raise ValueError(
            f"state({n}) must give fields of shape (m, n) or (m, ny, nx), at least 4 points each way, "
            f"got shape {fields.shape}"
        )
    if not np.isfinite(fields).all():
        raise ValueError(f"state({n}) must be finite everywhere, got {shown(fields)}")
    return fields.astype(float) if fields.dtype.kind in "iu" else fields
