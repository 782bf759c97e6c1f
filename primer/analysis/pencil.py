"""Frozen-coefficient symbols as matrix pencils, and the growth of the exponentials they admit (section A2.1)."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from primer.analysis.eigen import degree, finite_eigenvalues
from primer.checks import affordable, instance, integer, real_array, shown
from primer.types import ArrayLike, Numbers

_BEYOND = 1e150  # entries from here on have squares that are no numbers
LARGEST = 12  # the number of finite eigenvalues is found by an expansion of 2^k terms


@dataclass(frozen=True, eq=False)
class Pencil:
    """Perturbations q e^{i<xi, x> + lambda t} of frozen-coefficient equations: lambda E q = -S(xi) q, as in eq. (e24).

    Parameters
    ----------
    S : callable, constant array, or sympy Matrix in the symbols xi, or xi_1, xi_2 (and xi_3)
        ``S(xi)`` is the k x k symbol. In one space variable xi is a number or an array of shape s; in two, or
        three, it has its component axis *first*, shape (2,) + s, so that ``xi1, xi2 = xi`` works for one wavevector and
        for many. S returns shape s + (k, k), or nested lists whose entries are of shape s or numbers; one that can only
        serve a single wavevector is called once for each.
    E : array of shape (k, k), or a callable of xi like S
        the coefficients of the time derivatives. It may be singular: a row of zeros is a constraint (div u = 0).
    dim : int
        the number of space variables, 1, 2 or 3; left out, the least with which S can be called

    Raises
    ------
    TypeError, ValueError    if the shapes do not fit, or det(lambda E + S) vanishes identically: then the equations do
                             not determine the unknowns

    >>> heat = Pencil(lambda xi: [[xi**2]], [[1.0]], dim=1)  # u_t = u_xx
    >>> print(heat.eigenvalues(3.0).real)
    [-9.]
    """

    S: Any
    E: Any
    dim: int | None = None
    size: int = field(init=False)

    def __post_init__(self) -> None:
        for name in ("S", "E"):
            if hasattr(getattr(self, name), "free_symbols"):
                object.__setattr__(self, name, _from_sympy(name, getattr(self, name)))
        dim = _dimension(self.S) if self.dim is None else integer("dim", self.dim, least=1, most=3)
        object.__setattr__(self, "dim", dim)
        for name in ("S", "E"):
            if not callable(getattr(self, name)):
                object.__setattr__(self, name, _square(name, getattr(self, name)))
        single = _square("E", self.E(self.probe[..., 0]) if callable(self.E) else self.E)
        object.__setattr__(self, "size", len(single))
        other = _square("S", self.S(self.probe[..., 0]) if callable(self.S) else self.S)
        if other.shape != single.shape:
            raise ValueError(f"S and E must be square matrices of the same size, got {other.shape} and {single.shape}")
        if self.size > LARGEST:
            raise ValueError(f"S and E must be no larger than {LARGEST} x {LARGEST}, got {self.size} x {self.size}")
        if self.count < 0:
            raise ValueError(
                "the pencil is singular: det(lambda E + S) vanishes identically, so the equations do not determine the "
                "unknowns"
            )

    @property
    def probe(self) -> np.ndarray:
        """Wavevectors in general position, more of them than the matrices can be wide."""
        j = np.arange(1, 14)
        xi = [1.1 + 0.37 * np.sin(2.3 * j), -0.7 + 0.41 * np.cos(1.7 * j), 0.9 - 0.31 * np.sin(1.3 * j)]
        return xi[0] if self.dim == 1 else np.stack(xi[: self.dim])

    @cached_property
    def count(self) -> int:
        """The number of finite eigenvalues at wavevectors in general position."""
        S, E = self.matrices(self.probe[..., :3])
        return max(degree(s, e) for s, e in zip(S, E, strict=True))

    @cached_property
    def is_real(self) -> bool:
        """Whether the equations have real coefficients: S(-xi) is the conjugate of S(xi), and E likewise."""
        plus, minus = self.matrices(self.probe), self.matrices(-self.probe)
        return all(np.allclose(a, b.conj(), rtol=1e-12, atol=0) for a, b in zip(plus, minus, strict=True))

    @cached_property
    def _vectorised(self):
        functions = {name: f for name in ("S", "E") if callable(f := getattr(self, name))}
        return {name: _serves_many(f, self.probe) for name, f in functions.items()}

    def matrices(self, xi: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """(S, E) at wavevectors xi of shape s, or (dim,) + s: complex arrays of shape s + (k, k)."""
        xi = self.wavevectors(xi)
        shape = xi.shape if self.dim == 1 else xi.shape[1:]
        flat = xi.reshape(-1) if self.dim == 1 else xi.reshape(len(xi), -1)
        affordable("xi: the matrices of all wavevectors", 128 * flat.shape[-1] * self.size**2, f"shape {xi.shape}")
        with np.errstate(all="ignore"):
            S, E = (self._values(name, flat).reshape(*shape, self.size, self.size) for name in ("S", "E"))
        if not (_moderate(S) and _moderate(E)):
            raise ValueError(f"xi must leave S and E finite, and below {_BEYOND:g}, got {shown(xi)}")
        return S, E

    def wavevectors(self, xi: ArrayLike) -> np.ndarray:
        """xi as a float array, its shape checked."""
        xi = real_array("xi", xi)
        if self.dim != 1 and (xi.ndim == 0 or len(xi) != self.dim):
            number = "two" if self.dim == 2 else "three"
            raise ValueError(f"xi must have shape ({self.dim}, ...) for {number} space variables, got shape {xi.shape}")
        return xi

    def _values(self, name, xi):
        f, n = getattr(self, name), xi.shape[-1]
        if not callable(f):
            return np.broadcast_to(f, (n, *f.shape))
        if self._vectorised[name]:
            return _together(f, xi)
        values = [np.asarray(f(xi[..., j]), dtype=complex) for j in range(n)]
        return np.array(values).reshape(n, self.size, self.size)

    def eigenvalues(self, xi: ArrayLike) -> np.ndarray:
        """The finite eigenvalues lambda at xi of shape s, or (2,) + s.

        Returns
        -------
        complex array of shape s + (count,), sorted by decreasing real part. Small eigenvalues are as accurate as large
        ones, relative to what rounding of S's entries allows. Where a wavevector has fewer (or leaves some unknown
        undetermined, as xi = 0 does for a pressure) the places at the end (or all) are nan.
        """
        S, E = self.matrices(xi)
        lam = finite_eigenvalues(S.reshape(-1, *S.shape[-2:]), E.reshape(-1, *E.shape[-2:]), self.count)
        order = np.argsort(np.where(np.isnan(lam.real), np.inf, -lam.real), axis=-1, kind="stable")
        return np.take_along_axis(lam, order, axis=-1).reshape(*S.shape[:-2], self.count)


def growth(pencil: Pencil, xi: ArrayLike) -> Numbers:
    """The growth rate max Re lambda over the finite eigenvalues, at xi of shape s or (2,) + s: shape s.

    -inf if there is none (no equation contains a time derivative).

    The quantity of eq. (cond-well-p).

    >>> backward_heat = Pencil(lambda xi: [[-(xi**2)]], [[1.0]], dim=1)
    >>> print(growth(backward_heat, [1.0, 10.0]))
    [  1. 100.]
    """
    instance("pencil", pencil, Pencil, "Pencil (for equations as text there is growth_rates)")
    lam = pencil.eigenvalues(xi)
    return lam[..., 0].real if pencil.count else np.full(lam.shape[:-1], -np.inf)


def _dimension(S):
    """The least dimension in which S can be called: 1, unless it cannot with a number but can with two or three."""
    for dim, xi in ((1, np.float64(1.1)), (2, np.array([1.1, -0.7])), (3, np.array([1.1, -0.7, 0.9]))):
        try:
            if callable(S):
                S(xi)
        except Exception:  # S is somebody's function: whatever it makes of a number it was not written for
            continue
        return dim
    return 1  # whose call will say what is wrong


def _from_sympy(name, matrix):
    """A sympy matrix in xi, or in xi_1, xi_2, xi_3, as a function of one wavevector; an array if it is constant."""
    import sympy

    matrix = matrix.subs({symbol: sympy.Symbol(symbol.name) for symbol in matrix.free_symbols})  # without assumptions
    names = sorted(symbol.name for symbol in matrix.free_symbols)
    if not names:
        return np.array(matrix.tolist(), dtype=complex)
    if set(names) <= {"xi"}:
        return sympy.lambdify(sympy.Symbol("xi"), matrix.tolist(), "numpy")
    if set(names) <= {"xi_1", "xi_2", "xi_3"}:
        two, three = (sympy.lambdify(sympy.symbols(f"xi_1:{n}"), matrix.tolist(), "numpy") for n in (3, 4))
        return lambda xi: (two if len(xi) == 2 and "xi_3" not in names else three)(*xi)
    raise ValueError(f"{name} must be a matrix in xi, or in xi_1, xi_2, xi_3, alone, got symbols {', '.join(names)}")


def _square(name, value):
    try:
        value = np.asarray(value, dtype=complex)
    except (TypeError, ValueError):
        raise TypeError(f"{name} must give a matrix of numbers, got {type(value).__name__}") from None
    if value.ndim != 2 or value.shape[0] != value.shape[1] or not value.size:
        raise ValueError(f"{name} must give one square matrix for one wavevector, got shape {value.shape}")
    if not np.isfinite(value).all():
        raise ValueError(f"{name} must be finite everywhere, got {shown(value)}")
    return value


def _moderate(values):
    return bool((np.abs(values) < _BEYOND).all())


def _together(f, xi):
    """What f gives for many wavevectors at once; in nested lists each entry is a number, or an array of them."""
    value = f(xi)
    if not isinstance(value, (list, tuple)):
        return np.asarray(value, dtype=complex)
    entries = [[np.broadcast_to(np.asarray(x, dtype=complex), xi.shape[-1:]) for x in row] for row in value]
    return np.moveaxis(np.array(entries), -1, 0)


def _serves_many(f, xi):
    """Whether f gives the same matrices for many wavevectors at once as one by one."""
    one_by_one = np.array([np.asarray(f(xi[..., j]), dtype=complex) for j in range(xi.shape[-1])])
    try:
        together = _together(f, xi)
    except Exception:  # any complaint of a function written for one wavevector
        return False
    return together.shape == one_by_one.shape and np.allclose(together, one_by_one, rtol=1e-12, atol=0)
