"""The periodic grid, and stencils that carry their own Fourier multipliers.

``CENTRAL`` holds the stencils of the paper's scheme (section A2.2.2), ``CENTRAL_4`` and ``CENTRAL_6`` those of higher
order (Fornberg, Math. Comp. 51 (1988) 699), as tables derivative -> stencil:

>>> for table in (CENTRAL, CENTRAL_4, CENTRAL_6):
...     print(table[1].order, f"{table[1](np.sin(Grid(16).x), Grid(16).h)[8]:.6f}")  # cos 0 = 1
2 0.974495
4 0.999222
6 0.999975
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.checks import integer, real, real_array, shown
from primer.equations.terms import DERIVATIVE
from primer.schemes.weights import central
from primer.types import ArrayLike, Numbers

MAX_POINTS = 10**7  # a finer grid is refused: a single field on it would take 80 MB


@dataclass(frozen=True)
class Stencil:
    """A finite-difference approximation of the m-th derivative::

        f^(m)(x_j) ~ [sum_k weights[k] f(x_j + offsets[k] h)] / (denominator h^m)

    with an error of order h^order on smooth f. The sum is taken in the order written.
    """

    derivative: int
    order: int
    offsets: tuple[int, ...]
    weights: tuple[int, ...]
    denominator: int

    def scale(self, h: float) -> float:
        """1/(denominator h^m), the factor by which a step multiplies the weighted sum."""
        return 1 / (self.denominator * math.prod([h] * self.derivative))

    def __call__(self, f: np.ndarray, h: float) -> np.ndarray:
        """Apply it to samples f of shape (..., n) of a periodic function on a grid of spacing h."""
        reach, n = max(map(abs, self.offsets)), f.shape[-1]
        if reach <= n:
            ghosts = np.concatenate((f[..., n - reach :], f, f[..., :reach]), axis=-1)
        else:  # more than once around
            ghosts = f[..., np.arange(-reach, n + reach) % n]
        if f.dtype.kind != "c":
            return self._sum(ghosts, reach, n, h)
        found = np.empty_like(f)  # real factors are for both parts
        found.real, found.imag = (self._sum(part, reach, n, h) for part in (ghosts.real, ghosts.imag))
        return found

    def _sum(self, ghosts, reach, n, h):
        total: Any = None
        for offset, weight in zip(self.offsets, self.weights, strict=True):
            term = ghosts[..., reach + offset : reach + offset + n]
            term = term if weight == 1 else weight * term
            total = term if total is None else total + term
        return total * self.scale(h)

    def multiplier(self, xi: ArrayLike, h: float) -> Numbers:
        """What it does to e^{i xi x}: complex, of the shape of xi."""
        total = sum(w * np.exp(1j * np.asarray(xi) * o * h) for o, w in zip(self.offsets, self.weights, strict=True))
        return total * self.scale(h)


def _table(order):
    return {m: Stencil(m, order, *central(m, order)) for m in range(1, DERIVATIVE + 1)}


#: The paper's stencils, central differences of second order, for the first and the second derivative; and, as in the
#: other tables, for those up to the twelfth.
CENTRAL = {**_table(2), 2: Stencil(2, 2, (1, 0, -1), (1, -2, 1), 1)}

#: Central differences of fourth and sixth order.
CENTRAL_4, CENTRAL_6 = _table(4), _table(6)


@dataclass(frozen=True)
class Grid:
    """The periodic grid x_j = -period/2 + j h, j = 0 ... n-1, with h = period/n; a period of 2 pi if none is given.

    Raises
    ------
    TypeError, ValueError    if n is not an integer >= 4, or period not a number > 0
    """

    n: int
    period: float = 2 * math.pi

    def __post_init__(self) -> None:
        object.__setattr__(self, "n", integer("n", self.n, least=4))
        if self.n > MAX_POINTS:
            raise ValueError(f"n must be an integer <= {MAX_POINTS:.0e} to fit into memory, got {shown(self.n)}")
        object.__setattr__(self, "period", real("period", self.period, above=0))

    @property
    def h(self) -> float:
        """The spacing period/n."""
        return self.period / self.n

    @property
    def x(self) -> np.ndarray:
        """The points, of shape (n,)."""
        return -self.period / 2 + self.h * np.arange(self.n)

    def derivative(self, f: ArrayLike, m: int) -> np.ndarray:
        """The m-th derivative of f, of shape (..., n), by central differences of second order, m = 1 ... 12."""
        m = integer("m", m, least=1, most=DERIVATIVE)
        values = f if isinstance(f, np.ndarray) and f.dtype.kind == "c" else real_array("f", f)
        if values.shape[-1:] != (self.n,):
            raise ValueError(f"f must have shape (..., {self.n}) on this grid, got {values.shape}")
        return CENTRAL[m](values, self.h)

    def multiplier(self, xi: ArrayLike, m: int) -> Numbers:
        """What that derivative does to e^{i xi x}: i sin(xi h)/h for m = 1, -(4/h^2) sin^2(xi h/2) for m = 2."""
        return CENTRAL[integer("m", m, least=1, most=DERIVATIVE)].multiplier(real_array("xi", xi), self.h)


def grids(name: str, ns: Iterable[int]) -> tuple[int, ...]:
    """A tuple of grid sizes, each checked as ``Grid`` does, under the name of the argument that holds them."""
    for n in ns:
        if integer(name, n, least=4) > MAX_POINTS:
            raise ValueError(f"{name} must be integers <= {MAX_POINTS:.0e} to fit into memory, got {shown(n)}")
    return tuple(int(n) for n in ns)
