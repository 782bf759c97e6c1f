"""Guards the exercises: the right number is found right for every student, slips are met, and no hint gives it away."""

import inspect
import math
import re

import numpy as np
import pytest

from primer import Toy, exercises, ftcs
from primer.study.spectrum import jacobian

SEEDS = range(12)
CHECKS = sorted(name for name in exercises.__all__ if name.startswith("check_"))


def numbers(text):
    return [float(found) for found in re.findall(r"\d+(?:\.\d+)?", text)]


def floor(seed):
    """By marching the scheme to its rest."""
    n = int(re.search(r"N = (\d+)", exercises.ask_03_1(seed))[1])
    return ftcs(Toy(1.5), n, 2e-3, 60).dist[-1]


def frozen(seed):
    """By bisection on the discrete symbol at the sawtooth."""
    a, eps = numbers(exercises.ask_03_2(seed))[:2]
    low, high = 1.0, 1e4
    while high - low > 1e-9 * high:
        n = (low + high) / 2
        h = 2 * math.pi / n
        S = Toy(a, eps).symbol(math.pi / h, a - 1, multiplier=lambda xi, m, h=h: {1: 0 * xi, 2: 0 * xi - 4 / h**2}[m])
        low, high = (low, n) if np.linalg.eigvals(S).real.max() > 1e-13 else (n, high)
    return low


def later(seed):
    """From the spectrum of the dense Jacobian."""
    text = exercises.ask_03_3(seed)
    n, digits = int(re.search(r"N = (\d+)", text)[1]), int(re.search(r"with (\d+) more", text)[1])
    return digits * math.log(10) / np.linalg.eigvals(jacobian(Toy(0.5), n)).real.max()


TRUTH = {"check_03_1": floor, "check_03_2": frozen, "check_03_3": later}


@pytest.mark.parametrize("name", CHECKS)
def test_the_truth_is_found_right_and_hints_keep_it(name):
    check = getattr(exercises, name)
    for seed in SEEDS[:4]:
        truth = TRUTH[name](seed)
        assert check(truth, seed).right, (seed, truth)
        for wrong in (0.0, truth * 1.05, truth * 0.9, -truth, truth**2, 1e6, truth * math.pi):
            found = check(wrong, seed)
            assert not found.right
            assert found.said
            assert not any(
                abs(value - truth) < 0.02 * abs(truth) for value in numbers(found.said) if value not in (2, 4)
            )
            assert str(found).startswith("Not yet")


@pytest.mark.parametrize("name", CHECKS)
def test_students_have_other_numbers_each_always_the_same(name):
    ask = getattr(exercises, name.replace("check", "ask"))
    asked = [ask(seed) for seed in SEEDS]
    assert len(set(asked)) > 3
    assert asked == [ask(seed) for seed in SEEDS]
    assert ask() == ask(0)


@pytest.mark.parametrize("name", CHECKS)
def test_answers_that_are_none(name):
    check = getattr(exercises, name)
    with pytest.raises(TypeError, match="answer must be a finite number, got 'six'"):
        check("six")
    with pytest.raises(ValueError, match="answer must be"):
        check(math.nan)
    with pytest.raises(ValueError, match="seed must be"):
        check(1.0, -1)
    assert "Feedback" in inspect.getdoc(check) or "``Feedback``" in inspect.getdoc(check)
