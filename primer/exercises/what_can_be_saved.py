"""Exercises of notebook 10, what can be saved."""

from primer.exercises.answers import Feedback, check, variant


def _first(seed):
    return variant("10_1", seed, bound=(2.0, 5.0, 3.0, 10.0), noise=(1e-4, 1e-6, 1e-3), part=(0.25, 0.4, 0.75, 0.6))


def ask_10_1(seed: int = 0) -> str:
    """The question: how far apart two profiles may be that fit the same data."""
    given = _first(seed)
    return (
        f"Two solutions of w_s = w_xx are {given['bound']:g} apart at s = 0 and {given['noise']:g} apart at s = T "
        f"(rms). How far apart are they at most at s = {given['part']} T?"
    )


def check_10_1(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is E^(1-f) delta^f, the log-convex bound at s = f T, to one per cent; a ``Feedback``."""
    given = _first(seed)
    E, delta, f = given["bound"], given["noise"], given["part"]
    return check(
        answer,
        E ** (1 - f) * delta**f,
        "a straight line of logarithms: at s = 0 it says nothing new, and a little later it says much.",
        {
            "the ends are exchanged: at s = 0 it must be the first of the two.": E**f * delta ** (1 - f),
            "that is on the straight line of the values; it is ln ||w|| that is convex.": (1 - f) * E + f * delta,
            "that forgets the bound at s = 0.": delta**f,
        },
        "draw ln of the distance against s. It is convex: where does it lie, seen from the chord between its ends?",
    )


def _second(seed):
    return variant("10_2", seed, part=(0.25, 0.4, 0.3), better=(2, 3))


def ask_10_2(seed: int = 0) -> str:
    """The question: what a smaller error costs."""
    given = _second(seed)
    return (
        f"By how many times must the noise be smaller for the bound at s = {given['part']} T to be {given['better']} "
        "times smaller?"
    )


def check_10_2(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is better^(T/s), since the bound falls like delta^(s/T), to one per cent; a ``Feedback``."""
    given = _second(seed)
    f, better = given["part"], given["better"]
    return check(
        answer,
        better ** (1 / f),
        "and at s = 0 no instrument is good enough: there the bound does not fall at all.",
        {
            "that is what the bound gains, if the noise is that many times smaller.": better**f,
            "the bound is a power of the noise, not a multiple.": better / f,
            "that is the power of the other end, 1 - s/T.": better ** (1 / (1 - f)),
        },
        "the bound falls like delta^(s/T). Which power of that is delta itself?",
    )
