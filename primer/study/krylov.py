"""The modes that one step multiplies most, from products with it alone: Arnoldi's method, residuals checked.

The step is near the identity, A ~ 1 + dt J, and a slow mode that grows is hard to tell from slow ones that decay. A
power of it is not: A^m stretches the gaps m times, so m is raised until the largest Ritz pairs are eigenpairs, or time
is up: what is then still missing is said.
"""

import math

import numpy as np

_SIZE = 40  # vectors of a Krylov space
_WANTED = 4  # modes
_GOOD = 1e-2  # residual of an eigenpair of A^m, over its own growth
_FINE = 1e-4  # the same over the width of what is seen of the spectrum
_LOG = 200.0  # logarithm of the largest growth in a power
_POWERS = (1, 8, 64, 512)


def dominant(A, box):
    """(basis, slack): (N, k) columns that span the modes of the largest |factor|; how far off its logarithm may be."""
    size = int(np.prod(box.shape))
    start, largest = np.random.default_rng(6).standard_normal(size), 1.0
    found = None
    for power in _POWERS:
        slow = 2 * power * _SIZE * box.seconds > box.meter.left() / 6
        if found and (slow or power * math.log(largest) > _LOG):
            break
        basis, H = _arnoldi(A, start, power, min(_SIZE, size))
        basis = basis[:, : H.shape[1]]
        values, vectors = np.linalg.eig(H[:-1])
        order = np.argsort(-np.abs(values))[:_WANTED]
        residual = np.abs(H[-1, -1] * vectors[-1, order])
        top = abs(values[order[0]])
        width = np.abs(values - values[order[0]]).max()
        allowed = max(_GOOD * top * abs(math.log(top)), _FINE * width)
        keep = order[residual <= max(allowed, 2 * residual[0])]
        found = basis @ vectors[:, keep], float(residual[0] / top / power)
        if residual[0] < allowed:
            break
        start, largest = (basis @ vectors[:, order]).real.sum(axis=1), top ** (1 / power)
    return found


def _arnoldi(A, start, power, steps):
    basis, H = np.zeros((start.size, steps + 1)), np.zeros((steps + 1, steps))
    basis[:, 0] = start / np.linalg.norm(start)
    for i in range(steps):
        w = basis[:, i]
        for _ in range(power):
            peak = np.abs(w).max()  # a perturbation of the size that the differences were made for
            w = peak * A.complex(w / peak).real
        for _ in range(2):  # twice is enough to stay orthogonal
            overlap = basis[:, : i + 1].T @ w
            H[: i + 1, i] += overlap
            w = w - basis[:, : i + 1] @ overlap
        H[i + 1, i] = np.linalg.norm(w)
        if H[i + 1, i] <= 1e-13 * np.abs(H[: i + 1, i]).max():  # the space is invariant
            return basis[:, : i + 2], H[: i + 2, : i + 1]
        basis[:, i + 1] = w / H[i + 1, i]
    return basis, H
