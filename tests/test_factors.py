"""Factors of determinants against the products that they were made of, and growth that scales with |xi|."""

from fractions import Fraction
from itertools import product

import mpmath as mp
import numpy as np
import pytest

from primer.analysis.factors import factors
from primer.analysis.roots import DIGITS
from primer.analysis.scales import homogeneity
from primer.analysis.symbolic import symbol

FLOW = """h_t + (u*h)_x + (v*h)_y = 0; u_t + u*u_x + v*u_y + h_x = 0; v_t + u*v_x + v*v_y + h_y = 0"""
AT = {"h": 0.7, "u": 0.1, "v": -0.3}


def multiplied(p, q):
    found: dict = {}
    for (a, c), (b, d) in product(p.items(), q.items()):
        powers = tuple(m + n for m, n in zip(a, b, strict=True))
        found[powers] = found.get(powers, 0) + c * d
    return {powers: c for powers, c in found.items() if abs(c) > 1e-60}


def of_reals(p):
    """The determinant in lambda and xi of a polynomial in lambda and d = i xi."""
    with mp.workdps(DIGITS):
        return {powers: mp.mpf(c.numerator) / c.denominator * mp.mpc(0, 1) ** sum(powers[1:])
                for powers, c in ((p, Fraction(c)) for p, c in p.items())}  # fmt: skip


def roots_at(D, xi):
    p = [0j] * (1 + max(n for n, *_ in D))
    for (n, a, b), c in D.items():
        p[n] += complex(c) * xi[0] ** a * xi[1] ** b
    return np.roots(p[::-1])


ADVECTED = {(1, 0, 0): 1, (0, 1, 0): Fraction(1, 3), (0, 0, 1): Fraction(-7, 5)}
WAVES = {(2, 0, 0): 1, (0, 2, 0): -2, (0, 0, 2): -3, (0, 0, 0): 1}
HEAT = {(1, 0, 0): 3, (0, 2, 0): -1, (0, 0, 2): Fraction(1, 7)}


@pytest.mark.parametrize("parts", [(ADVECTED, WAVES), (ADVECTED, ADVECTED, HEAT), (WAVES, HEAT), (WAVES,)])
def test_each_factor_is_found_once(parts):
    whole = {(0, 0, 0): 1}
    for part in parts:
        whole = multiplied(whole, part)
    with mp.workdps(DIGITS):
        found = factors({p: c * mp.mpc(2, 1) / 3 for p, c in of_reals(whole).items()})  # a common factor matters not
    distinct = [part for n, part in enumerate(parts) if part not in parts[:n]]
    assert len(found) == len(distinct)
    for xi in ((0.3, 1.7), (-2.0, 0.9)):
        expected = np.concatenate([roots_at(of_reals(part), xi) for part in distinct])
        got = np.concatenate([roots_at(part, xi) for part in found])
        assert np.abs(expected[:, None] - got).min(axis=0).max() < 1e-12
        assert np.abs(expected[:, None] - got).min(axis=1).max() < 1e-12


def test_what_is_not_rational_stays_whole():
    with mp.workdps(DIGITS):
        surd = {(2, 0, 0): mp.mpc(1), (0, 2, 0): -mp.sqrt(mp.mpf(2))}
        complex_one = {(2, 0, 0): mp.mpc(1), (0, 1, 0): mp.mpc(1), (1, 0, 0): mp.mpc(1)}
    assert factors(surd) == [surd]
    assert factors(complex_one) == [complex_one]


def test_a_factor_without_a_time_derivative_is_left_out():
    pressure = "u_t = -p_x + u_xx + u_yy; v_t = -p_y + v_xx + v_yy; u_x + v_y = 0"
    (found,) = factors(symbol(pressure).determinant)
    assert max(n for n, *_ in found) == 1


def test_waves_and_vorticity_of_a_mean_flow_are_told_apart():
    found = factors(symbol(FLOW, at=AT, uniform=True).determinant)
    assert sorted(max(n for n, *_ in part) for part in found) == [1, 2]


@pytest.mark.parametrize(
    ("text", "power"),
    [
        (FLOW, 1),
        ("u_t = u_xx - 2*u_yy", 2),
        ("u_tt = u_xxx", Fraction(3, 2)),
        ("u_t = u_xx + u", None),
        ("u_t = u_x + v_xx; v_t = u_yy", None),
        ("u_txx = u_xx", 0),
    ],
)
def test_homogeneity(text, power):
    at = AT if text == FLOW else {}
    assert homogeneity(symbol(text, at=at, uniform=True).determinant) == power
