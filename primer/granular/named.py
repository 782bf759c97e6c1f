"""The granular laws by name, as the command line asks for them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from primer.checks import shown
from primer.granular.compaction import Compaction
from primer.granular.friction import MuI
from primer.granular.materials import GLASS_BEADS
from primer.granular.regularised import RegularisedMuI
from primer.granular.relaxing import MuIPhiI
from primer.granular.rheology import CIDR, CSSM, Coulomb, IncompressibleMuI
from primer.granular.text_law import TextLaw
from primer.granular.viscous import DruckerPrager
from primer.types import Law

LAWS = ("coulomb", "mui", "cssm", "cidr", "regularised", "mui-phii", "bingham", "herschel-bulkley", "text")


def named(
    law: str,
    compaction: Compaction,
    I: float,
    d: float = 1.0,
    rho: float = 1.0,
    mu1: float | None = None,
    mu2: float | None = None,
    I0: float | None = None,
    mu: float | None = None,
    K: float | None = None,
    n: float | None = None,
    c: float | None = None,
    Y: str | None = None,
    f: str | None = None,
    parameters: dict[str, float] | None = None,
) -> Law:
    """The law of one of the names LAWS; glass beads where mu1, mu2, I0 are left out, mu(I) at the state where mu is.

    K, n and c are those of ``DruckerPrager`` (0.1, 1 for "bingham" or 0.5 for "herschel-bulkley", and 0, where left
    out), Y, f and parameters those of ``TextLaw``.

    Raises
    ------
    ValueError    for another name, or for K, n, c, Y, f or parameters that the law does not have
    """
    if law not in LAWS:
        raise ValueError(f"law must be one of {', '.join(LAWS)}, got {shown(law)}")
    viscous, text = law in ("bingham", "herschel-bulkley"), law == "text"
    own = ("K", K, viscous), ("n", n, law == "herschel-bulkley"), ("c", c, viscous)
    for name, value, taken in (*own, ("Y", Y, text), ("f", f, text), ("parameters", parameters or None, text)):
        if value is not None and not taken:
            raise ValueError(f"{name} must be left out for the law {law}, which has none, got {shown(value)}")
    if text and Y is None:
        raise ValueError("Y must be given for the law text, such as 'm*p', got None")
    beads = GLASS_BEADS.friction
    friction = MuI(_or(mu1, beads.mu1), _or(mu2, beads.mu2), _or(I0, beads.I0))
    constant, consistency, cohesion = _or(mu, float(friction.mu(I))), _or(K, 0.1), _or(c, 0.0)
    laws: dict[str, Callable[[], Law]] = {
        "coulomb": lambda: Coulomb(constant),
        "mui": lambda: IncompressibleMuI(friction),
        "cssm": lambda: CSSM(constant, compaction),
        "cidr": lambda: CIDR(friction, compaction),
        "regularised": lambda: IncompressibleMuI(RegularisedMuI(friction.mu1, friction.mu2, friction.I0)),
        "mui-phii": lambda: MuIPhiI(friction),
        "bingham": lambda: DruckerPrager(constant, consistency, 1.0, cohesion, d, rho),
        "herschel-bulkley": lambda: DruckerPrager(constant, consistency, _or(n, 0.5), cohesion, d, rho),
        "text": lambda: TextLaw(str(Y), _or(f, "0"), parameters or {}),
    }
    return laws[law]()


def needs_phi(law: Law) -> bool:
    """Whether Y or f depends on a solids fraction that the law itself does not give."""
    return not (getattr(law, "incompressible", False) or hasattr(law, "Phi"))


def _or(value: Any, default: Any) -> Any:
    return default if value is None else value
