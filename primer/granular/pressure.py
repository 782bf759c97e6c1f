"""The evolution form, eq. (22): pressure and shear stress from the rate of strain and the solids fraction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from primer.checks import affordable, broadcast, real_array, shown
from primer.granular.flow_rule import MOST, FlowRule, NoPressure, root
from primer.granular.state import a_law
from primer.types import ArrayLike, Law, Numbers

_BLOCK = 2**16  # states at a time: some ten MB


@dataclass(frozen=True, eq=False)
class Stress:
    """What a rate of strain and a solids fraction say of the stress; arrays of the broadcast shape, numbers for one.

    Attributes
    ----------
    p         pressure P; nan where there is none
    T         shear stress ||tau|| = Y(P, phi, I); nan likewise
    I         inertial number 2 d ||D||/sqrt(P/rho); nan likewise
    reason    a ``NoPressure``, or an array of them, of dtype object

    P, T and I are those of eq. (cons-mom-no-expl-stress).

    >>> from primer.granular import CSSM, Compaction, stress
    >>> found = stress(CSSM(0.4, Compaction(phi0=0.5, eps=0.1, C0=1.0)), div=0.0, D=1.0, phi=0.55)
    >>> print(f"{found.p:.2f} {found.T:.2f} {found.reason}")  # the critical state: p = mu C, ||tau|| = mu p
    0.40 0.16 none
    """

    p: Numbers
    T: Numbers
    I: Numbers
    reason: Numbers


def pressure(
    law: Law, div: ArrayLike, D: ArrayLike, phi: ArrayLike, d: ArrayLike = 1.0, rho: ArrayLike = 1.0
) -> Numbers:
    """P(grad u, phi), the solution p of the flow rule f(p, phi, 2 d ||D||/sqrt(p/rho)) = div u/(2 ||D||).

    Eq. (flow-rule-Cmu-rewritten). By hypothesis (b) of the theorem the left-hand side falls with p, so that there is at
    most one. It is found from its bracket by Newton's method to the last bits that f allows.

    Parameters
    ----------
    law      a compressible law, as in ``linearise``
    div      div u, in 1/time; positive where the material expands
    D        ||D|| > 0, in 1/time
    phi      solids fraction, dimensionless
    d, rho   grain diameter and density of the grains, both > 0; all five are numbers or arrays that broadcast

    Returns
    -------
    the pressure, in the units of C0: a float for numbers, else an array of the broadcast shape. It is nan where the
    flow has none, and ``stress(...).reason`` says why: the answer is the same for a number as in an array.

    Raises
    ------
    TypeError, ValueError    if an argument is not an array of numbers, the shapes do not broadcast, d or rho is not a
                             finite number > 0, or the law is incompressible: its pressure is no function of the flow

    A law for which (b) fails may have several pressures. They are looked for at 25 inertial numbers from 1e-128 to
    1e128, one a decade from 1e-8 to 1e8: two that lie closer together than that are not seen, but the one that is
    returned has f falling with p.

    >>> from primer.granular import CIDR, EXAMPLE_COMPACTION, GLASS_BEADS, BaseState
    >>> law, state = CIDR(GLASS_BEADS.friction, EXAMPLE_COMPACTION), BaseState(p=0.2, phi=0.55, I=0.1)
    >>> print(f"{pressure(law, state.div_u(law), state.D, state.phi):.12f}")
    0.200000000000
    """
    return stress(law, div, D, phi, d, rho).p


def stress(law: Law, div: ArrayLike, D: ArrayLike, phi: ArrayLike, d: ArrayLike = 1.0, rho: ArrayLike = 1.0) -> Stress:
    """P, T and I of eq. (cons-mom-no-expl-stress), and the reason where there are none: a ``Stress``.

    The arguments and errors are those of ``pressure``.

    >>> from primer.granular import CIDR, EXAMPLE_COMPACTION, GLASS_BEADS
    >>> found = stress(CIDR(GLASS_BEADS.friction, EXAMPLE_COMPACTION), div=0.0, D=0.02, phi=[0.55, 0.49])
    >>> print(found.p.round(4), *found.reason)
    [0.3924    nan] none phi out of range
    """
    a_law(law)
    if getattr(law, "incompressible", False):
        raise ValueError(f"law must be compressible, for its pressure to be a function of the flow, got {shown(law)}")
    for name, value in (("d", d), ("rho", rho)):
        if not (real_array(name, value) > 0).all():
            raise ValueError(f"{name} must be > 0{' everywhere' if np.ndim(value) else ''}, got {shown(value)}")
    arrays = broadcast(
        div=_numbers("div", div), D=_numbers("D", D), phi=_numbers("phi", phi), d=np.asarray(d), rho=np.asarray(rho)
    )
    shape = arrays[0].shape
    affordable("div, D and phi: the pressures", 64 * arrays[0].size, f"shape {shape}")
    flat = [np.ravel(a).astype(float) for a in arrays]
    if (flat[1] < 0).any():
        raise ValueError(f"D must be >= 0, being the norm of the rate of strain, got {shown(D)}")
    parts = [solve(law, *(a[i : i + _BLOCK] for a in flat)) for i in range(0, max(flat[0].size, 1), _BLOCK)]
    p, T, I, reason = (np.concatenate(column).reshape(shape)[()] for column in zip(*parts, strict=True))
    return Stress(p, T, I, reason)


def solve(law, div, D, phi, d, rho):
    """(p, T, I, reason) for flat arrays, without the checks of ``stress``."""
    reason = np.full(div.shape, NoPressure.NONE, dtype=object)
    with np.errstate(all="ignore"):
        X = div / (2 * D)
        scale = rho * (2 * d * D) ** 2  # p at I = 1
    reason[~(np.isfinite(div) & np.isfinite(D) & np.isfinite(phi))] = NoPressure.NOT_FINITE
    open_ = reason == NoPressure.NONE
    reason[open_ & (scale > MOST)] = NoPressure.NOT_FINITE
    open_ = reason == NoPressure.NONE
    reason[open_ & ~((scale > 0) & np.isfinite(X))] = NoPressure.NO_SHEAR
    open_ = reason == NoPressure.NONE
    reason[open_ & ~has_strength(law, phi, open_)] = NoPressure.PHI
    p, T, I = (np.full(div.shape, np.nan) for _ in range(3))
    todo = np.flatnonzero(reason == NoPressure.NONE)
    if todo.size:
        rule = FlowRule(law, X[todo], phi[todo], scale[todo])
        p[todo], reason[todo] = root(rule)
    todo = np.flatnonzero(reason == NoPressure.NONE)
    I[todo] = np.sqrt(scale[todo] / p[todo])
    if todo.size:
        with np.errstate(all="ignore"):
            T[todo] = law.Y(p[todo], phi[todo], I[todo])
    bad = todo[~((T[todo] > 0) & (T[todo] < np.inf))]
    reason[bad] = NoPressure.YIELD
    p[bad] = T[bad] = I[bad] = np.nan
    return p, T, I, reason


def has_strength(law, phi, asked):
    """Where the law has values at this phi: by its C(phi) where it has one, else by asking it."""
    found = np.zeros(phi.shape, bool)
    packing = getattr(law, "compaction", None)
    if packing is not None and hasattr(packing, "phi0") and hasattr(packing, "eps"):
        z = (phi - packing.phi0) / packing.eps
        found[asked] = ((z > 0) & (z < 1) & (phi < packing.phi0 + packing.eps))[asked]
        return found
    asked = np.flatnonzero(asked & (phi > 0) & (phi <= 1))
    if asked.size:
        try:
            law.f(np.ones(asked.size), phi[asked], np.ones(asked.size))
            found[asked] = True
        except ValueError:  # somewhere: find out where
            for j in asked:
                try:
                    law.f(1.0, phi[j], 1.0)
                    found[j] = True
                except ValueError:
                    pass
    return found


def _numbers(name, value):
    """A float array that may hold nan or infinity, or one sentence why not."""
    try:
        array = np.asarray(value)
    except ValueError:
        array = np.empty(0, dtype=object)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name} must be a number or an array of numbers, got {shown(value)}")
    return array.astype(float)
