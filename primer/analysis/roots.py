"""Polynomials in one variable with multiprecision coefficients: lists, the constant term first."""

from contextlib import suppress
from itertools import pairwise

import mpmath as mp

DIGITS = 160  # carried throughout: a root of multiplicity m is known to one m-th of them
ZERO = mp.mpf(10) ** -50  # relative size below which a sum of cancelling terms is zero, where data are exact


def trimmed(p, least):
    """p without the leading coefficients no larger than ``least``."""
    p = list(p)
    while p and abs(p[-1]) <= least:
        p.pop()
    return p


def derivative(p):
    """p', the coefficients from the constant one upwards."""
    return [n * a for n, a in enumerate(p)][1:]


def divided(p, d):
    """Quotient and remainder of p by d."""
    rest, quotient = list(p), []
    for n in range(len(p) - len(d), -1, -1):
        factor = rest[n + len(d) - 1] / d[-1]
        quotient.append(factor)
        for m, a in enumerate(d):
            rest[n + m] -= factor * a
    return quotient[::-1], rest[: len(d) - 1]


def common(p, q, zero):
    """The greatest common divisor of p and q by Euclid's algorithm, monic."""
    while q:
        _, rest = divided(p, q)
        largest = max(abs(a) for a in p) * max(abs(a) for a in q) / abs(q[-1])
        p, q = q, trimmed(rest, zero * largest)
    return [a / p[-1] for a in p]


def roots(p, zero=ZERO):
    """The distinct roots of p and their multiplicities: a list of pairs, by Yun's squarefree decomposition.

    The last coefficient of p must not be zero.
    """
    zeros = next(n for n, a in enumerate(p) if a != 0)
    found = [(mp.mpc(0), zeros)] if zeros else []
    p = p[zeros:]
    if len(p) < 3:
        return [*found, *((-p[0] / a, 1) for a in p[1:])]
    size = mp.root(abs(p[0] / p[-1]), len(p) - 1)  # the roots' geometric mean, scaled to one
    p = [a * size**n for n, a in enumerate(p)]
    return found + [(size * z, multiplicity) for z, multiplicity in _told_apart(p, zero)]


def _told_apart(p, zero):
    """The roots by Yun's decomposition; by a finer zero where it is at odds with itself, as where roots nearly meet."""
    for least, dps in ((zero, mp.mp.dps), (zero**2, 3 * mp.mp.dps), (zero**4, 6 * mp.mp.dps)):
        with mp.workdps(dps):
            found = _scaled_roots(p, least)
        if sum(multiplicity for _, multiplicity in found) == len(p) - 1:
            return found
    with mp.workdps(6 * mp.mp.dps):
        return [(z, 1) for z in mp.polyroots(p[::-1], maxsteps=5000, extraprec=4 * mp.mp.prec, error=False)]


def _scaled_roots(p, zero):
    found: list[tuple] = []
    multiplicity = 1
    shared = common(p, derivative(p), zero)
    simple, _ = divided(p, shared)
    while len(simple) > 1:
        again = common(simple, shared, zero)
        once, _ = divided(simple, again)
        if not once:
            return []
        found += [(z, multiplicity) for z in _simple_roots(once)]
        shared, _ = divided(shared, again)
        simple, multiplicity = again, multiplicity + 1
    return found


def _simple_roots(p):
    """The roots of p, all of them simple: found in double precision, polished, and certified to be all there are."""
    if len(p) == 2:
        return [-p[0] / p[1]]
    if len(p) == 3:
        half, root = -p[1] / (2 * p[2]), mp.sqrt(p[1] ** 2 - 4 * p[0] * p[2]) / (2 * p[2])
        far = half - root if abs(half - root) > abs(half + root) else half + root
        return [far, p[0] / (p[2] * far)]  # the smaller without cancellation
    with suppress(ZeroDivisionError):
        found = _polished(p)
        if found:
            return found
    return mp.polyroots(p[::-1], maxsteps=1000, extraprec=mp.mp.prec)


def _polished(p):
    """The roots from starts in double precision by Newton's method, or None where they cannot be certified.

    Each lies within len(p) - 1 times its Weierstrass correction of a root (Smith 1970): where these discs are disjoint
    and small, there is one root in each.
    """
    z, digits = _aberth(p), mp.mp.dps
    with mp.workdps(digits + 15):
        slope = derivative(p)
        for i, x in enumerate(z):
            for _ in range(12):
                fall = _at(slope, x)
                if fall == 0:
                    return None
                step = _at(p, x) / fall
                x -= step
                if abs(step) <= mp.mpf(10) ** (-digits // 2 - 5) * abs(x):  # the next would be at rounding level
                    break
            z[i] = x
        radius = []
        for i, x in enumerate(z):
            others = mp.fprod(x - y for j, y in enumerate(z) if j != i) * p[-1]
            if others == 0:
                return None
            radius.append(len(z) * abs(_at(p, x) / others))
        near = mp.mpf(10) ** (5 - digits)
        if any(r > near * abs(x) for r, x in zip(radius, z, strict=True)):
            return None
        if any(abs(z[i] - z[j]) <= radius[i] + radius[j] for i in range(len(z)) for j in range(i)):
            return None
    return [+x for x in z]


def _aberth(p):
    """The roots of p to some eight digits: by the Ehrlich-Aberth iteration, in double precision if numbers allow."""
    z = _starts(p)
    largest = max(abs(a) for a in p)
    scaled = [a / largest for a in p]
    if all(abs(a) > 1e-100 for a in scaled if a) and all(1e-20 < abs(x) < 1e20 for x in z) and len(p) < 14:
        with suppress(OverflowError, ZeroDivisionError):
            found = _iterated([complex(a) for a in scaled], [complex(x) for x in z], 1e-9)
            return [mp.mpc(x) for x in found]
    with mp.workdps(30):
        return _iterated(p, z, mp.mpf(10) ** -9)


def _iterated(p, z, enough):
    slope = derivative(p)
    for _ in range(60):
        largest = 0
        for i, x in enumerate(z):
            value = _at(p, x)
            if value == 0:
                continue
            step = _at(slope, x) / value - sum(1 / (x - y) for j, y in enumerate(z) if j != i)
            z[i] = x - 1 / step
            largest = max(largest, abs(1 / (step * z[i])))
        if largest < enough:
            break
    return z


def _starts(p):
    """Rough places of the roots: on circles whose radii are the slopes of the Newton polygon (Bini 1996)."""
    size = [float(mp.log(abs(a))) if a else -float("inf") for a in p]
    hull: list[int] = []
    for n, height in enumerate(size):
        if height == -float("inf"):
            continue
        while len(hull) > 1 and (size[hull[-1]] - size[hull[-2]]) * (n - hull[-1]) <= (height - size[hull[-1]]) * (
            hull[-1] - hull[-2]
        ):
            hull.pop()
        hull.append(n)
    z = []
    for low, high in pairwise(hull):
        radius = mp.exp((size[low] - size[high]) / (high - low))
        turn = 2 * mp.pi / (high - low)
        z += [radius * mp.expj(turn * m + 0.7 + low) for m in range(high - low)]
    return z


def _at(p, x):
    value = p[-1]
    for a in p[-2::-1]:
        value = value * x + a
    return value


def resultant(p, q):
    """The resultant of polynomials whose coefficients are polynomials in a parameter: a polynomial in that, [] if zero.

    By interpolation of Sylvester determinants at whole numbers.
    """
    with mp.extradps(DIGITS):  # interpolation loses many
        return _resultant(p, q)


def _resultant(p, q):
    degrees = [max(len(c) for c in f) - 1 for f in (p, q)]
    nodes = range(1, (len(q) - 1) * degrees[0] + (len(p) - 1) * degrees[1] + 2)
    values, sizes = [], []
    for s in nodes:
        rows = [[mp.polyval(c[::-1], s) for c in f[::-1]] for f in (p, q)]
        values.append(_sylvester(*rows))
        sizes.append(max(map(abs, rows[0])) ** (len(q) - 1) * max(map(abs, rows[1])) ** (len(p) - 1))
    if all(abs(v) <= ZERO * s for v, s in zip(values, sizes, strict=True)):
        return []
    found = interpolated(nodes, values)
    least = ZERO * max(map(abs, found))
    return trimmed([a if abs(a) > least else mp.mpc(0) for a in found], 0)


def sylvester_interpolated(p, q):
    """As :func:`resultant`, at the digits at hand and with all of them kept; None if it is zero."""
    degrees = [max(len(c) for c in f) - 1 for f in (p, q)]
    nodes = range(1, (len(q) - 1) * degrees[0] + (len(p) - 1) * degrees[1] + 2)
    values = [_sylvester(*([mp.polyval(c[::-1], s) for c in f[::-1]] for f in (p, q))) for s in nodes]
    found = interpolated(nodes, values)
    return trimmed(found, max(map(abs, found)) * mp.mpf(10) ** (-mp.mp.dps * 2 // 3)) or None


def _sylvester(p, q):
    """The determinant of the Sylvester matrix, by elimination; the leading coefficients first."""
    m, n = len(p) - 1, len(q) - 1
    rows = [[mp.mpc(0)] * r + list(p) + [mp.mpc(0)] * (n - 1 - r) for r in range(n)]
    rows += [[mp.mpc(0)] * r + list(q) + [mp.mpc(0)] * (m - 1 - r) for r in range(m)]
    product = mp.mpc(1)
    while rows:
        best = max(range(len(rows)), key=lambda r: abs(rows[r][0]))
        pivot = rows.pop(best)
        product *= pivot[0] * (-1) ** best
        if pivot[0] == 0:
            break
        rows = [[a - row[0] / pivot[0] * b for a, b in zip(row[1:], pivot[1:], strict=True)] for row in rows]
    return product


def interpolated(nodes, values):
    """Coefficients of the polynomial through the values, by Newton's divided differences."""
    nodes, table = list(nodes), list(values)
    for level in range(1, len(nodes)):
        for n in range(len(nodes) - 1, level - 1, -1):
            table[n] = (table[n] - table[n - 1]) / (nodes[n] - nodes[n - level])
    p = [table[-1]]
    for n in range(len(nodes) - 2, -1, -1):  # Horner: p (s - node) + table
        p = [table[n] - nodes[n] * p[0], *(a - nodes[n] * b for a, b in zip(p, [*p[1:], mp.mpc(0)], strict=True))]
    return p
