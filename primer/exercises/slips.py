"""A step of the paper's scheme as students write it, with the usual slips, so that a checker can name the one made.

The right one is u[j] + dt v_x, v[j] + dt (eps u v_xx + u_x - v - sin x)[j], with central differences on a circle, eq.
(toy-pde) and section A2.2.2. A slip is recognised by what it computes on data without symmetry, not by its code.
"""

import numpy as np


def slipped(
    u,
    v,
    x,
    h,
    eps,
    dt,
    *,
    side=1,
    first=2.0,
    power=2,
    middle=2.0,
    of_u=1.0,
    damping=1.0,
    drive=1.0,
    bend=None,
    kept=(1.0, 1.0),
    times=(1.0, 1.0),
    whole=(False, False),
    newer=None,
):
    """(u, v) after one step with a slip; without keywords, the right one, to rounding.

    ``side`` -1 takes left for right, ``first`` is the number of spacings under a first difference, ``power`` that of h
    under the second, ``middle`` the weight of its midpoint; ``of_u``, ``damping`` and ``drive`` multiply u_x, v and sin
    x; ``bend`` is the factor of v_xx; ``kept`` and ``times`` are the factors of the old value and of dt, ``whole``
    multiplies the old value by dt as well; ``newer`` is the field that is updated first, and used.
    """

    def slope(f):
        return side * (np.roll(f, -1) - np.roll(f, 1)) / (first * h)

    def new_u(v):
        return _added(u, slope(v), dt, 0)

    def _added(f, rate, dt, k):
        return (kept[k] * f + rate) * dt if whole[k] else kept[k] * f + times[k] * dt * rate

    def new_v(u):
        second = (np.roll(v, -1) - middle * v + np.roll(v, 1)) / h**power
        factor = eps * u if bend is None else bend(eps, u)
        return _added(v, factor * second + of_u * slope(u) - damping * v - drive * np.sin(x), dt, 1)

    if newer == "u":
        u_new = new_u(v)
        return u_new, new_v(u_new)
    if newer == "v":
        v_new = new_v(u)
        return new_u(v_new), v_new
    return new_u(v), new_v(u)


#: (keywords of :func:`slipped`, the hint), the likelier first
SLIPS = (
    ({"newer": "u"}, "v is updated with the new u. Both rates take the old values: compute u_t and v_t first."),
    ({"newer": "v"}, "u is updated with the new v. Both rates take the old values: compute u_t and v_t first."),
    ({"side": -1}, "left and right are exchanged. np.roll(f, -1)[j] is f[j+1]: the neighbour on the right."),
    ({"first": 1.0}, "the first differences are twice as large as they should be: j-1 and j+1 are how far apart?"),
    ({"power": 1}, "in v_xx the spacing has the wrong power: two differences, each over one spacing."),
    ({"first": 1.0, "power": 1}, "both spacings are wrong: j-1 and j+1 are how far apart, and what of v_xx?"),
    ({"middle": 1.0}, "in v_xx the midpoint has the wrong weight: of a straight line it must be 0."),
    ({"middle": -2.0}, "in v_xx the midpoint has the wrong sign: of a straight line it must be 0."),
    ({"times": (0.0, 1.0)}, "u has not moved. What is its rate, and for how long does it act?"),
    ({"times": (1.0, 0.0)}, "v has not moved. What is its rate, and for how long does it act?"),
    ({"kept": (0.0, 0.0)}, "dt times the rate is the change, not the new value."),
    ({"whole": (True, True)}, "dt is in the wrong place: it multiplies the rate, not the old value."),
    ({"whole": (True, False)}, "in u dt is in the wrong place: it multiplies the rate, not the old value."),
    ({"whole": (False, True)}, "in v dt is in the wrong place: it multiplies the rate, not the old value."),
    ({"times": (-1.0, -1.0)}, "the step goes backwards in time: look at the sign of dt."),
    ({"bend": lambda eps, u: u}, "eps is missing in front of u v_xx."),
    ({"bend": lambda eps, u: eps}, "u is missing in front of v_xx: the term is a product of two fields."),
    ({"bend": lambda eps, u: 0 * u}, "the term eps u v_xx is missing."),
    ({"bend": lambda eps, u: -eps * u}, "the sign of eps u v_xx is wrong."),
    ({"of_u": 0.0}, "the term u_x is missing in v_t."),
    ({"of_u": -1.0}, "the sign of u_x is wrong in v_t."),
    ({"damping": 0.0}, "the term -v is missing in v_t."),
    ({"damping": -1.0}, "the sign of v is wrong in v_t."),
    ({"drive": 0.0}, "the term -sin x is missing in v_t."),
    ({"drive": -1.0}, "the sign of sin x is wrong in v_t."),
)  # fmt: skip


def missing_dt(given, field):
    """(u, v) where dt is forgotten in one of them, or in both (``field`` None)."""
    dt = given[-1]
    return slipped(*given, times=tuple(1.0 if field not in (None, f) else 1 / dt for f in ("u", "v")))


def dropped_in_part(u, v, x, h, eps, dt):
    """(u, v) where dt multiplies the first term of v_t only, for want of brackets."""
    right_u, _ = slipped(u, v, x, h, eps, dt)
    second = (np.roll(v, -1) - 2 * v + np.roll(v, 1)) / h**2
    slope = (np.roll(u, -1) - np.roll(u, 1)) / (2 * h)
    return right_u, v + dt * eps * u * second + slope - v - np.sin(x)
