"""Three space variables: known systems, and eigenvalues with many digits at large |xi| in random directions."""

import math

import mpmath as mp
import numpy as np
import pytest

from primer import Pencil, growth_laws, growth_rates, linearise, max_growth, verdict
from primer.analysis.recover import recovered
from primer.analysis.symbolic import symbol
from primer.analysis.symmetry import axes_of_rotation

WELL, ILL = "well-posed", "ill-posed"
NAVIER_STOKES = """
u_t + u u_x + v u_y + w u_z = -p_x + nu*lap(u)
v_t + u v_x + v v_y + w v_z = -p_y + nu*lap(v)
w_t + u w_x + v w_y + w w_z = -p_z + nu*lap(w)
u_x + v_y + w_z = 0"""
MAXWELL = """
A_t = c^2*(R_y - Q_z); B_t = c^2*(P_z - R_x); C_t = c^2*(Q_x - P_y)
P_t = B_z - C_y; Q_t = C_x - A_z; R_t = A_y - B_x"""
CLEANED = (  # Maxwell's equations for E with div E = 0, which a pressure enforces
    "A_tt = c^2*lap(A) - q_x; B_tt = c^2*lap(B) - q_y; C_tt = c^2*lap(C) - q_z; A_x + B_y + C_z = 0"
)
ELASTIC = """
u_tt = mu*lap(u) + (lam + mu)*(u_xx + v_xy + w_xz)
v_tt = mu*lap(v) + (lam + mu)*(u_xy + v_yy + w_yz)
w_tt = mu*lap(w) + (lam + mu)*(u_xz + v_yz + w_zz)"""
KURAMOTO = "u_t + u*u_x + lap(u) + lap(lap(u)) = 0"
PRICE = "u_t = a*u_xx + b*u_yy + c*u_zz + d*u_xy + e*u_xz + f*u_yz + r*u_x - r*u"
AT = {"u": 1, "v": 2, "w": -3}


@pytest.mark.parametrize(
    ("text", "arguments", "kind", "exponent", "coefficient", "bound"),
    [
        (NAVIER_STOKES, {"at": AT, "uniform": True, "nu": 0.1}, WELL, 2, -0.1, 0),
        (NAVIER_STOKES, {"at": AT, "uniform": True, "nu": -0.1}, ILL, 2, 0.1, math.inf),
        (NAVIER_STOKES, {"at": AT, "uniform": True, "nu": 0}, WELL, 0, 0, 0),
        (MAXWELL, {"c": 3}, WELL, 0, 0, 0),
        (CLEANED, {"c": 3}, WELL, 0, 0, 0),
        (ELASTIC, {"mu": 1, "lam": 2}, WELL, 0, 0, 0),
        (ELASTIC, {"mu": 1, "lam": -3}, ILL, 1, 1, math.inf),  # lam + 2 mu = -1: pressure waves grow
        (KURAMOTO, {"at": {"u": 2}, "uniform": True, "space": "x, y, z"}, WELL, 4, -1, 0.25),
        ("u_t = u_xx + u_yy - 2*u_zz + u_x", {}, ILL, 2, 2, math.inf),
        ("u_tt = u_xx + u_yy - u_zz", {}, ILL, 1, 1, math.inf),
        ("u_tt = lap(u) - u_xz", {"space": "x, y, z"}, WELL, 0, 0, 0),  # |xi|^2 - xi_1 xi_3 > 0
        ("u_tt = lap(u) - 3*u_xz", {"space": "x, y, z"}, ILL, 1, 0.5**0.5, math.inf),  # 3/2 - 1 in (1, 0, 1)
    ],
)
def test_known_systems(text, arguments, kind, exponent, coefficient, bound):
    found = verdict(text, **arguments)
    assert (found.kind, found.exponent) == (kind, exponent)
    assert found.coefficient == pytest.approx(coefficient, rel=1e-9)
    assert found.bound == pytest.approx(bound, abs=1e-9)
    assert np.linalg.norm(found.direction) == pytest.approx(1)
    held_to_eigenvalues(found, symbol(text, **arguments))


def held_to_eigenvalues(found, exact):
    """The largest growth at 40 wavevectors, from the matrices with 50 digits, is no larger than the verdict says."""
    chance = np.random.default_rng(3)
    for n in range(40):
        d = chance.normal(size=3) if n % 4 else np.array(found.direction)
        d /= np.linalg.norm(d)
        k = 10.0 ** chance.uniform(2, 5)
        with mp.workdps(60):
            rate = many_digits(exact, k * d)
        law = found.coefficient * k ** float(found.exponent)
        most = found.bound if found.kind == WELL else law * (1 + 1e-2)
        assert rate <= most + 1e-12 * k**2 * 1e-8 + 1e-9
        if n % 4 == 0 and found.coefficient > 0:
            assert rate == pytest.approx(law, rel=1e-2)


def many_digits(exact, xi):
    """max Re lambda of det sum_n lambda^n M_n(xi): roots of the polynomial through its values at roots of unity."""
    size = len(exact.entries)
    xi = [mp.mpf(float(x)) for x in xi]
    scale = mp.norm(xi)
    highest = max(n for row in exact.entries for entry in row for n, *_ in entry) * size

    def det(z):
        M = mp.matrix(size, size)
        for r, row in enumerate(exact.entries):
            for c, entry in enumerate(row):
                for (n, *orders), value in entry.items():
                    M[r, c] += value * z**n * mp.fprod((1j * x) ** m for x, m in zip(xi, orders, strict=True))
        return mp.det(M)

    nodes = [scale * mp.expjpi(mp.mpf(2) * j / (highest + 1)) for j in range(highest + 1)]
    values = [det(z) for z in nodes]
    p = [
        mp.fsum(v * mp.expjpi(-mp.mpf(2) * j * m / (highest + 1)) for j, v in enumerate(values)) / (highest + 1)
        for m in range(highest + 1)
    ]  # of (lambda/scale)^m
    size = max(map(abs, p))
    while abs(p[-1]) < 1e-40 * size:
        p.pop()
    while abs(p[0]) < 1e-40 * size:
        p.pop(0)
    found = mp.polyroots(p[::-1], maxsteps=2000, extraprec=600) if len(p) > 1 else [mp.mpf(0)]
    return max(float(scale * z.real) if abs(z.real) > 1e-15 * abs(z) else 0.0 for z in found)


@pytest.mark.parametrize("seed", range(6))
def test_a_price_of_three_factors_is_well_posed_only_if_the_covariance_is_positive(seed):
    chance = np.random.default_rng(seed)
    L = chance.integers(-3, 4, (3, 3 - seed % 2))  # of full rank, or of rank 2
    A = L @ L.T + (np.diag([0, 0, -40]) if seed > 3 else 0)
    values = {"a": A[0, 0], "b": A[1, 1], "c": A[2, 2], "d": 2 * A[0, 1], "e": 2 * A[0, 2], "f": 2 * A[1, 2]}
    found = verdict(PRICE, r=0.05, **{name: int(value) for name, value in values.items()})
    least = np.linalg.eigvalsh(A)[0]
    assert found.exact
    assert found.kind == (ILL if least < -1e-9 else WELL)
    if abs(least) > 1e-9:
        assert (found.exponent, found.coefficient) == (2, pytest.approx(-least, rel=1e-9))
        d = np.array(found.direction)
        assert A @ d == pytest.approx(least * d, abs=1e-9 * abs(A).max())
    else:
        assert (found.exponent, found.coefficient) == (0, pytest.approx(-0.05))
    if found.kind == WELL:
        assert found.bound == pytest.approx(-0.05)


def test_where_there_is_no_symmetry_the_law_is_fitted():
    """-x^4 - y^4 - 3 z^4 on the unit sphere is at most -1/(1 + 1 + 1/3)."""
    found = verdict("u_t + u_xxxx + u_yyyy + 3*u_zzzz = u_xyz")
    assert (found.kind, found.exact, found.exponent) == (WELL, False, 4)
    assert found.coefficient == pytest.approx(-3 / 7, rel=1e-6)
    found = verdict("u_t + 2*u_xx + u_yy - u_zz = u_xyz")
    assert (found.kind, found.exact, found.exponent, found.coefficient) == (ILL, False, 2, pytest.approx(2))


def test_what_touches_zero_is_not_called_ill_posed():
    """|xi|^2 - 2 xi_1 xi_3 vanishes along (1, 0, 1), where the double root 0 is computed as 1e-8 |xi|."""
    assert verdict("u_tt = lap(u) - 2*u_xz", space="x, y, z").kind != ILL


def test_axes_of_rotation():
    def axes(text, **arguments):
        found = axes_of_rotation(symbol(text, **arguments).determinant)
        return [[float(x) for x in axis] for axis in found]

    assert len(axes("u_tt = u_xx + u_yy + u_zz")) == 3
    assert axes("u_tt = u_xx + u_yy + 2*u_zz") == [[0, 0, 1]]
    assert axes("u_tt = 3*u_xx + u_yy + 2*u_zz") == []
    # A frame that moves with the flow: convection alone turns nothing.
    assert len(axes("u_t + 2*u_x - u_y + 5*u_z = u_xx + u_yy + u_zz")) == 3
    (axis,) = axes("u_t + u_x + 2*u_y + 2*u_z = u_xxx + 2*u_xxy + 2*u_xxz + u_xyy + 2*u_yyy + 2*u_yyz + u_xzz + "
                   "2*u_yzz + 2*u_zzz")  # (1, 2, 2).grad of the Laplacian  # fmt: skip
    assert np.abs(axis) == pytest.approx([1 / 3, 2 / 3, 2 / 3])


def test_a_loss_that_the_determinant_does_not_show():
    """det = lambda^2 in every direction, yet along z alone something grows: like |xi| t."""
    found = verdict("u_t = v_z; v_t = 0*v_x + 0*u_y", space="x, y, z")
    assert (found.kind, found.loss) == (WELL, 1)


def test_pencils_laws_and_growth():
    waves = Pencil(lambda xi: [[0, -1], [xi[0] ** 2 + xi[1] ** 2 - 4 * xi[2] ** 2, 0]], np.eye(2), dim=3)
    assert recovered(waves).dim == 3
    found = verdict(waves)
    assert (found.kind, found.exponent, found.coefficient) == (ILL, 1, pytest.approx(2))
    assert np.abs(found.direction) == pytest.approx([0, 0, 1])
    top = max_growth(waves, [1.0, 1e6])
    assert top.direction.shape == (3, 2)
    assert top.growth == pytest.approx([2, 2e6])
    assert np.abs(top.direction[2]) == pytest.approx([1, 1])
    assert [b.coefficient.real for b in growth_laws(waves, (0, 0, 3))] == pytest.approx([2, -2])
    rates = growth_rates("u_t = u_xx + 2*u_yy + 3*u_zz", np.ones((3, 4, 5)))
    assert rates.shape == (4, 5, 1)
    assert rates.real == pytest.approx(-6)
    matrix = linearise("u_t = u_x + u_yy - u_zz")
    assert verdict(Pencil(-matrix, [[1.0]])).coefficient == pytest.approx(1)
    with pytest.raises(ValueError, match=r"xi must have shape \(3, ...\) for three space variables"):
        waves.eigenvalues([1.0, 2.0])


def test_the_largest_growth_in_an_unlucky_direction():
    d = np.array([0.3, -0.5, 0.81])
    d /= np.linalg.norm(d)
    narrow = Pencil(lambda xi: [[(np.tensordot(d, xi, 1) ** 2 / (xi**2).sum(axis=0)) ** 200 * -1.0]], [[1.0]], dim=3)
    found = max_growth(narrow, 7.0)
    assert found.growth == pytest.approx(1)
    assert abs(found.direction @ d) == pytest.approx(1)
