"""What a reader can change: numbers with a slider and a box, choices, lines of text; and the texts of a whole state."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import ipywidgets as widgets

from primer.checks import shown

_LABEL, _BOX = "11em", "7em"


@dataclass(frozen=True)
class Row:
    """A control on the page: its widget, what it says, and how to make it say something else without a stir."""

    widget: widgets.Widget
    get: Callable
    show: Callable


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
        return str(value) if self.whole else f"{value:.12g}"

    def build(self, changed):
        """The ``Row`` of slider and box; ``changed()`` is called once for each change that a reader makes."""
        tip = f"{self.label}: drag, or use the arrow keys"
        common = {"description": self.label, "tooltip": tip, "readout": False, "continuous_update": True}
        wide = {"layout": widgets.Layout(flex="1 1 12em", min_width="12em"), "style": {"description_width": _LABEL}}
        if self.log:
            ends = {"min": math.log10(self.low), "max": math.log10(self.high), "step": self.step}
            slider = widgets.FloatLogSlider(self._place(self.default), **ends, **common, **wide)
        else:
            sort = widgets.IntSlider if self.whole else widgets.FloatSlider
            slider = sort(self._place(self.default), min=self.low, max=self.high, step=self.step, **common, **wide)
        sort = widgets.IntText if self.whole else widgets.FloatText
        box = sort(self.default, continuous_update=False, layout=widgets.Layout(width=_BOX), tooltip=self.label)
        busy = []

        def show(value):
            busy.append(True)
            try:
                box.value = value
                if math.isfinite(value):
                    slider.value = self._place(value)
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
        parts = [slider, box]
        if self.play:
            last = round((self.high - self.low) / self.step)
            play = widgets.Play(max=last, interval=self.play, show_repeat=False, tooltip=f"play {self.label}")
            play.observe(lambda change: moved({"new": self.low + self.step * change["new"]}), "value")
            parts.append(play)
        return Row(widgets.HBox(parts), lambda: box.value, show)

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

    def build(self, changed):
        """The ``Row`` of this control, as for ``Number``."""
        menu = widgets.Dropdown(
            options=self.options, value=self.default, description=self.label, style={"description_width": _LABEL}
        )
        return _watched(menu, changed)


@dataclass(frozen=True)
class Line:
    """A line of text, such as a PDE."""

    name: str
    label: str
    default: str

    parse = text = staticmethod(str)

    def build(self, changed):
        """The ``Row`` of this control, as for ``Number``."""
        box = widgets.Text(
            self.default,
            description=self.label,
            continuous_update=False,
            layout=widgets.Layout(width="auto", flex="1 1 auto"),
            style={"description_width": _LABEL},
        )
        return _watched(box, changed)


def _watched(widget, changed):
    busy = []

    def show(value):
        busy.append(True)
        try:
            widget.value = value
        finally:
            busy.pop()

    widget.observe(lambda change: busy or changed(), "value")
    return Row(widgets.HBox([widget]), lambda: widget.value, show)


def defaults(controls):
    """Name -> value where nothing has been moved."""
    return {control.name: control.default for control in controls}


def write_state(controls, values):
    """A state as a text to copy: ``a=0.6,eps=0.01,n=64``."""
    return ",".join(f"{control.name}={control.text(values[control.name])}" for control in controls)


def read_state(controls, text):
    """Name -> value from such a text, of what it names.

    Raises
    ------
    ValueError    if it is not of this form, names what is not there, or names something twice
    """
    known, values = {control.name: control for control in controls}, {}
    for part in str(text).split(","):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not part.strip():
            continue
        if not equals or name not in known:
            raise ValueError(f"state must be NAME=VALUE parted by commas, of {', '.join(known)}, got {shown(part)}")
        if name in values:
            raise ValueError(f"state must say {name} once, got {shown(text)}")
        values[name] = known[name].parse(value)
    return values
