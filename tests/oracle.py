"""An oracle for verdicts that shares no code with the package: random systems, and what is true of them by brute force.

The determinant is expanded over permutations in exact Gaussian rationals; roots come from mpmath in many digits, once
each after a division by the greatest common divisor with the derivative; the power law is read off at |xi| = 10^20 and
10^40; the bound is the best of a scan, each maximum climbed; the loss is that of exp(t A) by squaring. Run as a script,
``python tests/oracle.py FIRST LAST``, it judges the seeds from FIRST on and prints what differs and the rates.
"""

import math
import random
import re
import sys
from fractions import Fraction
from itertools import permutations

import mpmath as mp
import numpy as np

COEFFICIENTS = ["1", "2", "3", "1/3", "2/7", "0.5", "0.1", "7", "1.7"]


class Gauss:
    """A number of Q(i)."""

    def __init__(self, re=0, im=0):
        self.re, self.im = Fraction(re), Fraction(im)

    def __add__(self, o):
        return Gauss(self.re + o.re, self.im + o.im)

    def __sub__(self, o):
        return Gauss(self.re - o.re, self.im - o.im)

    def __mul__(self, o):
        return Gauss(self.re * o.re - self.im * o.im, self.re * o.im + self.im * o.re)

    def __truediv__(self, o):
        size = o.re**2 + o.im**2
        return self * Gauss(o.re / size, -o.im / size)

    def __bool__(self):
        return bool(self.re or self.im)

    def mp(self):
        return mp.mpc(mp.mpf(self.re.numerator) / self.re.denominator, mp.mpf(self.im.numerator) / self.im.denominator)


I = Gauss(0, 1)


def system(seed):
    """(text, equations, dim): random; each equation is a list of (coefficient, unknown, (n, a, b)), their sum zero."""
    r = random.Random(seed)
    size = r.choice([1, 1, 2, 2, 2, 3, 3, 4])
    dim = 2 if seed % 5 == 4 else 1
    if dim == 2:
        size = min(size, 2)
    style = r.choice(["any", "damped", "waves", "waves", "jordan", "mixed", "constraint", "second"])
    large = r.random() < 0.25
    twisted = r.random() < 0.25

    def number():
        value = Fraction(r.choice(COEFFICIENTS)) * r.choice([1, 1, -1])
        if large:
            value *= Fraction(10) ** r.randint(-6, 6)
        return Gauss(value) * (I if twisted and r.random() < 0.4 else Gauss(1))

    def orders(least, most):
        n = r.randint(least, most)
        b = r.randint(0, n) if dim == 2 else 0
        return (0, n - b, b)

    equations = []
    top = r.choice([2, 4])
    shared = number()
    speeds = Gauss(abs(shared.re) + abs(shared.im))
    for e in range(size):
        order = 2 if style == "second" and e == 0 else 1
        terms = [(Gauss(-1), e, (order, 0, 0))]
        if style == "mixed" and e == 0:
            terms.append((Gauss(Fraction(r.choice(COEFFICIENTS)) * r.choice([1, 1, 1, -1])), e, (1, 2, 0)))
        if style == "any":
            terms += [(number(), r.randrange(size), orders(0, 4)) for _ in range(r.randint(1, 3))]
        elif style == "damped":
            sign = Gauss(1 if top == 2 else -1)
            for derivative in [(0, top, 0), (0, 0, top)][:dim]:
                terms.append((sign * Gauss(abs(number().re) + 1), e, derivative))
            terms += [(number(), r.randrange(size), orders(0, top - 1)) for _ in range(r.randint(1, 3))]
        elif style == "jordan":
            terms.append((speeds, e, (0, 1, 0)))
            terms += [(number(), later, orders(0, 2)) for later in range(e + 1, size)]
            if r.random() < 0.2:
                terms.append((number(), e, (0, 0, 0)))
        elif style == "second":
            terms.append((speeds, e, (0, 2, 0)) if order == 2 else (speeds, e, (0, 1, 0)))
            terms += [(number(), r.randrange(size), orders(0, 2)) for _ in range(r.randint(0, 2))]
        elif style in ("mixed", "constraint"):
            terms += [(number(), r.randrange(size), orders(0, 3)) for _ in range(r.randint(1, 2))]
        equations.append(terms)
    if style == "waves":  # i H with a Hermitian H, and a small coupling
        for a in range(size):
            equations[a].append((Gauss(number().re), a, (0, 1, 0) if r.random() < 0.6 else (0, 3, 0)))
            for b in range(a):
                value, derivative = Gauss(number().re), r.choice([(0, 1, 0), (0, 0, 1)][:dim])
                equations[a].append((value, b, derivative))
                equations[b].append((value, a, derivative))
        if r.random() < 0.5:
            equations[r.randrange(size)].append((number(), r.randrange(size), (0, 0, 0)))
    if style == "constraint" and size > 1:
        equations[-1] = [(Gauss(-1), size - 1, (0, r.choice([0, 2]), 0)), (number(), 0, orders(0, 3))]
    return written(equations), equations, dim


def written(equations):
    """The text of the equations."""

    def term(c, u, powers):
        letters = "".join(letter * n for letter, n in zip("txy", powers, strict=True))
        name = "abcd"[u] + ("_" + letters if letters else "")
        return f"({c.re}+({c.im})*i)*{name}" if c.im else f"({c.re})*{name}"

    return "; ".join(" + ".join(term(*t) for t in terms) + " = 0" for terms in equations)


def determinant(equations):
    """{(n, a, b): Gauss}: of lambda^n xi_1^a xi_2^b."""
    size = len(equations)
    powers_of_i = [Gauss(1), I, Gauss(-1), Gauss(0, -1)]
    entries = [[[(c * powers_of_i[(p[1] + p[2]) % 4], p) for c, v, p in terms if v == u] for u in range(size)]
               for terms in equations]  # fmt: skip
    total: dict = {}
    for order in permutations(range(size)):
        sign = (-1) ** sum(order[i] > order[j] for i in range(size) for j in range(i + 1, size))
        product = {(0, 0, 0): Gauss(sign)}
        for row, column in enumerate(order):
            new: dict = {}
            for p, c in product.items():
                for d, q in entries[row][column]:
                    key = tuple(x + y for x, y in zip(p, q, strict=True))
                    new[key] = new.get(key, Gauss()) + c * d
            product = new
        for key, c in product.items():
            total[key] = total.get(key, Gauss()) + c
    return {key: c for key, c in total.items() if c}


def at(D, x, y=Fraction(0)):
    """Coefficients of det M in lambda at rational xi, from the constant one upwards."""
    p = [Gauss() for _ in range(1 + max(n for n, _, _ in D))]
    for (n, a, b), c in D.items():
        p[n] = p[n] + c * Gauss(Fraction(x) ** a * Fraction(y) ** b)
    while p and not p[-1]:
        p.pop()
    return p


def simple(p):
    """p without repeated factors."""
    if _certainly_simple(p):
        return p
    f, g = p, [Gauss(n) * c for n, c in enumerate(p)][1:]
    while g:
        f, g = g, quotient(f, g)[1]
    return quotient(p, f)[0]


PRIME, ROOT = 998244353, 86583718  # ROOT^2 = -1


def _certainly_simple(p):
    """Whether p has no repeated factor modulo a prime, with a root of -1 for i: then it has none."""
    if any(part.denominator % PRIME == 0 for c in p for part in (c.re, c.im)):
        return False
    f = [(_residue(c.re) + ROOT * _residue(c.im)) % PRIME for c in p]
    if not f[-1]:
        return False
    g = [n * c % PRIME for n, c in enumerate(f)][1:]
    while g and not g[-1]:
        g.pop()
    while g:
        rest = list(f)
        inverse = pow(g[-1], -1, PRIME)
        for n in range(len(f) - len(g), -1, -1):
            factor = rest[n + len(g) - 1] * inverse
            for m, c in enumerate(g):
                rest[n + m] = (rest[n + m] - factor * c) % PRIME
        rest = rest[: len(g) - 1]
        while rest and not rest[-1]:
            rest.pop()
        f, g = g, rest
    return len(f) == 1


def _residue(x):
    return x.numerator * pow(x.denominator, -1, PRIME)


def quotient(p, d):
    rest, found = list(p), []
    for n in range(len(p) - len(d), -1, -1):
        factor = rest[n + len(d) - 1] / d[-1]
        found.append(factor)
        for m, c in enumerate(d):
            rest[n + m] = rest[n + m] - factor * c
    rest = rest[: len(d) - 1]
    while rest and not rest[-1]:
        rest.pop()
    return found[::-1], rest


def growth(D, x, y=Fraction(0), digits=60):
    """max Re lambda with many digits; None where nothing evolves."""
    p = at(D, x, y)
    if len(p) < 2:
        return None
    p = simple(p)
    zero = not p[0]
    while not p[0]:
        p = p[1:]
    with mp.workdps(digits):
        p = [c.mp() for c in p]
        if len(p) == 1:
            return mp.mpf(0)
        size = mp.root(abs(p[0] / p[-1]), len(p) - 1)
        scaled = [c * size**n for n, c in enumerate(p)]
        found = mp.polyroots(scaled[::-1], maxsteps=2000, extraprec=3 * digits)
        real = [size * z.real if abs(z.real) > mp.mpf(10) ** (-3 * digits // 4) * abs(z) else mp.mpf(0) for z in found]
        return max(real + [mp.mpf(0)] * zero)


def power_law(D):
    """(exponent, coefficient) of the largest growth in one variable, from |xi| = 10^20 and 10^40."""
    best = None
    for sign in (1, -1):
        low, high = (growth(D, sign * Fraction(10) ** e, digits=500) for e in (20, 40))
        if not high or not low:
            law = (0, Fraction(0), 0.0)
        else:
            with mp.workdps(60):
                slope = Fraction(float(mp.log(high / low, 10) / 20)).limit_denominator(12)
                law = (
                    int(mp.sign(high)),
                    slope,
                    float(high / mp.mpf(10) ** (40 * mp.mpf(slope.numerator) / slope.denominator)),
                )
        key = (law[0], law[0] * law[1], law[2])
        if best is None or key > best[0]:
            best = key, law
    return best[1][1:]


def scan(D, decades=12, each=24):
    """The largest growth at k on a grid over these decades to each side of 1, each maximum climbed: (value, k)."""
    k = 10.0 ** np.arange(-decades, decades + 1 / each, 1 / each)
    k = np.concatenate([-k[::-1], k])
    rough = np.array([_rough(D, x) for x in k])
    peak = (rough >= np.roll(rough, 1)) & (rough >= np.roll(rough, -1))
    found = []
    for n in np.argsort(np.where(peak, -rough, np.inf))[:2]:
        if not math.isfinite(rough[n]):
            continue
        s, step = math.log10(abs(k[n])), 1 / each
        value = _near(D, k[n], s)
        for _ in range(16):
            trials = [(_near(D, k[n], s + d), s + d) for d in (-step / 2, step / 2)]
            top = max(trials)
            if top[0] > value:
                value, s = top
            step /= 2
        found.append((value, 10**s))
    return max(found, default=(-math.inf, 0))


def _near(D, sign, s):
    value = growth(D, Fraction(math.copysign(10**s, sign)), digits=60)
    return -math.inf if value is None else float(value)


def _rough(D, x):
    """In double precision, for a scan."""
    p: list = [0j] * (1 + max(n for n, _, _ in D))
    for (n, a, _), c in _floats(D).items():
        p[n] += c * x**a
    if not p[-1]:
        return -math.inf
    largest = max(map(abs, p))
    try:
        return max(np.roots(np.array(p[::-1]) / largest).real, default=-math.inf)
    except np.linalg.LinAlgError:
        return -math.inf


def _floats(D, memory=[None, {}]):  # noqa: B006
    if memory[0] is not D:  # which is kept, so that no other can come to stand in its place
        memory[:] = D, {p: complex(float(c.re), float(c.im)) for p, c in D.items()}
    return memory[1]


def loss(equations):
    """The power of |exp(t A)| between |xi| = 10^4 and 10^6 over t < 1; None unless every equation is a_t = ..."""
    size = len(equations)
    if any([p for _, _, p in terms if p[0]] != [(1, 0, 0)] for terms in equations):
        return None
    parts = [abs(part) for terms in equations for c, *_ in terms for part in (c.re, c.im) if part]
    if min(parts) < 0.01 or max(parts) > 100:  # not yet a power law at these wavenumbers
        return None
    logs = []
    with mp.workdps(90):
        for decade in (4, 6):
            best = mp.mpf(0)
            for sign in (1, -1):
                A = mp.zeros(size)
                for r, terms in enumerate(equations):
                    for c, u, (n, a, _) in terms:
                        if not n:
                            A[r, u] += c.mp() * (mp.mpc(0, sign) * mp.mpf(10) ** decade) ** a
                for t in [mp.mpf(10) ** (-mp.mpf(m) / 2) for m in range(0, 8 * decade)]:
                    best = max(best, mp.mnorm(_exponential(A * t), "f"))
            logs.append(mp.log(best, 10))
    return float(logs[1] - logs[0]) / 2


def _exponential(A):
    halvings = max(0, int(mp.log(mp.mnorm(A, "f") + 1, 2)) + 4)
    A = A / mp.mpf(2) ** halvings
    term = total = mp.eye(A.rows)
    for n in range(1, 45):
        term = term * A / n
        total = total + term
    for _ in range(halvings):
        total = total * total
    return total


def judged(seed, verdict, with_loss=False):
    """("right" | "undecided" | "refused" | "wrong", text, details) for the system of one seed."""
    text, equations, dim = system(seed)
    D = determinant(equations)
    if not D or not max(n for n, _, _ in D):
        try:
            verdict(text)
        except ValueError:
            return "refused", text, ""
        return "wrong", text, "not refused"
    found = verdict(text)
    if found.kind == "undecided":
        return "undecided", text, found.reason
    checks = _in_plane(D, found) if dim == 2 else _on_line(D, found)
    if with_loss and not checks and dim == 1 and found.kind == "well-posed":
        power = loss(equations)
        if power is not None and abs(max(power, 0) - float(found.loss)) > 0.12:
            checks.append(f"loss {found.loss}, by exp(t A) {power:.3f}")
    return ("wrong" if checks else "right"), text, "; ".join(checks)


def _on_line(D, found):
    wrong = []
    exponent, coefficient = power_law(D)
    ill = exponent > 0 and coefficient > 0
    if (found.kind == "ill-posed") != ill:
        return [f"{found.kind}, but Re lambda ~ {coefficient:.6g} |xi|^{exponent}"]
    if found.exponent != exponent or abs(found.coefficient - coefficient) > 1e-6 * abs(coefficient):
        wrong.append(f"{found.coefficient:.9g} |xi|^{found.exponent}, truly {coefficient:.9g} |xi|^{exponent}")
    if not ill:
        value, k = scan(D)
        limit = coefficient if exponent == 0 else 0.0 if exponent < 0 or not coefficient else -math.inf
        at_zero = growth(D, Fraction(1, 10**40), digits=120)
        near_zero = -math.inf if at_zero is None else 0.0 if abs(at_zero) < 1e-25 else float(at_zero)
        value = max(value, limit, near_zero)
        if found.bound < value - 1e-6 * abs(value) - 1e-30:
            wrong.append(f"bound {found.bound:.9g}, but {value:.9g} near {k:.6g}")
        elif found.bound > value + 1e-6 * abs(value) and not _attained(D, found):
            wrong.append(f"bound {found.bound:.9g}, seen {value:.9g} near {k:.6g}")
    return wrong


def _attained(D, found):
    """Whether the bound is met near the wavenumber that the reason names."""
    place = re.search(r"near \|xi\| = ([-+.\de]+[\d])", found.reason)
    if not place or not float(place[1]):
        return False
    k, best, step = float(place[1]), -math.inf, 1e-3
    for sign in (1, -1):
        centre, step = k, 1e-3
        for _ in range(8):
            trials = [centre * (1 + step * m / 12) for m in range(-12, 13)]
            values = [_near(D, sign, math.log10(x)) for x in trials]
            centre, step = trials[int(np.argmax(values))], step / 8
            best = max(best, *values)
    return abs(best - found.bound) <= 1e-6 * abs(found.bound)


def _in_plane(D, found):
    """One-sided checks by sampling: growth at large |xi| in many directions, and growth anywhere against the bound."""
    wrong = []
    r = random.Random(7)
    slopes = [Fraction(r.randint(-400, 400), r.randint(1, 100)) for _ in range(12)]
    slopes += [Fraction(n, m) for n in (0, 1, -1, 2, -2) for m in (1, 10**4)]
    for slope in slopes:
        for sign in (1, -1):
            for along in ((1, slope), (slope, 1)):
                length = math.hypot(*map(float, along))
                low, high = (growth(D, *(sign * Fraction(10) ** e * x for x in along), digits=60) for e in (10, 14))
                if low is None or high is None:
                    continue
                if found.kind == "well-posed" and high > max(float(found.bound), 0) * (1 + 1e-6) + 1e-20:
                    wrong.append(f"growth {float(high):.6g} at 1e14, slope {slope}, above the bound {found.bound:.6g}")
                if found.kind == "ill-posed" and math.isfinite(found.coefficient):
                    law = found.coefficient * (length * 1e14) ** float(found.exponent)
                    if high > law * (1 + 1e-5):
                        wrong.append(f"growth {float(high):.6g}, above the law {law:.6g}, slope {slope}")
                if found.kind == "well-posed":
                    for e in range(-8, 9, 4):
                        value = growth(D, *(sign * Fraction(10) ** e * x for x in along), digits=30)
                        if value is not None and value > found.bound + 1e-6 * abs(found.bound) + 1e-20:
                            wrong.append(f"growth {float(value):.9g} above the bound {found.bound:.9g}")
                if wrong:
                    return wrong
    if found.kind == "ill-posed" and math.isfinite(found.coefficient) and "approached" not in found.reason:
        x, y = (Fraction(v).limit_denominator(10**15) for v in (*found.direction, 0.0)[:2])
        high = growth(D, *(10**14 * v for v in (x, y)), digits=80)
        law = found.coefficient * 1e14 ** float(found.exponent)
        if high is not None and high < law * 0.99:
            wrong.append(f"growth {float(high):.6g} in the direction named, below the law {law:.6g}")
    return wrong


def main(first, last):
    from primer import verdict

    rates: dict = {}
    for seed in range(first, last):
        try:
            kind, text, details = judged(seed, verdict, with_loss=seed % 4 == 0)
        except Exception as problem:  # an oracle tells of everything
            kind, text, details = "failed", system(seed)[0], repr(problem)
        rates[kind] = rates.get(kind, 0) + 1
        if kind in ("wrong", "failed"):
            print(seed, kind, text, details, sep=" | ", flush=True)
    print(rates)


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
