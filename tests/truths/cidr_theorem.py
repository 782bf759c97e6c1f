"""The answers of notebook 07 by other routes than the checkers take."""

import numpy as np

from primer import exercises
from primer.granular import Friction
from primer.granular.violations import cases
from truths.reading import numbers


def truth_07_1(seed):
    """From the determinant of a matrix of numbers, assembled as the Schur complement is."""
    text = exercises.ask_07_1(seed).replace("tau/(2", "").replace("xi_1", "").replace("xi_2", "")
    A, B, Gamma, t, x1, x2 = numbers(text)
    S11 = A * np.outer([x1, -x2], [x1, -x2])
    S12 = np.array([[(1 + B) * x1, 2 * t * x2], [(1 - B) * x2, 2 * t * x1]])  # with 2 ||D|| = 1, so that tau = t
    S21 = np.array([[(1 + B) * x1, (1 - B) * x2], [x2, x1]])
    return np.linalg.det(S11 + S12 @ np.diag([1 / Gamma, 1 / 2]) @ S21)


def truth_07_2(seed):
    """By the quadrature of Lemma 1 at I = 1."""
    m, q = numbers(exercises.ask_07_2(seed))[1:3]
    return float(Friction(lambda I: 0.4 + m * I**q, lambda I: m * q * I ** (q - 1)).alpha(1.0)) - 0.8


def truth_07_3(seed):
    """From differences of Y and f at the base state."""
    text = exercises.ask_07_3(seed)
    key = {
        "constant": "constant dilatancy",
        "CIDR with": "friction falls",
        "CSSM": "dilating",
        "plus": "(b) fails",
        "normality": "normality",
    }
    name = next((name for words, name in key.items() if words in text), "all hold")
    case = next(case for case in cases() if name in case.name)
    law, p, phi, I = case.law, case.state.p, case.state.phi, case.state.I

    def slope(g, which):
        h = 1e-5
        up, down = ((p * (1 + s), phi, I) if which == "p" else (p, phi, I * (1 + s)) for s in (h, -h))
        return (g(*up) - g(*down)) / (2 * h * (p if which == "p" else I))

    Y_p, Y_I, f_p, f_I = slope(law.Y, "p"), slope(law.Y, "I"), slope(law.f, "p"), slope(law.f, "I")
    failed = {
        "the equality": abs(Y_p - I / (2 * p) * Y_I - law.f(p, phi, I) - I * f_I) > 1e-6,
        "(a)": Y_I <= 1e-9,
        "(b)": f_p - I / (2 * p) * f_I >= 0,
    }
    found = [name for name, fails in failed.items() if fails]
    assert len(found) < 2
    return found[0] if found else "none"
