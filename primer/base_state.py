"""The command ``primer granular``: a granular law at a base state."""

import json

# Those of granular/named.py, which help must not wait for.
_LAWS = ("coulomb", "mui", "cssm", "cidr", "regularised", "mui-phii", "bingham", "herschel-bulkley", "text")
_NAMES = (
    "law",
    "p",
    "phi",
    "I",
    "d",
    "rho",
    "mu1",
    "mu2",
    "I0",
    "mu",
    "phi0",
    "eps",
    "C0",
    "K",
    "n",
    "c",
    "Y",
    "f",
    "dim",
    "lode",
)


def add_command(commands):
    """Add ``granular`` to the command line's argparse subparsers."""
    parser = commands.add_parser(
        "granular",
        help="is a granular rheology well posed at a base state?",
        description="Report the hypotheses of the well-posedness theorem, the verdict, and the limit of the largest "
        "growth rate as |xi| -> infinity, for a granular law frozen at a base state (sections 2 to 4).",
        epilog="example: primer granular --law cidr --phi 0.55 --p 0.2 --I 0.1",
        allow_abbrev=False,
    )
    parser.add_argument(
        "--law",
        required=True,
        type=_law,
        choices=_LAWS,
        help="Coulomb, incompressible mu(I), CSSM, CIDR; mu(I) as Barker & Gray regularise it, mu(I) with Phi(I), "
        "Drucker-Prager with a viscosity (Bingham, Herschel-Bulkley), or the texts of --Y and --f",
    )
    parser.add_argument("--p", type=float, required=True, help="pressure, in any unit (that of C0)")
    parser.add_argument("--phi", type=float, help="solids fraction; may be left out where Y and f do not depend on it")
    parser.add_argument("--I", type=float, required=True, help="inertial number")
    parser.add_argument("--d", type=float, default=1.0, help="particle diameter (default: 1)")
    parser.add_argument("--rho", type=float, default=1.0, help="density of the grains (default: 1)")
    parser.add_argument("--mu1", type=float, help="mu as I -> 0 (default: tan 21°)")
    parser.add_argument("--mu2", type=float, help="mu as I -> infinity (default: tan 33°)")
    parser.add_argument("--I0", type=float, help="scale of mu(I) (default: 0.279)")
    parser.add_argument("--mu", type=float, help="mu of Coulomb, CSSM, Bingham (default: mu(I) at the state)")
    parser.add_argument("--K", type=float, help="viscosity of Bingham, consistency of Herschel-Bulkley (default: 0.1)")
    parser.add_argument("--n", type=float, help="index of Herschel-Bulkley (default: 0.5)")
    parser.add_argument("--c", type=float, help="cohesion of Bingham, Herschel-Bulkley, a pressure (default: 0)")
    parser.add_argument("--Y", help="for the law text: the yield stress, such as 'm*p*sqrt(I)'")
    parser.add_argument("--f", help="for the law text: the dilatancy (default: 0)")
    parser.add_argument("--set", action="append", metavar="NAME=VALUE", help="a parameter of the texts; repeatable")
    parser.add_argument("--phi0", type=float, help="random loose packing (default: 0.5)")
    parser.add_argument("--eps", type=float, help="width of the range of phi (default: 0.1)")
    parser.add_argument("--C0", type=float, help="scale of C(phi), a pressure (default: 1)")
    parser.add_argument("--dim", type=int, default=2, help="2 or 3: over all directions of the sphere (default: 2)")
    parser.add_argument(
        "--lode",
        type=float,
        default=0.0,
        help="with --dim 3: the Lode angle of D in radians, from -pi/6 (extension along one axis) to pi/6 (compression "
        "along one axis; default: 0)",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.set_defaults(command=_run)


def _run(options):
    from primer.granular.command import report, text

    asked = {name: value for name, value in vars(options).items() if name in _NAMES}
    answer = report(**asked, parameters=_parameters(options.set or []))
    return json.dumps(answer, indent=1) if options.json else text(answer)


def _parameters(pairs):
    """{"m": 0.4} from ["m=0.4"]."""
    found = {}
    for pair in pairs:
        name, _, number = pair.partition("=")
        try:
            found[name.strip()] = float(number)
        except ValueError:
            raise ValueError(f"--set must be NAME=VALUE with a number, got {pair!r}") from None
    return found


def _law(text):
    """As people write it: CIDR, mu(I)."""
    return text.lower().replace("mu(i)", "mui")
