"""Guards the door of the analysis, the granular laws and the commands: one sentence at once, and exit code 2."""

import inspect
import sys
from pathlib import Path

import numpy as np
import pytest
from hostile import (
    ARRAY,
    FUNCTION,
    HUGE,
    INTEGER,
    NOT_FINITE,
    POSITIVE,
    REAL,
    THING,
    complaints,
    in_time,
    little_memory,
)

import primer
import primer.granular as granular
import primer.study as study
from primer import Pencil, growth, growth_laws, growth_rates, linearise, max_growth, verdict
from primer.__main__ import main
from primer.analysis.symbolic import pencil, symbol
from primer.granular import CIDR, CSSM, Ansatz, BaseState, Compaction, Coulomb, Friction, IncompressibleMuI, MuI
from primer.granular.command import report
from primer.granular.equations import derive
from primer.granular.linearisation import linearise as linearise_law
from primer.granular.maps import growth_map, neutral_stress_ratio
from primer.granular.noise import noise_after
from primer.granular.proof import lemma_2

sys.path.insert(0, str(Path(__file__).parents[1] / "figures"))
import regenerate
import test_bad_input

PILE, BEADS = granular.EXAMPLE_COMPACTION, granular.GLASS_BEADS.friction
LAW, SOIL, STATE = CIDR(BEADS, PILE), CSSM(0.4, PILE), BaseState(0.2, 0.55, 0.1)
WAVE = Pencil(lambda xi: np.array([[0, -1j * xi], [-1j * xi, 0]]), np.eye(2))
PLANE = Pencil(lambda xi: [[xi[0] ** 2 + xi[1] ** 2]], [[1.0]])
MANY = np.ones(2 * 10**7)  # wavenumbers; their matrices would fill the memory


def not_numbers(given):
    """Whether it is no array of real numbers at all."""
    try:
        array = np.asarray(given)
    except ValueError:
        return True
    return (array.dtype.kind not in "iuf" and not isinstance(given, int)) or isinstance(given, bool)


FAR = (*ARRAY, 1e200, MANY)
LAWS = (*THING, CIDR, PILE)
WAVES = granular.PlaneWave(LAW, STATE)
STATES = (*THING, BaseState, PILE)
STATE_ARRAY = BaseState([0.1, 0.2], 0.55, 0.1)
SHAPES = (np.zeros((2, 3)), [1.0], np.zeros(0), "x", None, {}, object(), np.nan * np.eye(2), np.eye(13))
FLOW = {"p": 0.2, "phi": 0.55, "I": 0.1}
FRACTION = (*POSITIVE, 1.1)
NO_ARRAY = tuple(x for x in ARRAY if not_numbers(x))  # what is not finite has no pressure, and a reason
INERTIAL = (*ARRAY, -1.0, [0.1, -0.1])
OUTSIDE = (*ARRAY, 0.4, 0.6, 1.0, [0.55, 0.6])
NUMBERS = {"p": (*ARRAY, np.ones(3)), "phi": (*ARRAY, 0.4, 0.7), "I": INERTIAL}
PAIRS = {**FLOW, "phi": np.array([0.54, 0.55])}  # against which three numbers do not broadcast


def partials(law, names=("Y", "Y_p", "Y_phi", "Y_I", "f", "f_p", "f_phi", "f_I")):
    """A row of the table for each of a law's functions of (p, phi, I)."""
    bad = NUMBERS if not law.incompressible else NUMBERS | {"phi": ARRAY}
    return {f"{type(law).__name__}.{name}": (getattr(law, name), PAIRS, bad) for name in names}


TABLE = {
    "Pencil": (Pencil, {"S": np.eye(2), "E": np.eye(2), "dim": 1}, {
        "S": SHAPES, "E": SHAPES, "dim": ("1", b"1", True, 1j, [1], {}, 1.5, np.nan, 0, 4, HUGE, -HUGE),
    }),
    "Pencil.eigenvalues": (WAVE.eigenvalues, {"xi": 1.0}, {"xi": FAR}),
    "Pencil.matrices": (WAVE.matrices, {"xi": 1.0}, {"xi": FAR}),
    "Pencil.matrices, two variables": (PLANE.matrices, {"xi": [1.0, 2.0]}, {"xi": (*ARRAY, 1.0, [1.0, 2.0, 3.0], [])}),
    "growth": (growth, {"pencil": WAVE, "xi": 1.0}, {"pencil": (*THING, Pencil), "xi": FAR}),
    "max_growth": (max_growth, {"pencil": PLANE, "k": 1.0}, {"pencil": THING, "k": (*ARRAY, 0.0, -1.0, 1e200, MANY)}),
    "growth_laws": (
        lambda direction: growth_laws("u_t = u_xx", direction), {"direction": 1},
        {"direction": ("x", 1j, True, 0, [0], [1, 2], [], *NOT_FINITE, {}, object())},
    ),
    "growth_laws of": (
        lambda equations: growth_laws(equations), {"equations": "u_t = u_xx"}, {"equations": (None, 3, b"x", object())},
    ),
    "growth_rates": (
        lambda xi, **rest: growth_rates("u_t = c*u_xx", xi, **{"c": 1.0} | rest), {"xi": [1.0, 2.0]},
        {"xi": FAR, "order": ("x", None, 3, 1j, []), "multiplier": ("x", 3, 1j, [1.0]), "at": ("x", 3, [1], 1j),
         "c": (None, True, {}, np.nan, np.inf, object())},
    ),
    "verdict": (
        lambda **rest: verdict("u_t = c*u_xx", **{"c": 1.0} | rest), {},
        {"order": ("x", None, 3, 1j, []), "at": ("x", 3, [1], 1j), "c": (None, True, {}, np.nan, np.inf, object())},
    ),
    "verdict of": (
        lambda equations: verdict(equations), {"equations": "u_t = u_xx"},
        {"equations": (None, 3, b"x", object(), 1j, [], Pencil)},
    ),
    "linearise": (
        lambda equations, **rest: linearise(equations, **rest), {"equations": "u_t = u_xx"},
        {"equations": (None, 3, b"x", object(), WAVE), "order": ("x", None, 3, 1j, []), "at": ("x", 3, [1], 1j)},
    ),
    "symbol": (
        lambda equations, **rest: symbol(equations, **rest), {"equations": "u_t = u_xx"},
        {"equations": (None, 3, b"x", object(), WAVE), "order": ("x", None, 3)},
    ),
    "pencil": (
        lambda equations, **rest: pencil(equations, **rest), {"equations": "u_t = u_xx"},
        {"equations": (None, 3, b"x"), "multiplier": ("x", 3, 1j, [1.0])},
    ),
    "MuI": (MuI, {"mu1": 0.3, "mu2": 0.6, "I0": 0.3}, {
        "mu1": (*POSITIVE, 0.6), "mu2": (*REAL, 0.3, -1.0), "I0": POSITIVE,
    }),
    **{f"MuI.{name}": (getattr(BEADS, name), {"I": 0.1}, {"I": INERTIAL})
       for name in ("mu", "dmu", "ddmu", "alpha", "beta", "dalpha", "dbeta")},
    "Friction": (Friction, {"mu": BEADS.mu, "dmu": BEADS.dmu}, {"mu": FUNCTION, "dmu": FUNCTION}),
    **{f"Friction.{name}": (getattr(Friction(BEADS.mu, BEADS.dmu), name), {"I": 0.1}, {"I": (*INERTIAL, MANY)})
       for name in ("alpha", "beta", "dalpha", "dbeta")},
    "Compaction": (Compaction, {"phi0": 0.5, "eps": 0.1, "C0": 1.0}, {
        "phi0": (*POSITIVE, 1.0), "eps": (*POSITIVE, 0.6), "C0": POSITIVE,
    }),
    "Compaction.C": (PILE.C, {"phi": 0.55}, {"phi": OUTSIDE}),
    "Compaction.dC": (PILE.dC, {"phi": 0.55}, {"phi": OUTSIDE}),
    "Compaction.phi": (PILE.phi, {"C": 1.0}, {"C": (*ARRAY, -1.0)}),
    "Coulomb": (Coulomb, {"mu": 0.4}, {"mu": POSITIVE}),
    "RegularisedMuI": (granular.RegularisedMuI, {"mu1": 0.3, "mu2": 0.6, "I0": 0.3}, {
        "mu1": (*POSITIVE, 0.6), "mu2": (*REAL, 0.3, -1.0), "I0": POSITIVE, "mu_inf": POSITIVE, "alpha": POSITIVE,
    }),
    "MuIPhiI": (granular.MuIPhiI, {"friction": BEADS}, {
        "friction": (*THING, PILE), "phi_max": (*POSITIVE, 1.1), "slope": POSITIVE, "K": POSITIVE,
    }),
    "DruckerPrager": (granular.DruckerPrager, {"mu": 0.4, "K": 0.1}, {
        "mu": POSITIVE, "K": (*REAL, -1.0), "index": POSITIVE, "c": (*REAL, -1.0), "d": POSITIVE, "rho": POSITIVE,
    }),
    "TextLaw": (granular.TextLaw, {"Y_text": "p", "f_text": "0"}, {
        "Y_text": ("q*p", "p_x", 3, None, ""), "f_text": ("q", 3, None, "2i"),
        "parameters": ({"p": 1.0}, 3, {"a": 1.0}),
    }),
    "IncompressibleMuI": (IncompressibleMuI, {"friction": BEADS}, {"friction": (*THING, PILE)}),
    "CSSM": (CSSM, {"mu": 0.4, "compaction": PILE}, {"mu": POSITIVE, "compaction": (*THING, BEADS)}),
    "CIDR": (CIDR, {"friction": BEADS, "compaction": PILE}, {
        "friction": (*THING, PILE), "compaction": (*THING, BEADS),
    }),
    "Ansatz": (
        Ansatz, {"a": BEADS.alpha, "da": BEADS.dalpha, "b": BEADS.beta, "db": BEADS.dbeta, "compaction": PILE},
        {"a": FUNCTION, "da": FUNCTION, "b": FUNCTION, "db": FUNCTION, "compaction": THING},
    ),
    **partials(Coulomb(0.4)), **partials(IncompressibleMuI(BEADS)), **partials(SOIL), **partials(LAW),
    "CIDR.p_max": (LAW.p_max, {"phi": PAIRS["phi"], "I": 0.1}, {"phi": OUTSIDE, "I": (*INERTIAL, np.ones(3))}),
    "CIDR.p_critical": (LAW.p_critical, {"phi": PAIRS["phi"], "I": 0.1}, {
        "phi": OUTSIDE, "I": (*INERTIAL, np.ones(3)),
    }),
    "BaseState": (BaseState, {**FLOW, "d": 1.0, "rho": np.ones(2)}, {
        "p": (*ARRAY, 0.0, -1.0, [0.1, 0.0], np.ones(3)), "phi": (*ARRAY, 0.0, -1.0, 1.1),
        "I": (*ARRAY, 0.0, -1.0), "d": (*ARRAY, 0.0, -1.0), "rho": (*ARRAY, 0.0, -1.0),
    }),
    "BaseState.tau": (STATE.tau, {"law": LAW}, {"law": LAWS}),
    "BaseState.div_u": (STATE.div_u, {"law": LAW}, {"law": LAWS}),
    **{f"{function.__module__}.{function.__name__}": (
        function, {"law": LAW, "state": STATE},
        {"law": LAWS, "state": (*STATES, *(BaseState(p, phi, 0.1) for p, phi in ((9, 0.55), (0.2, 0.45), (0.2, 0.6))))},
    ) for function in (
        granular.admit, granular.coefficients, granular.conditions, granular.growth_limit, linearise_law,
        granular.verdict, derive,
    )},
    **{f"{function.__name__} in space": (function, {"law": LAW, "state": STATE, "dim": 3, "lode": 0.1}, {
        "dim": (*INTEGER, 1, 2, 4, 3.0, HUGE, [3]), "lode": (*ARRAY, 1, 4, 0.5237, -0.5237, [0.1, 0.6]),
    }) for function in (granular.verdict, granular.growth_limit)},
    "derive": (derive, {"law": LAW, "state": STATE, "order": "full"}, {
        "order": ("x", None, 3), "state": [STATE_ARRAY],
    }),
    "linearise_law": (linearise_law, {"law": LAW, "state": STATE}, {"state": [STATE_ARRAY]}),
    "largest_growth": (granular.largest_growth, {"law": LAW, "state": STATE_ARRAY, "k": 1.0}, {
        "law": LAWS, "state": STATES, "k": (*ARRAY, 0.0, -1.0, np.ones(3), 1e200, MANY),
    }),
    "critical_state": (granular.critical_state, {"law": LAW, "phi": 0.55, "I": 0.1, "d": 1.0, "rho": 1.0}, {
        "law": (*LAWS, Coulomb(0.4)), "phi": OUTSIDE, "I": (*ARRAY, 0.0, -1.0), "d": (*ARRAY, 0.0),
        "rho": (*ARRAY, -1.0),
    }),
    "incompressible_criterion": (granular.incompressible_criterion, {"friction": BEADS, "I": 0.1}, {
        "friction": (*THING, PILE), "I": (*INERTIAL,),
    }),
    "neutral_inertial_numbers": (granular.neutral_inertial_numbers, {"friction": BEADS, "low": 1e-3, "high": 1e3}, {
        "friction": (*THING, PILE), "low": (*POSITIVE, 1e4), "high": (*POSITIVE, 1e-4),
    }),
    "neutral_stress_ratio": (neutral_stress_ratio, {"friction": BEADS, "I": 0.1}, {"friction": THING, "I": INERTIAL}),
    "lemma_2": (lemma_2, {"friction": BEADS, "I": 0.1}, {"friction": THING, "I": INERTIAL}),
    "growth_map": (
        growth_map, {"law": LAW, "I": [0.1], "ratio": [0.2], "compaction": PILE, "phi": 0.55, "k": 1e4},
        {"law": LAWS, "I": (*ARRAY, 0.1, [-1.0], [0.0], MANY), "ratio": (*ARRAY, 0.1, [-1.0], MANY),
         "compaction": (*THING, BEADS), "phi": (*REAL, 0.4, 0.6), "k": (*POSITIVE, 1e200)},
    ),
    "noise_after": (
        noise_after, {"law": LAW, "state": STATE, "n": 8, "t": 0.1, "side": 200.0, "seed": 1, "smooth": 2.5},
        {"law": LAWS, "state": (*STATES, STATE_ARRAY), "n": (*INTEGER, 0, 2, 7, HUGE, 10**5), "t": (*POSITIVE, 1e300),
         "side": (*POSITIVE, 1e-300), "seed": ("x", None, -1, 1.5, 1j, []), "smooth": (*REAL, 1e300, -1e300)},
    ),
    "report": (
        report, {"law": "cidr", **FLOW},
        {"law": ("x", None, 3, []), "p": (*POSITIVE, 9.0), "phi": (*FRACTION, 0.6), "I": POSITIVE,
         "d": [x for x in POSITIVE if x is not None], "mu1": [x for x in POSITIVE if x is not None],
         "phi0": [x for x in POSITIVE if x is not None], "dim": (*INTEGER, 1, 4), "lode": (*REAL, 0.1)},
    ),
    **{f"{function.__name__}": (
        function, {"law": LAW, "div": 0.0, "D": 1.0, "phi": 0.55, "d": 1.0, "rho": 1.0},
        {"law": (*LAWS, Coulomb(0.4)), **dict.fromkeys(("div", "D", "phi"), NO_ARRAY), "d": ARRAY, "rho": ARRAY},
    ) for function in (granular.pressure, granular.stress)},
    "PlaneWave": (granular.PlaneWave, {"law": LAW, "state": STATE}, {
        "law": LAWS, "state": (*STATES, STATE_ARRAY), "angle": ("x", 1j, np.nan, [1.0]),
        "period": ("x", 0, -1.0, np.nan),
        "amplitude": REAL, "modes": (*INTEGER, 0),
    }),
    "march_waves": (granular.march_waves, {"problem": WAVES, "n": 8, "t_end": 1e-3}, {
        "problem": (*THING, LAW), "n": (*INTEGER, 0, HUGE), "t_end": POSITIVE,
    }),
    "mode_growth": (granular.mode_growth, {"run": granular.march_waves(WAVES, 8, 1e-3)}, {"run": (*THING, LAW)}),
    "stress_path": (granular.stress_path, {"law": LAW, "state": STATE, "strain": 0.1, "points": 4}, {
        "law": (*LAWS, Coulomb(0.4)), "state": (*STATES, STATE_ARRAY), "strain": POSITIVE,
        "points": (*INTEGER, 0, HUGE),
    }),
    "localise": (granular.localise, {"law": LAW, "state": STATE, "n": 8, "strain": 1e-3}, {
        "law": (*LAWS, Coulomb(0.4)), "state": (*STATES, STATE_ARRAY), "n": (*INTEGER, 0, HUGE), "strain": POSITIVE,
    }),
    "region": (
        lambda pde, vary, **rest: primer.region(pde, vary, **{"progress": False} | rest),
        {"pde": "u_t = c*u_xx", "vary": {"c": (-1, 1)}},
        {"pde": (None, 3, b"x", object()), "vary": ("c", None, 3, {}, {"c": 1}, {"c": (1, 1)}, {"c": (1, np.nan)}),
         "n": ("x", 0, 1.5, HUGE)},
    ),
    "conditions": (
        lambda text, **rest: primer.conditions(text, **rest), {"text": "u_t = c*u_xx"},
        {"text": (None, 3, b"x", object()), "at": ("x", 3, [1]), "order": ("x", None, 3), "check": ("x", -1, 1.5)},
    ),
}  # fmt: skip

#: Other names by which a sentence may speak of an argument.
STATE_SAYS = ["p", "phi", "state"]
CALLED = {name: {"state": STATE_SAYS, "law": ["state", "law"]} for name in TABLE}
CALLED["conditions"] = {"text": ["equations"]}
CALLED["region"] = {"pde": ["equations"], "vary": ["vary", "q", "c"]}
CALLED["max_growth"] = {"k": ["k", "xi"]}


@pytest.fixture(autouse=True)
def _little_memory():
    with little_memory():
        yield


@pytest.mark.parametrize("name", TABLE)
def test_what_cannot_be_used_gets_one_sentence(name):
    function, good, bad = TABLE[name]
    assert complaints(function, good, bad, CALLED.get(name)) == []


#: What is given back, or raised, and never called with arguments of one's own.
RESULTS = {"Diagnosis", "GridThreshold", "Lines", "MaxGrowth", "PDEError", "PastHorizon", "Reference", "Run", "Stop"}
RESULTS |= {
    "Verdict",
    "Examination",
    "Region",
    "Conditions",
    "NoPressure",
    "Stress",
    "PDE",
}  # tests/test_pde.py has the bad input of PDE


@pytest.mark.parametrize("room", [primer, granular, study], ids=lambda room: room.__name__)
def test_no_public_function_is_forgotten(room):
    rows = TABLE | test_bad_input.TABLE
    asked = {row[0] for row in rows.values()}
    wrapped = {name.split(" ")[0] for name, row in rows.items() if getattr(row[0], "__name__", "") == "<lambda>"}
    for name in room.__all__:
        thing = getattr(room, name)
        assert not callable(thing) or thing in asked or name in wrapped | RESULTS, name
        if inspect.isfunction(thing):
            bad = {argument for function, _, bad in rows.values() if function is thing for argument in bad}
            needed = [p for p in inspect.signature(thing).parameters.values() if p.default is p.empty]
            assert name in wrapped or {p.name for p in needed if p.kind is not p.VAR_KEYWORD} <= bad, name


LAW_AT = ["granular", "--law", "cidr", "--phi", "0.55", "--p", "0.2", "--I", "0.1"]
BAD_NUMBERS = ("x", "", "nan", "inf", "-inf", "1e999", "1j", "0", "-1", "None", "[1]", "1 2")
TEXTS = ("", " ", ";", "u_t", "u_t =", "= u", "u_t = u = u", "u_t = (u", "u_t = foo(u)", "u_t = a*u_xx", "u_t = 1/0")
TEXTS = (*TEXTS, "u_x = u", "u_t = u^99999", "u_t = 1e99999*u", "\0", "u_t = §", "u_t = " + "(" * 500)
TEXTS = (
    *TEXTS,
    "u_t = " + "u+" * 5000 + "u",
    "import os",
    "__import__('os')",
    "u_t = u_" + "x" * 50,
    "u_t = exp(exp(9999))*u",
)


@pytest.mark.parametrize(
    "arguments",
    [
        ["nonsense"],
        ["granular"],
        ["verdict"],
        *(["verdict", text] for text in TEXTS),
        *(["verdict", "u_t = c*u_xx", "--at", f"c={value}"] for value in ("x+", "", "nan", "inf", "1e999", "[1]")),
        ["verdict", "u_t = u", "--at", "u"],
        ["verdict", "u_t = u", "--at", "=1"],
        ["verdict", "u_t = u", "--order", "half"],
        *([*LAW_AT, f"--{name}", value] for name in ("p", "phi", "I", "d", "rho", "I0", "C0") for value in BAD_NUMBERS),
        *([*LAW_AT, f"--{name}", value] for name in ("mu1", "mu2", "eps") for value in BAD_NUMBERS),
        *([*LAW_AT, "--law", "coulomb", "--mu", value] for value in BAD_NUMBERS),
        [*LAW_AT, "--law", "ice"],
        [*LAW_AT, "--phi", "0.6"],
        [*LAW_AT, "--p", "1e308"],
    ],
    ids=lambda arguments: " ".join(arguments)[:50].encode("unicode_escape").decode(),
)
def test_commands_end_with_exit_2_and_say_nothing_else(arguments, capsys, monkeypatch):
    with in_time():
        try:
            code = main(arguments)
        except SystemExit as stopped:
            code = stopped.code
    out, err = capsys.readouterr()
    assert (code, out) == (2, "")
    assert "Traceback" not in err
    assert err.rstrip().splitlines()[-1]
    assert len(err) < 1500  # argparse shows how to call it, and an equation its place


@pytest.mark.parametrize(
    "arguments",
    [
        *(["--jobs", value] for value in ("0", "-1", "x", "", "1.5", "nan", "1e3")),
        *(["--formats", value] for value in ("", ",", "bmp", "svg,", "SVG", "svg png")),
        *([name] for name in ("", "fig99", "../fig31", "fig31.py", "\0", "sidecar")),
        *(["--out", value] for value in ("", "\0", "/proc/nowhere", __file__, f"{__file__}/below")),
    ],
    ids=lambda arguments: " ".join(arguments)[-30:].encode("unicode_escape").decode(),
)
def test_regenerate_ends_with_exit_2_and_writes_nothing(arguments, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    out = [] if "--out" in arguments else ["--out", str(tmp_path)]
    with in_time(), pytest.raises(SystemExit) as stopped:
        regenerate.main([*arguments, *out])
    said = capsys.readouterr()
    assert (stopped.value.code, said.out) == (2, "")
    assert "Traceback" not in said.err
    assert "got" in said.err or "invalid int value" in said.err
    assert list(tmp_path.iterdir()) == []
