"""Exercises of notebook 12, when freezing lies."""

from primer.exercises.answers import Feedback, check, variant


def _first(seed):
    return variant("12_1", seed, b=(0.5, 0.8, 0.25, 0.6), c=(3, 2, 4))


def ask_12_1(seed: int = 0) -> str:
    """The question: how fast the varying equation truly grows."""
    given = _first(seed)
    return (
        f"w_t = i w_xx + i ({given['b']} + {given['c']} cos x) w_x on the circle. Re lambda ~ s |xi| for its fastest "
        "short waves, as xi -> -infinity. How large is s, truly?"
    )


def check_12_1(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is b, the mean of beta, to one per cent; a ``Feedback``."""
    given = _first(seed)
    b, c = given["b"], given["c"]
    return check(
        answer,
        b,
        "only the mean is left: what varies about it cancels as the wave goes round.",
        {
            "that is frozen where beta is largest.": b + c,
            "that is frozen where beta is least.": c - b,
            "the mean of cos x over the circle is 0.": c,
        },
        "w = z exp(-B/2) takes away of beta what has a periodic integral B. What is left?",
    )


def _second(seed):
    return variant("12_2", seed, c=(2, 0.5, 3), t=(0.4, 1.5, 0.7), xi=(10, 20, 15))


def ask_12_2(seed: int = 0) -> str:
    """The question: a derivative lost."""
    given = _second(seed)
    return (
        f"u_t = u_x + {given['c']} v_x, v_t = v_x with u = 0 and v = sin({given['xi']} x) at t = 0. How large is the "
        f"largest |u| at t = {given['t']}?"
    )


def check_12_2(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is c t xi, for u = c t v_x, to one per cent; a ``Feedback``."""
    given = _second(seed)
    c, t, xi = given["c"], given["t"], given["xi"]
    return check(
        answer,
        c * t * xi,
        "u is a derivative of the data: bounded data, and no bound on u that holds for all waves.",
        {
            "time is missing: v_x acts all the while.": c * xi,
            "v_x of a wave is xi times as large as v.": c * t,
            "that is an integral of t once too often: v_x stays as large as it was.": c * xi * t**2 / 2,
            "the factor in front of v_x is missing.": t * xi,
        },
        "both travel at the same speed. Go along: there v does not change, and u gains c v_x in each unit of time.",
    )
