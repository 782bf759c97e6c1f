"""From what each grid shows to whose fault it is: a power of n, a mode that only the step lets grow, or neither."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from primer.study.modes import LARGER

_BOUNDED, _RISES = 0.1, 0.2  # the power of n below which growth is bounded, and from which it is not
_FOLLOWS = 1.2  # the fastest wave, in grid spacings, from one grid to the next: more, and it stays behind
_NOISE = 1e-10  # of the derivative of a step: more than rounding


@dataclass(frozen=True)
class Judgement:
    """Whose fault it is; attributes as of :class:`~primer.study.examination.Examination`."""

    kind: str
    reason: str
    wavelength: tuple[float, ...]
    exponent: float = math.nan
    coefficient: float = math.nan
    stable_dt: float = math.nan


def judged(seen, dt):
    """The :class:`Judgement` of all grids together."""
    waves = tuple(each.wavelength for each in seen)
    last = seen[-1]
    if last.limit.open.any():
        return Judgement("undecided", _unsettled(last), waves)
    if last.grows:
        found = _growing(seen, waves)
        if found.kind != "unstable":
            return found
    bad = [each for each in seen if each.bad]
    note = ""
    if bad and max(each.bad[2] for each in bad) > 1:
        waves = tuple(each.bad[1] if each.bad else each.wavelength for each in seen)
        return Judgement("scheme", "", waves, found.exponent if last.grows else math.nan)
    if bad:
        worst = max(bad, key=lambda each: each.bad[0])
        note = (
            f" (perturbations far below {LARGER:g} of the fields do grow, by {math.exp(worst.bad[0] * dt):.3g} in a "
            f"step of dt = {dt:g} on n = {worst.spectra.box.n}, and larger ones decay: the step controls its error, "
            "and leaves noise of that level)"
        )
    if last.grows:
        return replace(found, reason=found.reason[:-1] + note + ".")
    possible = float((np.minimum(last.limit.rate, 0) + last.limit.noise).max())
    noisy = last.spectra.tangent(last.limit.dt).error > _NOISE
    if possible * dt > 0.05 or (noisy and possible > 0.02 * _fastest(last)):
        return Judgement("undecided", _noisy(last, possible), waves)
    n, decays = last.spectra.box.n, last.growth < -last.error
    text = f"decays like e^(-{-last.growth:.3g} t)" if decays else "neither grows nor decays"
    return Judgement(
        "stable", f"Nothing grows: on n = {n} the slowest mode {text}, within {possible:.1g} per unit time"
        f"{_moving(last)}{note}.", waves,
    )  # fmt: skip


def _growing(seen, waves):
    """Which of ill-posed, unstable and undecided it is, where the finest grid shows growth as dt -> 0."""
    last, before = seen[-1], seen[-2]
    n = [each.spectra.box.n for each in seen]
    length = lengths(last.wavelength)
    if not before.grows:
        if last.wavelength * n[-1] > 8 and before.wavelength < math.inf:
            text = "a wave that long should grow on the coarser grids too"
        else:
            text = f"whether finer grids show more cannot be told from one: add n = {2 * n[-1]}"
        return Judgement(
            "undecided",
            f"Only n = {n[-1]} shows growth, like e^({last.growth:.3g} t), of {length}; {text}.",
            waves,
        )
    power = math.log(last.growth / before.growth) / math.log(n[-1] / n[-2])
    follows = (
        last.wavelength * n[-1] <= _FOLLOWS * before.wavelength * n[-2] and last.wavelength < 0.9 * before.wavelength
    )
    law = f"{', '.join(f'{each.growth:.3g}' for each in seen)} on n = {', '.join(map(str, n))}"
    if follows and power >= _RISES:
        power = _power(seen, n, power)
        coefficient = last.growth * last.wavelength**power
        return Judgement(
            "ill-posed",
            f"Ill posed as these grids see it: growth rises like n^{power:.2f} ({law}; {coefficient:.3g} k^{power:.2f} "
            f"for k waves in the domain, fastest: {length}), and no smaller dt helps: the program, which need not be "
            f"the equations{_falling(seen, n)}{_too_large(last)}.",
            waves, power, coefficient,
        )  # fmt: skip
    if power < _BOUNDED or (not follows and power < 0.5):
        stays = "whatever the grid" if power < _BOUNDED else "which hardly get shorter on finer grids"
        return Judgement(
            "unstable",
            f"Unstable but bounded: the fastest growth is {law}, of {length}, {stays}: the model's own"
            f"{_moving(last)}.",
            waves, power, last.growth * last.wavelength**power if last.wavelength < math.inf else last.growth,
        )  # fmt: skip
    return Judgement(
        "undecided",
        f"Growth rises with the grid ({law}), but neither as a power of n nor to a bound; add n = {2 * n[-1]}.",
        waves, power,
    )  # fmt: skip


def _power(seen, n, last):
    """p of growth = c n^p - d through the last three grids, if all show the same wave; else ``last``, from two."""
    if len(seen) < 3 or not 1 / _FOLLOWS < seen[-3].wavelength * n[-3] / (seen[-1].wavelength * n[-1]) < _FOLLOWS:
        return last
    g, m = [each.growth for each in seen[-3:]], np.array(n[-3:], dtype=float) / n[-1]
    if not g[2] > g[1] > g[0]:
        return last
    powers = np.linspace(0.05, 8, 1591)
    ratio = (1 - m[1] ** powers) / (m[1] ** powers - m[0] ** powers)
    return float(powers[np.argmin(np.abs(np.log(ratio) - math.log((g[2] - g[1]) / (g[1] - g[0]))))])


def _falling(seen, n):
    """That the power falls from grid to grid, where it does."""
    if len(seen) < 3 or not seen[-3].grows:
        return ""
    a, b, c = (each.growth for each in seen[-3:])
    first, second = math.log(b / a) / math.log(n[-2] / n[-3]), math.log(c / b) / math.log(n[-1] / n[-2])
    if second > first - 0.1 or second > 1.9:
        return ""
    return f"; the power falls, {first:.2f} and then {second:.2f}, so that finer grids may show a bound"


def _too_large(last):
    return "; and dt is too large as well" if last.bad and last.bad[0] > 2 * last.growth else ""


def _moving(last):
    """That the base state does not stand still, where it moves faster than what grows on it."""
    speed = last.spectra.box.moved / last.spectra.dt
    if speed <= max(0.1 * abs(last.growth), 1e-6):
        return ""
    return f" (the base state itself moves, at first by {speed:.2g} of its size per unit time, and is held still here)"


def lengths(wavelength):
    """A wavelength in words."""
    if wavelength == math.inf:
        return "the uniform state, without waves"
    return f"waves of {wavelength:.3g} of the domain"


def _fastest(last):
    return float(last.modes.swing.max() / last.modes.dt)


def _unsettled(last):
    return (
        f"Cannot tell: with steps down to dt = {last.limit.dt:.2g} growth rates have not converged on n = "
        f"{last.spectra.box.n}; a smaller dt to begin with would help."
    )


def _noisy(last, possible):
    known = f"growth rates are known only to {possible:.2g} per unit time on n = {last.spectra.box.n}"
    error = last.spectra.tangent(last.limit.dt).error
    if error < _NOISE:
        return (
            f"Cannot tell: many modes are nearly parallel, as aliasing makes them, and {known}; powers of the step may "
            "rise where no mode grows; filter the shortest waves (the 2/3 rule) and see whether it helps."
        )
    return (
        f"Cannot tell: the step is noisy or not smooth (its derivative is known to {error:.1g}), and {known}; tighter "
        "tolerances inside it, or a larger dt, would help."
    )
