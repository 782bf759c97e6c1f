"""The answers of notebook 01 by other routes than the checkers take."""

import re

import numpy as np
from scipy.optimize import brentq

from primer import BackwardHeat, exercises
from primer.exercises.what_ill_posed_means import A_WHILE, ALWAYS, NEVER

X = np.arange(512) * 2 * np.pi / 512


def truth_01_1(seed):
    """From the exact solution at its crest, by bracketing."""
    digits, xi = map(int, re.search(r"10\^-(\d+) sin\((\d+) x\)", exercises.ask_01_1(seed)).groups())
    ripple = BackwardHeat(xi, 10.0**-digits)
    return brentq(lambda t: ripple.exact(np.pi / (2 * xi), t)[0] - 1, 0, 40 / xi**2, xtol=1e-12)


def truth_01_2(seed):
    """From the slope of ln |c_n| against n^2, by FFT."""
    s = float(re.search(r"s = ([\d.]+\d)", exercises.ask_01_2(seed))[1])
    u = sum(np.exp(-((X - np.pi + 2 * np.pi * m) ** 2) / (2 * s**2)) for m in range(-3, 4))
    n = np.arange(1, 8)
    return -np.polyfit(n**2, np.log(np.abs(np.fft.fft(u))[n]), 1)[0]


def truth_01_3(seed):
    """From the bend of ln |c_n|, c_n by FFT: like -s n^2 if it bends down steadily; none left if the series ends."""
    text = re.search(r"u\(x, 0\) = (.*)\. Is there", exercises.ask_01_3(seed))[1]
    n = np.arange(60)[:, None]
    u = {
        "1/(2 - cos x)": 1 / (2 - np.cos(X)),
        "|sin x|^3": np.abs(np.sin(X)) ** 3,
        "|sin x|^7": np.abs(np.sin(X)) ** 7,
        "sin(x)^3": np.sin(X) ** 3,
        "sin(x)^4": np.sin(X) ** 4,
        "the sum over n of exp(-n^2/50) cos(n x)": (np.exp(-(n**2) / 50) * np.cos(n * X)).sum(axis=0),
    }[text]
    c = np.abs(np.fft.fft(u))[1:200] / X.size
    c = c[c.argmax() % 2 :: 2]  # of one parity
    kept = np.argmax(np.append(c, 0) < 1e-10)
    if c[kept:].size and c[kept:].max() < 1e-15:
        return ALWAYS
    bend = np.diff(np.log(c[:kept]), 2)
    return A_WHILE if bend[0] < -0.01 and 0.8 < bend[-1] / bend[0] < 1.2 else NEVER
