"""The scene of the explorer of any PDE: what its frozen short waves do, and what it does itself on three grids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from primer.checks import real
from primer.equations.error import PDEError
from primer.equations.stages import evolution
from primer.problems.data import names
from primer.problems.pde import PDE
from primer.scenes.marched import data_of, in_words, length, marched
from primer.scenes.pde import TOY, PDEAnswer, pde, read_values
from primer.study.grid_comparison import GridComparison


@dataclass(frozen=True, eq=False)
class AtWork:
    """What :func:`at_work` found: the frozen equations, and the marched ones, or None if they were not.

    ``verdict`` says both in words, and why nothing was marched.
    """

    frozen: PDEAnswer
    marched: GridComparison | None
    verdict: str


def at_work(
    pde: str = TOY,
    at: str = "u=-0.5 v_xx=0.3 eps=0.01",
    uniform: bool = False,
    order: str = "full",
    n: int = 64,
    initial: str = "u = 0.5; v = -sin(x)/2",
    period: str = "2*pi",
    t_end: float = 8.0,
) -> AtWork:
    """Is a PDE ill posed, frozen at a base state, and what does it do from ``initial`` on n, 2n and 4n points?

    Parameters
    ----------
    pde, at, uniform, order, n    as for :func:`primer.scenes.pde.pde`; ``at`` gives the parameters their values
    initial    each field at t = 0, "u = a; v = -sin(x)/2"; nothing is marched where it is empty
    period     in x: a number, or a multiple of pi such as "16*pi"
    t_end      the end; a run that a reader would have to wait for is refused in words

    Raises
    ------
    TypeError, ValueError    in one sentence, for what the frozen equations cannot use, and for a period or an end that
                             is no number above 0

    Section A2.1 beside section A2.2.2.

    >>> found = at_work("u_t = -u_xx", at="", initial="u = exp(cos(x))", n=16, t_end=2.0)
    >>> print(found.frozen.found.kind, found.marched.lost.round(2))
    ill-posed [0.8  0.4  0.15]
    """
    frozen = _frozen(pde, at, order, n, uniform, length(period))
    real("t_end", t_end, above=0)
    if not str(initial).strip():
        return AtWork(frozen, None, f"{frozen.verdict} (With initial data it is marched.)")
    try:
        found = marched(_problem(pde, at, initial, period), n, t_end)
    except (PDEError, ValueError) as reason:
        words = str(reason).split("\n")[0]
        return AtWork(frozen, None, f"{frozen.verdict} Not marched: {words}.")
    return AtWork(frozen, found, f"{frozen.verdict} {in_words(found)}")


_frozen = pde


def _problem(text, at, initial, period):
    """The ``PDE`` with those values of ``at`` that its texts name."""
    values, data = read_values(at), data_of(initial)
    needed = set(evolution(text, tuple(sorted(values))).parameters)
    fields = tuple(data)
    for datum in data.values():
        needed |= set(names(datum, fields))
    return PDE(text, data, period=length(period), **{name: values[name] for name in values if name in needed})


def until(answer: AtWork) -> float:
    """The share of the time at which playing may end: when the last grid was lost."""
    if answer.marched is None or np.isinf(answer.marched.lost).any():
        return 1.0
    return float(answer.marched.lost.max() / answer.marched.t[-1])
