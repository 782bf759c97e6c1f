"""Explorers: move a number, and see at once what becomes of the equations, the grid and the run.

Each explorer is three things kept apart: a scene of :mod:`primer.scenes` that answers, the figures' own ``draw_*``
functions, and controls. ``BaseStateExplorer()`` at the end of a notebook cell shows one.
"""

from primer.view.explorers.base_state import BaseStateExplorer
from primer.view.explorers.heat import HeatExplorer
from primer.view.explorers.pde import PDEExplorer
from primer.view.explorers.refinement import RefinementExplorer
from primer.view.explorers.rheology import RheologyExplorer

__all__ = ["BaseStateExplorer", "HeatExplorer", "PDEExplorer", "RefinementExplorer", "RheologyExplorer"]
