"""Error against work that is the same on every machine: evaluations of the right-hand side, counted point by point."""

from dataclasses import dataclass

import numpy as np

from primer.checks import instance, real, sequence, shown
from primer.problems.toy import Toy
from primer.schemes.fourier import interpolate
from primer.schemes.grid import grids
from primer.schemes.lines import Lines
from primer.schemes.reference import reference
from primer.study.contestants import contestants

METHODS = ("FTCS", "central 4 + RK4", "central 6 + RK8", "Fourier + RK8")
_GRIDS = (12, 16, 24, 32, 48, 64, 96, 128, 192, 256)


@dataclass(frozen=True, eq=False)
class Effort:
    """One method on several grids.

    Attributes
    ----------
    method    its name
    n, dt     (k,) grid points and steps
    work      (k,) n times the evaluations of the right-hand side from 0 to t_end
    error     (k,) largest error of u and v at t_end, or largest difference from ``against``; infinite after a blow-up
    """

    method: str
    n: np.ndarray
    dt: np.ndarray
    work: np.ndarray
    error: np.ndarray

    @property
    def order(self):
        """Of accuracy in h = 2 pi/n: the slope of ln(error) over ln(h), by least squares; NaN if a run blew up."""
        return -float(np.polyfit(np.log(self.n), np.log(self.error), 1)[0])


def effort(toy, t_end=5.0, ns=_GRIDS, methods=METHODS, tol=1e-12, against=None):
    """March ``toy`` to t_end on the grids ``ns`` by several methods; compare the errors and the work.

    Work leaves out what an evaluation costs at a point: some operations for differences, about 2 n for Fourier. Steps
    are those of :mod:`primer.study.contestants`: stable, and as accurate as the grid.

    Parameters
    ----------
    toy, t_end    the system of eq. (toy-pde), and the end > 0
    ns            grids, each of n >= 4 points
    methods       names of ``contestants()`` whose knob is n and whose steps are fixed
    tol           of the ``reference`` that errors are measured against
    against       a ``Lines`` at t_end to take differences from instead, where there is no reference

    Returns
    -------
    tuple of ``Effort``, one a method

    Raises
    ------
    PastHorizon              if there is no reference at t_end: one cannot speak of errors past the first u = 0
    TypeError, ValueError    for an argument that is not allowed
    """
    instance("toy", toy, Toy)
    t_end, ns = real("t_end", t_end, above=0), grids("ns", sequence("ns", ns, "grids, such as [50, 100]"))
    known = {method.name: method for method in contestants(with_py_pde=False) if method.stages}
    for name in sequence("methods", methods, "names"):
        if not isinstance(name, str) or name not in known:
            raise ValueError(f"methods must be of {', '.join(known)}, got {shown(name)}")
    if against is not None and instance("against", against, Lines).t != t_end:
        raise ValueError(f"against must be a march to t_end = {t_end:g}, got one to {against.t:g}")
    truth = reference(toy, t_end, tol) if against is None else _Marched(against.final)
    return tuple(_march(toy, t_end, ns, known[name], truth) for name in methods)


@dataclass(frozen=True, eq=False)
class _Marched:
    """The fields of a march in place of a reference."""

    final: tuple[np.ndarray, ...]

    def at(self, x):
        """(u, v) at x, each of shape (1,) + the shape of x."""
        return tuple(interpolate(f[None], x) for f in self.final)


def _march(toy, t_end, ns, method, truth):
    dts, errors = [], []
    for n in ns:
        x, fields, dt = method.march(toy, n, t_end)
        error = float(np.abs(np.array(fields) - [f[0] for f in truth.at(x)]).max())
        dts.append(dt)
        errors.append(error if error < 1e3 else np.inf)  # beyond a thousand ``ftcs`` stops, and others may go on
    n, dt = np.array(ns), np.array(dts)
    return Effort(method.name, n, dt, n * method.stages * np.round(t_end / dt), np.array(errors))
