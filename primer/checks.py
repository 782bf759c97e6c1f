"""One clear sentence for bad input: the argument, what it was, and what is allowed."""

import math
import operator
from collections.abc import Callable, Iterable
from numbers import Real
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

T = TypeVar("T")
F = TypeVar("F", bound=Callable)

MAX_BYTES = 2**31  # what would need more memory than this is refused before it starts


def shown(value: object) -> str:
    """``value`` as it appears in a message, never longer than a line."""
    if isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim == 0):
        value = value.item()  # 0.61 rather than np.float64(0.61) or array(0.61)
    try:
        text = " ".join(repr(value[:60] if isinstance(value, (str, bytes, list, tuple)) else value).split())
    except ValueError:  # an int of more digits than Python prints
        text = f"an {type(value).__name__} too long to show"
    return text if len(text) <= 60 else text[:57] + "..."


def instance(name: str, value: object, kind: type[T], example: str | None = None) -> T:
    """Return ``value`` if it is of this type, or say in one sentence that it is not."""
    if not isinstance(value, kind):
        raise TypeError(f"{name} must be a {example or kind.__name__}, got {shown(value)}")
    return value


def function(name: str, value: F, of: str) -> F:
    """Return ``value`` if it can be called, or say in one sentence what it must be a function of."""
    if not callable(value):
        raise TypeError(f"{name} must be a function of {of}, got {shown(value)}")
    return value


def sequence(name: str, value: Iterable[T], of: str) -> tuple[T, ...]:
    """Return ``value`` as a tuple, or say in one sentence of what it must be a sequence."""
    if isinstance(value, (str, bytes, dict)) or not np.iterable(value):
        raise TypeError(f"{name} must be a sequence of {of}, got {shown(value)}")
    return tuple(value)


def affordable(what: str, size: float, got: str) -> None:
    """Raise ValueError if ``size`` bytes are more than ``MAX_BYTES``: the sentence names ``what`` and what was got."""
    if size > MAX_BYTES:
        raise ValueError(f"{what} must fit into {MAX_BYTES / 2**30:.0f} GiB of memory, got {got}")


def broadcast(**arrays: np.ndarray) -> tuple[np.ndarray, ...]:
    """The arrays broadcast against each other, or one sentence that says their shapes do not fit."""
    try:
        return np.broadcast_arrays(*arrays.values())
    except ValueError:
        shapes = ", ".join(f"{name} {np.shape(array)}" for name, array in arrays.items())
        raise ValueError(f"the shapes of {', '.join(arrays)} must broadcast, got {shapes}") from None


def real(
    name: str,
    value: Any,
    *,
    above: float | None = None,
    least: float | None = None,
    below: float | None = None,
    most: float | None = None,
) -> float:
    """Return ``value`` as a float, or say in one sentence why it is not an allowed number.

    ``above`` and ``below`` are strict bounds, ``least`` and ``most`` are attained ones.

    Raises
    ------
    TypeError   if it is not a real number (a bool is not one)
    ValueError  if it is not finite or lies outside the bounds
    """
    allowed = _range("a finite number", above, least, below, most)
    if not isinstance(value, (Real, np.number)) or isinstance(value, (bool, np.bool_, np.complexfloating)):
        raise TypeError(f"{name} must be {allowed}, got {shown(value)} ({type(value).__name__})")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number) or not _inside(number, above, least, below, most):
        raise ValueError(f"{name} must be {allowed}, got {shown(value)}")
    return number


def integer(name: str, value: Any, *, least: int | None = None, most: int | None = None) -> int:
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


def real_array(name: str, value: ArrayLike) -> np.ndarray:
    """Return ``value`` as a float array (of any shape) of finite numbers.

    Raises
    ------
    TypeError   if it does not hold real numbers
    ValueError  if an entry is not finite
    """
    try:
        array = np.asarray(value)
        if array.dtype == object and array.size and all(isinstance(x, int) for x in array.flat):
            array = array.astype(float)  # whole numbers beyond 64 bits
    except ValueError:  # a ragged list
        array = np.empty(0, dtype=object)
    except OverflowError:
        array = np.array(math.inf)
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
