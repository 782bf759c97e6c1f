"""Guards the pages that need no installation: what they hold is what was drawn, no network, names for everything."""

import base64
import json
import re
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import primer
from primer.scenes.base_state import base_state
from primer.view.explorers import BaseStateExplorer, PDEExplorer, RheologyExplorer
from primer.view.page import explorer_page
from primer.view.page.atlas import Shelf, atlas, shelf
from primer.view.page.closed import closed_form
from primer.view.page.collection import PAGES, shelves
from primer.view.page.record import recorded
from primer.view.page.words import plain

VIEW = Path(primer.__file__).parent / "view" / "page"
A, GRIDS, TIMES = (0.5, 1.5), (16, 64), (0.0, 5.0, 20.0, 100.0)
LOOK = {control.name: control for control in (*BaseStateExplorer.controls, *BaseStateExplorer.looks)}


@pytest.fixture(scope="module")
def small():
    places = [shelf(LOOK["a"], A), shelf(LOOK["n"], GRIDS), shelf(LOOK["t"], TIMES, look=True)]
    return atlas(BaseStateExplorer, places)


@pytest.fixture(scope="module")
def html(small):
    return explorer_page(small, "A <title>", "lead", {"a": "1.5"}, {"<b>&": {"a": "0.5", "n": "64"}}).html


class Elements(HTMLParser):
    """(tag, attributes) of everything in a page."""

    def __init__(self, html):
        super().__init__()
        self.found = []
        self.feed(html)

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes)))


def embedded(html):
    (text,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', html)
    return json.loads(text)


def lines(data, place):
    """[(x, y)] of the lines of a state, panel by panel."""
    for panel in data["states"][place][1]:
        parts = (data["parts"][k] for k in data["panels"][panel][1])
        yield [
            tuple(np.frombuffer(base64.b64decode(data["arrays"][part[axis]]), "<f4") for axis in "xy")
            for part in parts
            if part["kind"] == "line"
        ]


@pytest.mark.parametrize("i", range(len(A)))
@pytest.mark.parametrize("j", range(len(GRIDS)))
def test_the_curves_are_those_of_base_state(html, i, j):
    data, answer = embedded(html), base_state(A[i], 0.01, GRIDS[j])
    place = (i * len(GRIDS) + j) * len(TIMES)
    run = answer.run
    assert data["verdicts"][data["states"][place][0]] == answer.verdict
    for k, t in enumerate(TIMES):
        growth, dist, fields = lines(data, place + k)
        for panel, x, y in (
            (growth, answer.xi, answer.rate),
            (growth, answer.grid_xi, answer.grid_rate),
            (dist, run.t, run.dist),
        ):
            assert any(
                a.shape == np.shape(x) and np.array_equal(a, np.float32(x)) and np.array_equal(b, np.float32(y))
                for a, b in panel
            )
        state = run.snapshots[t] if t < run.t_stop else run.final
        for field in state:
            assert any(np.array_equal(b, np.float32([*field, field[0]])) for _, b in fields)
    if answer.growth > 0:
        assert any(np.array_equal(y, np.float32([answer.growth] * 2)) for _, y in growth)  # of the whole grid


def test_nothing_is_asked_of_the_network(html):
    elements = Elements(html).found
    (policy,) = [each["content"] for _, each in elements if each.get("http-equiv") == "Content-Security-Policy"]
    assert policy.startswith("default-src 'none'; ")
    assert not [tag for tag, each in elements if {"src", "href", "srcset", "action"} & set(each)]
    assert not {"link", "iframe", "object", "base", "form"} & {tag for tag, _ in elements}
    for name in ("page.html", "page.css", "page.js"):
        text = (VIEW / name).read_text(encoding="utf-8").replace("http://www.w3.org/2000/svg", "")
        assert not re.search(r"https?:|url\([^#]|@import|fetch\(|XMLHttpRequest|import\(|WebSocket|eval\(", text), name


def test_the_page_has_names_for_everything(html):
    elements = Elements(html).found
    ids = [each["id"] for _, each in elements if "id" in each]
    assert len(ids) == len(set(ids))
    labelled = {each["for"] for tag, each in elements if tag == "label"}
    for tag, each in elements:
        if tag in ("input", "select"):
            assert each["id"] in labelled or each["aria-label"]
    assert {each["id"] for _, each in elements if each.get("role") == "status"} == {"note", "verdict"}
    assert {tag for tag, _ in elements} >= {"h1", "h2", "main", "footer", "noscript"}
    assert "lang" in dict(elements)["html"]
    assert "<title>A &lt;title&gt;</title>" in html
    assert "&lt;b&gt;&amp;</button>" in html


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("file", [VIEW / "page.css", VIEW.parent / "site" / "site.css"])
def test_colours_can_be_told_from_what_is_behind_them(scheme, file):
    """The contrast of WCAG 2: 4.5 for words, 3 for frames."""
    css = file.read_text(encoding="utf-8").split("@media (prefers-color-scheme: dark)")
    colours = dict(re.findall(r"(--\w+): #(\w{6})", css[scheme == "dark"].partition("}")[0]))

    def light(name):
        part = np.array([int(colours[name][k : k + 2], 16) for k in (0, 2, 4)]) / 255
        return np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4) @ [0.2126, 0.7152, 0.0722]

    def contrast(one, other):
        low, high = sorted((light(one), light(other)))
        return (high + 0.05) / (low + 0.05)

    for words in {"--ink", "--steady", "--quiet", "--link", "--keyword", "--string", "--comment"} & colours.keys():
        assert min(contrast(words, behind) for behind in {"--paper", "--well"} & colours.keys()) >= 4.5, words
    assert contrast("--frame", "--paper") >= 3


def test_an_atlas_says_what_is_not_there(small):
    with pytest.raises(ValueError, match=r"a must be one of 0.5, 1.5, got '0.7'"):
        explorer_page(small, "", "", {"a": "0.7"})
    with pytest.raises(ValueError, match="a state must be of a, n, t, got 'b'"):
        explorer_page(small, "", "", {"b": "0.7"})
    with pytest.raises(TypeError, match="atlas must be"):
        explorer_page([], "", "")


def test_mathtext_in_plain_words():
    assert plain(r"wavenumber $\xi$") == "wavenumber ξ"
    assert plain(r"$\mathdefault{10^{-3}}$") == "10⁻³"
    assert plain(r"$\propto |\xi|^{2/3}$") == "∝ |ξ|²ᐟ³"
    assert plain(r"growth rate $\max\,\mathrm{Re}\,\lambda$") == "growth rate max Re λ"
    assert plain(r"$a - \cos x$") == "a \N{MINUS SIGN} cos x"
    assert plain("no mathematics") == "no mathematics"


def test_a_polar_picture_and_a_map_are_recorded():
    shown = RheologyExplorer.from_state("law=Coulomb")
    polar, growth, states = (recorded(ax) for ax in shown._picture.axes)
    assert polar[0]["kind"] == "disc"
    assert any(part["kind"] == "area" for part in polar[1])  # the petals
    assert all(np.hypot(part["x"], part["y"]).max() < 1.5 for part in polar[1] if part["kind"] == "area")
    assert growth[0]["y"]["scale"] == "asinh"
    assert any(part["kind"] == "cells" for part in states[1])
    assert {part["text"] for part in states[1] if part["kind"] == "text"} >= {"ill posed,\n|ξ|²"}


def test_a_closed_form_has_the_growth_of_the_symbol():
    """The toy's polynomial (82): lam^2 + (1 + eps u xi^2) lam + xi^2 - i eps v_xx xi."""
    form = closed_form("u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)", "u=-0.5 v_xx=0.3 eps=0.01", "full")
    assert form["names"] == ["eps", "u", "v_xx"]
    assert form["values"] == [0.01, -0.5, 0.3]
    terms = {tuple(row[2:]): complex(*row[:2]) for row in form["terms"]}
    assert terms == {
        (2, 0, 0, 0, 0): 1, (1, 0, 0, 0, 0): 1, (1, 2, 1, 1, 0): 1, (0, 2, 0, 0, 0): 1, (0, 1, 1, 0, 1): -1j,
    }  # fmt: skip


@pytest.mark.parametrize("explorer", PAGES)
def test_a_page_holds_the_explorers_own_controls(explorer):
    names = {control.name for control in (*explorer.controls, *explorer.looks)}
    found = shelves(explorer)
    assert all(isinstance(one, Shelf) for one in found)
    said = {name for one in found for _, place in one.places for name in place}
    assert said <= names
    if explorer is PDEExplorer:
        assert [text for text, _ in found[0].places] == list(explorer.presets)
    for one in found:
        texts = [text for text, _ in one.places]
        assert len(set(texts)) == len(texts)
