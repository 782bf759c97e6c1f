"""Exercises of notebook 00, start here."""

import math

from primer.exercises.answers import Feedback, check, choose, variant
from primer.study.threshold import grid_threshold

WELL, SEEN, HIDDEN = "well posed", "ill posed, and the grid shows it", "ill posed, and the grid hides it"


def _first(seed):
    return variant("00_1", seed, a=(0.3, 0.6, 0.8, 0.1, -0.2, -0.4))


def ask_00_1(seed: int = 0) -> str:
    """The question: where u < 0 in the steady state."""
    return f"With a = {_first(seed)['a']}: the steady state u = a - cos x is negative for |x| < c. How large is c?"


def check_00_1(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is arccos a, to one per cent; a ``Feedback``. The steady state is eq. (toy-steady)."""
    a = _first(seed)["a"]
    c = math.acos(a)
    return check(
        answer,
        c,
        "there the second derivative of v has the wrong sign, and the equations are ill posed.",
        {
            "that is in degrees; x is in radians.": math.degrees(c),
            "that is where sin x = a.": math.asin(a),
            "that is where u > 0, counted from the ends of the interval: u is least at x = 0.": math.pi - c,
            "that is the width of the whole stretch, from -c to c.": 2 * c,
        },
        "u = 0 where cos x = a.",
    )


def _second(seed):
    return variant("00_2", seed, state=((0.7, 64), (0.7, 140), (1.4, 128), (0.2, 40), (0.2, 120), (-0.5, 28)))


def ask_00_2(seed: int = 0) -> str:
    """The question: what a grid makes of a steady state."""
    a, n = _second(seed)["state"]
    return (
        f"With a = {a}, eps = 0.01 on N = {n} points, near the steady state: which is it, '{WELL}', '{SEEN}' "
        f"(some wave that the grid holds grows), or '{HIDDEN}' (none does)?"
    )


def check_00_2(answer: str, seed: int = 0) -> Feedback:
    """Whether ``answer`` names what the grid makes of the steady state, eq. (toy-steady); a ``Feedback``.

    Well posed if a > 1, for then u > 0. If not, the grid shows it from ``grid_threshold(a, eps).n`` points on.
    """
    a, n = _second(seed)["state"]
    more = {
        "also": {"hidden": HIDDEN},
        "half": ("ill posed", (SEEN, HIDDEN), "ill posed, and what does the grid make of it?"),
    }
    if a > 1:
        hint = "is there an x where a - cos x is negative? The grid has no say in that."
        praise = "u > 0 everywhere, and no grid is needed to see that."
        return choose(answer, WELL, praise, {SEEN: hint, HIDDEN: hint}, **more)
    truth = SEEN if n >= grid_threshold(a).n else HIDDEN
    hints = {
        WELL: "the steady state has u < 0 somewhere. A quiet run does not make equations well posed.",
        SEEN: "go there in the explorer and read the sentence: does a wave that this grid holds grow?",
        HIDDEN: "go there in the explorer and read the sentence: how fast does the fastest mode on this grid grow?",
    }
    del hints[truth]
    praise = "the equations are the same on every grid; what differs is what it shows."
    return choose(answer, truth, praise, hints, **more)
