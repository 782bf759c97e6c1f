"""Any evolution equation in one space variable, with data: a text becomes a problem that can be marched."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np

from primer.arithmetic import points
from primer.checks import real, shown
from primer.equations.evaluate import Known, Scalars, known, tendencies, value
from primer.equations.latex import latex
from primer.equations.slopes import Linearisation, linearised
from primer.equations.stages import Evolution, evolution
from primer.equations.text import PDEError, understand
from primer.equations.variables import canonical
from primer.problems.data import Datum, data, is_function, names, on
from primer.types import ArrayLike, Derivative

_OWN = ("text", "initial", "steady", "period", "space", "time", "self")  # what PDE(...) itself calls its arguments
_MEANING = ("x", "y", "t", "i", "pi")


@dataclass(frozen=True, init=False, repr=False)
class PDE:
    """Equations of the first order in time, or made so, on x in [-period/2, period/2), with data (dimensionless).

    Parameters
    ----------
    text : str      equations as for ``primer verdict``, such as "u_t = nu*u_xx - (u^2/2)_x", solved for the highest
                    time derivatives. A differentiated bracket is differenced as it is written: in conservation form.
                    Coefficients may depend on x and t, and be complex
    initial         {field: what it is at t = 0}: a text in x and the parameters, a number, a function of x, or samples
                    on the grid -period/2 + j h of as many points, whose trigonometric interpolant (in double precision)
                    serves other grids. A second time derivative makes a field of the first: {"u": ..., "u_t": ...}
    steady          the same for the state from which Dist is measured; left out, that is the initial data
    period          the period in x; all boundaries are periodic. A float that is k math.pi stands for k pi
    space, time     what the texts call their variables, such as "r" and "tau"; by default x and t
    parameters      a number, real or complex, for each other name in the texts; for a function f(u) of the equations a
                    text such as "u^3 - u" or a function of Python

    Raises
    ------
    PDEError                 for a text that cannot be used; equations that can be judged, not marched (constraints,
                             mixed time derivatives such as u_xt, a second space variable); a name without a value, a
                             value without a name, a field without data, data without a field
    TypeError, ValueError    in one sentence, for data or values that are not as above

    The form that is frozen in section A2.1; eq. (toy-pde) is

    >>> toy = PDE(
    ...     "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)",
    ...     initial={"u": "a", "v": "-sin(x)/2"}, steady={"u": "a - cos(x)", "v": "0"}, a=0.5, eps=0.01,
    ... )
    >>> print(toy.fields, toy.dist_from, toy.parameters)
    ('u', 'v') steady {'a': 0.5, 'eps': 0.01}
    >>> eval(repr(toy)) == toy
    True
    """

    text: str
    start: tuple[tuple[str, Datum], ...]
    end: tuple[tuple[str, Datum], ...] | None
    period: float
    values: tuple[tuple[str, float | complex], ...]
    space: str | None
    time: str | None
    functions: tuple[tuple[str, Any], ...]
    is_complex: bool

    def __init__(
        self,
        text: str,
        initial: Mapping[str, Any],
        *,
        steady: Mapping[str, Any] | None = None,
        period: float = 2 * math.pi,
        space: str | None = None,
        time: str | None = None,
        **parameters: Any,
    ) -> None:
        parameters = {canonical(name): value for name, value in parameters.items()}  # nu is ν
        for name in parameters:
            if name in _MEANING:
                raise PDEError(f"{name} has a meaning of its own and cannot be a parameter")
        functions = {name: given for name, given in parameters.items() if is_function(given)}
        values = tuple((name, _number(name, parameters[name])) for name in sorted(parameters.keys() - functions.keys()))
        put = partial(object.__setattr__, self)
        put("text", text)
        put("values", values)
        put("space", space)
        put("time", time)
        put("functions", tuple(sorted(functions.items())))
        put("period", real("period", period, above=0, most=1e100))
        put("start", data("initial", self.fields, initial))
        put("end", None if steady is None else data("steady", self.fields, steady))
        self._check_names()
        grid = -self.period / 2 + self.period / 8 * np.arange(8)
        self._numbers()
        given = (*self.initial(grid), *self.steady(grid), *(number for _, number in values))
        put("is_complex", self.evolution.imaginary or any(map(np.iscomplexobj, given)))

    def _check_names(self):
        given = dict(self.values)
        both = self.start + (self.end or ())
        told = (name for _, datum in both for name in names(datum, self.fields, self._source))
        wanted = dict.fromkeys((*self.evolution.parameters, *told))
        for name in wanted:
            if name in _OWN:
                raise PDEError(f"{name} is what an argument is called and cannot be a parameter: choose another name")
        missing = [name for name in wanted if name not in given]
        if missing:
            name = self._source.outside(missing[0]) if self._source else missing[0]
            raise PDEError(f"{name} has no value: give it one, as in PDE(..., {name}=1.0)")
        for name in given:
            if name not in wanted:
                why = "is a field, with data of its own" if name in self.fields else "occurs in no equation and no data"
                raise PDEError(f"{shown(name)} has a value but {why}")

    def _numbers(self):
        """The constants of the equations in double precision, once it is known that they are numbers."""
        with np.errstate(all="ignore"):
            found = [value(term, Scalars(np.dtype(float)), self.parameters) for term in self.evolution.constants]
        if not np.isfinite(found).all():
            raise PDEError(f"parameters must leave the constants in the text finite, got {shown(self.parameters)}")
        if any(found[k] == 0 for k in self.evolution.divisors):
            raise PDEError(f"parameters must not lead to a division by zero, got {shown(self.parameters)}")
        return found

    @cached_property
    def evolution(self) -> Evolution:
        """The right-hand side as stages, made from the text."""
        return evolution(self.text, tuple(name for name, _ in self.values), *self._told)

    @property
    def _told(self):
        return self.space, self.time, self.functions

    @cached_property
    def _source(self):
        """What knows how the texts call x; None if they call it x."""
        declared = self.space is not None or self.time is not None
        return understand(self.text, self.space, self.time, (), (), dict(self.functions)) if declared else None

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of the fields; u_t is one where u_tt occurs."""
        return self.evolution.fields

    @property
    def parameters(self) -> dict[str, float | complex]:
        """Parameters and values."""
        return dict(self.values)

    @property
    def dist_from(self) -> str:
        """From what Dist is measured: "steady" or, if no steady state was given, "initial"."""
        return "initial" if self.end is None else "steady"

    @property
    def autonomous(self) -> bool:
        """Whether t does not occur in the equations."""
        return self.evolution.autonomous

    def initial(self, x: ArrayLike) -> tuple[np.ndarray, ...]:
        """The fields at t = 0; x of any shape, in any numbers."""
        return self._on("initial", self.start, x)

    def steady(self, x: ArrayLike) -> tuple[np.ndarray, ...]:
        """The fields from which Dist is measured: the steady state, or else the initial data."""
        return self._on(self.dist_from, self.end or self.start, x)

    def _on(self, name, given, x):
        x = points(x)
        return tuple(
            on(f"{name} {field}", datum, x, self.period, self.parameters, self._source) for field, datum in given
        )

    def forcing(self, x: ArrayLike) -> Known:
        """What the right-hand side needs of the parameters and of x alone, so that a time loop computes it once."""
        return self.known(x)

    def known(self, x: ArrayLike) -> Known:
        """The same, under the name that all problems made from texts have for it."""
        return known(self.evolution, points(x), self.parameters)

    def rhs(
        self,
        x: ArrayLike,
        state: Sequence[np.ndarray],
        derivative: Derivative,
        forcing: Known | None = None,
        t: Any = 0.0,
    ) -> tuple[np.ndarray, ...]:
        """The time derivatives of the fields, in the order of operations of the text.

        ``derivative(f, m)`` gives the m-th x-derivative of an array on x; ``forcing`` is ``self.forcing(x)``, where it
        is at hand.
        """
        given = self.forcing(x) if forcing is None else forcing
        return tendencies(self.evolution, self.parameters, state, derivative, given, t)

    def linearised(
        self,
        x: ArrayLike,
        state: Sequence[np.ndarray],
        derivative: Derivative,
        forcing: Known | None = None,
        t: Any = 0.0,
    ) -> Linearisation:
        """The linearised right-hand side about a state on x: as an operator, a matrix, and frozen, a symbol."""
        given = self.forcing(x) if forcing is None else forcing
        return linearised(self.evolution, self.parameters, state, derivative, given, t)

    def latex(self) -> tuple[str, ...]:
        """The equations as LaTeX."""
        return latex(self.text, *self._told)

    def replace(self, **changes: Any) -> PDE:
        """The same problem with other values of parameters; also of ``initial``, ``steady`` and ``period``."""
        kept: dict[str, Any] = {"initial": dict(self.start), "steady": self.end and dict(self.end)}
        kept |= {"period": self.period, "space": self.space, "time": self.time, **dict(self.functions)}
        for name in changes:
            if name not in kept and name not in self.parameters:
                raise PDEError(f"{shown(name)} is no parameter of this PDE, which has {', '.join(self.parameters)}")
        return PDE(self.text, **{**kept, **self.parameters, **changes})

    def __repr__(self) -> str:
        parts = [repr(self.text), f"initial={dict(self.start)!r}"]
        if self.end is not None:
            parts.append(f"steady={dict(self.end)!r}")
        if self.period != 2 * math.pi:
            parts.append(f"period={self.period!r}")
        parts += [f"{name}={said!r}" for name in ("space", "time") if (said := getattr(self, name)) is not None]
        parts += [f"{name}={function!r}" for name, function in self.functions]
        return f"PDE({', '.join(parts + [f'{name}={number!r}' for name, number in self.values])})"


def _number(name, given):
    if isinstance(given, (complex, np.complexfloating)):
        number = complex(given)
        if not np.isfinite(number):
            raise ValueError(f"{name} must be a finite number, got {shown(given)}")
        return number
    return real(name, given)
