"""Guards the growth laws: the Newton polygon against closed forms and against multiprecision roots up to |xi| = 1e8."""

from fractions import Fraction

import mpmath as mp
import pytest
import sympy as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from primer import growth_laws
from primer.analysis.puiseux import branches, is_conservative
from primer.analysis.symbol import Symbol

DIGITS = 200  # of the second route: enough that a double root, or roots 70 decades apart, come out


def roots_at(P, k):
    """The roots of P(., k) by a library's solver; where that fails, at multiple ones, of its squarefree factors."""
    whole = {(i, j): (int(a.real), int(a.imag)) for (i, j), a in P.items()}
    degree = max(P)[0]
    p = [
        [sum(a[part] * k**j for (i, j), a in whole.items() if i == n) for part in (0, 1)] for n in range(degree, -1, -1)
    ]
    try:
        return mp.polyroots([mp.mpc(*c) for c in p], maxsteps=150, extraprec=mp.mp.prec)
    except mp.mp.NoConvergence:
        poly = sp.Poly([c[0] + sp.I * c[1] for c in p], sp.Symbol("lam"), extension=sp.I)
        factors = [([mp.mpmathify(c.evalf(DIGITS)) for c in f.all_coeffs()], m) for f, m in poly.sqf_list()[1]]
        return [z for f, m in factors for z in m * mp.polyroots(f, maxsteps=2000, extraprec=4 * mp.mp.prec)]


def value(branch, k):
    """The partial sum of a branch that is known."""
    return mp.fsum(c * mp.power(k, mp.mpf(q.numerator) / q.denominator) for q, c in branch.terms)


numbers = st.sampled_from([-3, -2, -1, 1, 2, 3])
complex_numbers = st.one_of(numbers, numbers, numbers.map(lambda n: n * 1j))


@st.composite
def symbols(draw):
    """Random pencils in one space variable: 1 to 3 fields, derivatives up to the third, some with constraints."""
    size = draw(st.integers(1, 3))
    entries = []
    for r in range(size):
        row = []
        for c in range(size):
            orders = draw(st.sets(st.integers(0, 3), max_size=2))
            entry = {(0, a, 0): mp.mpc(draw(complex_numbers)) for a in sorted(orders)}
            if (r == c and draw(st.integers(0, 5))) or (r != c and not draw(st.integers(0, 9))):
                entry[1, draw(st.sampled_from([0, 0, 0, 0, 2])), 0] = mp.mpc(draw(numbers))
            row.append(entry)
        entries.append(tuple(row))
    return Symbol(tuple(entries))


@settings(max_examples=25, deadline=None)
@given(symbols())
def test_laws_agree_with_multiprecision_eigenvalues(symbol):
    check_laws(symbol)


@pytest.mark.slow
@settings(max_examples=300, deadline=None)
@given(symbols())
def test_laws_agree_with_multiprecision_eigenvalues_at_length(symbol):
    check_laws(symbol)


def check_laws(symbol):
    """At |xi| = 1e2 ... 1e16 every branch is met by an eigenvalue, ever more closely, and so is the largest growth."""
    P = {(n, a): c for (n, a, _), c in symbol.determinant.items()}
    assume(P and max(P)[0] > 0)
    found = branches(P)
    assert sum(branch.multiplicity for branch in found) == max(P)[0]
    with mp.workdps(DIGITS):
        gaps, rates = [], []
        for k in (10**2, 10**5, 10**8, 10**16):
            left, gap = roots_at(P, k), mp.mpf(0)
            law, rate = found[0].law, max(z.real for z in left)
            for branch in sorted(found, key=lambda branch: -branch.exponent):
                for _ in range(branch.multiplicity):
                    nearest = min(left, key=lambda z, branch=branch, k=k: abs(z - value(branch, k)))
                    left.remove(nearest)
                    if branch.terms:
                        gap = max(gap, abs(nearest - value(branch, k)) / abs(value(branch, k)))
                    else:
                        assert abs(nearest) < mp.mpf(10) ** -100
            gaps.append(gap)
            size = mp.power(k, mp.mpf(law.exponent.numerator) / law.exponent.denominator)
            rates.append(abs(rate / size - law.coefficient) if law.coefficient else max(rate, 0))
        # The next term is smaller by k^(-1/6) at the least for these sizes and orders (usually by a whole power).
        assert gaps[2] < 0.3
        assert gaps[3] < max(1e-2 * gaps[1], mp.mpf(10) ** -60)
        assert rates[3] < max(0.05 * abs(found[0].law.coefficient), mp.mpf(10) ** -12)


HALF, THIRD = (1 + 1j) / 2**0.5, (1 + 3**0.5 * 1j) / 2


@pytest.mark.parametrize(
    ("text", "q", "coefficients"),  # all branches are c |xi|^q to leading order
    [
        ("u_t = u_xx", 2, [-1]),
        ("u_t = u_xxx - u_xx", 3, [-1j]),
        ("u_tt = u_xx", 1, [1j, -1j]),
        ("u_t = v; v_t = u_x", Fraction(1, 2), [HALF, -HALF]),
        ("u_t = v; v_t = w; w_t = u_xx", Fraction(2, 3), [THIRD, THIRD.conjugate(), -1]),
        ("u_t = 0*u_x", 0, [0]),
    ],
)
def test_leading_terms(text, q, coefficients):
    found = growth_laws(text)
    assert [branch.exponent for branch in found] == [q] * len(coefficients)
    for c in coefficients:
        assert min(abs(branch.coefficient - c) for branch in found) < 1e-15


@pytest.mark.parametrize("u", [1.5, -0.5, 2.0])
def test_toy_branches(u):
    """Eq. (toy-eig): lambda_1 ~ -eps u xi^2 and lambda_2 -> -1/(eps u)."""
    laws = growth_laws("u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)", at={"u": u, "v_xx": 0.3}, eps=0.01)
    laws = {branch.exponent: branch.coefficient for branch in laws}
    assert laws == {2: pytest.approx(-0.01 * u), 0: pytest.approx(-1 / (0.01 * u))}


def test_the_real_part_may_come_at_a_lower_order():
    (branch,) = growth_laws("u_t = u_xxx - u_xx")
    assert (branch.law.exponent, branch.law.coefficient) == (2, 1)
    assert [(q, complex(c)) for q, c in branch.terms] == [(3, -1j), (2, 1)]
    hidden = {(2, 0): 1, (1, 2): -2j, (0, 4): -1, (0, 1): -1}  # (lambda - i k^2)^2 = k
    assert [(b.law.exponent, b.law.coefficient) for b in branches(hidden)] == [
        (Fraction(1, 2), 1),
        (Fraction(1, 2), -1),
    ]


def test_conservative_systems_are_known_as_such():
    """The roots of lambda^2 + k^2 + k^4 - 1 are imaginary for every large k, though their expansion never ends."""
    P = {(2, 0): 1, (0, 2): 1, (0, 4): 1, (0, 0): -1}
    assert is_conservative(P)
    assert all(b.law.coefficient == 0 and b.multiplicity == 1 for b in branches(P))
    assert not is_conservative({**P, (1, 0): 1})
    assert [b.law.coefficient for b in branches({**P, (1, 0): 1})] == [-0.5, -0.5]


def test_no_polynomial_has_no_branches():
    assert branches({}) == []


def test_multiple_branches():
    (twice,) = branches({(2, 0): 1, (1, 2): 2, (0, 4): 1})  # (lambda + k^2)^2
    assert (twice.multiplicity, twice.exponent, twice.coefficient) == (2, 2, -1)
    waves = branches({(4, 0): 1, (2, 2): 2, (0, 4): 1})  # (lambda^2 + k^2)^2
    assert [(b.multiplicity, b.is_exact, b.law.coefficient) for b in waves] == [(2, True, 0), (2, True, 0)]
    split = branches({(2, 0): 1, (1, 2): 2, (0, 4): 1, (0, 3): -1})  # (lambda + k^2)^2 = k^3
    assert [(b.multiplicity, b.law.exponent) for b in split] == [(2, 2)]


@pytest.mark.parametrize("direction", [(0, 0), (1, 2, 3), "x", 1.0, (float("nan"), 1)])
def test_bad_directions(direction):
    with pytest.raises((ValueError, TypeError), match="direction"):
        growth_laws("u_t = u_xx + u_yy", direction)


def test_laws_along_a_direction():
    (law,) = growth_laws("u_t = u_xx + 3*u_xy + u_yy", (1, -1))
    assert (law.exponent, law.coefficient) == (2, pytest.approx(0.5))
    (law,) = growth_laws("u_t = u_xx + 3*u_xy + u_yy", (3, 4))
    assert law.coefficient == pytest.approx(-(9 + 36 + 16) / 25)
