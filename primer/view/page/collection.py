"""The five pages: of each explorer the states that its page holds, chosen so that a page stays under some megabytes."""

import numpy as np

from primer.view.explorers import BaseStateExplorer, HeatExplorer, PDEExplorer, RefinementExplorer, RheologyExplorer
from primer.view.explorers.state import defaults, read_state
from primer.view.page import explorer_page
from primer.view.page.atlas import Shelf, atlas, shelf
from primer.view.page.closed import closed_form

#: Explorer -> (name of its page, title, what a reader is told first, as HTML).
PAGES = {
    BaseStateExplorer: (
        "base_state",
        "One number, and a system of PDEs stops making sense",
        "The toy system u<sub>t</sub> = v<sub>x</sub>, v<sub>t</sub> = ε u v<sub>xx</sub> + u<sub>x</sub> − v − sin x "
        "begins at u = a, v = −(sin x)/2 on a circle and heads for the steady state u = a − cos x, v = 0. Its second "
        "derivative damps short waves where u is positive. Where u is negative it feeds them, the shorter the more, "
        "without bound: the equations are ill posed, and what a computer makes of them depends on its grid. Move "
        "the base state a, ε, the number N of grid points, or time.",
    ),
    RefinementExplorer: (
        "refinement",
        "Three grids: is the finest the best?",
        "The toy system on N, 2N and 4N points with one time step. Where the equations are well posed refining helps; "
        "where they are not, finer is sooner.",
    ),
    HeatExplorer: (
        "heat",
        "The backward heat equation: how soon a grid takes over",
        "u<sub>t</sub> = −u<sub>xx</sub> from sin x, with a little of the shortest wave of the grid. Shrink the seed, "
        "the step or the spacing: the grid takes over all the same, and sooner the finer it is.",
    ),
    RheologyExplorer: (
        "rheology",
        "Four granular laws: whose short waves grow?",
        "At which states do short waves grow, in which direction, and does the growth have an end? Growth rates are in "
        "units of ‖D‖, wavenumbers in units of 1/d, the grain diameter; slow flow has a friction angle of 21°.",
    ),
    PDEExplorer: (
        "pde",
        "Is this PDE ill posed, and would a grid show it?",
        "A PDE: do its short waves grow, frozen at a base state, and what does it do itself on N, 2N and 4N points? "
        "Any other equation is for the package: <code>primer verdict</code>, <code>primer run</code>.",
    ),
}
_VALUES: dict = {
    BaseStateExplorer: {
        "a": (-1.0, -0.5, 0.0, 0.5, 0.75, 0.9, 1.0, 1.1, 1.5, 2.0),
        "eps": (0.003, 0.01, 0.03),
        "n": (16, 30, 64, 100, 200),
        "t": (0.0, 1.0, 2.0, 3.0, 5.0, 8.0, 12.0, 14.0, 20.0, 50.0, 100.0),
    },
    RefinementExplorer: {
        "a": (0.0, 0.5, 0.75, 1.0, 1.05, 1.25, 1.5),
        "n": (15, 30, 50, 60, 64),
        "dt": (1e-4, 1e-3, 2e-2),
        "t": (0.0, 1.0, 2.0, 3.0, 5.0, 10.0, 40.0),
    },
    HeatExplorer: {
        "n": (12, 16, 24, 48, 64),
        "courant": (0.01, 0.05, 0.5),
        "seed": (0.0, 1e-12, 1e-8, 1e-4),
        "t": (0.0, 0.05, 0.13, 0.3, 0.46, 0.5, 0.7, 1.0, 1.5),
    },
    RheologyExplorer: {
        "law": ("Coulomb", "mu(I)", "CSSM", "CIDR"),
        "I": (0.001, 0.003, 0.01, 0.02, 0.05, 0.1, 0.3, 1.0, 10.0),
        "ratio": (0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.95),
        "k": (0.1, 1.0, 10.0),
    },
    PDEExplorer: {"n": (16, 32, 64, 128), "when": (0.0, 0.25, 0.5, 0.75, 1.0)},
}


def shelves(explorer):
    """The shelves of an explorer's page; the texts of the PDE explorer stand on one, as its presets."""
    found = []
    if explorer is PDEExplorer:
        kept = {name: _whole(explorer, state) for name, state in _presets(explorer)}
        for values in kept.values():
            for name in _VALUES[explorer]:
                del values[name]
        places = tuple(kept.items())
        found.append(Shelf("equation", "equation", places))
    for control in (*explorer.controls, *explorer.looks):
        if control.name in _VALUES[explorer]:
            found.append(shelf(control, _VALUES[explorer][control.name], look=control in explorer.looks))
    return found


def states(explorer, progress=iter):
    """The :class:`primer.view.page.atlas.Atlas` of an explorer's page; ``progress`` wraps the loop over its answers."""
    return atlas(explorer, shelves(explorer), progress)


def page(made):
    """The page of such an atlas."""
    explorer = made.explorer
    _, title, lead = PAGES[explorer]
    if explorer is PDEExplorer:
        named = ("pde", "at", "order", "uniform")
        closed = [closed_form(**{name: said[name] for name in named}) for _, said in made.shelves[0].places]
        begin = {"equation": "toy, u < 0", "n": "64", "when": "1"}
        return explorer_page(made, title, lead, begin, closed=closed)
    presets = {name: state for name, text in _presets(explorer) if (state := _on_shelf(explorer, text)) is not None}
    return explorer_page(made, title, lead, _on_shelf(explorer, ""), presets)


def _presets(explorer):
    return explorer.presets.items()


def _whole(explorer, text):
    """Name -> value of a state, what it leaves out as the explorer has it."""
    controls = (*explorer.controls, *explorer.looks)
    return defaults(controls) | explorer._completed(read_state(controls, text))


def _on_shelf(explorer, text):
    """Name -> text of the places nearest to a state of the explorer's; None if one is further off than a tenth."""
    values = _whole(explorer, text)
    found = {}
    for one in shelves(explorer):
        wanted, offered = values[one.name], _VALUES[explorer][one.name]
        if isinstance(wanted, str):
            found[one.name] = wanted
            continue
        gaps = np.abs(np.subtract(offered, wanted))
        if gaps.min() > 0.1 * abs(wanted):
            return None
        found[one.name] = one.places[int(gaps.argmin())][0]
    return found
