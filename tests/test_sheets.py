"""Guards sheets for a class and their marking: nothing lost, nothing swapped, and one bad answer stops no other."""

import re

import pytest
from test_exercises import CHECKS, TRUTH

from primer import exercises


def test_each_exercise_with_a_checker_can_be_set():
    assert [f"check_{name.replace('.', '_')}" for name in exercises.numbered()] == CHECKS
    for name in exercises.numbered():
        ask = getattr(exercises, f"ask_{name.replace('.', '_')}")
        parts = re.split(rf"Exercise {re.escape(name)}, seed (\d+)\n", exercises.sheet([7, 0, 12, 7], name))
        assert parts[0] == ""
        assert parts[1::2] == ["7", "0", "12"]
        assert [text.strip() for text in parts[2::2]] == [ask(7), ask(0), ask(12)]


@pytest.mark.parametrize("name", ["00.1", "03.2", "07.3", "12.1"])
def test_each_answer_is_marked_with_its_own_seed(name):
    truth = TRUTH[f"check_{name.replace('.', '_')}"]
    seeds = range(12)
    assert all(found.right for found in exercises.mark(((seed, truth(seed)) for seed in seeds), name))
    other = [(seed, truth((seed + 1) % 12)) for seed in seeds]
    for found, (seed, answer) in zip(exercises.mark(other, name), other, strict=True):
        assert (found.seed, found.answer) == (seed, answer)
        alone = getattr(exercises, f"check_{name.replace('.', '_')}")(answer, seed)
        assert (found.right, found.said) == (alone.right, alone.said)
    assert not all(found.right for found in exercises.mark(other, name))


def test_one_that_cannot_be_read_stops_no_other():
    truth = TRUTH["check_03_2"]
    handed = [(3, "six"), (4, truth(4)), (5, None), (6, float("nan")), (7, truth(7))]
    marks = exercises.mark(handed, "03.2")
    assert [found.right for found in marks] == [False, True, False, False, True]
    assert "could not be read: answer must be a finite number, got 'six'" in marks[0].said
    assert str(marks[0]).startswith("3: Not yet: ")


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: exercises.sheet([1], "03.4"), r"exercise must be one of 00\.1, .*, got '03\.4'"),
        (lambda: exercises.sheet([1], 3.2), r"exercise must be a text such as '03\.2', got 3\.2"),
        (lambda: exercises.sheet([], "03.2"), "roster must have at least one seed"),
        (lambda: exercises.sheet("123", "03.2"), "roster must be integers >= 0"),
        (lambda: exercises.sheet(5, "03.2"), "roster must be integers >= 0"),
        (lambda: exercises.sheet([-1], "03.2"), "seed must be"),
        (lambda: exercises.mark([(1, 2, 3)], "03.2"), r"handed_in must be pairs \(seed, answer\)"),
        (lambda: exercises.mark(7, "03.2"), r"handed_in must be pairs \(seed, answer\), got 7"),
        (lambda: exercises.mark([(-1, 2.0)], "03.2"), "seed must be"),
    ],
)
def test_what_cannot_be_set_or_marked(call, said):
    with pytest.raises((TypeError, ValueError), match=said):
        call()
