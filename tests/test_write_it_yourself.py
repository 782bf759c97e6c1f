"""Guards the checker of a student's own step: right to the bit, right to rounding, and each usual slip named."""

import math

import numpy as np
import pytest
from truths.write_it_yourself import truth_09_1

from primer.exercises import check_09_1
from primer.exercises.slips import SLIPS, dropped_in_part, missing_dt, slipped

RIGHT = """
def step(u, v, x, h, eps, dt):
    u_right, u_left = np.roll(u, -1), np.roll(u, 1)
    v_right, v_left = np.roll(v, -1), np.roll(v, 1)
    u_x = (u_right - u_left) * (1 / (2 * h))
    v_x = (v_right - v_left) * (1 / (2 * h))
    v_xx = (v_right - 2 * v + v_left) * (1 / h**2)
    u_t = v_x
    v_t = eps * u * v_xx + u_x - v - np.sin(x)
    u_new = u + dt * u_t
    v_new = v + dt * v_t
    return u_new, v_new
"""


def made(*changes):
    """The right program with lines changed, as a student would have them: no code of the checker's."""
    text = RIGHT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    space = {"np": np}
    exec(text, space)
    return space["step"]


@pytest.mark.parametrize("seed", range(12))
def test_right_to_the_last_bit(seed):
    for step in (made(), truth_09_1(seed)):
        found = check_09_1(step, seed)
        assert found.right
        assert "to the last bit" in found.said


def test_right_to_rounding_is_told_apart():
    found = check_09_1(made(("* (1 / (2 * h))", "/ (2 * h)"), ("* (1 / h**2)", "/ h**2")))
    assert found.right
    assert "to rounding" in found.said


@pytest.mark.parametrize(
    ("changes", "hint"),
    [
        (
            [
                ("u_t = v_x", "u_t = v_x; u += dt * u_t; u_x = (np.roll(u, -1) - np.roll(u, 1)) / (2 * h)"),
                ("u_new = u + dt * u_t", "u_new = u"),
            ],
            "v is updated with the new u",
        ),
        (
            [
                ("v_xx = (", "u = u + dt * v_x; u_x = (np.roll(u, -1) - np.roll(u, 1)) / (2 * h); v_xx = ("),
                ("u_new = u + dt * u_t", "u_new = u"),
            ],
            "v is updated with the new u",
        ),
        (
            [
                (
                    "u_right, u_left = np.roll(u, -1), np.roll(u, 1)",
                    "u_right, u_left = np.r_[u[1:], u[-1]], np.r_[u[0], u[:-1]]",
                )
            ],
            "right inside, wrong at the ends",
        ),
        ([("np.roll(v, -1), np.roll(v, 1)", "np.r_[v[1:], 0], np.r_[0, v[:-1]]")], "right inside, wrong at the ends"),
        (
            [("np.roll(v, -1), np.roll(v, 1)", "np.r_[v[1:], 0], np.r_[0, v[:-1]]"), ("+ dt * u_t", "+ u_t")],
            "in u dt is missing",
        ),
        ([("+ dt * u_t", "+ u_t"), ("+ dt * v_t", "+ v_t")], "dt is missing: the rate"),
        ([("+ dt * v_t", "+ v_t")], "in v dt is missing"),
        (
            [("v_new = v + dt * v_t", "v_new = v + dt * eps * u * v_xx + u_x - v - np.sin(x)")],
            "dt multiplies the first term only",
        ),
        ([("v_new = v + dt * v_t", "v_new = (v + v_t) * dt")], "in v dt is in the wrong place"),
        (
            [("u_new = u + dt * u_t", "u_new = dt * (u + u_t)"), ("v_new = v + dt * v_t", "v_new = (v + v_t) * dt")],
            "dt is in the wrong place",
        ),
        (
            [("u_new = u + dt * u_t", "u_new = dt * u_t"), ("v_new = v + dt * v_t", "v_new = dt * v_t")],
            "is the change, not the new value",
        ),
        (
            [
                ("np.roll(u, -1), np.roll(u, 1)", "np.roll(u, 1), np.roll(u, -1)"),
                ("np.roll(v, -1), np.roll(v, 1)", "np.roll(v, 1), np.roll(v, -1)"),
            ],
            "left and right are exchanged",
        ),
        ([("(1 / (2 * h))", "(1 / h)")], "the first differences are twice"),
        ([("h**2", "h")], "wrong power"),
        ([("eps * u * v_xx", "eps * v_xx")], "u is missing in front of v_xx"),
        ([("eps * u * v_xx", "u * v_xx")], "eps is missing"),
        ([(" - np.sin(x)", "")], "-sin x is missing"),
        ([("- v - np", "+ v - np")], "the sign of v is wrong"),
        ([("+ u_x -", "- u_x -")], "the sign of u_x is wrong"),
        ([("u_new = u + dt * u_t", "u_new = ...")], "u_new is still '...'"),
        ([("v_xx = (v_right - 2 * v + v_left) * (1 / h**2)", "v_xx = ...")], "a line is still '...'"),
        ([("return u_new, v_new", "return")], "nothing comes back"),
        ([("return u_new, v_new", "return u_new")], "two arrays must come back"),
        ([("return u_new, v_new", "return u_new, v_new[1:]")], "v_new must be an array"),
        ([("return u_new, v_new", "return u_new, 3.0")], "v_new must be an array"),
        ([("v_xx = (v_right", "v_xx = (v_wrong")], "it ends with NameError"),
        ([("u_t = v_x", "u_t = v_x + 1e-3")], "v is right, u is not"),
        ([("- v - np", "- v**3 - np")], "u is right, v is not"),
        ([("- v - np", "- v**3 - np"), ("u_t = v_x", "u_t = v_x + 1e-3")], "both fields are wrong"),
        ([("return u_new, v_new", "return u_new * np.nan, v_new")], "v is right, u is not"),
    ],
)
def test_a_slip_is_named(changes, hint):
    for seed in range(3):
        found = check_09_1(made(*changes), seed)
        assert not found.right
        assert hint in found.said


def test_every_slip_is_named_by_itself_and_no_two_alike():
    steps = {hint: (lambda *given, k=keywords: slipped(*given, **k)) for keywords, hint in SLIPS}
    steps["in v dt multiplies"] = dropped_in_part
    steps["in u dt is missing"] = lambda *given: missing_dt(given, "u")
    for hint, step in steps.items():
        assert check_09_1(step).said.startswith(hint)


def test_a_step_that_remembers_is_found_out():
    right, calls = made(), []

    def forgetful(*given):
        calls.append(1)
        return right(*given) if len(calls) < 9 else given[:2]

    assert "the first step is right" in check_09_1(forgetful).said


def test_the_students_arrays_are_their_own():
    """A step that writes into its arguments, in the right order, is right."""

    def step(u, v, x, h, eps, dt):
        new_u, new_v = made()(u, v, x, h, eps, dt)
        u[:], v[:] = new_u, new_v
        x[:] = math.nan
        return u, v

    assert check_09_1(step).right


@pytest.mark.parametrize("answer", [3, "step", None])
def test_what_is_no_function_is_refused(answer):
    with pytest.raises(TypeError, match="answer must be a function of u, v, x, h, eps, dt"):
        check_09_1(answer)
