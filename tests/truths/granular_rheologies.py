"""The answers of notebook 06 by other routes than the checkers take."""

import math
import re

import numpy as np

from primer import exercises
from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    BaseState,
    Coulomb,
    Friction,
    IncompressibleMuI,
    largest_growth,
    linearise,
)
from truths.reading import numbers


def truth_06_1(seed):
    """By searching all directions."""
    mu = numbers(exercises.ask_06_1(seed))[0]
    _, xi = largest_growth(Coulomb(mu), BaseState(p=0.3, phi=0.55, I=0.1), 10.0)
    return math.degrees(math.atan2(xi[1], xi[0]))


def truth_06_2(seed):
    """By bisection on the growth rates of a friction that is a power of I."""
    mu = numbers(exercises.ask_06_2(seed))[0]
    low, high = 0.0, 0.4
    while high - low > 1e-9:
        n = (low + high) / 2
        friction = Friction(lambda I, n=n: mu * I**n, lambda I, n=n: n * mu * I ** (n - 1))
        rate, _ = largest_growth(IncompressibleMuI(friction), BaseState(p=0.3, phi=0.55, I=1.0), 10.0)
        low, high = (n, high) if rate > 0 else (low, n)
    return low


def truth_06_3(seed):
    """From eigenvalues of the pencil at three wavenumbers, in 361 directions."""
    text = exercises.ask_06_3(seed)
    I, ratio = map(float, re.search(r"I = ([\d.]+) and p/C = ([\d.]+)", text).groups())
    law = {
        "mu(I)": IncompressibleMuI(GLASS_BEADS.friction),
        "CSSM": CSSM(math.tan(math.radians(21)), EXAMPLE_COMPACTION),
        "CIDR": CIDR(GLASS_BEADS.friction, EXAMPLE_COMPACTION),
    }[re.search(r"under (\S+) at", text)[1]]
    pencil = linearise(law, BaseState(ratio * EXAMPLE_COMPACTION.C(0.55), 0.55, I))
    theta = np.linspace(0, np.pi / 2, 361)
    k = np.array([1.0, 100.0, 1000.0])
    rates = pencil.eigenvalues(k[:, None] * np.stack([np.cos(theta), np.sin(theta)])[:, None]).real.max(axis=(1, 2))
    if rates[2] > 3 * rates[1] > 0:
        return "ill posed"
    return "unstable but bounded" if rates.max() > 0 else "damped"
