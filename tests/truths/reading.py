"""Reading the numbers of a question."""

import re


def numbers(text):
    """All unsigned numbers of a text, in order."""
    return [float(found) for found in re.findall(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?", text)]
