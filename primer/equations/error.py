"""What is said of a text that cannot be used: the text, and a caret under the place."""


class PDEError(ValueError):
    """The text of an equation, or what goes with it, cannot be used; the message shows the place.

    Section A2.1 needs equations that determine their unknowns, in the notation of ``primer verdict``.

    >>> from primer import verdict
    >>> try:
    ...     verdict("u_t = foo(u)")
    ... except PDEError as error:
    ...     print("foo" in str(error))
    True
    """

    def __init__(self, problem: str, text: str = "", place: int | None = None) -> None:
        super().__init__(problem if place is None else f"{problem}\n{_marked(text, place)}")


def _marked(text, place):
    """The line of the text that holds the place, cut to a window, and a caret under it."""
    start = text.rfind("\n", 0, place) + 1
    line, column = text[start:].partition("\n")[0], place - start
    left = max(0, column - 50)
    shown = "".join(c if c.isprintable() else " " for c in line[left : left + 80])
    return f"    {shown}\n    {' ' * (column - left)}^"
