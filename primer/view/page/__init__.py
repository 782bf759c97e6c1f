"""A page that needs no installation: one HTML file, without network, in which a reader moves a and N.

Every number on it was computed here and is looked up there: the page's script knows no equation. Bokeh draws.
"""

import base64
import json
from dataclasses import dataclass
from html import escape
from importlib.util import find_spec
from pathlib import Path
from string import Template

import numpy as np

from primer import __version__
from primer.checks import instance
from primer.view.page.plots import LINES, plots
from primer.view.page.states import Atlas

_HERE = Path(__file__).parent
_DASHES = {"solid": "none", "dashed": "6 4", "dotted": "2 3"}


@dataclass(frozen=True)
class Page:
    """A page as HTML."""

    html: str


def possible():
    """Whether pages can be made here: Bokeh is what the extra ``page`` brings."""
    return find_spec("bokeh") is not None


def save_page(page, path):
    """Write ``page`` to ``path``."""
    Path(path).write_text(page.html, encoding="utf-8")


def explorer_page(states, begin, presets):
    """The page of an :class:`primer.view.page.states.Atlas`.

    It begins with the state ``begin``, a pair (a, n); ``presets`` maps names to such pairs.

    Raises
    ------
    ModuleNotFoundError    without Bokeh
    ValueError             if begin or a preset is not a state of the atlas
    """
    instance("states", states, Atlas)
    for pair in (begin, *presets.values()):
        states.at(*pair)
    from bokeh.embed import json_item
    from bokeh.resources import Resources

    drawn = plots()
    library = Resources(mode="inline", components=["bokeh"], minified=True, log_level="error").js_raw
    data = pack(states) | {
        "begin": _places(states, *begin),
        "plots": [json_item(plot.figure, f"{name}-plot") for name, plot in drawn.items()],
        "paint": [row for plot in drawn.values() for row in plot.paint],
    }
    template = Template((_HERE / "page.html").read_text(encoding="utf-8"))
    return Page(
        template.substitute(
            style=(_HERE / "page.css").read_text(encoding="utf-8"),
            script=(_HERE / "page.js").read_text(encoding="utf-8"),
            library="\n".join(library),
            data=_embedded(data),
            presets="\n".join(_button(states, name, pair) for name, pair in presets.items()),
            **{f"{name}_key": "\n".join(_key(*each) for each in lines.items()) for name, lines in LINES.items()},
            a_last=len(states.a) - 1,
            n_last=len(states.n) - 1,
            a_range=_range(states.a),
            n_range=_range(states.n),
            eps=f"{states.eps:g}",
            version=__version__,
        )
    )


def pack(states):
    """What the page looks up: a dict ready for JSON.

    ``states[i][j]`` names for each curve the places of its coordinates in ``arrays``, which holds each array once, as
    base64 of little-endian float32: the numbers are rounded to 24 bits, and texts are made of the full ones.
    """
    arrays: dict[str, int] = {}

    def place(array):
        text = base64.b64encode(np.asarray(array, dtype="<f4").tobytes()).decode()
        return arrays.setdefault(text, len(arrays))

    packed = [
        [
            {
                "kind": state.kind,
                "verdict": state.verdict,
                "numbers": state.numbers,
                "labels": state.labels,
                "alts": state.alts,
                "curves": {
                    name: {axis: place(values) for axis, values in curve.items()}
                    for name, curve in state.curves.items()
                },
            }
            for state in row
        ]
        for row in states.states
    ]
    return {"a": list(states.a), "n": list(states.n), "states": packed, "arrays": list(arrays)}


def _embedded(data):
    """JSON that may stand inside a script element."""
    return json.dumps(data, allow_nan=False, separators=(",", ":"), ensure_ascii=False).replace("<", "\\u003c")


def _places(states, a, n):
    return [states.a.index(a), states.n.index(n)]


def _range(values):
    return f"{values[0]:g} to {values[-1]:g}, {len(values)} values".replace("-", "\N{MINUS SIGN}")


def _button(states, name, pair):
    i, j = _places(states, *pair)
    return f'<button type="button" data-a="{i}" data-n="{j}" aria-pressed="false">{escape(name)}</button>'


def _key(name, line):
    """A line of a plot's key: a sample of the stroke, and its label, which the script keeps up to date."""
    stroke = f'stroke="var({line.colour})" stroke-width="{line.width}" stroke-dasharray="{_DASHES[line.dash]}"'
    sample = {
        "line": f'<path d="M0 7H28" {stroke}/>',
        "upright": f'<path d="M14 0V14" {stroke}/>',
        "dot": f'<circle cx="14" cy="7" r="4.5" fill="var({line.colour})"/>',
        "strip": f'<rect width="28" height="14" fill="var({line.colour})" stroke="var(--steady)"/>',
    }[line.shape]
    return (
        f'<li id="key-{name}"><svg width="28" height="14" aria-hidden="true">{sample}</svg>'
        f"<span>{escape(line.label)}</span></li>"
    )
