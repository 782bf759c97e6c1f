"""Guards the laws by name: derivatives by differences, bands and thresholds by the pencil against closed forms."""

import json

import numpy as np
import pytest

from primer.__main__ import main
from primer.granular import (
    CIDR,
    CSSM,
    GLASS_BEADS,
    BaseState,
    Compaction,
    DruckerPrager,
    IncompressibleMuI,
    MuI,
    MuIPhiI,
    RegularisedMuI,
    TextLaw,
    linearise,
    neutral_inertial_numbers,
    verdict,
)

BEADS = GLASS_BEADS.friction
REGULAR = RegularisedMuI(0.342, 0.557, 0.069)
LAWS = [
    IncompressibleMuI(REGULAR),
    MuIPhiI(BEADS, K=3.0),
    DruckerPrager(0.6, 0.3, index=0.7, c=0.2),
    DruckerPrager(0.5, 0.1),
    TextLaw("a*p^1.5*sqrt(I)/(1 + I) + p^2*phi", "tanh(I) - p/phi^2 + log(1 + I)*phi", {"a": 0.4}),
    TextLaw("p^phi*exp(-I/3)", "sin(p)*cos(phi) - 2^I"),
]


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_the_partial_derivatives_are_those_of_differences(law):
    rng = np.random.default_rng(4)
    x = [rng.uniform(0.2, 2, 40), rng.uniform(0.4, 0.7, 40), 10 ** rng.uniform(-3.5, 0.5, 40)]
    for name in ("Y", "f"):
        for slot, variable in enumerate(("p", "phi", "I")):
            h = 1e-6 * x[slot]
            up, down = ([v + s * h if j == slot else v for j, v in enumerate(x)] for s in (1, -1))
            value = getattr(law, name)
            expected = (value(*up) - value(*down)) / (2 * h)
            np.testing.assert_allclose(getattr(law, f"{name}_{variable}")(*x), expected, rtol=1e-5, atol=1e-7)


def test_the_text_of_cssm_is_cssm():
    soil = CSSM(0.4, Compaction(0.5, 0.1, 1.0))
    state = BaseState(0.3, 0.55, 0.1)
    z = "((phi - 0.5)/0.1)"
    text = TextLaw(f"2*m*p - p^2*(1 - {z})/{z}", f"2*m - 2*p*(1 - {z})/{z}", {"m": 0.4})
    assert text.f(0.3, 0.53, 0.1) == pytest.approx(soil.f(0.3, 0.53, 0.1), rel=1e-9)
    assert text.Y_phi(0.3, 0.53, 0.1) == pytest.approx(soil.Y_phi(0.3, 0.53, 0.1), rel=1e-12)
    assert verdict(text, state).coefficient == pytest.approx(verdict(soil, state).coefficient, rel=1e-9)


def growth(law, I, p=1.0):
    """The growth at |xi| = 1 by eigenvalues of the pencil, over a scan of directions."""
    angles = np.linspace(0, np.pi / 2, 2001)
    rates = linearise(law, BaseState(p, 0.6, I)).eigenvalues(np.stack([np.cos(angles), np.sin(angles)]))
    return np.real(rates).max()


def test_the_band_of_the_regularised_law_is_wider_by_the_pencil_too():
    old, new = neutral_inertial_numbers(MuI(0.342, 0.557, 0.069)), neutral_inertial_numbers(REGULAR)
    assert pytest.approx(old[0], rel=1e-12) == REGULAR.I1
    assert new[-1] > 10 * old[1]
    law = IncompressibleMuI(REGULAR)
    for I in (1e-8, 1e-4, 0.9 * REGULAR.I1, 1.1 * REGULAR.I1, 0.1, 0.98 * new[-1]):
        assert growth(law, I) < 1e-9
    assert growth(law, 1.02 * new[-1]) > 0
    assert growth(IncompressibleMuI(MuI(0.342, 0.557, 0.069)), 1e-4) > 0


def test_the_two_branches_meet():
    I1 = REGULAR.I1
    assert REGULAR.mu(I1 * (1 + 1e-9)) == pytest.approx(REGULAR.mu(I1), rel=1e-7)
    assert REGULAR.mu(0.0) == 0


@pytest.mark.parametrize(("n", "c", "p", "I"), [(1.0, 0.0, 1.0, 0.5), (1.0, 0.3, 2.0, 0.1), (0.6, 0.0, 0.4, 1.3)])
def test_viscosity_mends_drucker_prager_above_its_threshold_only(n, c, p, I):
    K = DruckerPrager(0.6, 0.0, n, c).threshold(p, I * np.sqrt(p) / 2)
    for factor, ill in ((0.0, True), (0.98, True), (1.02, False)):
        law = DruckerPrager(0.6, factor * K, n, c)
        assert (growth(law, I, p) > 1e-9) == ill
        assert (verdict(law, BaseState(p, 0.6, I)).kind == "ill-posed") == ill
    assert DruckerPrager(1.2, 0.0).threshold(1, 1) == np.inf
    assert DruckerPrager(0.6, 0.0, index=0.05).threshold(1, 1) == np.inf


@pytest.mark.parametrize("I", [1e-3, 0.03, 0.3, 1.5])
def test_mu_I_phi_I_is_ill_posed_wherever_it_deforms(I):
    law = MuIPhiI(BEADS, K=1e9)
    state = BaseState(p=2.0, phi=law.Phi(I), I=I)
    found = verdict(law, state)
    assert (found.kind, found.exponent) == ("ill-posed", 2)
    limit = 2.0 / state.D * (1 - BEADS.mu(I)) / state.phi
    assert found.coefficient == pytest.approx(limit, rel=1e-4)
    assert found.direction == pytest.approx((0, 1), abs=1e-6)
    assert verdict(law, state, dim=3).kind == "ill-posed"


@pytest.mark.parametrize(
    ("texts", "parameters", "word"),
    [
        (("a*p", "0"), {}, "name a"),
        (("foo(p)", "0"), {}, "foo|function|name"),
        (("p_x", "0"), {}, "p_x|derivative"),
        (("2*i*p", "0"), {}, "i"),
        (("p*", "0"), {}, ""),
        (("p", "0"), {"b": 1.0}, "b"),
        (("p", "0"), {"phi": 1.0}, "phi"),
        ((3, "0"), {}, "text"),
    ],
)
def test_texts_that_make_no_law_are_refused(texts, parameters, word):
    with pytest.raises((ValueError, TypeError), match=word):
        TextLaw(*texts, parameters)


def test_a_text_that_is_not_positive_is_refused_at_the_state():
    with pytest.raises(ValueError, match="yield stress"):
        verdict(TextLaw("p - 2", "0"), BaseState(1.0, 0.55, 0.1))


@pytest.mark.parametrize(
    ("options", "kind"),
    [
        (["--law", "regularised", "--I", "0.001"], "well-posed"),
        (["--law", "mui-phii", "--I", "0.1"], "ill-posed"),
        (["--law", "bingham", "--I", "0.1", "--mu", "0.5", "--K", "0.01"], "ill-posed"),
        (["--law", "herschel-bulkley", "--I", "0.1", "--mu", "0.5", "--K", "5", "--n", "0.5"], "well-posed"),
        (["--law", "text", "--I", "0.1", "--Y", "m*p", "--f", "0", "--set", "m=0.4"], "ill-posed"),
        (["--law", "coulomb", "--I", "0.1"], "ill-posed"),
        (["--law", "cidr", "--I", "0.1", "--phi", "0.55"], "well-posed"),
    ],
)
def test_the_command_knows_them(options, kind, capsys):
    assert not main(["granular", "--p", "0.2", *options, "--json"])
    assert json.loads(capsys.readouterr().out)["verdict"] == kind


def test_cidr_needs_its_phi(capsys):
    with pytest.raises(SystemExit) as stop:
        raise SystemExit(main(["granular", "--law", "cidr", "--p", "0.2", "--I", "0.1"]))
    assert stop.value.code == 2
    assert "phi" in capsys.readouterr().err
    assert isinstance(CIDR(BEADS, Compaction(0.5, 0.1, 1.0)), CIDR)
