"""What NumPy computes for a compiled loop: numbers and functions of x once, and functions of fields row by row."""

import ctypes
from fractions import Fraction
from functools import cache

import numpy as np

from primer.equations.evaluate import operate, value
from primer.schemes.passes import Form, passes

_CALL = ctypes.CFUNCTYPE(None, ctypes.c_int64, ctypes.c_double)


class Numbers:
    """The constants, functions of x and functions of t of one problem, in the arrays of a compiled loop."""

    def __init__(self, problem, x, real):
        self.problem, self.x, self.real = problem, x, real
        with np.errstate(all="ignore"):  # a parameter beyond the largest number is infinite: a blow-up
            self.known = problem.known(x)
        self.raised, self.stop = None, lambda: None
        self.callback = _CALL(self._guarded)
        self.address = ctypes.cast(self.callback, ctypes.c_void_p).value

    def prepare(self, form, n, reach, members):
        """Room for rows of scratch and for what depends on t."""
        self.plan = passes(self.problem.evolution, form)
        self.inner = slice(reach, reach + n)
        self.scratch = np.zeros((self.plan.rows, n + 2 * reach, members), self.real)
        self.clocks = np.zeros(sum(1 + part for part in form.clock), self.real)

    def constants(self, first):
        """Those numbers, and behind them the constants, two for each that is complex."""
        return np.array([*map(self.real.type, first), *_parts(self.known.constants)], self.real)

    def fixed(self):
        """(rows, n)."""
        return np.array([*_parts(self.known.fixed)], self.real).reshape(-1, self.x.size)

    def _at(self, t):
        terms = self.problem.evolution.clocks
        with np.errstate(all="ignore"):
            return [value(term, self.known.scalars, self.problem.parameters, t=t) for term in terms]

    def form(self, fields):
        """What is complex here, where the fields are or are not."""
        known = self.known.constants, self.known.fixed, self._at(self.real.type(0))
        return Form(fields, *(tuple(bool(np.iscomplexobj(v)) for v in values) for values in known))

    def raise_what_was_raised(self):
        """What went wrong in between, such as Ctrl-C."""
        if self.raised is not None:
            raised, self.raised = self.raised, None
            raise raised

    def _guarded(self, which, time):
        try:
            self._compute(which, time)
        except BaseException as error:  # ctypes would print it and go on
            self.raised = error
            self.stop()
            if isinstance(error, KeyboardInterrupt):  # what is being done is done to the end, and right
                self._compute(which, time)

    def _compute(self, which, time):
        if which < 0:
            t = self.real.type(time)
            self.clocks[:] = _parts(self._at(t))
            return
        call = self.plan.calls[which]
        operands = [self.known.constants[at] if isinstance(at, int) else self._row(at) for at in call.operands]
        kind, what = ("^", None) if call.name == "^" else ("call", call.name)
        found = operate(kind, what, *operands)
        self.scratch[call.result.number, self.inner, 0] = found.real
        if call.result.imaginary is not None:
            self.scratch[call.result.imaginary, self.inner, 0] = found.imag

    def _row(self, row):
        real = self.scratch[row.number, self.inner, 0]
        if row.imaginary is None:
            return real
        found = np.empty(real.size, np.result_type(real, 1j))
        found.real, found.imag = real, self.scratch[row.imaginary, self.inner, 0]
        return found


def _parts(values):
    """Real values, and the two parts of complex ones, in order."""
    return [part for v in values for part in ((v.real, v.imag) if np.iscomplexobj(v) else (v,))]


@cache
def fused():
    """How NumPy multiplies complex arrays here: True if it rounds once where it adds two products, as its fastest loop
    does, False if it rounds each, None if it is neither, or if its quotient is not Smith's: then NumPy marches.
    """
    x = 1 + 2.0**-30  # x x - x x is 0, or what x x loses when it is rounded
    once = bool((np.full(8, x + x * 1j) * np.full(8, x + x * 1j)).real[0] != 0)
    random = np.random.default_rng(1)
    a, b = (random.normal(size=(2, 32)).view(complex).ravel() for _ in range(2))
    return once if _is_product(a, b, a * b, once) and _is_quotient(a, b, a / b) else None


def _is_product(a, b, ab, once):
    exact = np.vectorize(Fraction, otypes=[object])

    def of(p, q, r, s):
        """p q + r s, rounded after r s, and after p q if not once."""
        second = r * s
        return (exact(p) * exact(q) + exact(second)).astype(float) if once else p * q + second

    real, imag = of(a.real, b.real, -a.imag, b.imag), of(a.real, b.imag, a.imag, b.real)
    return np.array_equal(ab.real, real) and np.array_equal(ab.imag, imag)


def _is_quotient(a, b, found):
    wide = np.abs(b.real) >= np.abs(b.imag)
    x, y = np.where(wide, b.real, b.imag), np.where(wide, b.imag, b.real)
    ratio = y / x
    scale = 1 / (x + y * ratio)
    real = np.where(wide, a.real + a.imag * ratio, a.real * ratio + a.imag) * scale
    imag = np.where(wide, a.imag - a.real * ratio, a.imag * ratio - a.real) * scale
    return np.array_equal(found.real, real) and np.array_equal(found.imag, imag)
