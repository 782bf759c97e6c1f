"""Guards the exercises: the right answer is found right for every student, slips are met, and no hint gives it away."""

import inspect
import math
from importlib import import_module
from pathlib import Path

import pytest
from truths.reading import numbers

from primer import exercises

SEEDS = range(12)
CHECKS = sorted(name for name in exercises.__all__ if name.startswith("check_"))
_MODULES = [import_module(f"truths.{path.stem}") for path in (Path(__file__).parent / "truths").glob("[a-z]*.py")]
TRUTH = {
    name.replace("truth", "check"): found
    for module in _MODULES
    for name, found in vars(module).items()
    if name.startswith("truth_")
}
NUMBERS = [name for name in CHECKS if inspect.get_annotations(getattr(exercises, name))["answer"] is float]
CHOICES = [name for name in CHECKS if inspect.get_annotations(getattr(exercises, name))["answer"] is str]
PROGRAMS = [name for name in CHECKS if name not in NUMBERS + CHOICES]  # a function of the student's: their own tests


def test_each_exercise_has_a_second_route():
    assert sorted(TRUTH) == CHECKS
    assert PROGRAMS == ["check_09_1"]


@pytest.mark.slow
@pytest.mark.parametrize("name", NUMBERS)
def test_the_truth_is_found_right_and_hints_keep_it(name):
    check = getattr(exercises, name)
    for seed in SEEDS[:4]:
        truth = TRUTH[name](seed)
        assert check(truth, seed).right, (seed, truth)
        for wrong in (truth * 1.08, truth * 0.9, truth + 1, -truth - 1, truth**2 + 1.5, 1e6, truth * math.pi + 0.3):
            found = check(wrong, seed)
            assert not found.right
            assert found.said
            assert not any(
                abs(value - truth) < 0.02 * abs(truth) for value in numbers(found.said) if value not in (0, 1, 2, 4)
            )
            assert str(found).startswith("Not yet")


@pytest.mark.parametrize("name", CHOICES)
def test_the_right_choice_is_found_right_and_each_other_has_a_hint(name):
    check, said = getattr(exercises, name), set()
    for seed in SEEDS[:4]:
        truth = TRUTH[name](seed)
        assert check(truth, seed).right, (seed, truth)
        with pytest.raises(ValueError, match=r"answer must be one of '.*', got 'no such answer'") as error:
            check("no such answer", seed)
        assert check(f" {truth.upper()} ", seed).right
        options = [text for text in str(error.value).split(", got")[0].split("'")[1::2] if text != truth]
        assert options
        hints = [check(option, seed) for option in options]
        assert not any(hint.right or repr(truth) in hint.said for hint in hints)
        said |= {hint.said for hint in hints}
    assert len(said) > 1
    with pytest.raises(TypeError, match="answer must be one of"):
        check(6.0)


@pytest.mark.parametrize("name", CHECKS)
def test_students_have_other_numbers_each_always_the_same(name):
    ask = getattr(exercises, name.replace("check", "ask"))
    asked = [ask(seed) for seed in SEEDS]
    assert len(set(asked)) > 3
    assert asked == [ask(seed) for seed in SEEDS]
    assert ask() == ask(0)


@pytest.mark.parametrize("name", NUMBERS)
def test_answers_that_are_none(name):
    check = getattr(exercises, name)
    with pytest.raises(TypeError, match="answer must be a finite number, got 'six'"):
        check("six")
    with pytest.raises(ValueError, match="answer must be"):
        check(math.nan)


@pytest.mark.parametrize("name", CHECKS)
def test_seeds_that_are_none(name):
    with pytest.raises(ValueError, match="seed must be"):
        getattr(exercises, name)(TRUTH[name](0), -1)
    assert "``Feedback``" in inspect.getdoc(getattr(exercises, name))
