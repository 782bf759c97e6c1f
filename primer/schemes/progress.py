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
    if not progress or parent_process() is not None or not (sys.stderr and sys.stderr.isatty()):
        yield lambda step: None
        return
    from tqdm import tqdm

    with tqdm(total=steps, unit="step", unit_scale=True, delay=_PATIENCE, leave=False) as bar:
        yield lambda step: bar.update(int(step) - bar.n)
