"""What nobody should pass, and how it must be turned down: one sentence, at once, and nothing else."""

import re
import sys
import warnings
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numpy as np
from patience import alarm

#: Wrong for any argument that wants a number; the rest of the world's mistakes follow by kind.
HUGE = 10**400
NOT_A_NUMBER = ("1", "", b"1", None, True, 1j, [1.0, 2.0], {}, {1}, object(), float, lambda: 1)
NOT_FINITE = (np.nan, np.inf, -np.inf, HUGE, -HUGE, np.float32("inf"))
REAL = (*NOT_A_NUMBER, *NOT_FINITE, np.zeros(3), np.array("x"))
LEAST_0 = (*REAL, -1, -1e-300)
POSITIVE = (*LEAST_0, 0, 0.0, -0.0)
INTEGER = (*NOT_A_NUMBER, np.nan, np.inf, 2.0, 1.5, np.float64(8), np.arange(3), -1)
GRID = (*INTEGER, 0, 3, HUGE, 10**12, -HUGE)
RAGGED = [[1.0], [1.0, 2.0]]
ARRAY = ("x", "", None, True, [True, False], 1j, [1.0, 1j], RAGGED, {}, object(), ["a"], [None], float, *NOT_FINITE)
ARRAY = (*ARRAY, [1.0, np.nan], [[np.inf]])
FUNCTION = ("x", None, 3, 1j, [1.0], {})
THING = ("x", "", None, 3, 1.5, True, 1j, [1.0], {}, object(), np.zeros(3))

PATIENCE = 60.0  # seconds to say no in; a hang is minutes at least, so no machine is too slow


class Hung(BaseException):
    """Raised in a case that was neither done nor refused in time."""


@contextmanager
def in_time(seconds=PATIENCE):
    """Stop the block, where the system knows alarms, when it takes longer: no answer is a failure too."""

    def ring(*_):
        raise Hung(f"no answer within {seconds} s")

    with alarm(seconds, ring):
        yield


@contextmanager
def little_memory(gigabytes=4):
    """Let the process grow by so much and no more: what asks for petabytes is refused here, not by the machine."""
    try:
        import resource
    except ImportError:
        yield
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    pages = int(Path("/proc/self/statm").read_text().split()[0]) if sys.platform == "linux" else 0
    if pages:
        resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + gigabytes * 2**30, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def complaint(call, *names):
    """What is wrong with how ``call()`` turns its input down, or "" if it does it as it should.

    As it should: a TypeError, a ValueError or the package's own subclass; one line under 300 characters that names the
    argument and says what was got; no warning on the way.
    """
    with warnings.catch_warnings(), in_time():
        warnings.simplefilter("error")
        try:
            answer = call()
        except (TypeError, ValueError) as error:
            own = type(error) in (TypeError, ValueError) or type(error).__module__.startswith("primer.")
            said = str(error)
            if not own:
                return f"{type(error).__name__} is another library's: {said}"
            if len(said.splitlines()) != 1 or len(said) >= 300:
                return f"not one short line: {said}"
            if not any(re.search(rf"\b{re.escape(name)}\b", said) for name in names):
                return f"does not name {' or '.join(names)}: {said}"
            return "" if "got" in said else f"does not say what it got: {said}"
        except BaseException as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            return f"{type(error).__name__}: {error}"
    return f"taken, and answered by a {type(answer).__name__}"


def complaints(function, good, bad, called=None):
    """Every complaint about ``function(**good)`` with one argument at a time made bad.

    ``bad`` maps an argument's name to the values it must refuse; ``called`` to other names that the sentence may use
    instead.
    """
    assert function(**good) is not NotImplemented  # the good call is good: what fails below is the bad argument
    found = []
    for name, values in bad.items():
        for value in values:
            problem = complaint(partial(function, **{**good, name: value}), name, *(called or {}).get(name, ()))
            if problem:
                found.append(f"{name}={str(type(value) if callable(value) else value)[:40]!r}: {problem[:200]}")
    return found
