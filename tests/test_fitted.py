"""Symbols that are not polynomials, judged by computation: against answers derived by hand from their formulas."""

import math

import numpy as np
import pytest

from primer import Pencil, verdict
from primer.analysis.places import growth_and_error, reach

WELL, ILL, UNDECIDED = "well-posed", "ill-posed", "undecided"
SECOND = np.eye(2)


def first(rate, dim=1):
    """The pencil of u_t = rate(xi) u."""
    return Pencil(lambda xi: [[-rate(xi)]], [[1.0]], dim)


def second(square, dim=1):
    """The pencil of u_tt = square(xi) u."""
    return Pencil(lambda xi: [[0, -1], [-square(xi), 0]], SECOND, dim)


def length(xi):
    return np.hypot(xi[0], xi[1])


def lists(k):
    """max Re lambda must be found where the sheet's speeds are +-1/2: lambda = +-xi/2 by two first-order equations."""
    return Pencil(lambda xi: [[0, -1j * np.abs(xi) / 2], [1j * np.abs(xi) / 2, 0]], SECOND, 1)


@pytest.mark.parametrize(
    ("pencil", "exponent", "coefficient"),
    [
        (first(lambda xi: np.abs(xi) / 2), 1, 0.5),  # a vortex sheet of jump 1: lambda = +-|xi|/2
        (lists(1), 1, 0.5),
        (second(lambda xi: xi**2 / 4 - 3 * np.abs(xi)), 1, 0.5),  # gravity does not cure it: sqrt(k^2/4 - 3k)
        (second(lambda xi: -9.81 * xi * np.tanh(0.3 * xi) + 2 * np.abs(xi) ** 3), 1.5, math.sqrt(2)),
        (first(lambda xi: np.abs(xi) ** 0.74), 0.74, 1),  # the fractional Laplacian with the wrong sign, s = 0.37
        (first(lambda xi: 1j * xi * np.abs(xi) + 0.2 * np.abs(xi) ** 0.5), 0.5, 0.2),
        (first(lambda xi: xi**4 / (1 + xi**2) - 1j * xi**3), 2, 1),
        (first(lambda xi: xi**2 * np.exp(-1j * xi) * 0 + 5 * np.abs(xi) ** (4 / 3)), 4 / 3, 5),
        (first(lambda xi: xi[0] * xi[1] / length(xi), 2), 1, 0.5),  # largest at 45 degrees
        (first(lambda xi: length(xi) ** 1.5 - xi[0] ** 2, 2), 1.5, 1),  # along y alone
        # det = l^2 + xi_1^2 l + xi_1 |xi|^(1/2): xi_1 = -c |xi|^(1/6), l = s |xi|^(1/3) with s^2 + c^2 s = c, largest
        # where 2 c s = 1: s^3 = 1/4
        (
            Pencil(lambda xi: [[0, -1j * xi[0]], [-1j * length(xi) ** 0.5, xi[0] ** 2]], SECOND, 2),
            1 / 3,
            0.25 ** (1 / 3),
        ),
    ],
)
def test_ill_posed(pencil, exponent, coefficient):
    found = verdict(pencil)
    assert (found.kind, found.exact, found.bound, found.loss) == (ILL, False, math.inf, math.inf)
    assert abs(found.exponent - exponent) <= max(found.uncertainty, 1e-12)
    assert 0 < found.uncertainty < 1e-3
    assert found.coefficient == pytest.approx(coefficient, rel=1e-4)
    assert found.unstable
    assert "not a proof" in found.reason


@pytest.mark.parametrize(
    ("pencil", "exponent", "coefficient", "bound"),
    [
        # Kelvin-Helmholtz with surface tension: l^2 = k^2/4 - k^3/10 is largest at k = 5/3, where it is 25/108
        (second(lambda xi: xi**2 / 4 - np.abs(xi) ** 3 / 10), 0, 0, math.sqrt(25 / 108)),
        (second(lambda xi: -9.81 * np.abs(xi)), 0, 0, 0),  # deep water
        (second(lambda xi: -9.81 * xi * np.tanh(0.3 * xi)), 0, 0, 0),  # of finite depth
        (first(lambda xi: 1j * xi * np.abs(xi)), 0, 0, 0),  # Benjamin-Ono
        (first(lambda xi: 1j * xi * np.abs(xi) + np.abs(xi) - xi**2), 2, -1, 0.25),  # k - k^2
        (first(lambda xi: -(np.abs(xi) ** 1.3)), 1.3, -1, 0),
        (first(lambda xi: -1j * xi / (1 + xi**2)), 0, 0, 0),  # Benjamin, Bona & Mahony
        (first(lambda xi: xi**2 / (1 + xi**2)), 0, 1, 1),
        (first(lambda xi: np.exp(-1j * xi) - xi**2), 2, -1, 1),  # cos k - k^2
        (first(lambda xi: np.exp(-(xi**2)) + 1j * xi), 0, 0, 1),
        (first(lambda xi: 2 * (np.cos(0.1 * xi) - 1) / 0.01), 0, 0, 0),  # heat on a grid, and backward heat
        (first(lambda xi: 2 * (1 - np.cos(0.1 * xi)) / 0.01), 0, 400, 400),
        (first(np.sin), 0, 1, 1),
        (second(lambda xi: xi[0] ** 2 - 0.1 * length(xi) ** 3, 2), 0, 0, math.sqrt(4 / 0.1**2 / 27)),
        (first(lambda xi: 1j * xi[0] / length(xi) - length(xi) ** 0.5, 2), 0.5, -1, 0),  # surface quasi-geostrophic
    ],
)
def test_well_posed(pencil, exponent, coefficient, bound):
    found = verdict(pencil)
    assert (found.kind, found.exact) == (WELL, False)
    assert abs(found.exponent - exponent) <= max(found.uncertainty, 1e-12)
    assert found.coefficient == pytest.approx(coefficient, rel=1e-6, abs=1e-9)
    assert found.bound == pytest.approx(bound, rel=1e-9, abs=1e-9)
    assert found.unstable == (bound > 0)
    assert math.isnan(found.loss)


@pytest.mark.parametrize(
    "rate",
    [
        lambda xi: np.abs(xi) / np.log(2 + np.abs(xi)),
        lambda xi: np.log(2 + np.abs(xi)),
        lambda xi: np.log(2 + np.log(1 + np.abs(xi))),
        lambda xi: np.exp(np.abs(xi)),
        lambda xi: xi * np.cos(xi),
        lambda xi: xi * np.exp(-1j * xi),
        lambda xi: xi**2 / (1 - xi**2),  # a pole at 1
        lambda xi: 1 / np.abs(xi),  # unbounded as |xi| -> 0
        lambda xi: xi**2 + np.abs(xi) ** (15 / 8),  # a power, but not seen yet in thirty decades
    ],
)
def test_undecided(rate):
    found = verdict(first(rate))
    assert (found.kind, found.exact, found.direction, found.unstable) == (UNDECIDED, False, (), False)
    assert all(map(math.isnan, (found.exponent, found.coefficient, found.bound, found.loss)))


def test_a_true_delay_between_flux_and_gradient_is_not_called_well_posed():
    """Dual-phase lag: l u(t + tau) = -k^2 u has l tau = W_n(-k^2 tau), whose real part grows like a logarithm."""
    special = pytest.importorskip("scipy.special")
    found = verdict(first(lambda xi: special.lambertw(-0.1 * xi**2) / 0.1))
    assert found.kind == UNDECIDED


def test_what_decays_by_no_power_is_well_posed():
    for rate, bound in ((lambda xi: -np.log(1 + xi**2), 0), (lambda xi: -np.exp(np.abs(xi)), -1)):
        found = verdict(first(rate))
        assert (found.kind, found.bound) == (WELL, pytest.approx(bound, abs=1e-9))
        assert math.isnan(found.exponent)


def test_the_growth_that_rounding_makes_counts_as_none():
    """A Jordan block hidden by a change of unknowns: i|xi|, twice, is computed with real parts of 1e-8 |xi|."""
    turn = np.array([[1.3, 0.4], [0.2, 0.7]])
    back = np.linalg.inv(turn)

    def S(xi):
        block = np.zeros((*np.shape(xi), 2, 2), dtype=complex)
        block[..., 0, 0] = block[..., 1, 1] = block[..., 0, 1] = 1j * np.abs(xi)
        return turn @ block @ back

    pencil = Pencil(S, SECOND, 1)
    rate, error = growth_and_error(pencil, np.array([1e3, 1e9]))
    assert (np.abs(rate) <= error).all()
    found = verdict(pencil)
    assert (found.kind, found.bound, found.coefficient) == (WELL, 0, 0)


def test_exact_where_the_symbol_is_a_polynomial():
    found = verdict(Pencil(lambda xi: [[xi**2]], [[1.0]], 1))
    assert (found.exact, found.uncertainty) == (True, 0)


def test_the_reach_ends_where_entries_are_no_numbers():
    assert reach(first(np.cosh), -16, 16) == (-16, 2)


def test_nested_lists_of_arrays_serve_many_wavevectors_at_once():
    asked = []

    def S(xi):
        asked.append(np.shape(xi))
        return [[0, -1], [xi**2, 0]]

    pencil = Pencil(S, SECOND, 1)
    asked.clear()
    assert pencil.eigenvalues(np.linspace(1, 2, 50)).shape == (50, 2)
    assert asked[-1] == (50,)
