"""Many steps of the scheme in one: small perturbations of the toy system carried by long, stable strides.

m steps of forward Euler multiply a mode by (1 + dt lam)^m. One step of length D = m dt by the theta method multiplies
it by R(D lam), R(z) = (1 + (1 - theta) z)/(1 - theta z). With theta = (m - 1)/(2m):

* R agrees with (1 + z/m)^m to second order in z;
* |R| <= 1 exactly where |1 + dt lam| <= 1, since both say 2 Re lam + dt |lam|^2 <= 0: a stride keeps the scheme's own
  limit of stability, however long it is;
* m = 1 is the scheme itself.

A field that is even or odd about x = 0 is known from x = -pi to x = 0, n//2 + 1 points (on an odd number of points the
last is half a step short of 0). Ghost values there carry the symmetry; u and v have opposite ones, and a stride is one
solve of a banded system with u and v interleaved.
"""

import numpy as np


class Half:
    """Fields of one symmetry on the half grid x_j = -pi + j h, j = 0 ... n//2: u even and v odd, or the other way.

    even_u    1 if u is even (and v odd), -1 if u is odd (and v even)
    """

    def __init__(self, n, h, even_u):
        self.n, self.h, self.signs = n, h, np.array([even_u, -even_u], dtype=float)

    def part(self, f):
        """The part of full-grid fields f, of shape (..., 2, n), that has this symmetry."""
        mirrored = np.concatenate((f[..., :1], f[..., :0:-1]), axis=-1)
        return ((f + self.signs[:, None] * mirrored) / 2)[..., : self.n // 2 + 1]

    def full(self, f):
        """Half-grid fields, of shape (..., 2, n//2 + 1), on the full grid."""
        mirrored = f[..., (self.n - 1) // 2 : 0 : -1]
        return np.concatenate((f, self.signs[:, None] * mirrored), axis=-1)

    def differences(self, f):
        """(first, second) central differences of fields (..., 2, n//2 + 1), each of that shape."""
        left = self.signs * f[..., 1]
        right = self.signs * (f[..., -1] if self.n % 2 else f[..., -2])
        f = np.concatenate((left[..., None], f, right[..., None]), axis=-1)
        ahead, here, behind = f[..., 2:], f[..., 1:-1], f[..., :-2]
        return (ahead - behind) / (2 * self.h), (ahead - 2 * here + behind) / self.h**2

    def rate(self, eps, u, v_xx, f):
        """The linearised right-hand side about (u, v_xx), applied to perturbations f of shape (..., 2, n//2 + 1)."""
        first, second = self.differences(f)
        v_t = first[..., 0, :] + eps * (v_xx * f[..., 0, :] + u * second[..., 1, :]) - f[..., 1, :]
        return np.stack((first[..., 1, :], v_t), axis=-2)

    def factored(self, eps, u, v_xx, tau):
        """A function that solves (1 - tau J) z = f for the linearised right-hand side J about (u, v_xx)."""
        from scipy.linalg.lapack import dgbtrf, dgbtrs

        size, (p, q) = u.size, self.signs
        r1, r2 = tau / (2 * self.h), tau * eps * u / self.h**2
        ab = np.zeros((10, 2 * size))  # entry (i, j) is in row 6 + i - j; the first three are LAPACK's
        ab[6] = 1
        ab[6, 1::2] += tau + 2 * r2
        ab[7, ::2] = -tau * eps * v_xx
        ab[3, 3::2] = ab[5, 2::2] = -r1  # of u_t: v ahead; of v_t: u ahead
        ab[7, 1::2] = ab[9, ::2] = r1  # behind; nobody reads what lies outside the matrix
        ab[4, 3::2], ab[8, 1:-1:2] = -r2[:-1], -r2[1:]
        ab[3, 3], ab[5, 2], ab[4, 3] = -r1 * (1 - q), -r1 * (1 - p), -r2[0] * (1 + q)
        if self.n % 2:
            ab[5, -1], ab[6, -1] = -r1 * q, ab[6, -1] - r2[-1] * q
            ab[7, -2] -= r1 * p
        else:
            ab[7, -3], ab[9, -4], ab[8, -3] = r1 * (1 - q), r1 * (1 - p), -r2[-1] * (1 + q)
        lu, pivots, _ = dgbtrf(ab, 3, 3)

        def solve(f):
            columns = np.moveaxis(f, -2, -1).reshape(-1, 2 * size).T
            z = dgbtrs(lu, 3, 3, np.asfortranarray(columns), pivots)[0]
            return np.moveaxis(z.T.reshape(*f.shape[:-2], size, 2), -1, -2)

        return solve
