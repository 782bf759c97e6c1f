"""The numbers a run is made of: float32, float64, longdouble, or as many decimal digits as asked for."""

import math
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from primer.checks import integer, real_array, shown

_PI = "3.14159265358979323846264338327950288419716939937510"  # more digits than any longdouble holds


@dataclass(frozen=True)
class Arithmetic:
    """A number system.

    Its array ``dtype``, the conversion ``number``, its ``pi``, and, as floats, the distance ``epsilon`` from 1 to the
    next number and the ``largest`` one.
    """

    dtype: np.dtype
    number: Callable
    pi: Any
    epsilon: float
    largest: float

    def grid(self, n, period=2 * math.pi):
        """(h, x): the spacing h = period/n and the points -period/2 + j h in these numbers.

        A period that is a whole multiple of pi in floats stands for that multiple of pi itself.
        """
        turns = round(period / math.pi)
        length = turns * self.pi if turns * math.pi == period else self.number(period)
        h = length / n
        return self.number(h), (-length / 2 + h * np.arange(n)).astype(self.dtype)

    @property
    def complex(self):
        """The complex numbers that go with these."""
        if self.dtype == object:
            return replace(self, number=self.number(0).context.mpc)
        dtype = np.result_type(self.dtype, np.complex64)
        return replace(self, dtype=dtype, number=dtype.type)

    def array(self, values):
        """A new array of these numbers."""
        if self.dtype != object:
            return np.array(values, dtype=self.dtype)
        return np.frompyfunc(self.number, 1, 1)(values)


def arithmetic(dtype=np.float64, digits=None):
    """The number system of ``dtype``, or of ``digits`` decimal digits (through mpmath) where that is given.

    Raises
    ------
    TypeError, ValueError    if dtype is not float32, float64 or longdouble, or digits is not an integer from 2 to 10000
    """
    if digits is not None:
        return _decimal(integer("digits", digits, least=2, most=10_000))
    try:
        dtype = np.dtype(dtype)
    except TypeError:
        dtype = None
    if dtype not in (np.float32, np.float64, np.longdouble):
        raise ValueError("dtype must be float32, float64 or longdouble (for more, give digits), got " + shown(dtype))
    # float32 takes its grid from double precision: rounded once, not at every step of the way.
    pi = np.longdouble(_PI) if dtype == np.longdouble else math.pi
    # A longdouble's largest number is no float; the largest float is bound enough.
    largest = min(np.finfo(dtype).max, np.longdouble(sys.float_info.max))
    return Arithmetic(dtype, dtype.type, pi, float(np.finfo(dtype).eps), float(largest))


def _decimal(digits):
    import mpmath

    context = mpmath.MPContext()  # one of our own: mpmath's shared precision is left alone
    context.dps = digits
    return Arithmetic(np.dtype(object), context.mpf, +context.pi, float(context.eps), sys.float_info.max)


def constant(x, value):
    """``value`` at every point x, in the numbers of x, or in floats where x holds whole numbers."""
    x = points(x)
    return np.full_like(x, value, dtype=np.result_type(x, 0.0))


def points(x):
    """x as an array of finite numbers, multiprecision ones among them, or one sentence why not."""
    if isinstance(x, np.ndarray) and x.dtype == object and all(hasattr(z, "context") for z in x.flat):
        return x
    return real_array("x", x)


def sin(x):
    """sin x, element by element, also for arrays of multiprecision numbers."""
    x = points(x)
    return np.sin(x) if x.dtype != object else np.frompyfunc(lambda z: z.context.sin(z), 1, 1)(x)


def cos(x):
    """cos x, element by element, also for arrays of multiprecision numbers."""
    x = points(x)
    return np.cos(x) if x.dtype != object else np.frompyfunc(lambda z: z.context.cos(z), 1, 1)(x)
