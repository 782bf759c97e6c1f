"""Guards a problem of one's own: a wrong shape, or an order that is not there, is said in one sentence."""

from types import SimpleNamespace

import numpy as np
import pytest

from primer import FOURIER, ftcs, march_lines

N = 16


def own(**changed):
    """Two waves: u_t = v_x, v_t = u_x."""
    parts = {
        "fields": ("u", "v"),
        "initial": lambda x: (np.cos(x), 0 * x),
        "steady": lambda x: (0 * x, 0 * x),
        "forcing": lambda x: None,
        "rhs": lambda x, f, d, _: (d(f[1], 1), d(f[0], 1)),
    }
    return SimpleNamespace(**parts | changed)


def says(problem, sentence):
    for march in (lambda: ftcs(problem, N, 1e-3, 0.01), lambda: march_lines(problem, N, 1e-3, 0.01, FOURIER)):
        with pytest.raises(ValueError, match=sentence) as said:
            march()
        assert len(str(said.value).splitlines()) == 1
        assert len(str(said.value)) < 300


def test_a_good_one_is_marched():
    assert ftcs(own(), N, 1e-3, 0.01).stop == "reached_end"
    end = march_lines(own(), N, 1e-2, 1.0, FOURIER)
    np.testing.assert_allclose(end.final[0], np.cos(end.x) * np.cos(1.0), atol=1e-8)
    assert ftcs(own(initial=lambda x: np.array([np.cos(x), 0 * x])), N, 1e-3, 0.01).t_stop > 0


@pytest.mark.parametrize(
    "rhs",
    [
        lambda x, f, d, _: (d(f[1], 1),),
        lambda x, f, d, _: d(f[1], 1),
        lambda x, f, d, _: [d(f[1], 1)] * 3,
        lambda x, f, d, _: (d(f[1], 1), 0.0),
        lambda x, f, d, _: (d(f[1], 1), d(f[0], 1)[:-1]),
        lambda x, f, d, _: np.transpose([d(f[1], 1), d(f[0], 1)]),
        lambda x, f, d, _: None,
        lambda x, f, d, _: 0.0,
        lambda x, f, d, _: {"u": d(f[1], 1), "v": d(f[0], 1)},
        lambda x, f, d, _: (d(f[1], 1) * 1j, d(f[0], 1)),
        lambda x, f, d, _: (np.full(N, "a"), np.full(N, "b")),
    ],
)
def test_a_right_hand_side_of_another_shape(rhs):
    says(own(rhs=rhs), r"problem\.rhs must give 2 real arrays of 16 points, one for each field, as the fields, got")


@pytest.mark.parametrize(
    "initial",
    [
        lambda x: np.cos(x),
        lambda x: (np.cos(x),),
        lambda x: (np.cos(x), 0.0),
        lambda x: (np.cos(x), 0 * x, 0 * x),
        lambda x: (np.cos(x), x[:-1]),
        lambda x: None,
        lambda x: "uv",
    ],
)
def test_data_of_another_shape(initial):
    says(own(initial=initial), r"problem\.initial\(x\) must give 2 real arrays of 16 points, one for each field, got")
    with pytest.raises(ValueError, match=r"problem\.steady\(x\) must give 2 real arrays of 16 points"):
        ftcs(own(steady=initial), N, 1e-3, 0.01)


@pytest.mark.parametrize("m", [0, 13, -1, 1.5, "x", None, (1, 1)], ids=str)
def test_an_order_that_no_scheme_has(m):
    says(own(rhs=lambda x, f, d, _: (d(f[1], m), f[0])), r"an order that the scheme has, 1 to 12 .* got m = ")


@pytest.mark.parametrize("f", [0.0, np.zeros(N - 1), np.zeros((N, 2)), [1.0, 2.0]], ids=str)
def test_a_derivative_of_what_is_no_field(f):
    says(own(rhs=lambda x, y, d, _: (d(f, 1), y[0])), r"derivative\(f, m\) must be asked for f of shape \(\.\.\., 16\)")


def test_a_mistake_within_the_right_hand_side_is_its_author_s():
    def rhs(x, f, d, _):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        ftcs(own(rhs=rhs), N, 1e-3, 0.01)
