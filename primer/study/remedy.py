"""The step that would do, where the scheme is to blame."""

import math
from dataclasses import replace

from primer.study.fault import lengths
from primer.study.sighting import amplified

_CURES = 12  # halvings of dt that are tried as a cure
_FINE = 6  # bisections of the step that is the cure


def remedied(judgement, seen, dt):
    """The judgement with the step that would do: the largest with which no grid has a mode that only it lets grow."""
    worst = max((each for each in seen if each.bad), key=lambda each: each.bad[0])
    n = worst.spectra.box.n
    bad = [each for each in seen if each.bad and each.bad[2] > 1]
    step = min(_cured(each, dt) for each in bad)
    growth, wavelength, _ = worst.bad
    text = (
        f"The scheme: with dt = {dt:g} {lengths(wavelength)} grow like e^({growth:.3g} t) on n = {n}, a factor "
        f"{math.exp(min(growth * dt, 700)):.6g} in each step, and do not as dt -> 0"
    )
    if step > 0:
        text += f"; dt = {step:.3g} would do on all these grids"
    else:
        halved = amplified(worst.spectra, dt / 2, worst.limit.dt, worst.cap)
        by = f", with half the step {halved[0] / growth:.2f} times as fast" if halved else ""
        text += f"; no step would do (they always grow{by}): another scheme would"
    rest = [each for each in seen if each.grows]
    if rest:
        text += f"; what is left then is the model's own growth, {rest[-1].growth:.3g}"
    return replace(judgement, reason=text + ".", stable_dt=step)


def _cured(seen, dt):
    """The largest step below dt without a bad mode, to some percent; 0 if halving does not find one."""
    good, least = dt, seen.limit.dt

    def bad(step):
        found = amplified(seen.spectra, step, min(least, step / 4), seen.cap, seen.growth)
        return found is not None and found[2] > 1

    for _ in range(_CURES):
        good /= 2
        seen.spectra.look(good)
        if not bad(good):
            break
    else:
        return 0.0
    low, high = good, 2 * good
    for _ in range(_FINE):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if bad(middle) else (middle, high)
    return low
