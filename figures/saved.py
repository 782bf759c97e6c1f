"""What can be saved: backward heat with a bound known beforehand, and no look at the truth.

(a) The logarithm of a solution's size is convex in time: below the chord (thin). (b) A tent has diffused for T = 0.05,
with noise of rms delta; alpha of Tikhonov's method is taken by the discrepancy principle. Errors at four times (points)
under what is promised, (2 ||w(0)||)^{1-s/T} ((1+tau) delta)^{s/T} (lines). (c) With delta = 0.001, the error of the
answer: largest at the tent's corners, and many times smaller half way back.
"""

import numpy as np
from sidecar import close, same

from primer.schemes.grid import Grid
from primer.study.cure import march_back
from primer.study.discrepancy import by_discrepancy, diffuse, save
from primer.view.saving import draw_error, draw_log_convexity, draw_saved
from primer.view.style import new_figure

T, NOISE, PARTS = 0.05, np.logspace(-8, -1, 8), np.array([0.0, 0.25, 0.5, 1.0])


def tent(x):
    return np.pi / 2 - np.abs(x)


def compute():
    x = Grid(256).x
    draw = np.random.default_rng(0).standard_normal(256)
    data = march_back(tent(x), diffuse(T)) + 1e-3 * draw / np.sqrt(np.mean(draw**2))
    return x, by_discrepancy(data, 1e-3, T), save(tent, NOISE, PARTS * T, T)


def numbers(result):
    _, choice, saved = result
    claims = {"alpha_1e-03": close(choice.parameter, rtol=1e-6, why="a stated draw of the noise")}
    for part, order, error in zip(PARTS, saved.order, saved.error[2], strict=True):
        claims[f"error_1e-06_at_{part:g}T"] = close(error, rtol=1e-5, why="a stated draw of the noise")
        claims[f"order_at_{part:g}T"] = close(order, rtol=1e-5, why="a stated draw of the noise")
    claims["promise_kept"] = same(bool((saved.error <= saved.bound).all()), "log-convexity and the choice of alpha")
    return claims


def draw(result):
    x, choice, saved = result
    figure, (left, middle, right) = new_figure(
        1, 3, width=11.0, height=3.8, title="Backward heat with a bound: what can be saved without knowing the truth"
    )
    draw_log_convexity(left, {"cos x + cos 6x": np.cos(x) + np.cos(6 * x), "cos 3x": np.cos(3 * x)}, 0.3)
    left.set(title="(a) ln ‖w‖ is convex (T = 0.3)")
    draw_saved(middle, saved)
    middle.set(title="(b) the tent, T = 0.05")
    draw_error(right, x, {f"s = {part:g} T": error(x, choice.profile, part * T) for part in (0.0, 0.5)})
    right.set(title="(c) noise 10⁻³: answer - truth")
    return figure


def error(x, profile, s):
    return march_back(profile - tent(x), diffuse(s))
