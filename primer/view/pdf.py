"""An HTML page of the course as PDF, printed by a browser that is on this machine."""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "msedge", "microsoft-edge")
_PLACES = (  # where macOS and Windows keep what no PATH names
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    "C:/Program Files/Google/Chrome/Application/chrome.exe",
    "C:/Program Files (x86)/Microsoft/Edge/Application/msedge.exe",
)


def browser() -> str:
    """The path of a browser that can print: Chromium, or one made of it.

    Raises
    ------
    ValueError    if none is on PATH or where macOS and Windows keep them
    """
    for name in _NAMES:
        if found := shutil.which(name):
            return found
    for place in _PLACES:
        if Path(place).is_file():
            return place
    raise ValueError("--pdf needs Chromium or Chrome on PATH to print, got none: print the pages from your browser")


def printed(program: str, page: Path, out: Path, patience: float = 300.0) -> None:
    """Print ``page``, an HTML file, to ``out`` with the browser ``program``, whole or not at all, asking no network.

    Raises
    ------
    ValueError    if the browser makes no PDF within ``patience`` seconds
    OSError       if the folder of ``out`` cannot be written
    """
    with tempfile.TemporaryDirectory(dir=out.parent, prefix=".print-") as folder:
        made = Path(folder, "page.pdf").resolve()
        command = [program, "--headless", "--disable-gpu", "--no-first-run", "--no-pdf-header-footer"]
        command += [
            "--disable-background-networking",
            "--proxy-server=127.0.0.1:9",
            f"--user-data-dir={folder}/profile",
        ]
        if getattr(os, "geteuid", lambda: 1)() == 0:  # Chromium refuses root its sandbox
            command.append("--no-sandbox")
        command += [f"--print-to-pdf={made}", page.resolve().as_uri()]
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=patience)
        except subprocess.TimeoutExpired:
            raise ValueError(f"--pdf: {program} did not print {page.name} within {patience:g} s") from None
        if done.returncode or not made.is_file() or not made.read_bytes().rstrip().endswith(b"%%EOF"):
            raise ValueError(f"--pdf: {program} made no PDF of {page.name} (exit code {done.returncode})")
        made.replace(out)
