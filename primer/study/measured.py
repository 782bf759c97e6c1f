"""Measurements kept on file: wall times cannot be computed again, pictures and tables of them should."""

import json
import math
from dataclasses import asdict
from pathlib import Path

from primer.problems.toy import Toy
from primer.study.cost import Point, WorkPrecision, pareto


def write(path, study, cost):
    """Keep a ``WorkPrecision`` and the points of ``cost_against_n`` as JSON, numbers to four digits, NaN as null."""
    lines = [f'"a": {study.toy.a}', f'"eps": {study.toy.eps}', f'"t_end": {study.t_end}']
    for name, points in (("points", study.points), ("cost", cost)):
        rows = [{key: _kept(value) for key, value in asdict(p).items() if key != "on_front"} for p in points]
        lines.append(f'"{name}": [\n  ' + ",\n  ".join(json.dumps(row, allow_nan=False) for row in rows) + "\n ]")
    Path(path).write_text("{\n " + ",\n ".join(lines) + "\n}\n", encoding="utf-8")


def read(path):
    """(WorkPrecision, points of cost_against_n) as they were kept; the front is found anew."""
    stored = json.loads(Path(path).read_text(encoding="utf-8"))
    points, cost = (
        tuple(
            Point(**{key: math.nan if value is None else value for key, value in row.items()}) for row in stored[name]
        )
        for name in ("points", "cost")
    )
    return WorkPrecision(Toy(stored["a"], stored["eps"]), stored["t_end"], pareto(points)), cost


def _kept(value):
    if not isinstance(value, float):
        return value
    return float(f"{value:.4g}") if math.isfinite(value) else None
