"""Exercises of notebook 03, grid dependence."""

import math

from primer.exercises.answers import Feedback, check, variant
from primer.problems.toy import Toy
from primer.study.spectrum import growth


def _first(seed):
    return variant("03_1", seed, n=(48, 36, 40, 60, 72, 80))


def ask_03_1(seed: int = 0) -> str:
    """The question: where Dist comes to rest."""
    return f"With a = 1.5 on N = {_first(seed)['n']} points: where does Dist come to rest?"


def check_03_1(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is h/sin h - 1 with h = 2 pi/N, to one per cent; a ``Feedback``.

    Central differences of sin x are (sin h/h) cos x, so that their steady state is a - (h/sin h) cos x.
    """
    h = 2 * math.pi / _first(seed)["n"]
    return check(
        answer,
        h / math.sin(h) - 1,
        "the scheme has a steady state of its own, and stays that far from the equations'.",
        {
            "that is Dist for the equations. What is the steady state of the central differences?": 0.0,
            "that is h. How does the error of a central difference depend on it?": h,
            "that is h squared: the right power, but not the factor. Expand sin h.": h**2,
            "the sign: Dist is a distance.": 1 - h / math.sin(h),
        },
        "put u = a - c cos x, v = 0 into the scheme: u[j+1] - u[j-1] = 2h sin x[j] fixes c.",
    )


def _second(seed):
    return variant("03_2", seed, a=(0.4, 0.2, 0.7, 0.6, 0.3), eps=(0.02, 0.01, 0.005, 0.04))


def ask_03_2(seed: int = 0) -> str:
    """The question: the frozen threshold."""
    given = _second(seed)
    return (
        f"With a = {given['a']} and eps = {given['eps']}: from which N on does the sawtooth, frozen at x = 0, grow? "
        "(A real number.)"
    )


def check_03_2(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is pi/sqrt(eps (1 - a)), to one per cent; a ``Feedback``.

    On the grid xi^2 becomes (4/h^2) sin^2(xi h/2), at most 4/h^2 = N^2/pi^2; at u* = a - 1 growth needs
    -(1 + eps u* N^2/pi^2) > 0, eq. (toy-mat).
    """
    given = _second(seed)
    a, eps = given["a"], given["eps"]
    return check(
        answer,
        math.pi / math.sqrt(eps * (1 - a)),
        "and grid_threshold gives the true one, later, since the wave has to fit into the stretch where u < 0.",
        {
            "the least u of the steady state is a - 1, not a.": math.pi / math.sqrt(eps * a),
            "that is N squared over pi squared.": 1 / (eps * (1 - a)),
            "that is where xi^2 of the equations would grow at the cut-off xi = N/2; a grid sees 4/h^2 instead.": 2
            / math.sqrt(eps * (1 - a)),
        },
        "the first difference does not see the sawtooth, the second makes it -4/h^2: when is -(1 + eps u* 4/h^2) > 0?",
    )


def _third(seed):
    return variant("03_3", seed, n=(100, 80, 120, 150), digits=(3, 2, 5, 8))


def ask_03_3(seed: int = 0) -> str:
    """The question: what more digits buy."""
    given = _third(seed)
    rate = growth(Toy(0.5), given["n"])
    return (
        f"With a = 0.5 on N = {given['n']} points the fastest mode grows like exp({rate:.4g} t). How much later does "
        f"it blow up from round-off in arithmetic with {given['digits']} more decimal digits?"
    )


def check_03_3(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is digits ln(10)/growth, to two per cent; a ``Feedback``."""
    given = _third(seed)
    rate = growth(Toy(0.5), given["n"])
    return check(
        answer,
        given["digits"] * math.log(10) / rate,
        "digits buy time in proportion, while the growth rises with the square of N: twice the digits do not make up "
        "for half the spacing.",
        {
            "growth is exp(rate t), not 10^(rate t).": given["digits"] / rate,
            "that is for one digit.": math.log(10) / rate,
            "divide by the rate: fast growth leaves little time.": given["digits"] * math.log(10) * rate,
        },
        "the seed is 10^-digits times smaller. How long does exp(rate t) take to make up for that?",
        rtol=0.02,
    )


def _fifth(seed):
    return variant("03_5", seed, D=(1.0, 2.0, 0.5, 3.0), K=(5e-4, 2e-3, 1e-4, 4e-5))


def ask_03_5(seed: int = 0) -> str:
    """The question: from which grid on bounded growth stops looking like ill-posedness."""
    given = _fifth(seed)
    return (
        f"u_t = -D u_xx - K u_xxxx with D = {given['D']}, K = {given['K']:.5f}, on a period of 2 pi. On coarse grids "
        "the fastest growth rises with N squared, as if the equation were ill posed. From which N on can a grid hold "
        "the wave that really grows fastest, so that growth stops rising? (A real number; take the cut-off xi = N/2.)"
    )


def check_03_5(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is sqrt(2 D/K), to one per cent; a ``Feedback``.

    Re lambda = D xi^2 - K xi^4 is largest at xi^2 = D/(2K), where it is D^2/(4K): bounded, however short the waves.
    """
    given = _fifth(seed)
    D, K = given["D"], given["K"]
    return check(
        answer,
        math.sqrt(2 * D / K),
        "on any coarser grid this equation cannot be told from backward heat: a small fourth derivative hides too.",
        {
            "that is the wavenumber. How many points does a grid need to hold it?": math.sqrt(D / (2 * K)),
            "there growth ends; where is it largest?": 2 * math.sqrt(D / K),
            "that is how fast that wave grows.": D**2 / (4 * K),
            "that is xi squared, not N.": D / (2 * K),
        },
        "differentiate D xi^2 - K xi^4 by xi^2, then ask the cut-off N/2 to reach that xi.",
    )
