"""A bar for a run that takes its time: on a terminal alone, and only after two seconds."""

import sys
from contextlib import contextmanager
from multiprocessing import parent_process

_PATIENCE = 2.0  # seconds that need no bar


@contextmanager
def step_bar(steps, progress=True):
    """Yield ``tell(step)``, to be called now and then with the steps that are done.

    Nothing is shown where stderr is no terminal, in a worker process, whose bars would run over each other, or with
    ``progress=False``.
    """
    if not _seen(progress):
        yield lambda step: None
        return
    from tqdm import tqdm

    with tqdm(total=steps, unit="step", unit_scale=True, delay=_PATIENCE, leave=False) as bar:
        yield lambda step: bar.update(int(step) - bar.n)


def each(items, unit, progress=True):
    """Yield the items, under such a bar that counts them."""
    if not _seen(progress):
        yield from items
        return
    from tqdm import tqdm

    yield from tqdm(items, unit=unit, delay=_PATIENCE, leave=False)


def _seen(progress):
    """Whether a bar is wanted, and somebody may look."""
    return progress and parent_process() is None and bool(sys.stderr and sys.stderr.isatty())
