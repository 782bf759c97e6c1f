"""Guards machine code made from texts: whatever the equation, it gives NumPy's bits, and sees the very same steps."""

import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import Phase, assume, example, given, settings
from hypothesis import strategies as st
from test_ensemble import assert_same_run

from primer import CENTRAL, CENTRAL_4, CENTRAL_6, FOURIER, PDE, RK4, RK8, PDEError, ftcs, ftcs_ensemble, march_lines
from primer.compiled import machine_code
from primer.equations.stages import evolution
from primer.schemes import lines
from primer.schemes.block import compilable
from primer.schemes.kernel import kernel
from primer.schemes.passes import Form

pytest.importorskip("llvmlite")
scheme = sys.modules["primer.schemes.ftcs"]

# Each example is compiled anew: a failure is shown as it was found, and not looked for in smaller texts.
AS_FOUND = {"deadline": None, "phases": [Phase.explicit, Phase.reuse, Phase.generate]}
SLOTS = [field + "_" * (m > 0) + "x" * m for field in "uv" for m in range(9)]
LEAVES = st.sampled_from([*SLOTS, *"uvuv", "2", "0.3", "a", "b", "sin(x)", "cos(x - t)", "t", "x"])


def larger(inner):
    """Terms made of terms."""
    return st.one_of(
        st.builds("({} {} {})".format, inner, st.sampled_from("+-*/"), inner),
        st.builds("{}*{}".format, inner, inner),
        st.builds("-{}".format, inner),
        st.builds("({}){}".format, inner, st.sampled_from(["^2", "^3", "^5", "^-2", "_x", "_xx", "_xxx"])),
        st.builds("{}({})".format, st.sampled_from(["abs", "sqrt"]), inner),
    )


TERMS = st.recursive(LEAVES, larger, max_leaves=8)
CALLED = ["sin", "exp", "tanh", "log", "sign", "asin", "acos", "atan", "erf"]  # all by NumPy, or SciPy, row by row
CALLS = st.builds("{} + {}({})*{}".format, TERMS, st.sampled_from(CALLED), TERMS, TERMS)
POWERS = st.builds("{} + abs({})^{}".format, TERMS, TERMS, st.sampled_from(["0.7", "a", "u", "(1/3)"]))


def problem(right, complex_=False):
    """u_t and v_t of two texts, with the parameters that occur in them."""
    text = f"u_t = {right[0]} + 0*u; v_t = {right[1]} + 0*v"
    if complex_:
        text = text.replace("0*u", "i*u")
    names = evolution(text, ("a", "b")).parameters
    initial = {"u": "1 + sin(x)/2", "v": "cos(2*x)"} if not complex_ else {"u": "1 + exp(i*x)/2", "v": "i*cos(2*x)"}
    try:
        return PDE(text, initial, **dict.fromkeys(names, 0.7))
    except PDEError as error:
        assume("finite" not in str(error) and "division" not in str(error))  # sqrt(-2), 1/(a - a)
        raise


def both(pde, *arguments, **options):
    """The run by machine code and by NumPy."""
    runs = []
    for fast in (True, False):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(scheme, "_compiles", lambda problem, asked, fast=fast: fast)
            runs.append(ftcs(pde, *arguments, **options))
    return runs


@settings(max_examples=40, **AS_FOUND)
@given(
    right=st.tuples(*2 * [st.one_of(TERMS, TERMS, CALLS, POWERS)]),
    n=st.integers(10, 70),
    dt=st.sampled_from([1e-9, 1e-6, 1e-3, 0.05]),
    every=st.integers(1, 90),
    dtype=st.sampled_from([np.float32, np.float64]),
    far=st.sampled_from([0.01, 0.7, 3.0, 1e3, 1e9]),
    complex_=st.booleans(),
)
@example(("(u^2/2 - v_x)_x", "-(u*v)_x + u_xxxx"), 17, 1e-6, 7, np.float64, 1e3, False)
@example(("u_xxxxxxxx + ((u*v)_x/u)_xx", "t*cos(x - t)*u_xxxxxxx"), 33, 1e-9, 1, np.float32, 1e3, False)
@example(("abs(u)^2*u + sqrt(u)/v", "u/(v_x + 2) + log(u)"), 12, 1e-3, 5, np.float64, 3.0, True)
@example(("sign(v)*asin(u/9) + acos(v/9)", "atan(u_x) + erf(v) + v_xx"), 12, 1e-3, 5, np.float64, 3.0, False)
@example(("sign(v)*u_x", "max(u, v)*erf(u) - min(v, 0.1)"), 12, 1e-3, 5, np.float32, 3.0, False)
@example(("asin(u/9) + acos(v/9)", "atan(u_x/9) + erf(v) + v_xx"), 12, 1e-3, 5, np.float64, 3.0, True)
def test_machine_code_gives_the_bits_of_numpy(right, n, dt, every, dtype, far, complex_):
    pde = problem(right, complex_)
    steps = 120
    if compilable(pde, n):
        assert_same_run(*both(pde, n, dt, steps * dt, every, (0.0, 50 * dt, 51 * dt), None, far, dtype))


@settings(max_examples=12, **AS_FOUND)
@given(
    right=st.tuples(TERMS, TERMS),
    count=st.integers(2, 11),
    dt=st.sampled_from([1e-9, 1e-6, 1e-3]),
    dtype=st.sampled_from([np.float32, np.float64]),
    complex_=st.booleans(),
)
def test_members_of_a_block_have_the_bits_of_their_single_runs(right, count, dt, dtype, complex_):
    """Each with its own parameters and its own period."""
    pde = problem(right, complex_)
    changes = [{name: 0.3 * k - 1.1 for name in pde.parameters} | {"period": 6.0 + k % 3} for k in range(count)]
    members = [pde.replace(**change) for change in changes]
    options = {"n": 24, "dt": dt, "t_end": 90 * dt, "record_every": 7, "snapshots": (0.0, 31 * dt), "dtype": dtype}
    if compilable(pde, 24):
        for member, run in zip(members, ftcs_ensemble(members, **options), strict=True):
            assert_same_run(run, both(member, **options)[1])


@settings(max_examples=15, **AS_FOUND)
@given(
    right=st.tuples(*2 * [st.one_of(TERMS, CALLS)]),
    n=st.integers(16, 40),
    dt=st.sampled_from([1e-9, 1e-6]),
    space=st.sampled_from([CENTRAL, CENTRAL_4, CENTRAL_6]),
    time=st.sampled_from([RK4, RK8]),
    complex_=st.booleans(),
)
def test_lines_give_the_bits_of_numpy(right, n, dt, space, time, complex_):
    pde, found = problem(right, complex_), []
    for fast in (True, False):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(lines, "able", lambda fast=fast: fast)
            found.append(march_lines(pde, n, dt, 5 * dt, space, time).final)
    np.testing.assert_array_equal(*found)


@pytest.mark.parametrize("n", [8, 15, 32])
def test_lines_with_matrices_agree_to_rounding(n, monkeypatch):
    pde = problem(("(u^2/2 - v_x)_x + u_xxx/50", "-(u*v)_x + t*v*sin(u)"))
    fast = march_lines(pde, n, 1e-3, 0.1, FOURIER, RK8).final
    monkeypatch.setattr(lines, "able", lambda: False)
    np.testing.assert_allclose(fast, march_lines(pde, n, 1e-3, 0.1, FOURIER, RK8).final, rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize("every", [1, 40, 10**6])
def test_no_step_is_overlooked(every):
    """u dips below 0 for 5 steps in 10,000 and comes back; Dist peaks beyond the limit for fewer still."""
    dip = PDE("u_t = -c*(t - 5)/(1 + c*(t - 5)^2)^2", {"u": "1"}, c=1e6)
    # u = 1/(2 (1 + c (t - 5)^2)) + 1 - 1/(2 (1 + 25 c)), at its highest 1.5 at t = 5
    for far, shift in ((0.49, 0.0), (10.0, 1.4)):
        pde = PDE(dip.text, {"u": str(1 - 2 * shift)}, c=-1e6) if shift else dip
        compiled, plain = both(pde, 8, 1e-3, 8.0, every, (), None, far)
        assert_same_run(compiled, plain)


def test_a_field_that_is_no_number_ends_the_run_at_the_very_step():
    """sqrt(u) of u < 0: no number, without having been large before."""
    for text in ("u_t = -1 + 0*sqrt(u - 0.5)", "u_t = -1/(u - 0.5)^9*0"):
        compiled, plain = both(PDE(text, {"u": "1"}), 8, 1e-3, 2.0, 1000)
        assert_same_run(compiled, plain)
    assert np.isnan(both(PDE("u_t = -1 + 0*sqrt(u - 0.5)", {"u": "1"}), 8, 1e-3, 2.0, 1000)[0].dist[-1])


HOSTILE = [
    "ret",
    "define",
    "double",
    "book",
    "i64",
    "poison",
    "label",
    "__",
    "x2",
    "lambda",
    "import",
    "exec",
    "ü",
    "é" * 20,
]


@pytest.mark.parametrize("name", [name for name in HOSTILE if "__" not in name])
def test_names_do_not_get_into_the_code(name):
    """What is written are numbers of rows and constants; what a reader calls them stays in the tree."""
    plain, odd = (evolution(f"u_t = {word}*u_xx - u", (word,)) for word in ("c", name))
    texts = [kernel(form, CENTRAL, "double", 8, 1, Form(False, (False,)), False) for form in (plain, odd)]
    assert texts[0] == texts[1]
    assert_same_run(*both(PDE(f"u_t = {name}*u_xx - u", {"u": "sin(x)"}, **{name: 0.1}), 16, 1e-2, 1.0))


LLVM = """declare define double i64 i32 i1 ptr void load store align br label phi icmp slt eq fcmp olt ogt uno select
or add sub mul and ret getelementptr call fadd fsub fmul fdiv fneg x insertelement shufflevector poison zeroinitializer
sitofp true false to"""


@settings(max_examples=15, **AS_FOUND)
@given(right=st.tuples(TERMS, CALLS))
def test_the_code_holds_no_word_of_the_text(right):
    """Only LLVM's own: every line is one of a few forms, whatever the equation."""
    form = evolution(f"u_t = {right[0]} + 0*u; v_t = {right[1]} + 0*v", ("a", "b"))
    shape = Form(False, *(len(part) * (False,) for part in (form.constants, form.fixed, form.clocks)))
    text = kernel(form, CENTRAL, "double", 8, 1, shape, False)
    words = {word for line in text.splitlines() for word in line.replace(",", " ").split() if word.isidentifier()}
    assert words <= set(re.findall(r"\w+", LLVM))


def test_threads_may_compile_and_march_at_once():
    texts = [f"u_t = {k}*u_xx/100 - (u^2/{k})_x + u*{k}" for k in range(1, 7)]
    pdes = [PDE(text, {"u": "1 + sin(x)/2"}) for text in texts for _ in range(3)]
    with ThreadPoolExecutor(6) as pool:
        runs = list(pool.map(lambda pde: ftcs(pde, 20, 1e-3, 6.0), pdes))
    for pde, run in zip(pdes, runs, strict=True):
        assert_same_run(run, both(pde, 20, 1e-3, 6.0)[1])


@pytest.mark.parametrize("problem", [KeyboardInterrupt, MemoryError("no room")])
def test_ctrl_c_and_errors_in_numpy_s_part_come_through(problem, monkeypatch):
    from primer.schemes import whole_rows

    operate, calls = whole_rows.operate, []

    def fails(*operands):
        calls.append(operands)
        if len(calls) == 1000:
            raise problem
        return operate(*operands)

    pde = PDE("u_t = sin(u)", {"u": "1"})
    monkeypatch.setattr(whole_rows, "operate", fails)
    monkeypatch.setattr(scheme, "_compiles", lambda problem, asked: True)
    if problem is KeyboardInterrupt:
        run = ftcs(pde, 8, 1e-4, 5.0)
        assert run.stop == "interrupted"
        assert 0.0999 < run.t_stop < 0.15
        monkeypatch.undo()
        assert_same_run(run, replace(ftcs(pde, 8, 1e-4, run.t_stop, 50), stop=run.stop))
    else:
        with pytest.raises(MemoryError, match="no room"):
            ftcs(pde, 8, 1e-4, 5.0)


def test_what_is_compiled_is_given_back(monkeypatch):
    """Code lives as long as someone holds it."""
    code = machine_code("define void @nothing() {\n  ret void\n}\n")
    code.function("nothing")()
    assert code.address("nothing")
    del code


@pytest.mark.slow
def test_processes_started_at_once_need_nothing_of_each_other(tmp_path):
    """There is no cache to fight for, no file to corrupt, no folder that must be writable."""
    code = "from primer import PDE, ftcs; run = ftcs(PDE('u_t = u_xx/9 - (u^2/2)_x', {'u': 'sin(x)'}), 64, 1e-3, 9.0);"
    code += "print(run.final[0].tobytes().hex())"
    env = {**os.environ, "HOME": "/nonexistent", "XDG_CACHE_HOME": str(tmp_path / "none"), "TMPDIR": str(tmp_path)}
    options = {"stdout": subprocess.PIPE, "text": True, "env": env}
    started = [subprocess.Popen([sys.executable, "-c", code], **options) for _ in range(3)]
    assert len({process.communicate()[0] for process in started}) == 1
    assert list(tmp_path.iterdir()) == []


def test_how_numpy_multiplies_complex_arrays_is_found_out(monkeypatch):
    """True or False wherever it is one of the two known ways; else NumPy marches complex fields."""
    from primer.schemes import block, whole_rows

    assert whole_rows.fused() in (True, False)
    random = np.random.default_rng(3)
    a, b = (random.normal(size=(2, 50)).view(complex).ravel() for _ in range(2))
    assert whole_rows._is_product(a, b, a * b, whole_rows.fused())
    assert not whole_rows._is_product(a, b, a * b * (1 + 1e-15), whole_rows.fused())
    assert whole_rows._is_quotient(a, b, a / b)
    assert not whole_rows._is_quotient(a, b, a / b * (1 + 1e-15))
    monkeypatch.setattr(block, "fused", lambda: None)
    assert not compilable(PDE("u_t = i*u_xx", {"u": "cos(x)"}), 16)
    assert compilable(PDE("u_t = u_xx", {"u": "cos(x)"}), 16)
