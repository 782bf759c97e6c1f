"""Guards symbols with known coefficients: exact determinants, the pencils made of them, and the way back.

Second routes: Leibniz' sum over permutations in fractions, and coefficients drawn at random.
"""

import random
from fractions import Fraction
from itertools import permutations
from math import prod

import mpmath as mp
import numpy as np
import pytest

from primer import Pencil
from primer.analysis.determinant import determinant
from primer.analysis.recover import recovered
from primer.analysis.symbol import Symbol
from primer.equations.text import PDEError


def times(p, q):
    found = {}
    for one, a in p.items():
        for two, b in q.items():
            powers = tuple(m + n for m, n in zip(one, two, strict=True))
            found[powers] = found.get(powers, 0) + a * b
    return found


def expanded(entries, sign=-1):
    """The determinant as a sum over permutations, zeros kept; with sign=1 the permanent of the absolute values."""
    size = len(entries)
    total = {}
    for p in permutations(range(size)):
        odd = sum(p[i] > p[j] for i in range(size) for j in range(i, size))
        term = {(0, 0): sign**odd}
        for row, c in zip(entries, p, strict=True):
            entry = row[c]
            term = times(term, {powers: abs(a) for powers, a in entry.items()} if sign == 1 else entry)
        for powers, a in term.items():
            total[powers] = total.get(powers, 0) + a
    return total


def random_entries(draw, size):
    return [
        [
            {
                (draw.randint(0, 2), draw.randint(0, 1)): Fraction(
                    draw.choice([-3, -2, -1, 1, 2, 3]), draw.randint(1, 2)
                )
                for _ in range(draw.choice([0, 1, 1, 2, 3]))
            }
            for _ in range(size)
        ]
        for _ in range(size)
    ]


def test_determinants_of_polynomials_against_the_sum_over_permutations():
    draw = random.Random(21)
    cancelled = 0
    for n in range(60):
        entries = random_entries(draw, n % 4 + 1)
        expected = expanded(entries)
        cancelled += sum(value == 0 for value in expected.values())
        assert determinant(entries, 0) == {powers: value for powers, value in expected.items() if value != 0}
    assert cancelled
    assert determinant([], 0) == {(): 1}
    assert determinant([[{}, {}], [{}, {}]], 0) == {}
    assert determinant([[{(1,): 5}, {}], [{(2,): 7}, {}]], 0) == {}


def test_a_coefficient_cancels_relative_to_the_sum_of_its_terms():
    """Exactly at that share it is gone, and just below it stays."""
    draw = random.Random(22)
    for _ in range(20):
        entries = random_entries(draw, 3)
        most = expanded(entries, sign=1)
        for powers, value in determinant(entries, 0).items():
            share = abs(value) / most[powers]
            assert powers not in determinant(entries, share)
            assert determinant(entries, share * Fraction(999, 1000))[powers] == value


def random_symbol(draw, size, dim, orders=(0, 1), top=2):
    """Coefficients that double precision holds exactly; every unknown evolves."""

    def coefficient():
        return mp.mpc(draw.choice([-2, -1, 0.5, 1, 3]), draw.choice([0, 0, 1, -0.25]))

    def powers(n):
        a = draw.randint(0, top)
        return n, a, draw.randint(0, top) if dim == 2 else 0

    entries = [
        [{powers(draw.choice(orders)): coefficient() for _ in range(draw.randint(0, 2))} for _ in range(size)]
        for _ in range(size)
    ]
    for n in range(size):
        entries[n][n][powers(draw.choice(orders[1:]))] = coefficient()
    return Symbol(tuple(map(tuple, entries)), dim)


def value(symbol, lam, *xi):
    """det M(lambda, xi) from the numbers of its entries."""
    i = mp.mpc(0, 1)
    factors = [lam, *(i * x for x in xi), mp.mpf(1)]

    def term(powers, c):
        return c * prod(f**p for f, p in zip(factors, powers, strict=False))

    return mp.det(mp.matrix([[mp.fsum(term(*t) for t in entry.items()) for entry in row] for row in symbol.entries]))


@pytest.mark.parametrize("dim", [1, 2])
def test_the_determinant_of_a_symbol_is_that_of_its_numbers(dim):
    draw = random.Random(23)
    for n in range(20):
        symbol = random_symbol(draw, n % 3 + 1, dim, orders=(0, 1, 2))
        point = [mp.mpc(draw.gauss(0, 1), draw.gauss(0, 1)) for _ in range(1 + dim)]
        x = [*point, mp.mpf(1)]
        with mp.workdps(50):
            found = sum(c * prod(x[m] ** powers[m] for m in range(1 + dim)) for powers, c in symbol.determinant.items())
            exact = value(symbol, *point)
            assert abs(found - exact) <= mp.mpf(10) ** -30 * (abs(exact) + 1)
        assert all(len(powers) == 3 and c != 0 for powers, c in symbol.determinant.items())


@pytest.mark.parametrize("dim", [1, 2])
def test_a_pencil_has_the_eigenvalues_at_which_the_symbol_is_singular(dim):
    """First, second and third time derivatives, also in one equation, and mixed with derivatives in space."""
    draw = random.Random(24)
    seen = 0
    for n in range(16):
        symbol = random_symbol(draw, n % 3 + 1, dim, orders=(0, 1, 2, 3) if n % 2 else (0, 1))
        if len({powers[0] for powers in symbol.determinant}) < 2:
            continue
        xi = [draw.uniform(0.5, 2) for _ in range(dim)]
        pencil = symbol.pencil()
        assert pencil.dim == dim
        assert pencil.count == max(powers[0] for powers in symbol.determinant)
        lam = pencil.eigenvalues(xi if dim == 2 else xi[0])
        with mp.workdps(30):
            p = [mp.mpc(0)] * (pencil.count + 1)
            for (m, *powers), c in symbol.determinant.items():
                p[m] += c * prod(mp.mpf(x) ** a for x, a in zip(xi, powers, strict=False))
            for z in map(mp.mpmathify, lam[abs(lam) > 1e-6]):  # the polynomial's value is rounding of its terms
                terms = [c * z**m for m, c in enumerate(p)]
                assert abs(mp.fsum(terms)) <= 1e-13 * mp.fsum(map(abs, terms))
            # Newton's sum of the roots, so that none is missed.
            assert abs(lam.sum() * p[-1] + p[-2]) <= 1e-10 * abs(p[-1]) * np.abs(lam).sum() + 1e-12 * abs(p[-2])
            seen += len(lam)
        xis = np.array([[0.3, -1.2], [2.0, 0.1]])[:, :, None] * np.ones(3)
        assert pencil.eigenvalues(xis if dim == 2 else xis[0]).shape == ((2, 3, pencil.count))
    assert seen > 20


def test_higher_time_derivatives_are_unknowns_of_their_own():
    """2 u_ttt + 3 u_tx + 5 v = 0 and 7 v_tt + u = 0, with the unknowns u, v, u_t, u_tt, v_t."""
    symbol = Symbol((({(3, 0, 0): 2, (1, 1, 0): 3}, {(0, 0, 0): 5}), ({(0, 0, 0): 1}, {(2, 0, 0): 7})))
    S, E = symbol.pencil().matrices(10.0)
    np.testing.assert_array_equal(
        S, [[0, 5, 30j, 0, 0], [1, 0, 0, 0, 0], [0, 0, -1, 0, 0], [0, 0, 0, -1, 0], [0, 0, 0, 0, -1]]
    )
    np.testing.assert_array_equal(
        E, [[0, 0, 0, 2, 0], [0, 0, 0, 0, 7], [1, 0, 0, 0, 0], [0, 0, 1, 0, 0], [0, 1, 0, 0, 0]]
    )


def test_a_multiplier_takes_the_place_of_each_derivative_and_is_asked_once():
    asked = []

    def multiplier(xi, m):
        asked.append((float(np.max(xi)), m))
        return 100.0**m * xi

    symbol = Symbol((({(1, 0, 0): 1, (0, 2, 1): 1, (0, 1, 0): 1, (0, 0, 0): 7, (0, 2, 0): 1, (0, 0, 1): 3},),), 2)
    pencil = symbol.pencil(multiplier)
    asked.clear()
    S, _ = pencil.matrices([2.0, 5.0])
    assert S.item() == 20000 * 500 + 200 + 7 + 20000 + 3 * 500
    assert sorted(asked) == [(2.0, 1), (2.0, 2), (5.0, 1)]
    S, _ = symbol.pencil().matrices([2.0, 5.0])
    assert S.item() == (2j) ** 2 * 5j + 2j + 7 + (2j) ** 2 + 15j


def test_a_singular_symbol_is_refused_in_one_sentence():
    sentence = (
        "the pencil is singular: det(lambda E + S) vanishes identically, so the equations do not determine the unknowns"
    )
    for entries in ((({(1, 0, 0): 1}, {}), ({(0, 1, 0): 2}, {})), (({(1, 0, 0): 1},) * 2,) * 2):
        with pytest.raises(PDEError) as caught:
            Symbol(entries).pencil()
        assert str(caught.value) == sentence


@pytest.mark.parametrize("dim", [1, 2])
def test_coefficients_come_back_from_a_pencil(dim):
    draw = random.Random(25)
    for n in range(24):
        symbol = random_symbol(draw, n % 3 + 1, dim, top=(1, 2, 3, 4, 7, 8)[n % 6])
        back = recovered(symbol.pencil())
        assert back.dim == dim
        for row, again in zip(symbol.entries, back.entries, strict=True):
            for entry, found in zip(row, again, strict=True):
                assert found == {powers: c for powers, c in entry.items() if c != 0}


def one_by_one(S, E=1.0):
    return Pencil(lambda xi: [[S(xi)]], lambda xi: [[E(xi) if callable(E) else E]], dim=1)


def test_only_polynomials_of_degree_8_or_less_come_back():
    assert recovered(one_by_one(lambda xi: xi**8 + 1)).entries == (({(0, 8, 0): 1, (0, 0, 0): 1, (1, 0, 0): 1},),)
    assert recovered(one_by_one(lambda xi: xi**8 + xi**2, lambda xi: 1 + xi)).entries[0][0].keys() == {
        (0, 8, 0), (0, 2, 0), (1, 0, 0), (1, 1, 0)
    }  # fmt: skip
    assert recovered(one_by_one(lambda xi: xi**9)) is None
    assert recovered(one_by_one(lambda xi: xi**2, lambda xi: 2 + np.sin(xi))) is None
    assert recovered(one_by_one(lambda xi: xi**2 + 1e-3 * np.sin(xi))) is None
    assert recovered(Pencil(lambda xi: [[xi[0] ** 2 + xi[1] ** 9]], [[1]], dim=2)) is None
    assert recovered(Pencil(lambda xi: [[xi[0] ** 9 + xi[1]]], [[1]], dim=2)) is None


def test_the_symbol_of_a_grid_is_not_a_polynomial_however_fine_the_grid():
    for h in (1e-5, 1e-4, 1e-3, 0.01, 0.0628, 0.1, 0.3, 1.0):
        assert recovered(one_by_one(lambda xi, h=h: (2 * np.sin(h * xi / 2) / h) ** 2)) is None, h
        assert recovered(one_by_one(lambda xi: xi**2, lambda xi, h=h: 1 + np.tanh(h * xi) ** 2)) is None, h
        assert recovered(Pencil(lambda k, h=h: [[k[0] ** 2 + np.cos(h * k[1])]], [[1]], dim=2)) is None, h


def test_a_small_leading_coefficient_is_kept():
    for size in (1e-3, 1e-6, 1e-9, 1e-11):
        back = recovered(one_by_one(lambda xi, size=size: xi**2 + 1 - size * xi**8)).entries[0][0]
        assert back.keys() == {(0, 0, 0), (0, 2, 0), (0, 8, 0), (1, 0, 0)}
        assert back[0, 8, 0].real == pytest.approx(-size, rel=3e-14 / size)  # against a largest one of 1


def test_coefficients_below_the_rounding_of_their_entry_are_left_out():
    kept, lost = 3e-12, 3e-13

    def S(xi):
        return [[1 + xi * (kept + 1j * lost), 0], [0, 2e-20 * xi + 1j * kept - lost * xi**2 * 1e-8]]

    back = recovered(Pencil(S, np.eye(2), dim=1)).entries
    assert back[0][0].keys() == {(0, 0, 0), (0, 1, 0), (1, 0, 0)}
    assert complex(back[0][0][0, 1, 0]) == pytest.approx(-1j * kept, rel=1e-3)
    assert back[0][0][0, 1, 0].real == 0
    assert back[1][1].keys() == {(0, 0, 0), (0, 1, 0), (0, 2, 0), (1, 0, 0)}
    assert back[1][1][0, 0, 0] == mp.mpc(0, "3e-12")
    third = recovered(one_by_one(lambda xi: xi / 3)).entries[0][0]
    assert third[0, 1, 0] == mp.mpc(0, "-0.3333333333333")  # 13 digits
