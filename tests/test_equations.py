"""Guards the order of every stencil and every step on equations whose solutions are known, each written as a text.

Linear ones of every order to the eighth, waves, Burgers (Cole-Hopf), solitons, and forcings with a known answer.
"""

from dataclasses import dataclass

import numpy as np
import pytest

from primer import CENTRAL, CENTRAL_4, CENTRAL_6, EULER, FOURIER, PDE, RK4, RK8, march_lines
from primer.schemes.jacobian import rates
from primer.schemes.limit import largest_step


@dataclass(frozen=True)
class Case:
    """A problem, its solution u(x, t) for the first field, the coarser of two grids, and how far it is marched."""

    pde: PDE
    exact: object
    n: int = 24
    t_end: float = 0.1
    linear: PDE | None = None  # the part that limits the step, where the whole cannot be linearised

    def limit(self, n, space, time):
        """The largest stable step."""
        return largest_step(rates(self.linear or self.pde, n, space=space), time)


def wave(m):
    """u_t = +- the m-th derivative, the sign that does not grow: one wave that decays, or travels."""
    sign = -1 if m % 4 == 0 else 1
    text = f"u_t = {'-' if sign < 0 else ''}u_{'x' * m}"
    factor = sign * 1j**m
    t_end = 0.05 if m < 4 else 600 / 14**m  # some hundred steps on the finest grid
    return Case(PDE(text, {"u": "sin(x)"}), lambda x, t: np.exp(1j * x + factor * t).imag, 22, t_end)


def burgers(flux):
    """Cole and Hopf: u = -2 nu phi_x/phi, phi_t = nu phi_xx."""
    nu, phi = 0.3, lambda t: np.exp(-0.3 * t)
    pde = PDE(f"u_t = nu*u_xx - {flux}", {"u": "2*nu*sin(x)/(2 + cos(x))"}, nu=nu)
    return Case(pde, lambda x, t: 2 * nu * phi(t) * np.sin(x) / (2 + phi(t) * np.cos(x)), 128, 0.1)


U, U_X = "(cos(t)*sin(x)/2)", "(cos(t)*cos(x)/2)"


def sech2(x):
    return 1 / np.cosh(x) ** 2


CASES = {f"derivative {m}": wave(m) for m in range(1, 9)} | {
    "Burgers, conserved": burgers("(u^2/2)_x"),
    "Burgers, expanded": burgers("u*u_x"),
    "wave equation": Case(
        PDE("u_tt = c^2*u_xx", {"u": "sin(x)", "u_t": "-c*cos(x)"}, c=1.5), lambda x, t: np.sin(x - 1.5 * t), 24, 0.5
    ),
    "Korteweg-de Vries": Case(
        PDE("u_t + 6*u*u_x + u_xxx = 0", {"u": "1/cosh(sqrt(c)/2*x)^2*c/2"}, period=40.0, c=2.0),
        lambda x, t: sech2(np.sqrt(2) / 2 * (x - 2 * t)),
        320,
        0.02,
    ),
    "good Boussinesq": Case(
        PDE(
            "u_tt = u_xx - u_xxxx + (u^2)_xx",
            {"u": "-3/2*(1 - c^2)/cosh(b*x)^2", "u_t": "-3*b*c*(1 - c^2)*sinh(b*x)/cosh(b*x)^3"},
            period=60.0, c=0.5, b=np.sqrt(0.75) / 2,
        ),
        lambda x, t: -1.125 * sech2(np.sqrt(0.75) / 2 * (x - 0.5 * t)),
        360,
        0.05,
    ),
    "cubic Schroedinger": Case(
        PDE("i*u_t + u_xx + 2*abs(u)^2*u = 0", {"u": "exp(i*x/2)/cosh(x)"}, period=16 * np.pi),
        lambda x, t: np.exp(1j * (x / 2 + 0.75 * t)) / np.cosh(x - t),
        640,
        0.02,
        PDE("i*u_t + u_xx = 0", {"u": 1}, period=16 * np.pi),
    ),
    "travelling wave of a forced Kuramoto-Sivashinsky": Case(
        PDE(
            "u_t = -u_xxxx - u_xx - (u^2/2)_x + (sin(x - t)*cos(x - t) - cos(x - t))", {"u": "sin(x)"}
        ),
        lambda x, t: np.sin(x - t),
        32,
        0.003,
    ),
    "forced nonlinear diffusion, in brackets": Case(
        PDE(
            f"u_t = ((1 + u^2)*u_x)_x - sin(t)*sin(x)/2 + (1 + {U}^2)*{U} - 2*{U}*{U_X}^2", {"u": "sin(x)/2"}
        ),
        lambda x, t: np.cos(t) * np.sin(x) / 2,
        64,
        0.02,
    ),
}  # fmt: skip


def error(case, n, dt, space, time):
    end = march_lines(case.pde, n, dt, case.t_end, space, time)
    return np.abs(end.final[0] - case.exact(end.x, case.t_end)).max()


@pytest.mark.slow
@pytest.mark.parametrize("space", [CENTRAL, CENTRAL_4, CENTRAL_6], ids=["2", "4", "6"])
@pytest.mark.parametrize("name", CASES)
def test_order_of_every_stencil(name, space):
    case = CASES[name]
    errors = []
    for n in (case.n, 2 * case.n):
        dt = min(0.7 * case.limit(n, space, RK8), case.t_end / 4)
        errors.append(error(case, n, dt, space, RK8))
    rounding = 5e-14 if name == "derivative 8" and space is CENTRAL_6 else 0  # of what is left, some 1e-13
    low, high = (errors[0] / 2 ** (space[1].order + slack) for slack in (0.1, -0.1))
    assert low - rounding < errors[1] < high + rounding, errors


TIMED = {name: CASES[name] for name in ("derivative 1", "derivative 2", "wave equation")} | {
    name: CASES[name] for name in CASES if name.startswith(("Burgers", "forced"))
}
TIMED["clock"] = Case(PDE("u_t = cos(t + x)*u - sin(2*t)", {"u": 1}), None)
TIMED["complex"] = Case(PDE("i*u_t + u_xx + (1 + x^2/9)*u = sin(t)", {"u": "exp(i*x)"}), None)


@pytest.mark.parametrize("time", [EULER, RK4, RK8], ids=lambda time: time.name)
@pytest.mark.parametrize("name", TIMED)
def test_order_of_every_step(name, time):
    """Against a march with much smaller steps on the same grid, so that space has no part in it."""
    case, n = TIMED[name], 8
    t_end = 1.0 if name == "clock" else 4 * case.limit(n, FOURIER, RK8)
    steps = {"clock": 3}.get(name, 8 if "Burgers" in name else 12 if "forced" in name else 6)
    steps = {"Euler": 1024, "RK4": 64, "RK8": steps}[time.name]
    truth, coarse, fine = (
        np.array(march_lines(case.pde, n, t_end / k, t_end, FOURIER, of).final)
        for k, of in ((100, RK8), (steps, time), (2 * steps, time))
    )
    errors = [np.abs(end - truth).max() for end in (coarse, fine)]
    # Of the eighth order little is left between steps that are too large for it and rounding.
    assert abs(np.log2(errors[0] / errors[1]) - time.order) < (0.75 if time is RK8 else 0.1), errors
