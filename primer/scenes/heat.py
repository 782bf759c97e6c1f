"""The scene of the backward heat equation, eq. (backward-heat): when a grid takes over, and how little it needs."""

import math
from dataclasses import dataclass

import numpy as np

from primer.checks import integer, real
from primer.problems.heat import BackwardHeat
from primer.schemes.discrete import amplification
from primer.schemes.grid import Grid
from primer.study.refinement import HeatOnset, heat_onset

T_END = 1.5  # where the exact solution is 4.5 sin x
TOLERANCE = 0.1  # what a reader sees beside e^t sin x
_SHOTS = np.linspace(0, T_END, 151)  # times that can be looked at
_BIT = 2.0**-53  # the relative size of a rounding error


@dataclass(frozen=True, eq=False)
class HeatAnswer:
    """What :func:`heat` found; pairs are of the grids n and 2n.

    Attributes
    ----------
    onset        :class:`primer.study.refinement.HeatOnset`: the runs, with snapshots at every hundredth unit of time,
                 their departures, and ``onset.t`` when these pass ``TOLERANCE``; infinite if not by t = 1.5
    size         what starts at the sawtooth: the stated seed, or the 2^-53 of a rounding error if that is larger
    growth       (2,) rate ln(1 + 4 dt/h^2)/dt of the sawtooth, the shortest wave of each grid
    predicted    (2,) ln(TOLERANCE/size)/growth, in closed form
    xi, rate     (k,) wavenumbers and xi^2, that of the equation; xi from 1 to the cut-off n of the finer grid
    grid_xi, grid_rate    pairs of (k,): the same as grid and step see it, up to the cut-off pi/h
    verdict      the same in words
    """

    onset: HeatOnset
    size: float
    growth: np.ndarray
    predicted: np.ndarray
    xi: np.ndarray
    rate: np.ndarray
    grid_xi: tuple[np.ndarray, ...]
    grid_rate: tuple[np.ndarray, ...]
    verdict: str


def heat(n: int = 24, courant: float = 0.05, seed: float = 1e-12) -> HeatAnswer:
    """March u_t = -u_xx from sin x plus ``seed`` times the sawtooth (-1)^j on n and on 2n points, dt = courant h^2.

    With a seed of 0, round-off is the only one.

    Raises
    ------
    TypeError, ValueError    for n not a multiple of four in [4, 256], courant outside [0.005, 2], or seed outside
                             [0, 0.01]
    """
    if integer("n", n, least=4, most=256) % 4:
        raise ValueError(f"n must be a multiple of 4, so that pi/2 is a grid point, got {n}")
    courant, seed = real("courant", courant, least=0.005, most=2), real("seed", seed, least=0, most=0.01)
    onset = heat_onset((n, 2 * n), courant, TOLERANCE, seed, t_end=T_END, snapshots=_SHOTS)
    size = max(seed, _BIT)
    found = [_seen(Grid(m), courant) for m in (n, 2 * n)]
    grid_xi, grid_rate = zip(*found, strict=True)
    growth = np.array([rate[-1] for rate in grid_rate])
    predicted = math.log(TOLERANCE / size) / growth
    xi = np.geomspace(1, 2 * n, 65)
    verdict = _verdict(onset, seed, size, growth, predicted)
    return HeatAnswer(onset, size, growth, predicted, xi, xi**2, grid_xi, grid_rate, verdict)


def _seen(grid, courant):
    """(xi, growth per unit time) on a grid in steps of courant h^2: ln(1 + 4 courant sin^2(xi h/2))/dt."""
    xi, dt = np.geomspace(1, grid.n / 2, 65), courant * grid.h**2
    factors = amplification(BackwardHeat().symbol(xi, grid.multiplier), dt)[..., 0].real
    return xi, np.log(factors) / dt


def _verdict(onset, seed, size, growth, predicted):
    (n, fine), (seen, sooner) = onset.refinement.n, onset.t
    source = f"a sawtooth of {seed:.3g}" if seed >= _BIT else f"the last bit ({size:.2g})"
    first = (
        f"Ill posed: the equation makes a wave of wavenumber xi grow like e^(xi^2 t), without bound. On N = {n} points "
        f"the shortest grows like e^({growth[0]:.3g} t), and from {source} it is foretold to be seen at "
        f"t = {predicted[0]:.3g}"
    )
    if not seen < math.inf:
        second = f"after the end of this picture at t = {T_END:g}: this grid looks fine"
        if sooner < math.inf:
            second += f", and the finer one of N = {fine} is lost at t = {sooner:.3g}"
        else:
            second += f", as does that of N = {fine}; refine once more"
        return f"{first}, {second}. {_third(growth[0], n)}"
    halved = f"Half the spacing, N = {fine}, is lost at t = {sooner:.3g}, {seen / sooner:.3g} times sooner."
    return f"{first}; it was seen at t = {seen:.3g}. {halved} {_third(growth[0], n)}"


def _third(growth, n):
    return (
        f"Smaller steps do not help: as dt goes to zero the rate rises to 4/h^2 = {4 / Grid(n).h ** 2:.3g}. "
        f"Nor do smaller data: a seed a thousand times smaller buys {math.log(1000) / growth:.2g} of time. "
        "Small data, large solutions: Hadamard's third condition fails."
    )
