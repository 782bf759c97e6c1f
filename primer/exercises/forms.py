"""The forms in which a student may hold a number or a verdict, and the one in which a checker compares them."""

import math
import re
from enum import Enum

import mpmath as mp
import numpy as np
import sympy as sp

from primer.checks import shown
from primer.equations.linear import read
from primer.equations.values import evaluated

_MINUS = str.maketrans("\u2212\u2010\u2011\u2012\u2013\u2014", "-" * 6)
_FRAME = re.compile(r"(?:[\w*]+\s*(?:=|≈)\s*)?(?P<value>.*?)\s*(?:°|degrees?)?")  # "theta = 51.02 degrees"
_COMMA = re.compile(r"[-+]?\d+,(?!\d{3}$)\d+|[-+]?0,\d+")  # but 31,623 may be thirty thousand
_LONGEST = 80  # characters of a number written out
_EMPTY_WORDS = {"the", "and", "but", "it", "is", "hypothesis"}


def number(answer):
    """A number as a float: of Python, NumPy, sympy, mpmath or decimal, alone in an array or list, or written out.

    Text may be what a notebook prints, "c = 1.2661", or a formula, "sqrt(1.5/3)"; nothing of it is executed. A complex
    number counts if its imaginary part is rounding error.

    Raises
    ------
    TypeError, ValueError    if it is not a finite real number
    """
    held = _single(answer)
    try:
        if isinstance(held, (bool, np.bool_, bytes)):
            raise TypeError
        value = _written(held) if isinstance(held, str) else complex(held)
    except OverflowError:
        value = complex(math.inf)
    except (TypeError, ValueError, AttributeError):
        value = None
    if value is None or abs(value.imag) > 1e-9 * abs(value.real):
        raise TypeError(f"answer must be a finite number, got {shown(answer)} ({type(answer).__name__})")
    if not math.isfinite(value.real):
        raise ValueError(f"answer must be a finite number, got {shown(answer)}")
    return value.real


def text(answer, one_of):
    """A choice as a text: a text, a member of an enumeration, or something that has a ``kind`` as a verdict has.

    A well-posed ``Verdict`` says whether anything grows, and becomes "unstable" or "stable".

    Raises
    ------
    TypeError    if there is no text in it; the sentence begins with ``one_of``
    """
    held = _single(answer)
    if isinstance(held, sp.Basic) and held.free_symbols:
        return str(held)
    kind = getattr(held, "kind", held)
    if kind == "well-posed" and hasattr(held, "unstable"):
        return "unstable" if held.unstable else "stable"
    held = kind.value if isinstance(kind, Enum) else kind
    if not isinstance(held, str):
        raise TypeError(f"{one_of}, got {shown(answer)}")
    return str(held)


def plain(words):
    """Words without capitals, hyphens, marks and blanks: "Ill posed" and ill_posed are "ill-posed"."""
    found = re.findall(r"[^\W_]+", words.casefold())
    return "".join(word for word in found if word not in _EMPTY_WORDS) or "".join(found)


def term(written):
    """A product with a sign, its factors in order: "- δ u_xxxx" and "-u_xxxx*delta" are "-delta*u_xxxx"."""
    written = re.sub(r"['\"{}]", "", written.casefold().translate(_MINUS).replace("δ", "delta")).strip()
    sign, rest = (written[0], written[1:]) if written[:1] in ("-", "+") else ("+", written)
    return sign + "*".join(sorted(re.split(r"[\s*·]+", rest.strip())))


def _single(answer):
    """What is alone in an array, a list or a tuple; else the answer itself."""
    while (isinstance(answer, (list, tuple)) and len(answer) == 1) or (
        isinstance(answer, np.ndarray) and answer.size == 1
    ):
        answer = answer[0] if isinstance(answer, (list, tuple)) else answer.item()
    return answer


def _written(words):
    """The number that a text says."""
    framed = _FRAME.fullmatch(words.translate(_MINUS).strip().strip("'\""))
    value = framed["value"] if framed else ""
    try:
        return complex(float(value.replace(",", ".") if _COMMA.fullmatch(value) else value))
    except ValueError:
        pass
    if not value or len(value) > _LONGEST:
        raise ValueError
    system = read(f"u_t = ({value})*u")
    found = -system.slopes[0].get(("u", (0, 0, 0)), sp.S.Zero)
    if found.free_symbols or len(system.slopes[0]) > 2:
        raise ValueError
    with mp.workdps(30):
        return complex(evaluated(found, {}))
