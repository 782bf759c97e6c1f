"""H(u), the Hilbert transform, and absD(u) in text: against symbols written down by hand."""

import math

import numpy as np
import pytest
import sympy as sp

from primer import PDE, PDEError, growth_laws, growth_rates, linearise, verdict
from primer.analysis.fitted import computed
from primer.analysis.symbolic import pencil

XI = np.array([-3.0, -0.5, 0.7, 20.0])


@pytest.mark.parametrize(
    ("text", "arguments", "rate"),
    [
        ("u_t = absD(u)/2", {}, lambda k: abs(k) / 2),
        ("u_t + u u_x + H(u_xx) = 0", {"at": {"u": 2}, "uniform": True}, lambda k: -2j * k - 1j * np.sign(k) * k**2),
        ("u_t + 2 u_x + H(u)_xx = 0", {}, lambda k: -2j * k - 1j * np.sign(k) * k**2),
        ("u_t = H(u_x) - absD(u)", {}, lambda k: 0 * k),  # H d/dx = |d/dx|
        ("u_t = H(H(u)) + u", {}, lambda k: 0 * k),
        ("u_t = absD(absD(u)) + u_xx", {}, lambda k: 0 * k),
        ("u_t = c*absD(2*u_x - u) + i*u", {"c": 3}, lambda k: 3 * abs(k) * (2j * k - 1) + 1j),
        ("u_t = u*H(u)", {"at": {"u": 2}, "uniform": True}, lambda k: -2j * np.sign(k)),  # Constantin, Lax & Majda
    ],
)
def test_growth_rates(text, arguments, rate):
    assert growth_rates(text, XI, **arguments)[:, 0] == pytest.approx(rate(XI), abs=1e-12)
    (entry,) = linearise(text, **arguments)
    assert [complex(entry.subs("xi", k)) for k in XI] == pytest.approx(list(rate(XI)), abs=1e-12)


@pytest.mark.parametrize(
    ("text", "arguments", "kind", "exponent", "coefficient", "bound"),
    [
        ("u_t = absD(u)/2", {}, "ill-posed", 1, 0.5, math.inf),
        ("u_t + u u_x + H(u_xx) = 0", {"at": {"u": 2}, "uniform": True}, "well-posed", 0, 0, 0),
        ("u_t + H(u_xx) = absD(u) + u_xx", {}, "well-posed", 2, -1, 0.25),
        ("h_t = w; w_t = absD(h_xx) + absD(absD(h))/4 - 0*h", {}, "well-posed", 0, 0, (1 / 432) ** 0.5),
        ("u_t = absD(u) - v_y; v_t = absD(v) - u_y", {}, "ill-posed", 1, 1, math.inf),
        ("u_t = -absD(u) + u_xy", {}, "ill-posed", 2, 0.5, math.inf),
        ("u_t = u_xxx + absD(u) + u_yyyy - 2*u_xxxx", {}, "ill-posed", 4, 1, math.inf),
    ],
)
def test_verdicts(text, arguments, kind, exponent, coefficient, bound):
    found = verdict(text, **arguments)
    assert (found.kind, found.exact) == (kind, "_y" not in text and "_xy" not in text)
    assert abs(found.exponent - exponent) <= max(found.uncertainty, 1e-12)
    assert found.coefficient == pytest.approx(coefficient, rel=1e-6, abs=1e-9)
    assert found.bound == pytest.approx(bound, abs=1e-9)


def test_what_cannot_be():
    for text in ("u_t = H(u^2)", "u_t = absD(x*u)", "u_t = H(u) + u_yy"):
        with pytest.raises(PDEError, match="H"):
            verdict(text, at={"u": 1, "x": 1}) if "^2" in text else verdict(text)
    with pytest.raises(PDEError, match="look everywhere at once"):
        PDE("u_t = -absD(u)", {"u": "sin(x)"})
    with pytest.raises(ValueError, match="no Newton polygon"):
        growth_laws("u_t = absD(u)")
    with pytest.raises(PDEError, match=r"H\(u\)"):
        verdict("u_t = u*H(u)", at={"u": 1})


def test_an_unknown_may_be_called_H():
    assert sp.expand(linearise("H_t = H_xx")[0] + sp.Symbol("xi") ** 2) == 0
    with pytest.raises(PDEError, match="two ways"):
        linearise("H_t = H(x)_x; u_t = u_x")
    assert linearise("u_t = H*(u_xx)", H=2) == linearise("u_t = 2*u_xx")


@pytest.mark.parametrize("seed", range(12))
def test_verdicts_on_half_lines_are_those_that_are_computed(seed):
    """A second route: the same symbol as a pencil of numbers, whose law is fitted."""
    chance = np.random.default_rng(seed)
    c = [round(float(x), 2) for x in chance.normal(size=4)]
    i = "i*" * (seed % 3 == 0)
    text = f"u_t = {c[0]}*absD(u) + {i}{c[1]}*H(u)_xx + {c[2]}*u_xx + v; v_t = {c[3]}*H(v_x) - u"
    found, fit = verdict(text), computed(pencil(text))
    assert (found.kind, found.exact, fit.exact) == (fit.kind, True, False)
    assert float(found.exponent) == pytest.approx(float(fit.exponent), abs=1e-6)
    assert found.coefficient == pytest.approx(fit.coefficient, rel=1e-5)
    assert found.bound == fit.bound or found.bound == pytest.approx(fit.bound, rel=1e-6)


@pytest.mark.parametrize(
    ("text", "kind", "direction", "bound"),
    [
        ("u_t = i*H(u)_xx", "ill-posed", -1, math.inf),  # lambda = -sign(xi) xi^2
        ("u_t = -i*H(u)_xx", "ill-posed", 1, math.inf),
        ("u_t = i*H(u)/3 + u_xx", "well-posed", None, 1 / 3),  # sign(xi)/3 - xi^2
        ("u_t = i*H(u)/3 - absD(u)", "well-posed", None, 1 / 3),
    ],
)
def test_half_lines_may_differ(text, kind, direction, bound):
    found = verdict(text)
    assert (found.kind, found.exact) == (kind, True)
    assert found.bound == pytest.approx(bound)
    assert direction is None or found.direction == (direction,)


def test_a_narrow_resonance_beside_a_modulus_is_found():
    """Growth by e in a band of width e about |xi| = 0.85: no scan sees it."""
    found = verdict("u_t = i*absD(u) + e*v; v_t = -i*absD(v) + 1.7*i*v + e*u", e=1e-7)
    assert found.bound == pytest.approx(1e-7, rel=1e-6)
