r"""From characters to tokens: the alphabet of the language, plain or in LaTeX, each token with its place in the text.

A word takes its subscripts with it: ``u_xx``, ``u_{x x}``, ``uₓₓ`` and ``u_x_x`` are one token, and so is ``\rho_0``.
"""

import re
from typing import NamedTuple, NoReturn

from primer.equations.error import PDEError
from primer.equations.variables import GREEK, canonical, command

TOKENS, NAME = 900, 40  # far beyond what a person would write by hand

SCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿ"
LOWERED = "₀₁₂₃₄₅₆₇₈₉ₐₑₒₓₕₖₗₘₙₚₛₜᵢⱼᵣᵤᵥ"
LATEX_WORDS = [
    "sin",
    "cos",
    "tan",
    "exp",
    "log",
    "ln",
    "sinh",
    "cosh",
    "tanh",
    "arcsin",
    "arccos",
    "arctan",
    "max",
    "min",
]
_WORD = rf"[^\W\d_{SCRIPTS}{LOWERED}∂][^\W_{SCRIPTS}{LOWERED}]*"
_SUBSCRIPT = rf"_\{{[^{{}}]*\}}|_\\[A-Za-z]+|_[^\W_{SCRIPTS}{LOWERED}]+|[{LOWERED}]+"
_SUBSCRIPTS = f"(?:{_SUBSCRIPT})*"
_TOKEN = re.compile(
    rf"""(?P<blank>[^\S\n]+|[\ufeff\u200b\u2060&$])
  | (?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?P<imaginary>[ij](?!\w))?
  | (?P<word>{_WORD})(?P<subscripts>(?:{_SUBSCRIPT})*)
  | \\(?P<command>[A-Za-z]+\*?|\S|[ ])
  | (?P<subscript>{_SUBSCRIPT})
  | (?P<script>[{SCRIPTS}]+)
  | (?P<operator>\*\*|==|[-+*/^=()\[\]{{}};,|\n])
  | (?P<sign>[−–·⋅∙•×∗∂𝜕∇∆√≡])""",
    re.VERBOSE,
)
_SIGNS = {"−": "-", "–": "-", "×": "*", "∗": "*", "∂": "∂", "𝜕": "∂", "∇": "∇", "∆": "Δ", "√": "√", "≡": "="}
_SIGNS |= dict.fromkeys("·⋅∙•", "·") | {"**": "^", "==": "="}
_COMMANDS = {
    "cdot": "·", "times": "*", "ast": "*", "partial": "∂", "nabla": "∇", "Delta": "Δ", "frac": "frac", "dfrac": "frac",
    "tfrac": "frac", "sqrt": "√", "lvert": "|", "rvert": "|", "vert": "|", "mid": "|", "{": "(", "}": ")",
    "lbrace": "(", "rbrace": ")", "dot": "dot", "equiv": "=",
}  # fmt: skip
_BLANKS = frozenset(
    [" ", *",;:!>[]()", "displaystyle", "textstyle", "limits", "nonumber", "notag", "quad", "qquad", "left", "right"]
    + [size + side for size in ("big", "Big", "bigg", "Bigg") for side in ("", "l", "r")]
)
_COMMENT = re.compile(r"#[^\n]*|\\(?:begin|end)\s*\{\w*\*?\}(?:\{\w*\})?|\\(?:label|tag)\s*\{[^{}]*\}")
_FONT = re.compile(r"\\(?:text|mathrm|mathit|mathbf|mathsf|operatorname|boldsymbol|rm)\s*\{\s*(\w+)\s*\}")


class Token(NamedTuple):
    """kind is "number" (value: digits, imaginary), "name" (base, variables, word, whether from LaTeX), "subscript"
    (variables or None, as written), "script" (as written), "operator" (a sign, or one of ∂ ∇ Δ √ frac dot) or "end"."""

    kind: str
    value: object
    place: int
    end: int


def cleaned(text):
    """The text with comments and fonts blanked and LaTeX's line ends as line ends, each character in its place."""
    text = _COMMENT.sub(lambda match: " " * len(match[0]), text)
    text = _FONT.sub(
        lambda match: " " * (match.start(1) - match.start()) + match[1] + " " * (match.end() - match.end(1)), text
    )
    text = re.sub(r"\\\\(\[[^\]\n]*\])?", lambda match: " " * (len(match[0]) - 1) + "\n", text)
    return text.replace("\r", " ").replace("\v", " ").replace("\f", " ")


def tokens(text, variables, given=()):
    """The tokens of a text. ``given`` are canonical names that have a value: a word Δh that has one is a name."""
    clean = cleaned(text)
    straight = _straight(clean, variables, given)  # the places of a d that differentiates
    found: list[Token] = []
    place = depth = 0

    def fail(problem: str, at: int) -> NoReturn:
        raise PDEError(problem, text, at)

    while place < len(clean):
        match = _TOKEN.match(clean, place)
        if not match:
            if clean[place] == "." and re.match(r"\.\s*(?:$|\n|;)", clean[place:]):
                place += 1  # a full stop
                continue
            fail(f"unexpected character {text[place]!r}", place)
        start, place = match.start(), match.end()
        kind, value = str(match.lastgroup), match[str(match.lastgroup)]
        if kind in ("number", "imaginary"):
            kind, value = "number", (match["number"], bool(match["imaginary"]))
        elif kind in ("word", "subscripts"):
            word, subscripts = match["word"], match["subscripts"]
            cut = min((d for d in straight if start < d < match.end("word")), default=None)  # the x of dxdy
            if cut is not None:
                word, subscripts, place = word[: cut - start], "", cut
            if start in straight:
                kind, value, place = "operator", "∂", start + 1
            elif word[0] == "Δ" and canonical(clean[start:place]) not in given:
                kind, value, place = "operator", "Δ", start + 1
            else:
                kind, value = "name", _name(word, subscripts, variables, fail, start)
                place = _checked_end(clean, place, fail, start)
        elif kind == "command":
            kind, value, place = _commanded(clean, value, start, place, variables, given, fail)
        elif kind == "subscript":
            value = variables.derivatives(_lowered(value)), value
        elif kind in ("operator", "sign"):
            kind, value = "operator", _SIGNS.get(value, value)
        if kind == "blank":
            continue
        if len(found) == TOKENS:
            fail(f"the text has more than the {TOKENS} symbols allowed", start)
        if kind == "operator" and value in ("(", "[", "{", ")", "]", "}"):
            depth += 1 if value in "([{" else -1
        if value != "\n" or (depth <= 0 and _begins_equation(clean, place)):
            found.append(Token(kind, value, start, place))
    return [*found, Token("end", "", len(text), len(text))]


def _commanded(clean, name, start, place, variables, given, fail):
    """(kind, value, end) of a LaTeX command."""
    if name in _BLANKS:
        return "blank", "", place
    if name in _COMMANDS and not (name == "Delta" and name in given):
        return "operator", _COMMANDS[name], place
    word = command(name) or (name if name in LATEX_WORDS else None)
    if word is None:
        fail(f"\\{name} is not understood", start)
    end = place + len(re.match(_SUBSCRIPTS, clean[place:])[0])  # type: ignore[index]  # which matches nothing, too
    base, by, _, _ = _name(word, clean[place:end], variables, fail, start)
    return "name", (base, by, clean[start:end], True), _checked_end(clean, end, fail, start)


def _name(word, subscripts, variables, fail, place):
    """(base, variables, as written, whether from LaTeX)"""
    base = canonical(word)
    if not base.isidentifier():
        odd = next(n for n, _ in enumerate(word) if not canonical(word[: n + 1]).isidentifier())
        fail(f"unexpected character {word[odd]!r}", place + odd)
    for part in re.findall(_SUBSCRIPT, subscripts):
        base += "_" + _lowered(part)
    if not base.isidentifier() or base.endswith("_"):
        fail("a subscript must be letters and digits", place + len(word))
    if len(base) > NAME:
        fail(f"a name longer than the {NAME} characters allowed", place)
    return *variables.split(base), word + subscripts, False


def _checked_end(clean, place, fail, start):
    if clean.startswith("_", place):
        fail("a name with two underscores together, or with one at its end", start)
    return place


def _lowered(subscript):
    r"""What a subscript says: "xx" for ``_xx``, ``_{x x}`` or ``ₓₓ``, "infty" for ``_\infty``."""
    inner = subscript[1:] if subscript.startswith("_") else subscript
    inner = re.sub(r"\\([A-Za-z]+)", lambda match: command(match[1]) or match[1], inner)
    return canonical(re.sub(r"[\s{},_\\]", "", inner))


def _begins_equation(clean, place):
    """Whether the line that starts here is not the continuation of the one before: it has its own left side."""
    left, equals, _ = re.split(r"[;\n]", clean[place:], maxsplit=1)[0].partition("=")
    return bool(equals and left.strip(" \t&"))


def _straight(clean, variables, given):
    """The places of each d that stands for ∂: in d/dx, du/dt, d²u/dx² and in such fractions of LaTeX."""
    power, by = r"(?:\^?\d|\^\{\d\}|[²³⁴⁵⁶])?", "|".join(sorted(map(re.escape, variables.inner), key=len, reverse=True))
    below = rf"(?P<below>(?:d\s*(?:{by}){power}\s*)+)"
    plain = re.compile(rf"(?<!\w)d{power}\s*(?P<of>{_WORD})?\s*/\s*{below}(?!\w)")
    latex = re.compile(rf"frac\s*\{{\s*d(?P<of>{power}(?:[^{{}}]|\{{[^{{}}]*\}})*)\}}\s*\{{\s*{below}\}}")
    places: set[int] = set()
    for pattern in (plain, latex):
        for match in pattern.finditer(clean):
            of = canonical(match["of"] or "")
            known = (
                pattern is latex
                or len(of) < 2
                or of in GREEK
                or re.search(rf"(?<![^\W_]){re.escape(of)}(?![^\W_])", clean)
            )
            if known and "d" + of not in given:  # delta/dx is a quotient of two names
                places.update(
                    (
                        clean.index("d", match.start()),
                        *(d.start() + match.start("below") for d in re.finditer(rf"d(?=\s*(?:{by}))", match["below"])),
                    )
                )
    return places
