"""Compiled loops where numba can be imported, NumPy where it cannot."""

import warnings
from functools import cache
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
