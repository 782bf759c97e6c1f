"""The explorer: controls, a verdict in words and a picture, kept in step."""

import math
import re
from collections.abc import Callable
from html import escape
from threading import RLock
from types import MethodType
from typing import Any, ClassVar, Self

import ipywidgets as widgets

from primer.checks import shown
from primer.view.explorers.snapshot import Snapshot
from primer.view.explorers.state import defaults, read_state, write_state
from primer.view.picture import Picture
from primer.view.still import picture_html, render

_DRAWING = RLock()  # a notebook may call back from a thread of its own, and matplotlib draws one thing at a time


class _AlsoOfTheClass:
    """A method whose ``self`` is the explorer, or the class when it is asked of the class."""

    def __init__(self, function):
        self.__wrapped__, self.__doc__ = function, function.__doc__

    def __get__(self, explorer, owner):
        return MethodType(self.__wrapped__, owner if explorer is None else explorer)


class Explorer:
    """What all explorers share; a subclass states its scene, its drawing and its controls.

    Attributes of a subclass
    ------------------------
    answer      function of the values of ``controls``: a frozen result with a ``verdict`` in words
    draw        ``draw(axes, answer, **looks)`` on the axes of the figure
    layout      the arguments of ``primer.view.style.new_figure``
    controls    tuple of ``Number``, ``Choice`` and ``Line``: what the answer depends on
    looks       tuple of the same: how the answer is looked at, such as the time; they cost no new answer
    presets     name -> state: settings worth seeing
    until       ``until(answer)`` is when playing may end, infinite if at the end of the slider
    """

    answer: ClassVar[Callable]
    draw: ClassVar[Callable]
    layout: ClassVar[dict]
    controls: ClassVar[tuple]
    looks: ClassVar[tuple] = ()
    presets: ClassVar[dict]
    _completed: ClassVar[Callable] = staticmethod(lambda values: values)  # what else they move

    @staticmethod
    def until(answer: Any) -> float:
        return math.inf

    def __init__(self, **values: Any) -> None:
        self.verdict = ""
        self._picture = Picture(self.layout, self.draw)
        self._asked: dict[str, Any] | None = None
        self._answer: Any = None
        self._png = b""
        self._rows = {control.name: control.build(self._update) for control in self._all()}
        self._said, self._image, self._copy = _outputs()
        self._copy.observe(self._restore, "value")
        self.widget = self._arranged()
        self.set(**self._completed(values))

    @classmethod
    def from_state(cls, text: str) -> Self:
        """The explorer in a state such as ``"a=0.6,n=64"``; what is left out keeps its default.

        Raises
        ------
        ValueError    if the text is not NAME=VALUE, parted by commas, of this explorer's names
        """
        return cls(**read_state(cls._all(), text))

    @_AlsoOfTheClass
    def snapshot(self, state: str = "", **values: Any) -> Snapshot:
        """A still picture of a state, with its verdict: for pages that are printed, or read where nothing runs.

        Asked of an explorer, what is left out is as it is there; asked of the class, it has its default.

        Raises
        ------
        TypeError, ValueError    for a state or a value of which the explorer would say so
        """
        cls, start = (self, defaults(self._all())) if isinstance(self, type) else (type(self), self.values)
        values = start | cls._completed(read_state(cls._all(), state) | cls._known(values))
        asked, looks = cls._parted(values)
        answer = cls.answer(**asked)
        png = render(cls.layout, lambda axes: cls.draw(axes, answer, **looks))
        return Snapshot(answer.verdict, png, write_state(cls._all(), values))

    @property
    def values(self) -> dict[str, Any]:
        """Name -> what each control says."""
        return {name: row.get() for name, row in self._rows.items()}

    @property
    def state(self) -> str:
        """The state as a text to copy, which ``from_state`` gives back."""
        return write_state(self._all(), self.values)

    @property
    def png(self) -> bytes:
        """The picture, as bytes."""
        return self._png

    def set(self, **values: Any) -> None:
        """Move some controls at once; the answer is found once.

        Raises
        ------
        TypeError    if a name is not that of a control
        """
        for name, value in self._known(values).items():
            self._rows[name].show(value)
        self._update()

    def reset(self) -> None:
        """Back to where it began."""
        self.set(**defaults(self._all()))

    def preset(self, name: str) -> None:
        """One of the settings worth seeing.

        Raises
        ------
        ValueError    if there is none of this name
        """
        if name not in self.presets:
            raise ValueError(f"name must be one of {', '.join(map(repr, self.presets))}, got {shown(name)}")
        self._go_to(self.presets[name])

    def _update(self):
        """Answer, draw and say; whatever goes wrong is said too, since nobody sees an exception in a callback."""
        asked, looks = self._parted(self.values)
        _DRAWING.acquire()
        try:
            if asked != self._asked:
                self._asked = None
                self._answer = type(self).answer(**asked)
                self._asked = asked
                for row in self._rows.values():
                    row.until(type(self).until(self._answer))
            for control in self.looks:
                control.check(looks[control.name])
            self._png = self._picture.png(self._answer, looks)
            self._say(self._answer.verdict)
            self._image.value = picture_html(self._png, self.verdict)  # last: who sees it can read what it says
        except Exception as error:
            self._say(self._labelled(str(error) or type(error).__name__), wrong=True)
        finally:
            _DRAWING.release()

    def _say(self, text, wrong=False):
        self.verdict = text
        role, mark = ("alert", "<b>Not answered.</b> ") if wrong else ("status", "")
        self._said.value = (
            f'<div role="{role}" aria-live="polite" class="primer-said primer-{role}">'
            f'{mark}<span class="primer-verdict">{escape(text)}</span></div>'
        )
        if wrong:  # the picture is of another state
            self._image.add_class("primer-stale")
        else:
            self._image.remove_class("primer-stale")
        with self._copy.hold_trait_notifications():
            self._copy.value = self.state

    def _labelled(self, text):
        """A sentence about a name, said of the label that the reader sees, with the name as a state has it."""
        subject, *rest = re.split(r"(?= must | cannot )", text, maxsplit=1)
        for control in self._all() if rest else ():
            subject = re.sub(rf"(?<!\w){control.name}(?!\w)", f"{control.label} ({control.name})", subject)
        return subject + "".join(rest)

    def _go_to(self, state):
        """To this state, and to the default of what it leaves out."""
        self.set(**defaults(self._all()) | self._completed(read_state(self._all(), state)))

    def _restore(self, change):
        """A state was typed or pasted."""
        if change["new"] != self.state:
            try:
                self._go_to(change["new"])
            except ValueError as error:
                self._say(self._labelled(str(error)), wrong=True)

    def _arranged(self):
        buttons = []
        for name in self.presets:
            button = widgets.Button(description=name, layout=widgets.Layout(width="auto"))
            button.on_click(lambda _, name=name: self.preset(name))
            buttons.append(button)
        reset = widgets.Button(description="reset", icon="undo", layout=widgets.Layout(width="auto"))
        reset.on_click(lambda _: self.reset())
        choices = widgets.HBox([*buttons, reset], layout=widgets.Layout(flex_flow="row wrap"))
        rows = [row.widget for row in self._rows.values()]
        # The verdict below the picture: as it wraps the picture stays where it is.
        box = widgets.VBox([widgets.HTML(_STYLE), choices, *rows, self._image, self._said, self._copy])
        return box.add_class("primer-explorer")

    def _repr_mimebundle_(self, **options):
        data = self.widget._repr_mimebundle_(**options)
        data = data[0] if isinstance(data, tuple) else data
        text = f"{type(self).__name__}.from_state({self.state!r})\n{self.verdict}"
        return {**data, "text/html": picture_html(self.png, self.verdict), "text/plain": text}

    @classmethod
    def _all(cls):
        return (*cls.controls, *cls.looks)

    @classmethod
    def _known(cls, values):
        names = [control.name for control in cls._all()]
        for name in values:
            if name not in names:
                raise TypeError(f"the controls of {cls.__name__} are {', '.join(names)}, got {shown(name)}")
        return values

    @classmethod
    def _parted(cls, values):
        """(what the answer depends on, how it is looked at)."""
        looks = [control.name for control in cls.looks]
        return tuple({n: v for n, v in values.items() if (n in looks) is look} for look in (False, True))


_STYLE = """<style>
.primer-explorer { max-width: 1100px; } .primer-shown { overflow-x: auto; }
.primer-shown .primer-picture { min-width: 640px; }
.primer-stale { opacity: 0.25; }
.primer-said { padding: 4px 10px; border-left: 4px solid #7d858c; line-height: 1.5; min-height: 3em; }
.primer-alert { border: 2px solid #c0392b; border-left-width: 8px; min-height: 0; }
</style>"""


def _outputs():
    """(verdict, picture, state) as widgets."""
    said = widgets.HTML(layout=widgets.Layout(margin="4px 0", height="auto"))
    # A widgets.Image has no alternative text. Never stretched, which is soft; in a narrow window it scrolls sideways.
    image = widgets.HTML(layout=widgets.Layout(max_width="100%", margin="2px 0")).add_class("primer-shown")
    tip, wide = "Copy this to come back here; paste one and press Enter to go there", widgets.Layout(width="auto")
    copy = widgets.Text(description="state", tooltip=tip, continuous_update=False, layout=wide)
    return said, image, copy
