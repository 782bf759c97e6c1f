"""The tree of an equation."""

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Node:
    """One node of the tree: what it is, its operands, and its place in the text.

    kind is "number" (value: the digits, and whether i follows), "name" (the name), "+", "*" (any number of operands),
    "-" (sign), "/" , "^", "call" (value: the function) or "derivative" (value: the letters).
    """

    kind: str
    place: int
    value: object = None
    operands: tuple = ()


def split_name(name):
    """("v", "xx") for "v_xx"; ("eps", "") for a name without a subscript of the letters x, y, z, t."""
    base, _, subscript = name.rpartition("_")
    return (base, subscript) if base and re.fullmatch("[xyzt]+", subscript) else (name, "")
