"""What one grid of a black box shows: its fastest growth as dt -> 0, and what only the step asked about lets grow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from primer.study.modes import Modes, Spectra
from primer.study.vanishing_step import Limit, rates_of, vanishing

_WEAK = 1e-6  # growth of a wave in a radian of its oscillation that no run will notice
_MINOR = 0.05  # of the fastest growth: what is slower does not matter beside it
_CROWDED = 2e-5  # and of the fastest one's, where many modes that are nearly parallel share the noise
_SURE, _FINER = 0.1, 4  # of the fastest growth with dt, that what is known as dt -> 0 may lack; quarterings of it
_HALF = 0.5  # a mode that grows less than half as fast as dt -> 0 grows by the scheme


@dataclass(frozen=True, eq=False)
class Seen:
    """What one grid shows.

    Attributes
    ----------
    spectra, modes, limit    its modes with the least step, and their rates as dt -> 0
    growth, error, grows     the fastest of these rates, how far off it may be, whether it is growth beyond doubt
    wavelength               of that mode, as a fraction of the domain
    growths                  the fastest growth with steps of dt, dt/2 and dt/4
    amplification            the largest |factor| in a step of dt
    cap                      (p, 1) growth as dt -> 0 that no mode of the same wave exceeds
    bad                      (growth, wavelength, factor if it is larger) of the fastest mode that only the step lets
                             grow, or None
    """

    spectra: Spectra
    modes: Modes
    limit: Limit
    growth: float
    error: float
    grows: bool
    wavelength: float
    growths: tuple[float, ...]
    amplification: float
    cap: np.ndarray
    bad: tuple[float, float, float] | None


def look(spectra, dt, s):
    """:class:`Seen` of one grid: with the step dt, and with steps from ``s`` downwards."""
    for k in (1, 2, 4):
        spectra.look(dt / k)
    limit, modes = vanishing(spectra, s)
    growth, place, grows = limit.largest
    large = [spectra.modes(dt / k) for k in (1, 2, 4)]
    cap = _cap(spectra, limit, float(large[0].growth.max()))
    return Seen(
        spectra, modes, limit, growth, float(limit.unsure[place]), grows, spectra.wavelength(modes, place),
        tuple(float(each.growth.max()) for each in large), float(np.abs(large[0].factor).max()), cap,
        amplified(spectra, dt, limit.dt, cap, growth),
    )  # fmt: skip


def _cap(spectra, limit, fastest):
    """(p, 1) growth as dt -> 0 that no mode of the same wave exceeds, by steps that tell it from the ``fastest``."""
    for _ in range(_FINER if fastest > 0 else 0):
        if not (limit.unsure - limit.noise > _SURE * fastest).any():
            break
        small = limit.dt / 4
        limit = rates_of(spectra.modes(small), spectra, small)
    return np.maximum((limit.rate + limit.unsure).max(axis=1, keepdims=True), 0.0)


def amplified(spectra, dt, s, cap, own=0.0):
    """(growth, wavelength, factor if it is larger) of the fastest mode that only a step of dt, not of s, lets grow.

    A mode of a large step need not be one of small steps: what these seem to do to it counts up to ``cap``. What grows
    far more slowly than the equations' ``own`` modes does not matter.
    """
    modes = spectra.modes(dt)
    limit = rates_of(modes, spectra, s)
    rate = np.log(np.maximum(np.abs(modes.factor), 1e-300))
    grows = rate > np.maximum(5 * modes.doubt, _WEAK * np.abs(np.angle(modes.factor)))
    slow = (limit.rate + limit.unsure * (limit.rate > 0) <= _HALF * modes.growth) & ~limit.open
    bad = grows & (slow | (cap <= _HALF * modes.growth))
    crowd = _CROWDED * float(modes.swing.max()) if modes.factor.shape[1] > 10 else 0.0
    bad &= modes.growth > max(_MINOR * own, modes.spread / dt, crowd / dt)
    bad &= rate > spectra.box.moved * modes.swing  # what a base state that moves may add

    if not bad.any():
        return None
    place = np.unravel_index(np.argmax(np.where(bad, modes.growth, -np.inf)), bad.shape)
    return float(modes.growth[place]), spectra.wavelength(modes, place), spectra.larger(modes, place)
