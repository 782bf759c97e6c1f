"""Whether a black box is a step at all: it uses its dt, and returns fields, not their change."""

import numpy as np

from primer.study.black_box import Box

_NUDGE = 1e-3  # of a field's size
_LESS, _TINY = 0.9, 1e-9  # what a step does must fall to this share of itself before dt falls to that
_NOTHING = 1e-12  # of a field's size
_LITTLE = 1e-3  # of the fields


def no_step(box: Box, dt: float) -> str | None:
    """Why the ``step`` of a box is none of a time dt, or None.

    A perturbation of 1e-3 is followed through steps of dt, dt/4, dt/16, ...: a large implicit step may undo it as well
    in a quarter of dt, but not in the least.
    """
    nudge = _NUDGE * np.random.default_rng(8).standard_normal(box.shape)
    given, first = box.state + nudge, box.step(nudge, dt)
    done, small = np.abs(first - given).max(), dt
    if done <= _NOTHING:
        return (
            "step gives back what it is given: in a time dt nothing happens, or a tolerance inside swallows it; "
            "tighten the tolerances, or take a larger dt"
        )
    while small > _TINY * dt:
        small /= 4
        last = box.step(nudge, small)
        if np.abs(last - given).max() <= _LESS * done:
            return None
    if np.abs(last - first).max() <= _NOTHING:
        return "step does the same whatever dt is: let it use the dt that it is given"
    if np.abs(last).max() <= _LITTLE * np.abs(given).max():
        return (
            "as dt -> 0 what step returns vanishes: it must return the fields a time dt later, and not their change "
            "alone"
        )
    return None  # as where a field holds the one before
