"""The toy system to eighteen digits by another road: Taylor series in time, sums of sines in space, longdouble.

Nothing of ``primer.schemes`` is used.
"""

import numpy as np

REAL = np.longdouble
PI = 4 * np.arctan(REAL(1))


def toy_by_taylor(a, eps, times, n=32, order=24):
    """States (len(times), 2, n) at ascending times, on the grid -pi + 2 pi j/n."""
    x = -PI + 2 * PI / n * np.arange(n).astype(REAL)
    k = np.arange(1, n // 2 + 1).astype(REAL)[:, None, None]
    share = np.where(k == n // 2, REAL(1), REAL(2)) / n
    apart = x[None, :] - x[:, None]
    d1 = -(share * k * np.sin(k * apart)).sum(axis=0)  # the derivatives of the interpolant, summed wave by wave
    d2 = -(share * k * k * np.cos(k * apart)).sum(axis=0)
    # A Taylor polynomial of degree p is stable to about |lam| dt = p/3.
    longest = order / 3.5 / (float(eps) * (abs(a) + 1.3) * n * n / 4 + n / 2)
    u, v, now, states = np.full(n, REAL(a)), -np.sin(x) / 2, REAL(0), []
    for t in times:
        steps = int(np.ceil(float(t - now) / min(longest, 0.25)))
        for _ in range(steps):
            u, v = _step(u, v, (REAL(t) - now) / steps, np.sin(x), REAL(eps), d1, d2, order)
        now = REAL(t)
        states.append(np.array([u, v]))
    return np.array(states)


def _step(u, v, h, sin_x, eps, d1, d2, order):
    us, vs, curvatures = [u], [v], [v @ d2]
    for j in range(order):
        product = sum(us[i] * curvatures[j - i] for i in range(j + 1))
        slope = (us[j] - us[j][0]) @ d1
        us.append(vs[j] @ d1 / (j + 1))
        vs.append((eps * product + slope - vs[j] - (sin_x if j == 0 else 0)) / (j + 1))
        curvatures.append(vs[-1] @ d2)
    for j in range(order - 1, -1, -1):
        us[j], vs[j] = us[j] + h * us[j + 1], vs[j] + h * vs[j + 1]
    return us[0], vs[0]
