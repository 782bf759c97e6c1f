"""What a reader can say yes or no to."""

from dataclasses import dataclass

import ipywidgets as widgets

from primer.checks import shown
from primer.view.explorers.controls import LABEL, Row, watched


@dataclass(frozen=True)
class Switch:
    """Yes or no."""

    name: str
    label: str
    default: bool = False

    def parse(self, text):
        """Whether a text says yes.

        Raises
        ------
        ValueError    if it says neither yes nor no
        """
        known = {"yes": True, "true": True, "1": True, "no": False, "false": False, "0": False}
        if str(text).lower() not in known:
            raise ValueError(f"{self.name} must be yes or no, got {shown(text)}")
        return known[str(text).lower()]

    def text(self, value):
        """Yes or no."""
        return "yes" if value else "no"

    def check(self, value):
        """As of ``Number``."""
        self.parse(value)

    def build(self, changed):
        """The ``Row`` of this control, as for ``Number``."""
        box = widgets.Checkbox(self.default, description=self.label, style={"description_width": LABEL})
        row = watched(box, changed)
        return Row(row.widget, row.get, lambda value: row.show(self.parse(value)), row.until)
