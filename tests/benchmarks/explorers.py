"""How long an explorer's callback takes in the kernel, from a slider's step to the new picture:

    python tests/benchmarks/explorers.py

Each slider of each explorer is walked along; the median of its steps is printed, in milliseconds. (What the browser
adds is measured by tests/test_browser.py.)
"""

import itertools
import statistics
import time

from primer.view import explorers
from primer.view.explorers.controls import Number

STEPS = 24


def medians(explorer):
    """Name of a slider -> median of its steps in seconds."""
    shown = explorer()
    sliders = {c.name: shown._rows[c.name].widget.children[0] for c in shown._all() if isinstance(c, Number)}
    return {name: statistics.median(map(_timed, _walk(slider))) for name, slider in sliders.items()}


def _walk(slider):
    """Functions that move a slider: up by a step, and up again, and back."""
    ways = itertools.islice(itertools.cycle((1, 1, -1, -1)), STEPS)
    log = hasattr(slider, "base")
    for way in ways:
        value = slider.value * slider.base ** (way * slider.step) if log else slider.value + way * slider.step
        yield lambda value=value: setattr(slider, "value", value)


def _timed(step):
    start = time.perf_counter()
    step()
    return time.perf_counter() - start


if __name__ == "__main__":
    for name in explorers.__all__:
        found = medians(getattr(explorers, name))
        print(f"{name:20s}", *(f"{slider} {1e3 * seconds:.0f}" for slider, seconds in found.items()))
