"""``primer site OUT``: the course as static pages that need no installation and no network."""

import json
from pathlib import Path

from primer.lab import course


def add_command(commands):
    """Add ``site`` to the command line's argparse subparsers."""
    parser = commands.add_parser(
        "site",
        help="write the whole course as pages for any browser, without network",
        description="Write the executed notebooks, live explorers of computed states, the figures with their numbers "
        "and the paper's equations into the folder OUT: static pages that open from a file. It takes some minutes.",
        epilog="example: primer site public",
        allow_abbrev=False,
    )
    parser.add_argument("out", metavar="OUT", type=Path, help="folder of the pages")
    parser.add_argument("--explorers", metavar="DIR", type=Path, help="take the explorers' pages of an earlier site")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.set_defaults(command=_run)


def _run(options):
    from tqdm import tqdm

    from primer.view.site import build

    if options.explorers and not list(options.explorers.glob("explore_*.html")):
        raise ValueError(f"--explorers must be the folder of an earlier site, got {str(options.explorers)!r}")
    bar = {"total": 5, "desc": "explorers", "unit": "page", "disable": None}
    files = build(options.out, course(), options.explorers, lambda done: tqdm(done, **bar))
    if options.json:
        return json.dumps({"folder": str(options.out), "files": files}, indent=1)
    return f"{len(files)} files written to {options.out}: open {options.out / 'index.html'}"
