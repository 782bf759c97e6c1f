"""Exercises of notebook 01, what ill posed means."""

import math

from primer.exercises.answers import Feedback, check, choose, variant

ALWAYS, A_WHILE, NEVER = "for all time", "for a while", "for no time at all"


def _first(seed):
    return variant("01_1", seed, xi=(30, 20, 50, 80), digits=(10, 6, 8, 12))


def ask_01_1(seed: int = 0) -> str:
    """The question: how soon a ripple is large."""
    given = _first(seed)
    return (
        f"Data for u_t = -u_xx have a ripple 10^-{given['digits']} sin({given['xi']} x) on them. "
        "At what t has the ripple grown to size 1?"
    )


def check_01_1(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is digits ln(10)/xi^2, by eq. (backward-heat-growing-sln), to one per cent; a ``Feedback``."""
    given = _first(seed)
    xi, digits = given["xi"], given["digits"]
    return check(
        answer,
        digits * math.log(10) / xi**2,
        "ten times the wavenumber, and a hundredth of the time.",
        {
            "growth is exp(xi^2 t), not 10^(xi^2 t).": digits / xi**2,
            "the rate is xi squared: two derivatives.": digits * math.log(10) / xi,
            "divide by the rate: fast growth leaves little time.": digits * math.log(10) * xi**2,
            "the sign: the ripple grows with t.": -digits * math.log(10) / xi**2,
        },
        "its size is 10^-digits exp(xi^2 t). When is that 1?",
    )


def _second(seed):
    return variant("01_2", seed, s=(0.2, 0.3, 0.15, 0.25, 0.4))


def ask_01_2(seed: int = 0) -> str:
    """The question: how long a row of Gaussians has a solution."""
    return (
        f"u_t = -u_xx starts from a row of Gaussians, exp(-x^2/(2 s^2)) with s = {_second(seed)['s']}, repeated with "
        "period 2 pi. Its Fourier coefficients are in proportion to exp(-s^2 n^2/2). Until which t is there a solution?"
    )


def check_01_2(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is s^2/2, to one per cent; a ``Feedback``.

    The sum of e^{2 n^2 t} |c_n|^2, eq. (L2norm-sln), is one of e^{n^2 (2t - s^2)}.
    """
    s = _second(seed)["s"]
    return check(
        answer,
        s**2 / 2,
        "until then each Gaussian narrows, its variance s^2 - 2t, and in the end it is a spike.",
        {
            "square the coefficient too: the sum has |c_n|^2.": s**2 / 4,
            "the sum has e^{2 n^2 t}, with a 2.": s**2,
            "that has the right factor, but s enters squared.": s / 2,
        },
        "put c_n into the sum of e^{2 n^2 t} |c_n|^2. When does it stop converging?",
    )


_DATA = {
    "1/(2 - cos x)": (NEVER, "its coefficients fall like r^n. Does e^{-kn} win against e^{n^2 t}?"),
    "|sin x|^3": (NEVER, "its coefficients fall like a power of n. Does that win against e^{n^2 t}?"),
    "sin(x)^4": (ALWAYS, "write it as a sum of cosines. How many are there?"),
    "the sum over n of exp(-n^2/50) cos(n x)": (A_WHILE, "the coefficient grows to exp(n^2 t - n^2/50). Until when?"),
    "|sin x|^7": (NEVER, "six derivatives are continuous. Does that help against e^{n^2 t}?"),
    "sin(x)^3": (ALWAYS, "without the bars: write it as a sum of sines. How many are there?"),
}


def _third(seed):
    return variant("01_3", seed, data=tuple(_DATA))["data"]


def ask_01_3(seed: int = 0) -> str:
    """The question: whether data have a solution."""
    return (
        f"u_t = -u_xx starts from u(x, 0) = {_third(seed)}. Is there a solution '{ALWAYS}', '{A_WHILE}' or '{NEVER}'?"
    )


def check_01_3(answer: str, seed: int = 0) -> Feedback:
    """Whether ``answer`` says for how long the data have a solution; a ``Feedback``.

    Finitely many modes live for ever; coefficients like e^{-s n^2} until t = s; all that fall more slowly than any
    of these not at all, by eq. (L2norm-sln).
    """
    truth, hint = _DATA[_third(seed)]
    hints = {option: hint for option in (ALWAYS, A_WHILE, NEVER) if option != truth}
    return choose(
        answer, truth, "what decides is how fast the Fourier coefficients fall, not how smooth it looks.", hints
    )
