"""Growth rates as dt -> 0: what the program lets grow, told from what the size of its step does.

The rate of each mode is measured with steps s, 2 s and 4 s. Where it converges with some power of s it is extrapolated;
where it does not yet, s is halved.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_HALVINGS = 20  # of the step, beyond the first three
_DEEP = 20  # halvings after which what an implicit step damps is called damped
_RESOLVED = 0.7  # |ln factor| of a mode that a step follows in time
_POWER_LAW = 0.35  # and where its error goes as a power of the step, up to four times that step
_SURE, _FAIR = 0.2, 0.4  # of the extrapolated part, that may be wrong: near a whole power of s, and else
_SMALL = 0.02  # of a rate: a change that needs no further step


@dataclass(frozen=True, eq=False)
class Limit:
    """Rates of modes as dt -> 0, each of shape (p, r).

    Attributes
    ----------
    dt       the least step used
    rate     extrapolated growth rates
    unsure   how far off they may be
    noise    that part of it which is of the step's noise
    open     whether a mode that grows has not converged
    """

    dt: float
    rate: np.ndarray
    unsure: np.ndarray
    noise: np.ndarray
    open: np.ndarray

    @property
    def grows(self):
        """Where growth is beyond doubt."""
        return self.rate > 2 * self.unsure

    @property
    def largest(self):
        """(rate, its place, whether it is growth beyond doubt); a rate within doubt of 0 is 0."""
        rate = np.where(np.abs(self.rate) > self.unsure, self.rate, np.minimum(self.rate, 0.0))
        place = np.unravel_index(np.argmax(rate), rate.shape)
        return float(rate[place]), place, bool(self.grows[place])


def rates_of(modes, spectra, s):
    """The :class:`Limit` of given modes, from what steps of s, 2 s and 4 s do to them."""
    # Of its own step each factor is known well, also where modes are nearly parallel and what others do is not.
    factors = [modes.factor if k * s == modes.dt else modes.under(spectra.matrices(k * s)) for k in (1, 2, 4)]
    g1, g2, g4 = (_logarithm(factor) / (k * s) for k, factor in zip((1, 2, 4), factors, strict=True))
    turns = np.abs(_logarithm(factors[0])) + np.abs(np.angle(factors[0]))
    louder = spectra.tangent(s).error / spectra.tangent(modes.dt).error / s
    noise = (modes.doubt + modes.spread) * louder
    loose = modes.loose * louder  # of two modes that are nearly one, a step that splits them otherwise shows as much
    near, far = g2 - g1, g4 - g2
    with np.errstate(all="ignore"):
        ratio = np.nan_to_num(far / near, nan=0.0, posinf=0.0, neginf=0.0)
        power = np.clip(np.round(np.log2(np.maximum(ratio, 1.0))), 1, 8)
    follows = (turns < _POWER_LAW) & (np.abs(g4) * 4 * s < _RESOLVED)
    regular = (np.abs(ratio / 2**power - 1) < 0.15) & follows
    fair = (ratio > 1.5) & follows
    rate = np.where(fair, g1 - near / (2**power - 1), g1)
    part = np.where(fair, np.abs(rate - g1) * np.where(regular, _SURE, _FAIR), np.maximum(np.abs(near), np.abs(far)))
    settled = np.abs(near) <= 2 * np.maximum(noise, loose)
    unsure = noise + np.where(settled, 0.0, part)
    same = np.maximum(np.abs(near), np.abs(far)) <= _SMALL * np.abs(g1)
    counts = g1 > np.maximum(noise, _SMALL * max(g1.max(), 0.0))
    return Limit(s, np.where(settled, g1, rate), unsure, noise, counts & ~settled & ~regular & ~same)


def vanishing(spectra, s):
    """The :class:`Limit` of all modes of the least step, and its :class:`~primer.study.modes.Modes`.

    ``s`` is the step to begin with.
    """
    least = s / 2**_HALVINGS
    while True:
        spectra.look(s)
        modes = spectra.modes(s)
        found = rates_of(modes, spectra, s)
        if not found.open.any() or s / 2 < least:
            return found, modes
        s /= 2


def unresolved(modes, most=_RESOLVED):
    """Whether some mode changes so much in a step that its rate may be hidden by it."""
    return bool((modes.swing > most).any())


def deep(spectra, s):
    """(found, modes) with a step so small that every mode is resolved, or the least that is tried."""
    least = s / 2**_DEEP
    while True:
        modes = spectra.modes(s)
        if not unresolved(modes, _POWER_LAW / 4) or s / 4 < least:
            return rates_of(modes, spectra, s), modes
        s /= 4


def _logarithm(factor):
    return np.log(np.maximum(np.abs(factor), 1e-300))
