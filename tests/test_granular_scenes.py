"""Guards the maps, the noise, the eigenvalue routes and the report: numbers against closed forms and each other."""

import json
import math

import numpy as np
import pytest

from primer.__main__ import main
from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    BaseState,
    Coulomb,
    IncompressibleMuI,
    MuI,
    coefficients,
    growth_limit,
    neutral_inertial_numbers,
)
from primer.granular.command import LAWS as NAMES
from primer.granular.command import report, text
from primer.granular.fastest import fastest
from primer.granular.maps import growth_map, neutral_stress_ratio
from primer.granular.noise import modes, noise_after
from primer.granular.routes import ROUTES, compare, multiprecision

BEADS, PACKING = GLASS_BEADS.friction, EXAMPLE_COMPACTION
LAWS = [Coulomb(0.4), IncompressibleMuI(BEADS), CSSM(0.4, PACKING), CIDR(BEADS, PACKING)]
SHARED = BaseState(0.37 * PACKING.C(0.55), 0.55, 0.01)


def bisect(f, low, high):
    """The sign change of f between low and high, to rounding."""
    start = f(low) > 0
    for _ in range(48):
        middle = (low + high) / 2
        low, high = (middle, high) if (f(middle) > 0) == start else (low, middle)
    return (low + high) / 2


def test_the_boundary_of_mu_of_I_from_eigenvalues_is_the_closed_form():
    def growth(s):
        return fastest(coefficients(LAWS[1], BaseState(0.3, 0.55, math.exp(s))), 1e4)[0]

    low, high = neutral_inertial_numbers(BEADS)
    assert math.exp(bisect(growth, math.log(1e-3), math.log(0.1))) == pytest.approx(low, rel=1e-8)
    assert math.exp(bisect(growth, math.log(0.1), math.log(10))) == pytest.approx(high, rel=1e-8)


@pytest.mark.parametrize("friction", [BEADS, MuI(0.1, 0.3, 1.0), MuI(0.2, 0.95, 0.01)])
def test_the_boundary_of_cidr_from_eigenvalues_is_the_root_of_a_quartic(friction):
    law = CIDR(friction, PACKING)
    for I in (1e-3, 0.6):
        closed = friction.alpha(I) - neutral_stress_ratio(friction, I)

        def growth(r, I=I, law=law):
            return fastest(coefficients(law, BaseState(r * PACKING.C(0.55), 0.55, I)), 1e9)[0]

        top = min(1.6 * closed, 0.999 * friction.alpha(I))
        assert bisect(growth, 0.3 * closed, top) == pytest.approx(closed, rel=1e-8)


def test_the_quartic_is_where_the_limit_changes_sign():
    for friction in (BEADS, MuI(0.05, 0.9, 1e-3), MuI(0.6, 0.7, 10.0)):
        I = np.logspace(-8, 4, 60)
        r = friction.alpha(I) - neutral_stress_ratio(friction, I)
        I, r = I[r > 0], r[r > 0]  # elsewhere no state is unstable
        assert I.size > 20
        law = CIDR(friction, PACKING)
        C = PACKING.C(0.55)
        below, above = (growth_limit(law, BaseState(r * C * f, 0.55, I)) for f in (1 - 1e-7, 1 + 1e-7))
        assert (below > 0).all()
        assert (above < 0).all()


def test_the_boundary_of_cssm_from_eigenvalues_is_the_critical_pressure():
    """Between growth like |xi| and a bound: the exponent measured from |xi| = 1e14 to 1e15 crosses 1/3 at p = mu C."""
    law = LAWS[2]
    exact = law.p_critical(0.55, 0.1)

    def exponent(p):
        c = coefficients(law, BaseState(p, 0.55, 0.1))
        low, high = fastest(c, 1e14)[0], fastest(c, 1e15)[0]
        return math.log10(max(high, 1e-300) / max(low, 1e-300)) - 1 / 3

    assert bisect(exponent, 0.3 * exact, 1.5 * exact) == pytest.approx(exact, rel=1e-8)


def test_a_map_is_the_growth_at_each_of_its_states_and_empty_outside():
    I, ratio = np.geomspace(1e-3, 1, 7), np.linspace(0.1, 1, 6)
    for law in LAWS:
        m = growth_map(law, I, ratio, PACKING, 0.55, k=1e3)
        for i, r in ((0, 0), (3, 2), (6, 3)):
            state = BaseState(ratio[r] * PACKING.C(0.55), 0.55, I[i])
            assert m.growth[r, i] == pytest.approx(fastest(coefficients(law, state), 1e3)[0] / state.D, rel=1e-12)
    inside = np.isfinite(growth_map(LAWS[2], I, ratio, PACKING, 0.55).growth)
    np.testing.assert_array_equal(inside, np.broadcast_to(ratio[:, None] < 0.8 - 1e-12, inside.shape))


def test_finer_grids_add_modes_and_change_none():
    coarse, fine = modes(16, seed=3, smooth=2.0), modes(32, seed=3, smooth=2.0)
    m = np.fft.fftfreq(16, 1 / 16).astype(int)
    same = fine[:, m[:, None], m]
    same[:, np.abs(m) == 8], same[:, :, np.abs(m) == 8] = 0, 0
    np.testing.assert_array_equal(coarse, same)
    assert np.abs(coarse).any(axis=0).sum() == 15**2 - 1
    assert not np.allclose(modes(16, seed=4, smooth=2.0), coarse)


def test_ill_posed_laws_paint_the_grid_and_well_posed_ones_agree():
    t = 0.06 / SHARED.D
    laws = Coulomb(BEADS.mu(0.01)), LAWS[1], CSSM(BEADS.mu(0.01), PACKING), LAWS[3]
    for law in laws:
        coarse, fine = (noise_after(law, SHARED, n, t) for n in (32, 64))
        gap = np.abs(fine.after[:2, ::2, ::2] - coarse.after[:2]).max() / np.abs(coarse.after[:2]).max()
        if law is LAWS[3]:
            assert gap < 0.2  # the tail of the noise that only the finer grid holds
            assert fine.gain == pytest.approx(coarse.gain, rel=1e-3)
        else:
            assert gap > 3
            assert fine.gain > 50 * coarse.gain


def test_measured_growth_is_the_symbols():
    for law in (LAWS[0], LAWS[1], CSSM(BEADS.mu(0.01), PACKING), LAWS[3]):
        noise = noise_after(law, SHARED, 64, 0.06 / SHARED.D)
        fast = noise.predicted > 30 * SHARED.D  # slow modes still carry what the noise began with
        assert fast.sum() > 10
        np.testing.assert_allclose(noise.measured[fast], noise.predicted[fast], rtol=0.02)


def test_the_noise_of_an_incompressible_law_is_the_same_without_its_divergence():
    noise = noise_after(LAWS[1], SHARED, 32, 1.0)
    q = np.fft.fft2(noise.before)
    m = np.fft.fftfreq(32, 1 / 32)
    divergence = m[:, None] * q[0] + m * q[1]
    assert np.abs(divergence).max() < 1e-12 * np.abs(q[:2]).max()
    loose = noise_after(LAWS[3], SHARED, 32, 1.0)  # the same noise, its divergence left in
    r = np.fft.fft2(loose.before)
    np.testing.assert_allclose(
        m[:, None] * q[1] - m * q[0], m[:, None] * r[1] - m * r[0], atol=1e-12 * np.abs(r[:2]).max()
    )
    np.testing.assert_array_equal(noise.after[2], noise.before[2])
    assert abs(noise.before[0].mean()) < 1e-18
    with pytest.raises(ValueError, match="t must be"):
        noise_after(LAWS[1], SHARED, 32, -1.0)


def test_time_adds_up():
    """Two steps of t/2 are one of t: the modes at t/2, marched on by the exponential of the same matrix."""
    whole, half = (noise_after(LAWS[3], SHARED, 16, s) for s in (4.0, 2.0))
    from scipy.linalg import expm

    from primer.granular.linearisation import reduced

    q = np.fft.fft2(half.after, norm="forward")
    m = np.fft.fftfreq(16, 1 / 16)
    xi = 2 * np.pi / 200 * np.stack(np.meshgrid(m, m, indexing="ij"))
    step = expm(-reduced(coefficients(LAWS[3], SHARED), xi) * 2.0)
    after = np.fft.ifft2(np.moveaxis((step @ np.moveaxis(q, 0, -1)[..., None])[..., 0], -1, 0), norm="forward")
    np.testing.assert_allclose(after.real, whole.after, atol=1e-11 * np.abs(whole.after).max())


def test_the_routes_agree_but_for_what_they_are_known_to_lose():
    c = coefficients(LAWS[3], BaseState(0.2, 0.55, 1e-3))
    found = compare(c, np.array([1e3, 1e6]), np.cos(2 * np.radians(np.linspace(0.5, 89.5, 20))))
    by_name = dict(zip(found.names, found.errors, strict=True))
    assert by_name["cubic"].max() < 1e-12
    assert by_name["polished, 5 x 5"].max() < 1e-9
    assert by_name["QR, 3 x 3"].max() < 1e-7
    assert by_name["closed form, |xi| -> infinity"][1] < 1e-9
    assert by_name["QZ, 5 x 5"].max() > 1e-11
    assert len(ROUTES) == 6


def test_multiprecision_is_sure_of_its_digits():
    c = coefficients(LAWS[3], BaseState(0.2, 0.55, 0.1))
    few, many = (multiprecision(c, 1e6, 0.3, digits) for digits in (30, 80))
    np.testing.assert_allclose(few, many, rtol=1e-15)


@pytest.mark.parametrize("law", NAMES)
def test_the_report_is_plain_and_says_what_the_functions_say(law):
    answer = report(law, p=0.2, phi=0.55, I=0.1)
    assert json.loads(json.dumps(answer, allow_nan=False)) == answer
    assert answer["verdict"] in text(answer)
    assert answer["reason"] in text(answer)


def test_the_report_of_the_reference_state():
    answer = report("cidr", p=0.2, phi=0.55, I=0.1)
    assert answer["verdict"] == "well-posed"
    assert answer["limit"] == answer["bound"] == pytest.approx(1.000069799646291, rel=1e-12)
    assert all(answer[name] for name in ("equality", "a", "b"))
    assert "1.00006979965" in text(answer)
    assert report("mui", p=0.2, phi=0.55, I=0.1)["neutral_I"] == pytest.approx([0.0194016579336, 0.8402720681500])
    assert report("coulomb", p=0.2, phi=0.55, I=0.1)["limit"] is None


def test_the_command_prints_text_or_json_and_refuses_what_is_not_physical(capsys):
    arguments = ["granular", "--law", "cidr", "--phi", "0.55", "--p", "0.2", "--I", "0.1"]
    assert main(arguments) == 0
    assert "well-posed" in capsys.readouterr().out
    assert main([*arguments, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["verdict"] == "well-posed"
    for name, law in (("Coulomb", "Coulomb"), ("mu(I)", "IncompressibleMuI"), ("mui", "IncompressibleMuI")):
        assert main([*arguments[:2], name, *arguments[3:]]) == 0
        assert capsys.readouterr().out.startswith(f"{law}(")
    for wrong in ("--phi 0.7", "--p -1", "--I 0", "--mu2 0.1", "--p nan", "--p 5"):
        assert main([*arguments, *wrong.split()]) == 2
        said = capsys.readouterr().err
        assert "must" in said
        assert len(said.splitlines()) == 1
    with pytest.raises(ValueError, match="law must be one of"):
        report("sand", p=0.2, phi=0.55, I=0.1)
