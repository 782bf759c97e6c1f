"""March the scheme without round-off, and keep what came of it: ``python tests/benchmarks/exact.py``.

Writes figures/exact.measured.json, from which the figure of that name is drawn. Half a minute on one core.
"""

import json
import sys
from pathlib import Path

FIGURES = Path(__file__).resolve().parents[2] / "figures"
sys.path.insert(0, str(FIGURES))

from exact import MEASURED, kept, march  # noqa: E402

#: N, digits, a second number of digits, and an end.
RUNS = ((100, 126, 180, 110.0), (150, 140, 200, 30.0), (200, 150, 220, 16.0), (300, 180, 250, 9.0),
        (400, 250, 331, 6.0), (600, 280, 331, 4.5))  # fmt: skip


def main():
    rows = []
    for n, digits, more, t_end in RUNS:
        run, again = march(n, digits, t_end), march(n, more, t_end)
        times, dist = kept(run)
        rows.append({"n": n, "digits": digits, "t": run.t_stop, "more": more, "again": again.t_stop, "times": times,
                     "dist": dist})  # fmt: skip
        print(n, run.stop, run.t_stop, again.t_stop)
    MEASURED.write_text("[\n" + ",\n".join(" " + json.dumps(row) for row in rows) + "\n]\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
