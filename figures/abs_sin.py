"""The proposition of section A2.2.1: backward heat from |sin x|^p has a solution only for even p.

A solution that lives to time t needs sum e^{2 n^2 t} |c_n|^2 of eq. (L2norm-sln) to converge. For odd p (and any p
that is no even integer) the Fourier coefficients fall only like n^{-p-1}, and the sum runs away for every t > 0; for
even p they end.
"""

import numpy as np
from sidecar import close, same

from primer.problems.heat import abs_sin_coefficients, abs_sin_log_norms
from primer.view.heat import draw_coefficients, draw_log_norms
from primer.view.style import new_figure

POWERS, T, M = (1, 2, 3, 4), 1e-3, 80  # wavenumbers up to 2 M


def compute():
    return {p: (abs_sin_coefficients(p, M), abs_sin_log_norms(p, T, M)) for p in POWERS}


def numbers(result):
    claims = {}
    for p, (c, log_norm) in result.items():
        claims[f"p{p}_c0"] = close(c[0], rtol=1e-12, why="Gamma(p+1)/(2^p Gamma(1+p/2)^2)")
        claims[f"p{p}_last_nonzero_n"] = same(int(2 * np.flatnonzero(c)[-1]), "the series ends for even p only")
        claims[f"p{p}_log_norm_end"] = close(log_norm[-1], rtol=1e-10, why="a sum of closed forms")
    return claims


def draw(result):
    figure, (left, right) = new_figure(title=r"Backward heat from $|\sin x|^p$: which initial data have a solution?")
    draw_coefficients(left, POWERS, [result[p][0] for p in POWERS])
    left.set(title="(a) Fourier coefficients")
    draw_log_norms(right, POWERS, [result[p][1] for p in POWERS])
    right.set(title=f"(b) squared norm at t = {T:g}, cut at n")
    return figure
