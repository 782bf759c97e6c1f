"""Names: the letters they are written in, the variables they are differentiated by, and what they are called inside.

Inside, the space variables are x, y, z and time is t, whatever the text calls them. A name of the text that would be
taken for one of these, such as an unknown y where ``space="x"``, carries a mark that no text can write.
"""

import re
import unicodedata
from dataclasses import dataclass, field
from functools import cached_property

from primer.equations.error import PDEError
from primer.equations.tree import OPERATORS, split_name

MARK = "\u1d5b"  # a small raised v: a compatibility letter, so that no canonical name holds it
GREEK = [
    "alpha",
    "beta",
    "gamma",
    "delta",
    "epsilon",
    "zeta",
    "eta",
    "theta",
    "iota",
    "kappa",
    "lambda",
    "mu",
    "nu",
    "xi",
    "omicron",
    "pi",
    "rho",
    "sigma",
    "tau",
    "upsilon",
    "phi",
    "chi",
    "psi",
    "omega",
]
_LETTERS = dict(zip("αβγδεζηθικλμνξοπρστυφχψω", GREEK, strict=True))
_LETTERS |= {letter.upper(): name.capitalize() for letter, name in _LETTERS.items()} | {"ς": "sigma", "ħ": "hbar"}
_VARIANTS = {"varepsilon": "epsilon", "vartheta": "theta", "varphi": "phi", "varrho": "rho", "varkappa": "kappa"}


def canonical(name):
    """The one form of a name that has several: the micro sign is the Greek letter mu, as in Python, and that is mu."""
    plain = unicodedata.normalize("NFKC", name)
    return "".join(_LETTERS.get(letter, letter) for letter in plain)


def command(name):
    """The name that a LaTeX command writes, "nu" for ``\\nu``; None if it is not a Greek letter."""
    name = _VARIANTS.get(name, name)
    return name if name.lower() in GREEK or name in ("hbar", "ell") else None


@dataclass(frozen=True)
class Variables:
    """The variables of a text, and its names inside and outside.

    Attributes
    ----------
    space : tuple    the space variables as the text calls them, in order: those inside are x, y, z
    time : str       what the text calls t
    spelt : dict     what the text calls a name inside
    plain            those of e, i and pi that are names of the text and no numbers
    evolved          the names that are differentiated by their subscript
    valued           the names that have a value, as the text calls them
    """

    space: tuple = ("x", "y", "z")
    time: str = "t"
    declared: bool = False
    spelt: dict = field(default_factory=dict, compare=False)
    plain: frozenset = frozenset()
    evolved: frozenset = frozenset()
    valued: frozenset = frozenset()

    @cached_property
    def inner(self):
        """Variable -> its letter inside."""
        return dict(zip(self.space, "xyz", strict=False)) | {self.time: "t"}

    @cached_property
    def outer(self):
        """Letter inside -> variable."""
        return {letter: name for name, letter in self.inner.items()}

    @cached_property
    def _subscript(self):
        return re.compile("|".join(map(re.escape, sorted(self.inner, key=len, reverse=True))))

    @property
    def dim(self):
        """The number of space variables."""
        return len(self.space)

    def derivatives(self, subscript):
        """The variables that a canonical subscript differentiates by, as a tuple; None if it does not."""
        rest = re.sub(r"[\s,_{}]", "", subscript)
        found = self._subscript.findall(rest)
        return tuple(found) if found and "".join(found) == rest else None

    def split(self, name):
        """(base, variables) of a canonical name, such as ("u", ("x", "x")) of "u_xx"; (name, ()) of another."""
        base, found = name, ()
        while "_" in base:
            stem, _, subscript = base.rpartition("_")
            these = self.derivatives(subscript) if stem else None
            if these is None:
                break
            base, found = stem, these + found
        return base, found

    def inside(self, base, variables=(), spelling=None):
        """The name inside of a base differentiated by variables; ``spelling`` is kept for messages."""
        if base in self.inner:
            name = self.inner[base]
        else:
            name = base + MARK * (base in self.plain or base in (*"xyzt",) or bool(split_name(base)[1]))
            if spelling is not None:
                self.spelt.setdefault(name, base if variables else spelling)
        return name + "_" * bool(variables) + "".join(self.inner[v] for v in variables)

    def outside(self, name, said=False):
        """What the text calls a name inside, in canonical letters; or as it was first ``said``."""
        base, letters = split_name(name)
        for operator, letter in OPERATORS.items():
            if letter in letters:
                return f"{operator}({self.outside(name.replace(letter, '', 1).removesuffix('_'), said)})"
        spelt = self.spelt.get(base) if said else None
        base = self.outer.get(base) or spelt or base.removesuffix(MARK)
        return base + "_" * bool(letters) + "".join(self.outer.get(letter, letter) for letter in letters)

    def narrowed(self, used):
        """The variables of a text that uses these: unless they are declared, the first, and others only if used."""
        if self.declared:
            return self
        first, *others = self.space
        return Variables((first, *(name for name in others if name in used)), self.time)


def variables(space=None, time=None):
    """The :class:`Variables` that ``space`` ("r", "x, z", or a sequence of names) and ``time`` declare.

    Raises
    ------
    TypeError, PDEError    if they are no names, more than three of space, or a name twice
    """
    clock = _names("time", "t" if time is None else time)
    if len(clock) != 1:
        raise PDEError(f"time must be one name such as 't', got {time!r}")
    if space is None:
        return Variables(tuple(name for name in "xyz" if name != clock[0]), clock[0])
    names = _names("space", space)
    if not 1 <= len(names) <= 3:
        raise PDEError(f"space must be one, two or three names such as 'x, z', got {space!r}")
    if len({*names, *clock}) != len(names) + 1:
        raise PDEError(f"space and time must be different names, got {', '.join(names)} and {clock[0]}")
    return Variables(tuple(names), clock[0], True)


def _names(what, given):
    if not isinstance(given, (str, list, tuple)) or not all(isinstance(name, str) for name in given):
        raise TypeError(f"{what} must be a text such as 'r', got {given!r}")
    parts = re.split(r"[\s,;]+", given.strip()) if isinstance(given, str) else list(given)
    names = [canonical(part.strip()).replace("_", "") for part in parts]
    for name, part in zip(names, parts, strict=True):
        if not re.fullmatch(r"[^\W\d_]\w*", name) or len(name) > 10:
            raise PDEError(f"{what} must be a name such as 'r', got {part!r}")
    return names
