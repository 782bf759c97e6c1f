"""Error against wall time: the paper's scheme, better ones on the same right-hand side, and other packages.

Left: the toy system with a = 1.5 to t = 5; each line is one method on finer grids or at tighter tolerances, and a ring
marks what nothing else beats in both error and time. Right: what a march to t = 5 costs on N points, with the largest
step that is stable and accurate enough: explicit steps pay N^3 as soon as diffusion limits them. (All loops are
compiled but those of scipy, and of Fourier on more than 128 points, NumPy's transforms.) The wall times were
measured once, on one machine, by tests/benchmarks/work_precision.py, and are read from work_precision.measured.json;
errors are computed again by --check.
"""

from pathlib import Path

import numpy as np
from sidecar import close, same

from primer import reference
from primer.study import measured
from primer.study.contestants import contestants
from primer.view.style import new_figure, ticks
from primer.view.work_precision import draw_cost, draw_work_precision, keys, name_alone

MEASURED = Path(__file__).with_suffix(".measured.json")
QUICK = 0.02  # seconds; runs that took longer are not made again


def compute():
    return measured.read(MEASURED)


def numbers(result):
    study, _ = result
    truth = reference(study.toy, study.t_end, tol=3.5e-13)
    claims = {"on_front": same(" ".join(sorted({p.method for p in study.points if p.on_front})), "as measured")}
    for method in contestants(with_py_pde=False):
        for p in study.of(method.name) if method.by_points else ():
            if p.seconds < QUICK:
                x, fields, _ = method.march(study.toy, p.n, study.t_end)
                error = np.abs(np.array(fields) - [f[0] for f in truth.at(x)]).max()
                claims[f"{method.name} {p.n}"] = close(
                    error, rtol=0.02, atol=2e-13, why="round-off, scipy's step control"
                )
    return claims


def draw(result):
    study, cost = result
    figure, (left, right) = new_figure(height=5.4, title="Error against wall time: a = 1.5, ε = 0.01, to t = 5")
    lines = draw_work_precision(left, study)
    name_alone(left, study)
    left.set(title="(a) what an error costs")
    draw_cost(right, cost)
    right.set(title="(b) what N points cost")
    ticks(right.xaxis, [50, 100, 200, 400, 800, 1600, 3200])
    spaces, times = keys(study.methods)
    small = {"fontsize": 8.5, "title_fontsize": 8.5, "alignment": "left"}
    figure.legend(handles=spaces, loc="outside lower left", ncols=2, title="colour: in space", **small)
    figure.legend(
        handles=[*times, lines[-1]], loc="outside lower right", ncols=2, title="marker and line: in time", **small
    )
    return figure
