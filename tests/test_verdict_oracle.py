"""Guards the verdicts by an oracle that shares no code with them, on a hundred random systems; oracle.py judges more.

Kind, exponent, coefficient and bound to 1e-6, and for some the loss. Undecided is an answer; a wrong answer is none.
"""

import oracle
import pytest

from primer import verdict

BATCHES = 25


@pytest.mark.parametrize("batch", range(BATCHES))
def test_verdicts_on_random_systems(batch):
    for seed in range(batch, 100, BATCHES):
        kind, text, details = oracle.judged(seed, verdict, with_loss=seed % 4 == 0)
        assert kind != "wrong", f"{text}: {details}"


@pytest.mark.slow
def test_few_are_left_undecided():
    kinds = [oracle.judged(seed, verdict)[0] for seed in range(100, 160)]
    assert kinds.count("undecided") <= 6
    assert "wrong" not in kinds


@pytest.mark.parametrize(
    ("equations", "law"),
    [
        ([[(-1, 0, (1, 0, 0)), (-1, 0, (0, 2, 0))]], (2, 1)),  # u_t = -u_xx
        ([[(-1, 0, (1, 0, 0)), (1, 1, (0, 0, 0))], [(-1, 1, (1, 0, 0)), (1, 0, (0, 1, 0))]], (0.5, 0.5**0.5)),
        ([[(-1, 0, (2, 0, 0)), (1, 0, (0, 2, 0))]], (0, 0)),
        ([[(-1, 0, (1, 0, 0)), (1, 0, (0, 4, 0)), (1, 0, (1, 2, 0))]], (2, 1)),  # lambda = xi^4/(1 + xi^2)
    ],
)
def test_the_oracle_knows_what_is_known(equations, law):
    D = oracle.determinant([[(oracle.Gauss(c), u, p) for c, u, p in terms] for terms in equations])
    exponent, coefficient = oracle.power_law(D)
    assert (float(exponent), coefficient) == (law[0], pytest.approx(law[1], rel=1e-9))


def test_the_oracle_climbs_and_exponentiates():
    kuramoto = [[(-1, 0, (1, 0, 0)), (-1, 0, (0, 2, 0)), (-1, 0, (0, 4, 0))]]
    gauss = [[(oracle.Gauss(c), u, p) for c, u, p in terms] for terms in kuramoto]
    value, k = oracle.scan(oracle.determinant(gauss))
    assert (value, k) == (pytest.approx(0.25, rel=1e-10), pytest.approx(0.5**0.5, rel=1e-4))
    jordan = [
        [(-1, 0, (1, 0, 0)), (1, 0, (0, 1, 0)), (1, 1, (0, 1, 0))],
        [(-1, 1, (1, 0, 0)), (1, 1, (0, 1, 0))],
    ]
    assert oracle.loss([[(oracle.Gauss(c), u, p) for c, u, p in terms] for terms in jordan]) == pytest.approx(
        1, abs=0.01
    )
