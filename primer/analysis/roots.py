"""Polynomials in one variable with multiprecision coefficients: lists, the constant term first."""

import mpmath as mp

DIGITS = (
    80  # carried throughout: a multiple root costs its multiplicity in digits, and few branches meet more than once
)
ZERO = mp.mpf(10) ** -40  # relative size below which a sum of cancelling terms is zero, where data are exact


def trimmed(p, least):
    """p without the leading coefficients no larger than ``least``."""
    p = list(p)
    while p and abs(p[-1]) <= least:
        p.pop()
    return p


def derivative(p):
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
        largest = max(abs(a) for a in p) * max(1, max(abs(a) for a in q) / abs(q[-1]))
        p, q = q, trimmed(rest, zero * largest)
        if q:  # keep the sizes near one
            size = max(abs(a) for a in q)
            q = [a / size for a in q]
    return [a / p[-1] for a in p]


def roots(p, zero=ZERO):
    """The distinct roots of p and their multiplicities: a list of pairs, by Yun's squarefree decomposition."""
    p = trimmed(p, zero * max(abs(a) for a in p))
    zeros = next((n for n, a in enumerate(p) if a != 0), 0)
    found = [(mp.mpc(0), zeros)] if zeros else []
    p = p[zeros:]
    if len(p) == 2:
        return [*found, (-p[0] / p[1], 1)]
    multiplicity = 1
    if len(p) > 2:
        shared = common(p, derivative(p), zero)
        simple, _ = divided(p, shared)
        while len(simple) > 1:
            if len(shared) == 1:
                found += [(z, multiplicity) for z in _simple_roots(simple)]
                break
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
    return mp.polyroots(p[::-1], maxsteps=1000, extraprec=8 * mp.mp.prec) if len(p) > 1 else []
