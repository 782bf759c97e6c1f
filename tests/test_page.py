"""Guards the page that needs no installation: its numbers, no network, and what a reader does in a real browser."""

import base64
import json
import re
import statistics
import subprocess
import sys
import time
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from jupyter import ARTEFACTS, CHROMIUM, chromium

import primer
from primer.scenes.base_state import base_state
from primer.view import BaseStateExplorer
from primer.view.page import explorer_page, possible
from primer.view.page.plots import LINES
from primer.view.page.states import atlas

FIGURES = Path(__file__).parents[1] / "figures"
VIEW = Path(primer.__file__).parent / "view" / "page"
sys.path.insert(0, str(FIGURES))

import explorer  # noqa: E402
import regenerate  # noqa: E402

A, GRIDS = (-0.5, 0.5, 1.1, 1.5), (16, 30, 100)
needs_bokeh = pytest.mark.skipif(not possible(), reason="Bokeh is not installed (the extra 'page')")


@pytest.fixture(scope="module")
def small():
    return atlas(A, GRIDS)


@pytest.fixture(scope="module")
def html(small):
    return explorer_page(small, (1.5, 100), {"ill posed": (0.5, 30), "<b>&": (0.5, 100)}).html


def embedded(html):
    (text,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', html)
    return json.loads(text)


def curve(data, state, name):
    """Name of a coordinate -> its numbers as the page has them."""
    return {
        axis: np.frombuffer(base64.b64decode(data["arrays"][place]), "<f4")
        for axis, place in state["curves"][name].items()
    }


class Elements(HTMLParser):
    """(tag, attributes) of everything in a page."""

    def __init__(self, html):
        super().__init__()
        self.found = []
        self.feed(html)

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes)))


# ---- what is in the file


@needs_bokeh
@pytest.mark.parametrize("a", A)
@pytest.mark.parametrize("n", GRIDS)
def test_the_numbers_are_those_of_base_state(html, a, n):
    data, answer = embedded(html), base_state(a, 0.01, n)
    state, run = data["states"][data["a"].index(a)][data["n"].index(n)], answer.run
    assert (state["verdict"], state["kind"]) == (answer.verdict, str(answer.kind))
    closed = [np.append(f, f[0]) for f in (*run.final,)]
    for name, x, y in (
        ("equations", answer.xi, answer.rate),
        ("grid", answer.grid_xi, answer.grid_rate),
        ("end", [n / 2], answer.grid_rate[-1:]),
        ("u", np.append(run.x, np.pi), closed[0]),
        ("v", np.append(run.x, np.pi), closed[1]),
    ):
        got = curve(data, state, name)
        np.testing.assert_array_equal(got["x"], np.float32(x))
        np.testing.assert_array_equal(got["y"], np.float32(y))
    dist = curve(data, state, "dist")
    rows = np.searchsorted(np.float32(run.t), dist["x"])
    np.testing.assert_array_equal(dist["x"], np.float32(run.t[rows]))
    np.testing.assert_array_equal(dist["y"], np.float32(run.dist[rows]))
    assert (rows[0], rows[-1]) == (0, run.t.size - 1)
    assert np.diff(rows).max() <= 3
    steady = curve(data, state, "steady")
    np.testing.assert_allclose(steady["y"], a - np.cos(steady["x"]), atol=1e-6)
    for name, time_of in (
        ("first", run.t_first_negative),
        ("foretold", answer.predicted),
        ("blow_up", answer.measured),
    ):
        seen = time_of is not None and time_of <= 100
        np.testing.assert_array_equal(curve(data, state, name)["x"], np.float32([time_of] if seen else []))
        assert (f"t = {time_of:.3g}" in state["labels"][name]) if seen else (state["labels"][name] == "")
    shaded = curve(data, state, "negative")
    inside = ((run.x[:, None] > shaded["left"]) & (run.x[:, None] < shaded["right"])).any(axis=1)
    np.testing.assert_array_equal(inside[1:], run.final[0][1:] < 0)  # at -pi a strip begins, or not
    assert bool(state["labels"]["negative"]) == (run.final[0] < 0).any()


def test_words_say_what_the_pictures_show(small):
    well, ill, hidden = small.at(1.5, 100), small.at(0.5, 100), small.at(0.5, 16)
    assert "The equations: nowhere above zero. On N = 100" in well.alts["growth"]
    assert well.numbers["growth"] == "nothing grows"
    assert (well.numbers["foretold"], well.numbers["measured"]) == ("never", "none by t = 100")
    # Frozen at u = a - 1 = -1/2 the growth rate is above zero from xi = 14.2 on, where eps |u| xi^2 = 1.
    assert "The equations: above zero from xi = 14.5 on" in ill.alts["growth"]
    assert ill.numbers["growth"] == "2.727"
    assert "On N = 16 points, whose shortest wave is xi = 8: nowhere above zero" in hidden.alts["growth"]
    assert "0.000658 at the end, t = 100" in well.alts["dist"]
    assert "u < 0 at 0 of 100 points" in well.alts["fields"]
    assert re.search(r"u < 0 at [1-9]\d* of 16 points", hidden.alts["fields"])


@needs_bokeh
def test_nothing_is_asked_of_the_network_and_nothing_is_computed(html):
    elements = Elements(html).found
    (policy,) = [each["content"] for _, each in elements if each.get("http-equiv") == "Content-Security-Policy"]
    assert policy.startswith("default-src 'none'; ")
    assert "http" not in policy
    assert not [tag for tag, each in elements if {"src", "href", "srcset", "action"} & set(each)]
    assert not {"link", "iframe", "object", "base", "form"} & {tag for tag, _ in elements}
    ours = html.replace((VIEW / "page.js").read_text(encoding="utf-8"), "", 1)
    assert ours != html  # the script is in the page as it stands in the package
    for name in ("page.html", "page.css", "page.js"):
        text = (VIEW / name).read_text(encoding="utf-8")
        assert not re.search(r"https?:|url\(|@import|fetch\(|XMLHttpRequest|import\(|WebSocket|eval\(", text), name
    script = (VIEW / "page.js").read_text(encoding="utf-8")
    assert set(re.findall(r"Math\.(\w+)", script)) == {"min", "max", "abs"}  # to find the nearest state


@needs_bokeh
def test_the_page_has_names_for_everything(html):
    elements = Elements(html).found
    ids = [each["id"] for _, each in elements if "id" in each]
    assert len(ids) == len(set(ids))
    labelled = {each["for"] for tag, each in elements if tag == "label"}
    for tag, each in elements:
        if tag == "input":
            assert each["id"] in labelled or each["aria-label"]
    assert {each["id"] for _, each in elements if each.get("role") == "img"} == {f"{name}-picture" for name in LINES}
    assert {each["id"] for _, each in elements if each.get("role") == "status"} == {"note", "verdict"}
    assert {tag for tag, _ in elements} >= {"h1", "h2", "main", "footer", "noscript", "caption"}
    assert "lang" in dict(elements)["html"]
    assert "&lt;b&gt;&amp;</button>" in html


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_colours_can_be_told_from_what_is_behind_them(scheme):
    """The contrast of WCAG 2: 4.5 for words, 3 for lines, on the paper and on shaded parts."""
    css = (VIEW / "page.css").read_text(encoding="utf-8").split("@media (prefers-color-scheme: dark)")
    colours = dict(re.findall(r"(--\w+): #(\w{6})", css[scheme == "dark"].partition("}")[0]))

    def light(name):
        part = np.array([int(colours[name][k : k + 2], 16) for k in (0, 2, 4)]) / 255
        return np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4) @ [0.2126, 0.7152, 0.0722]

    def contrast(one, other):
        low, high = sorted((light(one), light(other)))
        return (high + 0.05) / (low + 0.05)

    assert min(contrast("--ink", "--paper"), contrast("--steady", "--paper")) >= 4.5
    for line in ("--ink", "--steady", "--u", "--v"):
        assert contrast(line, "--ill") >= 3, line
        assert contrast(line, "--paper") >= 3, line
    assert min(contrast("--frame", "--paper"), contrast("--well", "--paper")) >= 3


def test_no_curve_is_told_apart_by_its_colour_alone():
    for lines in LINES.values():
        assert len({(line.shape, line.dash) for line in lines.values()}) == len(lines)


# ---- bad calls


def test_an_atlas_needs_numbers_that_increase(small):
    with pytest.raises(ValueError, match=r"a must hold numbers that increase, at least one, got \(1.5, 0.5\)"):
        atlas((1.5, 0.5), (16,))
    with pytest.raises(ValueError, match=r"n must hold numbers that increase"):
        atlas((1.5,), ())
    with pytest.raises(TypeError, match="n must be a sequence of numbers, got int"):
        atlas((1.5,), 16)
    with pytest.raises(ValueError, match=r"\(a, n\) must be a state of the atlas, got \(0.7, 30\)"):
        explorer_page(small, (0.7, 30), {})
    with pytest.raises(TypeError, match="states must be"):
        explorer_page([], (0.5, 30), {})


def test_without_bokeh_the_command_names_the_extra(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(regenerate, "possible", lambda: False)
    with pytest.raises(SystemExit) as stopped:
        regenerate.main(["explorer", "--out", str(tmp_path)])
    assert stopped.value.code == 2
    said = capsys.readouterr().err
    assert "explorer needs Bokeh, which the extra 'page' brings" in said
    assert not list(tmp_path.iterdir())


def test_the_readme_counts_the_states():
    readme = (FIGURES.parent / "README.md").read_text(encoding="utf-8")
    assert f"Its {len(explorer.A) * len(explorer.GRIDS)} states" in readme


@pytest.mark.slow
def test_the_presets_are_those_of_the_notebook():
    assert explorer.PRESETS.keys() == BaseStateExplorer.presets.keys()
    for name, (a, n) in explorer.PRESETS.items():
        asked = BaseStateExplorer.from_state(BaseStateExplorer.presets[name]).values
        assert (asked["a"], asked["n"], asked["eps"]) == (a, n, 0.01)


# ---- in the browser


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The whole page, as a user makes it."""
    folder = tmp_path_factory.mktemp("page")
    command = [sys.executable, str(FIGURES / "regenerate.py"), "--out", str(folder), "explorer"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert {path.name for path in folder.iterdir()} == {"explorer.html", "explorer.json"}
    return folder / "explorer.html"


@pytest.fixture(scope="module")
def reader(made):
    with chromium() as browser:
        yield Reader(browser, made)


class Reader:
    """The page in a browser without network, and what went wrong there."""

    def __init__(self, browser, path):
        self.address, self.errors = path.as_uri(), []
        self.context = browser.new_context(viewport={"width": 1280, "height": 1100}, color_scheme="light")
        self.context.set_offline(True)
        self.page = self.context.new_page()
        self.page.on("console", lambda said: said.type in ("error", "warning") and self.errors.append(said.text))
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("request", self._asked)
        # When something was last drawn on a canvas.
        self.page.add_init_script(
            "for (const name of ['stroke', 'fill', 'fillText']) { const old = CanvasRenderingContext2D.prototype[name];"
            "CanvasRenderingContext2D.prototype[name] = function (...all) { window.drawn = performance.now();"
            "return old.apply(this, all); }; }"
        )

    def _asked(self, request):
        if not request.url.startswith(("file:", "data:")):
            self.errors.append(f"asked the network for {request.url}")

    def open(self, state=""):
        """Open the page anew; return the seconds until its first state is drawn."""
        self.page.goto("about:blank")
        start = time.perf_counter()
        self.page.goto(self.address + state)
        self.page.wait_for_selector("html[data-ready]", state="attached", timeout=120_000)
        self.page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        return time.perf_counter() - start

    def shows(self, a, n):
        """Assert that words, numbers and curves are those of ``base_state``, and that the controls say so."""
        answer, page = base_state(a, 0.01, n), self.page
        assert page.locator("#verdict").inner_text() == answer.verdict
        assert float(page.locator("#a-number").input_value()) == a
        assert int(page.locator("#n-number").input_value()) == n
        assert page.locator("#a-slider").get_attribute("aria-valuetext") == f"{a:g}"
        assert page.locator("#n-slider").get_attribute("aria-valuetext") == f"{n}"
        assert page.locator("#number-dist").inner_text().startswith(f"{answer.run.dist[-1]:.4g} ")
        assert page.locator("#number-end").inner_text() == f"t = {answer.run.t_stop:.4g}"
        for name, wanted in (
            ("equations", answer.rate),
            ("grid", answer.grid_rate),
            ("u", [*answer.run.final[0], answer.run.final[0][0]]),
            ("v", [*answer.run.final[1], answer.run.final[1][0]]),
        ):
            np.testing.assert_array_equal(self.plotted(name), np.float32(wanted))
        assert self.plotted("dist")[-1] == np.float32(answer.run.dist[-1])

    def plotted(self, name):
        """The ordinates of a curve, as the plot has them."""
        code = "(name) => [...Bokeh.documents.map((each) => each.get_model_by_name(name)).find((it) => it).data.y]"
        return np.array(self.page.evaluate(code, name))

    def wait_until(self, said):
        """Until it is so; the page's policy lets nobody's text be evaluated inside of it, not even a test's."""
        for _ in range(2000):
            if self.page.evaluate(said):
                return
            self.page.wait_for_timeout(50)
        raise AssertionError(f"in vain: {said}")

    def focus(self, id):
        self.page.locator(id).focus()

    def type(self, id, text):
        self.page.locator(id).fill(text)
        self.page.keyboard.press("Enter")


browser_test = [
    pytest.mark.slow,
    needs_bokeh,
    pytest.mark.skipif(CHROMIUM is None, reason="no Chromium is installed (Debian: apt-get install chromium)"),
]


def in_browser(function):
    for mark in browser_test:
        function = mark(function)
    return function


@in_browser
def test_opens_quickly_and_small(reader, made, measured):
    seconds = [reader.open() for _ in range(3)]
    reader.shows(1.5, 100)
    size = made.stat().st_size
    assert size < 6_000_000
    measured(f"explorer.html: {size / 1e6:.2f} MB, first state drawn {statistics.median(seconds):.2f} s after opening")
    assert not reader.errors


@in_browser
def test_answers_to_the_keyboard(reader):
    reader.open()
    reader.focus("#a-slider")
    for _ in range(20):
        reader.page.keyboard.press("ArrowLeft")
    reader.shows(0.5, 100)
    assert reader.page.locator("button[aria-pressed=true]").inner_text() == "ill posed"
    reader.page.keyboard.press("Tab")  # to the number box, where arrows go to the next state too
    reader.page.keyboard.press("ArrowUp")
    reader.shows(0.55, 100)
    reader.page.keyboard.press("Tab")
    reader.page.keyboard.press("End")
    reader.shows(0.55, 200)
    reader.page.keyboard.press("ArrowLeft")
    reader.shows(0.55, 160)
    reader.page.keyboard.press("Tab")
    reader.page.keyboard.press("ArrowDown")
    reader.shows(0.55, 128)
    for name, (a, n) in explorer.PRESETS.items():
        reader.page.keyboard.press("Tab")
        assert reader.page.evaluate("document.activeElement.textContent") == name
        reader.page.keyboard.press("Enter")
        reader.shows(a, n)
    reader.page.keyboard.press("Tab")
    assert reader.page.evaluate("document.activeElement.tagName") == "BODY"  # no trap in the plots
    assert not reader.errors


@in_browser
def test_answers_to_numbers_and_says_what_is_not_there(reader):
    reader.open()
    reader.type("#a-number", "-0.35")
    reader.type("#n-number", "64")
    reader.shows(-0.35, 64)
    assert reader.page.locator("#note").text_content() == ""
    reader.type("#n-number", "70")
    reader.shows(-0.35, 64)
    assert reader.page.locator("#note").inner_text() == "N = 70 is not on this page: the nearest is 64."
    reader.type("#a-number", "9")
    reader.shows(2.0, 64)
    assert reader.page.locator("#note").inner_text() == "a = 9 is not on this page: the nearest is 2."
    reader.type("#a-number", "")
    reader.shows(2.0, 64)
    assert reader.page.locator("#note").inner_text() == "a must be a number: it stays 2."
    reader.type("#a-number", "1.1")
    reader.shows(1.1, 64)
    assert reader.page.locator("#note").text_content() == ""
    assert not reader.errors


@in_browser
def test_the_address_holds_the_state(reader):
    reader.open("#a=0.5&n=30")
    reader.shows(0.5, 30)
    reader.focus("#n-slider")
    reader.page.keyboard.press("ArrowRight")
    reader.wait_until("location.hash === '#a=0.5&n=40'")
    reader.page.evaluate("location.hash = '#a=1.1'")
    reader.wait_until("document.getElementById('a-number').value === '1.1'")
    reader.shows(1.1, 40)
    reader.open("#a=<b>&n=1e9&x=1")
    reader.shows(1.5, 200)
    assert "a must be a number" in reader.page.locator("#note").inner_text()
    assert not reader.errors


@in_browser
def test_light_and_dark(reader):
    reader.open("#a=0.5&n=100")
    ARTEFACTS.mkdir(exist_ok=True)
    seen = {}
    for scheme in ("light", "dark"):
        reader.page.emulate_media(color_scheme=scheme)
        reader.page.wait_for_timeout(300)
        paper = reader.page.evaluate("getComputedStyle(document.body).backgroundColor")
        axis = reader.page.evaluate("Bokeh.documents[0].roots()[0].below[0].major_label_text_color")
        seen[scheme] = paper, axis
        reader.page.screenshot(path=ARTEFACTS / f"page_{scheme}.png", full_page=True)
    assert seen["light"][0] == "rgb(255, 255, 255)"
    assert seen["dark"][0] == "rgb(20, 23, 26)"
    assert (seen["light"][1], seen["dark"][1]) == ("#1a1a1a", "#ececec")
    reader.page.emulate_media(color_scheme="light")
    assert not reader.errors


@in_browser
def test_fits_a_telephone(reader):
    reader.open("#a=0.5&n=30")
    reader.page.set_viewport_size({"width": 360, "height": 740})
    reader.page.wait_for_timeout(300)
    assert reader.page.evaluate("document.documentElement.scrollWidth") <= 360
    reader.page.screenshot(path=ARTEFACTS / "page_narrow.png", full_page=True)
    reader.page.set_viewport_size({"width": 1280, "height": 1100})
    assert not reader.errors


@in_browser
def test_a_slider_step_is_drawn_soon(reader, measured):
    reader.open("#a=0.5&n=100")
    steps = reader.page.evaluate(
        """async () => {
          const slider = document.getElementById("a-slider"), seconds = [];
          for (const way of [1, 1, 1, 1, 1, -1, -1, -1, -1, -1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1]) {
            slider.value = Number(slider.value) + way;
            const start = performance.now();
            slider.dispatchEvent(new Event("input"));
            await new Promise((done) => setTimeout(done, 200));
            seconds.push((window.drawn - start) / 1000);
          }
          return seconds;
        }"""
    )
    measured(f"explorer.html: a slider step is drawn after {1e3 * statistics.median(steps):.0f} ms (median of 20)")
    assert min(steps) > 0  # each step was drawn
    reader.shows(0.5, 100)
    assert not reader.errors
