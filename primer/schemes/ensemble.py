"""Many problems of one text marched side by side: the same runs, to the bit, in less time."""

from __future__ import annotations

import os
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from primer.checks import sequence
from primer.compiled import able
from primer.schemes.block import MEMBERS, Block, fits_a_block
from primer.schemes.ftcs import ftcs
from primer.schemes.marching import a_problem
from primer.schemes.record import plan
from primer.schemes.run import Run, Seed
from primer.types import DTypeLike, Problem


def ftcs_ensemble(
    problems: Iterable[Problem],
    n: int = 100,
    dt: float = 1e-3,
    t_end: float = 100.0,
    record_every: int | None = None,
    snapshots: Iterable[float] = (),
    seed: Seed | tuple | None = None,
    blow_up_at: float = 1e3,
    dtype: DTypeLike = np.float64,
    digits: int | None = None,
) -> tuple[Run, ...]:
    """March many problems on the same grid with the same step: a tuple of what :func:`primer.ftcs` gives for each.

    Problems of one text, in float32 or float64, are marched in blocks, the member the innermost index, so that one
    vector instruction serves several of them; the blocks are spread over the machine's cores. Each member's bits are
    those of its single run. Anything else, such as a text with functions of the fields or of t, is marched one by one.

    Parameters
    ----------
    problems    a sequence of problems, such as ``[Toy(a) for a in np.linspace(0, 2, 64)]``
    The others are those of :func:`primer.ftcs`, and serve every member.

    Returns
    -------
    tuple of Run, in the order of ``problems``; after Ctrl-C, members that had not finished end as ``INTERRUPTED``

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not allowed

    The scheme of section A2.2.2.

    >>> from primer import Toy
    >>> runs = ftcs_ensemble([Toy(0.5), Toy(1.5)], n=30, t_end=5.0)
    >>> [run.t_first_negative is not None for run in runs]
    [True, False]
    """
    problems = sequence("problems", problems, "problems")
    for problem in problems:
        a_problem("problems", problem)
    options = (n, dt, t_end, record_every, snapshots, seed, blow_up_at, dtype, digits)
    asked = plan(*options)
    asked.refuse_if_large(max((len(problem.fields) for problem in problems), default=1), members=len(problems))
    groups: dict = {}
    for place, problem in enumerate(problems):
        groups.setdefault(fits_a_block(problem, asked), []).append(place)
    alone = groups.pop(None, [])
    if groups and not able():
        alone, groups = range(len(problems)), {}
    runs = {place: ftcs(problems[place], *options) for place in alone}
    blocks = [
        (places[k : k + MEMBERS], Block(asked, [problems[place] for place in places[k : k + MEMBERS]], MEMBERS))
        for places in groups.values()
        for k in range(0, len(places), MEMBERS)
    ]
    interrupted = False
    with ThreadPoolExecutor(os.cpu_count()) as pool:  # the compiled loop lets go of the interpreter
        marches = [pool.submit(block.march) for _, block in blocks]
        try:
            for march in marches:
                march.result()
        except KeyboardInterrupt:
            interrupted = True
        finally:
            for _, block in blocks:  # else the pool would wait for those still marching
                block.halted = True
    for places, block in blocks:
        runs |= zip(places, block.runs(interrupted), strict=True)
    return tuple(runs[place] for place in range(len(problems)))
