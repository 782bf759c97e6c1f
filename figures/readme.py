"""Write the tables of ``figures/README.md`` anew from the numbers beside the figures: ``python figures/readme.py``.

What stands between ``<!-- NAME: begin -->`` and ``<!-- NAME: end -->`` is written here and nowhere else.
"""

import json
import math
import os
import sys
from pathlib import Path
from tempfile import NamedTemporaryFile

from primer.study import measured

HERE = Path(__file__).resolve().parent
README = HERE / "README.md"
TARGETS = (1e-3, 1e-6, 1e-10)
# (what it is, figure, its claim, format)
NUMBERS = (
    ("a = 1.5, N = 100 (Figure 4): where Dist comes to rest", "fig31", "dist_end", ".4e"),
    ("a = 0.5, N = 100 (Figure 5): the first u = 0", "fig33", "t_first_negative", ".3f"),
    ("the same: it blows up, from round-off", "fig33", "t_blow_up", ".1f"),
    ("a = 0.5, N = 30 (Figure 6): where Dist comes to rest", "fig32", "dist_end", ".4e"),
    ("order of Dist at rest in the spacing", "toy_refinement", "order", ".2f"),
    ("a = 0.5, a stated seed: blow-up on 100 points", "toy_refinement", "t_blow_up_seeded_100", ".3f"),
    ("the same on 200 points", "toy_refinement", "t_blow_up_seeded_200", ".3f"),
    ("a = 0.5: the first grid that is unstable", "grid_map", "n_threshold", ".0f"),
    ("frozen at x = 0 it would be", "grid_map", "frozen", ".1f"),
    ("backward heat: 32 points last so many times longer than 64", "heat_refinement", "ratio_32_64", ".2f"),
)


def work_precision():
    """The time each method takes to reach an error, in times of the reference's."""
    study, _ = measured.read(HERE / "work_precision.measured.json")
    own = {target: study.quickest("reference", target).seconds for target in TARGETS}
    rows = [["", *(f"error ≤ 10<sup>{round(math.log10(target))}</sup>" for target in TARGETS)]]
    for method in study.methods:
        cells = []
        for target in TARGETS:
            point = study.quickest(method, target)
            star = " ★" if point and point.on_front else ""
            cells.append(f"{_round(point.seconds / own[target])}{star}" if point else "-")
        rows.append([method, *cells])
    return [
        f"Wall time to a largest error of so much at t = {study.t_end:g} (a = {study.toy.a:g}, ε = {study.toy.eps:g}),",
        "in times of the reference's, which includes its error bar. ★: nothing here is both as quick and as accurate;",
        "a dash: not within a few seconds. py-pde compiles for each run.",
        "",
        *_table(rows),
    ]


def numbers():
    """Numbers to expect, with how far another machine may be from them."""
    rows = [["number", "value", "claimed", "figure"]]
    for what, figure, name, form in NUMBERS:
        claim = json.loads((HERE / f"{figure}.json").read_text(encoding="utf-8"))[name]
        rows.append([what, format(claim["value"], form), _claimed(claim), figure])
    return _table(rows, "---", "---:", "---", "---")


PARTS = {"work-precision": work_precision, "numbers": numbers}


def written(text):
    """``text`` with its generated parts written anew.

    Raises
    ------
    ValueError    if the markers of a part are not there
    """
    for name, part in PARTS.items():
        begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"
        if text.count(begin) != 1 or text.count(end) != 1:
            raise ValueError(f"README.md must have the lines {begin.strip()} and {end.strip()} once each")
        before, after = text.split(begin)[0], text.split(end)[1]
        text = before + begin + "\n".join(part()) + "\n" + end + after
    return text


def main(readme=README):
    text = written(readme.read_text(encoding="utf-8"))
    with NamedTemporaryFile("w", dir=readme.parent, prefix=".readme-", delete=False, encoding="utf-8") as aside:
        aside.write(text)
    os.chmod(aside.name, 0o644)
    os.replace(aside.name, readme)


def _table(rows, *rule):
    rule = rule or ["---", *["---:"] * (len(rows[0]) - 1)]
    return ["| " + " | ".join(row) + " |" for row in (rows[0], rule, *rows[1:])]


def _claimed(claim):
    if "low" in claim:
        return f"{claim['low']:.3g} to {claim['high']:.3g}"
    if claim["atol"]:
        return f"± {claim['atol']:g}"
    if claim["rtol"] > 1e-4:
        return f"± {claim['rtol']:.0%}"
    return f"to {-math.log10(claim['rtol']):.0f} digits" if claim["rtol"] else "exactly"


def _round(ratio):
    """Two significant digits, in full."""
    digits = float(f"{ratio:.2g}")
    return f"{digits:,.0f}" if digits >= 10 else f"{digits:g}"


if __name__ == "__main__":
    sys.exit(main())
