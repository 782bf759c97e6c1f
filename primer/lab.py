"""``primer lab FOLDER``: the course in JupyterLab, on a copy that is the student's own."""

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from tempfile import NamedTemporaryFile

_HERE = Path(__file__).resolve().parent
_SHIPPED = (_HERE / "notebooks", _HERE.parent / "notebooks")  # in an installed package; in a clone


def add_command(commands):
    """Add ``lab`` to the command line's argparse subparsers."""
    parser = commands.add_parser(
        "lab",
        help="open the course in JupyterLab, on a copy of the notebooks",
        description="Copy the notebooks into FOLDER and open JupyterLab there. What is already in FOLDER is never "
        "overwritten: come back to your own work with the same command.",
        epilog="example: primer lab my-course -- --no-browser --port 9000",
        allow_abbrev=False,
    )
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="where your copy is, or shall be")
    parser.add_argument("--copy-only", action="store_true", help="copy, and do not open JupyterLab")
    parser.add_argument("options", nargs="*", default=[], metavar="OPTION", help="after --: options of JupyterLab")
    parser.set_defaults(command=_run)


def copy_course(folder):
    """Copy each notebook that ``folder`` does not have yet; return (copied, kept), names relative to it.

    Raises
    ------
    ValueError    if folder cannot be made or written, or the notebooks are not installed
    """
    folder, source = Path(folder), _source()
    copied, kept = [], []
    try:
        for path in sorted(source.rglob("*.ipynb")):
            name = path.relative_to(source)
            if any(part.startswith(".") for part in name.parts):
                continue
            target = folder / name
            if target.exists():
                kept.append(name)
                continue
            target.parent.mkdir(parents=True, exist_ok=True)
            _copy(path, target)
            copied.append(name)
    except OSError as error:
        raise ValueError(
            f"FOLDER must be a folder that can be written, got {str(folder)!r} ({error.strerror})"
        ) from None
    return copied, kept


def _source():
    for place in _SHIPPED:
        if any(place.glob("*.ipynb")):
            return place
    raise ValueError(f"the notebooks must be installed with the package or lie beside it, got neither of {_SHIPPED}")


def _copy(path, target):
    """All of it or nothing, and never over what is there, even if that came a moment ago."""
    with NamedTemporaryFile(dir=target.parent, prefix=".copy-", delete=False) as aside:
        try:
            aside.write(path.read_bytes())
            aside.close()
            os.chmod(aside.name, 0o644)
            if not target.exists():
                os.replace(aside.name, target)
        finally:
            Path(aside.name).unlink(missing_ok=True)


def _run(options):
    if not options.copy_only and find_spec("jupyterlab") is None:
        raise ValueError("JupyterLab must be installed to open the course, got none: python -m pip install jupyterlab")
    copied, kept = copy_course(options.folder)
    told = f"{len(copied)} notebooks copied to {options.folder}, {len(kept)} of yours kept as they are"
    if options.copy_only:
        return told
    print(told, flush=True)
    start = options.folder / "00_start_here.ipynb"
    # The address that JupyterLab prints is of the first notebook, too: with --no-browser it is all there is.
    first = f"--LabApp.default_url=/lab/tree/{start.name}"
    ended = subprocess.run([sys.executable, "-m", "jupyterlab", str(start), first, *options.options], check=False)
    if ended.returncode:
        raise ValueError(f"JupyterLab must end well, got its exit code {ended.returncode}; the reason is printed above")
    return "JupyterLab has closed"
