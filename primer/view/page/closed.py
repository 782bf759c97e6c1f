"""Growth in closed form on a page: the characteristic polynomial of a PDE, its coefficients as data."""

import numpy as np
import sympy

from primer.analysis.symbolic import linearise
from primer.scenes.pde import XI, read_values
from primer.scenes.pde import pde as answer


def closed_form(pde, at, order, uniform=False):
    """det(lambda - A), eq. (toy-mat) for any PDE, as a polynomial in lambda, xi and the names of the base state.

    Returns None where it is no polynomial in these, else a dict ready for JSON: ``names`` and ``values`` of the base
    state in ``at``, ``terms`` as rows of (real and imaginary part, power of lambda, powers of the wavenumbers, powers
    of the names), ``ways`` the unit vectors along which the largest growth is sought, ``xi`` at which |xi|.
    """
    matrix, values = linearise(pde, order=order, uniform=uniform), read_values(at)
    symbols = {symbol.name: symbol for symbol in matrix.free_symbols}
    lam = symbols.get("lambda", sympy.Symbol("lambda"))
    if "lambda" not in symbols:
        matrix = lam * sympy.eye(matrix.rows) - matrix
    plane = {"xi_1", "xi_2"} & symbols.keys()
    waves = [symbols.get(name, sympy.Symbol(name)) for name in (("xi_1", "xi_2") if plane else ("xi",))]
    names = sorted(symbols.keys() - {"lambda", "xi", "xi_1", "xi_2"})
    try:
        polynomial = sympy.Poly(sympy.expand(matrix.det()), lam, *waves, *(symbols[name] for name in names))
    except sympy.PolynomialError:
        return None
    terms = [[*map(float, complex_.as_real_imag()), *powers] for powers, complex_ in polynomial.terms()]
    ways = [[1.0], [-1.0]]
    if plane:
        angles = np.arange(32) * np.pi / 16
        ways = np.column_stack([np.cos(angles), np.sin(angles)]).tolist()
        ways += [list(map(float, answer(pde, at, order, uniform=uniform).found.direction))]
    return {
        "names": names,
        "values": [values[name] for name in names],
        "waves": len(waves),
        "terms": terms,
        "ways": [way for way in ways if way],
        "xi": XI.tolist(),
    }
