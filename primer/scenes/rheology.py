"""The scene of the four granular laws: which is well posed at which state, how fast its waves grow, and why."""

from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from math import radians, tan
from typing import Any

import numpy as np

from primer.analysis.verdict import Verdict
from primer.checks import real, shown
from primer.granular.criteria import Conditions, conditions, neutral_inertial_numbers
from primer.granular.friction import MuI
from primer.granular.limits import leading
from primer.granular.linearisation import Coefficients, coefficients
from primer.granular.maps import neutral_stress_ratio
from primer.granular.materials import EXAMPLE_COMPACTION, GLASS_BEADS
from primer.granular.posedness import growth_limit, verdict
from primer.granular.rheology import CIDR, CSSM, Coulomb, IncompressibleMuI
from primer.granular.state import BaseState

LAWS = ("Coulomb", "mu(I)", "CSSM", "CIDR")
PHI = 0.55  # half-way between loose and jammed in EXAMPLE_COMPACTION
RISE = 12.0  # degrees by which fast flow has more friction than slow flow: glass beads, 21 and 33
I_MAP, RATIO_MAP = np.geomspace(1e-3, 10, 41), np.linspace(0.02, 1, 36)
_HYPOTHESES = (
    ("equality", "stress rises with pressure just as expansion does with shear"),  # at fixed ||D||, and at fixed p
    ("a", "friction rises with I"),
    ("b", "more pressure means less expansion"),  # at fixed ||D||
)


class Kind(StrEnum):
    """What the frozen equations are at a state."""

    STABLE = "stable"
    UNSTABLE = "unstable"  # the frozen equations: bounded growth, so well posed all the same
    ILL_POSED = "ill-posed"
    UNDECIDED = "undecided"  # a knife edge that the orders kept do not decide
    NOT_ADMITTED = "not admitted"  # the law knows no such flow


@dataclass(frozen=True, eq=False)
class RheologyMap:
    """What short waves do over the states, for one law.

    Attributes
    ----------
    I : array of shape (n,)            inertial numbers
    ratio : array of shape (m,)        p/C(phi); a straight edge lies half-way between two of them, or two of I
    kind : array of shape (m, n)       0 damped, 1 growth, but bounded, 2 ill posed like |xi| (or |xi|^(2/3)), 3 ill
                                       posed like |xi|^2, as ``primer.view.granular_growth.KINDS``; nan if not admitted
    edges : tuple of pairs of arrays   curves (I, ratio) on which that changes, in closed form
    top : array of shape (n,)          the p/C(phi) below which the law admits a state; infinite if all
    """

    I: np.ndarray
    ratio: np.ndarray
    kind: np.ndarray
    edges: tuple
    top: np.ndarray


@dataclass(frozen=True, eq=False)
class RheologyAnswer:
    """What :func:`rheology` found.

    Attributes
    ----------
    law, state     the law of :mod:`primer.granular` and the ``BaseState``, in units of grain diameters and densities
    ratio          p/C(phi)
    coefficients   of the frozen equations, from which growth rates follow; None if the law does not admit the state
    conditions     the hypotheses of the theorem, or None
    found          the :class:`primer.Verdict`, or None
    limit          the largest growth rate as |xi| -> infinity, in ||D||; nan if the law does not admit the state
    map            the ``RheologyMap`` of the law
    kind           a ``Kind``
    verdict        the same in words
    """

    law: Any
    state: BaseState
    ratio: float
    coefficients: Coefficients | None
    conditions: Conditions | None
    found: Verdict | None
    limit: float
    map: RheologyMap
    kind: Kind
    verdict: str


def rheology(law: str = "mu(I)", I: float = 0.1, ratio: float = 0.3, angle: float = 21.0) -> RheologyAnswer:
    """Freeze a granular law at a state and ask what becomes of its short waves (sections 2 to 4 of the paper).

    Parameters
    ----------
    law      one of LAWS
    I        inertial number, 10^-4 to 100
    ratio    p/C(phi), at phi = 0.55 and with the C(phi) of ``EXAMPLE_COMPACTION``: above 0, at most 2
    angle    friction angle of slow flow (degrees), 5 to 32: mu1 = tan(angle), which is also the mu of Coulomb and CSSM;
             mu2 = tan(angle + 12), I0 = 0.279; 21 are glass beads

    Raises
    ------
    TypeError, ValueError    for an argument outside these
    """
    if law not in LAWS:
        raise ValueError(f"law must be one of {', '.join(LAWS)}, got {shown(law)}")
    I, ratio = real("I", I, least=1e-4, most=100), real("ratio", ratio, above=0, most=2)
    angle = real("angle", angle, least=5, most=32)  # mu2 < 1: no law with |B| >= 1, which has no growth rates
    made = _made(law, angle)
    state = BaseState(ratio * EXAMPLE_COMPACTION.C(PHI), PHI, I)
    known = rheology_map(law, angle)
    if not made.Y(state.p, PHI, I) > 0:
        top = made.p_max(PHI, I) / EXAMPLE_COMPACTION.C(PHI)
        text = (
            f"Not admitted: {law} has a yield stress only for p/C < {top:.4g} at I = {I:.3g}, so at p/C = {ratio:.4g} "
            "there is no such flow to ask about."
        )
        return RheologyAnswer(made, state, ratio, None, None, None, np.nan, known, Kind.NOT_ADMITTED, text)
    c, holds, found = coefficients(made, state), conditions(made, state), verdict(made, state)
    limit = float(growth_limit(made, state) / state.D)
    kind = _kind(found)
    text = f"{_judged(kind, found, limit, state.D)} {_why(law, angle, holds)}"
    return RheologyAnswer(made, state, ratio, c, holds, found, limit, known, kind, text)


@lru_cache(maxsize=32)
def rheology_map(law, angle):
    """The ``RheologyMap`` of a law of LAWS, from closed forms, and kept, since I and p do not change it."""
    made = _made(law, angle)
    shape = RATIO_MAP.size, I_MAP.size
    I_axis = _straddling(I_MAP, _neutral(angle) if law == "mu(I)" else ())
    axis = _straddling(RATIO_MAP, _expanding(angle) if law == "CSSM" else ())
    I, p = np.broadcast_arrays(I_axis, axis[:, None] * EXAMPLE_COMPACTION.C(PHI))
    inside = made.Y(p, PHI, I) > 0
    lead = leading(coefficients(made, BaseState(p[inside], PHI, I[inside])))
    kind = np.full(shape, np.nan)
    kind[inside] = np.where(lead.ill_posed, np.where(lead.exponent > 1.5, 3.0, 2.0), np.where(lead.limit > 0, 1.0, 0.0))
    ends = RATIO_MAP[[0, -1]]
    top = np.full(I_axis.shape, np.inf)
    edges: tuple = ()
    if law == "mu(I)":
        edges = tuple((np.full(2, value), ends) for value in _neutral(angle))
    if law == "CSSM":
        edges = tuple((I_axis[[0, -1]], np.full(2, ratio)) for ratio in _expanding(angle) if ratio > ends[0])
    if law == "CIDR":
        edges = ((I_axis, made.friction.alpha(I_axis) - neutral_stress_ratio(made.friction, I_axis)),)
    if not made.incompressible:
        top = made.p_max(PHI, I_axis) / EXAMPLE_COMPACTION.C(PHI)
    return RheologyMap(I_axis, axis, kind, edges, top)


def _straddling(axis, edges):
    """The axis with the two neighbours of each edge moved to either side of it, so that cells meet at the edge."""
    axis = axis.copy()
    for edge in edges:
        i = np.searchsorted(axis, edge)
        if 0 < i < axis.size:
            axis[i - 1 : i + 1] = edge + np.array([-0.5, 0.5]) * (axis[i] - axis[i - 1])
    return axis


def _made(law, angle):
    mu1, friction = tan(radians(angle)), _friction(angle)
    return {
        "Coulomb": lambda: Coulomb(mu1),
        "mu(I)": lambda: IncompressibleMuI(friction),
        "CSSM": lambda: CSSM(mu1, EXAMPLE_COMPACTION),
        "CIDR": lambda: CIDR(friction, EXAMPLE_COMPACTION),
    }[law]()


def _friction(angle):
    return MuI(tan(radians(angle)), tan(radians(angle + RISE)), GLASS_BEADS.friction.I0)


@lru_cache(maxsize=32)
def _neutral(angle):
    return tuple(neutral_inertial_numbers(_friction(angle)).tolist())


def _expanding(angle):
    """The p/C between which CSSM is ill posed: 0 <= f = Y_p = 2 mu - 2 p/C < 1, so that eq. (e44) has directions."""
    mu = tan(radians(angle))
    return mu - 1 / 2, mu


def _kind(found):
    if found.kind != "well-posed":
        return Kind(str(found.kind))
    return Kind.UNSTABLE if found.unstable else Kind.STABLE


def _judged(kind, found, limit, D):
    if kind is Kind.UNDECIDED:
        return f"Undecided: {found.reason}."
    degrees = np.degrees(np.arctan2(found.direction[1], found.direction[0]))
    power = {"1": "|ξ|d", "2/3": "(|ξ|d)^(2/3)"}.get(str(found.exponent), "(|ξ|d)^2")
    if kind is Kind.ILL_POSED:
        return (
            f"Ill posed: the shorter a wave the faster it grows, like {found.coefficient / D:.3g} ‖D‖ {power} without "
            f"end, and fastest at {degrees:.3g}° from the major compressive axis. A finer grid blows up sooner."
        )
    if kind is Kind.UNSTABLE:
        short = "short waves decay" if limit < 0 else f"the shortest grow at {limit:.3g} ‖D‖"
        return (
            f"Well posed, with growth: frozen at this state waves grow, yet none faster than {found.bound / D:.3g} "
            f"‖D‖, however short ({short}). Finer grids agree upon that."
        )
    tends = f"at {-limit:.3g} ‖D‖" if np.isfinite(limit) else f"like {-found.coefficient / D:.3g} ‖D‖ {power}"
    return f"Well posed: no wave grows, and short waves decay {tends} or faster."


def _why(law, angle, holds):
    false = [words for name, words in _HYPOTHESES if not getattr(holds, name)]
    if not false:
        return (
            f"The theorem promises it, since its three hypotheses hold: {'; '.join(words for _, words in _HYPOTHESES)}."
        )
    words = f"The theorem does not apply. What it asks for and fails: {'; '.join(false)}."
    if law == "mu(I)":
        neutral = " and ".join(f"{value:.3g}" for value in _neutral(angle))
        words += f" mu(I) is well posed only between I = {neutral}." if neutral else " mu(I) is ill posed at every I."
    if law == "CSSM":
        low, high = _expanding(angle)
        where = f"for {low:.3g} < p/C <= {high:.3g}" if low > 0 else f"for p/C <= {high:.3g}"
        words += f" CSSM is ill posed {where}, where it does not shrink{' (and dY/dp < 1)' if low > 0 else ''}."
    return words
