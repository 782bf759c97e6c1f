"""Guards the command line: what it prints, its JSON, and that bad input ends with a sentence and exit code 2."""

import json
import subprocess
import sys

import pytest

import primer.base_state
import primer.granular as granular
import primer.granular.command
from primer.__main__ import main

TOY = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"


def run(capsys, *arguments):
    code = main(list(arguments))
    return code, *capsys.readouterr()


def test_readable(capsys):
    code, out, err = run(capsys, "verdict", "u_t = u_xxx - u_xx")
    assert (code, err) == (0, "")
    assert out.splitlines()[0].split() == ["verdict:", "ill-posed"]
    assert "Re lambda ~ 1 |xi|^2" in out
    code, out, _ = run(capsys, "verdict", "u_t = -u_xx - u_xxxx")
    assert "well-posed, unstable" in out
    assert "Re lambda <= 0.25" in out
    code, out, _ = run(capsys, "verdict", "u_t = v; v_t = u_x")
    assert "|xi|^(1/2)" in out
    code, out, _ = run(capsys, "verdict", "u_t = u_xx - u_yy")
    assert "(0, 1)" in out


def test_json(capsys):
    code, out, _ = run(capsys, "verdict", TOY, "--at", "u=-0.5", "v_xx=0.3", "--set", "eps=1e-2", "--json")
    found = json.loads(out)
    assert code == 0
    assert (found["kind"], found["exponent"], found["coefficient"]) == ("ill-posed", 2, pytest.approx(0.005))
    assert found["bound"] is None
    assert (found["grows"], found["unstable"]) == (True, False)  # at a point of a state that varies
    _, out, _ = run(capsys, "verdict", "u_t + u_xxt = u_xx", "--json")
    assert json.loads(out)["exponent"] is None  # undecided


def test_order(capsys):
    _, out, _ = run(capsys, "verdict", "u_t = u_xxx - u_xx", "--order", "maximal", "--json")
    assert json.loads(out)["kind"] == "well-posed"


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["u_t = foo(u)"], "'foo' is not a known function"),
        (["u_t = (u"], "expected ')'"),
        (["u_t = a*u_xx"], "not given: parameters --at a=..."),
        (["u_t = u_xx", "--at", "w=3"], "'w' has a value"),
        (["u_t = u_xx", "--at", "u=nan"], "u must be a finite number"),
        ([""], "no equation"),
    ],
)
def test_bad_input_ends_with_exit_2(capsys, arguments, sentence):
    code, out, err = run(capsys, "verdict", *arguments)
    assert (code, out) == (2, "")
    assert sentence in err
    assert "Traceback" not in err


@pytest.mark.parametrize(
    "arguments",
    [["nonsense"], ["verdict"], ["verdict", "u_t = u", "--at", "u"], ["verdict", "u_t = u", "--order", "half"]],
)
def test_bad_calls_end_with_exit_2(capsys, arguments):
    with pytest.raises(SystemExit) as stopped:
        main(arguments)
    assert stopped.value.code == 2
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "meant"),
    [
        (["verdit", "u_t = u"], "verdict"),
        (["verdict", "u_t = u", "--jsn"], "--json"),
        (["granular", "--law", "cdr", "--p", "1", "--phi", "0.5", "--I", "1"], "cidr"),
        (["verdict", "u_t = u", "--order", "maximum"], "maximal"),
    ],
)
def test_errors_suggest_what_was_meant(capsys, arguments, meant):
    with pytest.raises(SystemExit) as stopped:
        main(arguments)
    assert stopped.value.code == 2
    assert capsys.readouterr().err.rstrip().endswith(f"did you mean {meant}?")


def test_colours_are_for_terminals_alone(capsys, monkeypatch):
    _, plain, _ = run(capsys, "verdict", "u_t = u_xx")
    assert "\33" not in plain
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    assert "\33[1;32mwell-posed\33[0m" in run(capsys, "verdict", "u_t = u_xx")[1]
    json.loads(run(capsys, "verdict", "u_t = u_xx", "--json")[1])
    monkeypatch.setenv("NO_COLOR", "1")
    assert run(capsys, "verdict", "u_t = u_xx")[1] == plain


FLOW = ["granular", "--law", "cidr", "--p", "0.2", "--phi", "0.55", "--I", "0.1"]


def test_granular_in_space(capsys):
    """The verdict is that of three dimensions, of which tests/test_granular_space.py has the oracle."""
    code, out, err = run(capsys, *FLOW, "--dim", "3", "--lode", "0.1")
    assert (code, err) == (0, "")
    assert "hypotheses of the theorem, in the plane" in out
    assert "Lode angle 0.1" in out
    shown = [float(x) for x in out.split("direction (")[1].split(")")[0].split(",")]
    assert len(shown) == 3
    found = json.loads(run(capsys, *FLOW, "--dim", "3", "--lode", "0.1", "--json")[1])
    assert (found["dim"], found["lode"]) == (3, 0.1)
    assert found["direction"] == pytest.approx(shown, rel=1e-5)
    assert sum(x * x for x in found["direction"]) == pytest.approx(1)
    plane = json.loads(run(capsys, *FLOW, "--json")[1])
    assert (plane["dim"], plane["lode"], len(plane["direction"])) == (2, None, 2)
    assert plane["limit"] == pytest.approx(1.000070, abs=1e-6)
    law = granular.CIDR(granular.GLASS_BEADS.friction, granular.EXAMPLE_COMPACTION)
    says = granular.verdict(law, granular.BaseState(0.2, 0.55, 0.1), dim=3, lode=0.1)
    assert found["direction"] == list(says.direction)
    assert found["bound"] == says.bound
    assert found["limit"] < plane["limit"]


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        (["--dim", "4"], "dim must be an integer >= 2 and <= 3, got 4"),
        (["--lode", "0.1"], "lode must be left out where dim is 2"),
        (["--dim", "3", "--lode", "nan"], "lode must be a finite number, got nan"),
        (["--dim", "3", "--lode", "0.6"], "lode must be an angle between -pi/6 and pi/6"),
        (["--c", "0.1"], "c must be left out for the law cidr"),
    ],
)
def test_granular_options_out_of_place(capsys, more, sentence):
    code, out, err = run(capsys, *FLOW, *more)
    assert (code, out) == (2, "")
    assert sentence in err
    assert "Traceback" not in err


def test_cohesion_raises_the_yield_stress(capsys):
    """Y = c + mu p + 2 K ||D||."""
    flow = ["granular", "--law", "bingham", "--p", "0.2", "--I", "0.1", "--mu", "0.4", "--json"]
    tau, more = (json.loads(run(capsys, *flow, "--c", c)[1])["tau"] for c in ("0", "0.07"))
    assert more - tau == pytest.approx(0.07)


def test_as_a_module():
    command = [sys.executable, "-W", "error", "-m", "primer"]
    found = subprocess.run([*command, "verdict", "-"], input="u_t = -u_xx\n", capture_output=True, text=True)
    assert found.returncode == 0, found.stderr
    assert "ill-posed" in found.stdout
    assert subprocess.run([*command, "--version"], capture_output=True, text=True).stdout == (
        f"primer {primer.__version__}\n"
    )


def test_help_needs_no_numpy():
    """And the laws that the help names are those of the package."""
    code = "import sys; from primer.__main__ import _parser; _parser().format_help(); print('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"
    assert primer.base_state._LAWS == primer.granular.named.LAWS
