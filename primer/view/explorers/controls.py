"""What a reader can change: numbers with a slider and a box, choices, lines of text."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import ipywidgets as widgets

from primer.checks import real, shown

LABEL, _BOX = "11em", "8.5em"  # the box holds 0.000501187
_ROW = widgets.Layout(flex_flow="row wrap")  # where a page is narrow, what does not fit goes below


@dataclass(frozen=True)
class Row:
    """A control on the page: its widget, what it says, and how to make it say something else without a stir.

    ``until(value)`` ends its play button's way there.
    """

    widget: widgets.Widget
    get: Callable
    show: Callable
    until: Callable = lambda value: None


@dataclass(frozen=True)
class Number:
    """A number with a slider from ``low`` to ``high``, and a box that takes any number.

    On a logarithmic slider ``step`` is in decades. With ``play``, a number of milliseconds, a button walks along it.
    """

    name: str
    label: str
    default: float
    low: float
    high: float
    step: float
    log: bool = False
    play: int = 0

    def parse(self, text):
        """The number that a text says.

        Raises
        ------
        ValueError    if it says none
        """
        kind = int if self.whole else float
        try:
            return kind(text)
        except ValueError:
            sort = "a whole number" if self.whole else "a number"
            raise ValueError(f"{self.name} must be {sort}, got {shown(text)}") from None

    @property
    def whole(self):
        """Whether it counts something."""
        return isinstance(self.default, int)

    def text(self, value):
        """The shortest text that gives the number back."""
        return f"{value:.12g}"

    def check(self, value):
        """Refuse what is off the slider; only looks are held to it, since what is asked of a scene the scene checks.

        Raises
        ------
        ValueError    if it is
        """
        real(self.name, value, least=self.low, most=self.high)

    def build(self, changed):
        """The ``Row`` of slider and box; ``changed()`` is called once for each change that a reader makes."""
        tip = f"{self.label}: drag, or use the arrow keys"
        common = {"description": self.label, "tooltip": tip, "readout": False, "continuous_update": True}
        wide = {"layout": widgets.Layout(flex="1 1 20em", min_width="17em"), "style": {"description_width": LABEL}}
        if self.log:
            ends = {"min": math.log10(self.low), "max": math.log10(self.high), "step": self.step}
            slider = widgets.FloatLogSlider(self._place(self.default), **ends, **common, **wide)
        else:
            sort = widgets.IntSlider if self.whole else widgets.FloatSlider
            slider = sort(self._place(self.default), min=self.low, max=self.high, step=self.step, **common, **wide)
        # Never an IntText: a browser makes 655 of what is typed there as 65.5.
        box = widgets.FloatText(
            self.default, step=None, continuous_update=False, layout=widgets.Layout(width=_BOX), tooltip=self.label
        )
        busy = []

        last = round((self.high - self.low) / self.step)
        play = None
        if self.play:
            play = widgets.Play(max=last, interval=self.play, show_repeat=False, tooltip=f"play {self.label}")

        def until(value):
            if play:
                play.max = min(math.ceil((value - self.low) / self.step - 1e-9), last) or last

        def show(value):
            busy.append(True)
            try:
                box.value = value
                if math.isfinite(value):
                    slider.value = self._place(value)
                    if play:  # goes on from here, and from the end all over again
                        play.value = self._notch(value) if self._notch(value) < play.max else 0
            finally:
                busy.pop()

        def moved(change):
            if not busy and self._notch(change["new"]) != self._notch(box.value):
                show(change["new"] if self.whole else self._rounded(change["new"]))
                changed()

        def typed(change):
            if not busy:
                show(change["new"])
                changed()

        slider.observe(moved, "value")
        box.observe(typed, "value")
        if play:
            play.observe(lambda change: moved({"new": self.low + self.step * change["new"]}), "value")
        parts = [slider, box, play] if play else [slider, box]
        return Row(widgets.HBox(parts, layout=_ROW), lambda: self._said(box.value), show, until)

    def _said(self, value):
        """A whole number where one is meant and typed; anything else as it is, to be refused."""
        return int(value) if self.whole and float(value).is_integer() else value

    def _place(self, value):
        """The nearest place on the slider: a browser moves it there from any other."""
        scale, back = (math.log10, lambda exponent: 10.0**exponent) if self.log else (float, type(self.default))
        return min(max(back(scale(self.low) + self._notch(value) * self.step), self.low), self.high)

    def _notch(self, value):
        """The number of that place. A browser that says the same place in other last digits has moved nothing."""
        scale = math.log10 if self.log else float
        inside = min(max(self.low, value), self.high)  # in this order NaN is at the low end
        return round((scale(inside) - scale(self.low)) / self.step)

    def _rounded(self, value):
        """What a slider says, without the last digits of its arithmetic."""
        return float(f"{value:.6g}")


@dataclass(frozen=True)
class Choice:
    """One of a few texts."""

    name: str
    label: str
    default: str
    options: tuple[str, ...]

    def parse(self, text):
        """The option that a text says.

        Raises
        ------
        ValueError    if it is none of them
        """
        if text not in self.options:
            raise ValueError(f"{self.name} must be one of {', '.join(self.options)}, got {shown(text)}")
        return text

    text = staticmethod(str)

    def check(self, value):
        """As of ``Number``."""
        self.parse(value)

    def build(self, changed):
        """The ``Row`` of this control, as for ``Number``."""
        menu = widgets.Dropdown(
            options=self.options, value=self.default, description=self.label, style={"description_width": LABEL}
        )
        return watched(menu, changed)


@dataclass(frozen=True)
class Line:
    """Lines of text, such as PDEs; with ``rows`` above 1 in a box that is left, by Tab or a click, to be answered."""

    name: str
    label: str
    default: str
    rows: int = 1

    parse = staticmethod(str)

    def text(self, value):
        """In one line: where the box has a new line, a text has a semicolon."""
        return "; ".join(filter(None, (line.strip().rstrip(";") for line in value.splitlines())))

    def check(self, value):
        """As of ``Number``; there is nothing to refuse."""

    def build(self, changed):
        """The ``Row`` of this control, as for ``Number``."""
        sort = widgets.Textarea if self.rows > 1 else widgets.Text
        box = sort(
            self.default,
            description=self.label,
            continuous_update=False,
            layout=widgets.Layout(flex="1 1 20em", min_width="17em", width="auto"),
            style={"description_width": LABEL},
        )
        if self.rows == 1:
            return watched(box, changed)
        box.rows = self.rows
        answer = widgets.Button(
            description="answer", tooltip="or leave the box with Tab", layout=widgets.Layout(width="auto")
        )
        return watched(box, changed, answer)


def watched(widget, changed, *beside):
    busy = []

    def show(value):
        busy.append(True)
        try:
            widget.value = value
        finally:
            busy.pop()

    widget.observe(lambda change: busy or changed(), "value")
    return Row(widgets.HBox([widget, *beside], layout=_ROW), lambda: widget.value, show)
