"""A primer on ill-posed PDEs and grid-dependent computations.

The package reproduces Appendix 2 of Barker, Schaeffer, Shearer & Gray, "Well-posed continuum equations for granular
flow with compressibility and mu(I)-rheology", Proc. R. Soc. A 473 (2017), and that paper's dispersion analysis.

Public names are loaded when they are first asked for, so ``import primer`` costs no more than ``import numpy``.
"""

from importlib import import_module

__version__ = "0.1.0"

_HOME = {
    "BackwardHeat": "problems.heat",
    "BaseState": "granular.state",
    "CENTRAL": "schemes.grid",
    "CENTRAL_4": "schemes.grid",
    "CENTRAL_6": "schemes.grid",
    "CIDR": "granular.rheology",
    "CSSM": "granular.rheology",
    "Compaction": "granular.compaction",
    "Conditions": "analysis.conditions",
    "Coulomb": "granular.rheology",
    "Diagnosis": "study.diagnosis",
    "ETDRK4": "schemes.exponential",
    "EULER": "schemes.runge_kutta",
    "Examination": "study.examination",
    "FOURIER": "schemes.fourier",
    "Friction": "granular.friction",
    "GridThreshold": "study.threshold",
    "IncompressibleMuI": "granular.rheology",
    "Lines": "schemes.lines",
    "MaxGrowth": "analysis.directions",
    "MuI": "granular.friction",
    "PDE": "problems.pde",
    "PDEError": "equations.error",
    "PastHorizon": "schemes.horizon",
    "Pencil": "analysis.pencil",
    "RK4": "schemes.runge_kutta",
    "RK8": "schemes.runge_kutta",
    "Reference": "schemes.reference",
    "Region": "study.region",
    "Run": "schemes.run",
    "Seed": "schemes.run",
    "Stop": "schemes.run",
    "Toy": "problems.toy",
    "Verdict": "analysis.outcome",
    "blow_up_map": "study.maps",
    "conditions": "analysis.conditions",
    "cost_against_n": "study.cost",
    "critical_state": "granular.criteria",
    "diagnose": "study.diagnosis",
    "exact_march": "study.exact",
    "examine": "study.examination",
    "ftcs": "schemes.ftcs",
    "ftcs_ensemble": "schemes.ensemble",
    "grid_threshold": "study.threshold",
    "growth": "analysis.pencil",
    "growth_laws": "analysis.laws",
    "growth_limit": "granular.posedness",
    "growth_rates": "analysis.symbolic",
    "heat_onset": "study.refinement",
    "linearise": "analysis.symbolic",
    "march_lines": "schemes.lines",
    "max_growth": "analysis.directions",
    "neutral_inertial_numbers": "granular.criteria",
    "reference": "schemes.reference",
    "refine": "study.refinement",
    "region": "study.region",
    "stable_dt": "study.stability",
    "verdict": "analysis.verdict",
    "work_precision": "study.cost",
}
_ROOMS = ("exercises", "equations", "problems", "schemes", "analysis", "granular", "study", "scenes", "view")

__all__ = sorted(_HOME)


def __getattr__(name):
    """Load a public name, or one of the package's rooms, on first use."""
    if name in _ROOMS:
        return import_module(f"{__name__}.{name}")
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted({*globals(), *_HOME, *_ROOMS})
