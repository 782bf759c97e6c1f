"""The paper's checkable claims, each with what was computed, what shows it, and a verdict: one table, claims.toml."""

from dataclasses import dataclass

VERDICTS = ("confirmed", "corrected", "sharpened")


@dataclass(frozen=True)
class Claim:
    """One checkable claim of Barker, Schaeffer, Shearer & Gray (2017), in our words, and what became of it.

    Attributes
    ----------
    where       a label of the paper's source, such as "(toy-eig)", or a place, such as "Lemma 1"
    says        what the paper says there
    computed    what was computed
    shown_by    what shows it: scripts "figures/NAME.py" and tests "tests/FILE.py::NAME"
    verdict     "confirmed", "corrected" (the paper's version is wrong) or "sharpened" (right, and more can be said)
    """

    where: str
    says: str
    computed: str
    shown_by: tuple[str, ...]
    verdict: str


def claims(word="", verdict=None):
    """The claims in the paper's order, as a tuple of ``Claim``.

    Parameters
    ----------
    word       keep those that hold this text anywhere, in capitals or not; "" keeps all
    verdict    keep those of this verdict; None keeps all

    Raises
    ------
    TypeError     if word is not text
    ValueError    if verdict is not one of VERDICTS
    """
    if not isinstance(word, str):
        raise TypeError(f"word must be text, got {word!r}")
    if verdict is not None and verdict not in VERDICTS:
        raise ValueError(f"verdict must be one of {', '.join(VERDICTS)}, got {verdict!r}")
    import tomllib  # only now: the command line asks for the verdicts alone
    from importlib.resources import files

    rows = tomllib.loads(files("primer").joinpath("claims.toml").read_text(encoding="utf-8"))["claim"]
    found = (Claim(**{**row, "shown_by": tuple(row["shown_by"])}) for row in rows)
    return tuple(c for c in found if verdict in (None, c.verdict) and word.casefold() in _text(c).casefold())


def report(found):
    """Claims as lines to read."""
    counts = [f"{sum(c.verdict == v for c in found)} {v}" for v in VERDICTS]
    return "\n\n".join(
        [*(_paragraph(c) for c in found), f"{len(found)} claim{'s' * (len(found) != 1)}: {', '.join(counts)}"]
    )


def _paragraph(claim):
    rows = [("paper", claim.says), ("computed", claim.computed), ("shown by", "\n             ".join(claim.shown_by))]
    return "\n".join([f"{claim.where}: {claim.verdict}", *(f"  {name + ':':10s} {text}" for name, text in rows)])


def _text(claim):
    return " ".join([claim.where, claim.says, claim.computed, *claim.shown_by, claim.verdict])
