"""A JupyterLab on 127.0.0.1 and a headless Chromium to look at it, for tests that drive the course as a reader does."""

import json
import os
import re
import shutil
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path
from urllib.error import URLError
from urllib.request import urlopen

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
ARTEFACTS = Path(__file__).with_name("artefacts")
# Every cell stays in the page, and nothing is asked of the network.
_SETTINGS = {
    "notebook-extension/tracker": {"windowingMode": "none"},
    "apputils-extension/notification": {"fetchNews": "false", "checkForUpdates": False, "doNotDisturbMode": True},
}


@contextmanager
def chromium():
    """A browser, closed at the end."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        try:
            yield browser
        finally:
            browser.close()


@contextmanager
def lab(folder, aside):
    """The address of a JupyterLab that serves ``folder``; its settings and its log go to ``aside``."""
    for name, value in _SETTINGS.items():
        path = aside / "settings" / "@jupyterlab" / f"{name}.jupyterlab-settings"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(value), encoding="utf-8")
    env = {
        **os.environ,
        "JUPYTERLAB_SETTINGS_DIR": str(aside / "settings"),
        "JUPYTERLAB_WORKSPACES_DIR": str(aside / "workspaces"),
        "JUPYTER_RUNTIME_DIR": str(aside / "runtime"),
    }
    options = ["--no-browser", "--ip=127.0.0.1", "--port=0", "--IdentityProvider.token=", "--allow-root"]
    with open(aside / "lab.log", "wb") as log:
        server = subprocess.Popen(
            [sys.executable, "-m", "jupyterlab", *options, str(folder)], env=env, stdout=log, stderr=log
        )
    try:
        yield _address(server, aside)
    finally:
        server.terminate()
        server.wait(30)


def _address(server, aside):
    """Where it serves, once it does."""
    for _ in range(600):
        for note in (aside / "runtime").glob("jpserver-*.json"):
            try:
                url = json.loads(note.read_text(encoding="utf-8"))["url"]
                with urlopen(f"{url}api/status", timeout=5):
                    return url.rstrip("/")
            except (ValueError, URLError, OSError):
                pass
        if server.poll() is not None:
            break
        time.sleep(0.1)
    raise RuntimeError("JupyterLab did not start:\n" + (aside / "lab.log").read_text(encoding="utf-8")[-2000:])


class Notebook:
    """A notebook in the browser: runs, is looked at, and remembers what went wrong on the console."""

    def __init__(self, browser, address, name):
        self.page, self.errors = browser.new_page(viewport={"width": 1400, "height": 1100}), []
        self.page.on("console", lambda said: said.type == "error" and self.errors.append(said.text))
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.goto(f"{address}/lab/tree/{name}?reset", timeout=120_000)
        self.page.locator(".jp-Notebook").wait_for(timeout=120_000)
        self.page.get_by_text("(ipykernel) | Idle").wait_for(timeout=120_000)

    def run_all(self):
        """Run -> Run All Cells, and wait until the last cell has its number."""
        self.page.get_by_role("menuitem", name="Run", exact=True).click()
        self.page.get_by_role("menuitem", name="Run All Cells", exact=True).click()
        self.page.wait_for_function(
            "() => [...document.querySelectorAll('.jp-CodeCell .jp-InputPrompt')]"
            ".every(prompt => /\\[\\d+\\]/.test(prompt.textContent))",
            timeout=300_000,
        )
        self.page.wait_for_timeout(500)

    def explorer(self, index=0):
        """One of its explorers, from the top."""
        box = self.page.locator(".primer-explorer").nth(index)
        box.scroll_into_view_if_needed()
        box.locator("img").first.wait_for(timeout=60_000)
        return Box(self.page, box)

    def photograph(self, name):
        """Keep a picture of the window as an artefact."""
        ARTEFACTS.mkdir(exist_ok=True)
        self.page.screenshot(path=ARTEFACTS / f"{name}.png")


class Box:
    """One explorer in the page."""

    def __init__(self, page, box):
        self.page, self.box = page, box

    @property
    def verdict(self):
        """What it says."""
        return self.box.locator(".primer-verdict").inner_text()

    @property
    def picture(self):
        """The address of the picture: another one for each picture."""
        return self.box.locator("img").first.get_attribute("src")

    def slider(self, label):
        """The handle of a slider, ready for arrow keys."""
        handle = self.box.locator(".widget-inline-hbox", has_text=label).locator(".noUi-handle")
        handle.focus()
        return handle

    def number(self, label):
        """The number box beside it."""
        row = self.box.locator(".widget-hbox", has=self.page.locator(".widget-inline-hbox", has_text=label))
        return row.last.locator("input[type=number]")

    def press(self, button):
        """Click a preset, or reset."""
        self.box.locator("button", has_text=re.compile(rf"^\s*{re.escape(button)}\s*$")).click()

    def wait_until(self, role, said):
        """Until the verdict has the role (``status``, or ``alert`` where something is wrong) and says so."""
        verdict = "box.querySelector('.primer-said')"
        self.page.wait_for_function(
            f"([box, role, said]) => {verdict}.getAttribute('role') === role && {verdict}.textContent.includes(said)",
            arg=[self.box.element_handle(), role, said],
            timeout=120_000,
        )

    def step(self, act):
        """Seconds from an act of the reader to a new picture on the page."""
        old, start = self.picture, time.perf_counter()
        act()
        self.page.wait_for_function(
            "([box, old]) => { const img = box.querySelector('img'); return img.src !== old && img.complete; }",
            arg=[self.box.element_handle(), old],
            timeout=120_000,
            polling=10,
        )
        return time.perf_counter() - start
