"""All states of an explorer that a page holds: each answered, drawn and recorded here, and looked up there."""

import base64
import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np

from primer.view.page.record import recorded
from primer.view.picture import Picture
from primer.view.style import styled


@dataclass(frozen=True)
class Shelf:
    """One control of a page: its name and label, and the places it has, each a text and what it says of the controls.

    A ``look`` changes how an answer is looked at, such as the time, and is answered at no new cost.
    """

    name: str
    label: str
    places: tuple[tuple[str, dict], ...]
    look: bool = False


@dataclass(frozen=True, eq=False)
class Atlas:
    """An explorer, the shelves of its states, and what the page shows of each: see ``atlas``.

    states      tuple over all combinations of the places, the last shelf fastest: (verdict, numbers of the panels)
    panels      each (frame, elements, key): numbers of ``parts``
    parts       each once: plain data ready for JSON, whose arrays are numbers of ``arrays``
    arrays      each once: base64 of little-endian float32, that is numbers rounded to 24 bits
    """

    explorer: type
    shelves: tuple
    states: tuple
    panels: tuple
    parts: tuple
    arrays: tuple


def shelf(control, values, look=False):
    """The ``Shelf`` of an explorer's own control at some values."""
    places = tuple((control.text(value), {control.name: value}) for value in values)
    return Shelf(control.name, control.label, places, look)


def atlas(explorer, shelves, progress: Callable = iter):
    """The :class:`Atlas` of all combinations of places; looks come last. ``progress`` wraps the loop over answers."""
    asked = [one for one in shelves if not one.look]
    looks = [one for one in shelves if one.look]
    arrays, parts, panels, states = _Once(), _Once(), _Once(), []
    picture = Picture(explorer.layout, explorer.draw)
    for combination in progress(list(product(*(one.places for one in asked)))):
        answer = explorer.answer(**_joined(combination))
        end, past, shown = explorer.until(answer), -math.inf, ()
        for look in product(*(one.places for one in looks)):
            values = _joined(look)
            t = values.get("t", 0.0)
            if not (shown and end < past <= t):  # after the end of the run nothing changes
                with styled():
                    drawn = [recorded(ax) for ax in picture.drawn(answer, values)]
                shown = tuple(panels.place(_written(each, parts, arrays)) for each in drawn)
            past = t
            states.append((answer.verdict, shown))
    return Atlas(explorer, (*asked, *looks), tuple(states), tuple(panels.kept), tuple(parts.kept), tuple(arrays.kept))


def _joined(places):
    return {name: value for _, said in places for name, value in said.items()}


def _written(panel, parts, arrays):
    frame, elements, key = panel
    numbers = [parts.place(json.dumps(_packed(each, arrays))) for each in elements]
    return json.dumps([parts.place(json.dumps(frame)), numbers, parts.place(json.dumps(key))])


def _packed(element, arrays):
    return {
        name: arrays.place(base64.b64encode(value.tobytes()).decode()) if isinstance(value, np.ndarray) else value
        for name, value in element.items()
    }


class _Once:
    """Texts, each kept once, by the order they came."""

    def __init__(self):
        self.kept = {}

    def place(self, text):
        return self.kept.setdefault(text, len(self.kept))
