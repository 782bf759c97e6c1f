"""Still pictures of an explorer's states, with their verdicts."""

from dataclasses import dataclass

from primer.view.still import Still


@dataclass(frozen=True)
class Snapshot(Still):
    """A picture of the state ``state``; its words are the verdict."""

    state: str

    @property
    def verdict(self):
        """What the explorer says there."""
        return self.alt

    def __str__(self):
        return f"[{self.state}] {self.verdict}"
