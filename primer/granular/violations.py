"""The theorem's hypotheses violated, as laws at base states: which are needed?"""

from dataclasses import dataclass
from typing import Any

from primer.granular.ansatz import Ansatz
from primer.granular.criteria import conditions
from primer.granular.friction import Friction
from primer.granular.materials import EXAMPLE_COMPACTION, GLASS_BEADS
from primer.granular.posedness import verdict
from primer.granular.rheology import CIDR, CSSM
from primer.granular.state import BaseState


@dataclass(frozen=True, eq=False)
class Case:
    """A law at a base state, the hypotheses that hold there, and the verdict."""

    name: str
    law: Any
    state: BaseState
    conditions: Any
    verdict: Any


def cases(friction=GLASS_BEADS.friction, compaction=EXAMPLE_COMPACTION):
    """All hypotheses, then each one broken, as a tuple of ``Case``.

    The states are at phi = 0.55; what a case breaks, and whether that matters, is computed and not assumed.
    """
    mu, dmu, phi = friction.mu, friction.dmu, 0.55
    scale = compaction.C(phi)
    # Lemma 1 turns a falling friction law into alpha and beta that satisfy the equality, but with Y_I < 0.
    falling = Friction(lambda I: friction.mu1 + 0.1 / (1 + I), lambda I: -0.1 / (1 + I) ** 2)
    normal = Ansatz(lambda I: 2 * mu(I), lambda I: 2 * dmu(I), lambda I: 2 * mu(I), lambda I: 2 * dmu(I), compaction)
    constant = Ansatz(lambda I: mu(I) + 0.05, dmu, lambda I: 0.1 + 0 * I, lambda I: 0 * I, compaction)
    # b = beta + K/I keeps the equality, because f + I f_I does not see K/I, and raises f_p - I/(2p) f_I by K/(2 p I).
    K = 0.1
    drop = Ansatz(
        friction.alpha,
        friction.dalpha,
        lambda I: friction.beta(I) + K / I,
        lambda I: friction.dbeta(I) - K / I**2,
        compaction,
    )
    table = (
        ("all hold: CIDR", CIDR(friction, compaction), BaseState(0.2 * scale, phi, 0.1)),
        ("(a) fails, Y_I = 0: CSSM, dilating", CSSM(friction.mu1, compaction), BaseState(0.2 * scale, phi, 0.1)),
        ("(a) fails, Y_I = 0: CSSM, contracting", CSSM(friction.mu1, compaction), BaseState(0.5 * scale, phi, 0.1)),
        ("(a) fails, Y_I < 0: friction falls with I", CIDR(falling, compaction), BaseState(0.3 * scale, phi, 0.5)),
        ("equality fails: normality, f = Y_p", normal, BaseState(0.2 * scale, phi, 0.1)),
        ("equality fails: constant dilatancy", constant, BaseState(0.05 * scale, phi, 0.001)),
        ("(b) fails: f_p - I/(2p) f_I > 0", drop, BaseState(0.2 * scale, phi, 0.1)),
    )
    return tuple(Case(name, law, state, conditions(law, state), verdict(law, state)) for name, law, state in table)


def table(rows):
    """The cases as lines of text."""
    head = f"{'case':44s} {'B = C':>6s} {'(a)':>4s} {'(b)':>4s}  {'verdict':11s} growth"
    return "\n".join([head, *(_line(row) for row in rows)])


def _line(row):
    marks = ["yes" if bool(v) else "no" for v in (row.conditions.equality, row.conditions.a, row.conditions.b)]
    v = row.verdict
    growth = f"{v.coefficient:.5g} |xi|^{float(v.exponent):.3g}" if v.kind == "ill-posed" else f"at most {v.bound:.5g}"
    return f"{row.name:44s} {marks[0]:>6s} {marks[1]:>4s} {marks[2]:>4s}  {v.kind:11s} {growth}"
