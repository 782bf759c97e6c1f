"""Guards what cannot be helped: full disks, read-only places, kills, Ctrl-C, dead workers, damaged files, bare systems.

Each must cost no more than what was being made, leave every file whole, and be said in words.
"""

import errno
import json
import math
import os
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import primer
from primer import Seed, Stop, Toy, blow_up_map, ftcs
from primer.schemes.block import Block
from primer.schemes.record import Log
from primer.study import contestants, measured
from primer.study.table import Table

ROOT = Path(__file__).parents[1]
PACKAGE = Path(primer.__file__).parent
REGENERATE = ROOT / "figures" / "regenerate.py"
sys.path.insert(0, str(ROOT / "figures"))
import regenerate  # noqa: E402

A, N = [0.3, 0.6, 1.5], [16, 80, 120]
BARE = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "PYTHONIOENCODING": "ascii"}
ODD = "a folder, with (blanks) é ü 漢字 φ"
pytestmark = pytest.mark.slow
posix = pytest.mark.skipif(os.name != "posix", reason="sends POSIX signals")


def python(*arguments, env=None, **options):
    """A new Python with this package, its output as text."""
    env = {**os.environ, "PYTHONPATH": str(ROOT), **(env or {})}
    return partial(subprocess.run, capture_output=True, text=True, env=env, **options)([sys.executable, *arguments])


def start(*arguments, **options):
    """The same, running."""
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen([sys.executable, *arguments], env=env, start_new_session=True, **pipes, **options)


def same(one, other):
    for name in ("a", "n", "dt", "t_blow_up", "t_seeded"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


def sweep(**options):
    return blow_up_map(A, N, t_end=30.0, progress=False, **options)


@pytest.fixture(scope="module")
def whole():
    return sweep()


def no_space(*_, **__):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


# Full disks


@pytest.mark.parametrize("fails", ["os.replace", "write"])
def test_a_sweep_on_a_full_disk_says_so_and_keeps_its_table(whole, fails, tmp_path, monkeypatch):
    path = tmp_path / "map.csv"
    blow_up_map(A, N[:1], t_end=30.0, table=path, progress=False)
    before = path.read_bytes()
    with monkeypatch.context() as full:
        if fails == "write":
            full.setattr("csv.writer", no_space)
        else:
            full.setattr(os, "replace", no_space)
        with pytest.raises(OSError, match="No space left on device; the table is as it was") as caught:
            sweep(table=path)
    assert str(path) in str(caught.value)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["map.csv"]
    same(sweep(table=path), whole)


def test_a_table_on_a_truly_full_disk_is_as_it_was(tmp_path):
    code = (
        "import resource, signal, sys; from primer.study.table import Table;"
        "t = Table(sys.argv[1], {'eps': 0.1}, ('n',), ('t',)); t.add({(4,): (1.0,)});"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN); resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096));"
        "t.add({(n,): (n / 3,) for n in range(4, 4000)})"
    )
    pytest.importorskip("resource")
    path = tmp_path / "t.csv"
    found = python("-c", code, str(path))
    assert "File too large; the table is as it was" in found.stderr.splitlines()[-1]
    assert Table(path, {"eps": 0.1}, ("n",), ("t",)).rows == {(4.0,): (1.0,)}
    assert [p.name for p in tmp_path.iterdir()] == ["t.csv"]


def test_figures_on_a_full_disk_are_named_and_the_old_ones_kept(tmp_path):
    pytest.importorskip("resource")
    (tmp_path / "abs_sin.svg").write_text("old")
    code = (
        "import resource, signal, sys; sys.path.insert(0, sys.argv[1]); import regenerate;"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN); resource.setrlimit(resource.RLIMIT_FSIZE, (8192, 8192));"
        "sys.exit(regenerate.main(['abs_sin', '--out', sys.argv[2]]))"
    )
    found = python("-c", code, str(ROOT / "figures"), str(tmp_path))
    assert found.returncode == 1
    assert "abs_sin: not written (OSError: [Errno 27] File too large" in found.stderr
    assert "Traceback" not in found.stderr
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"abs_sin.svg": "old"}


RUN = "from primer import Toy, ftcs; run = ftcs(Toy(1.5), 100, 1e-3, 10.0); print(run.stop, run.dist[-1].hex())"


# Read-only places


def test_a_read_only_installation_and_home_still_run(tmp_path):
    """No folder can be made below a file, not even by root: the nearest to read-only that every account meets."""
    package = shutil.copytree(PACKAGE, tmp_path / "primer", ignore=shutil.ignore_patterns("__pycache__"))
    blocked = tmp_path / "file"
    blocked.write_text("")
    for folder in [package, *(path for path in package.rglob("*") if path.is_dir())]:
        (folder / "__pycache__").write_text("")
    nowhere = {name: str(blocked / "below") for name in ("HOME", "XDG_CACHE_HOME", "MPLCONFIGDIR")}
    code = "import primer; print(primer.__file__);" + RUN
    found = python("-c", code, env=nowhere | {"PYTHONPATH": str(tmp_path)}, cwd=tmp_path)
    where, said = found.stdout.splitlines()
    assert where.startswith(str(tmp_path))
    assert said + "\n" == python("-c", RUN).stdout
    assert "llvmlite is not here" not in found.stderr


@pytest.mark.skipif(not shutil.which("setpriv") or os.geteuid() != 0, reason="needs root, to become somebody else")
def test_an_installation_of_another_user_still_runs(tmp_path):
    """As "nobody", who may read everything here (the Python may be in a private folder) and write nothing."""
    read = "dac_read_search"
    nobody = ["setpriv", "--reuid", "65534", "--clear-groups", f"--inh-caps=+{read}", f"--ambient-caps=+{read}"]
    shutil.copytree(PACKAGE, tmp_path / "primer", ignore=shutil.ignore_patterns("__pycache__"))
    env = {**os.environ, "PYTHONPATH": str(tmp_path), "HOME": "/nonexistent"}
    code = "import os, primer; print(os.access(os.path.dirname(primer.__file__), os.W_OK));" + RUN
    found = subprocess.run([*nobody, sys.executable, "-c", code], capture_output=True, text=True, env=env, cwd=tmp_path)
    if "setpriv:" in found.stderr:
        pytest.skip("this machine does not let its root become somebody else")
    assert found.stdout == "False\n" + python("-c", RUN).stdout, found.stderr


# Kills and Ctrl-C


@posix
def test_a_killed_sweep_goes_on_where_it_was(whole, tmp_path):
    path = tmp_path / "map.csv"
    code = (
        "import sys; from primer import blow_up_map;"
        f"blow_up_map({A}, {N}, t_end=30.0, table=sys.argv[1], progress=False); print('done')"
    )
    process = start("-c", code, str(path))
    try:
        while not path.exists() and process.poll() is None:
            time.sleep(0.001)
    finally:
        os.killpg(process.pid, signal.SIGKILL)
    out, _ = process.communicate()
    kept = Table(path, {"eps": 0.01, "t_end": 30.0, "seed": 1e-12}, ("n", "dt", "a"), ("t_blow_up", "t_seeded")).rows
    assert "done" in out or 3 <= len(kept) < 9
    same(sweep(table=path), whole)


@posix
def test_killed_regenerations_leave_whole_files(tmp_path):
    python(str(REGENERATE), "abs_sin", "fig31", "--out", str(tmp_path))
    made = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert len(made) == 4
    for delay in (0.5, 1.0, 1.5, 2.0, 2.5):  # wherever that is: starting, computing, drawing, writing
        process = start(str(REGENERATE), "abs_sin", "fig31", "--out", str(tmp_path))
        time.sleep(delay)
        process.kill()  # and not its workers: they must see it, or they would hold the pipes open for ever
        process.communicate(timeout=120)
        assert {name: (tmp_path / name).read_bytes() for name in made} == made
    assert python(str(REGENERATE), "abs_sin", "fig31", "--out", str(tmp_path)).returncode == 0
    assert {name: (tmp_path / name).read_bytes() for name in made} == made


ENDLESS = """\"\"\"A map that takes hours.\"\"\"
from pathlib import Path
from primer import blow_up_map


def compute():
    Path(__file__).with_suffix(".begun").touch()
    return blow_up_map([1.5], [200], t_end=1e6, progress=False)


def numbers(result):
    return {}


def draw(result):
    from matplotlib.figure import Figure

    return Figure()
"""


@posix
def test_ctrl_c_ends_a_regeneration_quietly(tmp_path, ctrl_c):
    """A map swallows Ctrl-C, to give back what it has: of that no picture may be made."""
    scripts, out = tmp_path / "scripts", tmp_path / "out"
    scripts.mkdir()
    for name in ("regenerate", "sidecar"):
        shutil.copy(ROOT / "figures" / f"{name}.py", scripts)
    (scripts / "endless.py").write_text(ENDLESS)
    process = start(str(scripts / "regenerate.py"), "endless", "--out", str(out))
    try:
        while not (scripts / "endless.begun").exists():
            assert process.poll() is None, process.communicate()
            time.sleep(0.01)
        time.sleep(0.5)  # it does not matter where in the map it is
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to the workers too
        told, err = process.communicate()
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
    assert process.returncode == 130, err
    assert "interrupted: what was not finished is as it was before" in err
    assert told == ""
    assert "Traceback" not in err
    assert list(out.iterdir()) == []


def press_ctrl_c(monkeypatch, after):
    """Have a true signal come after so many looks at the state, or calls of the compiled loop."""
    left = [after]

    def then(function):
        def called(*arguments):
            function(*arguments)
            left[0] -= 1
            if left[0] == 0:
                signal.raise_signal(signal.SIGINT)

        return called

    monkeypatch.setattr(Log, "watch", then(Log.watch))
    init = Block.__init__

    def watched(block, *arguments):
        init(block, *arguments)
        block.loop = then(block.loop)

    monkeypatch.setattr(Block, "__init__", watched)


@pytest.mark.parametrize(
    ("problem", "after", "every"),
    [({"seed": Seed(3, 1e-3)}, 3, 2000), ({"dtype": np.longdouble}, 96, 30), ({"digits": 20}, 96, 30)],
    ids=str,
)
def test_ctrl_c_in_a_long_run_gives_what_was_recorded(problem, after, every, ctrl_c, monkeypatch):
    with monkeypatch.context() as pressed:
        press_ctrl_c(pressed, after)
        run = ftcs(Toy(1.5), 16, 1e-3, 1e5, record_every=every, **problem)
    assert run.stop is Stop.INTERRUPTED
    steps = round(run.t_stop / 1e-3)
    assert 95 <= steps < 10**8  # the end
    assert run.t[-1] == run.t_stop
    assert run.t.size == (steps - 1) // every + 2
    assert run.t.shape == run.dist.shape == run.u_min.shape
    again = ftcs(Toy(1.5), 16, 1e-3, min(steps, 2 * every) * 1e-3, record_every=every, **problem)
    assert run.dist[:3].tolist() == again.dist[:3].tolist()  # what it had, it had right


# Workers that die


def _dies(a, n, *rest):
    if n == 80:
        time.sleep(1.0)  # the other grids are done by then, or never begun
        os._exit(9)
    return _column(a, n, *rest)


def _fails(a, n, *rest):
    if n == 80:
        raise MemoryError("no memory for this one")
    return _column(a, n, *rest)


_column = sys.modules["primer.study.maps"]._column


@posix
@pytest.mark.parametrize("column", [_fails, _dies])
def test_a_worker_that_dies_costs_its_own_grid(whole, column, tmp_path, monkeypatch):
    path = tmp_path / "map.csv"
    with monkeypatch.context() as broken, ProcessPoolExecutor(2, mp_context=get_context("fork")) as pool:
        broken.setattr(sys.modules["primer.study.maps"], "_column", column)
        with pytest.warns(RuntimeWarning, match=r"not marched, and not a number in the map: n = 80 \("):
            first = sweep(table=path, executor=pool)
    assert first.done[0]
    assert not first.done[1]
    for j in np.flatnonzero(first.done):
        np.testing.assert_array_equal(first.t_blow_up[:, j], whole.t_blow_up[:, j])
    same(sweep(table=path), whole)  # and only the lost grid is marched again


def test_a_figure_whose_worker_dies_is_named_and_the_rest_made(tmp_path, monkeypatch, capsys):
    make = regenerate._make

    def dies(name, *rest):
        if name == "hadamard_modes":
            raise MemoryError("no memory for this one")
        return make(name, *rest)

    monkeypatch.setattr(regenerate, "_make", dies)
    monkeypatch.setattr(regenerate, "ProcessPoolExecutor", _inline)
    assert regenerate.main(["hadamard_modes", "abs_sin", "--out", str(tmp_path)]) == 1
    out, err = capsys.readouterr()
    assert err == "hadamard_modes: not written (MemoryError: no memory for this one)\n"
    assert out.startswith("1 of 2 figures written")
    assert {path.name for path in tmp_path.iterdir()} == {"abs_sin.svg", "abs_sin.json"}


def _inline(_, initializer):
    from concurrent.futures import ThreadPoolExecutor

    return ThreadPoolExecutor(1)


def test_two_regenerations_at_once_agree(tmp_path):
    one, two = (start(str(REGENERATE), "abs_sin", "fig31", "--out", str(tmp_path)) for _ in range(2))
    for process in (one, two):
        _, err = process.communicate(timeout=120)
        assert process.returncode == 0, err
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        f"{name}.{ending}" for name in ("abs_sin", "fig31") for ending in ("json", "svg")
    ]
    assert python(str(REGENERATE), "--check", "--out", str(tmp_path), "abs_sin", "fig31").returncode == 0


# Damaged files


def damaged(text):
    lines = text.splitlines(keepends=True)
    return {
        "empty": "",
        "no header": "".join(lines[1:]),
        "half a row": text[: len(text) - 12],
        "a word for a number": text.replace(lines[2].split(",")[0], "many", 1),
        "a column more": text.replace("\n", ",1\n"),
        "other columns": text.replace("t_seeded", "t_other"),
        "an old header": text.replace("seed=", "amplitude="),
        "a quote": text + '"',
    }


DAMAGE = (*damaged("# a\n1,2\n3,4\n"), "bytes", "a folder")


@pytest.mark.parametrize("harm", DAMAGE)
def test_a_damaged_table_is_refused_and_left_alone(harm, tmp_path):
    path = tmp_path / "map.csv"
    blow_up_map([1.5], [8], t_end=1.0, table=path, progress=False)
    text = path.read_text()
    if harm == "a folder":
        path.unlink()
        path.mkdir()
    else:
        path.write_bytes(b"\xff\xfe\x00" * 50 if harm == "bytes" else damaged(text)[harm].encode())
    before = path.is_dir() or path.read_bytes()
    with pytest.raises(ValueError, match=r"^table must be .* got") as caught:
        blow_up_map([1.5], [8], t_end=1.0, table=path, progress=False)
    assert len(str(caught.value).splitlines()) == 1
    assert before == (path.is_dir() or path.read_bytes())
    assert [p.name for p in tmp_path.iterdir()] == ["map.csv"]


@pytest.mark.parametrize(
    "content", [b"", b"{", b"[]", b"3", b"null", b'{"x": 3}', b'{"p_max": {}}', b"\xff\xfe", b'{"x": {"value": 1}}']
)
def test_a_damaged_sidecar_is_named_and_left_alone(content, tmp_path):
    path = tmp_path / "hadamard_modes.json"
    path.write_bytes(content)
    found = regenerate._check("hadamard_modes", tmp_path, ["svg"], redraw=False)[0]
    assert found
    assert all(len(sentence.splitlines()) == 1 for sentence in found)
    assert path.read_bytes() == content


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b"{}", b'{"points": [], "cost": [3]}', b"\xff\xfe"])
def test_damaged_measurements_are_named(content, tmp_path):
    path = tmp_path / "kept.json"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=r"path must be a file of measurements .*kept\.json"):
        measured.read(path)
    with pytest.raises(FileNotFoundError, match=r"none\.json"):
        measured.read(tmp_path / "none.json")


def test_measurements_are_replaced_as_a_whole(tmp_path, monkeypatch):
    kept = ROOT / "figures" / "work_precision.measured.json"
    path = shutil.copy(kept, tmp_path / "kept.json")
    study, cost = measured.read(path)
    measured.write(path, study, cost)
    assert json.loads(path.read_text()) == json.loads(kept.read_text())
    before = path.read_bytes()
    monkeypatch.setattr(os, "replace", no_space)
    with pytest.raises(OSError, match="No space left"):
        measured.write(path, study, cost)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["kept.json"]


# Bare systems


def test_a_missing_extra_is_named(monkeypatch):
    monkeypatch.setattr(contestants, "find_spec", lambda name: None)
    with pytest.raises(ModuleNotFoundError, match=r'pip install "illposed-primer\[bench\]"'):
        contestants.contestants(with_py_pde=True)
    assert "py-pde" not in [method.name for method in contestants.contestants()]


def test_without_distributed_nothing_asks_for_it():
    """The cluster extra is the user's own choice: they hand in its executor, and the package never imports it."""
    code = "import sys; sys.modules['distributed'] = sys.modules['dask'] = None\nfrom primer import blow_up_map\n"
    code += "print(blow_up_map([1.5], [8], t_end=1.0, progress=False).done.all())"
    found = python("-W", "error", "-c", code)
    assert found.stdout == "True\n", found.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ["granular", "--help"],
        ["verdict", "ψ_t = -ψ_xx"],
        ["granular", "--law", "φ"],
        ["granular", "--law", "cidr", "--phi", "0.55", "--p", "0.2", "--I", "0.1"],
    ],
    ids=lambda arguments: " ".join(arguments)[:20].encode("unicode_escape").decode(),
)
def test_commands_speak_to_a_terminal_of_ascii(arguments):
    bare = python("-m", "primer", *arguments, env=BARE)
    assert bare.returncode in (0, 2)
    assert bare.returncode == 2 or ":" in bare.stdout
    assert bool(bare.stdout) != bool(bare.stderr)
    assert "Traceback" not in bare.stderr
    assert (bare.stdout + bare.stderr).isascii()


@pytest.mark.parametrize(
    "env", [{}, BARE, {"DISPLAY": "", "MPLBACKEND": "tkagg"}], ids=["usual", "ascii", "no display"]
)
def test_figures_go_to_any_folder_of_any_system(env, tmp_path):
    folder = tmp_path / ODD
    found = python(str(REGENERATE), "fig31", "--out", str(folder), "--formats", "svg,png,pdf", env=env)
    assert found.returncode == 0, found.stderr
    assert sorted(path.name for path in folder.iterdir()) == [f"fig31.{e}" for e in ("json", "pdf", "png", "svg")]
    usual = ROOT / "figures"
    assert (
        json.loads((folder / "fig31.json").read_text()).keys() == json.loads((usual / "fig31.json").read_text()).keys()
    )
    assert python(str(REGENERATE), "fig31", "--check", "--out", str(folder), env=env).returncode == 0


def test_lists_speak_to_a_terminal_of_ascii():
    found = python(str(REGENERATE), "--list", env=BARE)
    assert found.returncode == 0, found.stderr
    assert found.stdout.isascii()


def test_a_table_may_have_any_name(tmp_path):
    (tmp_path / ODD).mkdir()
    path = tmp_path / ODD / "map ψ.csv"
    first = blow_up_map([1.5], [8], t_end=1.0, table=path, progress=False)
    again = blow_up_map([1.5], [8], t_end=1.0, table=str(path), progress=False)
    same(first, again)
    assert math.isinf(again.t_blow_up[0, 0])
    assert [p.name for p in path.parent.iterdir()] == ["map ψ.csv"]
