"""What a checker says, how a number is compared with the truth and with slips, and a choice."""

from dataclasses import dataclass
from random import Random

from primer.checks import integer
from primer.exercises.forms import number, plain, text


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


def check(answer, truth, praise, slips, hint, rtol=0.01, digits=16):
    """``Feedback`` on a number, in any form that :func:`primer.exercises.forms.number` reads.

    ``slips`` maps hints to the number that a common slip gives, or to several. An answer within ``rtol`` of the truth
    is right unless a slip is nearer: so a slip that lies close to the truth does not pass. Right is also the truth
    rounded to ``digits`` significant digits or more.

    Raises
    ------
    TypeError, ValueError    if answer is not a finite number
    """
    answer = number(answer)
    told = [(truth, None)]
    for said, wrong in slips.items():
        told += [(value, said) for value in (wrong if isinstance(wrong, tuple) else (wrong,))]
    near = [(abs(answer - value), said) for value, said in told if abs(answer - value) <= rtol * abs(value)]
    if any(answer == float(f"{truth:.{shown - 1}e}") for shown in range(digits, 16)):
        near.append((abs(answer - truth), None))
    if not near:
        return Feedback(False, hint)
    _, said = min(near, key=lambda found: found[0])
    return Feedback(True, praise) if said is None else Feedback(False, said)


def choose(answer, truth, praise, hints, also=None, half=(), form=plain):
    """``Feedback`` on one of a few texts, written in any way that ``form`` reads as the same.

    ``hints`` maps each of the others to what to think of, ``also`` other names of options to them, and ``half`` is an
    answer that leaves some options open, those options, and what to ask back if one of them is right.

    Raises
    ------
    TypeError     if answer is neither a text nor something that has one, as a ``Kind`` or a ``Verdict``
    ValueError    if it is none of those to choose from
    """
    options = sorted([truth, *hints])
    one_of = f"answer must be one of {', '.join(map(repr, options))}"
    answer = text(answer, one_of)
    told = {form(name): option for name, option in [*((option, option) for option in options), *(also or {}).items()]}
    found = told.get(form(answer))
    if found is None and half and form(answer) == form(half[0]):
        _, some, question = half
        return Feedback(False, question if truth in some else hints[some[0]])
    if found is None:
        raise ValueError(f"{one_of}, got {answer!r}" if len(answer) <= 60 else f"{one_of}, got {answer[:57]!r}...")
    return Feedback(True, praise) if found == truth else Feedback(False, hints[found])
