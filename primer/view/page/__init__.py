"""A page that needs no installation: one HTML file, without network, in which a reader moves an explorer's numbers.

Every number on it was computed here and is looked up there: the page's script knows no equation. What it draws are the
lines and areas that the explorer's own drawing put on axes.
"""

import json
from dataclasses import dataclass
from html import escape
from pathlib import Path
from string import Template

from primer import __version__
from primer.checks import instance
from primer.view.page.atlas import Atlas

_HERE = Path(__file__).parent
_CLOSED = (
    " At a base state of your own the growth is computed here, from the coefficients of the characteristic polynomial, "
    "to a millionth."
)
_SEEDED = (
    " Most blow-ups are seeded by round-off, by the last bit of the computer that made the page: another one finds "
    "slightly other times."
)
_OWN = """<section aria-label="A base state of your own" id="own">
<h2>A base state of your own</h2>
<p>The growth of the same equations, from their characteristic polynomial, at the numbers that you type.</p>
<div class="controls" id="own-numbers"></div>
<div class="plots"><figure aria-labelledby="own-title"><h2 id="own-title">growth of the frozen equations</h2>
<div class="plot" id="own-plot"></div></figure></div>
<p id="own-said" role="status"></p>
</section>"""


@dataclass(frozen=True)
class Page:
    """A page as HTML."""

    html: str


def save_page(page, path):
    """Write ``page`` to ``path``."""
    Path(path).write_text(page.html, encoding="utf-8", newline="\n")


def explorer_page(atlas, title, lead, begin=None, presets=None, closed=()):
    """The page of an :class:`primer.view.page.atlas.Atlas`, which begins with the state ``begin``.

    ``closed`` are the closed forms (``primer.view.page.closed``) of the places of the first shelf, if there are any.
    ``lead`` is HTML; ``presets`` maps names to states, each a dict name -> text of a place; what is left out stays as
    it is.

    Raises
    ------
    TypeError     if atlas is none
    ValueError    if begin or a preset is not a state of the atlas
    """
    instance("atlas", atlas, Atlas)
    start = [place or 0 for place in _places(atlas, begin or {})]
    verdicts = list(dict.fromkeys(verdict for verdict, _ in atlas.states))
    number = {verdict: k for k, verdict in enumerate(verdicts)}
    data = {
        "shelves": [
            {"name": s.name, "label": s.label, "places": [text for text, _ in s.places]} for s in atlas.shelves
        ],
        "begin": start,
        "states": [[number[verdict], panels] for verdict, panels in atlas.states],
        "verdicts": verdicts,
        "panels": list(map(json.loads, atlas.panels)),
        "parts": list(map(json.loads, atlas.parts)),
        "arrays": atlas.arrays,
        "closed": closed,
    }
    return Page(
        Template((_HERE / "page.html").read_text(encoding="utf-8")).substitute(
            title=escape(title),
            lead=lead,
            style=(_HERE / "page.css").read_text(encoding="utf-8"),
            script=(_HERE / "page.js").read_text(encoding="utf-8"),
            controls="\n".join(map(_control, atlas.shelves)),
            presets="\n".join(_button(atlas, name, state) for name, state in (presets or {}).items()),
            plots="\n".join(map(_plot, range(len(atlas.states[0][1])))),
            count=f"{len(atlas.states):,}",
            closed=_CLOSED if closed else "",
            seeded=_SEEDED if any(one.name == "t" for one in atlas.shelves) else "",
            own=_OWN if closed else "",
            version=__version__,
            data=_embedded(data),
        )
    )


def _places(atlas, state):
    """For each shelf the place that a state says, or None."""
    found = []
    known = {shelf.name for shelf in atlas.shelves}
    for name in state:
        if name not in known:
            raise ValueError(f"a state must be of {', '.join(sorted(known))}, got {name!r}")
    for shelf in atlas.shelves:
        texts = [text for text, _ in shelf.places]
        if shelf.name in state and state[shelf.name] not in texts:
            raise ValueError(f"{shelf.name} must be one of {', '.join(texts)}, got {state[shelf.name]!r}")
        found.append(texts.index(state[shelf.name]) if shelf.name in state else None)
    return found


def _control(shelf):
    name, label, texts = escape(shelf.name), escape(shelf.label), [escape(text) for text, _ in shelf.places]
    if not _is_number(texts[0]):
        options = "".join(f'<option value="{k}">{text}</option>' for k, text in enumerate(texts))
        return (
            f'<div class="control"><label for="select-{name}">{label}</label>'
            f'<select id="select-{name}">{options}</select></div>'
        )
    play = f'<button type="button" id="play-{name}" aria-label="play {label}">play</button>' if shelf.look else ""
    places = f"{texts[0]} to {texts[-1]}, {len(texts)} values"
    return (
        f'<div class="control"><label for="slider-{name}">{label} ({places})</label>'
        f'<input type="range" id="slider-{name}" min="0" max="{len(texts) - 1}" step="1">'
        f'<div class="row"><input type="text" inputmode="decimal" id="number-{name}" aria-label="{label}, as a number">'
        f"{play}</div></div>"
    )


def _is_number(text):
    try:
        float(text)
    except ValueError:
        return False
    return True


def _button(atlas, name, state):
    places = escape(json.dumps(_places(atlas, state)))
    return f'<button type="button" data-at="{places}" aria-pressed="false">{escape(name)}</button>'


def _plot(k):
    return (
        f'<figure aria-labelledby="title-{k}"><h2 id="title-{k}"></h2><div class="plot" id="plot-{k}"></div>'
        f'<ul class="key" id="key-{k}" aria-label="Key"></ul></figure>'
    )


def _embedded(data):
    """JSON that may stand inside a script element."""
    return json.dumps(data, allow_nan=False, separators=(",", ":"), ensure_ascii=False).replace("<", "\\u003c")
