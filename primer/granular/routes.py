"""Six routes to the growth rates of one compressible state, to compare their errors and speed."""

from dataclasses import dataclass, fields
from types import SimpleNamespace

import numpy as np

from primer.granular.dispersion import at, dispersion, growth_rates
from primer.granular.linearisation import mass, reduced, symbol
from primer.granular.proof import Lambda, lambda_3


def qz(c, k, x):
    """QZ on the 5 x 5 pencil (LAPACK's ggev): relative to the largest eigenvalue only."""
    from scipy.linalg import eigvals

    S, E = symbol(c, wavevector(k, x)), mass(c)
    found = []
    for matrix in S.reshape(-1, 5, 5):
        alpha, beta = eigvals(-matrix, E, homogeneous_eigvals=True)
        order = np.argsort(-np.abs(beta) / (np.abs(alpha) + np.abs(beta)))[:3]  # the three that are finite
        found.append(alpha[order] / beta[order])
    return np.array(found).reshape(*S.shape[:-2], 3)


def qr(c, k, x):
    """QR on the reduced 3 x 3 matrix (LAPACK's geev, which balances it: a graded matrix then keeps its small roots)."""
    return np.linalg.eigvals(-reduced(c, wavevector(k, x)))


def polished(c, k, x):
    """The 5 x 5 pencil, QZ's digits polished on the equilibrated matrix: the package's general route."""
    from primer.analysis.eigen import finite_eigenvalues

    S = symbol(c, wavevector(k, x))
    E = np.broadcast_to(mass(c).astype(complex), S.shape)
    return finite_eigenvalues(S.reshape(-1, 5, 5), E.reshape(-1, 5, 5), 3).reshape(*S.shape[:-2], 3)


def cubic(c, k, x):
    """The characteristic cubic with coefficients in closed form, solved without cancellation."""
    return growth_rates(c, k, x)


def asymptotic(c, k, x):
    """The closed form for |xi| -> infinity: Lambda_1, Lambda_2 and -det P/(Lambda_1 Lambda_2)."""
    k, x = np.broadcast_arrays(k, x)
    return np.concatenate([lambda_3(c, x)[..., None], Lambda(c, x) * np.square(k)[..., None]], axis=-1)


def multiprecision(c, k, x, digits=50):
    """The cubic in ``digits`` digits, its coefficients too: the reference."""
    import mpmath as mp

    k, x = np.broadcast_arrays(np.asarray(k, dtype=float), np.asarray(x, dtype=float))
    found = []
    with mp.workdps(digits):
        names = [f.name for f in fields(c) if f.name != "incompressible"]
        exact = SimpleNamespace(**{name: mp.mpf(float(getattr(c, name))) for name in names})
        d, R = dispersion(exact), exact.rho * exact.phi
        for ki, xi in zip(k.ravel(), x.ravel(), strict=True):
            ki, xi = mp.mpf(ki), mp.mpf(xi)
            T, Delta, Sigma, N = (at(poly, xi) for poly in (d.T, d.Delta, d.Sigma, d.N))
            coefficients = [exact.Gamma, ki**2 / R * T, (ki**2 / R) ** 2 * Delta + ki**2 / exact.rho * Sigma]
            coefficients.append(exact.phi * (ki**2 / R) ** 2 * N)
            found.append([complex(v) for v in mp.polyroots(coefficients, maxsteps=500, extraprec=8 * digits)])
    return np.array(found).reshape(*k.shape, 3)


#: Name and function of each route, the reference last.
ROUTES = (
    ("QZ, 5 x 5", qz),
    ("QR, 3 x 3", qr),
    ("polished, 5 x 5", polished),
    ("cubic", cubic),
    ("closed form, |xi| -> infinity", asymptotic),
    ("multiprecision, 50 digits", multiprecision),
)


@dataclass(frozen=True, eq=False)
class Routes:
    """Largest relative error over directions of lambda_3, the smallest root: one row a route, one column a k."""

    names: tuple
    k: np.ndarray
    errors: np.ndarray


def compare(c, k, x):
    """The ``Routes`` of one state at wavenumbers k and directions x = cos 2 theta, against multiprecision."""
    exact = multiprecision(c, k[:, None], x)
    small = np.take_along_axis(exact, np.abs(exact).argmin(axis=-1)[..., None], axis=-1)
    errors = [np.abs(route(c, k[:, None], x) - small).min(axis=-1) / np.abs(small[..., 0]) for _, route in ROUTES[:-1]]
    return Routes(tuple(name for name, _ in ROUTES[:-1]), k, np.array([error.max(axis=1) for error in errors]))


def wavevector(k, x):
    """xi of shape (2, ...) from its length and x = cos 2 theta."""
    k, x = np.broadcast_arrays(k, x)
    return k * np.stack([np.sqrt((1 + x) / 2), np.sqrt((1 - x) / 2)])
