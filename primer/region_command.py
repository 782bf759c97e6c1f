"""The commands ``primer region`` and ``primer conditions``: for which values equations are ill posed."""

import argparse
import json
import math
import sys
from pathlib import Path
from typing import Any

SHOWN = 12  # boundary values printed


def add_command(commands, assignment):
    """Add ``primer region`` to the subcommands of a parser; ``assignment`` reads NAME=VALUE."""
    sub = commands.add_parser(
        "region",
        help="for which values is a PDE ill-posed?",
        description="Ask for the verdict over one or two base-state values or parameters of a PDE, and say where it "
        "changes. How equations are written: primer help equations.",
        epilog="example: primer region 'u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)' --vary u=-2:2 "
        "--vary eps=0:0.1 --at v_xx=0.3 --plot toy.svg",
        allow_abbrev=False,
    )
    sub.add_argument("pde", metavar="PDE", help="such as 'u_t = (u^3 - u)_xx'; - reads it from standard input")
    sub.add_argument(
        "--vary", action="append", required=True, type=_range, metavar="NAME=LOW:HIGH", help="once, or twice"
    )
    sub.add_argument(
        "--at",
        "--set",
        nargs="+",
        action="extend",
        default=[],
        type=assignment,
        metavar="NAME=VALUE",
        help="the other base-state values and parameters; of a function f(u), a text: 'f=u^3 - u'",
    )
    sub.add_argument("--uniform", action="store_true", help="all derivatives of the base state are 0")
    sub.add_argument("--space", metavar="NAMES", help="what the space variables are called, such as r, or x,z")
    sub.add_argument("--time", metavar="NAME", help="what time is called (default: t)")
    sub.add_argument("--order", choices=("full", "maximal"), default="full", help="which terms to keep (default: full)")
    sub.add_argument("--n", type=int, help="values of each name (default: 201 of one, 101 of two)")
    sub.add_argument("--table", type=Path, metavar="FILE", help="a CSV file with which an interrupted run goes on")
    sub.add_argument("--plot", type=Path, metavar="FILE", help="a picture: .svg, .png or .pdf")
    sub.add_argument("--json", action="store_true", help="print one JSON object")
    sub.set_defaults(command=_region)


def add_conditions(commands, assignment):
    """Add ``primer conditions`` to the subcommands of a parser."""
    sub = commands.add_parser(
        "conditions",
        help="for which values is a PDE ill-posed, in symbols?",
        description="Leave names without a value, and get the conditions under which a PDE is ill-posed, each held to "
        "the verdict at random points. How equations are written: primer help equations.",
        epilog="example: primer conditions 'u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)'",
        allow_abbrev=False,
    )
    sub.add_argument("pde", metavar="PDE", help="such as 'u_t = a*u_xx'; - reads it from standard input")
    sub.add_argument(
        "--at", "--set", nargs="+", action="extend", default=[], type=assignment, metavar="NAME=VALUE", help="known"
    )
    sub.add_argument("--uniform", action="store_true", help="all derivatives of the base state are 0")
    sub.add_argument("--space", metavar="NAMES", help="what the space variables are called, such as r, or x,z")
    sub.add_argument("--time", metavar="NAME", help="what time is called (default: t)")
    sub.add_argument("--order", choices=("full", "maximal"), default="full", help="which terms to keep (default: full)")
    sub.add_argument("--direction", nargs=2, type=float, metavar=("X", "Y"), help="of two: only waves along it")
    sub.add_argument("--json", action="store_true", help="print one JSON object")
    sub.set_defaults(command=_conditions)


def _conditions(options):
    from primer.analysis.conditions import conditions

    text = sys.stdin.read() if options.pde == "-" else options.pde
    functions = {name: value for name, value in options.at if isinstance(value, str)}
    at = {name: value for name, value in options.at if name not in functions}
    declared: dict[str, Any] = {"uniform": options.uniform, "space": options.space, "time": options.time}
    declared |= {"order": options.order, "direction": options.direction}
    found = conditions(text, at=at, **{**declared, **functions})
    if not options.json:
        return str(found)
    cases = [
        {
            "condition": str(case.condition),
            "kind": str(case.kind),
            "growth": None if case.growth is None else str(case.growth),
            "exponent": float(case.exponent),
        }
        for case in found.cases
    ]
    told = {"names": list(found.names), "cases": cases, "otherwise": str(found.otherwise), "checked": found.checked}
    return json.dumps(told | {"withdrawn": list(map(str, found.withdrawn))}, indent=1)


def _range(text):
    name, equals, ends = (part.strip() for part in text.partition("="))
    try:
        low, high = map(float, ends.split(":"))
    except ValueError:
        low = high = math.nan
    if not name or not equals or not low < high:
        raise argparse.ArgumentTypeError(f"expected NAME=LOW:HIGH such as u=-2:2, got {text!r}")
    return name, (low, high)


def _region(options):
    from primer.run import _check_plot
    from primer.study.region import region

    text = sys.stdin.read() if options.pde == "-" else options.pde
    vary = dict(options.vary)
    if len(vary) < len(options.vary):
        raise ValueError("vary must name each value once")
    functions = {name: value for name, value in options.at if isinstance(value, str)}
    at = {name: value for name, value in options.at if name not in functions}
    if options.plot is not None:
        _check_plot(options.plot)
    declared: dict[str, Any] = {"uniform": options.uniform, "space": options.space, "time": options.time}
    declared["order"] = options.order
    found = region(text, vary, at=at, n=options.n, table=options.table, **{**declared, **functions})
    if options.plot is not None:
        _draw(found, text, options.plot)
    return json.dumps(_as_json(found), indent=1) if options.json else _in_words(found)


def _draw(found, text, path):
    from primer.view.region import draw_region
    from primer.view.style import new_figure, save, styled

    with styled():
        figure, axes = new_figure(title=text if len(text) < 90 else text[:87] + "...", width=7.0, height=4.6, columns=1)
        handles = draw_region(axes, found)
        figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
        save(figure, path, f"Where it is well posed, over {' and '.join(found.names)}: {text}")


def _as_json(found):
    pieces = [
        {
            "kind": str(p.kind),
            "exponent": _plain(p.exponent),
            "loss": _plain(p.loss),
            "share": p.share,
            "where": p.where,
            "coefficient": list(map(_plain, p.coefficient)),
            "bound": list(map(_plain, p.bound)),
            "computed": p.computed,
        }
        for p in found.pieces
    ]
    alone = [{"where": where, "kind": str(v.kind), "reason": v.reason} for where, v in found.isolated]
    lines = {name: getattr(found, name).tolist() for name in ("boundaries", "error", "changes")}
    return {"names": list(found.names), "pieces": pieces, **lines, "isolated": alone, "computed": found.computed}


def _plain(value):
    return float(value) if math.isfinite(value) else None


def _in_words(found):
    rows = []
    for p in found.pieces:
        weakly = "weakly " if 0 < p.loss < math.inf else ""
        law = f", exponent {p.exponent}" if math.isfinite(p.exponent) else ""
        where = ", ".join(f"{name} = {value:.4g}" for name, value in p.where.items())
        rows.append((f"{100 * p.share:.1f} %", f"{weakly}{p.kind}{law} (as at {where})"))
    if len(found.names) == 1:
        values = ", ".join(f"{x:.10g}" for x in found.boundaries[:SHOWN]) or "none"
        more = f" and {len(found.boundaries) - SHOWN} more" if len(found.boundaries) > SHOWN else ""
        rows.append(("boundaries", f"{found.names[0]} = {values}{more}" if len(found.boundaries) else values))
    else:
        rows.append(("boundaries", f"{len(found.boundaries)} points, to {max(found.error, default=0):.1g}"))
    for where, verdict in found.isolated:
        at = ", ".join(f"{name} = {value:.6g}" for name, value in where.items())
        rows.append(("isolated", f"{verdict.kind} at {at}, but not on either side"))
    rows.append(("computed", f"{found.computed} verdicts; between their points what they agree on is assumed"))
    return "\n".join(f"{name + ':':12s} {value}" for name, value in rows)
