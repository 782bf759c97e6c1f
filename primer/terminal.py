"""What all commands share: a parser whose errors suggest, and colours that only a terminal sees."""

import argparse
import os
import re
import sys
from difflib import get_close_matches

_COLOURS = {"ill-posed": 31, "well-posed": 32, "undecided": 33}  # red, green, yellow


class Parser(argparse.ArgumentParser):
    """An ``ArgumentParser`` that names what may have been meant."""

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **{"allow_abbrev": False} | options)

    def error(self, message):
        """Exit with 2 after the usage, the error, and a suggestion if something like it is there."""
        wrong = re.search(r"invalid choice: '([^']*)'|unrecognized arguments: (\S+)", message)
        close = get_close_matches(wrong[1] or wrong[2], self._known(), 1) if wrong else ()
        super().error(message + "".join(f"; did you mean {name}?" for name in close))

    def _known(self):
        """All words that a call may hold, of this command and those below it."""
        for action in self._actions:
            yield from action.option_strings
            yield from action.choices or ()
            if isinstance(action, argparse._SubParsersAction):
                for below in action.choices.values():
                    yield from below._known()


def coloured(text):
    """``text`` with its verdicts in colour on a terminal; as it is elsewhere, or where NO_COLOR is set."""
    if not sys.stdout.isatty() or os.environ.get("NO_COLOR") or text.startswith(("{", "[")):
        return text
    kinds = "|".join(_COLOURS)
    return re.sub(rf"\b({kinds})\b", lambda found: f"\33[1;{_COLOURS[found[1]]}m{found[1]}\33[0m", text)
