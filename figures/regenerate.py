"""Regenerate the figures, each with a JSON of its numbers: ``python figures/regenerate.py [NAME ...]``.

Some are made on request, that is by name: a movie, as mp4 where ffmpeg is found, else as GIF; and a page, as HTML.
"""

import argparse
import json
import os
import signal
import sys
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from importlib import import_module
from multiprocessing import parent_process
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Thread

import sidecar
from tqdm import tqdm

from primer.view.movie import MOVIES, Movie, save_movie, writable
from primer.view.page import Page, save_page
from primer.view.style import FORMATS, save, styled

HERE = Path(__file__).resolve().parent
ON_REQUEST = ["blow_up_movie", "explorer"]  # too slow to draw each time, or too large to keep
PAGES = ["explorer"]
_NEEDS = {
    "blow_up_movie": "ffmpeg or Pillow to be written, and neither is here",
}
NAMES = sorted({path.stem for path in HERE.glob("*.py")} - {"regenerate", "sidecar", "readme", *ON_REQUEST})


def main(arguments=None):
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")  # a folder's name may have letters the terminal has not
    options = _options(arguments)
    if options.list:
        for name in NAMES + ON_REQUEST:
            note = " [on request]" if name in ON_REQUEST else ""
            print(f"{name:18s} {import_module(name).__doc__.splitlines()[0]}{note}")
        return 0
    job, tell = (_check, "checked") if options.check else (_make, "written")
    problems, kept = [], []
    with ProcessPoolExecutor(min(options.jobs, len(options.names)), initializer=_as_a_worker) as pool:
        waiting = {pool.submit(job, name, options.out, options.formats, options.redraw): name for name in options.names}
        try:
            with tqdm(total=len(waiting), unit="figure", disable=None) as bar:
                for done in _as_they_come(waiting, bar):
                    name = waiting[done]
                    if isinstance(error := done.exception(), Exception):  # a full disk, a worker that died
                        problems.append(f"{name}: not {tell} ({type(error).__name__}: {error})")
                    else:
                        sentences, held = done.result()
                        problems += [f"{name}: {sentence}" for sentence in sentences]
                        kept += [name] * held
                    bar.update()
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
            print("interrupted: what was not finished is as it was before", file=sys.stderr)
            return 130
    for sentence in sorted(problems):
        print(sentence, file=sys.stderr)
    good = len(options.names) - len({sentence.split(":")[0] for sentence in problems})
    print(f"{good} of {len(options.names)} figures {'up to date' if kept else tell} in {options.out}")
    if kept:
        print(f"{len(kept)} were there, their numbers hold, and they are as they were: --redraw draws them anew")
    return 1 if problems else 0


def _as_they_come(waiting, bar):
    """Yield the futures that are done; once a second the bar has the time, and what is at work."""
    left = set(waiting)
    while left:
        done, left = wait(left, timeout=1, return_when=FIRST_COMPLETED)
        yield from done
        bar.set_postfix_str(", ".join(sorted(waiting[each] for each in left if each.running())))


def _as_a_worker():
    """End with Ctrl-C, and with the process that waits for the figures.

    A sweep takes Ctrl-C for the wish to see what there is, but half a sweep makes no figure; and a worker whose parent
    was killed would wait for work for ever.
    """
    signal.signal(signal.SIGINT, lambda *_: sys.exit(130))
    Thread(target=lambda: (parent_process().join(), os._exit(1)), daemon=True).start()


def _make(name, out, formats, redraw):
    """Compute one figure; write its pictures and numbers aside, then put them in place.

    What is there already, with numbers that hold, is left alone: another machine has other last digits. Returns
    (sentences about what went wrong: none, whether all was left alone).
    """
    script = import_module(name)
    result = script.compute()
    numbers, formats = script.numbers(result), formats or _formats(name)[:1]
    there = not redraw and not _drift(name, out, numbers)
    formats = [ending for ending in formats if not (there and Path(out, f"{name}.{ending}").exists())]
    with TemporaryDirectory(dir=out, prefix=".regenerate-") as aside, styled():
        files = [Path(aside, f"{name}.{ending}") for ending in formats]
        for picture in files:
            drawn = script.draw(result)
            if (kind := type(drawn)) in (Movie, Page):
                {Movie: save_movie, Page: save_page}[kind](drawn, picture)
            else:
                save(drawn, picture, script.__doc__)
        if not there:
            files.append(Path(aside, f"{name}.json"))
            files[-1].write_text(sidecar.dumps(numbers), encoding="utf-8", newline="\n")
        for file in files:
            os.replace(file, Path(out, file.name))
    return [], not files


def _check(name, out, formats, redraw):
    """Compute one figure's numbers again; return a sentence for each that left the stored one, as ``_make`` does."""
    script = import_module(name)
    return _drift(name, out, script.numbers(script.compute())), False


def _drift(name, out, fresh):
    """A sentence for each of the fresh numbers that left the stored one."""
    try:
        stored = json.loads(Path(out, f"{name}.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        return [f"no stored numbers to compare with ({error})"]
    try:
        return sidecar.drift(stored, fresh)
    except (AttributeError, KeyError, TypeError):
        return [f"no stored numbers to compare with ({name}.json holds no claims)"]


def _formats(name):
    """What a figure can be written as here, the default first."""
    if name in PAGES:
        return ("html",)
    return writable() if name in ON_REQUEST else FORMATS


def _options(arguments):
    about = __doc__.replace("``", "")
    parser = argparse.ArgumentParser(prog="regenerate.py", description=about, allow_abbrev=False)
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help="figures to make (default: all but those on request; see --list)"
    )
    parser.add_argument("--list", action="store_true", help="list the figures and what they show, and stop")
    parser.add_argument("--out", default=str(HERE), metavar="DIR", help="folder of the pictures (default: figures/)")
    parser.add_argument(
        "--check", action="store_true", help="write nothing: recompute and compare with the stored JSON"
    )
    parser.add_argument("--redraw", action="store_true", help="draw anew what is there with numbers that hold")
    parser.add_argument(
        "--jobs", type=int, default=os.cpu_count() or 1, metavar="N", help="processes (default: all cores)"
    )
    parser.add_argument("--formats", help=f"some of {','.join(FORMATS)} (default: svg), of {','.join(MOVIES)}, or html")
    options = parser.parse_args(arguments)
    for name in options.names:
        if name not in NAMES + ON_REQUEST:
            parser.error(f"NAME must be one of {', '.join(NAMES + ON_REQUEST)}, got {name!r}")
    options.names = list(dict.fromkeys(options.names)) or NAMES
    if options.jobs < 1:
        parser.error(f"--jobs must be >= 1, got {options.jobs}")
    for name in options.names:
        if not (_formats(name) or options.check or options.list):
            parser.error(f"{name} needs {_NEEDS[name]}")
    if options.formats is not None:
        special, allowed = [name for name in options.names if name in ON_REQUEST], _formats(options.names[0])
        options.formats = list(dict.fromkeys(options.formats.split(",")))
        if any(_formats(name) != allowed for name in options.names):
            parser.error(f"--formats of {special[0]} are not those of the others: make it in a call of its own")
        for ending in options.formats:
            if ending not in allowed:
                parser.error(f"--formats must be some of {','.join(allowed)}, got {ending!r}")
    if not options.out or "\0" in options.out:
        parser.error(f"--out must be the name of a folder, got {options.out!r}")
    options.out = Path(options.out)
    if not (options.check or options.list):
        try:
            options.out.mkdir(parents=True, exist_ok=True)
            TemporaryDirectory(dir=options.out, prefix=".regenerate-").cleanup()
        except OSError as error:
            parser.error(f"--out must be a folder that can be written, got {str(options.out)!r} ({error.strerror})")
    return options


if __name__ == "__main__":
    sys.exit(main())
