"""The finite eigenvalues of lambda E q = -S q, many pencils at once, to full relative accuracy.

A library solver (QR, QZ) is accurate relative to the largest entry: among eigenvalues of size |xi|^2 it loses
2 log10 |xi| digits of one of size one. Here its results are only starting values. Each is polished by the
Ehrlich-Aberth iteration (Newton's method on det(lambda E + S), the other roots divided out) with the determinant's
logarithmic derivative taken from a factorisation of the *equilibrated* matrix lambda E + S, whose error is relative
to each entry, however different their sizes. See Bini & Noferini, Linear Algebra Appl. 439 (2013) 1130, for the method.
"""

import numpy as np

from primer.analysis.determinant import determinant

CANCELLED = 1e-12  # relative size below which a coefficient of the determinant is only rounding
EPS = np.finfo(float).eps
TINY = 1e-150  # the square of its inverse is still a number
LEAST = 2.0**-300  # the smallest factor by which a row or column is divided: the cube of its inverse is still a number
LOST = 1e50  # an iterate this large is on its way to infinity
CIRCLE = 6  # values back that an iterate is compared with
PATIENCE = 12  # steps after which a value that has not settled is asked whether it is a zero
STEPS = 60  # Ehrlich-Aberth converges cubically; graded starting values need a few dozen steps at the very most


def finite_eigenvalues(S, E, n):
    """The n finite eigenvalues lambda of lambda E q = -S q, for a batch of pencils.

    Parameters
    ----------
    S, E : complex array of shape (N, k, k)
    n : int     the degree of det(lambda E + S) in lambda, see :func:`degree`

    Returns
    -------
    complex array of shape (N, n), in no order; nan where a pencil is singular or has fewer than n finite eigenvalues
    """
    lam = np.full((len(S), n), np.nan, dtype=complex)
    solvable = n == S.shape[-1] and (np.abs(np.linalg.det(_scaled(E)[0])) > 1e-12).all()
    regular = np.full(len(S), True) if solvable else ~_singular(S, E)
    if n:
        S, E = S[regular], E[regular]
        found = _start(S, E, n, solvable)
        lam[regular] = _told_apart(S, E, _polished(S, E, found, np.ones(found.shape, dtype=bool)))
    return lam


def degree(S, E):
    """The degree in lambda of det(lambda E + S), the number of finite eigenvalues, for one pencil; -1: it vanishes."""
    entries = [
        [{(n,): c for n, c in enumerate(pair) if c} for pair in zip(s, e, strict=True)]
        for s, e in zip(S.tolist(), E.tolist(), strict=True)
    ]
    return max((n for (n,) in determinant(entries, CANCELLED)), default=-1)


def _polished(S, E, lam, active):
    """lam after the Ehrlich-Aberth iteration, of those that are ``active`` only."""
    lost = np.zeros(lam.shape, dtype=bool)
    last = np.full(lam.shape, np.inf)
    visited: list[np.ndarray] = []
    for step_number in range(STEPS):
        rows = np.flatnonzero(active.any(axis=1))
        if not rows.size:
            break
        now = lam[rows]
        newton = _log_derivative(S[rows], E[rows], now)  # f'/f
        gap = now[:, :, None] - now[:, None, :]
        others = _inverse(gap).sum(axis=2)
        step = _inverse(newton - others) * active[rows]
        size = np.abs(step)
        settled = last[rows] <= 1e-7 * np.abs(now)
        # Near a multiple eigenvalue a step at rounding level may go anywhere: one that has grown is not taken.
        new = np.where(settled & (size > last[rows]), now, now - step)
        lost[rows] |= np.abs(new) > LOST
        lam[rows] = np.where(lost[rows], LOST * np.exp(1j * np.arange(now.shape[1])), new)
        # Stop at rounding level, or when a step no longer shrinks: a zero or a multiple eigenvalue has no better value.
        done = (size <= 2 * EPS * np.abs(now)) | (settled & (size > last[rows] / 2))
        if step_number == PATIENCE:  # a zero has no digits of its own to settle: where S is singular, it is one
            nought = _near_zero(S[rows], now)
            lam[rows] = np.where(nought & active[rows], 0, lam[rows])
            done |= nought
        # A zero among large ones, or a multiple one, may go round in a circle at rounding level for ever.
        for old in visited[-CIRCLE:]:
            done |= np.abs(lam[rows] - old[rows]) <= 2 * EPS * np.abs(lam[rows])
        active[rows] &= ~(done | lost[rows])
        visited.append(lam.copy())
        last[rows] = size
    lam[lost] = np.nan
    return lam


def _near_zero(S, lam):
    """Of each row, the smallest eigenvalue where S is singular to rounding, and that eigenvalue beside the others."""
    size = np.abs(lam)
    s = np.linalg.svd(_scaled(S)[0], compute_uv=False)
    least = size == size.min(axis=1, keepdims=True)
    return least & (s[:, -1:] <= 16 * EPS * s[:, :1]) & (size <= 1e-12 * size.max(axis=1, keepdims=True))


def _told_apart(S, E, lam):
    """lam with each value that repeats another sought again from elsewhere; if it comes back it is a double one."""
    i, j = np.tril_indices(lam.shape[1], -1)
    repeats = np.zeros(lam.shape, dtype=bool)
    np.logical_or.at(repeats.T, i, (np.abs(lam[:, i] - lam[:, j]) <= 1e-9 * np.abs(lam[:, i])).T)
    rows = repeats.any(axis=1)
    if not rows.any():
        return lam
    old, again = lam[rows], repeats[rows]
    # The others divided out, one is left to find, and almost any place will do to begin.
    away = np.where(old == 0, 1e-3 * _size(S[rows], E[rows])[:, None], old) * (
        1.37 + 0.41j * np.arange(1, old.shape[1] + 1)
    )
    new = _polished(S[rows], E[rows], np.where(again, away, old), again.copy())
    came_back = np.abs(new - old) <= np.where(old == 0, 1e-30 * np.abs(away), 1e-5 * np.abs(old))
    lam[rows] = np.where(again & ~came_back & np.isfinite(new), new, old)
    return lam


def _inverse(z):
    """1/z, or zero where z or 1/z is too large or too small to compute with."""
    size = np.abs(z)
    return np.divide(1, z, out=np.zeros_like(z), where=(size > TINY) & (size < 1 / TINY))


def _log_derivative(S, E, lam):
    """f'/f at lam of shape (N, n) for f = det(lambda E + S) = tr((lambda E + S)^-1 E); inf at a root."""
    A = lam[..., None, None] * E[:, None] + S[:, None]
    A, rows, columns = _scaled(A)
    scaled_E = rows[..., :, None] * columns[..., None, :] * E[:, None]
    try:
        return np.trace(np.linalg.solve(A, scaled_E), axis1=-2, axis2=-1)
    except np.linalg.LinAlgError:  # some lambda is a root to the last bit
        out = np.full(lam.shape, np.inf, dtype=complex)
        with np.errstate(invalid="ignore"):
            regular = np.linalg.det(A) != 0
        out[regular] = np.trace(np.linalg.solve(A[regular], scaled_E[regular]), axis1=-2, axis2=-1)
        return out


def _scaled(A):
    """Rows and columns of A divided by powers of two until the largest entry of each is near one (equilibration)."""
    rows, columns = np.ones(A.shape[:-1]), np.ones(A.shape[:-1])
    size = np.abs(A)
    for _ in range(3):
        for axis, factors in ((-1, rows), (-2, columns)):
            largest = size.max(axis=axis)
            largest = np.where(largest > 0, np.maximum(largest, LEAST), 1)
            factor = np.exp2(-np.round(np.log2(largest) / (2 if axis == -1 else 1)))
            factors *= factor
            size = size * np.expand_dims(factor, axis)
    rows, columns = (np.clip(factors, LEAST, 1 / LEAST) for factors in (rows, columns))
    return rows[..., :, None] * columns[..., None, :] * A, rows, columns


def _size(S, E):
    """A first guess of the size of lambda, of shape (N,)."""
    s, e = np.abs(S).max(axis=(-2, -1)), np.abs(E).max(axis=(-2, -1))
    return np.where((s > 0) & (e > 0), s, 1) / np.where(e > 0, e, 1)


def _singular(S, E):
    """Where det(lambda E + S) = 0 for every lambda: tried at two lambdas in general position."""
    size = _size(S, E)
    lam = size[:, None] * np.array([0.83 + 0.61j, -0.29 + 1.37j])
    A, _, _ = _scaled(lam[..., None, None] * E[:, None] + S[:, None])
    s = np.linalg.svd(A, compute_uv=False)
    return (s[..., -1] <= 16 * EPS * s[..., 0]).all(axis=1)


def _start(S, E, n, solvable):
    """Starting values from one library call: the eigenvalues of -E^-1 S, or of (mu E + S)^-1 E where E is singular."""
    if solvable:
        scaled, rows, columns = _scaled(E)
        return np.linalg.eigvals(-np.linalg.solve(scaled, rows[..., :, None] * columns[..., None, :] * S))
    mu = 4 * _size(S, E) * np.exp(0.7j)
    for _ in range(2):  # the second time with a shift no larger than the largest eigenvalue asks for
        A, rows, columns = _scaled(mu[:, None, None] * E + S)
        theta: np.ndarray = np.linalg.eigvals(np.linalg.solve(A, rows[..., :, None] * columns[..., None, :] * E))
        theta = np.take_along_axis(theta, np.argsort(-np.abs(theta), axis=1), axis=1)[:, :n]
        lam = mu[:, None] - 1 / np.where(theta == 0, TINY, theta)
        largest = np.where(theta == 0, 0, np.abs(lam)).max(axis=1)  # those at infinity left out
        mu = np.exp(0.7j) * np.maximum(2 * largest, 1e-8 * np.abs(mu))
    return lam
