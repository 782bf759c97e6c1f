"""The fastest growth at a given wavenumber, over all directions, for many states at once."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields, replace

import numpy as np

from primer.checks import affordable, real_array, shown
from primer.granular.dispersion import growth_rate
from primer.granular.linearisation import Coefficients

_SCAN = np.cos(np.linspace(0, np.pi, 25))
_STEP = np.pi / 24  # no neighbour of a scanned x is further away
_OUT = 10.0 ** -np.arange(12.0, 0, -1)
_FAN = np.concatenate([-_OUT[::-1], [0], _OUT])
_NEXT = np.concatenate([_OUT[1:], _OUT[-1:] + _STEP])  # outwards from each of _OUT
_PREVIOUS = np.concatenate([[0], _OUT[:-1]])  # and inwards
_REACH = (
    np.concatenate([np.full(25, -_STEP), (_OUT - _NEXT)[::-1], [-_OUT[0]], _PREVIOUS - _OUT]),
    np.concatenate([np.full(25, _STEP), (_OUT - _PREVIOUS)[::-1], [_OUT[0]], _NEXT - _OUT]),
)
_BLOCK = 2048  # states at a time: the work arrays then stay in the cache
_LARGEST = 1e20  # the cubic for the growth rates is solved with products up to k^12
_GOLDEN = (math.sqrt(5) - 1) / 2


def fastest(c, k):
    """The largest growth rate at |xi| = k over all directions, and where it is.

    A scan of fixed directions is not enough (CSSM's growth at its critical state lives in a window of width k^{-2/3}
    that drifts), so x = cos 2 theta is scanned also at all distances from the minimum of det(M + N), and the best
    point is refined by golden sections to about 1e-5 of its surroundings, that is 1e-10 of the curvature there.

    Parameters
    ----------
    c : Coefficients    of any shape
    k : array           wavenumbers > 0, broadcast against it

    Returns
    -------
    (growth, x) : arrays of the broadcast shape; the directions are theta = +-arccos(x)/2 from the major stress axis
    """
    k = real_array("k", k)
    if (k <= 0).any():
        raise ValueError(f"k must be > 0 everywhere, being the length of the wavevector, got {shown(k)}")
    try:
        shape = np.broadcast_shapes(k.shape, np.shape(c.A))
    except ValueError:
        raise ValueError(
            f"k must have a shape that broadcasts against the states' {np.shape(c.A)}, got {k.shape}"
        ) from None
    if (k > _LARGEST).any():
        raise ValueError(f"k must be <= {_LARGEST:g} everywhere, for its powers to be finite, got {shown(k)}")
    affordable("k and the states", 200 * math.prod(shape), f"shape {shape}")
    columns = {f.name: _flat(getattr(c, f.name), shape) for f in fields(Coefficients) if f.name != "incompressible"}
    k = _flat(k, shape)
    parts = [slice(i, i + _BLOCK) for i in range(0, max(k.size, 1), _BLOCK)]

    def work(part):
        return _block(replace(c, **{name: column[part] for name, column in columns.items()}), k[part])

    with ThreadPoolExecutor() as pool:
        results = list(pool.map(work, parts)) if len(parts) > 1 else [work(parts[0])]
    return tuple(np.concatenate(column).reshape(shape)[()] for column in zip(*results, strict=True))


def flattest(c):
    """The x in [-1, 1] at which Delta = Gamma det(M + N)/k^4 is smallest: -B in CSSM, if |B| < 1."""
    bend = c.t - c.A
    vertex = -c.t * (c.B + c.C) / (2 * np.where(bend > 0, bend, 1))
    ends = np.where(c.B + c.C > 0, -1.0, 1.0)
    return np.where(bend > 0, np.clip(vertex, -1, 1), ends)


def _block(c, k):
    centre = flattest(c)
    x = np.concatenate([np.broadcast_to(_SCAN[:, None], (_SCAN.size, k.size)), centre + _FAN[:, None]])
    x = np.clip(x, -1, 1)
    rate = growth_rate(c, k, x)
    best, rows = np.argmax(rate, axis=0), np.arange(k.size)
    top, where = rate[best, rows], x[best, rows]
    low, high = (np.clip(where + reach[best], -1, 1) for reach in _REACH)  # to the neighbours on either side
    left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    fl, fr = growth_rate(c, k, left), growth_rate(c, k, right)
    for _ in range(26):
        up = fr > fl
        low, high = np.where(up, left, low), np.where(up, high, right)
        new = np.where(up, low + _GOLDEN * (high - low), high - _GOLDEN * (high - low))
        fn = growth_rate(c, k, new)
        left, right, fl, fr = (
            np.where(up, right, new),
            np.where(up, new, left),
            np.where(up, fr, fn),
            np.where(up, fn, fl),
        )
    for f, y in ((fl, left), (fr, right)):
        better = f > top
        top, where = np.where(better, f, top), np.where(better, y, where)
    return top, where


def _flat(value, shape):
    return np.broadcast_to(value, shape).ravel()
