"""The cure and its price: backward heat with a Fourier cut-off, or a small fourth derivative, on noisy data.

A tent has diffused for t = 0.05; from noisy samples it is marched back. (a, b) The error falls as more modes are let in
and then explodes with the noise: points are measured, lines expected. (c) With noise of 10^-3 the answer is whatever
the cut-off makes it, and that is the lesson.
"""

import numpy as np
from sidecar import close, within

from primer.study.cure import cut_off, fourth_derivative, march_back, recover
from primer.view.grid_dependence import draw_answers, draw_recovery
from primer.view.style import new_figure

NOISE = (1e-6, 1e-4, 1e-2)


def compute():
    cut = recover(cut_off, np.arange(1.0, 25), NOISE)
    noisy = cut.data + 1e-3 * np.random.default_rng(0).standard_normal(cut.x.size)
    return {
        "cut": cut,
        "beta": recover(fourth_derivative, np.geomspace(5e-4, 0.3, 25), NOISE),
        "answers": {f"K = {K}": march_back(noisy, cut_off(cut.t, K)) for K in (3, 9, 13)},
    }


def numbers(result):
    claims = {}
    for name in ("cut", "beta"):
        found = result[name]
        for noise, best, error in zip(NOISE, found.best, found.error.min(axis=1), strict=True):
            claims[f"best_{name}_{noise:.0e}"] = close(best, rtol=1e-9, why="a stated draw of the noise")
            claims[f"error_{name}_{noise:.0e}"] = close(error, rtol=1e-6, why="a stated draw of the noise")
        ratio = np.median(found.error / found.expected)
        claims[f"measured_over_expected_{name}"] = within(ratio, 0.8, 1.2, "one draw of the noise")
    return claims


def draw(result):
    figure, (left, middle, right) = new_figure(
        1, 3, width=11.0, height=3.6, title="Backward heat made well posed: the answer depends on how (t = 0.05)"
    )
    draw_recovery(left, result["cut"], "cut-off K")
    left.set(title="(a) Fourier cut-off", ylim=(1e-3, 1e3))
    draw_recovery(middle, result["beta"], "β")
    middle.set(title="(b) fourth derivative, $-βu_{xxxx}$", xscale="log", ylim=(1e-3, 1e3))
    draw_answers(right, result["cut"].x, result["cut"].profile, result["answers"])
    right.set(title="(c) noise 10⁻³: three answers")
    return figure
