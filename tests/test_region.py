"""Regions: boundaries that are known by hand, points that lie alone, and what a grid of verdicts one by one says."""

import json
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from primer import Pencil, region, verdict
from primer.__main__ import main
from primer.granular import CSSM, EXAMPLE_COMPACTION, IncompressibleMuI, MuI, neutral_inertial_numbers
from primer.view.region import classes, draw_region
from primer.view.style import new_figure

TOY = "u_t = v_x; v_t = eps*u*v_xx + u_x - v - sin(x)"
LAYERS = "h_t + (h*u)_x = 0; e_t + (e*v)_x = 0; u_t + u*u_x + g*(h + e)_x = 0; v_t + v*v_x + g*(r*h + e)_x = 0"
TWO_FLUIDS = "a_t + (a*u)_x = 0; -a_t + ((1-a)*v)_x = 0; r*(u_t + u*u_x) = -p_x; s*(v_t + v*v_x) = -p_x"
VAN_DER_WAALS = "v_t = u_x; u_t = -(8*T/(3*v - 1) - 3/v^2)_x"
BOUSSINESQ = "n_t + w_x + a*w_xxx - b*n_xxt = 0; w_t + n_x + c*n_xxx - d*w_xxt = 0"
FIREHOSE = "v_t = (B - P/B)*b_x; b_t = B*v_x"

# Text, name, ends, other values, and the boundaries, by hand.
CLASSICAL = {
    "toy": (TOY, "u", (-2, 2.3), {"at": {"v_xx": 0.3}, "eps": 0.01}, [0]),
    # ((c-u)^2 - g h)((c-v)^2 - g e) = r g^2 h e; at h = e, with U half the shear, U^2 = g h (1 -+ sqrt r)
    "layers": (
        LAYERS,
        "u",
        (0.1, 4),
        {"at": {"h": 1, "e": 1, "v": 0}, "g": 1, "r": 0.81, "uniform": True, "n": 21},
        [2 * 0.1**0.5, 2 * 1.9**0.5],
    ),
    "two fluids": (TWO_FLUIDS, "u", (-1, 2.1), {"at": {"a": 0.3, "v": 0.7}, "r": 1, "s": 2, "uniform": True}, [0.7]),
    # p'(v) = -24 T/(3v-1)^2 + 6/v^3 > 0 where T < (3v-1)^2/(4v^3); at v = 2 that is 25/32
    "van der Waals": (VAN_DER_WAALS, "T", (0.5, 1.2), {"at": {"v": 2}, "uniform": True}, [25 / 32]),
    # lambda^2 = -k^2 (1 - a k^2)(1 - c k^2)/((1 + b k^2)(1 + d k^2)): ill posed where a c < 0 < b d
    "Boussinesq": (BOUSSINESQ, "a", (-1, 1.1), {"b": 0.1, "d": 0.2, "c": 0.3}, [0]),
    "firehose": (FIREHOSE, "P", (0, 1), {"B": 0.7}, [0.49]),
}


@pytest.mark.parametrize("name", CLASSICAL)
def test_classical_boundaries(name):
    text, varied, ends, given, exact = CLASSICAL[name]
    found = region(text, {varied: ends}, **{"n": 51} | given)
    assert found.boundaries == pytest.approx(exact, abs=1e-8)
    assert (found.error <= 1e-8).all()


def test_a_map_of_the_toy_is_its_closed_form():
    found = region(TOY, {"u": (-2, 2.1), "eps": (-0.03, 0.1)}, at={"v_xx": 0.3}, n=200)
    u, eps = np.meshgrid(*found.axes, indexing="ij")
    assert (found.kind == np.where(eps * u < 0, "ill-posed", "well-posed")).all()  # eq. (toy-eig)
    grows = found.kind == "ill-posed"
    assert found.coefficient[grows] == pytest.approx(-(eps * u)[grows])
    assert np.abs(found.boundaries).min(axis=1).max() < 1e-10
    assert found.computed < 400
    assert {(piece.kind, piece.exponent) for piece in found.pieces} == {("well-posed", 0), ("ill-posed", 2)}


@pytest.mark.parametrize(
    ("text", "vary", "given"),
    [
        (VAN_DER_WAALS, {"v": (0.45, 3), "T": (0.7, 1.1)}, {"uniform": True}),
        (BOUSSINESQ, {"a": (-1, 1.1), "c": (-1, 1)}, {"b": 0.1, "d": 0.1}),
        ("u_t = a*u_xxx + b*u_xx - (a - b)*u_xxxx", {"a": (-1, 1), "b": (-1, 1)}, {}),
        ("u_t = a*v_x; v_t = b*u_x + (a^2 + b^2 - 1/2)*u", {"a": (-1, 1), "b": (-1, 1)}, {}),
    ],
)
def test_what_was_filled_is_what_verdicts_say_one_by_one(text, vary, given):
    found = region(text, vary, n=12, **given)
    for place in np.ndindex(12, 12):
        point = {name: axis[k] for name, axis, k in zip(found.names, found.axes, place, strict=True)}
        one = verdict(text, at=point, **given)
        assert one.kind == found.kind[place], point
        assert one.kind == "undecided" or float(one.exponent) == found.exponent[place]


@pytest.mark.parametrize(
    ("text", "place"),
    [("u_t = -eps^2*u_xxxx - u_xx", 0.0), ("u_t = -(eps^2 - 2)^2*u_xxxx - u_xx", 2**0.5)],
)
def test_a_point_that_lies_alone_is_found_between_those_of_the_grid(text, place):
    found = region(text, {"eps": (-1, 3.03)}, n=10)
    ((where, one),) = found.isolated
    assert one.kind == "ill-posed"
    assert where["eps"] == pytest.approx(place)
    assert found.boundaries == pytest.approx([place])


def test_a_line_that_lies_alone_is_found_too():
    found = region("u_t = -(eps - a)^2*u_xxxx - u_xx", {"eps": (-1, 3.03), "a": (0, 1)}, n=10)
    assert (found.kind == "well-posed").all()
    assert [verdict.kind for _, verdict in found.isolated] == ["ill-posed"]


def test_a_thin_strip_between_two_zeros_is_seen():
    found = region("u_t = (a - 0.3)*(a - 0.3001)*u_xx", {"a": (-1, 1.03)}, n=12)
    assert found.boundaries == pytest.approx([0.3, 0.3001], abs=1e-8)


def test_changes_of_exponent_are_kept_apart():
    found = region("u_t = -u_xx + a*u_xxxx", {"a": (0, 1)}, n=5)
    assert not len(found.boundaries)
    assert found.changes == pytest.approx([0.0])


def test_pencils_laws_and_two_space_variables():
    found = region(lambda a: Pencil(lambda xi: [[a * xi**2]], [[1]]), {"a": (-1, 1.3)}, n=9)
    assert found.boundaries == pytest.approx([0], abs=1e-8)
    law = MuI(0.383, 0.643, 0.279)
    found = region(IncompressibleMuI(law), {"I": np.geomspace(1e-3, 10, 60)}, at={"phi": 0.55, "p": 0.3})
    assert found.boundaries == pytest.approx(neutral_inertial_numbers(law), abs=1e-8)
    C = EXAMPLE_COMPACTION.C(0.55)
    found = region(CSSM(0.4, EXAMPLE_COMPACTION), {"p": (0.01 * C, 0.79 * C)}, at={"phi": 0.55, "I": 0.1}, n=20)
    assert found.boundaries == pytest.approx([0.4 * C], abs=1e-8)
    found = region("u_t = a*u_xx + u_yy", {"a": (-1, 1.3)}, n=9)
    assert found.boundaries == pytest.approx([0], abs=1e-8)


def test_a_table_and_an_executor_go_on_where_they_stopped(tmp_path):
    table, given = tmp_path / "r.csv", {"n": 21, "at": {"v_xx": 0.3}, "eps": 0.01}
    with ThreadPoolExecutor(1) as executor:
        first = region(TOY, {"u": (-2, 2)}, table=table, executor=executor, **given)
    again = region(TOY, {"u": (-2, 2)}, table=table, **given)
    assert first.computed == again.computed == len(table.read_text().splitlines()) - 2
    with pytest.raises(ValueError, match="table must be new"):
        region(TOY, {"u": (-2, 2)}, table=table, **given | {"eps": 0.02})


def test_a_place_without_a_linearisation_is_undecided_and_a_missing_value_an_error():
    assert region("u_t = 1/a*u_xx", {"a": (-1, 1)}, n=3).kind.tolist() == ["ill-posed", "undecided", "well-posed"]
    with pytest.raises(ValueError, match="not given: parameters b="):
        region("u_t = a*b*u_xx", {"a": (-1, 1)})


@pytest.mark.parametrize(
    ("vary", "given", "words"),
    [
        ({}, {}, "one or two names"),
        ({"a": (1, -1)}, {}, "lowest and highest"),
        ({"a": 3}, {}, "vary a must be"),
        ({"a": (-1, 1)}, {"a": 2}, "is varied and has a value"),
        ({"a": (-1, 1)}, {"n": 1}, "n must be"),
        ({"q": (-1, 1)}, {"a": 2}, "does not occur"),
    ],
)
def test_bad_input_in_one_sentence(vary, given, words):
    with pytest.raises((ValueError, TypeError), match=words):
        region("u_t = a*u_xx", vary, **given)


def test_the_picture_has_words_for_each_kind():
    found = region(TWO_FLUIDS, {"u": (-1, 2.1)}, at={"a": 0.3, "v": 0.7}, r=1, s=2, uniform=True, n=20)
    _, axes = new_figure(columns=1)
    assert {handle.get_label() for handle in draw_region(axes, found)} == {"ill posed", "weakly well posed"}
    assert set(np.unique(classes(found))) == {1, 2}


def test_the_command(capsys, tmp_path):
    line = ["region", TOY, "--vary", "u=-2:2.2", "--at", "eps=0.01", "v_xx=0.3", "--n", "11"]
    assert main([*line, "--plot", str(tmp_path / "r.svg")]) == 0
    assert "boundaries:  u = 0\n" in capsys.readouterr().out
    assert "ill posed" in (tmp_path / "r.svg").read_text()
    assert main([*line, "--vary", "eps=0:1"]) == 2
    assert "eps is varied and has a value" in capsys.readouterr().err
    assert main([*line, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["boundaries"] == pytest.approx([0], abs=1e-9)
    with pytest.raises(SystemExit):
        main(["region", TOY, "--vary", "u=2:-2"])
