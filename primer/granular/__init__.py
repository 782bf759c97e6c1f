"""Granular rheologies under the same test: Coulomb, mu(I), CSSM and CIDR (sections 2 to 4 of the paper)."""

from primer.granular.ansatz import Ansatz
from primer.granular.compaction import Compaction
from primer.granular.criteria import conditions, critical_state, incompressible_criterion, neutral_inertial_numbers
from primer.granular.flow_rule import NoPressure
from primer.granular.friction import Friction, MuI
from primer.granular.linearisation import coefficients, linearise
from primer.granular.localisation import localise
from primer.granular.march import march_waves
from primer.granular.materials import DISCS_2011, EXAMPLE_COMPACTION, GLASS_BEADS, GLASS_BEADS_2015, GLASS_BEADS_2017
from primer.granular.mode_growth import mode_growth
from primer.granular.posedness import growth_limit, largest_growth, verdict
from primer.granular.pressure import Stress, pressure, stress
from primer.granular.regularised import RegularisedMuI
from primer.granular.relaxing import MuIPhiI
from primer.granular.rheology import CIDR, CSSM, Coulomb, IncompressibleMuI
from primer.granular.state import BaseState, admit
from primer.granular.stress_path import stress_path
from primer.granular.text_law import TextLaw
from primer.granular.viscous import DruckerPrager
from primer.granular.waves import PlaneWave

__all__ = [
    "CIDR",
    "CSSM",
    "DISCS_2011",
    "EXAMPLE_COMPACTION",
    "GLASS_BEADS",
    "GLASS_BEADS_2015",
    "GLASS_BEADS_2017",
    "Ansatz",
    "BaseState",
    "Compaction",
    "Coulomb",
    "DruckerPrager",
    "Friction",
    "IncompressibleMuI",
    "MuI",
    "MuIPhiI",
    "NoPressure",
    "PlaneWave",
    "RegularisedMuI",
    "Stress",
    "TextLaw",
    "admit",
    "coefficients",
    "conditions",
    "critical_state",
    "growth_limit",
    "incompressible_criterion",
    "largest_growth",
    "linearise",
    "localise",
    "march_waves",
    "mode_growth",
    "neutral_inertial_numbers",
    "pressure",
    "stress",
    "stress_path",
    "verdict",
]
