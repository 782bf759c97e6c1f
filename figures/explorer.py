"""A page that needs no installation: move a and N; growth curve, Dist(t), fields and verdict answer at once.

One HTML file for any browser, without network. Base states from -1 to 2 on grids of 16 to 200 points, the data of
eq. (toy-initial), eps = 0.01 and t = 100 as in A2.2.2. Each state is computed here and looked up there. Round-off
seeds most blow-ups, so that their times are claimed as intervals.
"""

from sidecar import close, same, within
from tqdm import tqdm

from primer.study.diagnosis import Kind
from primer.view.page import explorer_page
from primer.view.page.states import atlas

A = tuple(k / 20 for k in range(-20, 41))
GRIDS = (16, 20, 24, 30, 40, 50, 60, 64, 80, 100, 128, 160, 200)  # 30 and 100 are the paper's, 64 the first unstable
BEGIN = (1.5, 100)
PRESETS = {
    "well posed": (1.5, 100),
    "marginal": (1.1, 100),
    "ill posed": (0.5, 100),
    "ill posed, and the coarse grid looks fine": (0.5, 30),
}


def compute():
    bar = {"desc": "explorer", "unit": "base state", "position": 1, "leave": False, "disable": None}
    return atlas(A, GRIDS, progress=lambda a: tqdm(a, **bar))


def numbers(result):
    states = [state for row in result.states for state in row]
    kinds = {kind: sum(state.kind is kind for state in states) for kind in Kind}
    paper, coarse = result.at(0.5, 100), result.at(0.5, 30)
    lost = kinds[Kind.ILL_POSED]
    return {
        "states": same(len(states), "as asked for"),
        "converge": same(kinds[Kind.CONVERGES], "u stays positive: the first u = 0 is known to four digits"),
        "transient": same(kinds[Kind.TRANSIENT], "a >= 1, and u = 0 on the way"),
        "ill_posed": within(lost, 0.98 * lost, 1.02 * lost, "states at the edge hang on round-off"),
        "kind_paper": same(str(paper.kind), "Figure 5: it blows up"),
        "kind_coarse": same(str(coarse.kind), "Figure 6: only the coarse grid hides it"),
        "t_blow_up_paper": within(paper.measured, 12, 16, "seeded by round-off"),
        "dist_end_converged": close(result.at(1.5, 100).curves["dist"]["y"][-1], rtol=1e-6, why="the scheme's floor"),
    }


def draw(result):
    return explorer_page(result, BEGIN, PRESETS)
