"""Measure error against wall time, and keep what was measured: ``python tests/benchmarks/work_precision.py``.

Writes figures/work_precision.measured.json, from which the figure of that name is drawn, and from which ``python
figures/readme.py`` makes the README's table. It takes four minutes, py-pde included where that is installed (``pip
install -e ".[bench]"``). The ratios are of one machine at one time.
"""

import sys
from pathlib import Path

from primer.study import measured
from primer.study.cost import cost_against_n, work_precision

STORE = Path(__file__).resolve().parents[2] / "figures" / "work_precision.measured.json"


def main():
    measured.write(STORE, work_precision(patience=2.5), cost_against_n())


if __name__ == "__main__":
    sys.exit(main())
