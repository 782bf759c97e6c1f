"""The command ``primer granular``: a granular law at a base state."""

import json

_LAWS = ("coulomb", "mui", "cssm", "cidr")  # of granular/command.py, which help must not wait for
_NAMES = ("law", "p", "phi", "I", "d", "rho", "mu1", "mu2", "I0", "mu", "phi0", "eps", "C0")


def add_command(commands):
    """Add ``granular`` to the command line's argparse subparsers."""
    parser = commands.add_parser(
        "granular",
        help="is a granular rheology well posed at a base state?",
        description="Report the hypotheses of the well-posedness theorem, the verdict, and the limit of the largest "
        "growth rate as |xi| -> infinity, for one of four granular laws frozen at a base state (sections 2 to 4).",
        epilog="example: primer granular --law cidr --phi 0.55 --p 0.2 --I 0.1",
        allow_abbrev=False,
    )
    parser.add_argument(
        "--law", required=True, type=_law, choices=_LAWS, help="Coulomb, incompressible mu(I), CSSM or CIDR"
    )
    parser.add_argument("--p", type=float, required=True, help="pressure, in any unit (that of C0)")
    parser.add_argument("--phi", type=float, required=True, help="solids fraction")
    parser.add_argument("--I", type=float, required=True, help="inertial number")
    parser.add_argument("--d", type=float, default=1.0, help="particle diameter (default: 1)")
    parser.add_argument("--rho", type=float, default=1.0, help="density of the grains (default: 1)")
    parser.add_argument("--mu1", type=float, help="mu as I -> 0 (default: tan 21°)")
    parser.add_argument("--mu2", type=float, help="mu as I -> infinity (default: tan 33°)")
    parser.add_argument("--I0", type=float, help="scale of mu(I) (default: 0.279)")
    parser.add_argument("--mu", type=float, help="mu of Coulomb and CSSM (default: mu(I) at the state)")
    parser.add_argument("--phi0", type=float, help="random loose packing (default: 0.5)")
    parser.add_argument("--eps", type=float, help="width of the range of phi (default: 0.1)")
    parser.add_argument("--C0", type=float, help="scale of C(phi), a pressure (default: 1)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.set_defaults(command=_run)


def _run(options):
    from primer.granular.command import report, text

    answer = report(**{name: value for name, value in vars(options).items() if name in _NAMES})
    return json.dumps(answer, indent=1) if options.json else text(answer)


def _law(text):
    """As people write it: CIDR, mu(I)."""
    return text.lower().replace("mu(i)", "mui")
