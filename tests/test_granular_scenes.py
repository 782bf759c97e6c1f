"""Guards the maps, the noise, the eigenvalue routes and the report: numbers against closed forms and each other."""

import json
import math

import mpmath
import numpy as np
import pytest
from scipy.linalg import expm

from primer.__main__ import main
from primer.granular import (
    CIDR,
    CSSM,
    EXAMPLE_COMPACTION,
    GLASS_BEADS,
    BaseState,
    Compaction,
    Coulomb,
    IncompressibleMuI,
    MuI,
    coefficients,
    conditions,
    growth_limit,
    incompressible_criterion,
    linearise,
    neutral_inertial_numbers,
    verdict,
)
from primer.granular.command import report, text
from primer.granular.dispersion import growth_rates
from primer.granular.fastest import fastest
from primer.granular.linearisation import reduced
from primer.granular.maps import growth_map, neutral_stress_ratio
from primer.granular.named import LAWS as NAMES
from primer.granular.noise import _exponentials, modes, noise_after
from primer.granular.routes import ROUTES, asymptotic, compare, multiprecision, wavevector

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


@pytest.mark.parametrize("law", NAMES[:-1])
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


def test_a_map_starts_from_what_it_says_and_refuses_the_rest():
    I, ratio = np.array([0.01, 0.1]), np.array([0.2, 0.5, 0.9])
    default, stated = growth_map(LAWS[3], I, ratio, PACKING, 0.55), growth_map(LAWS[3], I, ratio, PACKING, 0.55, k=1e4)
    assert default.k == 1e4
    np.testing.assert_array_equal(default.growth, stated.growth)
    np.testing.assert_array_equal(default.I, I)
    np.testing.assert_array_equal(default.ratio, ratio)
    assert np.isnan(default.growth[2, 0])  # Y < 0: alpha(0.01) < 0.9
    assert np.isnan(default.x[2, 0])
    for r, i in ((0, 0), (1, 1)):
        state = BaseState(ratio[r] * PACKING.C(0.55), 0.55, I[i])
        rate, x = fastest(coefficients(LAWS[3], state), 1e4)
        assert (default.growth[r, i], default.x[r, i]) == pytest.approx((rate / state.D, x), rel=1e-9)
    for arguments, said in (
        (([0.0], ratio), "I must be a sequence of numbers > 0, got array([0.])"),
        ((I, 0.3), "ratio must be a sequence of numbers > 0, got 0.3"),
        (([], ratio), "I must be a sequence of numbers > 0, got array([], dtype=float64)"),
        (
            (np.full(3000, 0.1), np.full(3000, 0.1)),
            "I and ratio must fit into 2 GiB of memory, got 3000 times 3000 stat",
        ),
    ):
        with pytest.raises(ValueError, match="must") as error:
            growth_map(LAWS[3], *arguments, PACKING, 0.55)
        assert str(error.value).startswith(said)
    for wrong in ({"phi": 0.0}, {"k": 0.0}):
        with pytest.raises(ValueError, match="must be a finite number > 0, got 0"):
            growth_map(LAWS[3], I, ratio, PACKING, **{"phi": 0.55, **wrong})


def test_the_neutral_stress_ratio_solves_its_quartic_and_is_the_largest_root():
    rng = np.random.default_rng(0)
    for mu1, rise, I0 in rng.uniform(0.05, 0.8, (40, 3)):
        friction, I = MuI(mu1, mu1 + rise, I0), 10 ** rng.uniform(-4, 3, 5)
        T = neutral_stress_ratio(friction, I)
        mu, s = friction.mu(I), I * friction.dmu(I)
        assert T.shape == (5,)
        left, right = T**2 * (2 * T - s) ** 2, 16 * (mu + s - T) * (2 * T - mu - s)
        assert (np.abs(left - right) <= 1e-13 * (left + 16 * (mu + s) ** 2)).all()
        beyond = T * np.linspace(1.0001, 4, 200)[:, None]
        assert (beyond**2 * (2 * beyond - s) ** 2 > 16 * (mu + s - beyond) * (2 * beyond - mu - s)).all()
    assert np.shape(neutral_stress_ratio(BEADS, 0.1)) == ()
    I = np.geomspace(1e-3, 10, 200)
    for T, mu, s in zip(neutral_stress_ratio(BEADS, I), BEADS.mu(I), I * BEADS.dmu(I), strict=True):
        with mpmath.workdps(40):  # all digits
            q, s = mpmath.mpf(float(mu)) + mpmath.mpf(float(s)), mpmath.mpf(float(s))
            exact = mpmath.findroot(lambda T, q=q, s=s: T**2 * (2 * T - s) ** 2 - 16 * (q - T) * (2 * T - q), float(T))
            assert abs(T / exact - 1) < 1e-15
    steep = neutral_stress_ratio(MuI(0.98, 1.94, 0.73), np.array([1e-3, 10.0]))
    assert np.isnan(steep).tolist() == [False, True]  # mu = 1.88: the two roots have met and gone


def test_the_modes_of_the_noise_one_by_one():
    """Shell by shell of max(|m_1|, |m_2|), in the order of m_1, then m_2, from a stream named by seed and shell."""
    q = modes(8, 5, 1.5)
    assert (q[:, 0, 0] == 0).all()
    assert (q[:, 4] == 0).all()
    assert (q[:, :, 4] == 0).all()
    for s in (1, 2, 3):
        shell = [(i, j) for i in range(-s, s + 1) for j in range(-s, s + 1) if max(abs(i), abs(j)) == s]
        draw = np.random.default_rng([5, s]).normal(size=(2, 3, len(shell)))
        for place, (i, j) in enumerate(shell):
            expected = (draw[0, :, place] + 1j * draw[1, :, place]) * (i * i + j * j) ** -0.75
            np.testing.assert_allclose(q[:, i, j], expected, rtol=1e-14)


@pytest.mark.parametrize("law", [LAWS[0], LAWS[3]], ids=lambda law: type(law).__name__)
def test_the_noise_mode_by_mode_against_the_matrix_exponential(law):
    n, t, side, state = 8, 3.0, 50.0, BaseState(0.3, 0.56, 0.2, d=0.7, rho=1.7)
    noise, c = noise_after(law, state, n, t, side, seed=4, smooth=1.0), coefficients(law, state)
    start, grid = modes(n, 4, 1.0), np.arange(n) * side / n
    before, after, shells = 0, 0, {}
    for i in range(-3, 4):
        for j in range(-3, 4):
            if i == j == 0:
                continue
            xi = 2 * np.pi / side * np.array([i, j])
            q = start[:, i, j] * np.array([state.D * state.d] * 2 + [1e-3])
            if c.incompressible:
                across = np.array([-j, i]) / math.hypot(i, j)
                q[:2] = across * (across @ q[:2])
                lam = linearise(law, state).eigenvalues(xi)[0].real
                steps = [np.diag([math.exp(lam * s)] * 2 + [1]) for s in (0.9 * t, t)]
                top = lam
            else:
                steps = [expm(-reduced(c, xi) * s) for s in (0.9 * t, t)]
                top = np.linalg.eigvals(-reduced(c, xi)).real.max()
            late, end = (step @ q for step in steps)
            rate = math.log(np.linalg.norm(end[:2]) / np.linalg.norm(late[:2])) / (0.1 * t)
            shells.setdefault(round(math.hypot(i, j)), []).append((rate, top))
            wave = np.exp(1j * (xi[0] * grid[:, None] + xi[1] * grid))
            before, after = before + q[:, None, None] * wave, after + end[:, None, None] * wave
    np.testing.assert_allclose(noise.before, before.real, atol=1e-13 * np.abs(before).max())
    np.testing.assert_allclose(noise.after, after.real, atol=1e-11 * np.abs(after).max())
    rms = [np.sqrt((v[:2].real ** 2).mean()) for v in (before, after)]
    assert noise.gain == pytest.approx(rms[1] / rms[0], rel=1e-10)
    np.testing.assert_allclose(noise.k, 2 * np.pi / side * np.array(sorted(shells)), rtol=1e-14)
    np.testing.assert_allclose(noise.measured, [max(r for r, _ in shells[s]) for s in sorted(shells)], rtol=1e-7)
    top = [max(p for _, p in shells[s]) for s in sorted(shells)]
    np.testing.assert_allclose(noise.predicted, top, rtol=1e-7, atol=1e-15)
    assert (noise.n, noise.t, noise.side) == (n, t, side)


def test_noise_is_on_a_square_of_side_200_with_seed_1_unless_said_otherwise():
    default = noise_after(LAWS[3], SHARED, 8, 1.0)
    np.testing.assert_array_equal(default.after, noise_after(LAWS[3], SHARED, 8, 1.0, 200.0, 1, 2.5).after)
    assert noise_after(LAWS[3], SHARED, 4, 1.0, seed=0, smooth=-10).before.shape == (3, 4, 4)
    assert noise_after(LAWS[3], SHARED, 4, 1.0, smooth=10).gain > 0


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"n": 5}, "n must be even, got 5"),
        ({"n": 2}, "n must be an integer >= 4, got 2"),
        ({"n": 1038}, "n: the matrices of all modes must fit into 2 GiB of memory, got n = 1038"),
        ({"t": 0}, "t must be a finite number > 0, got 0"),
        ({"t": 1e9}, "t must be short enough for the noise to stay finite, got 1e+09"),
        ({"side": 0}, "side must be a finite number > 0, got 0"),
        ({"side": 1e-19}, "side must be >= pi n/1e+20, got 1e-19 with n = 8"),
        ({"seed": -1}, "seed must be an integer >= 0, got -1"),
        ({"smooth": -10.1}, "smooth must be a finite number >= -10 and <= 10, got -10.1"),
        ({"smooth": 10.1}, "smooth must be a finite number >= -10 and <= 10, got 10.1"),
        ({"state": BaseState([0.1, 0.2], 0.55, 0.1)}, "state must be a single state, got shape (2,)"),
    ],
)
def test_noise_that_cannot_be_made_is_refused_in_one_sentence(options, said):
    arguments = {"law": LAWS[0], "state": SHARED, "n": 8, "t": 1.0, **options}
    with pytest.raises(ValueError, match="must") as error:
        noise_after(**arguments)
    assert str(error.value) == said


def test_every_route_finds_the_same_three_growth_rates():
    c = coefficients(LAWS[3], BaseState([0.2, 0.3], 0.55, [0.1, 0.5]))
    one = coefficients(LAWS[3], BaseState(0.2, 0.55, 0.1))
    k, x = np.array([[50.0], [300.0]]), np.array([-0.7, 0.0, 0.2, 0.9])
    exact = multiprecision(one, k, x)
    assert exact.shape == (2, 4, 3)
    tolerances = {"QZ, 5 x 5": 1e-5, "QR, 3 x 3": 1e-8, "polished, 5 x 5": 1e-9, "cubic": 1e-12}
    tolerances |= {"closed form, |xi| -> infinity": 1e-2, "multiprecision, 50 digits": 0}
    assert [name for name, _ in ROUTES] == list(tolerances)
    for name, route in ROUTES:
        found = route(one, k, x)
        assert found.shape == (2, 4, 3), name
        gaps = np.abs(np.sort(found.real, axis=-1) - np.sort(exact.real, axis=-1)) / np.abs(
            np.sort(exact.real, axis=-1)
        )
        assert gaps.max() <= tolerances[name], name
    for p, I, j in ((0.2, 0.1, 0), (0.3, 0.5, 1)):  # the reference against the general polynomial at one direction
        single = coefficients(LAWS[3], BaseState(p, 0.55, I))
        np.testing.assert_allclose(growth_rates(single, 50.0, 0.2), growth_rates(c, 50.0, 0.2)[j], rtol=1e-13)


def test_the_errors_of_the_routes_are_the_largest_over_the_directions():
    c, k, x = coefficients(LAWS[3], BaseState(0.2, 0.55, 0.1)), np.array([20.0, 1e3]), np.array([-0.7, 0.1, 0.9])
    found = compare(c, k, x)
    assert found.names == tuple(name for name, _ in ROUTES[:-1])
    assert found.errors.shape == (5, 2)
    np.testing.assert_array_equal(found.k, k)
    third = [min(multiprecision(c, 20.0, v), key=abs) for v in x]
    errors = [
        abs(min(asymptotic(c, 20.0, v), key=lambda z, t=t: abs(z - t)) - t) / abs(t)
        for v, t in zip(x, third, strict=True)
    ]
    assert found.errors[4, 0] == pytest.approx(max(errors), rel=1e-9)
    xi = wavevector(np.array([[2.0], [3.0]]), x)
    assert xi.shape == (2, 2, 3)
    np.testing.assert_allclose(np.hypot(*xi), np.broadcast_to([[2.0], [3.0]], (2, 3)), rtol=1e-15)
    np.testing.assert_allclose((xi[0] ** 2 - xi[1] ** 2) / (xi**2).sum(axis=0), [x, x], rtol=1e-14)


@pytest.mark.parametrize(
    ("law", "options"),
    [("coulomb", {"mu": 0.4}), ("mui", {}), ("cssm", {"phi0": 0.51, "eps": 0.12, "C0": 2.0}),
     ("cidr", {"mu1": 0.3, "mu2": 0.6, "I0": 0.3, "d": 0.5, "rho": 2.0}), ("mui", {"I": 0.3}), ("cssm", {"p": 0.37})],
)  # fmt: skip
def test_a_report_holds_what_the_functions_give(law, options):
    options = {"p": 0.2, "phi": 0.55, "I": 0.01, **options}
    state = BaseState(*(options.get(name, 1.0) for name in ("p", "phi", "I", "d", "rho")))
    friction = MuI(options.get("mu1", BEADS.mu1), options.get("mu2", BEADS.mu2), options.get("I0", BEADS.I0))
    packing = Compaction(options.get("phi0", 0.5), options.get("eps", 0.1), options.get("C0", 1.0))
    mu = options.get("mu", float(friction.mu(options["I"])))
    made = {"coulomb": Coulomb(mu), "mui": IncompressibleMuI(friction), "cssm": CSSM(mu, packing)}
    made = made.get(law, CIDR(friction, packing))
    answer, v, holds = report(law, **options), verdict(made, state), conditions(made, state)
    says = incompressible_criterion(friction, state.I)
    expected = {
        "law": repr(made),
        "state": {name: getattr(state, name) for name in ("p", "phi", "I", "d", "rho")},
        "dim": 2,
        "lode": None,
        "D": state.D,
        "tau": made.Y(state.p, state.phi, state.I),
        "div_u": state.div_u(made),
        "B": holds.B,
        "C": holds.C,
        "equality": bool(holds.equality),
        "Y_I": holds.Y_I,
        "a": bool(holds.a),
        "slope": holds.slope,
        "b": bool(holds.b),
        "verdict": str(v.kind),
        "exponent": str(v.exponent),
        "coefficient": v.coefficient if np.isfinite(v.coefficient) else None,
        "direction": list(v.direction),
        "bound": v.bound if np.isfinite(v.bound) else None,
        "unstable": v.unstable,
        "limit": growth_limit(made, state) if np.isfinite(growth_limit(made, state)) else None,
        "reason": v.reason,
    }
    if law == "mui":
        expected |= {"n": says.n, "criterion_C": says.C, "neutral_I": list(neutral_inertial_numbers(friction))}
    assert answer == expected
    word = {True: "holds", False: "fails"}
    at = ", ".join(f"{name} = {value:g}" for name, value in expected["state"].items())
    lines = [
        expected["law"],
        f"at {at}: ||D|| = {state.D:.6g}, ||tau|| = {expected['tau']:.6g}, div u = {expected['div_u']:.6g}",
        "",
        "hypotheses of the theorem",
        f"  Y_p - I/(2p) Y_I = f + I f_I   {word[answer['equality']]}   {holds.B:.6g} and {holds.C:.6g}",
        f"  (a) Y_I > 0                    {word[answer['a']]}   {holds.Y_I:.6g}",
        f"  (b) f_p - I/(2p) f_I < 0       {word[answer['b']]}   {holds.slope:.6g}",
    ]
    if law == "mui":
        lines.append("criterion of the incompressible mu(I)-rheology: C <= 0 or n >= 1/2")
        roots = ", ".join(f"{value:.10g}" for value in expected["neutral_I"])
        lines.append(f"  C = {says.C:.6g}, n = {says.n:.6g}; neutral inertial numbers: {roots}")
    limit = {True: "infinity", False: "-infinity"}[v.kind == "ill-posed"]
    limit = limit if answer["limit"] is None else f"{answer['limit']:.12g}"
    lines += ["", f"{v.kind}: {v.reason}.", f"limit of the largest growth rate as |xi| -> infinity: {limit}"]
    assert text(answer) == "\n".join(lines)


def test_the_command_takes_every_parameter_and_its_defaults_are_the_reports(capsys):
    where = ["granular", "--law", "cidr", "--phi", "0.55", "--p", "0.2", "--I", "0.1", "--json"]
    assert main(where) == 0
    assert json.loads(capsys.readouterr().out) == report("cidr", 0.2, 0.55, 0.1)
    given = {"d": 0.5, "rho": 2.0, "mu1": 0.3, "mu2": 0.6, "I0": 0.2, "mu": 0.44, "phi0": 0.51, "eps": 0.11, "C0": 1.5}
    assert main([*where, *(word for name, value in given.items() for word in (f"--{name}", str(value)))]) == 0
    assert json.loads(capsys.readouterr().out) == report("cidr", 0.2, 0.55, 0.1, **given)
    assert report("mui", 0.2, 0.55, 0.1, mu1=0.3, mu2=0.31)["neutral_I"] == []
    assert text(report("mui", 0.2, 0.55, 0.1, mu1=0.3, mu2=0.31)).count("neutral inertial numbers: none") == 1
    with pytest.raises(ValueError, match=r"^law must be one of coulomb, mui, cssm, cidr, .*text, got 'sand'$"):
        report("sand", p=0.2, phi=0.55, I=0.1)
    with pytest.raises(SystemExit):
        main(where[:3] + where[3:5])  # p and I are needed


@pytest.mark.parametrize("size", [1e-6, 1.0, 30.0])
def test_matrix_exponentials_at_once_are_those_one_by_one(size):
    """Growing and damped matrices of many sizes in one batch, against scipy."""
    random = np.random.default_rng(3)
    A = (
        size
        * (random.normal(size=(60, 3, 3)) + 1j * random.normal(size=(60, 3, 3)))
        * np.geomspace(0.01, 1, 60)[:, None, None]
    )
    A[::2] -= 3 * size * np.eye(3)
    ours, theirs = _exponentials(A), expm(A)
    apart = np.abs(ours - theirs).max(axis=(1, 2)) / np.abs(theirs).max(axis=(1, 2))
    assert apart.max() < 1e-12
