"""An exercise for a whole class: one sheet of questions, and one table of what was handed in."""

from collections.abc import Iterable
from dataclasses import dataclass
from importlib import import_module

from primer.checks import integer
from primer.exercises.answers import Feedback


@dataclass(frozen=True)
class Mark:
    """What there is to say about one answer handed in: ``seed``, ``answer``, ``right`` and ``said``, the hint."""

    seed: int
    answer: object
    right: bool
    said: str

    def __str__(self):
        return f"{self.seed}: {Feedback(self.right, self.said)}"


def numbered() -> tuple[str, ...]:
    """The numbers of the exercises that have a checker, as ``"03.2"``, in order.

    >>> numbered()[:3]
    ('00.1', '00.2', '01.1')
    """
    names = import_module("primer.exercises").__all__
    return tuple(sorted(name[4:].replace("_", ".") for name in names if name.startswith("ask_")))


def sheet(roster: Iterable[int], exercise: str) -> str:
    """The questions of ``exercise``, as ``"03.2"``, one for each seed of the ``roster``, under its seed.

    It holds no answers. A seed given twice is asked once.

    >>> print(sheet([0, 4711], "03.2")[:16])
    Exercise 03.2, s

    Raises
    ------
    TypeError, ValueError    if roster is no sequence of integers >= 0 or is empty, or exercise has no checker
    """
    ask, _ = _pair(exercise)
    seeds = dict.fromkeys(_seeds(roster))
    return "\n\n".join(f"Exercise {exercise}, seed {seed}\n{ask(seed)}" for seed in seeds)


def mark(handed_in: Iterable[tuple[int, object]], exercise: str) -> tuple[Mark, ...]:
    """What the checker of ``exercise`` says of each pair (seed, answer), in the order handed in.

    An answer that the checker cannot read is not right, and said to be unreadable: it does not stop the others.

    >>> [found.right for found in mark([(0, -1.0), (0, "six")], "03.2")]
    [False, False]

    Raises
    ------
    TypeError, ValueError    if handed_in is no sequence of pairs (integer >= 0, answer), or exercise has no checker
    """
    _, check = _pair(exercise)
    allowed = "handed_in must be pairs (seed, answer)"
    try:
        pairs = [tuple(pair) if isinstance(pair, tuple | list) else None for pair in handed_in]
    except TypeError:
        raise TypeError(f"{allowed}, got {handed_in!r}") from None
    for place, pair in enumerate(pairs):
        if pair is None or len(pair) != 2:
            raise ValueError(f"{allowed}, got something else at place {place}")
        integer("seed", pair[0], least=0)
    return tuple(_marked(check, seed, answer) for seed, answer in pairs)


def _marked(check, seed, answer):
    try:
        found = check(answer, seed)
    except (TypeError, ValueError) as error:
        return Mark(seed, answer, False, f"this could not be read: {error}")
    return Mark(seed, answer, found.right, found.said)


def _seeds(roster):
    if isinstance(roster, str | bytes):
        raise TypeError(f"roster must be integers >= 0, the seeds of a class, got {roster!r}")
    try:
        seeds = list(roster)
    except TypeError:
        raise TypeError(f"roster must be integers >= 0, the seeds of a class, got {roster!r}") from None
    if not seeds:
        raise ValueError("roster must have at least one seed, got none")
    return [integer("seed", seed, least=0) for seed in seeds]


def _pair(exercise):
    """The two functions of an exercise, ``ask_03_2`` and ``check_03_2``."""
    if not isinstance(exercise, str):
        raise TypeError(f"exercise must be a text such as '03.2', got {exercise!r}")
    if exercise not in numbered():
        raise ValueError(f"exercise must be one of {', '.join(numbered())}, got {exercise!r}")
    room, name = import_module("primer.exercises"), exercise.replace(".", "_")
    return getattr(room, f"ask_{name}"), getattr(room, f"check_{name}")
