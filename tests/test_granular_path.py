"""Guards the stress path of Appendix 1.2, alone and with noise: what is held, where it ends, where it localises."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from primer.granular import CIDR, CSSM, EXAMPLE_COMPACTION, GLASS_BEADS, BaseState, Coulomb, PlaneWave
from primer.granular.layer import system_of
from primer.granular.localisation import localise
from primer.granular.march import Outcome
from primer.granular.stress_path import stress_path

BEADS, PACKING = GLASS_BEADS.friction, EXAMPLE_COMPACTION
SOIL, MIX = CSSM(BEADS.mu1, PACKING), CIDR(BEADS, PACKING)


def start(law, factor, I=0.01):
    """State B of Figure 2(b) for a factor below 1, A above."""
    return BaseState(factor * law.p_critical(0.55, I), 0.55, I)


@pytest.mark.parametrize("factor", [0.62, 1.42], ids=["B", "A"])
@pytest.mark.parametrize("law", [SOIL, MIX], ids=["CSSM", "CIDR"])
def test_the_path_ends_on_the_critical_state_line_under_the_same_load(law, factor):
    path = stress_path(law, start(law, factor), strain=5.0)
    D = np.hypot(path.shear, path.div) / 2
    np.testing.assert_allclose(path.p - path.div / (2 * D) * path.tau, path.load, rtol=1e-11)
    np.testing.assert_allclose(path.div / (2 * D), law.f(path.p, path.phi, path.I), atol=1e-11)
    np.testing.assert_allclose(path.tau, law.Y(path.p, path.phi, path.I), rtol=1e-11)
    np.testing.assert_allclose(path.I, 2 * D / np.sqrt(path.p), rtol=1e-11)
    mu = law.mu if law is SOIL else BEADS.mu(path.I[-1])
    assert path.p[-1] == pytest.approx(path.load, rel=1e-10)
    assert path.tau[-1] == pytest.approx(mu * path.p[-1], rel=1e-9)
    assert path.phi[-1] == pytest.approx(PACKING.phi(path.load / law.b(path.I[-1]) * 2), rel=1e-9)
    rises = factor > 1  # A contracts, strengthens, and ends on a larger yield locus
    assert (np.diff(path.p[:10]) > 0).all() == rises
    assert (path.phi[-1] > 0.55) == rises


def test_the_path_of_cssm_by_a_plain_runge_kutta_method():
    state = start(SOIL, 0.62)
    path, mu = stress_path(SOIL, state, strain=0.3, points=4), BEADS.mu1
    C = lambda phi: (phi - 0.5) / (0.6 - phi)  # noqa: E731
    f0 = 2 * mu - 2 * state.p / C(0.55)
    load = state.p - f0 * (2 * mu * state.p - state.p**2 / C(0.55))

    def slope(phi):  # d phi/d(gamma t)
        f = lambda p: 2 * mu - 2 * p / C(phi)  # noqa: E731
        p = brentq(lambda p: p - f(p) * (2 * mu * p - p * p / C(phi)) - load, 0.01, 0.5, xtol=1e-15)
        return -phi * f(p) / math.sqrt(1 - f(p) ** 2)

    phi, h = 0.55, 1e-3
    for step in range(1, 301):
        k1 = slope(phi)
        k2 = slope(phi + h / 2 * k1)
        k3 = slope(phi + h / 2 * k2)
        phi += h / 6 * (k1 + 2 * k2 + 2 * k3 + slope(phi + h * k3))
        if step % 100 == 0:
            assert path.phi[step // 100] == pytest.approx(phi, rel=1e-8)


@pytest.mark.parametrize("law", [SOIL, MIX], ids=["CSSM", "CIDR"])
def test_the_layer_without_noise_follows_the_path(law):
    state = start(law, 1.42)
    band, path = localise(law, state, 8, strain=0.3, amplitude=0.0, points=4), stress_path(law, state, 0.3, 4)
    np.testing.assert_allclose(band.p, path.p, rtol=1e-3)  # but for the creep that is added to ||D||
    exact = localise(law, state, 8, strain=0.3, amplitude=0.0, points=4, creep=0.0)
    np.testing.assert_allclose(exact.p, path.p, rtol=1e-4)
    np.testing.assert_allclose(exact.phi.mean(axis=1), path.phi, rtol=1e-5)  # the piston lags
    np.testing.assert_allclose(band.width, 0.5, rtol=1e-9)


@pytest.mark.parametrize("law", [SOIL, MIX], ids=["CSSM", "CIDR"])
def test_the_jacobian_of_the_layer_is_that_of_its_right_hand_side(law):
    layer = system_of(law, start(law, 0.7), n=8, height=20.0, creep=0.02)
    rng, D = np.random.default_rng(0), float(layer.state.D)
    wave = np.concatenate([rng.normal(size=16) * D, 1.1 * (0.55 + 0.005 * rng.normal(size=8)) - 0.55])
    y = np.concatenate([wave, [math.log(1.1), 0.1 * D]])
    wanted = []
    for j in range(y.size):
        change = np.zeros(y.size)
        change[j] = 1e-6 * layer.unit[j]
        wanted.append((layer.rhs(0.0, y + change) - layer.rhs(0.0, y - change)) / (2 * change[j]))
    scale = layer.unit / layer.unit[:, None]
    gap, size = (layer.jacobian(0.0, y).toarray() - np.array(wanted).T) * scale, np.abs(np.array(wanted).T * scale)
    assert (np.abs(gap).max(axis=1) < 1e-6 * size.max(axis=1)).all()


def test_short_waves_across_the_layer_grow_as_the_symbol_in_the_bad_direction_says():
    state = start(SOIL, 0.62)
    layer = system_of(SOIL, state, n=64, height=20.0, creep=0.0)
    f = float(SOIL.f(state.p, 0.55, 0.01))
    y = np.concatenate([np.zeros(128), np.zeros(64), [0.0, 2 * f * float(state.D)]])
    found = np.linalg.eigvals(layer.jacobian(0.0, y).toarray()[:192, :192]).real.max()
    angle = math.degrees(math.acos(-f) / 2)  # (e44)
    assert PlaneWave(SOIL, state).angle == pytest.approx(angle, rel=1e-9)
    assert found == pytest.approx(PlaneWave(SOIL, state, angle).growth(64 / 20.0), rel=0.05)


@pytest.mark.slow
def test_a_stays_uniform_and_b_localises_in_cssm_as_thin_as_the_grid_allows():
    a = [localise(SOIL, start(SOIL, 1.42), n, 0.2, points=3) for n in (32, 64)]
    assert {band.outcome for band in a} == {Outcome.REACHED_END}
    assert all(abs(band.width[-1] - 0.5) < 0.005 for band in a)
    b = [localise(SOIL, start(SOIL, 0.62), n, 0.2, points=3) for n in (32, 64, 128)]
    width = np.array([band.width[-1] for band in b])
    assert (width < 0.2).all()
    assert width[2] < 0.7 * width[1] < 0.7 * width[0]
    assert all(band.mass_drift < 1e-14 for band in a + b)


@pytest.mark.slow
def test_b_localises_in_cidr_to_a_band_of_its_own():
    given = {"strain": 0.2, "amplitude": 1e-3, "modes": 4, "points": 3}
    width = [localise(MIX, start(MIX, 0.62), n, **given).width[-1] for n in (64, 128, 256)]
    assert width[2] < 0.25
    assert abs(width[2] / width[1] - 1) < 0.005
    soil = [localise(SOIL, start(SOIL, 0.62), n, **given).width[-1] for n in (64, 128, 256)]
    assert soil[2] < 0.7 * soil[1] < 0.7 * soil[0]


def test_without_creep_the_march_ends_where_a_part_of_the_layer_stops():
    band = localise(SOIL, start(SOIL, 0.62), 64, creep=0.0)
    assert band.outcome == Outcome.RIGID
    assert band.strain[-1] < 0.1
    assert band.shear[-1].min() < 0.05


@pytest.mark.parametrize(
    ("function", "given", "kind", "words"),
    [
        (stress_path, (SOIL, start(SOIL, 0.62), 0.0), ValueError, "strain must be"),
        (stress_path, (SOIL, BaseState([0.2, 0.3], 0.55, 0.1)), ValueError, "state must be a single state"),
        (stress_path, (Coulomb(0.4), BaseState(0.2, 0.55, 0.1)), ValueError, "law must be compressible"),
        (stress_path, (SOIL, BaseState(0.9, 0.55, 0.1)), ValueError, "p must be < "),
        (stress_path, (CSSM(0.9, PACKING), BaseState(0.01, 0.55, 0.1)), ValueError, "must have |f| < 1"),
        (localise, (Coulomb(0.4), BaseState(0.2, 0.55, 0.1), 16), ValueError, "law must be compressible"),
        (localise, (SOIL, start(SOIL, 0.62), 2), ValueError, "n must be"),
        (localise, (SOIL, start(SOIL, 0.62), 16, 0.1, -1.0), ValueError, "height must be"),
        (localise, (SOIL, start(SOIL, 0.62), 16, 0.1, 60.0, 9.0), ValueError, "amplitude must leave"),
    ],
)
def test_bad_input_is_one_sentence(function, given, kind, words):
    with pytest.raises(kind) as caught:
        function(*given)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
