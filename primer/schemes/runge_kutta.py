"""Explicit Runge-Kutta steps, as tables of numbers with their source.

``EULER``, ``RK4`` (Kutta 1901) and ``RK8`` (Dormand & Prince; Hairer, Norsett & Wanner (1993)) march y' = -y to t = 1:

>>> for step in (EULER, RK4, RK8):
...     y = np.array([1.0])
...     for _ in range(4):
...         y = step.step(lambda y: -y, y, 0.25)
...     print(step.name, step.order, f"{abs(y[0] - np.exp(-1)):.0e}")
Euler 1 5e-02
RK4 4 1e-05
RK8 8 4e-13
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np


@dataclass(frozen=True)
class RungeKutta:
    """An explicit Runge-Kutta step for y' = f(y)::

        k_i = f(y + dt sum_{j<i} A[i, j] k_j),    y(t + dt) ~ y + dt sum_i b[i] k_i

    with an error of order dt^order over a fixed time; where f depends on t as well, stage i is at t + dt sum_j A[i, j].

    Attributes
    ----------
    order    the order of accuracy
    rows     the rows of A below its first, zero one; row i has its first i entries
    b        the weights
    reach    the eigenvalues lam of f for which the step does not grow include Re lam <= 0, |lam| dt <= reach
    """

    name: str
    order: int
    rows: tuple[tuple[float, ...], ...] = field(repr=False)
    b: tuple[float, ...] = field(repr=False)
    reach: float

    @cached_property
    def table(self) -> tuple[np.ndarray, np.ndarray]:
        """(A, b) as read-only arrays of shape (s, s) and (s,), for s stages."""
        A, b = np.zeros((len(self.b), len(self.b))), np.array(self.b)
        for i, row in enumerate(self.rows, start=1):
            A[i, :i] = row
        A.flags.writeable = b.flags.writeable = False
        return A, b

    @cached_property
    def nodes(self) -> tuple[float, ...]:
        """(s,) the times of the stages in units of dt: the sums of the rows of A."""
        return tuple(math.fsum(row) for row in ((), *self.rows))

    def step(self, f: Callable, y: np.ndarray, dt: float, t: float | None = None) -> np.ndarray:
        """The state one step dt after the array y, where ``f(y)`` gives y'; or, where t is given, ``f(y, t)``."""
        return _combine(y, dt, self.b, self._slopes(f, y, dt, t))

    def exact_step(self, f: Callable, y: np.ndarray, lost: np.ndarray, dt: float, t: float | None = None) -> tuple:
        """The same by Kahan's sum: (state, what rounding took from it), where ``lost`` was so taken in the step before.

        So rounding does not pile up in a hundred thousand steps.
        """
        change = _combine(lost, dt, self.b, self._slopes(f, y, dt, t))
        new = y + change
        return new, change - (new - y)

    def _slopes(self, f, y, dt, t):
        slopes: list[np.ndarray] = []
        for row, node in zip(((), *self.rows), self.nodes, strict=True):
            at = _combine(y, dt, row, slopes)
            slopes.append(f(at) if t is None else f(at, t + node * dt))
        return slopes


def _combine(y, dt, weights, slopes):
    for weight, k in zip(weights, slopes, strict=True):
        if weight:
            y = y + dt * weight * k
    return y


#: Forward Euler, the step of the paper's scheme. Of its region of stability, no half disc about 0 is a part.
EULER = RungeKutta("Euler", 1, (), (1.0,), reach=0.0)

#: The classical step of fourth order (Kutta 1901). The largest half disc in its region of stability has radius 2.6.
RK4 = RungeKutta("RK4", 4, ((0.5,), (0, 0.5), (0, 0, 1.0)), (1 / 6, 1 / 3, 1 / 3, 1 / 6), reach=2.6)

#: The step of eighth order and twelve stages by Dormand and Prince, as in the code DOP853 of E. Hairer,
#: S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd ed., Springer 1993 (whose step control is
#: not used here). The largest half disc in its region of stability has radius 5.9.
RK8 = RungeKutta(
    "RK8",
    8,
    (
        (5.26001519587677318785587544488e-2,),
        (1.97250569845378994544595329183e-2, 5.91751709536136983633785987549e-2),
        (2.95875854768068491816892993775e-2, 0, 8.87627564304205475450678981324e-2),
        (
            *(2.41365134159266685502369798665e-1, 0),
            *(-8.84549479328286085344864962717e-1, 9.24834003261792003115737966543e-1),
        ),
        (
            *(3.7037037037037037037037037037e-2, 0, 0),
            *(1.70828608729473871279604482173e-1, 1.25467687566822425016691814123e-1),
        ),
        (
            *(3.7109375e-2, 0, 0, 1.70252211019544039314978060272e-1),
            *(6.02165389804559606850219397283e-2, -1.7578125e-2),
        ),
        (
            *(3.70920001185047927108779319836e-2, 0, 0, 1.70383925712239993810214054705e-1),
            *(1.07262030446373284651809199168e-1, -1.53194377486244017527936158236e-2),
            8.27378916381402288758473766002e-3,
        ),
        (
            *(6.24110958716075717114429577812e-1, 0, 0, -3.36089262944694129406857109825),
            *(-8.68219346841726006818189891453e-1, 2.75920996994467083049415600797e1),
            *(2.01540675504778934086186788979e1, -4.34898841810699588477366255144e1),
        ),
        (
            *(4.77662536438264365890433908527e-1, 0, 0, -2.48811461997166764192642586468),
            *(-5.90290826836842996371446475743e-1, 2.12300514481811942347288949897e1),
            *(1.52792336328824235832596922938e1, -3.32882109689848629194453265587e1),
            -2.03312017085086261358222928593e-2,
        ),
        (
            *(-9.3714243008598732571704021658e-1, 0, 0, 5.18637242884406370830023853209),
            *(1.09143734899672957818500254654, -8.14978701074692612513997267357),
            *(-1.85200656599969598641566180701e1, 2.27394870993505042818970056734e1),
            *(2.49360555267965238987089396762, -3.0467644718982195003823669022),
        ),
        (
            *(2.27331014751653820792359768449, 0, 0, -1.05344954667372501984066689879e1),
            *(-2.00087205822486249909675718444, -1.79589318631187989172765950534e1),
            *(2.79488845294199600298499808837e1, -2.85899827713502369474065508674),
            *(-8.87285693353062954433549289258, 1.23605671757943030647266201528e1),
            6.43392746015763530355970484046e-1,
        ),
    ),
    (
        *(5.42937341165687622380535766363e-2, 0, 0, 0, 0, 4.45031289275240888144113950566),
        *(1.89151789931450038304281599044, -5.8012039600105847814672114227),
        *(3.1116436695781989440891606237e-1, -1.52160949662516078556178806805e-1),
        *(2.01365400804030348374776537501e-1, 4.47106157277725905176885569043e-2),
    ),
    reach=5.9,
)
