"""Machine code from LLVM's intermediate representation where llvmlite can be imported, NumPy where it cannot.

Whoever marches writes what is to be done as such a text (``schemes/writer.py``), from the tree of an equation and from
nothing else. A text is compiled in a few hundredths of a second, so that nothing needs to be kept on disk.
"""

import ctypes
import sys
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from threading import Lock
from typing import Any

_ONE_AT_A_TIME = Lock()  # compilers share what they know of the processor


@cache
def able():
    """Whether machine code can be made here; where it cannot, that is said once.

    An llvmlite that does not fit its system may fail with any error: whatever it is, NumPy gives the same results.
    """
    try:
        _compiler()
    except Exception as problem:
        said = f"llvmlite is not here ({_sentence(problem)}): results are the same, but slower"
        warnings.warn(said, RuntimeWarning, stacklevel=_outside())
        return False
    return True


def _outside():
    """How far up whoever called the package is."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back and frame.f_globals.get("__name__", "").startswith("primer."):
        level, frame = level + 1, frame.f_back
    return level


def _sentence(problem):
    words = " ".join(str(problem).split())
    words = words if isinstance(problem, ImportError) and words else f"{type(problem).__name__}: {words}"
    return words if len(words) <= 160 else words[:157] + "..."


def started():
    """Whether the compiler has been loaded, which takes a tenth of a second."""
    return _compiler.cache_info().currsize > 0 or "llvmlite.binding" in sys.modules


@cache
def _compiler():
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm, llvm.Target.from_default_triple(), llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()


@dataclass(frozen=True, eq=False)
class Code:
    """Machine code in memory, for as long as this object lives."""

    engine: Any

    def address(self, name: str) -> int:
        """Of one of its functions."""
        return self.engine.get_function_address(name)

    def function(self, name: str, *kinds: Any) -> Callable:
        """The same for Python, of arguments of these kinds of ctypes; it lets go of the interpreter while it runs."""
        return ctypes.CFUNCTYPE(None, *kinds)(self.address(name))


def machine_code(text: str) -> Code:
    """The machine code of a text of LLVM's, for this processor.

    No operation is contracted or reordered: no flag of fast arithmetic is ever written into such a text.
    """
    with _ONE_AT_A_TIME:
        llvm, target, processor, features = _compiler()
        machine = target.create_target_machine(cpu=processor, features=features, opt=3)  # the engine's own from here on
        module = llvm.parse_assembly(text)
        module.verify()
        engine = llvm.create_mcjit_compiler(module, machine)
        engine.finalize_object()
    return Code(engine)
