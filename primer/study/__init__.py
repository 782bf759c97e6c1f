"""Many runs, one question: the only place that loops over runs."""

from primer.study.cost import cost_against_n, work_precision
from primer.study.refinement import heat_onset, refine

__all__ = ["cost_against_n", "heat_onset", "refine", "work_precision"]
