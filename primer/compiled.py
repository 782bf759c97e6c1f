"""Compiled loops where numba can be imported, NumPy where it cannot."""

import warnings
from functools import cache, wraps
from importlib import import_module


@cache
def compiled(module):
    """The module of that dotted name, which imports numba, or None where numba cannot be imported (said once)."""
    try:
        return import_module(module)
    except ImportError as missing:
        _say(str(missing))
        return None


@cache
def _say(why):
    warnings.warn(f"numba is not here ({why}): results are the same, but slower", RuntimeWarning, stacklevel=5)


def jit(function):
    """``function`` as machine code that lets go of the interpreter.

    It is cached on disk: beside its source, in the user's cache where that is read-only, or nowhere if both are, or if
    the disk is full.
    """
    import numba

    try:
        cached = numba.njit(cache=True, nogil=True)(function)
    except RuntimeError:  # no folder to write to
        return numba.njit(nogil=True)(function)

    @wraps(function)
    def called(*arguments):
        try:
            return cached(*arguments)
        except OSError:  # compiled, but not saved; nothing has run yet
            return cached(*arguments)

    return called
