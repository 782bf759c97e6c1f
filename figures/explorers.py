"""The five explorers as they open: what a reader moves in the course, each drawn by its own function.

From above: the base state of the toy system, eq. (toy-pde), at a = 0.5 on 100 points; three grids side by side; the
backward heat equation; the four granular laws; and any PDE that a reader types. Each answers in a sentence too.
"""

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from sidecar import same

from primer.view.explorers import BaseStateExplorer, HeatExplorer, PDEExplorer, RefinementExplorer, RheologyExplorer
from primer.view.explorers.state import defaults, read_state

STATES = {
    BaseStateExplorer: "a=0.5,t=12",
    RefinementExplorer: "",
    HeatExplorer: "",
    RheologyExplorer: "law=mu(I),I=0.01",
    PDEExplorer: "",
}


def compute():
    found = {}
    for explorer, state in STATES.items():
        controls = (*explorer.controls, *explorer.looks)
        values = defaults(controls) | read_state(controls, state)
        looks = {control.name: values.pop(control.name) for control in explorer.looks}
        found[explorer] = explorer.answer(**values), looks
    return found


def numbers(result):
    # What is in a verdict may hang on round-off; how it begins does not.
    return {
        explorer.__name__: same(answer.verdict.split(" ")[0], "as drawn") for explorer, (answer, _) in result.items()
    }


def draw(result):
    figure = Figure(figsize=(11, sum(explorer.layout["height"] for explorer in result)))
    FigureCanvasAgg(figure)
    parts = figure.subfigures(len(result), 1, height_ratios=[explorer.layout["height"] for explorer in result])
    for part, (explorer, (answer, looks)) in zip(parts, result.items(), strict=True):
        layout = explorer.layout
        places = np.arange(layout.get("rows", 1) * layout["columns"]).reshape(-1, layout["columns"])
        options = {key: layout[key] for key in ("width_ratios", "per_subplot_kw") if key in layout}
        axes = part.subplot_mosaic(places.tolist(), **options)
        part.suptitle(explorer.__name__, x=0.01, ha="left", fontsize=11, fontweight="bold")
        explorer.draw(np.array([axes[k] for k in places.flat]), answer, **looks)
    return figure
