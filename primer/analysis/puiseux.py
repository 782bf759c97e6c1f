"""Growth laws: the branches lambda(k) of a polynomial P(lambda, k) = 0 as k -> infinity, by the Newton polygon.

A polynomial is a dict {(i, j): a} standing for the sum of a lambda^i k^j; j may be a fraction.
"""

from collections import defaultdict
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import comb

import mpmath as mp

from primer.analysis.roots import DIGITS, ZERO, roots


@dataclass(frozen=True)
class Law:
    """Re lambda ~ coefficient k^exponent as k -> infinity; coefficient = 0 says that Re lambda vanishes.

    Laws are ordered by the size of Re lambda for large k.
    """

    exponent: Fraction
    coefficient: float

    @property
    def key(self):
        """What laws are ordered by; the first two members say which is faster whatever the coefficients' sizes."""
        sign = (self.coefficient > 0) - (self.coefficient < 0)
        return sign, sign * self.exponent, self.coefficient

    def __lt__(self, other):
        return self.key < other.key

    @property
    def is_bounded(self):
        """Whether Re lambda is bounded from above."""
        return self.coefficient <= 0 or self.exponent <= 0

    def __str__(self):
        q = self.exponent
        if not self.coefficient or not q:
            return f"Re lambda -> {self.coefficient:.6g}"
        power = "" if q == 1 else f"^{q}" if str(q).isdigit() else f"^({q})"
        return f"Re lambda ~ {self.coefficient:.6g} |xi|{power}"

    def is_near(self, other):
        """Whether the two are equal but for rounding of the coefficient."""
        slack = 1e-12 * abs(other.coefficient)
        near = self.key[:2] == other.key[:2] and abs(self.coefficient - other.coefficient) <= slack
        return near or self == other


@dataclass(frozen=True)
class Branch:
    """One branch lambda(k) = c_1 k^{q_1} + c_2 k^{q_2} + ... as k -> infinity, q_1 > q_2 > ...

    Attributes
    ----------
    terms : tuple of (q, c)    exponents (Fraction) and coefficients (complex, multiprecision), as far as was needed to
                               see the real part; empty for lambda = 0
    multiplicity : int         how many branches share these terms
    is_exact : bool            the terms are all there is
    law : Law                  the leading behaviour of Re lambda
    """

    terms: tuple
    multiplicity: int
    is_exact: bool
    law: Law

    @property
    def exponent(self):
        """q of the leading term c k^q; 0 where lambda = 0."""
        return self.terms[0][0] if self.terms else Fraction(0)

    @property
    def coefficient(self):
        """c of the leading term c k^q, as a complex number."""
        return complex(self.terms[0][1]) if self.terms else 0j


def branches(P, last=None):
    """All branches of P(lambda, k) = 0 for k -> infinity, each carried on until its real part is seen.

    Parameters
    ----------
    P : dict {(i, j): a}
    last : int      expansions are carried no further than k^last; by default so far that a real part which has not
                    shown by then is zero for good

    Returns
    -------
    list of Branch, the fastest growing first
    """
    with mp.workdps(DIGITS):
        P = {(i, Fraction(j)): mp.mpc(a) for (i, j), a in P.items()}
        if not P:
            return []
        last = far_enough(P) if last is None else last
        found = list(_expand(P, None, (), is_conservative(P), last))
    return sorted(found, key=lambda branch: branch.law, reverse=True)


def far_enough(P):
    """An exponent q such that Re lambda = o(k^q) on a branch of P means Re lambda = 0 on it.

    Let p be the irreducible factor that the branch belongs to, and p* its mirror image in the imaginary axis. Unless
    they are the same, their resultant is a polynomial in k, not zero, so at least of order k^0; it is also the product
    of all differences of their roots, 2 Re lambda among them, and of powers of the leading coefficient. Those have
    orders bounded by P's degree n in lambda, its largest exponent, and the degree in k of its leading coefficient.
    """
    hull = hull_of(P)
    n, degree = hull[-1]
    largest = max([0, *((j - j2) / (i2 - i) for (i, j), (i2, j2) in pairwise(hull))])
    return -(2 * n * degree + (n**2 - 1) * largest)


def is_conservative(P):
    """Whether the roots of P(., k) are symmetric about the imaginary axis for every real k."""
    top = max(P)
    ratio = mp.conj(P[top]) * (-1) ** top[0] / P[top]
    return all(abs(mp.conj(a) * (-1) ** i - ratio * a) <= ZERO * abs(a) for (i, _), a in P.items())


def _expand(P, above, terms, conservative, last):
    """Branches lambda = (terms) + mu of a polynomial P in mu and k, mu = o(k^above)."""
    hull = hull_of(P)
    if hull[0][0] > 0:  # mu = 0 is a root: the expansion ends here
        yield Branch(terms, hull[0][0], True, Law(Fraction(0), 0.0))
    for (i, j), (i2, j2) in pairwise(hull):
        q = (j - j2) / (i2 - i)
        if above is not None and q >= above:
            break
        edge = [P.get((n, j - q * (n - i)), mp.mpc(0)) for n in range(i, i2 + 1)]
        for c, multiplicity in roots(edge):
            longer = (*terms, (q, c))
            if abs(c.real) > ZERO * abs(c):
                yield Branch(longer, multiplicity, False, Law(q, float(c.real)))
            elif (conservative and multiplicity == 1) or q < last:
                # A simple branch that agrees with its mirror image in the imaginary axis is its mirror image.
                yield Branch(longer, multiplicity, False, Law(Fraction(0), 0.0))
            else:
                yield from _expand(shifted_by(P, 1j * c.imag, q, 0), q, longer, conservative, last)


def hull_of(P):
    """Vertices of the upper hull of the exponents (i, j) of P, from left to right."""
    top: dict = {}
    for i, j in P:
        top[i] = max(j, top.get(i, j))
    hull: list[tuple] = []
    for i in sorted(top):
        while len(hull) > 1 and _turns_left(hull[-2], hull[-1], (i, top[i])):
            hull.pop()
        hull.append((i, top[i]))
    return hull


def _turns_left(a, b, c):
    return (b[1] - a[1]) * (c[0] - b[0]) <= (c[1] - b[1]) * (b[0] - a[0])


def shifted_by(P, c, q, place):
    """P with the variable in this place of its exponents, z, replaced by c k^q + z; k is the variable in place 1."""
    terms = []
    for powers, a in P.items():
        for n in range(powers[place] + 1):
            m = powers[place] - n
            new = list(powers)
            new[place], new[1] = n, powers[1] + q * m
            terms.append((tuple(new), a * comb(powers[place], n) * c**m))
    return collected(terms)


def collected(terms):
    """The polynomial {powers: sum} of terms (powers, coefficient), without the sums that cancel."""
    value: dict = defaultdict(mp.mpc)
    size: dict = defaultdict(mp.mpf)
    for powers, a in terms:
        value[powers] += a
        size[powers] += abs(a)
    return {powers: a for powers, a in value.items() if abs(a) > ZERO * size[powers]}
