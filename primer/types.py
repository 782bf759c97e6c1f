"""What annotations mean here: numbers or arrays, and what a problem, a friction or a law of one's own must have."""

from collections.abc import Callable, Sequence
from typing import Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

#: A number, or an array of the shape that the arguments broadcast to: which of the two, a type checker cannot know.
Numbers: TypeAlias = Any

#: One array for each field of a problem.
Fields: TypeAlias = tuple[np.ndarray, ...]

#: ``derivative(f, m)`` is the m-th x-derivative of a field, ``multiplier(xi, m)`` what that does to e^{i xi x}.
Derivative: TypeAlias = Callable[[np.ndarray, int], np.ndarray]
Multiplier: TypeAlias = Callable[[np.ndarray, int], Numbers]


class SympyEquation(Protocol):
    """An equation of sympy, such as ``Eq(u.diff(t), u.diff(x, 2))``."""

    @property
    def lhs(self) -> Any: ...

    @property
    def rhs(self) -> Any: ...


class Problem(Protocol):
    """What can be marched: a ``PDE``, a ``Toy``, a ``BackwardHeat``, or any object with these methods.

    It may say more of itself: a ``period`` other than 2 pi; ``autonomous = False`` if its ``rhs`` takes the time as a
    last argument; ``is_complex = True`` if its fields are complex.
    """

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of the fields."""

    def initial(self, x: Any, /) -> Fields:
        """The fields at t = 0."""

    def steady(self, x: Any, /) -> Fields:
        """The steady state from which Dist is measured."""

    def forcing(self, x: Any, /) -> Any:
        """What the right-hand side needs of x alone; computed once."""

    def rhs(self, x: Any, state: Any, derivative: Derivative, forcing: Any, /) -> Sequence[np.ndarray]:
        """The time derivatives of the fields."""


class FrictionLaw(Protocol):
    """A friction as a function of the inertial number, with its derivative."""

    @property
    def mu(self) -> Callable[[Any], Numbers]:
        """mu(I)."""

    @property
    def dmu(self) -> Callable[[Any], Numbers]:
        """mu'(I)."""


class Law(Protocol):
    """A rheology: yield stress Y(p, phi, I), dilatancy f(p, phi, I), and their partial derivatives."""

    def Y(self, p: Any, phi: Any, I: Any, /) -> Numbers:
        """The yield stress."""

    def Y_p(self, p: Any, phi: Any, I: Any, /) -> Numbers:
        """dY/dp."""

    def Y_phi(self, p: Any, phi: Any, I: Any, /) -> Numbers:
        """dY/dphi."""

    def Y_I(self, p: Any, phi: Any, I: Any, /) -> Numbers:
        """dY/dI."""

    def f(self, p: Any, phi: Any, I: Any, /) -> Numbers:
        """The dilatancy."""

    def f_p(self, p: Any, phi: Any, I: Any, /) -> Numbers:
        """df/dp."""

    def f_phi(self, p: Any, phi: Any, I: Any, /) -> Numbers:
        """df/dphi."""

    def f_I(self, p: Any, phi: Any, I: Any, /) -> Numbers:
        """df/dI."""


class HasCriticalState(Protocol):
    """A law that shears without a change of volume at one pressure for each solids fraction."""

    def p_critical(self, phi: Any, I: Any, /) -> Numbers:
        """That pressure."""


__all__ = [
    "ArrayLike",
    "DTypeLike",
    "Derivative",
    "Fields",
    "FrictionLaw",
    "HasCriticalState",
    "Law",
    "Multiplier",
    "Numbers",
    "Problem",
]
