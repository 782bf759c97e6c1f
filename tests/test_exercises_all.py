"""Guards exercises whose answers are kept as a table: the second route agrees on every case that may be asked."""

import pytest
from truths import living_with_ill_posedness, scheme_or_pde

from primer import exercises


@pytest.mark.parametrize(
    ("name", "truth"),
    [
        ("04_2", scheme_or_pde.truth_04_2),
        ("04_3", scheme_or_pde.truth_04_3),
        ("08_3", living_with_ill_posedness.truth_08_3),
    ],
)
def test_every_case_that_may_be_asked(name, truth):
    ask, check = (getattr(exercises, f"{what}_{name}") for what in ("ask", "check"))
    seeds = {ask(seed): seed for seed in range(60)}  # one for each question
    assert len(seeds) >= 5
    for question, seed in seeds.items():
        assert check(truth(seed), seed).right, question
