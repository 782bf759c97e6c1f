"""Round-off as the seed: digits, last bits and the order of a sum decide when the toy system blows up.

(a) The same run in more and more digits, a = -1.5, eps = 0.02, N = 36: digits buy time, until the solution that exact
arithmetic would give blows up by itself; 30 and 60 digits agree on when. Bars: what is foretold. (b) Stated seeds
at a = 0.5, N = 80: T = c + ln(1/delta)/growth. (c) a = 0.5, N = 100: one initial value moved by its last bit, and an
order of operations that is mirror-symmetric, so that the fastest mode, of the opposite symmetry, never gets its seed.
"""

import numpy as np
from sidecar import close, within

from primer import Toy, ftcs
from primer.study.round_off import (
    PRECISIONS,
    blow_up_time,
    mirror_symmetric,
    one_ulp,
    precision_ladder,
    seed_ladder,
)
from primer.study.toy_diagnosis import foretold
from primer.view.grid_dependence import draw_ladder, draw_last_bit, draw_seeds
from primer.view.style import new_figure

LADDER = {"toy": Toy(-1.5, 0.02), "n": 36, "dt": 8e-3, "t_end": 30.0}
PAPER = Toy(0.5)


def compute():
    return {
        "ladder": {name: blow_up_time(run) for name, run in precision_ladder(**LADDER).items()},
        "foreseen": {name: foretold(**LADDER, **how) for name, how in PRECISIONS.items()},
        "seeds": seed_ladder(PAPER, 80, 1e-3, 200.0, 10.0 ** -np.arange(4, 15)),
        "plain": blow_up_time(ftcs(PAPER)),
        "ulps": one_ulp(PAPER, 100, 1e-3, 40.0, [10, 30, 50, 70, 90]),
        "mirror": mirror_symmetric(PAPER, 100, 1e-3, 80.0),
    }


def numbers(result):
    ladder, seeds = result["ladder"], result["seeds"]
    claims = {
        f"t_{name.replace(' ', '_')}": within(t, 0.8 * t, 1.25 * t, "seeded by round-off") for name, t in ladder.items()
    }
    claims["t_longdouble"].update(low=0.75 * ladder["float64"], why="on some machines longdouble is double")
    claims["digits_30_less_60"] = close(
        ladder["30 digits"] - ladder["60 digits"], atol=8e-3, why="a step: both follow the exact solution of the scheme"
    )
    claims["slope_times_growth"] = within(seeds.slope * seeds.rate, 0.95, 1.05, "T = c + ln(1/delta)/growth")
    claims["growth"] = close(seeds.rate, rtol=1e-6, why="an eigenvalue")
    claims["t_plain"] = within(result["plain"], 12, 16, "seeded by round-off")
    claims["t_one_ulp"] = within(np.median(result["ulps"]), 12, 16, "seeded by round-off, differently")
    claims["t_mirror"] = within(result["mirror"], 35, 60, "only modes of the data's symmetry grow, from round-off")
    return claims


def draw(result):
    figure, (left, middle, right) = new_figure(1, 3, width=11.0, title="Round-off as the seed")
    draw_ladder(left, result["ladder"], result["foreseen"])
    left.set(title="(a) digits buy time, up to a point: N = 36")
    draw_seeds(middle, result["seeds"])
    middle.set(title="(b) stated seeds, N = 80")
    draw_last_bit(right, result["plain"], result["ulps"], result["mirror"])
    right.set(title="(c) the last bit, the order, N = 100")
    return figure
