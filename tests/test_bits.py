"""Guards the last bit: a reproduction run is the same run compiled or not, alone or side by side, here or elsewhere."""

import hashlib
import os
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from subprocess import run as start

import numpy as np
import pytest
from transcription import march

import primer.problems.toy
from primer import Toy, ftcs, ftcs_ensemble

scheme = sys.modules["primer.schemes.ftcs"]
ROOT = Path(__file__).parents[1]
SCENE = {"n": 32, "dt": 2.0**-7, "t_end": 200 * 2.0**-7}  # 200 steps of a dyadic length
TOY = 0.5, 0.125  # ill posed enough for a changed last bit to grow e^6-fold in that time
DTYPES = {"float32": np.float32, "float64": np.float64}

#: SHA-256 of u and v after 200 steps, little-endian, from sin and cos of this machine's NumPy.
GENUINE = {
    "float32": "35cfb671822fbbc405f7500250b95867cc9459cbcf6bdb8422e8dd1620aba8a6",
    "float64": "e2388708e8f178862720b51c34df5724f562be88e24cc893071c5af149271ab6",
}
#: The same from initial data, forcing and steady state that are whole numbers over 8 in place of sin and cos: with no
#: library between them and the result, every machine of IEEE arithmetic must give these.
DYADIC = {
    "float32": "800d414801bbada2f26386673b4d1b212076c8112ba2059805c2401bf6c9822c",
    "float64": "bda23c374da4e2f87e8a40b866fb9ba0384524758773e8f3471913285654d0d0",
}
#: And from 30 decimal digits, where mpmath is the only library.
DIGITS = "ffd8bbd6de27d5a4aac199f61ffd86c11a2d1e29ecd47fa7960b381b11a1a87f"

WHY = """the bits of a run of 200 steps have changed.
If the dyadic runs of this file still pass, the scheme is what it was and only sin or cos differ: their last bit is the
math library's, NumPy's own with the vector instructions of this processor or libm's, and may change with either. On an
x86 processor, put NPY_DISABLE_CPU_FEATURES="X86_V3 X86_V4" before the command: if that changes the bits, it is that,
and the new numbers belong here with a word on why. Such runs agree with the old ones to round-off, until an ill-posed
one blows up, whose time is claimed as an interval only (figures/fig33.py).
If a dyadic run fails too, it is a bug: the order of operations, a contraction (fused multiply-add) or fastmath."""


def digest(run):
    """SHA-256 of the final fields, whatever the machine's byte order."""
    fields = np.array(run.final)
    if fields.dtype not in DTYPES.values():  # a longdouble has bytes that mean nothing
        return hashlib.sha256(repr([[str(x) for x in field] for field in fields]).encode()).hexdigest()
    return hashlib.sha256(fields.astype(fields.dtype.newbyteorder("<")).tobytes()).hexdigest()


def wave(x, shift=0):
    """A triangle in place of sin, by the point's number and not by x: exact in every binary arithmetic."""
    j = (np.arange(x.size) + shift) % x.size
    return ((np.abs(j - x.size // 2) - x.size // 4) / 8).astype(x.dtype)


@pytest.fixture
def _dyadic(monkeypatch):
    monkeypatch.setattr(primer.problems.toy, "sin", wave)
    monkeypatch.setattr(primer.problems.toy, "cos", partial(wave, shift=8))


@pytest.fixture(params=["compiled", "interpreted"])
def _loop(request, monkeypatch):
    if request.param == "compiled":
        pytest.importorskip("llvmlite")
    monkeypatch.setattr(scheme, "_compiles", lambda problem, asked: request.param == "compiled")


@pytest.mark.usefixtures("_loop")
@pytest.mark.parametrize("name", DTYPES)
def test_genuine_runs_give_the_recorded_bits(name):
    assert digest(ftcs(Toy(*TOY), **SCENE, dtype=DTYPES[name])) == GENUINE[name], WHY


@pytest.mark.usefixtures("_loop", "_dyadic")
@pytest.mark.parametrize("name", DTYPES)
def test_dyadic_runs_give_the_recorded_bits_on_every_machine(name):
    run = ftcs(Toy(*TOY), **SCENE, dtype=DTYPES[name])
    assert (8 * run.problem.initial(run.x)[1] % 0.5 == 0).all()  # dyadic indeed
    assert digest(run) == DYADIC[name], "no math library is in between: this is a bug (see WHY)"


def test_thirty_digits_give_the_recorded_bits():
    assert digest(ftcs(Toy(*TOY), **SCENE, digits=30)) == DIGITS


@pytest.mark.parametrize("name", DTYPES)
def test_the_recorded_bits_are_those_of_the_plain_transcription(name):
    """The other route: the scheme as anyone would type it, which no optimisation has touched."""
    *_, last = march(*TOY, SCENE["n"], SCENE["dt"], 200, DTYPES[name])
    assert hashlib.sha256(np.array(last).tobytes()).hexdigest() == GENUINE[name], WHY


@pytest.mark.parametrize("name", DTYPES)
@pytest.mark.parametrize("size", [1, 3, 8, 11])
def test_members_of_a_block_have_the_bits_of_their_single_runs(name, size):
    toys = [Toy(a) for a in np.linspace(-0.5, 1.5, size)]
    alone = [digest(ftcs(toy, **SCENE, dtype=DTYPES[name])) for toy in toys]
    assert [digest(run) for run in ftcs_ensemble(toys, **SCENE, dtype=DTYPES[name])] == alone


# What a new process may find otherwise: caches, cores, vector units, no compiler at all.

CODE = """
import sys, numpy as np
sys.path.insert(0, "tests")
import primer.problems.toy
from primer import Toy, ftcs, ftcs_ensemble
scheme = sys.modules["primer.schemes.ftcs"]
scheme._SOON = scheme._LATER = 0
from test_bits import SCENE, TOY, digest, wave
for numbers in ({"dtype": np.float32}, {"dtype": np.float64}, {"dtype": np.longdouble}, {"digits": 20}):
    print(digest(ftcs(Toy(*TOY), **SCENE, **numbers)))
print(*(digest(run) for run in ftcs_ensemble([Toy(a) for a in (0.3, 0.5, 1.5)], **SCENE)))
primer.problems.toy.sin = primer.problems.toy.cos = wave
print(digest(ftcs(Toy(*TOY), **SCENE)), digest(ftcs(Toy(*TOY), **SCENE, dtype=np.float32)))
"""
BLOCKED = "import sys; sys.modules['llvmlite.binding'] = None\nimport warnings; warnings.simplefilter('ignore')\n"
ONE_CORE = "import os; os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})\n"


def elsewhere(before="", **env):
    """What CODE prints in a new process."""
    env = {**os.environ, "PYTHONPATH": str(ROOT), **env}
    found = start([sys.executable, "-c", before + CODE], capture_output=True, text=True, env=env, cwd=ROOT)
    assert found.returncode == 0, found.stderr
    return found.stdout


@pytest.fixture(scope="module")
def here():
    return elsewhere()


@pytest.mark.slow
def test_no_compiler_and_another_process_give_the_same_bits(here):
    assert elsewhere() == here
    assert elsewhere(BLOCKED) == here


@pytest.mark.slow
def test_cores_and_threads_do_not_change_the_bits(here):
    assert elsewhere(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1") == here
    if hasattr(os, "sched_setaffinity"):
        assert elsewhere(ONE_CORE) == here


@pytest.mark.slow
def test_vector_units_do_not_change_the_dyadic_bits(here):
    """NumPy without the processor's newer instructions: sin may differ in its last bit, + and * may not."""
    from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

    able = [feature for feature in __cpu_dispatch__ if __cpu_features__.get(feature)]
    plain = elsewhere(NPY_DISABLE_CPU_FEATURES=" ".join(able))
    assert plain.splitlines()[-1] == here.splitlines()[-1]


def fate(a, name):
    """All of a run that is lost to round-off, the most sensitive of numbers: when it blew up, and with what."""
    run = ftcs(Toy(a), 80, 2.0**-7, 60.0, dtype=DTYPES[name])
    return run.stop, run.t_stop, digest(run)


@pytest.mark.slow
@pytest.mark.parametrize("pool", [ThreadPoolExecutor, partial(ProcessPoolExecutor, mp_context=get_context("spawn"))])
def test_one_process_or_many_give_the_same_bits(pool):
    tasks = [(a, name) for a in (-0.5, 0.3, 0.5) for name in DTYPES]
    alone = [fate(*task) for task in tasks]
    with pool(2) as workers:
        assert list(workers.map(fate, *zip(*tasks, strict=True))) == alone
    assert any(stop == "blew_up" for stop, _, _ in alone)
