"""H(u) and absD(u) in one space variable: for xi > 0, and for xi < 0, their symbols are polynomials in |xi|.

For k = |xi| and s = sign xi: d/dx is s i k, the Hilbert transform -i s, absD k. With d = i k each half line has a
:class:`Symbol` of its own, of which only k > 0 means anything: everything known of symbols that are polynomials holds.
"""

from __future__ import annotations

from dataclasses import replace

import mpmath as mp

from primer.analysis.puiseux import collected
from primer.analysis.roots import DIGITS


def half_lines(symbol):
    """((symbol, sign), ...) of a :class:`Symbol` with operators in one space variable: xi > 0, and xi < 0.

    The second is left out where the coefficients are real: growth at -xi is then that at xi.
    """
    values = [c for row in symbol.entries for entry in row for c in entry.values()]
    signs = (1,) if all(mp.im(c) == 0 for c in values) else (1, -1)
    return tuple((_half(symbol, sign), sign) for sign in signs)


def _half(symbol, sign):
    with mp.workdps(DIGITS):
        entries = tuple(tuple(_polynomial(entry, sign) for entry in row) for row in symbol.entries)
    return replace(symbol, entries=entries, operators=False)


def _polynomial(entry, sign):
    """In lambda and d = i k, k = |xi| = -i d."""
    i = mp.mpc(0, 1)
    return collected(
        ((n, a + moduli, 0), c * sign**a * (-i * sign) ** hilbert * (-i) ** moduli)
        for (n, a, _, hilbert, moduli), c in entry.items()
    )
