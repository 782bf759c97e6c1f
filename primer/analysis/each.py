"""One answer for each of an array of base states or parameters, so that a map needs no loop."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from primer.checks import affordable, shown

STATES = 10**6  # more would take hours


class Each(np.ndarray):
    """An array of answers, of the shape that the arrays of values broadcast to, of dtype object.

    ``answers[3, 1]`` is one answer; an attribute of the answers is an array of theirs: ``answers.kind``,
    ``answers.coefficient``, ``answers.bound`` and so on, for verdicts.
    """

    def __getattr__(self, name):
        if name.startswith("_") or not self.size or not all(hasattr(answer, name) for answer in self.flat):
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        values = [getattr(answer, name) for answer in self.flat]
        if not all(isinstance(value, (bool, int, float, str)) for value in values):
            values = _boxed(values)
        return np.array(values).reshape(self.shape)


def each(at: Any, parameters: dict, answer: Callable) -> Any:
    """``answer(at, parameters)``, or where values are arrays, an :class:`Each` of the answers, of their shape."""
    at = {} if at is None else at
    if not isinstance(at, dict):
        return answer(at, parameters)
    arrays = {
        (where, name): np.asarray(value)
        for where in (0, 1)
        for name, value in (at, parameters)[where].items()
        if _is_array(value)
    }
    if not arrays:
        return answer(at, parameters)
    for (_, name), value in arrays.items():
        if value.dtype.kind not in "iufcO":
            raise TypeError(f"{name} must be a number or an array of numbers, got {shown(value)}")
    try:
        shape = np.broadcast_shapes(*(value.shape for value in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {value.shape}" for (_, name), value in arrays.items())
        raise ValueError(f"the arrays of values must fit together in shape, got {shapes}") from None
    affordable("at: one answer for each of its values", 1024 * int(np.prod(shape, dtype=float)), f"shape {shape}")
    spread = {key: np.broadcast_to(value, shape) for key, value in arrays.items()}
    found = np.empty(shape, dtype=object)
    for index in np.ndindex(*shape):
        here = ({**at}, {**parameters})
        for (where, name), value in spread.items():
            here[where][name] = value[index].item() if hasattr(value[index], "item") else value[index]
        found[index] = answer(*here)
    return found.view(Each)


def _is_array(value):
    return (isinstance(value, np.ndarray) and value.ndim > 0) or isinstance(value, (list, tuple, range))


def _boxed(values):
    boxed = np.empty(len(values), dtype=object)
    for k, value in enumerate(values):
        boxed[k] = value
    return boxed
