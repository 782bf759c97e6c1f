"""Pictures: a style sheet, ``draw_*(axes, result)`` functions shared by figures and notebooks, and the explorers.

The explorers, which need ipywidgets, are loaded when they are first asked for.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from primer.view.explorers import BaseStateExplorer, HeatExplorer, PDEExplorer, RefinementExplorer, RheologyExplorer

__all__ = ["BaseStateExplorer", "HeatExplorer", "PDEExplorer", "RefinementExplorer", "RheologyExplorer"]


def __getattr__(name):
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from primer.view import explorers

    return getattr(explorers, name)


def __dir__():
    return sorted({*globals(), *__all__})
