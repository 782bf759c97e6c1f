"""The stress path with a little noise: does a sheared layer stay uniform, and how thin is the band if it does not?"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from primer.checks import integer, real
from primer.granular.flow_rule import NoPressure
from primer.granular.layer import system_of
from primer.granular.march import MAX_STEPS, RIGID_BELOW, Outcome
from primer.granular.state import BaseState
from primer.types import Law


@dataclass(frozen=True, eq=False)
class Band:
    """A layer that was sheared with a little noise in it.

    Attributes
    ----------
    n, height       grid points across the layer, and its height at the start
    strain          (r,) recorded gamma t, the last one where the march ended
    p, tau          (r,) means over the layer
    phi             (r, n) solids fraction
    shear           (r, n) local rate of shear over its mean
    width           (r,) the part of the layer that takes half of its shear: 1/2 where it is uniform
    outcome         an ``Outcome`` and ``reason``, one sentence
    mass_drift      the largest change of the layer's mass, over the mass
    """

    n: int
    height: float
    strain: np.ndarray = field(repr=False)
    p: np.ndarray = field(repr=False)
    tau: np.ndarray = field(repr=False)
    phi: np.ndarray = field(repr=False)
    shear: np.ndarray = field(repr=False)
    width: np.ndarray = field(repr=False)
    outcome: Outcome
    reason: str
    mass_drift: float


def localise(
    law: Law,
    state: BaseState,
    n: int,
    strain: float = 0.5,
    height: float = 60.0,
    amplitude: float = 1e-4,
    modes: int = 12,
    seed: int = 1,
    points: int = 21,
    creep: float = 0.02,
) -> Band:
    """March the stress path of section A1.2 with noise in phi: the ``Band`` it makes on n points.

    The layer of ``stress_path``, now with waves across it (along its gradient): with a(s) and b(s) the local shear and
    stretch, ||D|| = sqrt(a^2 + b^2)/2, div u = b, and eqs. (cons-mom-no-expl-stress), (c-mass) in a coordinate that
    stretches with the layer. A light piston keeps its mean normal stress at the load (its mass is what a layer of one
    grain's thickness times d over the height has). The layer is taken to be periodic, and the inertia of its mean
    expansion is the piston's alone: that is what is left out. Direction and base flow are not frozen.

    For CSSM the gradient of such a layer is the direction (e44) at every instant.

    Parameters
    ----------
    law, state    as for ``stress_path``
    n             grid points, >= 4; derivatives are ``CENTRAL``
    strain        gamma t at the end
    height        of the layer, in d
    amplitude     of the noise in phi, relative to 1/10: ``modes`` cosines with random phases, the same on all grids
    seed          of the phases
    points        how many times are recorded
    creep         in the stress ||D|| is sqrt(||D||^2 + (creep ||D*||)^2), with ||D*|| that at the start: so the layer
                  beside a band creeps where it would stop; with 0 the march ends when it first does

    Returns
    -------
    Band; a layer that leaves what the law can say is an ``Outcome``

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not as above

    >>> from primer.granular import CSSM, EXAMPLE_COMPACTION, BaseState
    >>> law = CSSM(0.4, EXAMPLE_COMPACTION)
    >>> a, b = (localise(law, BaseState(p, 0.55, 0.01), 32, 0.15, points=2) for p in (0.55, 0.25))
    >>> print(f"A: {a.width[-1]:.2f}, B: less than a quarter, {b.width[-1] < 0.25}")
    A: 0.50, B: less than a quarter, True
    """
    strain = real("strain", strain, above=0)
    amplitude, modes = real("amplitude", amplitude, least=0), integer("modes", modes, least=1)
    points = integer("points", points, least=2)
    layer = system_of(law, state, n, height, creep)
    grid, f = layer.grid, float(law.f(state.p, state.phi, state.I))
    phases = np.random.default_rng(integer("seed", seed, least=0)).uniform(0, 2 * np.pi, modes)
    noise = np.cos(2 * np.pi / grid.period * np.multiply.outer(grid.x, np.arange(1, modes + 1)) + phases).sum(axis=1)
    noise *= 0.1 * amplitude / math.sqrt(modes)
    start = np.concatenate([np.zeros(2 * grid.n), noise, [0.0, 2 * f * float(state.D)]])
    return _followed(layer, start, strain, np.linspace(0, strain, points))


def _followed(layer, start, strain, asked):
    from scipy.integrate import BDF

    n, end = layer.grid.n, strain / layer.gamma
    rows, strains, waiting, outcome, reason, steps = [], [], list(asked), None, "", 0
    if not np.isfinite(layer.rhs(0.0, start)).all():
        raise ValueError("amplitude must leave each point of the layer a pressure at the start")
    solver = BDF(layer.rhs, 0.0, start, end, rtol=1e-5, atol=1e-6 * layer.unit, jac=layer.jacobian)

    def record(strain, y):
        strains.append(strain)
        rows.append((y, layer.seen(y)))

    while outcome is None:
        layer.lack = []
        try:
            with np.errstate(all="ignore"):
                solver.step()
            failed = solver.status == "failed"
        except (ValueError, RuntimeError, np.linalg.LinAlgError):
            failed = True
        steps += 1
        if failed or steps > MAX_STEPS:
            kinds = sorted(set(layer.lack), key=layer.lack.count)
            phi = bool(kinds) and kinds[-1] == NoPressure.PHI
            outcome = Outcome.PHI if phi else Outcome.NO_PRESSURE if kinds else Outcome.GAVE_UP
            reason = (
                f"At a strain of {solver.t * layer.gamma:.4g} {' and '.join(kinds) or 'the steps became too small'}."
            )
            record(solver.t * layer.gamma, solver.y)
            break
        while waiting and waiting[0] <= solver.t * layer.gamma * (1 + 1e-12):
            at = waiting.pop(0)
            record(at, start if at == 0 else solver.dense_output()(at / layer.gamma))
        least = layer.seen(solver.y)[-1]
        if least < RIGID_BELOW:
            outcome = Outcome.RIGID
            reason = f"At a strain of {solver.t * layer.gamma:.4g} a part of the layer stops: ||D|| = 0 has no stress."
            record(solver.t * layer.gamma, solver.y)
        elif solver.status == "finished":
            outcome, reason = Outcome.REACHED_END, f"The layer was sheared to its end, a strain of {strain:g}."
    seen = [row[1] for row in rows]
    mass = np.array([row[0][2 * n : 3 * n].mean() for row in rows]) + layer.state.phi
    p, tau, phi, shear, width = (np.array([row[j] for row in seen]) for j in range(5))
    drift = float(np.abs(mass / mass[0] - 1).max())
    return Band(n, layer.grid.period, np.array(strains), p, tau, phi, shear, width, outcome, reason, drift)
