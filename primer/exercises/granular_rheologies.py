"""Exercises of notebook 06, granular rheologies."""

import math

from primer.exercises.answers import Feedback, check, choose, variant
from primer.scenes.rheology import Kind, rheology

_KINDS = {
    Kind.STABLE: ("damped", "some wave grows: ask largest_growth, which searches all directions."),
    Kind.UNSTABLE: (
        "unstable but bounded",
        "compare the largest growth rate at |xi| d = 1, 100 and 10000: is it positive, and does it level off?",
    ),
    Kind.ILL_POSED: ("ill posed", "a law is ill posed if growth has no end: does it rise with |xi|?"),
}
_STATES = (
    ("CIDR", 0.1, 0.3),
    ("mu(I)", 0.005, 0.3),
    ("CSSM", 0.1, 0.6),
    ("CIDR", 0.1, 0.6),
    ("CSSM", 0.1, 0.2),
    ("mu(I)", 0.2, 0.3),
    ("mu(I)", 2, 0.3),
)


def _first(seed):
    return variant("06_1", seed, mu=(0.4, 0.3, 0.5, 0.6, 0.35, 0.25))


def ask_06_1(seed: int = 0) -> str:
    """The question: the direction in which a Coulomb material is worst."""
    mu = _first(seed)["mu"]
    return (
        f"A Coulomb material has mu = {mu}. At how many degrees from the major compressive axis does the wavevector of "
        "the fastest growing short wave point? (Between nought and a right angle, to two decimal places.)"
    )


def check_06_1(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is arccos(-tan(arcsin(mu)/2))/2 in degrees, to 2 in 10,000; a ``Feedback``.

    Without rate dependence the growth rate is -(t/(rho phi)) |xi|^2 x (x + mu)/(1 + mu x), largest at that x.
    """
    mu = _first(seed)["mu"]

    def degrees(x):
        return math.degrees(math.acos(x)) / 2

    x = -math.tan(math.asin(mu) / 2)
    return check(
        answer,
        degrees(x),
        "inside the wedge of growing directions, -mu < x < 0, but not quite half-way.",
        {
            "half-way between the edges of the wedge is close, but not where the growth rate is largest.": (
                (degrees(0) + degrees(-mu)) / 2,
                degrees(-mu / 2),
            ),
            "that is x = 0, where the wedge of growing directions begins; there the growth rate is zero.": degrees(0),
            "that is x = -mu, where the wedge ends; there the growth rate is zero.": degrees(-mu),
            "the sign: the growing directions have x = cos 2 theta < 0.": degrees(-x),
            "x is the cosine of twice the angle.": 2 * degrees(x),
            "in degrees, not in radians.": math.radians(degrees(x)),
        },
        "the growth rate is proportional to -x (x + mu)/(1 + mu x) with x = cos 2 theta: where is that largest?",
        rtol=2e-4,
    )


def _second(seed):
    return variant("06_2", seed, mu=(0.4, 0.3, 0.5, 0.6, 0.35, 0.45))


def ask_06_2(seed: int = 0) -> str:
    """The question: how much rate dependence cures the incompressible equations."""
    mu = _second(seed)["mu"]
    return (
        f"At some inertial number mu(I) = {mu}. How large must n = I mu'(I)/mu(I) at least be for the incompressible "
        "mu(I)-rheology to be well posed there?"
    )


def check_06_2(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is the smaller root of 4 n^2 - 4 n + mu^2 (1 - n/2)^2 = 0, to one per cent; a ``Feedback``.

    That is (4 + mu^2/4) n^2 - (4 + mu^2) n + mu^2 = 0, close to n = mu^2/4.
    """
    mu = _second(seed)["mu"]
    a, b, c = 4 + mu**2 / 4, 4 + mu**2, mu**2
    root = math.sqrt(b * b - 4 * a * c)
    return check(
        answer,
        (b - root) / (2 * a),
        "so little: a friction that rises by a few per cent when I becomes e times as large will do.",
        {
            "that is the larger root: C <= 0 between the two, and you are asked where that begins.": (b + root)
            / (2 * a),
            "the square of mu matters, and a quarter of it.": mu**2,
            "mu enters as its square.": mu / 4,
            "from n = 1/2 on it is well posed in any case, but less will do.": 0.5,
            "that is mu'(I) I. Divide by mu.": mu * (b - root) / (2 * a),
        },
        "solve C = 4 n^2 - 4 n + mu^2 (1 - n/2)^2 = 0 for n, and take the smaller root.",
    )


def _third(seed):
    return variant("06_3", seed, state=_STATES)["state"]


def ask_06_3(seed: int = 0) -> str:
    """The question: what a law is at a state."""
    law, I, ratio = _third(seed)
    options = ", ".join(repr(text) for text, _ in _KINDS.values())
    return (
        f"Glass beads (GLASS_BEADS, EXAMPLE_COMPACTION, phi = 0.55) under {law} at I = {I} and p/C = {ratio}; for CSSM "
        f"mu = tan(21 degrees). Which are the frozen equations: {options}?"
    )


def check_06_3(answer: str, seed: int = 0) -> Feedback:
    """Whether ``answer`` is the kind that the closed forms of section 4 give; a ``Feedback``."""
    kind = rheology(*_third(seed)).kind
    hints = {text: hint for other, (text, hint) in _KINDS.items() if other != kind}
    damped, bounded, _ = (text for text, _ in _KINDS.values())
    return choose(
        answer,
        _KINDS[kind][0],
        "positive growth and growth without end are two questions, and you asked both.",
        hints,
        also={"stable": damped, "unstable": bounded},
        half=("well posed", (damped, bounded), "well posed, and does some wave grow? Ask for its growth rate."),
    )
