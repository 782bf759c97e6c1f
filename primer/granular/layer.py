"""A sheared layer with waves across it, under a load: a stiff system with its Jacobian."""

from __future__ import annotations

import math

import numpy as np

from primer.checks import instance, integer, real
from primer.granular.flow_rule import NoPressure
from primer.granular.pointwise import forces
from primer.granular.state import BaseState, admit
from primer.schemes.grid import CENTRAL, Grid
from primer.types import Law


def system_of(law: Law, state: BaseState, n: int, height: float, creep: float) -> Layer:
    """The stiff system of a layer; its arguments are those of ``localise``."""
    instance("state", state, BaseState)
    tau, f = admit(law, state), float(np.max(np.abs(law.f(state.p, state.phi, state.I))))
    if state.shape != () or getattr(law, "incompressible", False) or not f < 1:
        raise ValueError(f"law must be compressible, and state a single state with |f| < 1, got |f| = {f:g}")
    grid = Grid(integer("n", n, least=4), real("height", height, above=0) * float(state.d))
    gamma, load = 2 * float(state.D) * math.sqrt(1 - f * f), float(state.p - law.f(state.p, state.phi, state.I) * tau)
    return Layer(law, state, grid, gamma, load, real("creep", creep, least=0) * float(state.D))


class Layer:
    """The layer as a stiff system: y = (w along, w across, m, log stretch, mean rate of stretch).

    m = phi stretch - phi*, so that the mass phi stretch of a slice has all its digits; its sum is conserved.
    ``creep`` is in 1/time, as ``gamma`` is.
    """

    def __init__(self, law, state, grid, gamma, load, creep):
        from scipy.sparse import csr_matrix

        self.law, self.state, self.grid = law, state, grid
        self.gamma, self.load, self.creep = gamma, load, creep
        self.lack = []
        self.D = csr_matrix(CENTRAL[1](np.eye(self.grid.n), self.grid.h).T)
        rho = float(self.state.rho)
        self.piston = 1 / (rho * self.state.phi * float(self.state.d) ** 2)
        # Units in which all unknowns are about as large: ||D|| d, 1/1000, 1/1000 and ||D||/1000.
        n, speed = self.grid.n, float(self.state.D * self.state.d)
        self.unit = np.concatenate([np.full(2 * n, speed), np.full(n, 1e-3), [1e-3, 1e-3 * self.state.D]])

    def split(self, y):
        """(w, phi, stretch, mean rate of stretch, (a, b))."""
        n = self.grid.n
        w, length, rate = y[: 2 * n].reshape(2, n), math.exp(y[-2]), y[-1]
        phi = (y[2 * n : 3 * n] + self.state.phi) / length
        w_s = CENTRAL[1](w, self.grid.h) / length
        return w, phi, length, rate, np.array([self.gamma + w_s[0], rate + w_s[1]])

    def rhs(self, t, y):
        """dy/dt, nan where there is no pressure."""
        w, phi, length, rate, (a, b) = self.split(y)
        found, reason = self.forces(a, b, phi)
        if not np.isfinite(found).all():
            self.lack = [r for r in reason if r != NoPressure.NONE]
        push = CENTRAL[1](found, self.grid.h) / length / (self.state.rho * phi)
        w_s = np.array([a - self.gamma, b - rate])
        w_t = push - w[1] * w_s - w[1] * np.array([[self.gamma], [rate]])
        mass = -CENTRAL[1](phi * w[1], self.grid.h)
        return np.concatenate([*w_t, mass, [rate, self.piston * (-found[1].mean() - self.load)]])

    def forces(self, a, b, phi):
        """((2, n) force along and across on a plane of the layer, reasons)."""
        found = forces(self.law, self.state, a, b, phi, self.creep)
        return found.flux, found.reason

    def jacobian(self, t, y):
        """d rhs/d y, from the slopes of the force at each point."""
        from scipy.sparse import bmat, csc_matrix, diags

        w, phi, length, rate, (a, b) = self.split(y)
        n, D, small = self.grid.n, self.D / length, 1e-5 * self.gamma
        steps = ((small, 0.0, 0.0), (0.0, small, 0.0), (0.0, 0.0, 1e-7))
        slopes = []
        for da, db, dphi in steps:
            up, down = (self.forces(a + s * da, b + s * db, phi + s * dphi)[0] for s in (1, -1))
            slope = (up - down) / (2 * (da + db + dphi))
            slopes.append(np.where(np.isfinite(slope), slope, 0.0))
        over, w_s = diags(1 / (self.state.rho * phi)), (a - self.gamma, b - rate)
        held = (self.gamma, rate)
        blocks: list = [[None] * 5 for _ in range(5)]
        for i in range(2):
            for j in range(2):
                blocks[i][j] = over @ D @ diags(slopes[j][i]) @ D
                if j == 1:
                    blocks[i][j] = blocks[i][j] - diags(w_s[i] + held[i])
            blocks[i][i] = blocks[i][i] - diags(w[1]) @ D
            blocks[i][2] = over @ D @ diags(slopes[2][i] / length)
            blocks[i][4] = csc_matrix((over @ (D @ slopes[1][i]) - (w[1] if i else 0 * w[1]))[:, None])
            blocks[4][i] = csc_matrix(-self.piston / n * (D.T @ slopes[i][1])[None])
        longer = -(
            slopes[0] * w_s[0] + slopes[1] * w_s[1] + slopes[2] * phi
        )  # of the forces, by the log of the stretch
        push = D @ self.forces(a, b, phi)[0].T
        for i in range(2):
            blocks[i][2] = blocks[i][2] - diags(push[:, i] / (self.state.rho * phi**2 * length))
            blocks[i][3] = csc_matrix((over @ (D @ longer[i]) + w[1] * w_s[i])[:, None])
        blocks[2][3] = csc_matrix((D @ (phi * length * w[1]))[:, None])
        blocks[4][3] = csc_matrix([[-self.piston * longer[1].mean()]])
        blocks[2][1], blocks[2][2] = -(D @ diags(phi * length)), -(D @ diags(w[1]))
        blocks[4][2] = csc_matrix(-self.piston / n * slopes[2][1][None] / length)
        blocks[4][4] = csc_matrix([[-self.piston * slopes[1][1].mean()]])
        blocks[3][3], blocks[3][4] = csc_matrix((1, 1)), csc_matrix([[1.0]])
        return csc_matrix(bmat(blocks))

    def seen(self, y):
        """(mean p, mean tau, phi, shear over its mean, width, least ||D|| over its start) of a state."""
        _, phi, _, _, (a, b) = self.split(y)
        found = forces(self.law, self.state, a, b, phi, self.creep)
        part = np.sort(np.abs(a))[::-1].cumsum()
        half = part[-1] / 2
        j = int(np.searchsorted(part, half))
        width = (j + (half - (part[j - 1] if j else 0.0)) / (part[j] - (part[j - 1] if j else 0.0))) / a.size
        return found.p.mean(), (found.p * 0 + found.T).mean(), phi, a / a.mean(), width, found.D.min() / self.state.D
