"""One clear sentence for bad input: the argument, what it was, and what is allowed."""

import math
import operator
from numbers import Real

import numpy as np


def shown(value):
    """``value`` as it appears in a message, never longer than a line."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def real(name, value, *, above=None, least=None, below=None, most=None):
    """Return ``value`` as a float, or say in one sentence why it is not an allowed number.

    ``above`` and ``below`` are strict bounds, ``least`` and ``most`` are attained ones.

    Raises
    ------
    TypeError   if it is not a real number (a bool is not one)
    ValueError  if it is not finite or lies outside the bounds
    """
    allowed = _range("a finite number", above, least, below, most)
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (Real, np.number)) or np.iscomplexobj(value):
        raise TypeError(f"{name} must be {allowed}, got {shown(value)} ({type(value).__name__})")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number) or not _inside(number, above, least, below, most):
        raise ValueError(f"{name} must be {allowed}, got {shown(value)}")
    return number


def integer(name, value, *, least=None, most=None):
    """Return ``value`` as an int, or say in one sentence why it is not an allowed integer.

    Raises
    ------
    TypeError   if it is not an integer (2.0 is not one, nor is True)
    ValueError  if it lies outside the bounds
    """
    allowed = _range("an integer", None, least, None, most)
    try:
        if isinstance(value, (bool, np.bool_)):
            raise TypeError
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be {allowed}, got {shown(value)} ({type(value).__name__})") from None
    if not _inside(number, None, least, None, most):
        raise ValueError(f"{name} must be {allowed}, got {shown(value)}")
    return number


def real_array(name, value):
    """Return ``value`` as a float array (of any shape) of finite numbers.

    Raises
    ------
    TypeError   if it does not hold real numbers
    ValueError  if an entry is not finite
    """
    try:
        array = np.asarray(value)
    except ValueError:  # a ragged list
        array = np.empty(0, dtype=object)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name} must be a number or an array of numbers, got {shown(value)}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} must be finite everywhere, got {shown(value)}")
    return array.astype(float) if array.dtype.kind != "f" else array


def _inside(number, above, least, below, most):
    return (
        (above is None or number > above)
        and (least is None or number >= least)
        and (below is None or number < below)
        and (most is None or number <= most)
    )


def _range(kind, above, least, below, most):
    signs = (">", above), (">=", least), ("<", below), ("<=", most)
    bounds = [f"{sign} {bound:g}" for sign, bound in signs if bound is not None]
    return " ".join([kind, " and ".join(bounds)]).strip()
