"""Polynomials in one variable with multiprecision coefficients: lists, the constant term first."""

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
    return found + [(size * z, multiplicity) for z, multiplicity in _scaled_roots(p, zero)]


def _scaled_roots(p, zero):
    found: list[tuple] = []
    multiplicity = 1
    shared = common(p, derivative(p), zero)
    simple, _ = divided(p, shared)
    while len(simple) > 1:
        again = common(simple, shared, zero)
        once, _ = divided(simple, again)
        found += [(z, multiplicity) for z in _simple_roots(once)]
        shared, _ = divided(shared, again)
        simple, multiplicity = again, multiplicity + 1
    return found


def _simple_roots(p):
    if len(p) == 3:
        half, root = -p[1] / (2 * p[2]), mp.sqrt(p[1] ** 2 - 4 * p[0] * p[2]) / (2 * p[2])
        return [half + root, half - root]
    return mp.polyroots(p[::-1], maxsteps=1000, extraprec=mp.mp.prec)


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
    found = _interpolated(nodes, values)
    least = ZERO * max(map(abs, found))
    return trimmed([a if abs(a) > least else mp.mpc(0) for a in found], 0)


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


def _interpolated(nodes, values):
    """Coefficients of the polynomial through the values, by Newton's divided differences."""
    nodes, table = list(nodes), list(values)
    for level in range(1, len(nodes)):
        for n in range(len(nodes) - 1, level - 1, -1):
            table[n] = (table[n] - table[n - 1]) / (nodes[n] - nodes[n - level])
    p = [table[-1]]
    for n in range(len(nodes) - 2, -1, -1):  # Horner: p (s - node) + table
        p = [table[n] - nodes[n] * p[0], *(a - nodes[n] * b for a, b in zip(p, [*p[1:], mp.mpc(0)], strict=True))]
    return p
