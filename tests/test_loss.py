"""Guards weak well-posedness: the power of |xi| by which data may grow, against the exponential of the matrix itself.

Second route: |exp(t A(xi))| in many digits at two large wavenumbers, for A typed by hand.
"""

import math
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest

from primer import verdict

ILL, WELL = "ill-posed", "well-posed"


@pytest.mark.parametrize(
    ("text", "loss"),
    [
        ("u_t = u_x + v_x; v_t = v_x", 1),
        ("u_t = v_xx; v_t = 0", 2),
        ("u_tt = u_xx", 0),
        ("u_tt = -u_xxxx", 0),
        ("u_tt + 2*u_tx + u_xx = 0", 1),  # (d_t + d_x)^2
        ("u_ttt + 3*u_ttx + 3*u_txx + u_xxx = 0", 2),
        ("u_t = v; v_t = w; w_t = 0", 0),  # grows like t^2, but no faster for short waves
        ("u_t = v_x; v_t = w; w_t = 0", 1),
        ("u_t = u_xx + v_x; v_t = 0", 0),  # i xi/xi^2
        ("u_t = u_xx + v_xxx; v_t = -v", 1),
        ("u_t = i*u_xx + v_x; v_t = i*v_xx", 1),
        ("u_t = u_xx + v_xxx; v_t = v_xx", 1),  # t xi^3 exp(-t xi^2) is largest, xi/e, at t = xi^-2
        ("u_t = u_xx + v_xxxx; v_t = v_xx", 2),
        ("u_t = v_x + u_xx; v_t = u_xx + v_xx", 0),
        ("u_t = w; w = v_xx; v_t = 0", 2),
        ("u_t - u_xxt + u_x = 0", 0),
        ("u_t = u_xxx", 0),
        ("u_t - u_xxt = -2*u_xx + 1e4*u_xx", 0),
        ("u_t - u_xxt = 1e9*u - 1e9*u_xx", 0),
        ("u_t = u_x + v_xx; v_t = 2*v_x", 1),  # xi^2/(xi)
        ("u_t = u_x + v_xx; v_t = v_x + 5*i*v", 2),
        ("u_tt = v_xxx; v_tt = v_xx", 2),  # v_t = xi gives v = sin(xi t), u_t = -i xi^2 (1 - cos), u ~ -i xi^2 t
        ("u_tt = 0*u_x", 0),  # q = 0: u and u_t count alike
        ("r_t + (r*u)_x = 0; u_t + u*u_x = 0", 1),
        # in the plane: where two waves keep pace, in a direction or on a curve
        ("u_tt = u_xx + u_yy", 0),
        ("u_t + p_x = 0; v_t + p_y = 0; u_x + v_y = 0", 0),
        ("h_t + u_x + v_y = 0; u_t + h_x = v; v_t + h_y = -u", 0),
        ("u_t = u_x + v_x; v_t = 2*v_y", 1),
        ("u_t = u_x + v_x + 5*i*u; v_t = 2*v_y", 1),
        ("u_t = i*u_xx + 5*u_x + v_xx; v_t = 2*i*v_yy", 2),
        ("u_t = v_y; v_t = w_y; w_t = 0*u_x", 2),
        ("u_t = u_xx + u_yy + v_xy; v_t = v_xx + v_yy", 0),
    ],
)
def test_the_power_by_hand(text, loss):
    found = verdict(text, at={"r": 1, "u": 0.3, "r_x": 0, "u_x": 0} if text.startswith("r_t") else None)
    assert (found.kind, found.loss) == (WELL, loss)
    assert isinstance(found.loss, Fraction)
    assert ("weakly" in found.reason) == (loss > 0)
    assert loss == 0 or "No perturbation grows" not in found.reason


def test_a_lower_order_term_decides():
    """Weakly well-posed; and ill-posed, with u in the second equation. What is strongly well-posed stays so."""
    weak, ill = verdict("u_t = u_x + v_x; v_t = v_x"), verdict("u_t = u_x + v_x; v_t = v_x + u")
    assert (weak.kind, weak.loss) == (WELL, 1)
    assert (ill.kind, ill.exponent, ill.coefficient) == (ILL, Fraction(1, 2), pytest.approx(0.5**0.5))
    assert ill.loss == math.inf
    strong = [verdict(f"u_t = v_x; v_t = u_x + {lower}") for lower in ("0*u", "u", "-3*v")]
    assert [found.loss for found in strong] == [0, 0, 0]  # no lower-order term moves these
    assert math.isnan(verdict("u_t + u_xxt = u_xx").loss)


@pytest.mark.parametrize("seed", range(12))
def test_the_power_against_the_exponential(seed):
    """A(xi) upper triangular with imaginary or decaying entries: its exponential at xi = 10^3 and 10^5, for t < 1."""
    random = np.random.default_rng(seed)
    size = 2 + seed % 2
    waves = [random.choice(["x", "2*x", "i*xx", "xx", "0"]) for _ in range(size)]
    symbols = {"x": lambda k: 1j * k, "2*x": lambda k: 2j * k, "i*xx": lambda k: -1j * k**2, "xx": lambda k: -(k**2),
               "0": lambda k: 0 * k}  # fmt: skip
    orders = {(r, c): int(random.integers(0, 4)) for r in range(size) for c in range(r + 1, size)}
    names = "uvw"

    def term(wave, name):
        factor, _, letters = wave.rpartition("*")
        return "0" if wave == "0" else (factor + "*" if factor else "") + f"{name}_{letters}"

    text = "; ".join(
        f"{names[r]}_t = {term(waves[r], names[r])}"
        + "".join(f" + {names[c]}" + ("_" + "x" * orders[r, c] if orders[r, c] else "") for c in range(r + 1, size))
        for r in range(size)
    )

    def matrix(k):
        A = mp.zeros(size)
        for r in range(size):
            A[r, r] = symbols[waves[r]](k)
            for c in range(r + 1, size):
                A[r, c] = (1j * k) ** orders[r, c]
        return A

    with mp.workdps(30):
        most = []
        for power in (3, 5):
            k = mp.mpf(10) ** power
            found = mp.mpf(0)
            for t in [*(mp.mpf(10) ** -mp.mpf(n) * m for n in range(0, 2 * power + 1) for m in (1, 0.37))]:
                found = max(found, mp.mnorm(_triangular(matrix(k), t), "f"))
            most.append(mp.log(found, 10))
        slope = float(most[1] - most[0]) / 2
    assert float(verdict(text).loss) == pytest.approx(max(slope, 0), abs=0.08)


def _triangular(A, t):
    """exp(t A) of an upper triangular matrix: divided differences of the exponential along all chains of entries."""
    size = A.rows
    found = mp.zeros(size)
    for r in range(size):
        found[r, r] = mp.exp(t * A[r, r])
        for c in range(r + 1, size):
            total = A[r, c] * _divided([A[r, r], A[c, c]], t)
            if c - r == 2:
                total += A[r, r + 1] * A[r + 1, c] * _divided([A[r, r], A[r + 1, r + 1], A[c, c]], t)
            found[r, c] = total
    return found


def _divided(nodes, t):
    """The divided difference of exp(t z), by splitting at two nodes that differ; a derivative where none do."""
    nodes = sorted(nodes, key=lambda z: (float(mp.re(z)), float(mp.im(z))))
    if nodes[0] == nodes[-1]:
        n = len(nodes) - 1
        return t**n * mp.exp(t * nodes[0]) / mp.factorial(n)
    return (_divided(nodes[1:], t) - _divided(nodes[:-1], t)) / (nodes[-1] - nodes[0])


def test_a_scheme_that_von_neumann_passes_diverges():
    """u_t = u_x + v_x, v_t = v_x by Lax-Friedrichs, the factors of which are all below 1: u of rough data grows with N.

    The amplification matrix is G = g I + i sin(k h) N with g = exp(i k h) at dt = h, and N nilpotent: the eigenvalues
    have |g| = 1, but G^n has n g^(n-1) i sin(k h) beside its diagonal. Lax and Richtmyer ask that all powers be
    bounded, Kreiss' theorem that the resolvent be; the eigenvalues of G ask for neither.
    """
    most = []
    for n in (32, 64, 128, 256):
        x = 2 * np.pi * np.arange(n) / n
        u, v = np.zeros(n), np.cos(n // 4 * x)  # bounded by 1
        factors = np.exp(1j * 2 * np.pi * np.arange(n) / n)
        assert np.abs(factors).max() == pytest.approx(1)  # eigenvalues of G: those of the exact shift
        for _ in range(n):  # to t = 2 pi, with dt = h
            mean, slope = (
                [(np.roll(w, -1) + np.roll(w, 1)) / 2 for w in (u, v)],
                [(np.roll(w, -1) - np.roll(w, 1)) / 2 for w in (u, v)],
            )
            u, v = mean[0] + slope[0] + slope[1], mean[1] + slope[1]
        assert np.abs(v).max() == pytest.approx(1)  # the equation that stands alone is marched exactly
        most.append(np.abs(u).max())
    assert np.log2(np.array(most[1:]) / most[:-1]) == pytest.approx([1, 1, 1], abs=0.01)  # |xi|, as loss = 1 says
    assert verdict("u_t = u_x + v_x; v_t = v_x").loss == 1
