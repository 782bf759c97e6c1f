"""The command line: ``primer verdict "u_t = u_xxx - u_xx"``, also as ``python -m primer``."""

import argparse
import json
import math
import os
import sys
from dataclasses import asdict
from typing import Any

from primer import __version__
from primer.base_state import add_command as add_granular
from primer.claims import VERDICTS, claims
from primer.claims import report as claims_report
from primer.diagnosing import add_command as add_diagnose
from primer.lab import add_command as add_lab
from primer.region_command import add_command as add_region
from primer.region_command import add_conditions
from primer.run import add_command as add_run
from primer.site import add_command as add_site
from primer.slides import add_command as add_slides
from primer.terminal import Parser, coloured

_GREETING = """Welcome to primer: change one number, and watch a system of PDEs stop making sense.

  primer lab my-course                       the course, in JupyterLab
  primer verdict "u_t = u_xxx - u_xx"        is this PDE ill posed?
  primer claims --verdict corrected          where the paper is corrected

"""


def main(arguments=None):
    """Run one command and return its exit code, as shells know them.

    0 if it did what was asked; 2, and the reason on stderr, if the input cannot be used; 130 after Ctrl-C; 141 if the
    reader of its output went away, as ``head`` does.
    """
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")  # a terminal without the degree sign gets \xb0
    parser = _parser()
    try:
        if not (sys.argv[1:] if arguments is None else arguments):
            print(_GREETING + parser.format_help(), end="", flush=True)
            return 0
        options = parser.parse_args(arguments)
        print(coloured(options.command(options)), flush=True)
    except (ValueError, TypeError) as error:
        said = error.said("shell") if hasattr(error, "said") else error  # a PDEError, which need not be imported
        print(f"primer: {said}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # the flush at exit must not fail once more
        return 141
    return 0


def _parser():
    parser = Parser(prog="primer", description="A primer on ill-posed PDEs and grid-dependent computations.")
    parser.add_argument("--version", action="version", version=f"primer {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    _add_verdict(commands)
    add_region(commands, _assignment)
    add_conditions(commands, _assignment)
    add_run(commands)
    add_diagnose(commands)
    add_granular(commands)
    add_lab(commands)
    add_site(commands)
    add_slides(commands)
    _add_claims(commands)
    _add_help(commands)
    return parser


def _add_verdict(commands):
    sub = commands.add_parser(
        "verdict",
        help="is a PDE linearly ill-posed?",
        description="Linearise a PDE about a base state, freeze it at a point, and say whether the growth of its short "
        "waves is bounded (section A2.1). In one space variable x, or two, x and y; equations are separated by ';'. "
        "How equations are written: primer help equations.",
        epilog="example: primer verdict 'u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)' --at u=-0.5 v_xx=0.3 eps=0.01",
        allow_abbrev=False,
    )
    sub.add_argument("pde", metavar="PDE", help="such as 'u_t = u_xxx - u_xx'; - reads it from standard input")
    sub.add_argument(
        "--at",
        "--set",
        nargs="+",
        action="extend",
        default=[],
        type=_assignment,
        metavar="NAME=VALUE",
        help="base-state values and parameters; of a function f(u), a text: 'f=u^3 - u'",
    )
    sub.add_argument("--uniform", action="store_true", help="all derivatives of the base state are 0")
    sub.add_argument("--space", metavar="NAMES", help="what the space variables are called, such as r, or x,z")
    sub.add_argument("--time", metavar="NAME", help="what time is called (default: t)")
    sub.add_argument("--order", choices=("full", "maximal"), default="full", help="which terms to keep (default: full)")
    sub.add_argument("--json", action="store_true", help="print one JSON object")
    sub.set_defaults(command=_verdict)


def _verdict(options):
    from fractions import Fraction

    from primer.analysis.puiseux import Law
    from primer.analysis.verdict import verdict

    text = sys.stdin.read() if options.pde == "-" else options.pde
    functions = {name: value for name, value in options.at if isinstance(value, str)}
    at = {name: value for name, value in options.at if name not in functions}
    declared: dict[str, Any] = {"uniform": options.uniform, "space": options.space, "time": options.time}
    found = verdict(text, at=at, order=options.order, **{**declared, **functions})
    if options.json:
        number = {"exponent": _plain(found.exponent), "exponent_text": str(found.exponent)}
        rest = {name: _plain(getattr(found, name)) for name in ("coefficient", "bound")}
        rest |= {"direction": list(found.direction), "grows": found.grows, "unstable": found.unstable}
        rest |= {"loss": _plain(found.loss), "reason": found.reason}
        return json.dumps({"kind": str(found.kind), **number, **rest}, indent=1)
    growing = (", unstable" if found.unstable else ", with growth") if 0 < found.bound < math.inf else ""
    weakly = "weakly " if 0 < found.loss < math.inf else ""
    rows = [("verdict", weakly + str(found.kind) + growing)]
    if math.isfinite(found.exponent):
        rows.append(("short waves", str(Law(Fraction(found.exponent), found.coefficient))))
    if found.direction:
        rows.append(("bound", f"Re lambda <= {found.bound:.10g}" if math.isfinite(found.bound) else "none"))
    if len(found.direction) == 2:
        rows.append(("direction", "({:.6g}, {:.6g})".format(*found.direction)))
    return "\n".join(f"{name + ':':12s} {value}" for name, value in [*rows, ("reason", found.reason)])


def _add_claims(commands):
    sub = commands.add_parser(
        "claims",
        help="what the paper claims, what was computed, and what shows it",
        description="List the checkable claims of the paper, each with what was computed, the figure or test that "
        "shows it, and the verdict.",
        epilog="example: primer claims --verdict corrected",
        allow_abbrev=False,
    )
    sub.add_argument("word", nargs="?", default="", metavar="WORD", help="only claims that hold this text")
    sub.add_argument("--verdict", choices=VERDICTS, help="only claims of this verdict")
    sub.add_argument("--json", action="store_true", help="print a JSON array of objects")
    sub.set_defaults(command=_claims)


def _claims(options):
    found = claims(options.word, options.verdict)
    return json.dumps([asdict(claim) for claim in found], indent=1) if options.json else claims_report(found)


def _add_help(commands):
    sub = commands.add_parser(
        "help",
        help="how equations are written",
        description="Explain a topic in a screen.",
        epilog="example: primer help equations",
        allow_abbrev=False,
    )
    sub.add_argument("topic", nargs="?", choices=("equations",), default="equations")
    sub.set_defaults(command=_help)


def _help(options):
    from primer import equations

    return "\n".join(equations.__doc__.splitlines()[2:])


def _plain(value):
    """A float that JSON can hold: null for nan and infinity."""
    return float(value) if math.isfinite(value) else None


def _assignment(text):
    name, equals, value = (part.strip() for part in text.partition("="))
    if not equals or not name or not value or "=" in value:
        return _fail(text)
    try:
        return name, float(value)
    except ValueError:
        return (name, value) if any(c.isalpha() for c in value) else _fail(text)  # a function as a text


def _fail(text):
    raise argparse.ArgumentTypeError(f"expected NAME=VALUE such as u=-0.5, got {text!r}")


if __name__ == "__main__":
    sys.exit(main())
