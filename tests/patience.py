"""An alarm clock for what may hang."""

import signal
import threading
import time
from contextlib import contextmanager


@contextmanager
def alarm(seconds, ring):
    """Call ``ring`` when the block takes longer, where the system knows alarms; one that rings sooner stays set."""
    known = hasattr(signal, "setitimer") and threading.current_thread() is threading.main_thread()
    left = signal.getitimer(signal.ITIMER_REAL)[0] if known else 0.0
    if not known or 0 < left <= seconds:
        yield
        return
    before, start = signal.signal(signal.SIGALRM, ring), time.monotonic()
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
        if left:
            signal.setitimer(signal.ITIMER_REAL, max(left - (time.monotonic() - start), 1e-3))
