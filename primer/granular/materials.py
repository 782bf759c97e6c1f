"""Parameters from the literature, with their sources."""

import math
from dataclasses import dataclass

from primer.granular.compaction import Compaction
from primer.granular.friction import MuI


@dataclass(frozen=True)
class Material:
    """A granular material: its friction law (dimensionless), grain diameter d (m), grain density rho (kg/m^3), source.

    d and rho are None where the source works in dimensionless units.
    """

    friction: MuI
    d: float | None
    rho: float | None
    source: str


#: Glass beads. The angles are those of the fit to flows down inclines, 20.9 and 32.76 degrees, to whole degrees.
GLASS_BEADS = Material(
    MuI(mu1=math.tan(math.radians(21)), mu2=math.tan(math.radians(33)), I0=0.279),
    d=0.53e-3,
    rho=2450.0,
    source="Jop, Forterre & Pouliquen, J. Fluid Mech. 541 (2005) 167 and Nature 441 (2006) 727",
)

#: Glass beads, the same fit with the friction coefficients to three digits, as the ill-posedness paper uses it.
GLASS_BEADS_2015 = Material(
    MuI(mu1=0.383, mu2=0.643, I0=0.279),
    d=0.53e-3,
    rho=2450.0,
    source="Barker, Schaeffer, Bohorquez & Gray, J. Fluid Mech. 779 (2015) 794",
)

#: Fine glass beads.
GLASS_BEADS_2017 = Material(
    MuI(mu1=0.342, mu2=0.557, I0=0.069),
    d=0.5e-3,
    rho=2500.0,
    source="Barker & Gray, J. Fluid Mech. 828 (2017) 5",
)

#: Frictional discs in two-dimensional contact-dynamics simulations of collapsing columns.
DISCS_2011 = Material(
    MuI(mu1=0.32, mu2=0.60, I0=0.4),
    d=None,
    rho=None,
    source="Lagree, Staron & Popinet, J. Fluid Mech. 686 (2011) 378",
)

#: An illustrative C(phi) in units of C0; the paper fixes the form z/(1 - z) but no numbers.
EXAMPLE_COMPACTION = Compaction(phi0=0.5, eps=0.1, C0=1.0)
