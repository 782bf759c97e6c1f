"""Exercises of notebook 04, the scheme or the PDE?"""

import math

from primer.exercises.answers import Feedback, check, choose, variant


def _first(seed):
    return variant("04_1", seed, a=(1.5, 2.0, 1.2, 3.0), n=(400, 300, 500, 800))


def ask_04_1(seed: int = 0) -> str:
    """The question: the largest step for the sawtooth."""
    given = _first(seed)
    return (
        f"With a = {given['a']} and eps = 0.01 on N = {given['n']} points: up to which dt does the sawtooth not grow, "
        "frozen where u of the steady state is largest?"
    )


def check_04_1(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is 2/(1 + 4 eps (a + 1)/h^2), to two per cent; a ``Feedback``.

    To the sawtooth the first difference is zero and the second is -4/h^2, so that v is multiplied each step by
    1 - dt (1 + 4 eps u/h^2), eq. (toy-mat).
    """
    given = _first(seed)
    h, eps, u = 2 * math.pi / given["n"], 0.01, given["a"] + 1
    return check(
        answer,
        2 / (1 + 4 * eps * u / h**2),
        "beyond it the sawtooth overshoots, and changes sign with every step.",
        {
            "that is where the factor is 0. It may be as low as -1.": 1 / (1 + 4 * eps * u / h**2),
            "the largest u of the steady state is a + 1, not a.": 2 / (1 + 4 * eps * (u - 1) / h**2),
            "the least u is a - 1: the largest is meant.": 2 / (1 + 4 * eps * (u - 2) / h**2),
            "that is the limit of waves at eps = 0. Here diffusion is what is stiff.": h**2,
        },
        "each step multiplies v by 1 - dt (1 + 4 eps u/h^2). When is that outside [-1, 1]?",
        rtol=0.02,
    )


# (a, N, times): blow-ups from seeds of 1e-4 and 1e-12 of the mode N/2 - 1 of v, in steps of 5e-4. Of these no single
# one gives the rate by chance: the second comes at less than two and a half times the first; at three times it would.
_MEASURED = (
    (0.0, 60, 8.76, 20.08),
    (-0.1, 56, 9.47, 21.62),
    (-0.3, 50, 9.37, 22.67),
    (-0.4, 48, 9.07, 22.2),
    (-0.5, 46, 9.14, 22.45),
    (0.4, 90, 4.58, 11.33),
)


def _second(seed):
    a, n, soon, late = variant("04_2", seed, measured=_MEASURED)["measured"]
    return {"a": a, "n": n, "soon": soon, "late": late}


def ask_04_2(seed: int = 0) -> str:
    """The question: a growth rate from two blow-ups."""
    given = _second(seed)
    return (
        f"With a = {given['a']} on N = {given['n']} points a seed of 1e-4 blew up at t = {given['soon']}, and one of "
        f"1e-12 at t = {given['late']}. At which rate did the seed grow?"
    )


def check_04_2(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is 8 ln(10) over the time between, to two per cent; a ``Feedback``."""
    given = _second(seed)
    between = given["late"] - given["soon"]
    return check(
        answer,
        8 * math.log(10) / between,
        "nobody looked at the equations: two runs and a logarithm gave an eigenvalue.",
        {
            "growth is exp(rate t), not 10^(rate t).": 8 / between,
            "that is a time for each factor of e: the rate is its inverse.": between / (8 * math.log(10)),
            "one blow-up does not tell: the first growth is not at this rate. Take the difference of the two.": (
                12 * math.log(10) / given["late"],
                4 * math.log(10) / given["soon"],
            ),
        },
        "the second seed is 10^8 times smaller, and that took exp(rate t) the time between the two to make up for.",
        rtol=0.02,
    )


_KINDS = {
    (0.5, 30, 1e-3, 100): "hidden",
    (1.5, 1000, 1e-3, 20): "scheme",
    (0.5, 100, 1e-3, 100): "ill-posed",
    (1.15, 1200, 2e-4, 20): "transient",
    (1.5, 60, 1e-3, 40): "converges",
    (0.9, 60, 1e-3, 100): "hidden",
    (0.0, 80, 1e-3, 100): "ill-posed",
    (1.3, 900, 2e-3, 20): "scheme",
}
_HINTS = {
    "converges": "where is the least u of the run, on the way and at rest? And does the run reach its end?",
    "hidden": "that is of runs that reach their end, though u < 0 stays where it is.",
    "ill-posed": "would it blow up with a quarter of the step? And is u < 0 in the steady state?",
    "scheme": "would it live with a quarter of the step? And did it blow up at all?",
    "transient": "that is where u dips below zero only on the way: the steady state a - cos x stays positive.",
}


def _third(seed):
    return variant("04_3", seed, case=tuple(_KINDS))["case"]


def ask_04_3(seed: int = 0) -> str:
    """The question: what kind of run."""
    a, n, dt, t_end = _third(seed)
    return (
        f"The paper's scheme with a = {a}, eps = 0.01, N = {n}, dt = {dt:g}, to t = {t_end}. Run it, and run it "
        "again as you like. Is it 'converges', 'hidden', 'ill-posed', 'scheme' or 'transient'?"
    )


def check_04_3(answer: str, seed: int = 0) -> Feedback:
    """Whether ``answer`` is the :class:`primer.study.diagnosis.Kind` of the run; a ``Feedback``."""
    kind = _KINDS[_third(seed)]
    hints = {other: hint for other, hint in _HINTS.items() if other != kind}
    return choose(answer, kind, "and diagnose says so too.", hints)


_FAULTS = ("ill-posed", "scheme", "unstable", "stable", "scheme")  # of primer.scenes.whose_fault.PROGRAMS
_ASKED = {
    "scheme": "growth that goes away as dt -> 0 is the scheme's: how do `growths` with dt, dt/2 and dt/4 compare?",
    "ill-posed": "that is growth that rises with n as dt -> 0: does `growth` do so from grid to grid?",
    "unstable": "that is growth that stays as dt -> 0, and is the same on each grid. Is it?",
    "stable": "something grows: with which step, and on which grid?",
}


def _fifth(seed):
    return variant("04_5", seed, program=tuple(range(len(_FAULTS))))["program"]


def ask_04_5(seed: int = 0) -> str:
    """The question: whose fault it is, of a program that is only given as a function."""
    number = _fifth(seed)
    return (
        f"program = primer.scenes.whose_fault.PROGRAMS[{number}] is a solver, program.step, with a state at rest, "
        "program.state, and the step program.dt that its author uses on 64, 128 and 256 points. Examine it. Is it "
        "'scheme', 'ill-posed', 'unstable' or 'stable'?"
    )


def check_04_5(answer: str, seed: int = 0) -> Feedback:
    """Whether ``answer`` is the :class:`primer.study.examination.Fault` of the program; a ``Feedback``."""
    kind = _FAULTS[_fifth(seed)]
    hints = {other: hint for other, hint in _ASKED.items() if other != kind}
    return choose(answer, kind, "and nobody read the program.", hints)
