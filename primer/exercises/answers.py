"""What a checker says, how a number is compared, and a choice."""

from dataclasses import dataclass
from random import Random

from primer.checks import integer, real, shown


@dataclass(frozen=True)
class Feedback:
    """Whether an answer is right, and what there is to say about it: a hint, never the answer."""

    right: bool
    said: str

    def __str__(self):
        return f"{'Right' if self.right else 'Not yet'}: {self.said}"

    __repr__ = __str__


def variant(exercise, seed, **choices):
    """One of each of the ``choices`` for a student: the first of each for seed 0, chance for the others.

    Raises
    ------
    TypeError, ValueError    if seed is not an integer >= 0
    """
    if integer("seed", seed, least=0) == 0:
        return {name: values[0] for name, values in choices.items()}
    draw = Random(f"{exercise}/{seed}")
    return {name: draw.choice(values) for name, values in choices.items()}


def check(answer, truth, praise, slips, hint, rtol=0.01):
    """``Feedback`` on a number: right within ``rtol``; ``slips`` maps hints to the numbers that common slips give.

    Raises
    ------
    TypeError, ValueError    if answer is not a finite number
    """
    answer = real("answer", answer)
    if _near(answer, truth, rtol):
        return Feedback(True, praise)
    for said, wrong in slips.items():
        if _near(answer, wrong, rtol):
            return Feedback(False, said)
    return Feedback(False, hint)


def choose(answer, truth, praise, hints):
    """``Feedback`` on one of a few texts, in capitals or not; ``hints`` maps each of the others to what to think of.

    Raises
    ------
    TypeError     if answer is not a text
    ValueError    if it is none of those to choose from
    """
    options = sorted([truth, *hints])
    if not isinstance(answer, str):
        raise TypeError(f"answer must be one of {', '.join(map(repr, options))}, got {shown(answer)}")
    told = {option.casefold(): option for option in options}
    answer = told.get(" ".join(answer.casefold().split()), answer)  # 'Well posed ' is not wrong
    if answer not in options:
        raise ValueError(f"answer must be one of {', '.join(map(repr, options))}, got {shown(answer)}")
    return Feedback(True, praise) if answer == truth else Feedback(False, hints[answer])


def _near(answer, value, rtol):
    return abs(answer - value) <= rtol * abs(value)
