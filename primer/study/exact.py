"""The paper's scheme without round-off: whole numbers of many digits, and the mirror symmetry kept exactly.

Round-off ends an ill-posed run early, so one may think that it is to blame. Here it is taken away. The data of
eq. (toy-initial) keep u even and v odd about x = 0: half the grid says it all. Numbers are whole multiples of 2^-B, in
which sums are exact and a product loses less than one of them. With c = dt/(2h) and s = eps dt/h^2 the scheme for
U = s u and V = s c v needs three products at a point::

    U <- U + V[j+1] - V[j-1]
    V <- V + c^2 (U[j+1] - U[j-1]) + U (V[j+1] - 2 V[j] + V[j-1]) - dt V - s c dt sin x
"""

from __future__ import annotations

import math

import numpy as np

from primer.arithmetic import arithmetic
from primer.checks import instance, integer
from primer.problems.toy import Toy
from primer.schemes.progress import step_bar
from primer.schemes.record import Log, plan
from primer.schemes.run import Run

MOST_DIGITS = 1900  # digits
_FIRST = 64  # digits to begin with where none are stated, to be doubled until they are enough
_SPARE = 10  # digits below 1 at which round-off must have stayed
_AT_LARGE = 2.0  # Dist from which on the run is lost, and the growth of round-off no longer counts; it is 1 at t = 0


def exact_march(
    toy: Toy,
    n: int = 100,
    dt: float = 1e-3,
    t_end: float = 100.0,
    digits: int | None = None,
    record_every: int | None = None,
    blow_up_at: float = 1e3,
    progress: bool = True,
) -> Run:
    """March ``toy`` as ``ftcs`` does, by the scheme of section A2.2.2, with no round-off to speak of.

    An ill-posed run blows up all the same, later: the smooth solution itself is lost. Its Fourier coefficients fall
    only exponentially with the wavenumber k, while where u < 0 wave k grows like e^{eps k^2 |u| t}.

    What rounding leaves, 10^-digits, grows too. In the energy of (u_x, v_x) a perturbation grows at most at the rate
    max(0, 4 eps max(-u)/h^2 - 1) + eps max|v_xx|/h + dt/(2 h^2), the last for the steps; digits are enough if it is
    still below 1e-10 when the run is lost.

    A step on 100 points in 126 digits takes a thirtieth of the time that it takes ``ftcs`` with ``digits=126``, and a
    run to t = 92.4 in 92,400 steps about half a minute.

    Parameters
    ----------
    toy                         a ``Toy``
    n, dt, t_end                grid points >= 4, step > 0, end >= 0
    digits : int                decimal digits after the point, 2 to 1900; with None as many as are enough
    record_every, blow_up_at,
    progress                    as for ``ftcs``

    Returns
    -------
    Run, rounded to double precision; also when it blows up or is interrupted

    Raises
    ------
    TypeError, ValueError    in one sentence, for an argument that is not allowed, or if 1900 digits are not enough

    >>> from primer import Toy, exact_march
    >>> run = exact_march(Toy(-0.5, eps=0.05), n=40, t_end=20.0)
    >>> print(run.stop, f"{run.t_stop:.2f}")
    blew_up 5.35
    """
    instance("toy", toy, Toy)
    asked = plan(n, dt, t_end, record_every, (), None, blow_up_at, np.float64, None)
    asked.refuse_if_large(fields=2)
    if digits is not None:
        digits = integer("digits", digits, least=2, most=MOST_DIGITS)
        with step_bar(asked.steps, progress) as tell:
            return _march(toy, asked, digits, False, tell)
    digits = _FIRST
    while True:
        with step_bar(asked.steps, progress) as tell:
            run = _march(toy, asked, digits, True, tell)
        if run is not None:
            return run
        if digits == MOST_DIGITS:
            raise ValueError(
                f"t_end, n and dt must be such that {MOST_DIGITS} digits are enough, got n = {asked.grid.n} and "
                f"{asked.steps} steps of {asked.dt:g}"
            )
        digits = min(2 * digits, MOST_DIGITS)


def _march(toy, asked, digits, enough, tell):
    """The run; None if digits must be ``enough`` and round-off has come near."""
    numbers, log = _Numbers(toy, asked, digits), Log(asked, np.array(toy.steady(asked.grid.x)))
    half = asked.grid.n // 2 + 1
    lost, state, interrupted = 0.0, np.array(toy.initial(asked.grid.x)), False
    log.watch(0, state)
    rate = _rate(toy, asked, state)
    try:
        while log.running:
            step = int(log.clock[0])
            todo = min(asked.every - step % asked.every, asked.steps - step)
            done, negative = numbers.advance(todo, log.steady[0, :half], log.limit)
            if log.clock[1] < 0 <= negative:
                log.clock[1] = step + negative
            state, before = numbers.fields(), rate
            if log.measure(state)[0] <= _AT_LARGE**2:
                rate = _rate(toy, asked, state)
                lost += done * asked.dt * max(before, rate) / math.log(10)
            if enough and lost + _SPARE > digits:
                return None
            log.watch(step + done, state)
            tell(step + done)
    except KeyboardInterrupt:
        interrupted = True
    return log.run(toy, state, interrupted)


def _rate(toy, asked, state):
    """The rate at which round-off grows, at most."""
    h, (u, v) = asked.grid.h, state
    bend = np.abs(np.roll(v, 1) - 2 * v + np.roll(v, -1)).max() / h**2
    return max(0.0, -4 * toy.eps * u.min() / h**2 - 1) + toy.eps * bend / h + asked.dt / (2 * h**2)


class _Numbers:
    """U and V on the half grid from x = -pi on, as whole numbers."""

    def __init__(self, toy, asked, digits):
        n, half = asked.grid.n, asked.grid.n // 2 + 1
        h, dt, eps = asked.grid.h, asked.dt, toy.eps
        # u = U/s and v = V/(s c) have fewer digits after the point than U and V.
        extra = math.ceil(-math.log10(min(1.0, (eps * dt / h**2 or 1.0) * min(1.0, dt / (2 * h))))) + 1
        self.bits = math.ceil((digits + extra) * math.log2(10))
        exact = arithmetic(digits=math.ceil((self.bits + 64) * math.log10(2)))
        number, one = exact.number, exact.number(2) ** self.bits
        h, dt = 2 * exact.pi / n, number(dt)
        c, s = dt / (2 * h), number(eps) * dt / h**2 if eps else number(1)
        sin_x = [-number.context.sin(h * j) if 0 < 2 * j < n else number(0) for j in range(half)]

        def whole(*values):
            return np.array([int(number.context.nint(z * one)) for z in values], dtype=object)

        self.U, self.V = whole(*[s * toy.a] * half), whole(*(-s * c * z / 2 for z in sin_x))
        self.S, (self.K, self.T) = whole(*(s * c * dt * z for z in sin_x)), whole(c * c, dt)
        self.odd, self.bent, self.scales = bool(n % 2), eps > 0, (float(1 / s), float(1 / (s * c)))

    def fields(self):
        """(u, v) on the whole grid, in double precision."""
        u, v = self._floats()
        turn = slice(None if self.odd else -1)  # x = 0 is its own image; x = -pi is, too
        return np.array([np.concatenate((u, u[turn][:0:-1])), np.concatenate((v, -v[turn][:0:-1]))])

    def advance(self, steps, steady, limit):
        """Take ``steps`` steps, fewer if Dist^2 exceeds ``limit``: (steps done, the first with u <= 0 or -1)."""
        negative, back = -1, slice(-1, None) if self.odd else slice(-2, -1)
        for step in range(1, steps + 1):
            U, V = self.U, self.V
            u, v = np.concatenate((U[1:2], U, U[back])), np.concatenate((-V[1:2], V, -V[back]))
            change = self.K * (u[2:] - u[:-2]) - self.T * V
            ahead, behind = v[2:], v[:-2]
            if self.bent:
                change += U * (ahead + behind - 2 * V)
            self.U, self.V = U + ahead - behind, V + (change >> self.bits) - self.S
            now_u, now_v = self._floats()
            if negative < 0 and now_u.min() <= 0:
                negative = step
            if not ((now_u - steady) ** 2 + now_v**2).max() <= limit:
                return step, negative
        return steps, negative

    def _floats(self):
        return (
            (f / 2**self.bits).astype(float) * scale for f, scale in zip((self.U, self.V), self.scales, strict=True)
        )
