"""Exercises of notebook 05, speed against error."""

import math

from primer.exercises.answers import Feedback, check, variant


def _first(seed):
    # (N, error) twice: of the FTCS, central 4 and central 6 of ``primer.study.effort`` at a = 1.5, t = 5.
    return variant(
        "05_1",
        seed,
        pairs=(
            (40, 1.789e-07, 100, 7.365e-10),
            (50, 3.606e-03, 120, 6.244e-04),
            (100, 7.896e-07, 160, 1.238e-07),
            (60, 2.502e-03, 160, 3.511e-04),
            (50, 4.699e-08, 80, 2.808e-09),
        ),
    )["pairs"]


def ask_05_1(seed: int = 0) -> str:
    """The question: an order of accuracy."""
    n1, e1, n2, e2 = _first(seed)
    return (
        f"A method has the error {e1:.3e} on {n1} points and {e2:.3e} on {n2}. Of which order is it, by these two? "
        "(To two decimal places.)"
    )


def check_05_1(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is ln(e1/e2)/ln(N2/N1), to one per cent; a ``Feedback``."""
    n1, e1, n2, e2 = _first(seed)
    return check(
        answer,
        math.log(e1 / e2) / math.log(n2 / n1),
        "and the whole number next to it is the order of the stencil.",
        {
            "that takes N to have doubled.": math.log2(e1 / e2),
            "divide by the logarithm of the ratio of the two N.": math.log(e1 / e2),
            "those are decimal digits gained, not an order.": math.log10(e1 / e2),
            "the sign: as N goes up, h goes down with the error.": -math.log(e1 / e2) / math.log(n2 / n1),
        },
        "error = C h^p with h = 2 pi/N: take the ratio of the two, and logarithms.",
    )


def _second(seed):
    return variant("05_2", seed, order=(2, 4, 6), ratio=(10, 20, 50))


def ask_05_2(seed: int = 0) -> str:
    """The question: what a better answer costs."""
    given = _second(seed)
    return (
        f"A scheme of order {given['order']} in h takes steps of dt = h^2/4, with an error that h alone decides. How "
        f"many times the work does an error {given['ratio']} times smaller cost?"
    )


def check_05_2(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is ratio^(3/order), to 2 in 1000 or rounded to two digits; a ``Feedback``.

    Work is points times steps, N^3.
    """
    given = _second(seed)
    p, ratio = given["order"], given["ratio"]
    return check(
        answer,
        ratio ** (3 / p),
        "points, and steps that go as the square of them: work is N cubed.",
        {
            "that is how many times as many points. Each of them takes more steps, too.": ratio ** (1 / p),
            "those are the steps. There are also more points.": ratio ** (2 / p),
            "that is N cubed with N as many times larger as the error is smaller.": float(ratio**3),
        },
        "how many times as many points? How many times as many steps? Multiply.",
        rtol=2e-3,
        digits=2,
    )


_LARGEST = {"fourth-order": 16 / 3, "sixth-order": 272 / 45, "Fourier": math.pi**2}  # of -h^2 times the multiplier


def _third(seed):
    return variant("05_3", seed, space=tuple(_LARGEST), a=(0.6, 0.2, 0.4), eps=(0.01, 0.02))


def ask_05_3(seed: int = 0) -> str:
    """The question: the frozen threshold of a better stencil."""
    given = _third(seed)
    known = {
        "fourth-order": "the fourth-order second difference multiplies the sawtooth by -16/(3 h^2)",
        "sixth-order": "the sixth-order second difference multiplies the sawtooth by -272/(45 h^2)",
        "Fourier": "the Fourier second derivative multiplies the sawtooth by -(pi/h)^2",
    }[given["space"]]
    return (
        f"With a = {given['a']} and eps = {given['eps']}: {known}; take its first derivative as 0. From which N on "
        "does it grow, frozen at x = 0? (A real number.)"
    )


def check_05_3(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is 2 pi/sqrt(c eps (1 - a)), -c/h^2 being the multiplier, to one per cent; a ``Feedback``.

    Growth needs 1 + eps (a - 1) c/h^2 < 0, eq. (toy-mat).
    """
    given = _third(seed)
    c, well = _LARGEST[given["space"]], given["eps"] * (1 - given["a"])
    return check(
        answer,
        2 * math.pi / math.sqrt(c * well),
        "sooner than the pi/sqrt(eps (1 - a)) of second-order differences: who sees better sees it sooner.",
        {
            "that is for the paper's second-order difference, c = 4.": math.pi / math.sqrt(well),
            "that is 1/h. N is 2 pi/h.": 1 / math.sqrt(c * well),
            "the least u of the steady state is a - 1, not a.": 2 * math.pi / math.sqrt(c * given["eps"] * given["a"]),
        },
        "growth needs 1 + eps u* c/h^2 < 0 at u* = a - 1, where -c/h^2 is what the stencil makes of the sawtooth.",
    )
