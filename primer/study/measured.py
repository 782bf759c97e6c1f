"""Measurements kept on file: wall times cannot be computed again, pictures and tables of them should."""

import json
import math
from dataclasses import asdict
from pathlib import Path
from typing import Any

from primer.problems.toy import Toy
from primer.study.cost import Point, WorkPrecision, pareto
from primer.study.table import written_whole


def write(path, study, cost):
    """Keep a ``WorkPrecision`` and the points of ``cost_against_n`` as JSON, numbers to four digits, NaN as null."""
    lines = [f'"a": {study.toy.a}', f'"eps": {study.toy.eps}', f'"t_end": {study.t_end}']
    for name, points in (("points", study.points), ("cost", cost)):
        rows = [{key: _kept(value) for key, value in asdict(p).items() if key != "on_front"} for p in points]
        lines.append(f'"{name}": [\n  ' + ",\n  ".join(json.dumps(row, allow_nan=False) for row in rows) + "\n ]")
    with written_whole(path) as file:
        file.write("{\n " + ",\n ".join(lines) + "\n}\n")


def read(path):
    """(WorkPrecision, points of cost_against_n) as they were kept; the front is found anew.

    Raises
    ------
    OSError, ValueError    if there is no such file, or it does not hold what ``write`` keeps
    """
    text = Path(path).read_bytes()
    try:
        stored = json.loads(text)
        points, cost = (
            tuple(Point(**{key: _read(value) for key, value in row.items()}) for row in stored[name])
            for name in ("points", "cost")
        )
        return WorkPrecision(Toy(stored["a"], stored["eps"]), stored["t_end"], pareto(points)), cost
    except (ValueError, TypeError, KeyError, AttributeError):
        raise ValueError(f"path must be a file of measurements as write() keeps them, got {str(path)!r}") from None


def _read(value: Any) -> Any:
    return math.nan if value is None else value


def _kept(value):
    if not isinstance(value, float):
        return value
    return float(f"{value:.4g}") if math.isfinite(value) else None
