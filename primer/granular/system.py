"""A plane wave on a grid as a stiff system: its right-hand side, and the Jacobian from slopes at each point."""

from __future__ import annotations

import numpy as np

from primer.granular.flow_rule import NoPressure


class System:
    """A ``PlaneWave`` on a grid, as scipy asks for it, and what was last found lacking.

    ``rhs(t, y)`` and ``jacobian(t, y)`` take the distance from the base state, flat.
    """

    def __init__(self, problem, x, derivative, source):
        from scipy.sparse import csr_matrix

        self.problem, self.x, self.derivative, self.source = problem, x, derivative, source
        self.shape = len(problem.fields), x.size
        self.base = np.repeat(problem.base, x.size)  # what is marched is the wave alone: its digits are the wave's
        dense = derivative(np.eye(x.size), 1).T
        self.D = csr_matrix(dense) if np.count_nonzero(dense) < 0.2 * dense.size else dense
        self.lack = None

    def state(self, y):
        """The fields of a flat array."""
        return (y + self.base).reshape(self.shape)

    def rhs(self, t, y):
        """The time derivatives, flat; nan where a point has no pressure."""
        state = self.state(y)
        with np.errstate(all="ignore"):
            found = np.array(self.problem.rhs(self.x, state, self.derivative))
        if not np.isfinite(found).all():
            self.lack = t, self.lacking(state)
        return (found if self.source is None else found + self.source(self.x, t)).ravel()

    def lacking(self, state):
        """The reasons at points that have no pressure."""
        if not np.isfinite(state).all():
            return [NoPressure.NOT_FINITE]
        reasons = self.stress(state).reason
        return [r for r in reasons if r != NoPressure.NONE]

    def least_shear(self, state):
        """The smallest ||D|| over that of the base flow."""
        problem = self.problem
        e, o, _ = problem.frame.rates(self.derivative(state[: 1 if problem.incompressible else 2], 1))
        return np.hypot(e, o).min() / problem.frame.D

    def stress(self, state):
        """The ``Local`` stress of a state."""
        if self.problem.incompressible:
            return self.problem.local(self.derivative(state, 1), self.problem.state.phi)
        return self.problem.local(self.derivative(state[:2], 1), state[2])

    def jacobian(self, t, y):
        """d rhs/d y, from the slopes of the force at each point: sums of diagonal matrices times the derivative."""
        from scipy.sparse import bmat, csc_matrix

        problem, D = self.problem, self.D
        state = self.state(y)
        dense = isinstance(D, np.ndarray)
        rho = problem.state.rho
        diag = _diagonal(dense)
        if problem.incompressible:
            (F,) = self._slopes(state)
            J = D @ diag(F[0]) @ D / (rho * problem.state.phi)
            return J if dense else csc_matrix(J)
        G, H, B = self._slopes(state)
        w, phi = state[:2], state[2]
        w_s, force = self.derivative(w, 1), self.derivative(self.stress(state).flux, 1)
        n = problem.frame.n
        across = n @ w
        over = diag(1 / (rho * phi))
        shear = 2 * problem.state.D * problem.frame.m if problem.simple_shear else np.zeros(2)
        blocks: list = [[None] * 3 for _ in range(3)]
        for i in range(2):
            for j, slope in enumerate((G, H)):
                block = over @ D @ diag(slope[i]) @ D - diag(n[j] * (w_s[i] + shear[i]))
                blocks[i][j] = block - diag(across) @ D if i == j else block
            blocks[i][2] = over @ D @ diag(B[i]) - diag(force[i] / (rho * phi**2))
            blocks[2][i] = -n[i] * (D @ diag(phi))
        blocks[2][2] = -(D @ diag(across))
        return np.block(blocks) if dense else csc_matrix(bmat(blocks))

    def _slopes(self, state):
        """Of the force at each point, by each velocity gradient and, if it varies, by phi: central differences."""
        problem = self.problem
        velocities = state[: self.shape[0] - (not problem.incompressible)]
        gradient = self.derivative(velocities, 1)
        phi = problem.state.phi if problem.incompressible else state[2]
        step, out = 1e-5 * float(problem.state.D), []
        for j in range(len(gradient)):
            change = np.zeros_like(gradient)
            change[j] = step
            up, down = problem.local(gradient + change, phi).flux, problem.local(gradient - change, phi).flux
            out.append((up - down) / (2 * step))
        if not problem.incompressible:
            up, down = problem.local(gradient, phi + 1e-7).flux, problem.local(gradient, phi - 1e-7).flux
            out.append((up - down) / 2e-7)
        return [np.where(np.isfinite(slope), slope, 0.0) for slope in out]  # at an edge of what has a pressure


def _diagonal(dense):
    if dense:
        return np.diag
    from scipy.sparse import diags

    return diags
