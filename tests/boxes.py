"""Black boxes with known answers: solvers as people type them, for test_examination.py."""

import numpy as np
from scipy.integrate import solve_ivp

L = 2 * np.pi


def d1(u):
    return (np.roll(u, -1, -1) - np.roll(u, 1, -1)) * u.shape[-1] / (2 * L)


def d2(u):
    return (np.roll(u, -1, -1) - 2 * u + np.roll(u, 1, -1)) * (u.shape[-1] / L) ** 2


def spectral(u, m, keep=1.0):
    """The m-th derivative by Fourier collocation, of the waves below ``keep`` times the shortest."""
    k = np.fft.fftfreq(u.shape[-1], 1 / u.shape[-1])
    multiplier = (1j * k) ** m * (np.abs(k) < keep * u.shape[-1] / 2)
    found = np.fft.ifft(multiplier * np.fft.fft(u))
    return found if np.iscomplexobj(u) else found.real


def euler(f):
    return lambda u, dt: u + dt * f(u)


def rk4(f):
    def step(u, dt):
        a = f(u)
        b = f(u + dt / 2 * a)
        c = f(u + dt / 2 * b)
        return u + dt / 6 * (a + 2 * b + 2 * c + f(u + dt * c))

    return step


def adaptive(f, **options):
    def step(u, dt):
        found = solve_ivp(lambda t, y: f(y.reshape(u.shape)).ravel(), (0, dt), u.ravel(), **options)
        return found.y[:, -1].reshape(u.shape)

    return step


def implicit(symbol):
    """Backward Euler of u_t = symbol(d/dx) u, wave by wave."""

    def step(u, dt):
        k = np.fft.fftfreq(u.shape[-1], 1 / u.shape[-1])
        return np.fft.ifft(np.fft.fft(u) / (1 - dt * symbol(k))).real

    return step


def flat(*values):
    return lambda n: np.outer(values, np.ones(n))


def x_of(n):
    return -np.pi + L * np.arange(n) / n


def curved(*functions):
    return lambda n: np.array([f(x_of(n)) for f in functions])


def shallow_water(z):
    """Two layers between rigid lids: h of the lower one and s = u - v, no net flux; ill posed where s^2 > 1."""
    h, s = z
    return np.array([-d1(h * (1 - h) * s), -d1(s * s * (1 - 2 * h) / 2 + h)])


def toy(a, eps=0.01):
    def f(z):
        u, v = z
        return np.array([d1(v), eps * u * d2(v) + d1(u) - v - np.sin(x_of(u.size))])

    return f


def cahn_hilliard(u):
    return d2(u**3 - u - 0.02 * d2(u))


def kuramoto_sivashinsky(u):
    return -u * d1(u) - d2(u) - 0.05 * d2(d2(u))


def kdv(u):
    return -6 * u * d1(u) - d1(d2(u))


def waves(z):
    return np.array([d1(z[1]), d1(z[0])])


def perona_malik(u):
    p = (np.roll(u, -1, -1) - u) * u.shape[-1] / L
    flux = p / (1 + p**2)
    return (flux - np.roll(flux, 1, -1)) * u.shape[-1] / L


def hidden_well_posed(w):
    """w_t = i w_xx + 3 i cos(x) w_x by central differences: frozen it is ill posed, and it is not."""
    return 1j * d2(w) + 3j * np.cos(x_of(w.shape[-1])) * d1(w)


def galerkin(w):
    """The same with the product cut off, not wrapped, at the last wave: the matrix grows like n."""
    n = w.shape[-1]
    k = np.fft.fftshift(np.fft.fftfreq(n, 1 / n))
    slope = 1j * k * np.fft.fftshift(np.fft.fft(w), axes=-1)
    product = np.zeros_like(slope)
    product[..., 1:] += slope[..., :-1] / 2
    product[..., :-1] += slope[..., 1:] / 2
    return 1j * spectral(w, 2) + 3j * np.fft.ifft(np.fft.ifftshift(product, axes=-1))


def imex(u, dt):
    """Cahn-Hilliard with its fourth derivative implicit."""
    k = np.fft.fftfreq(u.shape[-1], 1 / u.shape[-1])
    rest = -(k**2) * np.fft.fft(u**3 - u)
    return np.fft.ifft((np.fft.fft(u) + dt * rest) / (1 + dt * 0.02 * k**4)).real


def laplacian(u):
    sides = sum(np.roll(u, s, axis) for s in (1, -1) for axis in (-1, -2))
    return (sides - 4 * u) * (u.shape[-1] / L) ** 2


def jacobian(f, base):
    """Of a right-hand side about a base state of shape (m, n), by complex steps where it is real, column by column."""
    columns = []
    for i in range(base.size):
        e = np.zeros(base.size)
        e[i] = 1
        e = e.reshape(base.shape)
        columns.append(
            (f(base + 1e-30j * e).imag / 1e-30 if not np.iscomplexobj(base) else f(base + e) - f(base)).ravel()
        )
    return np.array(columns).T
