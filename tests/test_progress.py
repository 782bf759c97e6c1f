"""Guards the bars of long runs: silent where nobody looks, and no bit of a march depends on them."""

import io
import sys

import numpy as np
import pytest

from primer import FOURIER, PDE, RK4, RK8, Toy, exact_march, ftcs, march_lines, reference
from primer.schemes import lines_block, progress
from primer.schemes.grid import CENTRAL
from primer.schemes.lines import trace
from primer.study.contestants import contestants
from primer.study.cost import cost_against_n, work_precision

MARCHES = {
    "ftcs": lambda **options: ftcs(Toy(1.5), n=30, t_end=20.0, **options),
    "march_lines": lambda **options: march_lines(Toy(1.5), 30, 1e-3, 20.0, **options),
    "in NumPy": lambda **options: march_lines(Toy(1.5), 256, 0.01, 2.0, FOURIER, **options),
    "reference": lambda **options: reference(Toy(1.5), 20.0, **options),
    "of a text": lambda **options: reference(PDE("u_t = u_xx", {"u": "sin(x)"}), 1.0, **options),
    "exact_march": lambda **options: exact_march(Toy(1.5), n=16, t_end=1.0, digits=30, **options),
}
every = pytest.mark.parametrize("march", MARCHES.values(), ids=MARCHES)


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def impatient(monkeypatch):
    monkeypatch.setattr(progress, "_PATIENCE", 0.0)
    monkeypatch.setattr(lines_block, "PIECE", 20_000)


@every
def test_a_long_run_has_a_bar_on_a_terminal(march, impatient, monkeypatch):
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    march()
    assert "step" in terminal.getvalue()


def test_a_study_counts_its_methods(impatient, monkeypatch):
    (paper,) = [method for method in contestants() if method.name == "FTCS"]
    for study, options in ((work_precision, {"patience": 0.01, "repeats": 1}), (cost_against_n, {"ns": (20,)})):
        for wanted in (True, False):
            monkeypatch.setattr(sys, "stderr", terminal := Terminal())
            study(methods=[paper], progress=wanted, **options)
            assert ("method" in terminal.getvalue()) is wanted


@every
def test_who_wants_none_has_none(march, impatient, monkeypatch):
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    march(progress=False)
    assert terminal.getvalue() == ""
    monkeypatch.setattr(sys, "stderr", file := io.StringIO())
    march()
    assert file.getvalue() == ""


@pytest.mark.parametrize("piece", [1, 700, 20_000])
@pytest.mark.parametrize(
    "problem", [Toy(0.3), PDE("u_t = nu*u_xx + sin(t)*u_x", {"u": "cos(x)"}, nu=0.5)], ids=["toy", "in time"]
)
@pytest.mark.parametrize(("space", "time"), [(CENTRAL, RK4), (FOURIER, RK8)], ids=["central", "fourier"])
def test_pieces_change_no_bit(problem, space, time, piece, monkeypatch):
    counts, dt = np.array([0, 7, 0, 0, 31, 1, 0]), np.array([0.1, 0.003, 0.1, 0.2, 0.004, 0.01, 0.3])
    whole = trace(problem, 24, space, time, dt, counts)
    monkeypatch.setattr(lines_block, "PIECE", piece)
    for one, other in zip(trace(problem, 24, space, time, dt, counts), whole, strict=True):
        assert np.array_equal(one, other)
        assert np.isfinite(one).all()


def test_pieces_after_a_blow_up_are_left_out(monkeypatch):
    counts, dt = np.array([3, 40, 20]), np.array([1e-3, 10.0, 1e-3])
    whole = trace(Toy(1.5), 24, CENTRAL, RK4, dt, counts)
    monkeypatch.setattr(lines_block, "PIECE", 500)
    again = trace(Toy(1.5), 24, CENTRAL, RK4, dt, counts)
    for one, other in zip(again, whole, strict=True):
        assert np.array_equal(one, other, equal_nan=True)
    assert np.isfinite(whole[0][0]).all()
    assert np.isnan(whole[0][1:]).all()
    assert np.isinf(whole[1][1:]).all()
