"""``primer lab FOLDER``: the course in JupyterLab, on a copy that is the student's own."""

import argparse
import json
import os
import signal
import subprocess
import sys
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from tempfile import NamedTemporaryFile

_HERE = Path(__file__).resolve().parent
_SHIPPED = (_HERE / "notebooks", _HERE.parent / "notebooks")  # in an installed package; in a clone
_FIRST = Path("00_start_here.ipynb")
_FLAGS = ("copy_only", "without_solutions", "json")
# Nobody comes here for news of JupyterLab.
_QUIET = ("--LabApp.news_url=None", "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate")


def add_command(commands):
    """Add ``lab`` to the command line's argparse subparsers."""
    parser = commands.add_parser(
        "lab",
        help="open the course in JupyterLab, on a copy of the notebooks",
        description="Copy the notebooks into FOLDER and open JupyterLab there, on the notebook you worked on last. "
        "What is already in FOLDER is never overwritten: come back to your own work with the same command.",
        epilog="example: primer lab my-course --no-browser --port 9000",
        allow_abbrev=False,
    )
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="where your copy is, or shall be")
    parser.add_argument("--copy-only", action="store_true", help="copy, and do not open JupyterLab")
    parser.add_argument("--without-solutions", action="store_true", help="leave out the worked solutions")
    parser.add_argument("--json", action="store_true", help="with --copy-only: print one JSON object")
    rest = parser.add_argument("options", nargs=argparse.REMAINDER, metavar="OPTION", help="options of JupyterLab")
    rest.required = False  # some versions of Python name it among what is missing
    parser.set_defaults(command=_run)


def copy_course(folder, solutions=True):
    """Copy each notebook that ``folder`` does not have yet; return (copied, kept), names relative to it.

    Raises
    ------
    ValueError    if folder cannot be made or written, or the notebooks are not installed
    """
    folder, source = Path(folder), course()
    copied, kept = [], []
    try:
        for path in sorted(source.rglob("*.ipynb")):
            name = path.relative_to(source)
            if any(part.startswith(".") for part in name.parts) or (name.parts[0] == "solutions" and not solutions):
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


def last_worked_on(folder):
    """The notebook of ``folder`` that was changed last, of those that are no longer as they came; else the first."""
    source, changed = course(), {}
    for path in Path(folder).glob("*.ipynb"):
        shipped = source / path.name
        if not (shipped.exists() and shipped.read_bytes() == path.read_bytes()):
            changed[path.stat().st_mtime] = Path(path.name)
    return changed[max(changed)] if changed else _FIRST


def course():
    """The folder of the notebooks, as they came.

    Raises
    ------
    ValueError    if they are not there
    """
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
    rest = [option for option in options.options if option != "--"]
    for name in _FLAGS:  # ours, even behind FOLDER, where the rest is JupyterLab's
        flag = f"--{name.replace('_', '-')}"
        setattr(options, name, getattr(options, name) or flag in rest)
        rest = [option for option in rest if option != flag]
    if not options.copy_only and find_spec("jupyterlab") is None:
        raise ValueError("JupyterLab must be installed to open the course, got none: python -m pip install jupyterlab")
    copied, kept = copy_course(options.folder, solutions=not options.without_solutions)
    told = f"{len(copied)} notebooks copied to {options.folder}, {len(kept)} of yours kept as they are"
    if options.copy_only:
        names = {"folder": str(options.folder), "copied": copied, "kept": kept}
        return json.dumps(names, indent=1, default=Path.as_posix) if options.json else told
    print(told, flush=True)
    start = options.folder / last_worked_on(options.folder)
    # The address that JupyterLab prints is of that notebook, too: with --no-browser it is all there is.
    first = f"--LabApp.default_url=/lab/tree/{start.name}"
    code = _serve([sys.executable, "-m", "jupyterlab", str(start), first, *_QUIET, *rest])
    if code:
        raise ValueError(f"JupyterLab must end well, got its exit code {code}; the reason is printed above")
    return "JupyterLab has closed"


def _serve(command):
    """Run JupyterLab, and end it where this process is ended: by Ctrl-C or a signal, without a question.

    It has a session of its own, so that Ctrl-C does not reach it a second way.
    """
    server, early = None, []

    def stop(number, frame):
        if server is not None:
            raise KeyboardInterrupt
        early.append(number)  # no sooner than there is a server to end

    before = {}
    with suppress(ValueError):  # only the main thread may
        before = {number: signal.signal(number, stop) for number in _signals()}
    try:
        server = subprocess.Popen(command, stdin=subprocess.DEVNULL, start_new_session=True)
        if early:
            raise KeyboardInterrupt
        return server.wait()
    finally:
        for number in before:
            signal.signal(number, signal.SIG_IGN)  # not twice
        if server is not None and server.poll() is None:
            server.terminate()
            try:
                server.wait(10)
            except subprocess.TimeoutExpired:
                server.kill()
        for number, handler in before.items():
            signal.signal(number, handler)


def _signals():
    return [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
