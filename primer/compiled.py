"""Compiled loops where numba loads, NumPy where it does not."""

import warnings
from functools import cache, wraps
from importlib import import_module


@cache
def compiled(module):
    """The module of that dotted name, which imports numba, or None where numba does not load (said once).

    A numba that does not fit its NumPy or its compiler fails with a SystemError, an AttributeError or an OSError as
    well as with an ImportError: whatever it is, NumPy gives the same results.
    """
    why = _numba_fails()
    if not why:
        try:
            return import_module(module)
        except Exception as problem:
            why = _sentence(problem)
    _say(why)
    return None


@cache
def _numba_fails():
    """Why numba does not load, or "": asked once, for a second attempt may fail in another way."""
    try:
        import_module("numba")
    except Exception as problem:
        return _sentence(problem)
    return ""


def _sentence(problem):
    words = " ".join(str(problem).split())
    words = words if isinstance(problem, ImportError) and words else f"{type(problem).__name__}: {words}"
    return words if len(words) <= 160 else words[:157] + "..."


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
