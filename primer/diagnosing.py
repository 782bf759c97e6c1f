"""The command ``primer diagnose``: is it the time step, the grid or the equations?"""

import argparse
import json
import math
import sys
from dataclasses import asdict


def add_command(commands):
    """Add ``primer diagnose`` to the subcommands of a parser."""
    sub = commands.add_parser(
        "diagnose",
        help="is it the time step, the grid or the equations?",
        description="Say what a run of an evolution equation in x (periodic) by central differences will do, and "
        "whether to blame the scheme, the grid or the equations. Fields that are given by --at alone start uniform; "
        "--initial gives others.",
        epilog="example: primer diagnose 'u_t = (u^3 - u - 0.01*u_xx)_xx' --at u=0.1 --n 100 --dt 1e-4 --time rk4",
        allow_abbrev=False,
    )
    sub.add_argument("pde", metavar="PDE", help="such as 'u_t = u_xx'; - reads it from standard input")
    sub.add_argument(
        "--at", "--set", nargs="+", action="extend", default=[], type=_assignment, metavar="NAME=VALUE",
        help="uniform fields at t = 0, and parameters",
    )  # fmt: skip
    sub.add_argument(
        "--initial", nargs="+", action="extend", default=[], metavar="FIELD=TEXT", help="fields at t = 0, as texts in x"
    )
    sub.add_argument("--period", type=float, default=2 * math.pi, help="in x (default: 2 pi)")
    sub.add_argument("--n", type=int, default=100, help="grid points (default: 100)")
    sub.add_argument("--dt", type=float, default=1e-3, help="time step (default: 1e-3)")
    sub.add_argument("--t-end", type=float, default=100.0, help="the end (default: 100)")
    sub.add_argument("--time", choices=("euler", "rk4", "rk8"), default="euler", help="the step (default: euler)")
    sub.add_argument("--json", action="store_true", help="print one JSON object")
    sub.set_defaults(command=_diagnose)


def _diagnose(options):
    from primer.equations.stages import evolution
    from primer.problems.pde import PDE
    from primer.scenes.marched import data_of
    from primer.schemes.runge_kutta import EULER, RK4, RK8
    from primer.study.diagnosis import diagnose

    text = sys.stdin.read() if options.pde == "-" else options.pde
    given = dict(options.at)
    fields = evolution(text, tuple(given)).fields
    initial: dict = data_of(";".join(options.initial), "--initial") if options.initial else {}
    initial = {name: given.pop(name) for name in fields if name in given} | initial
    initial = {name: 0.0 for name in fields if name.endswith("_t")} | initial
    problem = PDE(text, initial, period=options.period, **given)
    time = {"euler": EULER, "rk4": RK4, "rk8": RK8}[options.time]
    found = diagnose(problem, options.n, options.dt, options.t_end, time=time)
    return _as_json(found) if options.json else _as_text(found)


def _as_text(found):
    rows = [("kind", str(found.kind))]
    if found.blow_up:
        rows.append(("blow-up", "t = {:.4g} to {:.4g}".format(*found.blow_up)))
    rows.append(("growth", f"{found.growth:.6g} per unit time"))
    if math.isfinite(found.wavelength):
        rows.append(("fastest", f"waves of length {found.wavelength:.4g}"))
    if found.amplification:
        rows.append(("a step", f"multiplies no wave by more than {max(found.amplification):.6g}"))
    if math.isfinite(found.stable_dt):
        rows.append(("cure", f"dt <= {found.stable_dt:.4g}" if found.stable_dt else "no dt, another scheme"))
    return "\n".join(f"{name + ':':9s} {value}" for name, value in [*rows, ("reason", found.reason)])


def _as_json(found):
    whole = asdict(found) | {"kind": str(found.kind)}
    return json.dumps({name: _plain(value) for name, value in whole.items()}, indent=1)


def _plain(value):
    """What JSON can hold: null for nan and infinity."""
    if isinstance(value, (tuple, list)):
        return [_plain(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _assignment(text):
    name, equals, value = text.partition("=")
    try:
        if equals and name.strip():
            return name.strip(), float(value)
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"expected NAME=VALUE such as u=0.1, got {text!r}")
