"""Exercises of notebook 09, write it yourself: the student's own step of the scheme, held to that of ``ftcs``."""

from collections.abc import Callable, Iterator

import numpy as np

from primer.checks import function
from primer.exercises.answers import Feedback, check, variant
from primer.exercises.slips import SLIPS, dropped_in_part, missing_dt, slipped
from primer.problems.toy import Toy
from primer.schemes.ftcs import ftcs

_CLOSE = 1e-9  # of the size of the change in one step: far above rounding, far below any slip
_LONG = 400  # steps of the second comparison


def _first(seed):
    return variant("09_1", seed, a=(1.5, 1.8, 2.0, 1.3), eps=(0.01, 0.02, 0.03), n=(32, 40, 48, 64))


def ask_09_1(seed: int = 0) -> str:
    """The question: one step of the paper's scheme, as a function."""
    given = _first(seed)
    return (
        "Write step(u, v, x, h, eps, dt), which returns u and v after one step of central space, forward time. It is "
        f"held to ftcs with a = {given['a']}, eps = {given['eps']}, N = {given['n']}, bit by bit."
    )


def check_09_1(answer: Callable, seed: int = 0) -> Feedback:
    """Whether ``answer`` is a step of the paper's scheme, held to ``ftcs`` bit by bit; a ``Feedback``.

    One step from data without symmetry shows a slip, and which; 400 steps from eq. (toy-initial) show the last bit.
    What differs from ``ftcs`` by rounding alone is right, and told so.

    Raises
    ------
    TypeError    if answer is not a function
    """
    function("answer", answer, "u, v, x, h, eps, dt")
    given = _first(seed)
    toy, n, dt = Toy(given["a"], given["eps"]), given["n"], 1e-3
    start = _Rough(toy, n)
    before = ftcs(start, n, dt, 0.0)
    u, v = before.final
    found = _called(answer, (u.copy(), v.copy(), before.x.copy(), 2 * np.pi / n, toy.eps, dt), (u, v))
    if isinstance(found, str):
        return Feedback(False, found)
    truth = ftcs(start, n, dt, dt).final
    wrong = [~_near(mine, right, old) for mine, right, old in zip(found, truth, (u, v), strict=True)]
    if np.any(wrong):
        return Feedback(False, _hint(found, (u, v, before.x, 2 * np.pi / n, toy.eps, dt), wrong))
    return _marched(answer, toy, n, dt)


def _marched(step, toy, n, dt):
    """What there is to say after many steps of a step that is right to rounding."""
    run = ftcs(toy, n, dt, 0.0)
    state, x = run.final, run.x
    for _ in range(_LONG):
        state = _called(step, (state[0].copy(), state[1].copy(), x.copy(), 2 * np.pi / n, toy.eps, dt), state)
        if isinstance(state, str):
            return Feedback(False, state)
    end = ftcs(toy, n, dt, _LONG * dt).final
    apart = max(float(np.abs(mine - right).max()) for mine, right in zip(state, end, strict=True))
    if apart == 0:
        return Feedback(True, f"to the last bit, also after {_LONG} steps. This is the scheme of the whole course.")
    if apart < 1e-10:
        return Feedback(
            True,
            f"the scheme, to rounding: after {_LONG} steps it is {apart:.0e} from ftcs, since sums are taken in "
            "another order. On ill-posed equations these last bits are a seed.",
        )
    return Feedback(False, f"the first step is right, and after {_LONG} steps it is {apart:.1g} off: is anything kept?")


class _Rough:
    """The toy system from data without any symmetry, in which each slip shows."""

    fields, period, is_complex, autonomous = ("u", "v"), 2 * np.pi, False, True

    def __init__(self, toy, n):
        self.toy, self.draw = toy, np.random.default_rng(n).uniform(-1, 1, (2, n))
        self.steady, self.forcing, self.rhs = toy.steady, toy.forcing, toy.rhs

    def initial(self, x):
        """(u, v): random numbers about the toy's."""
        return tuple(f + g for f, g in zip(self.toy.initial(x), self.draw, strict=True))


def _called(step, given, old):
    """(u, v) that the student's function gives, or a sentence."""
    try:
        with np.errstate(all="ignore"):
            made = step(*given)
    except Exception as error:  # whatever a student's line may raise is for the student to read
        if "ellipsis" in str(error):
            return "a line is still '...': replace the dots."
        return f"it ends with {type(error).__name__}: {str(error)[:120] or 'no message'}"
    if made is None:
        return "nothing comes back: the last line must be return u_new, v_new."
    if not isinstance(made, (tuple, list)) or len(made) != 2:
        return "two arrays must come back, u_new and v_new."
    for name, field in zip(("u_new", "v_new"), made, strict=True):
        if field is Ellipsis:
            return f"{name} is still '...': replace the dots."
        if not isinstance(field, np.ndarray) or field.dtype.kind != "f" or field.shape != old[0].shape:
            kind = f"shape {field.shape}" if isinstance(field, np.ndarray) else type(field).__name__
            return f"{name} must be an array of real numbers, as many as points, got {kind}."
    return tuple(made)


def _near(mine, right, old):
    """Where an answer is right but for rounding; the change of one step is the measure."""
    size = max(float(np.abs(right - old).max()), 1e-300)
    return np.abs(mine - right) <= _CLOSE * size


def _slips(given) -> Iterator[tuple[tuple, str]]:
    """((u, v), hint) of each slip."""
    yield missing_dt(given, None), "dt is missing: the rate acts for a time dt."
    yield missing_dt(given, "u"), "in u dt is missing: the rate acts for a time dt."
    yield missing_dt(given, "v"), "in v dt is missing: the rate acts for a time dt."
    yield dropped_in_part(*given), "in v dt multiplies the first term only: brackets round the whole of v_t."
    for keywords, hint in SLIPS:
        yield slipped(*given, **keywords), hint


def _hint(found, given, wrong):
    """The slip that gives what was found; else where it is wrong."""
    n, old = given[0].size, given[:2]
    for made, hint in _slips(given):
        if all(_near(mine, slip, f).all() for mine, slip, f in zip(found, made, old, strict=True)):
            return hint
    places = np.flatnonzero(wrong[0] | wrong[1])
    if set(places) <= {0, 1, n - 2, n - 1}:
        return (
            "right inside, wrong at the ends: x is a circle, so the left neighbour of point 0 is point N - 1, and the "
            "right one of N - 1 is 0. np.roll goes round."
        )
    for made, hint in _slips(given):
        if all(_near(m, s, f)[2:-2].all() for m, s, f in zip(found, made, old, strict=True)):
            return f"{hint} And look at the ends, too."
    if not wrong[0].any():
        return "u is right, v is not: compute each term of v_t by hand at one point and compare."
    if not wrong[1].any():
        return "v is right, u is not: compute v_x by hand at one point and compare."
    return "both fields are wrong: begin with v_x, by hand, at one point."


def _second(seed):
    return variant("09_2", seed, m=(3, 5, 8, 6, 10), n=(100, 40, 60, 80))


def ask_09_2(seed: int = 0) -> str:
    """The question: how far a step reaches."""
    given = _second(seed)
    return (
        f"One value v[j] is changed a little, on N = {given['n']} points, while no u is 0. At how many points can v "
        f"differ after {given['m']} steps of the scheme?"
    )


def check_09_2(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is 2 m + 1, the points within m of one after m steps, to one per cent; a ``Feedback``."""
    m = _second(seed)["m"]
    return check(
        answer,
        2 * m + 1,
        "one point further on each side in each step: what the scheme knows moves at a speed of h/dt.",
        {
            "that counts one side only.": m + 1,
            "that leaves out the point itself.": 2 * m,
            "that is after one step more.": 2 * m + 3,
            "that is after one step less.": 2 * m - 1,
        },
        "v_new[j] takes v at j - 1, j and j + 1. Draw one point, and above it those that one step reaches.",
    )
