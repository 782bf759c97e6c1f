"""Guards the grid-refinement studies' arguments: a wrong one gets one sentence that names it."""

import pytest

from primer import Toy
from primer.study.refinement import heat_onset, refine


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: refine(Toy(1.5), 16), "ns must be a sequence of grids, such as [50, 100], got 16"),
        (lambda: refine(Toy(1.5), "16"), "ns must be a sequence of grids, such as [50, 100], got '16'"),
        (lambda: heat_onset(16), "ns must be a sequence of grids, such as [50, 100], got 16"),
        (lambda: heat_onset([16, 30]), "ns must be multiples of four points, got 30"),
        (lambda: heat_onset([16.0]), "ns must be an integer >= 4, got 16.0 (float)"),
        (lambda: heat_onset([16], courant=0), "courant must be a finite number >= 1e-06 and <= 1e+06, got 0"),
        (lambda: heat_onset([16], tolerance=0), "tolerance must be a finite number >= 1e-15 and <= 1, got 0"),
        (lambda: heat_onset([16], sawtooth=0.01), "sawtooth must be a finite number >= 0 and < 0.01, got 0.01"),
    ],
)
def test_bad_input_gets_one_sentence(call, sentence):
    with pytest.raises((TypeError, ValueError)) as caught:
        call()
    assert str(caught.value) == sentence
