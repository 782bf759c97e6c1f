"""What is said of a text that cannot be used: the text, a caret under the place, and what to do, in three voices."""

import re

_ASK = re.compile(r"⟪(\w+) ?([^⟪⟫]*)⟫")


class PDEError(ValueError):
    """The text of an equation, or what goes with it, cannot be used; the message shows the place.

    Section A2.1 needs equations that determine their unknowns, in the notation of ``primer help equations``.

    >>> from primer import verdict
    >>> try:
    ...     verdict("u_t = foo(u)")
    ... except PDEError as error:
    ...     print("foo" in str(error))
    True
    """

    def __init__(self, problem: str, text: str = "", place: int | None = None) -> None:
        self.problem = problem
        self.where = "" if place is None else f"\n{marked(text, place)}"
        super().__init__(self.said("python"))

    def said(self, voice: str) -> str:
        """The message as a reader is to act on it: in "python", in the "shell", or in an "explorer"."""
        return _ASK.sub(lambda ask: _VOICES[voice][ask[1]](ask[2].split()), self.problem) + self.where


def ask(what, *names):
    """A wish in a message, which each voice says in its own way: ``base``, ``value``, ``uniform``, ``variable``, ..."""
    return f"⟪{what} {' '.join(names)}⟫"


def _dotted(names):
    return " ".join(f"{name}=..." for name in names)


_VOICES: dict = {
    "python": {
        "base": lambda names: "at={" + ", ".join(f"'{name}': ..." for name in names) + "}",
        "value": lambda names: ", ".join(f"{name}=..." for name in names),
        "uniform": lambda names: "uniform=True",
        "variable": lambda names: f"{names[0]}='{names[1]}'",
        "function": lambda names: f"{names[0]}='{names[1]}^2' or {names[0]}=lambda {names[1]}: {names[1]}**2",
    },
    "shell": {
        "base": lambda names: f"--at {_dotted(names)}",
        "value": lambda names: f"--at {_dotted(names)}",
        "uniform": lambda names: "--uniform",
        "variable": lambda names: f"--{names[0]} {names[1]}",
        "function": lambda names: f"--at '{names[0]}={names[1]}^2'",
    },
    "explorer": {
        "base": lambda names: f"{_dotted(names)} in the base state",
        "value": lambda names: f"{_dotted(names)} in the base state",
        "uniform": lambda names: "uniform in the base state",
        "variable": lambda names: f"{names[0]}={names[1]} in the base state",
        "function": lambda names: f"{names[0]}={names[1]}^2 in the base state",
    },
}


def marked(text, place):
    """The line of the text that holds the place, cut to a window, and a caret under it."""
    start = text.rfind("\n", 0, place) + 1
    line, column = text[start:].partition("\n")[0], place - start
    left = max(0, column - 50)
    shown = "".join(c if c.isprintable() else " " for c in line[left : left + 80])
    return f"    {shown}\n    {' ' * (column - left)}^"
