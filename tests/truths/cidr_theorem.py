"""The answers of notebook 07 by other routes than the checkers take."""

import numpy as np
from scipy.optimize import brentq

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


def truth_07_5(seed):
    """By a difference of p + Y along p, with ||D|| held and Y its tangent plane."""
    p, I, Y_p, Y_I = numbers(exercises.ask_07_5(seed).split("psi = 0")[0])

    def stress(q):
        return q + Y_p * (q - p) + Y_I * (I * np.sqrt(p / q) - I)

    return (stress(p + 1e-5) - stress(p - 1e-5)) / 2e-5


def truth_07_6(seed):
    """By a difference of div u - 2 f ||D|| along the first velocity's gradient, about ||D|| = 1."""
    text = exercises.ask_07_6(seed)
    I, f, f_I = numbers(text.split("By Table")[0])
    f = -f if "f = -" in text else f

    def rule(g):
        u_x, v_y = g + f - 1, f + 1  # div u = 2 f ||D||, compressed along the first axis
        D = np.abs(u_x - v_y) / 2
        return u_x + v_y - 2 * (f + f_I * (I * D - I)) * D

    return (rule(1e-6) - rule(-1e-6)) / 2e-6


def truth_07_7(seed):
    """Straight friction has mu'(sI) = mu'(I), the limit of the estimate: its alpha and beta by quadrature."""
    text = exercises.ask_07_7(seed)
    m = numbers(text)[0]
    straight = Friction(lambda I: 0.4 + m * I, lambda I: m + 0 * I)
    part = straight.beta if "beta" in text else straight.alpha
    return float(part(1.5) - part(0.5))


def truth_07_8(seed):
    """By a root of the yield condition in z."""
    p, alpha, tau = numbers(exercises.ask_07_8(seed).split("a flow has")[1])[:3]
    return brentq(lambda z: tau - alpha * p + p * p * (1 - z) / z, 1e-9, 1.0)
