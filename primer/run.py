"""The command ``primer run``: any equation on several grids, as a table, and as a picture if asked for."""

import argparse
import json
import math
import re
import sys
from pathlib import Path


def add_command(commands):
    """Add ``primer run`` to the subcommands of a parser."""
    sub = commands.add_parser(
        "run",
        help="march an equation on several grids, and compare them",
        description="March an evolution equation in x (periodic) from data of yours by central differences and RK4, on "
        "each grid with a step that is not to blame, and say whether the grids agree.",
        epilog="example: primer run 'u_t = nu*u_xx - (u^2/2)_x' --initial 'u = -sin(x)' --set nu=0.1 --n 64,128,256 "
        "--t-end 3 --plot burgers.svg",
        allow_abbrev=False,
    )
    sub.add_argument("pde", metavar="PDE", help="such as 'u_t = u_xx'; - reads it from standard input")
    sub.add_argument(
        "--initial",
        required=True,
        nargs="+",
        action="extend",
        metavar="FIELD=TEXT",
        help="each field at t = 0: 'u = a' 'v = -sin(x)/2', or in one text parted by ';'",
    )
    sub.add_argument(
        "--steady", nargs="+", action="extend", metavar="FIELD=TEXT", help="the state that Dist is measured from"
    )
    sub.add_argument(
        "--set",
        nargs="+",
        action="extend",
        default=[],
        type=_assignment,
        metavar="NAME=VALUE",
        help="parameters; of a function f(u), a text: 'f=u^3 - u'",
    )
    sub.add_argument("--space", metavar="NAME", help="what the space variable is called (default: x)")
    sub.add_argument("--time", metavar="NAME", help="what time is called (default: t)")
    sub.add_argument("--period", default="2*pi", help="in x: a number, or as here (default: 2*pi)")
    sub.add_argument("--n", type=_grids, default=(64, 128, 256), metavar="N,N,...", help="grids (default: 64,128,256)")
    sub.add_argument("--t-end", type=float, default=1.0, help="the end (default: 1)")
    sub.add_argument("--plot", type=Path, metavar="FILE", help="a picture: .svg, .png or .pdf")
    sub.add_argument("--json", action="store_true", help="print one JSON object")
    sub.set_defaults(command=_run)


def _run(options):
    from primer.equations.error import PDEError
    from primer.problems.pde import PDE
    from primer.scenes.marched import data_of, in_words, length
    from primer.study.grid_comparison import compare_grids

    text = sys.stdin.read() if options.pde == "-" else options.pde
    steady = data_of(";".join(options.steady), "--steady") if options.steady else None
    initial = data_of(";".join(options.initial), "--initial")
    if options.plot is not None:
        _check_plot(options.plot)
    try:
        variables = {"space": options.space, "time": options.time}
        problem = PDE(text, initial, steady=steady, period=length(options.period), **variables, **dict(options.set))
    except PDEError as error:
        raise ValueError(re.sub(r"as in PDE\(\.\.\., (\S+)=1\.0\)", r"as in --set \1=1", str(error))) from None
    found = compare_grids(problem, options.n, options.t_end)
    if options.plot is not None:
        _draw(found, in_words(found), options.plot)
    return _as_json(found, in_words(found)) if options.json else _as_table(found, in_words(found))


def _as_table(found, words):
    last = found.last_shared
    between = f"to the next (t = {found.t[last]:.4g})"
    rows = [("N", "dt", "outcome", f"Dist (t = {found.t[last]:.4g})", between)]
    for k, (n, dt, lost) in enumerate(zip(found.n, found.dt, found.lost, strict=True)):
        outcome = f"lost by t = {lost:.4g}" if lost < math.inf else f"reached t = {found.t[-1]:.4g}"
        gap = f"{found.gap[k, last]:.4g}" if k < len(found.gap) else ""
        rows.append((str(n), f"{dt:.3g}", outcome, f"{found.dist[k, last]:.6g}", gap))
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    whence = "the steady state" if found.problem.dist_from == "steady" else "the initial data"
    return "\n".join([*lines, "", f"Dist is measured from {whence}.", words])


def _as_json(found, words):
    last = found.last_shared
    whole = {
        "n": found.n.tolist(),
        "dt": found.dt.tolist(),
        "lost": [t if t < math.inf else None for t in found.lost.tolist()],
        "by_scheme": found.by_scheme.tolist(),
        "t": float(found.t[last]),
        "dist": found.dist[:, last].tolist(),
        "dist_from": found.problem.dist_from,
        "gap": found.gap[:, last].tolist(),
        "order": None if math.isnan(found.order) else found.order,
        "reason": words,
    }
    return json.dumps(whole, indent=1)


def _check_plot(path):
    from primer.view.style import FORMATS

    if path.suffix[1:] not in FORMATS:
        raise ValueError(f"--plot must end in one of {', '.join('.' + kind for kind in FORMATS)}, got {str(path)!r}")
    if not path.parent.is_dir():
        raise ValueError(f"--plot must be a file in a folder that is there, got {str(path)!r}")


def _draw(found, words, path):
    from primer.view.grid_comparison import draw_apart, draw_on_grids
    from primer.view.style import new_figure, save, styled

    with styled():
        figure, (left, right) = new_figure(height=4.0)
        draw_on_grids(left, found)
        draw_apart(right, found)
        save(figure, path, words)


def _assignment(text):
    name, equals, value = text.partition("=")
    try:
        if equals and name.strip():
            return name.strip(), float(value)
    except ValueError:
        if any(letter.isalpha() for letter in value):
            return name.strip(), value  # a function as a text
    raise argparse.ArgumentTypeError(f"expected NAME=VALUE such as nu=0.1, got {text!r}")


def _grids(text):
    try:
        return tuple(int(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"expected whole numbers such as 64,128,256, got {text!r}") from None
