"""``primer slides OUT``: slides and a handout of each notebook, that need no network."""

import json
from pathlib import Path

from primer.lab import course


def add_command(commands):
    """Add ``slides`` to the command line's argparse subparsers."""
    parser = commands.add_parser(
        "slides",
        help="write slides and a handout of each notebook, for any browser, without network",
        description="Write NN_name.slides.html (arrow keys turn the pages) and NN_name.handout.html (to read, or to "
        "print) of each executed notebook into the folder OUT; with --pdf, both also as PDF.",
        epilog="example: primer slides for-class",
        allow_abbrev=False,
    )
    parser.add_argument("out", metavar="OUT", type=Path, help="folder of the pages")
    parser.add_argument("--pdf", action="store_true", help="PDFs as well, printed by the Chromium or Chrome found here")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.set_defaults(command=_run)


def _run(options):
    from primer.view.site.words import possible

    if not possible():
        raise ValueError("nbconvert must be installed to write slides, got none: python -m pip install jupyterlab")
    from primer.view.pdf import browser, printed
    from primer.view.slides import pages

    program = browser() if options.pdf else None
    written = []
    try:
        options.out.mkdir(parents=True, exist_ok=True)
        for path in sorted(course().glob("*.ipynb")):
            for kind, page in zip(("slides", "handout"), pages(path), strict=True):
                name = f"{path.stem}.{kind}.html"
                (options.out / name).write_text(page, encoding="utf-8", newline="\n")
                written.append(name)
                if program:
                    target = (options.out / name).with_suffix(".pdf")
                    printed(program, options.out / name, target)
                    written.append(target.name)
    except OSError as error:
        raise ValueError(
            f"OUT must be a folder that can be written, got {str(options.out)!r} ({error.strerror})"
        ) from None
    if options.json:
        return json.dumps({"folder": str(options.out), "files": written}, indent=1)
    return f"{len(written)} files written to {options.out}"
