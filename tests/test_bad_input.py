"""Guards the door: whatever cannot be used gets one sentence at once, from problems, schemes and studies alike."""

import numpy as np
import pytest
from hostile import (
    ARRAY,
    FUNCTION,
    GRID,
    HUGE,
    INTEGER,
    LEAST_0,
    POSITIVE,
    RAGGED,
    REAL,
    THING,
    complaints,
    little_memory,
)

from primer import (
    CENTRAL,
    FOURIER,
    RK4,
    BackwardHeat,
    Seed,
    Toy,
    blow_up_map,
    cost_against_n,
    diagnose,
    exact_march,
    examine,
    ftcs,
    ftcs_ensemble,
    grid_threshold,
    heat_onset,
    march_lines,
    reference,
    refine,
    stable_dt,
    work_precision,
)
from primer.problems.heat import abs_sin_coefficients, abs_sin_log_norms, mode, scaled_amplitude
from primer.schemes.discrete import amplification, discrete_steady, dist_floor
from primer.schemes.grid import Grid
from primer.schemes.lines import stable_step
from primer.study.contestants import Method
from primer.study.cure import cut_off, fourth_derivative, march_back, recover
from primer.study.round_off import mirror_symmetric, one_ulp, precision_ladder, seed_ladder
from primer.study.spectrum import depth, fastest, growing, growth, jacobian
from primer.study.stability import amplification_over_modes, frozen_dt

TOY, HEAT, LIFELESS, X = Toy(1.5), BackwardHeat(), Toy(1.5, 0.0), np.linspace(-1.0, 1.0, 8)
TOYS = (*THING, Toy, HEAT)
MANY = [10**9 // 4 * 4]  # grids of which the first alone would fill the memory
SEQUENCE = ("x", None, 3, 1.5, 1j, object())
DTYPES = ("x", "int64", int, bool, complex, object, "float16", 3, [], None.__class__)
DIGITS = (1, 0, -1, 10**9, 2.5, "9", True, 1j, [9])
DT = (*POSITIVE, 1e-320, 1e-300)
SNAPSHOTS = (*SEQUENCE, ["x"], [None], [-1], [np.nan], [1e9], [HUGE], [1j], RAGGED)
SEEDS = ("x", 1j, [1, 2], (), (1,), (1, 2, 3, 4, 5), (1.5, 1), (-1, 1), (9999, 1), (1, "x"), (1, np.nan), (1, 1, "w"))
SEEDS = (*SEEDS, (1, 1, 5), object(), Seed)
RUN = {"n": GRID, "dt": DT, "t_end": LEAST_0}
MARCH = RUN | {
    "record_every": (0, -1, 1.5, "x", 1j, np.nan, [1]),
    "snapshots": SNAPSHOTS,
    "seed": SEEDS,
    "blow_up_at": (*POSITIVE, 1e300),
    "dtype": DTYPES,
    "digits": DIGITS,
}
SHORT = {"n": 8, "dt": 1e-2, "t_end": 0.1}
METHOD = Method("none", lambda toy, n, t_end: (Grid(n).x, TOY.initial(Grid(n).x), 0.1), (8,))
COST = {"toy": [x for x in TOYS if x is not None and not isinstance(x, BackwardHeat)], "t_end": (*POSITIVE, 1e15)}


def DECAY(fields, dt):
    return fields / (1 + dt)


TABLE = {
    "Toy": (Toy, {"a": 1.5, "eps": 0.01}, {"a": REAL, "eps": LEAST_0}),
    "Toy.initial": (TOY.initial, {"x": X}, {"x": ARRAY}),
    "Toy.steady": (TOY.steady, {"x": X}, {"x": ARRAY}),
    "Toy.forcing": (TOY.forcing, {"x": X}, {"x": ARRAY}),
    "Toy.exact": (LIFELESS.exact, {"x": X, "t": 1.0}, {"x": ARRAY, "t": (*ARRAY, [1.0, 2.0])}),
    "Toy.symbol": (
        TOY.symbol,
        {"xi": [1.0, 2.0], "u": 0.5, "v_xx": 0.1},
        {"xi": (*ARRAY, 1e200), "u": (*ARRAY, [1.0, 2.0, 3.0]), "v_xx": (*ARRAY, np.zeros((3, 3)))},
    ),
    "Toy.symbol on a grid": (
        lambda multiplier: TOY.symbol([1.0, 2.0], 0.5, multiplier=multiplier),
        {"multiplier": Grid(8).multiplier},
        {"multiplier": ("x", 3, 1j, [1.0])},
    ),
    "BackwardHeat": (BackwardHeat, {"xi": 1, "amplitude": 1.0}, {"xi": (*INTEGER, 0, HUGE), "amplitude": REAL}),
    "BackwardHeat.initial": (HEAT.initial, {"x": X}, {"x": ARRAY}),
    "BackwardHeat.steady": (HEAT.steady, {"x": X}, {"x": ARRAY}),
    "BackwardHeat.exact": (HEAT.exact, {"x": X, "t": 1.0}, {"x": ARRAY, "t": (*ARRAY, [1.0, 2.0])}),
    "BackwardHeat.symbol": (HEAT.symbol, {"xi": 1.0}, {"xi": (*ARRAY, 1e200)}),
    "mode": (mode, {"xi": 1.0, "x": X, "t": 1.0}, {"xi": ARRAY, "x": ARRAY, "t": (*ARRAY, np.zeros(3))}),
    "scaled_amplitude": (
        scaled_amplitude,
        {"xi": [1.0, 2.0], "t": 1.0, "p": 1.0},
        {"xi": (*ARRAY, 0.0, [1.0, 0.0]), "t": (*ARRAY, np.zeros(3)), "p": LEAST_0},
    ),
    "abs_sin_coefficients": (
        abs_sin_coefficients,
        {"p": 1.0, "m_max": 3},
        {"p": LEAST_0, "m_max": (*INTEGER, HUGE, 10**12)},
    ),
    "abs_sin_log_norms": (
        abs_sin_log_norms,
        {"p": 1.0, "t": 1.0, "m_max": 3},
        {"p": LEAST_0, "t": LEAST_0, "m_max": (*INTEGER, HUGE, 10**12)},
    ),
    "Grid": (Grid, {"n": 8}, {"n": GRID}),
    "Grid.derivative": (
        Grid(8).derivative,
        {"f": X, "m": 1},
        {"f": (*ARRAY, np.zeros(7), np.zeros((8, 7)), []), "m": (*INTEGER, 0, 13, HUGE)},
    ),
    "Grid.multiplier": (Grid(8).multiplier, {"xi": X, "m": 2}, {"xi": ARRAY, "m": (*INTEGER, 0, 13, HUGE)}),
    "Seed": (
        Seed,
        {"mode": 1, "amplitude": 1.0, "field": "u", "phase": 0.0},
        {"mode": INTEGER, "amplitude": REAL, "field": (None, 3, 1j, b"u", ["u"]), "phase": REAL},
    ),
    "Seed()": (Seed(1, 1.0), {"x": X}, {"x": ARRAY}),
    "discrete_steady": (
        discrete_steady,
        {"toy": TOY, "x": X, "h": 0.1},
        {"toy": TOYS, "x": ARRAY, "h": (*POSITIVE, 4.0)},
    ),
    "dist_floor": (dist_floor, {"n": 8}, {"n": GRID}),
    "amplification": (
        amplification,
        {"symbol": np.eye(2), "dt": 0.1},
        {
            "symbol": ("x", None, RAGGED, [], 1.0, [1.0, 2.0], np.zeros((2, 3)), np.nan * np.eye(2), {}, object()),
            "dt": POSITIVE,
        },
    ),
    "ftcs": (ftcs, {"problem": TOY, **SHORT}, {"problem": (*THING, Toy), **MARCH}),
    "ftcs, any problem": (ftcs, {"problem": HEAT, **SHORT}, MARCH),
    "ftcs_ensemble": (ftcs_ensemble, {"problems": [TOY], **SHORT}, {"problems": (*SEQUENCE, [3], [TOY, "x"]), **MARCH}),
    "march_lines": (
        march_lines,
        {"problem": TOY, **SHORT, "space": CENTRAL, "time": RK4},
        {"problem": (*THING, Toy), **RUN, "space": (*THING, {1: 2}, {}, CENTRAL[1]), "time": THING},
    ),
    "march_lines, Fourier": (march_lines, {"problem": TOY, **SHORT, "space": FOURIER}, RUN),
    "stable_step": (
        stable_step,
        {"toy": TOY, "n": 8, "space": CENTRAL, "time": RK4},
        {"toy": TOYS, "n": GRID, "space": THING, "time": THING},
    ),
    "reference": (
        reference,
        {"toy": TOY, "t": 0.5, "tol": 1e-6},
        {
            "toy": TOYS,
            "t": (*ARRAY, -1.0, [1.0, -1.0], [], [[1.0]], 1e15, 1e300, np.zeros(10**6)),
            "tol": (*POSITIVE, 1.0, 1e-300),
        },
    ),
    "Reference.at": (reference(TOY, 0.5, 1e-6).at, {"x": X}, {"x": ARRAY}),
    "refine": (refine, {"problem": TOY, "ns": [8], "dt": 1e-2, "t_end": 0.1}, {
        "problem": (*THING, Toy), "ns": (*SEQUENCE, [3], ["x"], [8.0], [8, HUGE], RAGGED, *map(list, [MANY])),
        "dt": [x for x in DT if not callable(x)], "t_end": LEAST_0, "seed": SEEDS, "snapshots": SNAPSHOTS,
        "dtype": DTYPES,
    }),
    "heat_onset": (heat_onset, {"ns": [8], "courant": 0.02, "tolerance": 1e-2, "sawtooth": 0.0}, {
        "ns": (*SEQUENCE, [3], [6], ["x"], [8.0], [HUGE], RAGGED, MANY),
        "courant": (*POSITIVE, 1e-300, 1e-12, 1e300),
        "tolerance": (*POSITIVE, 1e-300, 2.0),
        "sawtooth": (*LEAST_0, 1.0),
    }),
    "grid_threshold": (grid_threshold, {"a": 0.5, "eps": 0.01}, {
        "a": (*REAL, 1 - 1e-16), "eps": (*LEAST_0, 5e-324, 1e-300, 1e-14),
    }),
    "stable_dt": (stable_dt, {"problem": TOY, "n": 8, "u": 1.0}, {
        "problem": THING, "n": GRID, "u": (*(x for x in ARRAY if x is not None), []),
    }),
    "exact_march": (exact_march, {"toy": TOY, **SHORT}, {
        "toy": TOYS, **RUN, "digits": (0, -1, 2.5, "9", True, 1j, [9]), "record_every": (0, -1, 1.5, "x", [1]),
        "blow_up_at": POSITIVE,
    }),
    "examine": (examine, {"step": DECAY, "state": lambda n: np.ones((1, n)), "n": [8, 16]}, {
        "step": (None, 3, "x", lambda fields, dt: fields[..., 1:]),
        "state": (None, 3, "x", lambda n: np.ones(n + 1), lambda n: np.full((1, n), np.inf)),
        "n": (None, 3, "x", [], [0], [1.5]), "dt": (*POSITIVE,), "patience": (None, "x", -1, np.nan, 1j),
    }),
    "diagnose": (diagnose, {"problem": TOY, **SHORT}, {
        "problem": (*THING, Toy), **RUN, "n": (*GRID, 10**6), "seed": (*SEEDS, True, np.nan, np.inf, HUGE),
        "dtype": DTYPES, "digits": DIGITS,
    }),
    "blow_up_map": (
        lambda **options: blow_up_map(**options, progress=False),
        {"a_values": [1.5], "n_values": [8], "eps": 0.01, "t_end": 0.1, "dt": 1e-2, "seed": 1e-12},
        {
            "a_values": (*ARRAY, [1.5, 1.5]), "n_values": (*SEQUENCE, [3], [8, 8], ["x"], [8.0], [HUGE], RAGGED, MANY),
            "eps": LEAST_0, "t_end": LEAST_0, "dt": POSITIVE, "seed": (*POSITIVE,), "executor": ("x", 3, object()),
            "table": (3, 1.5, object(), 1j, b"x", [], "", ".", "/nowhere/map.csv"),
        },
    ),
    "work_precision": (
        work_precision,
        {"toy": TOY, "t_end": 0.1, "methods": [METHOD], "patience": 1.0, "repeats": 1},
        {**COST, "methods": (3, "x", ["x"], [None], object()), "patience": POSITIVE,
         "repeats": (*INTEGER, 0, HUGE, 10**9)},
    ),
    "cost_against_n": (
        cost_against_n,
        {"toy": TOY, "t_end": 0.1, "ns": [8], "methods": [METHOD], "seconds": 1e-9},
        {"toy": COST["toy"], "t_end": POSITIVE, "ns": (*SEQUENCE, [3], ["x"], [8.0], [HUGE]),
         "methods": (3, "x", ["x"], [None], object()), "seconds": POSITIVE},
    ),
    "frozen_dt": (frozen_dt, {"h": 0.1, "u": 1.0, "eps": 0.01}, {"h": POSITIVE, "u": ARRAY, "eps": LEAST_0}),
    "amplification_over_modes": (amplification_over_modes, {"toy": TOY, "n": 8, "dt": 0.1, "u": 1.0}, {
        "toy": TOYS, "n": GRID, "dt": POSITIVE, "u": REAL,
    }),
    "spectrum.jacobian": (jacobian, {"toy": TOY, "n": 8}, {"toy": TOYS, "n": (*GRID, 10**6)}),
    "spectrum.depth": (depth, {"toy": TOY, "n": 8}, {"toy": TOYS, "n": GRID}),
    "spectrum.fastest": (fastest, {"toy": TOY, "n": 8, "dt": 0.0}, {"toy": TOYS, "n": GRID, "dt": LEAST_0}),
    "spectrum.growing": (growing, {"toy": TOY, "n": 8, "dt": 0.0}, {"toy": TOYS, "n": GRID, "dt": LEAST_0}),
    "spectrum.growth": (growth, {"toy": TOY, "n": 8, "dt": 0.0}, {"toy": TOYS, "n": GRID, "dt": LEAST_0}),
    "precision_ladder": (
        precision_ladder, {"toy": TOY, **SHORT, "precisions": ["float32"]},
        {"toy": (*THING, Toy), **RUN, "precisions": (3, "x", ["x"], [3], object())},
    ),
    "seed_ladder": (
        seed_ladder, {"toy": Toy(-3.0), "n": 40, "dt": 1e-3, "t_end": 10.0, "amplitudes": [1e-6, 1e-4]},
        {"amplitudes": (*ARRAY, [1e-6], [-1e-6, 1e-6], [0.0, 1e-6], []), "mode": INTEGER[:3] + INTEGER[4:],
         "dt": DT, "field": ("w", 3), "toy": TOYS, "n": GRID, "t_end": LEAST_0},
    ),
    "one_ulp": (one_ulp, {"toy": TOY, **SHORT, "points": [0]}, {
        "toy": TOYS, **RUN, "points": (*SEQUENCE, ["x"], [8], [-9], [1.5], [HUGE]),
    }),
    "mirror_symmetric": (mirror_symmetric, {"toy": TOY, **SHORT}, {"toy": TOYS, **RUN, "blow_up_at": POSITIVE}),
    "cut_off": (cut_off, {"t": 0.1, "K": 3.0}, {"t": LEAST_0, "K": LEAST_0}),
    "fourth_derivative": (fourth_derivative, {"t": 0.1, "beta": 1.0}, {"t": LEAST_0, "beta": POSITIVE}),
    "march_back": (march_back, {"data": X, "multiplier": cut_off(0.1, 3.0)}, {
        "data": (*ARRAY, 1.0, []), "multiplier": FUNCTION,
    }),
    "recover": (
        recover, {"regularise": cut_off, "parameters": [2.0], "noise": [0.1], "t": 0.05, "n": 8, "seed": 0},
        {"regularise": FUNCTION, "parameters": (*ARRAY, [], 1.0), "noise": (*ARRAY, [], [-1.0], 1.0), "t": POSITIVE,
         "n": (*GRID, 7), "seed": ("x", -1, 1.5, 1j)},
    ),
}  # fmt: skip

#: Other names by which a sentence may speak of an argument.
CALLED = {"work_precision": {"t_end": ["t"]}}


@pytest.fixture(autouse=True)
def _little_memory():
    with little_memory():
        yield


@pytest.mark.parametrize("name", TABLE)
def test_what_cannot_be_used_gets_one_sentence(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    function, good, bad = TABLE[name]
    assert complaints(function, good, bad, CALLED.get(name)) == []
    assert list(tmp_path.iterdir()) == []  # nothing is written
