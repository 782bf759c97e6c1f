"""The tree of an equation."""

import re
from dataclasses import dataclass

#: The Hilbert transform, symbol -i sign(xi), and |d/dx|, symbol |xi|, as letters of a subscript that no text can hold.
OPERATORS = {"H": "\u1d34", "absD": "\u1d30"}


@dataclass(frozen=True)
class Node:
    """One node of the tree: what it is, its operands, and its place in the text.

    kind is "number" (value: the digits, and whether i follows), "name" (the name), "+", "*" (any number of operands),
    "-" (sign), "/" , "^", "call" (value: the function) or "derivative" (value: the letters,
    those of ``OPERATORS`` among them).
    """

    kind: str
    place: int
    value: object = None
    operands: tuple = ()


def split_name(name):
    """("v", "xx") for "v_xx"; ("eps", "") for a name without a subscript of the letters of derivatives."""
    base, _, subscript = name.rpartition("_")
    return (base, subscript) if base and re.fullmatch("[xyzt\u1d34\u1d30]+", subscript) else (name, "")
