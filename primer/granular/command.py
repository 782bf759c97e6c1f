"""What ``primer granular`` says: the hypotheses, the verdict and the limit of a granular law at a base state."""

from __future__ import annotations

import math

from primer.checks import real
from primer.granular.compaction import Compaction
from primer.granular.criteria import conditions, incompressible_criterion, neutral_inertial_numbers
from primer.granular.linearisation import coefficients
from primer.granular.materials import EXAMPLE_COMPACTION
from primer.granular.named import named, needs_phi
from primer.granular.posedness import growth_limit, verdict
from primer.granular.rheology import IncompressibleMuI
from primer.granular.state import BaseState


def report(law, p, phi=None, I=None, d=1.0, rho=1.0, phi0=None, eps=None, C0=None, dim=2, lode=0.0, **options):
    """What can be said of a law at a base state, as a dict of plain values (None for what is infinite, of either sign).

    ``law`` is one of ``named.LAWS``; the other names are those of ``named.named``, ``Compaction`` and ``BaseState``,
    glass beads and ``EXAMPLE_COMPACTION`` where left out. phi may be left out where only the density knows it: then it
    is 0.6, or Phi(I). dim and lode are those of ``verdict``, for the verdict and the limit; the hypotheses of the
    theorem are those of the plane.
    """
    packing = EXAMPLE_COMPACTION
    compaction = Compaction(_or(phi0, packing.phi0), _or(eps, packing.eps), _or(C0, packing.C0))
    p, I, d, rho = (real(name, value, above=0) for name, value in (("p", p), ("I", I), ("d", d), ("rho", rho)))
    lode = real("lode", lode)
    made = named(law, compaction, I, d, rho, **options)
    if phi is None:
        if needs_phi(made):
            raise ValueError(f"phi must be given for the law {law}, a function of the solids fraction, got None")
        phi = float(made.Phi(I)) if hasattr(made, "Phi") else 0.6
    state = BaseState(p, real("phi", phi, above=0), I, d, rho)
    c, holds, v = coefficients(made, state), conditions(made, state), verdict(made, state, dim, lode)
    answer = {
        "law": repr(made),
        "state": {"p": state.p, "phi": state.phi, "I": state.I, "d": state.d, "rho": state.rho},
        "dim": dim,
        "lode": lode if dim == 3 else None,
        "D": float(state.D),
        "tau": float(c.tau),
        "div_u": float(state.div_u(made)),
        "B": float(holds.B),
        "C": float(holds.C),
        "equality": bool(holds.equality),
        "Y_I": float(holds.Y_I),
        "a": bool(holds.a),
        "slope": float(holds.slope),
        "b": bool(holds.b),
        "verdict": str(v.kind),
        "exponent": str(v.exponent),
        "coefficient": _finite(v.coefficient),
        "direction": list(v.direction),
        "bound": _finite(v.bound),
        "unstable": v.unstable,
        "limit": _finite(growth_limit(made, state, dim, lode)),
        "reason": v.reason,
    }
    if isinstance(made, IncompressibleMuI):
        friction = made.friction
        says = incompressible_criterion(friction, I)
        answer |= {"n": float(says.n), "criterion_C": float(says.C)}
        answer["neutral_I"] = [float(value) for value in neutral_inertial_numbers(friction)]
    return answer


def text(answer):
    """The report as lines to read."""
    state = ", ".join(f"{name} = {value:g}" for name, value in answer["state"].items())
    space = answer["dim"] == 3
    plane = ", in the plane" if space else ""
    lines = [
        f"{answer['law']}",
        f"at {state}: ||D|| = {answer['D']:.6g}, ||tau|| = {answer['tau']:.6g}, div u = {answer['div_u']:.6g}",
        "",
        f"hypotheses of the theorem{plane}",
        f"  Y_p - I/(2p) Y_I = f + I f_I   {_says(answer['equality'])}   {answer['B']:.6g} and {answer['C']:.6g}",
        f"  (a) Y_I > 0                    {_says(answer['a'])}   {answer['Y_I']:.6g}",
        f"  (b) f_p - I/(2p) f_I < 0       {_says(answer['b'])}   {answer['slope']:.6g}",
    ]
    if "neutral_I" in answer:
        roots = ", ".join(f"{value:.10g}" for value in answer["neutral_I"]) or "none"
        lines += [
            f"criterion of the incompressible mu(I)-rheology: C <= 0 or n >= 1/2{plane}",
            f"  C = {answer['criterion_C']:.6g}, n = {answer['n']:.6g}; neutral inertial numbers: {roots}",
        ]
    unbounded = "infinity" if answer["verdict"] == "ill-posed" else "-infinity"
    limit = unbounded if answer["limit"] is None else f"{answer['limit']:.12g}"
    if space:
        lines += ["", f"in three dimensions, D at the Lode angle {answer['lode']:g} (radians)"]
        if all(map(math.isfinite, answer["direction"])):
            x = ", ".join(f"{value:.6g}" for value in answer["direction"])
            lines.append(f"  direction ({x}): along the axes of compression, of extension and the third")
    lines += [
        "",
        f"{answer['verdict']}: {answer['reason']}.",
        f"limit of the largest growth rate as |xi| -> infinity: {limit}",
    ]
    return "\n".join(lines)


def _or(value, default):
    return default if value is None else value


def _finite(value):
    return float(value) if math.isfinite(value) else None


def _says(holds):
    return "holds" if holds else "fails"
