"""Guards the site: the course as pages that open from a file without network, whose numbers are primer's."""

import json
import os
import re
from pathlib import Path

import numpy as np
import pytest
from jupyter import ARTEFACTS, CHROMIUM, chromium

from primer.__main__ import main
from primer.scenes.pde import pde as answer
from primer.view.explorers import PDEExplorer
from primer.view.page.closed import closed_form
from primer.view.page.collection import PAGES, shelves
from primer.view.page.record import recorded
from primer.view.picture import Picture
from primer.view.site.words import equations, mathml, numbered, prose
from primer.view.style import styled

ROOT = Path(__file__).parents[1]
AXE = os.environ.get("PRIMER_AXE")  # axe.min.js of axe-core, which is not part of the package
READY = os.environ.get("PRIMER_EXPLORERS")  # a folder of an earlier site, to save some minutes


# ---- words


def test_mathematics_needs_no_network():
    html = prose(r"The symbol $\lambda^2 + \xi^2$ and $$u_t = v_x \qquad (79)$$ and $x < y$.")
    assert html.count("<math ") == 3
    assert "$" not in html
    assert 'alttext="\\lambda^2 + \\xi^2"' in html
    assert "&lt;" in mathml("x < y", display=False)


def test_equations_are_linked_by_number():
    assert equations()["toy-mat"] == "82"
    assert equations()["42b"] == "68"
    for text in ("see (toy-mat)", "see (82) (toy-mat)"):
        linked = numbered(f"<p>{text}</p>")
        assert linked.count('<a href="equations.html#toy-mat">(82)</a>') == 1
        assert linked.count("(82)") == 1
    for kept in ("<code>(toy-mat)</code>", "<pre>(toy-mat)</pre>", "<math>(toy-mat)</math>", "f(x)"):
        assert numbered(kept) == kept


def test_labels_of_the_paper_have_numbers():
    labels = (ROOT / "tests" / "paper_labels.txt").read_text(encoding="utf-8").split()
    assert {label for label in equations() if label not in labels} == set()


# ---- bad calls


def test_a_folder_that_cannot_be(tmp_path, capsys):
    (tmp_path / "file").write_text("", encoding="utf-8")
    assert main(["site", str(tmp_path / "file" / "site")]) == 2
    assert re.fullmatch(r"primer: OUT must be a folder that can be written, got .*\n", capsys.readouterr().err)
    assert main(["site", str(tmp_path / "site"), "--explorers", str(tmp_path)]) == 2
    assert "--explorers must be the folder of an earlier site" in capsys.readouterr().err


# ---- the site in a browser without network

pages = pytest.mark.slow


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    assert main(["site", str(folder), "--json", *(["--explorers", READY] if READY else [])]) == 0
    return folder


@pytest.fixture(scope="module")
def browser(site):
    if CHROMIUM is None:
        pytest.skip("no Chromium is installed (Debian: apt-get install chromium)")
    with chromium() as browser:
        yield Browser(browser)


class Browser:
    """A browser without network, and what went wrong in it."""

    def __init__(self, browser):
        self.context = browser.new_context(viewport={"width": 1280, "height": 1000}, color_scheme="light")
        self.context.set_offline(True)
        self.page, self.errors = self.context.new_page(), []
        self.page.on("console", lambda said: said.type in ("error", "warning") and self.errors.append(said.text))
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on("request", self._asked)

    def _asked(self, request):
        if not request.url.startswith(("file:", "data:", "about:")):
            self.errors.append(f"asked the network for {request.url}")

    def open(self, path, state=""):
        self.errors.clear()  # what another test made of the page before
        self.page.goto("about:blank")
        self.page.goto(path.as_uri() + state)
        if path.name.startswith("explore_"):
            self.page.wait_for_selector("html[data-ready]", state="attached", timeout=20_000)


def html_pages(site):
    return sorted(site.rglob("*.html"))


@pages
def test_every_page_is_there_and_small(site):
    names = {path.relative_to(site).as_posix() for path in html_pages(site)}
    lessons = {path.stem for path in (ROOT / "notebooks").glob("*.ipynb")}
    assert names >= {f"{name}.html" for name in lessons} | {f"solutions/{name}.html" for name in lessons}
    assert names >= {f"explore_{name}.html" for name, _, _ in PAGES.values()}
    assert names >= {"index.html", "figures.html", "equations.html", "claims.html"}
    assert max(path.stat().st_size for path in html_pages(site)) < 6_000_000


@pages
def test_nothing_is_asked_of_the_network_and_links_lead_somewhere(site):
    for path in html_pages(site):
        html = path.read_text(encoding="utf-8")
        assert not re.search(r'\b(?:src|poster|srcset)="https?:|<link[^>]*https?:|@import', html), path.name
        if path.name.startswith("explore_"):
            continue
        assert "$$" not in re.sub(r"<pre.*?</pre>|alttext=\".*?\"", "", html, flags=re.S)
        for target in re.findall(r'(?:href|src)="(?!https?:|data:|mailto:)([^"]+)"', html):
            address, _, place = target.partition("#")
            other = (path.parent / address) if address else path
            assert other.exists(), (path.name, target)
            if place and not other.name.startswith("explore_"):
                assert re.search(rf'id="{re.escape(place)}"', other.read_text(encoding="utf-8")), (path.name, target)


@pages
def test_every_page_opens_without_a_complaint(site, browser):
    ARTEFACTS.mkdir(exist_ok=True)
    for path in html_pages(site):
        for width, scheme in ((1280, "light"), (390, "dark"), (320, "light")):
            browser.page.set_viewport_size({"width": width, "height": 900})
            browser.page.emulate_media(color_scheme=scheme)
            browser.open(path)
            assert browser.page.evaluate("document.documentElement.scrollWidth") <= width, (path.name, width)
            named = "[...document.images].every((image) => image.getAttribute('alt'))"
            assert browser.page.evaluate(named), path.name
            if path.parent == site:
                browser.page.screenshot(path=ARTEFACTS / f"site_{path.stem}_{width}_{scheme}.png", full_page=True)
        assert browser.errors == [], path.name
    browser.page.set_viewport_size({"width": 1280, "height": 1000})


@pages
def test_a_notebook_has_live_explorers(site, browser):
    browser.open(site / "03_grid_dependence.html")
    frame = browser.page.frame_locator("iframe").first
    frame.locator("#verdict").wait_for()
    begun = frame.locator("#verdict").inner_text()
    frame.locator("#number-a").fill("0.5")
    frame.locator("#number-a").press("Enter")
    assert frame.locator("#verdict").inner_text() != begun
    assert not browser.errors


@pages
@pytest.mark.skipif(AXE is None, reason="PRIMER_AXE names no axe.min.js of axe-core")
def test_axe_finds_nothing_serious(site, browser):
    for path in html_pages(site):
        for width in (1280, 390):
            browser.page.set_viewport_size({"width": width, "height": 900})
            browser.open(path)
            browser.page.evaluate(Path(AXE).read_text(encoding="utf-8"))
            found = browser.page.evaluate("axe.run().then((result) => result.violations)")
            serious = [(each["id"], each["nodes"][0]["html"][:200]) for each in found if each["impact"] in _SERIOUS]
            assert serious == [], path.name


_SERIOUS = ("serious", "critical")


@pages
@pytest.mark.parametrize("explorer", PAGES, ids=lambda explorer: explorer.__name__)
def test_a_hundred_states_are_primers(site, browser, explorer):
    """Words and curves of random states of a page are those of the explorer's own answer and drawing."""
    browser.open(site / f"explore_{PAGES[explorer][0]}.html")
    places, picture = shelves(explorer), Picture(explorer.layout, explorer.draw)
    random = np.random.default_rng(18)
    for _ in range(100):
        at = [int(random.integers(len(one.places))) for one in places]
        said = {}
        for one, k in zip(places, at, strict=True):
            said |= one.places[k][1]
            changed = ["select", k] if browser.page.query_selector(f"#select-{one.name}") else ["slider", k]
            browser.page.evaluate(
                "([id, value, kind]) => { const box = document.getElementById(id); box.value = value;"
                "box.dispatchEvent(new Event(kind)); }",
                [f"{changed[0]}-{one.name}", changed[1], "change" if changed[0] == "select" else "input"],
            )
        asked, looks = explorer._parted(said)
        found = explorer.answer(**asked)
        assert browser.page.locator("#verdict").inner_text() == " ".join(found.verdict.split())
        with styled():
            drawn = [recorded(ax) for ax in picture.drawn(found, looks)]
        shown = browser.page.evaluate("primerShown()")
        for (_, elements, _), lines in zip(drawn, shown, strict=True):
            wanted = [part for part in elements if part["kind"] == "line"]
            assert len(wanted) == len(lines)
            for part, line in zip(wanted, lines, strict=True):
                for axis, got in zip("xy", line, strict=True):
                    numbers = [np.nan if value is None else value for value in got]
                    np.testing.assert_allclose(np.array(numbers, float), part[axis].astype(float), rtol=1e-6)
    assert not browser.errors


@pages
def test_a_line_ends_where_a_grid_was_lost(site, browser):
    """What is no number is left out, on logarithmic axes too: Dist of a lost grid does not fall to the bottom."""
    browser.open(site / "explore_pde.html")
    dist = PDEExplorer()._answer.marched.dist
    wanted = [int(np.isfinite(one).sum()) for one in dist]
    assert len(set(wanted)) == 3  # two of the three grids were lost
    paths = browser.page.evaluate(
        "[...document.querySelectorAll('svg')].map((svg) => "
        "[...svg.querySelectorAll('path[stroke-linejoin=round]')].map((path) => path.getAttribute('d')))"
    )
    assert wanted in [[len(re.findall("[ML]", path)) for path in panel[:3]] for panel in paths]


@pages
def test_closed_forms_are_primers_at_a_hundred_states(site, browser):
    (explorer,) = (one for one in PAGES if PAGES[one][0] == "pde")
    browser.open(site / "explore_pde.html")
    random, (equation, *_) = np.random.default_rng(81), shelves(explorer)
    named = ("pde", "at", "order", "uniform")
    forms = [(k, {name: place[name] for name in named}) for k, (_, place) in enumerate(equation.places)]
    forms = [(k, place) for k, place in forms if closed_form(**place)]
    assert len(forms) > 10
    for k, place in [forms[int(random.integers(len(forms)))] for _ in range(100)]:
        names = closed_form(**place)["names"]
        values = [float(random.uniform(0.01, 1) if name in ("eps", "nu") else random.normal()) for name in names]
        at = " ".join(f"{name}={value!r}" for name, value in zip(names, values, strict=True))
        got = np.array(browser.page.evaluate("([k, values]) => primerGrowth(k, values)", [k, values]), dtype=float)
        wanted = answer(**place | {"at": at}).rate
        np.testing.assert_allclose(got, wanted, rtol=1e-6, atol=1e-6, err_msg=f"{place} {at}")
    assert not browser.errors


@pages
def test_an_explorer_answers_to_keyboard_number_and_address(site, browser):
    page, path = browser.page, site / "explore_base_state.html"
    browser.open(path, "#a=0.5&n=30")
    assert "Ill posed" in page.locator("#verdict").inner_text()
    assert page.locator("#number-n").input_value() == "30"
    page.locator("#slider-a").focus()
    page.keyboard.press("ArrowRight")
    assert page.locator("#number-a").input_value() == "0.75"
    page.locator("#number-a").fill("0.72")
    page.keyboard.press("Enter")
    assert page.locator("#note").inner_text() == "base state a = 0.72 is not on this page: the nearest is 0.75."
    page.locator("#number-a").fill("")
    page.keyboard.press("Enter")
    assert "must be a number: it stays 0.75" in page.locator("#note").inner_text()
    for button in page.locator("button[data-at]").all():
        button.focus()
        page.keyboard.press("Enter")
        assert button.get_attribute("aria-pressed") == "true"
    page.wait_for_timeout(300)
    assert "a=" in page.evaluate("location.hash")
    browser.open(path, "#a=1.5&n=100&t=0")
    before = page.locator("#number-t").input_value()
    page.locator("#play-t").click()
    page.wait_for_timeout(1000)
    assert page.locator("#number-t").input_value() != before
    assert not browser.errors


@pages
def test_the_command_says_what_it_wrote(site, tmp_path, capsys):
    assert main(["site", str(tmp_path), "--explorers", str(site), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert all((tmp_path / name).exists() for name in told["files"])
