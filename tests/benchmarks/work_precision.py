"""Measure error against wall time, and keep what was measured: ``python tests/benchmarks/work_precision.py``.

Writes figures/work_precision.measured.json, from which the figure of that name is drawn, and the table between the two
markers in README.md. ``--table`` only writes the table again from the stored measurements. It takes four minutes,
py-pde included where that is installed (``pip install -e ".[bench]"``). The ratios are of one machine at one time.
"""

import argparse
import math
import sys
from pathlib import Path

from primer.study import measured
from primer.study.cost import cost_against_n, work_precision

ROOT = Path(__file__).resolve().parents[2]
STORE, README = ROOT / "figures" / "work_precision.measured.json", ROOT / "README.md"
BEGIN, END = "<!-- work-precision: begin -->", "<!-- work-precision: end -->"
TARGETS = (1e-3, 1e-6, 1e-10)


def table(study):
    """The README's table: the time each method takes to reach an error, in times of the reference's."""
    own = {target: study.quickest("reference", target).seconds for target in TARGETS}
    heads = [f"error ≤ 10<sup>{round(math.log10(target))}</sup>" for target in TARGETS]
    rows = [["", *heads], ["---", *["---:"] * len(heads)]]
    for method in study.methods:
        cells = []
        for target in TARGETS:
            point = study.quickest(method, target)
            star = " ★" if point and point.on_front else ""
            cells.append(f"{_round(point.seconds / own[target])}{star}" if point else "-")
        rows.append([method, *cells])
    text = [
        f"Wall time to a largest error of so much at t = {study.t_end:g} (a = {study.toy.a:g}, ε = {study.toy.eps:g}),",
        "in times of the reference's, which includes its error bar. ★: nothing here is both as quick and as accurate;",
        "a dash: not within a few seconds. py-pde compiles for each run.",
        "",
        *("| " + " | ".join(row) + " |" for row in rows),
    ]
    return "\n".join(text)


def write_table(readme=README):
    text = readme.read_text(encoding="utf-8")
    if not (BEGIN in text and END in text):
        raise SystemExit(f"{readme.name} must have the lines {BEGIN} and {END}, between which the table goes")
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    readme.write_text(f"{before}{BEGIN}\n{table(measured.read(STORE)[0])}\n{END}{after}", encoding="utf-8")


def _round(ratio):
    """Two significant digits, in full."""
    digits = float(f"{ratio:.2g}")
    return f"{digits:,.0f}" if digits >= 10 else f"{digits:g}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--table", action="store_true", help="only write the README's table from what is stored")
    if not parser.parse_args().table:
        measured.write(STORE, work_precision(patience=2.5), cost_against_n())
    write_table()


if __name__ == "__main__":
    sys.exit(main())
