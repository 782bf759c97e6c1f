"""A page that needs no installation: move a, eps, N and time; growth, Dist(t), fields and verdict answer at once.

One HTML file for any browser, without network: base states from -1 to 2, grids of 16 to 200 points, three eps, and
the data of eq. (toy-initial) to t = 100 as in A2.2.2. Each state is computed here and looked up there. Round-off
seeds most blow-ups, so that their times are claimed as intervals.
"""

from sidecar import close, same, within
from tqdm import tqdm

from primer.scenes.base_state import base_state
from primer.view.explorers import BaseStateExplorer
from primer.view.page.collection import page, states


def compute():
    bar = {"desc": "explorer", "unit": "state", "position": 1, "leave": False, "disable": None}
    return states(BaseStateExplorer, progress=lambda rows: tqdm(rows, **bar))


def numbers(result):
    paper, coarse, converged = (base_state(a, 0.01, n) for a, n in ((0.5, 100), (0.5, 30), (1.5, 100)))
    return {
        "states": same(len(result.states), "as asked for"),
        "kind_paper": same(str(paper.kind), "Figure 5: it blows up"),
        "kind_coarse": same(str(coarse.kind), "Figure 6: only the coarse grid hides it"),
        "t_blow_up_paper": within(paper.measured, 12, 16, "seeded by round-off"),
        "dist_end_converged": close(converged.run.dist[-1], rtol=1e-6, why="the scheme's floor"),
    }


def draw(result):
    return page(result)
