"""The fastest growth law over all directions in two space variables, directions that drift with |xi| included.

The largest growth at |xi| = k, as k -> infinity, is attained along some curve xi = k (d + tau k^{-r} d_perp + ...). The
curves to try are finite in number: tau is free and its law changes at *special* values only, where a vertex of the
Newton polygon vanishes, or branches meet, or one touches the imaginary axis. About each special direction the exponents
r to try are normals of facets of the Newton polytope in (lambda, k, tau).
"""

from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, pairwise

import mpmath as mp
import numpy as np

from primer.analysis.factors import factors
from primer.analysis.puiseux import Law, branches, collected, hull_of, shifted_by
from primer.analysis.roots import DIGITS, ZERO, resultant, roots

NOTHING = Law(Fraction(0), -float("inf"))  # of a direction in which nothing evolves
BEYOND = Fraction(1000)  # the exponent of a drift faster than any that the equations know: a limit taken first
DEPTH = 2  # drifts within drifts
LAST = -3  # terms of branches below k^LAST are left out
SAMPLES = 25  # values of tau to begin with
REAL = mp.sqrt(ZERO)  # relative imaginary part below which a root is real, and difference below which two are one


@dataclass(frozen=True)
class Worst:
    """The fastest law, the direction (a unit vector) it tends to, and the exponent r of the drift, 0 for none."""

    law: Law
    direction: tuple
    drift: Fraction


def worst_law(D, real, hints=(), inward=False):
    """The fastest law of det M = D(lambda, xi_1, xi_2), a polynomial {(n, a, b): c}, over all directions.

    ``real``: the equations have real coefficients, so that half of the directions tell all. ``hints`` are angles near
    which the coefficient may be largest. ``inward``: for xi -> 0, as a law in 1/|xi|. An exponent above BEYOND/20 says
    that growth is unbounded at every |xi|, near a direction in which the highest time derivative drops out.
    """
    found = []
    with mp.workdps(DIGITS):
        for sign in (1,) if real else (1, -1):
            out = -1 if inward else 1
            search = _Search(hints)
            for F in factors(D):
                along_x = {(n, Fraction(out * (a + b)), b): c * sign ** (a + b) for (n, a, b), c in F.items()}
                along_y = {(n, Fraction(out * (a + b)), a): c * sign ** (a + b) for (n, a, b), c in F.items()}
                search.family(along_x, Fraction(0), DEPTH, None)
                search.near(along_y, Fraction(0), DEPTH, mp.inf)
                for slope in (0, 1, -1):
                    search.add(search.law(along_x, Fraction(0), mp.mpf(slope)), mp.mpf(slope), Fraction(0))
            found += [(law, sign, slope, r) for law, slope, r in search.found]
    top = max(law for law, _, _, _ in found)
    # Of laws that are equal but for rounding, the one in the plainest direction.
    law, sign, slope, r = min((item for item in found if item[0].is_near(top)), key=_plainness)
    stretch = mp.sqrt(1 + slope**2)
    x, y = (0.0, 1.0) if slope == mp.inf else (float(1 / stretch), float(slope / stretch))
    return Worst(law, (sign * x + 0.0, sign * y + 0.0), r)  # 0, not -0


def _plainness(item):
    _, sign, slope, r = item
    return r, ([0, mp.inf, 1, -1].index(slope) if slope in (0, mp.inf, 1, -1) else 4), -sign


class _Search:
    """Laws of polynomials F = {(i, j, l): c}, meaning c lambda^i k^j t^l, on curves t = tau k^{-r}."""

    def __init__(self, hints):
        self.hints, self.found = hints, []

    def law(self, F, r, tau):
        P = collected((((i, j - r * l), c * tau**l) for (i, j, l), c in F.items()))
        found = branches(P, self.last())
        return found[0].law if found else NOTHING

    def last(self):
        """The order below which the real part of a branch can no longer matter."""
        best = max((law for law, _, _ in self.found), default=None)
        return max(LAST, best.exponent) if best and best.coefficient > 0 else LAST

    def add(self, law, slope, r):
        """Keep a law, its k the distance along the direction of this slope turned into |xi|."""
        if law == NOTHING:
            return
        stretch = 1 if slope == mp.inf else float(mp.sqrt(1 + slope**2))
        self.found.append((Law(law.exponent, law.coefficient * stretch ** -float(law.exponent)), slope, r))

    def family(self, F, r, depth, slope):
        """All of t = tau k^{-r}, tau not 0 unless r = 0; slope is that of the direction, None where tau itself is."""

        def value(s):  # the parameter s -> tau
            return mp.tan(s) if slope is None else mp.sign(s) * mp.exp(abs(s) - 5)

        def law(s):
            return law_at(value(s))

        def law_at(tau):
            found = self.law(F, r, tau)
            stretch = float(mp.sqrt(1 + tau**2)) if slope is None else 1.0
            return Law(found.exponent, found.coefficient * stretch ** -float(found.exponent))

        if slope is None:
            hinted = [np.arctan(np.tan(angle)) + np.array([-1e-4, 0, 1e-4]) for angle in self.hints]
            for values in (np.linspace(-1.5707, 1.55, SAMPLES), *hinted):
                s = _highest(law, values, None)
                self.add(self.law(F, r, value(s)), value(s), r)
        else:
            s = _highest(law, np.array([-10, -7, -5.3, -3, 3.1, 4.9, 7, 10]), self.best())
            self.add(self.law(F, r, value(s)), slope, r)
        special = self.special(F, r, self.best())
        for low, high in pairwise(special):  # where growth is confined between two, all the values tried may miss it
            if law_at((low + high) / 2) > self.best():
                tau = _highest(law_at, np.linspace(low, high, 9)[1:-1], None)
                self.add(self.law(F, r, tau), tau if slope is None else slope, r)
        for tau in special:
            if slope is None or tau != 0:
                moved, towards = shifted_by(F, tau, -r, 2), tau if slope is None else slope
                if depth:
                    self.near(moved, r, depth - 1, towards)
                else:
                    self.add(self.law(moved, r, 0), towards, r)

    def near(self, F, r, depth, slope):
        """t = 0 itself, and t = tau k^{-r'} with r' > r."""
        self.add(self.law(F, 0, 0), slope, r)
        P = {(i, j): c for (i, j, l), c in F.items() if l == 0}
        if max((i for i, _ in P), default=-1) < max(i for i, _, _ in F):  # a pole: what is beside it, at every k
            for tau in (1, -1):
                law = self.law(F, BEYOND, mp.mpf(tau))
                self.add(Law(Fraction(0), 0.0) if law.exponent < -BEYOND / 20 else law, slope, r)
            if self.best().exponent > BEYOND / 20:
                return
        exponents = _facets(F)
        # Where branches begin with the same imaginary terms, as all do in a mean flow, the rest decides.
        for imaginary in {terms[:n] for terms in self._imaginary(P) for n in range(1, len(terms) + 1)}:
            moved = F
            for q, c in imaginary:
                moved = shifted_by(moved, c, q, 0)
            exponents |= _facets(moved)
        for r2 in sorted(exponents):
            if r2 > r:
                self.family(F, r2, depth, slope)

    def _imaginary(self, P):
        """The purely imaginary terms, up to two, with which the branches at t = 0 begin."""
        found = set()
        for branch in branches(P, LAST):
            terms = tuple((q, 1j * c.imag) for q, c in branch.terms if abs(c.real) <= ZERO * abs(c))
            found.add(terms[:2])
        return found

    def best(self):
        return max((law for law, _, _ in self.found), default=NOTHING)

    def special(self, F, r, best):
        """Real tau where the Newton polygon of a faster law than ``best`` degenerates."""
        family: dict = {}
        for (i, j, l), c in F.items():
            family.setdefault((i, j - r * l), {})[l] = c
        family = {power: [column.get(l, mp.mpc(0)) for l in range(max(column) + 1)] for power, column in family.items()}
        hull = hull_of(family)
        found = []
        for (i, j), (i2, j2) in pairwise(hull):
            q = (j - j2) / (i2 - i)
            edge = [family.get((n, j - q * (n - i)), [mp.mpc(0)]) for n in range(i, i2 + 1)]
            found += _real_roots(edge[0]) + _real_roots(edge[-1])
            if best.coefficient > 0 and q <= best.exponent:
                continue
            mirror = [[mp.conj(c) * (-1) ** n for c in p] for n, p in enumerate(edge)]
            meeting = resultant(edge, mirror)
            if not meeting:  # purely imaginary throughout: then where branches meet
                slope = [[n * c for c in p] for n, p in enumerate(edge)][1:]
                meeting = resultant(edge, slope)
            found += _real_roots(meeting)
        distinct: list = []
        for tau in sorted(tau if abs(tau) > REAL else mp.mpf(0) for tau in found):
            if not distinct or abs(tau - distinct[-1]) > REAL * (1 + abs(tau)):
                distinct.append(tau)
        return distinct


def _real_roots(p):
    found = roots(p) if p else []
    return [z.real for z, _ in found if abs(z.imag) <= REAL * (1 + abs(z))]


def _facets(F):
    """Drift exponents r > 0 of the facets of the Newton polytope whose outer normals are (q, 1, -r)."""
    top: dict = {}
    for i, j, l in F:
        top[i, l] = max(j, top.get((i, l), j))
    points = [(i, j, l) for (i, l), j in top.items()]
    # A point with a lower power of k and a higher one of t than another never counts.
    points = [p for p in points if not any(o != p and o[0] == p[0] and o[1] >= p[1] and o[2] <= p[2] for o in points)]
    scale = int(np.lcm.reduce([p[1].denominator for p in points]))
    corners = np.array([(i, int(j * scale), l) for i, j, l in points], dtype=np.int64)
    found = set()
    for a, b, c in combinations(corners, 3):
        n = np.cross(b - a, c - a)
        n = n if n[1] > 0 else -n
        if n[1] > 0 and n[2] < 0 and ((corners - a) @ n <= 0).all():
            found.add(Fraction(int(-n[2]), int(n[1])) / scale)
    return found


def _highest(law, s, rival):
    """Where law(s) is fastest: the best of the values s, sought more finely if there is a chance against ``rival``."""
    laws = [law(x) for x in s]
    best = max(range(len(s)), key=lambda n: laws[n])
    centre, top, width = s[best], laws[best], np.diff(s).max()
    if all(other.is_near(top) for other in laws) or (rival and top.key[:2] < rival.key[:2]):
        return centre
    start = max(1, abs(top.coefficient))
    while width > 1e-8 and abs(top.coefficient) < 1e4 * start:  # no further towards a pole: a special direction
        for x in (centre - width / 2, centre + width / 2):
            trial = law(x)
            if trial > top:
                centre, top = x, trial
        width /= 2.5
    return centre
