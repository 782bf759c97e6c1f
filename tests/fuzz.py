"""Hostile input by the hundred thousand: no text may raise anything but PDEError, or hang.

    python tests/fuzz.py [cases] [--every 50] [--seed 1]

Each case is parsed; one in ``--every`` is also linearised and judged, with random base-state values. A case that takes
more than ``LIMIT`` seconds of this process's time is ended by an alarm and counts as a hang.
"""

import argparse
import random
import signal
from collections import Counter

from primer import PDEError, growth, linearise, verdict
from primer.analysis.symbolic import pencil
from primer.equations.text import FUNCTIONS, LENGTH, parse

LIMIT = 30
GOOD = (
    "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)",
    "u_t = -u_xx",
    "u_t + u*u_x + v*u_y = -p_x + nu*(u_xx + u_yy); v_t + u*v_x + v*v_y = -p_y + nu*(v_xx + v_yy); u_x + v_y = 0",
    "(h)_t + (h*u)_x = 0\n(h*u)_t + (h*u^2 + g*h^2/2)_x = -c*abs(u)*u",
    "u_tt = u_xx - sin(u)",
    "u_t = 2i*u_xx + exp(-u^2)/sqrt(1 + u_x**2)",
    r"\frac{\partial u}{\partial t} + u\,\frac{\partial u}{\partial x} = \nu \frac{\partial^2 u}{\partial x^2}",
    "∂u/∂t = ∇·(u∇u) + ∂²u/∂x∂y - |u|^2 u, ∂_t v = Δv + d/dx(u v) # and more",
    "du/dt = div(u grad(u)) + lap(lap(u)) + e^{-u} + max(u, 0)",
)
PIECES = (
    *"uvwxytipe=+-*/^();\n\t .,0123456789_",
    *(
        "u_t",
        "v_t",
        "u_x",
        "v_xx",
        "u_xy",
        "_x",
        "_t",
        "__",
        "u_",
        "**",
        "pi",
        "eps",
        "2i",
        "1e5",
        "1e-300",
        "1e999",
        ".5",
    ),
    *("= ", " = ", "; ", "u_t = ", "(", ")", "(", ")", *(f"{name}(" for name in FUNCTIONS)),
    *(
        "∂",
        "∂_t",
        "∂/∂x",
        "∂u/∂x",
        "∇",
        "∇²",
        "∇·",
        "Δ",
        "d/dx",
        "du/dt",
        "lap(",
        "grad(",
        "div(",
        "dot(",
        "e^",
        "uₓ",
        "²",
    ),
    *(
        r"\frac{",
        r"\partial",
        r"\nu",
        r"\left(",
        r"\right)",
        r"\,",
        r"\sqrt",
        r"\sin",
        r"\\",
        "}{",
        "_{xx}",
        "_{x x}",
        "^{",
    ),
    *"\0\r\f\u00b2\u00b7\u00d7\u2212\u03b5\u0661\u200b\u202e\ud800\uff55\U0001d7d8@#$%&[]{}<>?!|\\'\"`~:",
)
SHAPES = (
    *("{a}+{b}", "{a}-{b}", "{a}*{b}", "{a}/{b}", "({a})/({b})", "({a})^({b})", "({a})^2", "-{a}"),
    *(
        "{a} {b}",
        "2({a})",
        "|{a}|",
        "lap({a})",
        "div(({a}) grad({b}))",
        "d/dx({a})",
        "max({a}, {b})",
        r"\frac{{{a}}}{{{b}}}",
    ),
    *("({a})_x", "({a})_yt", "{f}({a})", "{f}({a})_xx"),
)


def soup(rng):
    return "".join(rng.choices(PIECES, k=rng.choice((3, 10, 30, 100))))


def spoiled(rng):
    """A good text with a few characters taken out, put in, doubled or moved."""
    text = rng.choice(GOOD)
    for _ in range(rng.randint(1, 6)):
        a, b = sorted(rng.choices(range(len(text) + 1), k=2))
        piece = rng.choice(PIECES)
        text = rng.choice(
            (text[:a] + piece + text[a:], text[:a] + text[a + 1 :], text[:b] + text[a:], text[:a] + text[b:])
        )
    return text


def letters(rng):
    """Any characters there are, the surrogates among them."""
    kinds = rng.choices((128, 0x3000, 0x110000), k=rng.randint(0, 40))
    return "u_t = " * rng.randint(0, 1) + "".join(chr(rng.randrange(kind)) for kind in kinds)


def tree(rng, depth):
    """An expression by the grammar, so that it gets past the parser."""
    if depth == 0 or rng.random() < 0.2:
        return rng.choice(
            ("u", "v", "u_x", "u_xx", "v_xy", "a", "x", "y", "t", "0", "1", "2", "3.5", "1e-9", "i", "pi")
        )
    a, b = tree(rng, depth - 1), tree(rng, depth - 1)
    shape = rng.choice(SHAPES)
    return shape.format(a=a, b=b, f=rng.choice(FUNCTIONS))


def grown(rng):
    left = rng.choice(("u_t", "u_t", "u_tt", "(u)_t", "u_xt - u_x", "a*u_t", "0"))
    text = f"{left} = {tree(rng, rng.randint(1, 5))}"
    return text if rng.random() < 0.5 else f"{text}; {rng.choice(('v_t', 'u_x', 'v'))} = {tree(rng, rng.randint(1, 3))}"


def repeated(rng):
    """One piece many times over, about the limits of length, of depth and of symbols."""
    piece = rng.choice(PIECES) * rng.choice((1, 2, 70, 79, 80, 81, 299, 600, LENGTH, LENGTH + 1))
    return ("u_t = " * rng.randint(0, 1) + piece + rng.choice(("", "u", ")" * len(piece))))[: LENGTH + 2]


def too_long(*_):
    raise TimeoutError(f"more than {LIMIT} s")


def tried(call, text, **arguments):
    """What came of one case: "accepted" or "refused"; anything but a PDEError is a fault."""
    signal.setitimer(signal.ITIMER_VIRTUAL, LIMIT)
    try:
        call(text, **arguments)
        return "accepted"
    except PDEError:
        return "refused"
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)


def rates(text, at):
    """Growth rates at one wavenumber, or one wavevector."""
    system = pencil(text, at=at)
    return growth(system, 3.0 if system.dim == 1 else (3.0, -2.0))


def run(cases, every=50, seed=1):
    """Counts of what came of so many cases, and the faults: a list of (call, text, exception)."""
    signal.signal(signal.SIGVTALRM, too_long)
    rng, counts, faults = random.Random(seed), Counter(), []
    values = {
        name: (0, 0.0, -0.5, 1, 2.5, 1e9, 1j) for name in ("u", "v", "u_x", "u_xx", "v_xy", "v_xx", "x", "y", "t", "a")
    }
    for n in range(cases):
        text = rng.choice((soup, spoiled, letters, grown, repeated))(rng)
        calls = [(parse, {})]
        if n % every == 0:
            text = rng.choice((spoiled, grown, grown))(rng)
            at = {name: rng.choice(of) for name, of in values.items() if name in text and rng.random() < 0.9}
            calls += [(linearise, {"at": at}), (verdict, {"at": at}), (rates, {"at": at})]
        for call, arguments in calls:
            try:
                counts[call.__name__, tried(call, text, **arguments)] += 1
            except Exception as fault:  # which is what is looked for
                faults.append((call.__name__, text, arguments, fault))
    return counts, faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", type=int, nargs="?", default=100_000)
    parser.add_argument("--every", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    counts, faults = run(chosen.cases, chosen.every, chosen.seed)
    for (call, outcome), count in sorted(counts.items()):
        print(f"{call:13} {outcome:9} {count}")
    for call, text, arguments, fault in faults:
        print(f"FAULT in {call}({text[:200]!r}, {arguments}): {type(fault).__name__}: {fault}")
    raise SystemExit(bool(faults))


if __name__ == "__main__":
    main()
