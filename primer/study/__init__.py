"""Many runs, one question: the only place that loops over runs."""

from primer.study.cost import cost_against_n, work_precision
from primer.study.diagnosis import diagnose
from primer.study.examination import examine
from primer.study.maps import blow_up_map
from primer.study.refinement import heat_onset, refine
from primer.study.stability import stable_dt
from primer.study.threshold import grid_threshold

__all__ = [
    "blow_up_map",
    "cost_against_n",
    "diagnose",
    "examine",
    "grid_threshold",
    "heat_onset",
    "refine",
    "stable_dt",
    "work_precision",
]
