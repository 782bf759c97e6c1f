"""Which names of a text are its unknowns: those that are differentiated, and where these are too few, who else."""

from primer.equations.error import PDEError
from primer.equations.tree import split_name

VARIABLES = ("x", "y", "z", "t")


def uses(equations, constants=()):
    """{(name, its own derivatives, those of the brackets around it): its place}, in the order of the text.

    ``equations`` are pairs of nodes, as ``parse`` gives them; ``constants`` are names that are none.
    """
    found: dict = {}
    for equation in equations:
        for side in equation:
            _collect(side, "", constants, found)
    return found


def _collect(node, around, constants, found):
    if node.kind == "name" and node.value not in constants:
        found.setdefault((*split_name(node.value), around), node.place)
    for operand in node.operands:
        _collect(operand, around + (node.value if node.kind == "derivative" else ""), constants, found)


def unknowns(uses, number, given, outside=str):
    """The names differentiated; and, where those are too few, names in differentiated brackets or in constraints.

    ``outside(name)`` is what the text calls a name, for the errors.
    """
    order = [name for name in dict.fromkeys(base for base, _, _ in uses) if name not in VARIABLES]
    evolved = {base for base, own, around in uses if "t" in own + around}
    order.sort(key=lambda name: name not in evolved)
    direct = {base for base, own, _ in uses if own}
    wider: tuple[set, ...] = (
        set(),
        {base for base, _, around in uses if "t" in around},
        {base for base, _, around in uses if around},
        {base for base, _, _ in uses},
    )
    for others in wider:
        found = tuple(name for name in order if name in direct or (name in others and name not in given))
        if len(found) == number:
            return found
    found = tuple(name for name in order if name in direct)
    if not found:
        raise PDEError("nothing is differentiated: derivatives are written u_t, v_xx, (u*v)_x")
    raise PDEError(
        f"{number} equation{'s' * (number > 1)} for {len(found)} unknown{'s' * (len(found) > 1)} "
        f"({', '.join(map(outside, found))}): there must be as many of one as of the other"
    )
