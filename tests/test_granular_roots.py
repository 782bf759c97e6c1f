"""Guards the cubic, its growth at infinity and the search over directions: brute force on made-up coefficients."""

from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest

from primer.granular.dispersion import Delta, at, cubic, dispersion, growth_rate, growth_rates, rightmost, split
from primer.granular.fastest import _FAN, _REACH, _SCAN, fastest, flattest
from primer.granular.limits import leading, least_Delta, quotient_maximum
from primer.granular.linearisation import Coefficients
from primer.granular.posedness import _reason, _with_long_waves

NAMES = ("A", "B", "C", "Gamma", "t", "tau", "Y_phi", "f_phi", "D", "phi", "rho")
SCAN = np.linspace(-1, 1, 4001)


def made_up(n, seed, **fixed):
    """n sets of coefficients of either sign, the viscosities and densities positive."""
    rng = np.random.default_rng(seed)
    values = {name: rng.normal(size=n) for name in NAMES}
    for name in ("A", "t", "tau", "D", "phi", "rho"):
        values[name] = np.exp(values[name])
    return Coefficients(**{**values, **{name: np.broadcast_to(v, n) + 0.0 for name, v in fixed.items()}})


def some(c, index):
    """Some of the states."""
    return replace(c, **{name: getattr(c, name)[index] for name in NAMES})


def from_roots(r, s, t):
    """Coefficients of (lam - r)(lam - s)(lam - t) to the last digit, and the roots' largest real part."""
    with mp.workdps(60):
        r, s, t = (mp.mpmathify(v) for v in (r, s, t))
        return [float(mp.re(v)) for v in (-(r + s + t), r * s + r * t + s * t, -r * s * t)]


def triples(seed, n):
    rng = np.random.default_rng(seed)
    for _ in range(n):
        size = 10 ** rng.uniform(-6, 6, 3)
        r, s, t = size * rng.choice([-1.0, 1.0], 3)
        yield r, s, t
        yield r, complex(s, t), complex(s, -t)


def test_the_roots_of_a_cubic_each_to_full_relative_accuracy():
    """The digits that the coefficients, rounded, leave in the roots: roots from the same coefficients in 60 digits."""
    for roots in triples(0, 25):
        c2, c1, c0 = from_roots(*roots)
        with mp.workdps(60):
            exact = [complex(z) for z in mp.polyroots([1, c2, c1, c0], maxsteps=500, extraprec=300)]
        lead = np.random.default_rng(1).normal()
        r, b, q = split(lead, lead * c2, lead * c1, lead * c0)
        nearest = min(exact, key=lambda z: abs(z - r))
        others = list(exact)
        others.remove(nearest)
        assert r == pytest.approx(nearest.real, rel=1e-10)
        assert b == pytest.approx(-sum(others).real, abs=1e-10 * sum(map(abs, others)))
        assert q == pytest.approx((others[0] * others[1]).real, rel=1e-10)
        top = max(exact, key=lambda z: z.real)
        assert rightmost(lead, lead * c2, lead * c1, lead * c0) == pytest.approx(top.real, abs=1e-8 * abs(top))


@pytest.mark.parametrize(
    ("coefficients", "roots"),
    [
        ((1, 0, 0, 0), (0, 0, 0)),
        ((2, 4, 0, 0), (-2, 0, 0)),
        ((2, -4, 0, 0), (2, 0, 0)),
        ((1, 0, -4, 0), (-2, 0, 2)),
        ((1, 0, 4, 0), (-2j, 0, 2j)),
        ((1, 3, 2, 0), (-2, -1, 0)),
        ((1, -3, 2, 0), (0, 1, 2)),
        ((1, 0, 0, 8), (-2, 1 - 3**0.5 * 1j, 1 + 3**0.5 * 1j)),
        ((1, 0, 0, -8), (2, -1 - 3**0.5 * 1j, -1 + 3**0.5 * 1j)),
        ((1, 3, 3, 1), (-1, -1, -1)),
        ((1, -3, 3, -1), (1, 1, 1)),
        ((1, -5, 8, -4), (1, 2, 2)),
        ((-1, 6, -11, 6), (1, 2, 3)),
        ((1, 6, 11, 6), (-3, -2, -1)),
    ],
)
def test_repeated_roots_and_roots_at_zero(coefficients, roots):
    r, b, q = split(*coefficients)
    rest = np.roots([1, b, q])
    found = sorted([complex(r), *rest], key=lambda z: (z.real, z.imag))
    np.testing.assert_allclose(found, sorted(map(complex, roots), key=lambda z: (z.real, z.imag)), atol=2e-5)
    assert np.polynomial.polynomial.polyfromroots([r, *rest]) == pytest.approx(
        np.array(coefficients[::-1]) / coefficients[0], abs=1e-13
    )
    assert rightmost(*coefficients) == pytest.approx(max(complex(z).real for z in roots), abs=2e-5)


def test_without_a_cubic_term_two_roots_are_left_and_without_a_square_one():
    """c3 = 0: the lead is c2. c2 = 0 as well leaves lam^2 alone, as no viscosity at all would."""
    assert split(0, 2, -6, 4) == (-np.inf, -3, 2)
    assert rightmost(0, 2, -6, 4) == 2
    assert rightmost(0, 2, 6, 4) == -1
    assert rightmost(0, 1, 2, 5) == -1
    assert rightmost(0, 2, 0, 0) == 0
    assert split(0, 0, 3, 4) == (-np.inf, 3, 4)
    r, b, q = split([0, 1.0], 2, [[-6.0], [6.0]], 4)
    assert r.shape == b.shape == q.shape == (2, 2)
    assert (r[:, 0] == -np.inf).all()


def test_all_growth_rates_solve_the_characteristic_polynomial_rightmost_first():
    c = made_up(400, 2)
    rng = np.random.default_rng(3)
    k, x = 10 ** rng.uniform(-3, 3, 400), rng.uniform(-1, 1, 400)
    lam, (c3, c2, c1, c0) = growth_rates(c, k, x), cubic(c, k, x)
    assert lam.shape == (400, 3)
    assert (np.diff(lam.real, axis=1) <= 0).all()
    np.testing.assert_allclose(lam[:, 0].real, growth_rate(c, k, x), rtol=1e-9)
    # Vieta: the sums are compared with the size of their terms
    a, b, d = lam.T
    np.testing.assert_allclose(a + b + d, -c2 / c3, rtol=1e-11, atol=1e-11 * np.abs(lam).max())
    for ours, theirs, size in (
        (a + b + d, -c2 / c3, np.abs(lam).sum(axis=1)),
        (a * b + a * d + b * d, c1 / c3, np.abs(a * b) + np.abs(a * d) + np.abs(b * d)),
        (a * b * d, -c0 / c3, np.abs(a * b * d)),
    ):
        assert (np.abs(ours - theirs) <= 1e-9 * size).all()
    assert 30 < (np.abs(lam.imag).max(axis=1) > 0).sum() < 370
    np.testing.assert_allclose(lam.imag.sum(axis=1), 0, atol=1e-12 * np.abs(lam).max())


def test_an_incompressible_law_has_one_growth_rate_infinite_where_the_pressure_fails():
    one = np.ones(())
    c = Coefficients(0.3 * one, 1.25 * one, 0 * one, 0 * one, 2 * one, one, 0 * one, 0 * one, one, 0.5 * one, one, True)
    assert growth_rate(c, 3.0, -0.8) == np.inf
    x = np.array([-0.9, 0.1, 1.0])
    expected = -(3.0**2) / 0.5 * (2 * (x + 1.25) * x + 0.3 * (1 - x**2)) / (1 + 1.25 * x)
    np.testing.assert_allclose(growth_rate(c, 3.0, x), expected, rtol=1e-14)
    np.testing.assert_array_equal(growth_rates(c, 3.0, x), growth_rate(c, 3.0, x)[:, None] + 0j)


def test_Delta_is_its_polynomial_without_cancellation():
    c = made_up(300, 4)
    x = np.random.default_rng(5).uniform(-1, 1, 300)
    np.testing.assert_allclose(Delta(c, x), at(dispersion(c).Delta, x), rtol=1e-9, atol=1e-9)
    flat = replace(c, A=0 * c.A, C=c.B)
    close = -c.B * (1 + 1e-9)
    np.testing.assert_allclose(Delta(flat, close), c.t * (close + c.B) ** 2, rtol=1e-15)


def test_no_neighbour_of_a_scanned_direction_is_beyond_its_reach():
    """The maximum near the best scanned point is looked for up to the next ones, and not needlessly further."""
    rng = np.random.default_rng(6)
    for centre in [*rng.uniform(-1, 1, 300), -1.0, 0.0, 1.0]:
        x = np.concatenate([_SCAN, np.clip(centre + _FAN, -1, 1)])
        order = np.sort(x)
        left, right = (np.clip(x + reach, -1, 1) for reach in _REACH)
        before = order[np.maximum(np.searchsorted(order, x, "left") - 1, 0)]
        after = order[np.minimum(np.searchsorted(order, x, "right"), x.size - 1)]
        assert (left <= np.minimum(before, x) + 1e-16).all()
        assert (right >= np.maximum(after, x) - 1e-16).all()
    low, high = _REACH
    assert np.abs([low[:25], high[:25]]).max() <= np.pi / 24 * (1 + 1e-15)
    far = np.abs(_FAN)
    np.testing.assert_allclose(np.maximum(-low, high)[25:], np.where(far == 0, 1e-12, np.minimum(9 * far, np.pi / 24)))
    np.testing.assert_allclose(_FAN, -_FAN[::-1])
    assert set(np.round(np.log10(far[far > 0]))) == set(range(-12, 0))


@pytest.mark.parametrize(("A", "same"), [(None, False), (0.0, True)])
def test_the_fastest_direction_against_a_scan(A, same):
    c = made_up(60, 7, **({} if A is None else {"A": A}))
    c = replace(c, Gamma=np.abs(c.Gamma), **({"C": c.B} if same else {}))
    for k in (0.1, 3.0, 1e3):
        rate, x = fastest(c, k)
        scan = growth_rate(c, k, SCAN[:, None]).max(axis=0)
        size = np.abs(scan) + 1e-9
        assert (rate >= scan - 1e-11 * size).all()
        assert same or (rate <= scan + 1e-2 * size).all()  # A = 0 leaves windows of growth that a scan does not see
        np.testing.assert_allclose(growth_rate(c, k, x), rate, rtol=1e-9, atol=1e-12)
        assert (np.abs(x) <= 1).all()


def test_a_narrow_window_of_growth_is_found_wherever_it_is():
    """A = 0 and B = C, far out: |xi|^2 times a window about x = -B that no fixed scan would see."""
    B = np.random.default_rng(8).uniform(-0.99, 0.99, 200)
    c = replace(made_up(200, 9, A=0.0, Gamma=1.0, Y_phi=1.0, f_phi=0.0), B=B, C=B)
    for k in (1e3, 1e6, 1e9):
        rate, x = fastest(c, k)
        out = np.geomspace(1e-12, 1, 1000)
        scan = growth_rate(c, k, np.clip(-B + np.concatenate([-out, [0], out])[:, None], -1, 1)).max(axis=0)
        assert (rate >= scan * (1 - 1e-9)).all()
        np.testing.assert_allclose(growth_rate(c, k, x), rate, rtol=1e-9)


def test_the_fastest_growth_of_many_states_is_that_of_each():
    c = made_up(5000, 10)
    rate, x = fastest(c, 2.0)
    for j in (0, 1, 2046, 2047, 2048, 2049, 4095, 4096, 4999):
        alone = some(c, j)
        assert fastest(alone, 2.0) == (rate[j], x[j])
        assert np.shape(fastest(alone, 2.0)[0]) == ()
    k = np.array([[0.5], [2.0]])
    both = fastest(some(c, slice(3)), k)
    assert both[0].shape == both[1].shape == (2, 3)
    np.testing.assert_array_equal(both[0][1], rate[:3])
    assert fastest(some(c, slice(0)), 2.0)[0].shape == (0,)


def test_a_wavenumber_is_a_length_that_fits_the_states():
    c = made_up(3, 11)
    assert np.isfinite(fastest(replace(c, Gamma=np.abs(c.Gamma)), 1e20)[0]).all()
    for k, said in (
        (0.0, "k must be > 0 everywhere, being the length of the wavevector, got 0.0"),
        ([1.0, -1.0, 1.0], "k must be > 0 everywhere, being the length of the wavevector, got array([ 1., -1., 1.])"),
        ([1.0, 2.0], "k must have a shape that broadcasts against the states' (3,), got (2,)"),
        (1.1e20, "k must be <= 1e+20 everywhere, for its powers to be finite, got 1.1e+20"),
        (np.broadcast_to(1.0, (2**22, 3)), "k and the states must fit into 2 GiB of memory, got shape (4194304, 3)"),
    ):
        with pytest.raises(ValueError, match="must") as error:
            fastest(c, k)
        assert str(error.value) == said
    fastest(c, np.ones((1, 3)))


@pytest.mark.parametrize("sign", [1, -1])
def test_the_least_determinant_is_that_of_a_scan(sign):
    c = made_up(3000, 12)
    c = replace(c, C=np.where(np.arange(3000) % 3, c.C, c.B), A=np.where(np.arange(3000) % 5, c.A, c.t))
    values = sign * Delta(c, SCAN[::2, None])
    least, x = least_Delta(c, sign)
    size = c.t * (1 + np.abs(c.B)) * (1 + np.abs(c.C)) + c.A * (1 + c.t * np.abs(c.Gamma))
    assert (least <= values.min(axis=0) + 1e-14 * size).all()
    assert (least >= values.min(axis=0) - 1e-5 * size).all()
    assert (np.abs(sign * Delta(c, x) - least) <= 1e-14 * size).all()
    assert (np.abs(x) <= 1).all()
    if sign == 1:  # where to look for the fastest growth
        np.testing.assert_allclose(Delta(c, flattest(c)), least, atol=1e-13 * size.max())


def quotient_cases():
    rng = np.random.default_rng(13)
    n, d = rng.normal(size=(2, 3, 400))
    n[2, :100] = d[2, :100] = 0  # lines
    n[1, :50] = d[1, :50] = 0  # constants
    n[:, 100:130] = 0
    d[:, 130:200] = n[:, 130:200] * rng.normal(size=70)  # in proportion
    n[2, 200:230] = 0
    d[2, 230:260] = 0
    n[1, 260:290] = d[1, 260:290] = 0  # even
    d[0] = np.abs(d).sum(axis=0) + 0.01
    return n, d


@pytest.mark.parametrize(("low", "high"), [(-1.0, 1.0), (0.25, 0.5), (-2.0, -1.0)])
def test_the_maximum_of_a_quotient_of_quadratics_of_every_kind(low, high):
    n, d = quotient_cases()
    d[0] += 3 * (np.abs(d[1]) + np.abs(d[2]))
    value, x = quotient_maximum(n, d, low, high)
    scan = np.linspace(low, high, 4001)[:, None]
    best = (at(n, scan) / at(d, scan)).max(axis=0)
    size = np.abs(n).sum(axis=0) / d[0] * 16
    assert (value >= best - 1e-14 * size).all()
    assert (value <= best + 1e-5 * size).all()
    assert ((low <= x) & (x <= high)).all()
    assert (np.abs(at(n, x) / at(d, x) - value) <= 1e-14 * size).all()


def test_a_quotient_without_a_turning_point_is_largest_at_an_end():
    """Real zeros that interlace leave (n/d)' without any: d = (r - x)(x - s), n with one zero between."""
    rng = np.random.default_rng(18)
    r, s, u = rng.uniform(1.01, 3, 300), -rng.uniform(1.01, 3, 300), rng.uniform(-1, 1, 300)
    w = np.where(rng.random(300) < 0.5, r, s) * rng.uniform(1.01, 4, 300)
    sign = rng.choice([-1.0, 1.0], 300)
    n, d = sign * np.array([u * w, -u - w, 1 + 0 * u]), np.array([-r * s, r + s, -1 + 0 * r])
    value, x = quotient_maximum(n, d)
    ends = np.array([at(n, end) / at(d, end) for end in (-1.0, 1.0)])
    np.testing.assert_allclose(value, ends.max(axis=0), rtol=1e-13)
    np.testing.assert_array_equal(x, np.where(ends[0] > ends[1], -1.0, 1.0))
    assert set(x) == {-1, 1}


def test_where_the_denominator_vanishes_there_is_no_quotient():
    """(2 + x)/(1 - x^2): both ends are left out, and x = -2 -+ sqrt(3) are where it turns."""
    n, d = ([np.array([v]) for v in row] for row in ((2.0, 1.0, 0.0), (1.0, 0.0, -1.0)))
    value, x = quotient_maximum(n, d)
    assert x == pytest.approx(-2 + 3**0.5)
    assert value == pytest.approx(3**0.5 / (1 - (2 - 3**0.5) ** 2))


def test_growth_at_infinity_is_what_the_eigenvalues_do_whatever_the_coefficients():
    c = made_up(600, 14)
    gamma = np.where(np.arange(600) % 6, c.Gamma, 0.0)
    c = replace(c, Gamma=gamma)
    lead = leading(c)
    k = 1e7
    rate, x = fastest(c, k)
    ill, finite = lead.ill_posed, np.isfinite(lead.coefficient)
    assert (~ill).sum() > 50
    assert set(lead.exponent) == {0.0, 2.0}
    np.testing.assert_array_equal(ill, lead.exponent == 2)
    np.testing.assert_array_equal(np.isinf(lead.limit), ill)
    np.testing.assert_allclose(rate[ill & finite] / k**2, lead.coefficient[ill & finite], rtol=1e-6)
    T = dispersion(c).T
    np.testing.assert_array_equal(~finite, (c.Gamma == 0) & (np.abs(T[0]) <= np.abs(T[1])))
    assert (~finite).sum() > 10
    assert (finite & (c.Gamma == 0) & (T[0] < 0)).any()
    bounded = ~ill
    np.testing.assert_allclose(lead.limit[bounded], lead.coefficient[bounded])
    size = np.abs(lead.limit[bounded]) + 1
    assert (np.abs(rate[bounded] - lead.limit[bounded]) <= 1e-5 * size).all()
    apart = np.abs(x - lead.x)[ill & finite]
    assert np.median(apart) < 1e-6


def test_a_trace_that_vanishes_in_one_direction_leaves_no_bound_at_finite_wavenumber():
    """Gamma = 0 and B = C = 1: T = 2 + 2x is zero at x = -1."""
    one = np.ones(())
    c = Coefficients(*(v * one for v in (0.5, 1.0, 1.0, 0.0, 1.0, 1.0, 0.3, 0.2, 1.0, 0.6, 1.0)))
    lead = leading(c)
    assert (lead.exponent, lead.coefficient, lead.limit, lead.ill_posed) == (2, np.inf, np.inf, True)


def test_where_the_determinant_touches_zero_the_sign_of_N_decides():
    """A = 0 and B = C with |B| < 1: growth like |xi| where N < 0, and a bound where N > 0."""
    B = np.random.default_rng(15).uniform(-0.95, 0.95, 400)
    c = replace(made_up(400, 16, A=0.0), B=B, C=B)
    c = replace(c, Gamma=np.abs(c.Gamma))
    lead, N = leading(c), at(dispersion(c).N, -B)
    np.testing.assert_array_equal(lead.exponent, np.where(N < 0, 1.0, 0.0))
    np.testing.assert_array_equal(lead.ill_posed, N < 0)
    rate, _ = fastest(c, 1e8)
    up = N < 0
    np.testing.assert_allclose(rate[up] / 1e8, lead.coefficient[up], rtol=1e-4)
    np.testing.assert_allclose(lead.x[up], -B[up], rtol=1e-14)
    np.testing.assert_allclose(lead.coefficient[up], np.sqrt(-N[up] / (c.rho * at(dispersion(c).T, -B))[up]), rtol=1e-9)
    assert (lead.limit[up] == np.inf).all()
    down = ~up
    assert (np.abs(rate - lead.limit)[down] <= 1e-5 * (1 + np.abs(lead.limit[down]))).all()
    assert (np.isclose(lead.x, -B) & down).sum() > 20  # the pair that goes like +-i |xi| decides
    assert (~np.isclose(lead.x, -B) & down).sum() > 20  # the third growth rate does


def test_a_double_zero_of_N_at_the_touching_point_is_a_knife_edge():
    one = np.ones(())

    def states(B, Y_phi, f_phi, A=0.0, C=None, Gamma=1.0):
        values = (A, B, B if C is None else C, Gamma, 2.0, 1.0, Y_phi, f_phi, 1.5, 0.6, 1.7)
        return Coefficients(*(v * one for v in values))

    for B, Y_phi, f_phi in ((1.0, 0.0, 0.3), (-1.0, 0.0, 0.3), (0.0, 0.0, 0.3)):
        lead = leading(states(B, Y_phi, f_phi))
        assert np.isnan([lead.exponent, lead.coefficient, lead.limit]).all()
        assert not lead.ill_posed
        assert lead.x == -B
    for B, g in ((0.5, 0.3), (-0.3, 0.7), (0.9, -0.2)):
        c = states(B, 0.0, g)
        lead = leading(c)
        assert (lead.exponent, lead.x, lead.ill_posed, lead.limit) == (pytest.approx(2 / 3), -B, True, np.inf)
        assert fastest(c, 1e9)[0] / 1e6 == pytest.approx(lead.coefficient, rel=1e-2)
    c = states(0.75, 1.0, -0.25, A=1.0, C=-0.75, Gamma=0.0625)  # Delta = x^2, N = -x(1 + ...)
    lead = leading(c)
    np.testing.assert_array_equal(dispersion(c).Delta, [0, 0, 1])
    assert (lead.exponent, lead.x) == (pytest.approx(2 / 3), 0)
    assert fastest(c, 1e9)[0] / 1e6 == pytest.approx(lead.coefficient, rel=1e-2)
    still = leading(states(0.5, 0.0, 0.0))  # N = 0 for all x
    assert (still.exponent, still.ill_posed, still.limit) == (0, False, 0)


def test_an_incompressible_law_at_infinity():
    """n = A/t: growth t/R [(1 - n) T^2 - n] at x = -T. Neutral, that is 0; from |B| = 1 on unbounded, at x = -1/B."""
    B, A, t = np.array([0.6, -0.6, 1.25, -1.25]), np.array([0.1, 0.4, 0.3, 0.3]), np.array([1.0, 2, 3, 4])
    one = np.ones(4)
    c = Coefficients(A, B, 0 * one, 0 * one, t, one, 0 * one, 0 * one, one, 0.5 * one, 3 * one, True)
    lead, T = leading(c), 1 / 3  # tan(asin(0.6)/2)
    np.testing.assert_allclose(
        lead.coefficient[:2], [(0.9 * T**2 - 0.1) / 1.5, 2 / 1.5 * (0.8 * T**2 - 0.2)], atol=1e-15
    )
    np.testing.assert_array_equal(lead.limit, [-np.inf, -np.inf, np.inf, np.inf])
    np.testing.assert_allclose(lead.x, [-T, T, -0.8, 0.8], rtol=1e-14)
    assert (lead.coefficient[2:].tolist(), lead.exponent.tolist()) == ([np.inf] * 2, [2] * 4)
    np.testing.assert_array_equal(lead.ill_posed, [False, False, True, True])
    growing = leading(replace(c, A=0.5 * A))
    assert (growing.coefficient[0], growing.limit[0], growing.ill_posed[0]) == (
        pytest.approx((0.95 * T**2 - 0.05) / 1.5), np.inf, True,
    )  # fmt: skip
    still = leading(replace(c, A=0 * one, B=0 * one))  # no friction at all: neutral
    assert (still.limit.tolist(), still.ill_posed.tolist(), still.x.tolist()) == ([0] * 4, [False] * 4, [0] * 4)
    edge = leading(replace(c, B=np.array([1.0, -1, 1, -1])))
    assert (edge.coefficient.tolist(), edge.x.tolist()) == ([np.inf] * 4, [-1, 1, -1, 1])


def test_the_bound_is_the_growth_at_the_worst_finite_wavenumber():
    """Brute force over |xi| and direction, for bounded growth that long waves exceed."""
    c = made_up(400, 17)
    c = replace(c, Gamma=np.abs(c.Gamma), A=3 * c.A)
    lead = leading(c)
    c, limit = some(c, ~lead.ill_posed), np.maximum(lead.limit[~lead.ill_posed], 0)
    bound = _with_long_waves(c, limit)
    raised = bound > limit + 1e-9
    assert 4 < raised.sum() < raised.size - 20
    np.testing.assert_array_equal(bound[~raised], limit[~raised])
    for which in (raised, ~raised):
        few = some(c, np.flatnonzero(which)[:12])
        k = np.geomspace(1e-5, 1e5, 161)[:, None, None]
        scan = growth_rate(few, k, SCAN[::100, None]).max(axis=(0, 1))
        top = bound[which][:12]
        assert (top >= scan - 1e-6 * (1 + np.abs(scan))).all()
        if which is raised:
            np.testing.assert_allclose(top, scan, rtol=7e-2)
    given = np.array([np.inf, np.nan])
    np.testing.assert_array_equal(_with_long_waves(some(c, slice(2)), given), given)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((False, "undecided", np.nan, np.nan, np.nan, np.nan, 0.0),
         "the leading terms vanish together at a knife edge: the orders kept here do not decide"),
        ((True, "ill-posed", 2.0, np.inf, np.inf, np.inf, 0.5),
         "the growth is unbounded already at finite |xi|, at 60 degrees from the major compressive axis, "
         "because the pressure cannot keep div u = 0"),
        ((False, "ill-posed", 2.0, 1.25, np.inf, np.inf, 0.5**0.5),
         "the growth rate rises like 1.25 |xi|^2 at 45 degrees from the major compressive axis"),
        ((False, "ill-posed", 1.0, 0.5, np.inf, np.inf, 1.0),
         "the growth rate rises like 0.5 |xi| at 0 degrees from the major compressive axis"),
        ((False, "ill-posed", 2 / 3, 0.5, np.inf, np.inf, 0.0),
         "the growth rate rises like 0.5 |xi|^(2/3) at 90 degrees from the major compressive axis, "
         "a direction it drifts to"),
        ((True, "well-posed", 2.0, -1.0, -np.inf, 0.0, 0.0),
         "every direction is damped, or neutral, as |xi| -> infinity"),
        ((False, "well-posed", 0.0, 1.5, 1.5, 1.5, 0.5**0.5),
         "the largest growth rate tends to 1.5 as |xi| -> infinity, at 45 degrees from the major compressive axis: "
         "growth, but bounded"),
        ((False, "well-posed", 0.0, -1.5, -1.5, 0.0, 0.5**0.5),
         "the largest growth rate tends to -1.5 as |xi| -> infinity, at 45 degrees from the major compressive axis: "
         "damped"),
    ],
)  # fmt: skip
def test_the_reason_of_a_verdict_in_words(arguments, said):
    assert _reason(*arguments) == said
