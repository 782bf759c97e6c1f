"""The determinant of a matrix of polynomials, knowing which of its coefficients cancel."""


def determinant(entries, zero):
    """det of a matrix whose entries are polynomials {powers: coefficient}, the powers being tuples of equal length.

    Expanded along the rows, each minor once, with the sum of the absolute values of the terms beside each coefficient:
    one that is smaller than ``zero`` times that sum has cancelled and is left out. Numbers of any kind will do.
    """
    size = len(entries)
    length = len(next((powers for row in entries for entry in row for powers in entry), ()))
    minors: dict[frozenset, dict] = {frozenset(): {(0,) * length: (1, 1)}}
    for row in entries:
        longer: dict[frozenset, dict] = {}
        for columns, minor in minors.items():
            for c, entry in enumerate(row):
                if c not in columns and entry:
                    sign = (-1) ** sum(other > c for other in columns)
                    _add_product(longer.setdefault(columns | {c}, {}), sign, entry, minor)
        minors = longer
    whole = minors.get(frozenset(range(size)), {})
    return {powers: value for powers, (value, most) in whole.items() if abs(value) > zero * most}


def _add_product(total, sign, entry, minor):
    for p, a in entry.items():
        for q, (b, b_most) in minor.items():
            powers = tuple(m + n for m, n in zip(p, q, strict=True))
            value, most = total.get(powers, (0, 0))
            total[powers] = value + sign * a * b, most + abs(a) * b_most
