"""The cells of a map, marched job by job: here or by any executor, kept in a table as they come, safe from Ctrl-C."""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Callable, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, as_completed
from dataclasses import dataclass
from multiprocessing import current_process
from typing import Any

import numpy as np

from primer.checks import shown
from primer.schemes.ensemble import ftcs_ensemble
from primer.schemes.run import Seed, Stop


@dataclass(frozen=True, eq=False)
class Job:
    """Some cells of a map: ``work(*arguments)``, in any process, gives {key: values}, a row of the table for each cell.

    The first of the arguments has the cells; ``name`` says in a warning which they are.
    """

    name: str
    work: Callable
    arguments: tuple


def blow_up_times(problems: Sequence[Any], n: int, dt: float, t_end: float, seed: float) -> list[tuple[float, float]]:
    """[(t_blow_up, t_seeded), ...]: when runs by ``ftcs`` blow up, from round-off alone and from a seed as large.

    The seed is in the mode n//2 - 1 of the first field, next to the sawtooth. Infinite: the run lives; or, of the
    second, it was not made, since the first lives.

    Raises
    ------
    KeyboardInterrupt    after Ctrl-C
    """
    plain = _times(problems, n, dt, t_end, None)
    lost = [k for k, t in enumerate(plain) if t < math.inf]
    seeded = [math.inf] * len(plain)
    if lost:
        some = [problems[k] for k in lost]
        for k, t in zip(lost, _times(some, n, dt, t_end, Seed(n // 2 - 1, seed, some[0].fields[0])), strict=True):
            seeded[k] = t
    return list(zip(plain, seeded, strict=True))


def _times(problems, n, dt, t_end, seed):
    runs = ftcs_ensemble(problems, n, dt, t_end, record_every=10**9, seed=seed)
    if any(run.stop is Stop.INTERRUPTED for run in runs):
        raise KeyboardInterrupt
    return [run.t_stop if run.stop is Stop.BLEW_UP else math.inf for run in runs]


def overtaken(t_blow_up: np.ndarray, t_seeded: np.ndarray) -> np.ndarray:
    """True where a plain run blows up and only round-off makes it: the stated seed overtakes it, by two percent."""
    return np.isfinite(t_blow_up) & (t_seeded < 0.98 * t_blow_up)


def an_executor(executor: Any) -> None:
    """Raise TypeError unless it is an executor, or None."""
    if executor is not None and not isinstance(executor, Executor):
        raise TypeError(f"executor must be a concurrent.futures.Executor or None, got {shown(executor)}")


def without_repeats(name: str, values: list) -> list:
    """The values, or ValueError if one occurs twice."""
    if len(set(values)) < len(values):
        raise ValueError(f"{name} must be without repeats, got {shown(values)}")
    return values


def sweep(jobs: Sequence[Job], executor: Executor | None, store: Any, progress: bool, stacklevel: int) -> None:
    """Add the rows of all jobs to a ``Table`` as they come, under a progress bar that counts cells on a terminal.

    Ctrl-C ends it, and what was done by then is kept. A job whose worker dies or fails is named in a warning
    (``stacklevel``: whose).

    Raises
    ------
    RuntimeError    if no worker lived to do a job
    """
    from tqdm import tqdm

    if executor is not None and getattr(current_process(), "_inheriting", False):
        sys.exit(1)  # a spawned worker that reads a script without a main guard: its parent says so, once
    total = sum(len(job.arguments[0]) for job in jobs)
    with tqdm(total=total, unit="cell", disable=None if progress else True) as bar:

        def keep(rows):
            store.add(rows)
            bar.update(len(rows))

        waiting: dict[Future, int] = {}
        lost: dict[int, BaseException] = {}
        try:
            if executor is None:  # each job takes all cores
                for job in jobs:
                    keep(job.work(*job.arguments))
            else:
                for k, job in enumerate(jobs):
                    try:
                        waiting[executor.submit(job.work, *job.arguments)] = k
                    except BrokenExecutor as broken:  # a worker has died already
                        lost[k] = broken
                for done in as_completed(waiting):
                    if (error := done.exception()) is None or isinstance(error, KeyboardInterrupt):
                        keep(done.result())
                    else:  # one worker died, or ran out of memory: the others' cells are worth keeping
                        lost[waiting[done]] = error
        except KeyboardInterrupt:
            bar.set_postfix_str("interrupted")
        finally:
            for future in waiting:
                future.cancel()
    if lost and len(lost) == len(jobs) and all(isinstance(error, BrokenExecutor) for error in lost.values()):
        raise RuntimeError(
            "no worker lived to march a grid. In a script, what uses a process pool must stand under "
            'if __name__ == "__main__":, since spawned workers read the script again'
        )
    if lost:
        why = "; ".join(f"{jobs[k].name} ({type(e).__name__}: {e})" for k, e in sorted(lost.items()))
        warnings.warn(f"not marched, and not a number in the map: {why}", RuntimeWarning, stacklevel=stacklevel + 1)
