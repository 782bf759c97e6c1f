"""An exponential step: the stiff linear part of any equation that is a text is marched exactly, mode by mode.

With Fourier modes v of the fields, L the constant-coefficient part of the right-hand side and N = f - L v the rest::

    v' = L v + N(v, t)

Steps are then limited by N alone. L comes from the text's tree: its linearisation about the initial data, each slope
replaced by its mean over x; whatever L is, N makes up for it, so that only speed and stability depend on the choice.

A hundred steps (Cox & Matthews 2002), each four hundred times the largest that RK4 could take:

>>> from primer import FOURIER, PDE, march_lines
>>> pde = PDE("u_t = -u_xxxx - u_xx - u*u_x", {"u": "cos(x)/4"}, period=32)  # Kuramoto and Sivashinsky
>>> end = march_lines(pde, 128, 0.05, 5.0, FOURIER, ETDRK4)
>>> end.blew_up
False
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from primer.equations.slopes import Linearisation, linearised
from primer.schemes.by_transforms import slope_by_transforms
from primer.schemes.marching import grid_of

_CIRCLE = 64  # points on the circle; 32 give full accuracy to Kassam and Trefethen, and the work is done once a march


@dataclass(frozen=True)
class Exponential:
    """A step that marches the linear constant-coefficient part exactly; it needs ``FOURIER`` and a problem with a text.

    Attributes
    ----------
    order    the order of accuracy: an error of dt^order over a fixed time, once dt resolves what is not in L
    """

    name: str
    order: int


#: The exponential time differencing step of fourth order by Cox & Matthews, J. Comput. Phys. 176 (2002), eqs. 26-29,
#: with coefficients as in Kassam & Trefethen, SIAM J. Sci. Comput. 26 (2005): means over a circle about each
#: eigenvalue, so that nothing cancels; for systems, whose L is a matrix for each mode, from one matrix exponential.
ETDRK4 = Exponential("ETDRK4", 4)


def exponential_march(problem, x, y, space, time, dt, begin, counts, limit, states, depth, tell):
    """Fill ``states`` and ``depth`` as ``lines.trace`` has them, from the state y of shape (fields, n)."""
    from scipy import fft

    is_complex, n, deep, made = y.dtype.kind == "c", x.size, 0.0, 0
    there, back = (fft.fft, fft.ifft) if is_complex else (fft.rfft, fft.irfft)
    with np.errstate(all="ignore"):
        L = linear_part(problem, x, y, space, begin[0] if len(begin) else 0.0)
        slope, v = slope_by_transforms(problem, x, space, is_complex), there(y)

        def times(matrices, w):
            return np.einsum("kij,jk->ik", matrices, w) if len(y) > 1 else matrices[:, 0, 0] * w

        def rest(w, t):
            now = back(w, n)
            if not np.abs(now).max() <= limit:
                return np.full_like(w, np.nan)
            return there(slope(now, t)) - times(L, w)

        for m, count in enumerate(counts):
            h = dt[m]
            if count:
                E, E2, Q, f1, f2, f3 = coefficients(L, h)
            for step in range(count):
                t = begin[m] + step * dt[m]
                deep -= h * min(0.0, y[0].real.min())
                now = rest(v, t)
                half = times(E2, v)
                a = half + times(Q, now)
                at_a = rest(a, t + h / 2)
                b = half + times(Q, at_a)
                at_b = rest(b, t + h / 2)
                c = times(E2, a) + times(Q, 2 * at_b - now)
                v = times(E, v) + times(f1, now) + times(f2, 2 * (at_a + at_b)) + times(f3, rest(c, t + h))
                y = back(v, n)
                if not np.abs(y).max() <= limit:
                    return
                if (made := made + 1) % 100 == 0:
                    tell(made)
            states[m], depth[m] = y, deep


def linear_part(problem: Any, x: np.ndarray, y: np.ndarray, space: Any, t: float = 0.0) -> np.ndarray:
    """(modes, F, F): L for each Fourier mode of F fields, real data having the modes 0 ... n/2 alone.

    Slopes that are not finite somewhere, such as that of sqrt at 0, are left to the rest.
    """
    h, n = grid_of(problem, x.size).h, x.size

    def derivative(f, m):
        return space[m](f, h)

    given = problem.known(x)
    try:
        slopes = linearised(problem.evolution, problem.parameters, y, derivative, given, t).slopes
    except ValueError:  # |u| of a complex u has no slope
        stages = problem.evolution.stages
        slopes = tuple(tuple(_linear(term, given.constants) for term in stage.values) for stage in stages)
    means = tuple(tuple({slot: _mean(c) for slot, c in of.items()} for of in stage) for stage in slopes)
    unit = np.zeros(n)
    unit[0] = 1.0
    modes = np.arange(n if y.dtype.kind == "c" else n // 2 + 1)
    found = Linearisation(problem.evolution, means).symbol(lambda m: np.fft.fft(derivative(unit, m))[modes])
    return np.array(np.broadcast_to(found, (modes.size, *found.shape[-2:])))


def _linear(term, constants):
    """{slot: slope} of the summands of a term that are constants times slots."""
    if not term.operands:
        return {term.value: 1.0} if term.kind == "slot" else {}
    parts = [_linear(operand, constants) for operand in term.operands]
    if term.kind == "neg":
        return {slot: -c for slot, c in parts[0].items()}
    if term.kind in ("+", "-"):
        found, sign = dict(parts[0]), -1 if term.kind == "-" else 1
        for slot, c in parts[1].items():
            found[slot] = found.get(slot, 0) + sign * c
        return found
    for own, other in ((0, 1), (1, 0)):
        if term.kind == "*" or (term.kind, own) == ("/", 0):
            factor = term.operands[other]
            if factor.kind == "constant":
                c = constants[factor.value]
                c = 1 / c if term.kind == "/" else c
                return {slot: c * slope for slot, slope in parts[own].items()}
    return {}


def _mean(slope):
    mean = np.mean(slope)
    return mean if np.isfinite(mean) else 0.0


def coefficients(L: np.ndarray, h: float) -> tuple[np.ndarray, ...]:
    """(E, E2, Q, f1, f2, f3) of the step h for matrices L of shape (modes, F, F), each of that shape.

    With phi_0 = e^z and phi_{k+1} = (phi_k - 1/k!)/z: E = phi_0(hL), E2 = phi_0(hL/2), Q = h/2 phi_1(hL/2),
    f1 = h (phi_1 - 3 phi_2 + 4 phi_3), f2 = h (phi_2 - 2 phi_3), f3 = h (4 phi_3 - phi_2), all three at hL.
    """
    phi = _on_circles if L.shape[-1] == 1 else _by_exponential
    E, one, two, three = phi(h * L)
    E2, half, *_ = phi(h / 2 * L)
    return E, E2, h / 2 * half, h * (one - 3 * two + 4 * three), h * (two - 2 * three), h * (4 * three - two)


def _on_circles(z):
    """phi_0 ... phi_3 of numbers: an analytic function is its mean over a circle about each."""
    around = z[..., None] + np.exp(2j * np.pi * (np.arange(_CIRCLE) + 0.5) / _CIRCLE)
    found = [np.exp(around)]
    for one_over_factorial in (1.0, 1.0, 0.5):
        found.append((found[-1] - one_over_factorial) / around)
    return [np.exp(z), *(phi.mean(axis=-1) for phi in found[1:])]


def _by_exponential(A):
    """phi_0 ... phi_3 of matrices: the first row of blocks of the exponential of [[A, 1, 0, 0], [0, 0, 1, 0], ...]."""
    from scipy.linalg import expm

    size = A.shape[-1]
    whole = np.zeros((len(A), 4 * size, 4 * size), dtype=complex)
    whole[:, :size, :size] = A
    for k in range(3):
        whole[:, k * size : (k + 1) * size, (k + 1) * size : (k + 2) * size] = np.eye(size)
    row = expm(whole)[:, :size]
    return [row[:, :, k * size : (k + 1) * size] for k in range(4)]
