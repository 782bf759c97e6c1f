"""What the fields of a ``PDE`` start from or settle to: texts in x and parameters, numbers, samples, functions of x."""

import math
from collections.abc import Callable, Mapping
from numbers import Number
from typing import Any, TypeAlias

import numpy as np

from primer.checks import shown
from primer.equations.evaluate import Scalars, value
from primer.equations.terms import Builder
from primer.equations.text import PDEError, Source, parse_expression, split_name
from primer.equations.variables import canonical

#: A text, a number, a tuple of samples on a grid of that many points, or a function of x.
Datum: TypeAlias = str | float | complex | tuple | Callable


def data(name: str, fields: tuple[str, ...], given: Any) -> tuple[tuple[str, Datum], ...]:
    """((field, datum), ...) in the order of the fields, from a dict; ``name`` is the argument's."""
    if not isinstance(given, Mapping):
        raise TypeError(f"{name} must be a dict of the fields' data such as {{'u': 'sin(x)'}}, got {shown(given)}")
    given = {canonical(field) if isinstance(field, str) else field: datum for field, datum in given.items()}
    missing = [field for field in fields if field not in given]
    if missing:
        raise PDEError(f"{name} must have data for {', '.join(fields)}, got none for {', '.join(missing)}")
    extra = [shown(field) for field in given if field not in fields]
    if extra:
        raise PDEError(f"{name} must have data for {', '.join(fields)} only, got some for {', '.join(extra)}")
    return tuple((field, _datum(f"{name} {field}", given[field])) for field in fields)


def _datum(name, given):
    if isinstance(given, str) or callable(given):
        return given
    try:
        array = np.asarray(given if np.iterable(given) or isinstance(given, (Number, np.number)) else None)
    except ValueError:  # a ragged list
        array = np.array(None)
    if array.dtype.kind not in "iufc" or array.ndim > 1 or isinstance(given, (set, dict)):
        raise TypeError(
            f"{name} must be a text, a number, a sequence of samples or a function of x, got {shown(given)}"
        )
    if not np.isfinite(array).all():
        raise ValueError(f"{name} must be finite, got {shown(given)}")
    array = array.astype(complex if array.dtype.kind == "c" else float)
    if array.ndim and array.size < 4:
        raise ValueError(f"{name} must be samples on at least 4 points, got {array.size}")
    return tuple(array.tolist()) if array.ndim else array.item()


def is_function(given: Any) -> bool:
    """Whether a value by keyword is a function, as a text or of Python, and no number."""
    return callable(given) or (isinstance(given, str) and any(map(str.isalpha, given)))


def names(datum: Datum, fields: tuple[str, ...], source: Source | None = None) -> tuple[str, ...]:
    """The parameters that occur in a datum, a text in the variables of ``source``."""
    return tuple(_term(datum, fields, source)[1]) if isinstance(datum, str) else ()


def _term(text, fields=(), source=None):
    node = parse_expression(text, source)

    def field(base, letters, node):
        raise PDEError(f"{base} is a field: data are texts in x and parameters", text, node.place)

    builder = Builder(text, {split_name(name)[0] for name in fields}, field)
    term = builder.build(node)
    if _has(term, "t"):
        raise PDEError(f"t has no place in the data {shown(text)}, which are those of one time")
    return term, builder.parameters


def _has(term, kind):
    return term.kind == kind or any(_has(operand, kind) for operand in term.operands)


def on(
    name: str,
    datum: Datum,
    x: np.ndarray,
    period: float,
    parameters: Mapping[str, Any],
    source: Source | None = None,
) -> np.ndarray:
    """A datum at the points x, in the numbers of x; complex where it is so.

    Raises
    ------
    ValueError    if it is not finite there, or a function gives something else than a number for each x
    """
    scalars = Scalars.of(x)
    if isinstance(datum, tuple):
        found: Any = _sampled(datum, x, period, scalars)
    elif isinstance(datum, str):
        with np.errstate(all="ignore"):
            found = value(_term(datum, (), source)[0], scalars, parameters, x=x)
    else:
        found = _called(name, datum, x) if callable(datum) else datum
    found = np.asarray(found)
    if found.dtype.kind not in "biufcO" or found.shape not in ((), x.shape):
        raise ValueError(f"{name} must give a number for each x, got {shown(found)} of shape {found.shape}")
    if found.dtype.kind != "O" or x.dtype != object:
        found = found.astype(np.result_type(scalars.dtype, 1j) if found.dtype.kind == "c" else scalars.dtype)
    found = np.broadcast_to(found, x.shape).copy()
    finite = np.isfinite(found) if found.dtype != object else np.array([abs(z) < math.inf for z in found.flat])
    if not finite.all():
        bad = x.flat[int(np.argmin(finite))]
        raise ValueError(f"{name} must be finite everywhere, got {shown(datum)}, which is not at x = {float(bad):.6g}")
    return found


def _called(name, datum, x):
    try:
        return datum(x)
    except Exception as error:
        problem = f"{type(error).__name__}: {error}"
    raise ValueError(f"{name} must be a function of an array of x, but it raised {shown(problem)}")


def _sampled(samples, x, period, scalars):
    """The trigonometric interpolant of samples on the grid -period/2 + j h; at the grid itself the samples."""
    n, values = len(samples), np.array(samples)
    place = (np.array(x, dtype=float) + period / 2) * (n / period)
    nearest = np.rint(place)
    if (np.abs(place - nearest) < (1e-5 if x.dtype == np.float32 else 1e-9)).all():
        found = values[nearest.astype(int) % n]
    else:
        waves, amplitudes = np.fft.fftfreq(n, 1 / n), np.fft.fft(values) / n
        angle = 2 * math.pi / n * place.ravel()
        pieces = np.array_split(angle, max(1, angle.size * n // 2**22))  # of 64 MB at most
        found = np.concatenate([np.exp(1j * np.multiply.outer(piece, waves)) @ amplitudes for piece in pieces])
        if n % 2 == 0:  # the sawtooth is a cosine
            found += amplitudes[n // 2] * (np.cos(n / 2 * angle) - np.exp(-0.5j * n * angle))
        found = (found if values.dtype.kind == "c" else found.real).reshape(x.shape)
    return found if scalars.context is None else np.frompyfunc(scalars.number, 1, 1)(found)
