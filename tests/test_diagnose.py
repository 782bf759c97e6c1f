"""Guards diagnose: right about random scenes that it has not seen, the interval, the hard cases, and the strides."""

import math

import numpy as np
import pytest

import primer.study.toy_diagnosis as diagnosis
from primer import Seed, Stop, Toy, diagnose, exact_march, ftcs
from primer.schemes.discrete import discrete_steady
from primer.schemes.grid import Grid
from primer.schemes.record import plan
from primer.study.catalogue import HARD_CASES
from primer.study.diagnosis import Kind
from primer.study.forecast import Forecast
from primer.study.leap import Half
from primer.study.spectrum import fastest, growing, jacobian
from primer.study.stability import stable_dt


def scenes(count, seed, logarithmic):
    random = np.random.default_rng(seed)
    for _ in range(count):
        a, n = random.uniform(-1, 2), int(random.integers(8, 601))
        eps, dt = random.uniform(0.001, 0.1), random.uniform(1e-5, 2e-2)
        if logarithmic:  # more of coarse grids, small steps and weak coefficients
            eps, dt = 10 ** random.uniform(-3, -1), 10 ** random.uniform(-5, math.log10(2e-2))
            n = int(np.exp(random.uniform(math.log(8), math.log(600))))
        mode = int(random.integers(1, n // 2 + 1))
        yield Toy(a, eps), n, dt, Seed(mode, 1e-6, "uv"[random.integers(2)])


@pytest.mark.slow
@pytest.mark.parametrize("logarithmic", [False, True])
def test_random_scenes(logarithmic):
    """At least 98 of 100 right, and nine of ten blow-ups within an interval at most a factor 1.5 wide."""
    right, inside = [], []
    for toy, n, dt, seed in scenes(100, 2024 + logarithmic, logarithmic):
        found, run = diagnose(toy, n, dt, 30.0, seed), ftcs(toy, n, dt, 30.0, seed=seed)
        blew_up = run.stop is Stop.BLEW_UP
        right.append((found.blow_up is not None) == blew_up and consistent(found.kind, toy, run))
        if blew_up and found.blow_up:
            earliest, latest = found.blow_up
            assert latest <= 1.5 * earliest
            inside.append(earliest <= run.t_stop <= latest)
    assert np.sum(right) >= 98
    assert np.mean(inside) >= 0.9
    assert len(inside) >= 30


def consistent(kind, toy, run):
    """Whether a kind can be that of a run at all."""
    lived, dipped = run.stop is Stop.REACHED_END, run.t_first_negative is not None
    return {
        Kind.CONVERGES: lived and not dipped and toy.a >= 1,
        Kind.HIDDEN: lived and toy.a < 1,
        Kind.ILL_POSED: not lived and toy.a < 1,
        Kind.TRANSIENT: dipped and toy.a >= 1,
        Kind.SCHEME: not lived,
    }[kind]


@pytest.mark.slow
def test_a_blow_up_of_the_scheme_is_cured_by_a_smaller_step_and_no_other():
    """Scenes that blow up on grids quick to march, marched again with a small dt."""
    seen = set()
    for toy, n, dt, seed in scenes(250, 7, True):
        found = diagnose(toy, n, dt, 30.0, seed) if n < 150 and dt > 5e-3 else None
        if found and found.blow_up:
            small = min(dt / 4, 0.1 * Grid(n).h ** 2, 0.5 / (1 + 4 * toy.eps * (abs(toy.a) + 1.2) / Grid(n).h ** 2))
            scheme = found.kind is Kind.SCHEME
            run = ftcs(toy, n, small, 30.0 if scheme else 60.0, seed=seed)
            assert (run.stop is Stop.REACHED_END) == scheme, found
            seen.add(found.kind)
    assert {Kind.SCHEME, Kind.ILL_POSED} <= seen


def test_the_reason_says_why_the_equations_are_well_posed():
    assert "well posed, as the equations have no second derivative" in diagnose(Toy(1.5, 0.0), 40, 1e-3, 5.0).reason
    assert "well posed, as u stays positive" in diagnose(Toy(1.5), 40, 1e-3, 5.0).reason


@pytest.mark.parametrize(("n", "t_end"), [(30, 100.0), (100, 1.0)])
def test_the_reason_of_what_is_hidden_says_whether_anything_grows(n, t_end):
    """On the coarse grid nothing does; on the fine one it does, but not in so short a time."""
    found = diagnose(Toy(0.5), n, 1e-3, t_end)
    assert found.kind is Kind.HIDDEN
    assert (found.growth > 0) == (n == 100)
    assert ("nothing grows" in found.reason) == (n == 30)
    assert ("perturbations grow only by" in found.reason) == (n == 100)


def test_hard_cases_can_be_marched():
    for case in HARD_CASES:
        asked = plan(case.n, case.dt, case.t_end, None, (), case.seed, 1e3, case.dtype, None)
        assert 0 < asked.dt <= 1e-3
        assert asked.steps * asked.dt == pytest.approx(case.t_end)


def test_hard_cases_that_are_compared_differ_only_in_what_is_said():
    cases = {case.name: case for case in HARD_CASES}
    paper = [cases[name] for name in ("62 points", "63 points", "64 points", "65 points", "66 points")]
    for others in (
        [*paper, cases["64 points, seeded"]],
        [cases["a = 1.05, coarse"], cases["a = 1.05, fine"]],
        [cases["a = 1.15, coarse"], cases["a = 1.15, fine"]],
        [cases["eps = 0, 300 points"], cases["eps = 0, 400 points"]],
        [cases["odd n"], cases["even n"]],
    ):
        assert len({(case.toy, case.t_end) for case in others}) == 1


@pytest.mark.parametrize("name", ["65 points", "66 points"])
def test_one_point_more_outruns_the_last_bit(name):
    (case,) = (case for case in HARD_CASES if case.name == name)
    assert case.diagnose().kind is case.kind


@pytest.mark.slow
@pytest.mark.parametrize("case", HARD_CASES, ids=lambda case: case.name)
def test_hard_cases_end_as_they_must(case):
    run, found = case.march(), case.diagnose()
    assert (run.stop is Stop.BLEW_UP) == case.blows_up
    assert (found.blow_up is not None) == case.blows_up
    assert found.kind is case.kind
    if case.blows_up:
        assert found.blow_up[0] <= run.t_stop <= found.blow_up[1]
        assert found.seeded == (case.seed is not None)
    assert found.reason.endswith(".")
    assert case.why


@pytest.mark.parametrize(
    ("seed", "seeded"),
    [(None, False), (Seed(1, 1e-6), False), (Seed(49, 1e-6), True), (Seed(48, 1e-6, "v"), True), (1e-6, True)],
)
def test_the_mode_of_the_seed_matters(seed, seeded):
    """From a low mode hardly anything reaches the growing one, next to the sawtooth, before round-off does."""
    found = diagnose(Toy(0.5), seed=seed)
    stated = Seed(49, seed) if isinstance(seed, float) else seed
    run = ftcs(Toy(0.5), seed=stated)
    assert found.seeded is seeded
    assert found.seed == stated
    assert found.blow_up[0] <= run.t_stop <= found.blow_up[1]
    assert found.kind is Kind.ILL_POSED
    assert found.kind == "ill-posed"


@pytest.mark.slow
def test_each_kind_by_name():
    kinds = [
        diagnose(*scene).kind for scene in [(Toy(1.5),), (Toy(0.5), 30), (Toy(0.5),), (Toy(1.1),), (Toy(1.5, 0), 300)]
    ]
    assert kinds == ["converges", "hidden", "ill-posed", "transient", "scheme"]


def test_growth_is_that_of_the_jacobian_with_the_step_taken():
    lam = np.linalg.eigvals(jacobian(Toy(0.5), 100))
    for dt in (1e-3, 1e-5):
        expected = np.log(np.abs(1 + dt * lam)).max() / dt
        assert diagnose(Toy(0.5), 100, dt).growth == pytest.approx(expected, rel=1e-6)


@pytest.mark.slow
def test_fewer_digits_blow_up_sooner():
    times = [diagnose(Toy(0.5), dtype=d).t_blow_up for d in (np.float32, np.float64, np.longdouble)]
    times += [diagnose(Toy(0.5), digits=d).t_blow_up for d in (30, 60, 400)]
    assert np.all(np.diff(times) > 0)
    assert times[4] - times[3] == pytest.approx(30 * math.log(10) / diagnose(Toy(0.5)).growth, rel=0.02)


def test_where_u_is_negative_throughout_the_small_step_is_that_of_the_stiffest_mode(monkeypatch):
    """At u = 0 the limit is h^2, four times (pi/n)^2, whatever eps."""
    steps = []
    monkeypatch.setattr(diagnosis, "forecast", lambda toy, n, dt, *rest, **options: steps.append(dt))
    for eps in (0.01, 5.0):
        diagnosis._with_a_small_step(Toy(-2.0, eps), 40, 1e-2, 1.0, None, 1e-16)
    assert steps == pytest.approx(2 * [0.05 * (math.pi / 40) ** 2])
    assert diagnosis._with_a_small_step(Toy(-2.0), 40, steps[0], 1.0, None, 1e-16) is None


@pytest.fixture
def foreseen(monkeypatch):
    """Forecasts of ours: what follows from them, and what they are asked."""

    def diagnosed(toy, *forecasts, growth=0.5, **options):
        asked = []

        def forecast(toy, n, dt, t_end, seed, epsilon, **more):
            asked.append((n, dt, t_end, seed, epsilon, more))
            return forecasts[len(asked) - 1]

        monkeypatch.setattr(diagnosis, "forecast", forecast)
        monkeypatch.setattr(diagnosis, "leader", lambda toy, n, dt=0.0: (np.expm1(growth * dt) / (dt or 1), 50))
        return diagnosis.foretold(toy, **{"n": 100, "dt": 1e-2, "t_end": 12.0, **options}), asked

    return diagnosed


def lost(t, dip=0.7, **origin):
    return Forecast(t, origin.get("seeded", False), origin.get("smooth", False), dip)


ILL, WELL, LIFELESS = Toy(0.5), Toy(1.5), Toy(0.5, 0.0)
NEVER = lost(math.inf)
NEAR_10 = "what grows from round-off is as large as u near t = 10"
HIDES = "The equations are ill posed where u < 0, for |x| < 1.05, but on n = 100 points"


@pytest.mark.parametrize(
    ("toy", "forecasts", "growth", "kind", "reason"),
    [
        (ILL, [NEVER], -0.0, Kind.HIDDEN, f"{HIDES} nothing grows on the steady state."),
        (ILL, [NEVER], 0.123456, Kind.HIDDEN,
         f"{HIDES} perturbations grow only by e^(0.123 t), so slowly that each step of theirs is lost in the last "
         "bit."),
        (ILL, [lost(12.3456)], 0.5, Kind.HIDDEN,
         f"{HIDES} perturbations grow only by e^(0.5 t): what grows from round-off is as large as u near t = 12.3, "
         "after the end."),
        (ILL, [lost(12.0), NEVER], 0.5, Kind.SCHEME,
         "The step dt = 0.01 is too large for n = 100, and what grows from round-off is as large as u near t = 12; "
         "a smaller one lives to the end."),
        (ILL, [lost(10.0), lost(10.9)], 0.5, Kind.ILL_POSED,
         f"Where u < 0, for |x| < 1.05, the equations are ill posed, n = 100 points see it, and {NEAR_10}; no smaller "
         "dt helps."),
        (ILL, [lost(10.0), lost(15.0)], 0.5, Kind.ILL_POSED,
         f"Where u < 0, for |x| < 1.05, the equations are ill posed, n = 100 points see it, and {NEAR_10}; a smaller "
         "dt only puts it off, to about t = 15."),
        (ILL, [lost(10.0), lost(15.01)], 0.5, Kind.SCHEME,
         f"The step dt = 0.01 is too large for n = 100, and {NEAR_10}; a smaller one lives to the end."),
        (WELL, [NEVER], 0.5, Kind.TRANSIENT, "The steady state is well posed, but u dips below zero at t = 0.7; "
         "it recovers before anything on n = 100 points has grown enough."),
        (WELL, [lost(10.0, None), lost(11.0, 0.87654)], 0.5, Kind.TRANSIENT,
         "The steady state is well posed, but u dips below zero at t = 0.877, n = 100 points see that it is ill posed "
         f"there, and {NEAR_10}."),
        (Toy(1.0), [NEVER], 0.5, Kind.TRANSIENT, "The steady state is well posed, but u dips below zero at t = 0.7; "
         "it recovers before anything on n = 100 points has grown enough."),
        (WELL, [lost(math.inf, None)], -0.5, Kind.CONVERGES,
         "The equations are well posed, as u stays positive, and nothing on n = 100 points grows to matter."),
        (LIFELESS, [NEVER], -0.5, Kind.CONVERGES, "The equations are well posed, as the equations have no second "
         "derivative, and nothing on n = 100 points grows to matter."),
        (WELL, [lost(10.0, None), lost(11.0, None)], 0.5, Kind.ILL_POSED,
         f"Where u < 0 the equations are ill posed, n = 100 points see it, and {NEAR_10}; no smaller dt helps."),
    ],
)  # fmt: skip
def test_the_kind_and_the_reason_follow_from_the_forecasts(foreseen, toy, forecasts, growth, kind, reason):
    found, _ = foreseen(toy, *forecasts, growth=growth)
    assert (found.kind, found.reason) == (kind, reason)
    assert found.growth == pytest.approx(growth)
    t = found.t_blow_up
    assert t == forecasts[0].t_blow_up
    assert found.blow_up == ((0.87 * t, 1.26 * t) if t <= 12 else None)


@pytest.mark.parametrize(
    ("origin", "source"), [("seeded", "the seed"), ("smooth", "the smooth solution itself"), ("", "round-off")]
)
def test_the_reason_names_what_it_grows_from(foreseen, origin, source):
    found, _ = foreseen(ILL, *2 * [lost(10.0, **{origin: True})])
    assert f"what grows from {source} is as large" in found.reason
    assert found.seeded == (origin == "seeded")
    late, _ = foreseen(ILL, lost(20.0, seeded=True))
    assert late.seeded is False  # there is no blow-up that grows from it


@pytest.mark.parametrize(("t_end", "until"), [(12.0, 15.0), (40.0, 40.0)])
def test_a_smaller_step_is_given_half_as_long_again(foreseen, t_end, until):
    """And marched without the last bit; where the step is small already the one forecast says all."""
    small = 0.05 * min((math.pi / 100) ** 2, stable_dt(WELL, 100, 2.7))
    _, asked = foreseen(WELL, *2 * [lost(10.0)], t_end=t_end)
    (n, dt, end, seed, epsilon, more), (_, second, later, _, _, gentle) = asked
    assert (n, dt, end, seed, epsilon, more) == (100, 0.01, t_end, None, 2.0**-52, {})
    assert (second, later, gentle) == (pytest.approx(small), until, {"locks": False})
    _, asked = foreseen(WELL, lost(10.0), dt=0.9 * small)
    assert len(asked) == 1


def test_the_forecast_is_asked_in_the_arithmetic_of_the_run_and_in_whole_steps(foreseen):
    for options, epsilon in (({"dtype": np.float32}, 2.0**-23), ({"digits": 400}, 1e-300)):
        _, asked = foreseen(WELL, lost(math.inf), **options)
        assert asked[0][4] == epsilon
    _, asked = foreseen(WELL, lost(math.inf), dt=0.7, t_end=2.0, seed=1e-6)
    assert asked[0][2] == 3 * 0.7
    assert asked[0][3] == Seed(49, 1e-6)
    foreseen(WELL, lost(math.inf), n=5000)
    with pytest.raises(ValueError, match=r"^n must be an integer <= 5000 for a diagnosis, got 5001$"):
        foreseen(WELL, lost(math.inf), n=5001)


def test_a_run_without_time_is_foreseen_too():
    assert diagnose(Toy(0.5), t_end=0).blow_up is None


@pytest.mark.parametrize("n", [4, 5, 16, 31])
@pytest.mark.parametrize("even_u", [1, -1])
def test_half_grids_are_the_full_one(n, even_u):
    """Symmetric parts, differences and solves against the dense Jacobian about a symmetric state."""
    grid, toy = Grid(n), Toy(0.3, 0.2)
    u = 0.3 - 1.1 * np.cos(grid.x) + 0.2 * np.cos(2 * grid.x)
    v = 0.4 * np.sin(grid.x)
    J = jacobian(toy, n, (u, v))
    half = Half(n, grid.h, even_u)
    f = half.part(np.random.default_rng(n).normal(size=(3, 2, n)))
    full = half.full(f)
    np.testing.assert_array_equal(half.part(full), f)
    frozen = u[: n // 2 + 1], grid.derivative(v, 2)[: n // 2 + 1]
    rates = (full.reshape(3, -1) @ J.T).reshape(3, 2, n)
    np.testing.assert_allclose(half.full(half.rate(toy.eps, *frozen, f)), rates, atol=1e-11)
    solved = half.factored(toy.eps, *frozen, 0.05)(f)
    np.testing.assert_allclose(solved - 0.05 * half.rate(toy.eps, *frozen, solved), f, atol=1e-12)


@pytest.mark.parametrize("m", [1, 2, 7, 1000])
def test_a_stride_is_m_steps_and_keeps_their_stability(m):
    """(1 + z/m)^m to second order, and |R| <= 1 where |1 + z/m| <= 1, for the step of leap's docstring."""
    theta = (m - 1) / (2 * m)

    def stride(z):
        return (1 + (1 - theta) * z) / (1 - theta * z)

    z = 1e-3 * np.exp(1j * np.linspace(0, 6, 13))
    np.testing.assert_allclose(stride(z), (1 + z / m) ** m, atol=2e-10)
    z = m * (np.random.default_rng(m).normal(size=(2000, 2)) @ [1.5, 1.5j] - 1)
    assert 100 < np.sum(np.abs(1 + z / m) < 1) < 1900
    np.testing.assert_array_equal(np.abs(stride(z)) < 1, np.abs(1 + z / m) < 1)


@pytest.mark.parametrize(
    ("arguments", "error", "sentence"),
    [
        ((3,), TypeError, "problem must be a PDE, a Toy, a BackwardHeat or an object with their methods, got 3"),
        ((Toy(1), 3), ValueError, "n must be an integer >= 4, got 3"),
        ((Toy(1), 100, 0), ValueError, "dt must be a finite number > 0, got 0"),
        ((Toy(1), 100, 1e-3, 1.0, (3, 1e-6, "w")), ValueError, "seed field must be one of u, v, got 'w'"),
        ((Toy(1), 100, 1e-3, 1.0, (51, 1e-6)), ValueError, "seed mode must be an integer <= 50, got 51"),
        ((Toy(1), 100, 1e-3, 1.0, "x"), TypeError, "seed must be a Seed"),
    ],
)
def test_bad_input_gets_one_sentence(arguments, error, sentence):
    with pytest.raises(error) as caught:
        diagnose(*arguments)
    assert str(caught.value).startswith(sentence)


def test_discrete_steady_state_is_where_the_smooth_solution_comes_to_rest():
    """A converged run stands on it; what diagnose takes to be still is."""
    run = ftcs(Toy(1.5), 60, 1e-3, 60.0)
    np.testing.assert_allclose(run.final, discrete_steady(Toy(1.5), run.x, Grid(60).h), atol=1e-12)


def test_the_fastest_mode_need_not_be_the_one_that_the_seed_holds():
    """A packet near k = N/4 grows at 0.323, and the seed, near the sawtooth, holds another that grows at 0.305."""
    case = (Toy(0.5), 72, 4.5e-3, 60.0, Seed(35, 1e-5))
    earliest, latest = diagnose(*case).blow_up
    assert earliest < ftcs(*case[:-1], seed=case[-1]).t_stop < latest
    assert fastest(Toy(0.5), 72, 4.5e-3).lam.imag > 1
    assert any(mode.lam.imag < 1 for mode in growing(Toy(0.5), 72, 4.5e-3))


def test_a_step_far_too_large_is_to_blame_in_single_precision_too():
    """With a fiftieth of the step the run lives twenty times as long: the scheme's fault, though u < 0 as well."""
    toy, scene = Toy(0.486, 1.6887), {"n": 197, "dtype": np.float32}
    found, run = diagnose(toy, dt=0.005755, t_end=50, **scene), ftcs(toy, dt=0.005755, t_end=50, **scene)
    assert found.kind is Kind.SCHEME
    assert found.blow_up[0] <= run.t_stop <= found.blow_up[1] < 0.1
    assert ftcs(toy, dt=2e-5, t_end=50, **scene).t_stop > 10 * run.t_stop


@pytest.mark.parametrize(
    ("toy", "n", "digits", "t_end"),
    [
        (Toy(-0.5, 0.05), 40, 80, 20.0),
        pytest.param(Toy(0.5), 200, 150, 100.0, marks=pytest.mark.slow),
        pytest.param(Toy(0.5), 100, 126, 100.0, marks=pytest.mark.slow),
    ],
)
def test_with_digits_enough_the_smooth_solution_itself_is_lost_and_that_is_foreseen(toy, n, digits, t_end):
    """The table of tests/test_exact.py: 13.0 on 200 points, 92.4 on 100; and a quicker scene."""
    found = diagnose(toy, n, 1e-3, t_end, digits=digits)
    true = {200: 12.985, 100: 92.388}.get(n) or exact_march(toy, n, 1e-3, t_end, digits).t_stop
    assert found.kind is Kind.ILL_POSED
    assert found.blow_up[0] <= true <= found.blow_up[1]
    assert "the smooth solution itself" in found.reason


@pytest.mark.parametrize("toy", [Toy(0.5), Toy(1.5, 0.05), Toy(0.5, 0.0), Toy(-0.4, 0.003)])
@pytest.mark.parametrize("n", [17, 40])
def test_growths_and_the_fastest_wave_are_those_of_the_jacobian(toy, n):
    """About the steady state of the grid, by a dense matrix in x."""
    found = diagnose(toy, n, 1e-3, 1.0)
    for m, growth in zip((n, 2 * n, 4 * n), found.growths, strict=True):
        lam = np.linalg.eigvals(jacobian(toy, m))
        assert growth == pytest.approx(max(lam.real.max(), 0.0), rel=1e-6, abs=1e-9)
    lam, vectors = np.linalg.eig(jacobian(toy, n))
    rates = np.where(np.abs(lam) < 1e-6, -np.inf, np.log(np.abs(1 + 1e-3 * lam)))  # but those that are exactly neutral
    fast = np.flatnonzero(rates > rates.max() - 1e-9)  # a pair, or equally fast ones
    waves = [np.abs(np.fft.fft(vectors[n:, i]))[1 : n // 2 + 1] for i in fast]
    assert any(found.wavelength == pytest.approx(2 * np.pi / (1 + np.argmax(each))) for each in waves)


def test_the_amplification_of_each_wave_is_the_worst_of_all_u_on_the_grid():
    for toy, n, dt in ((Toy(0.5), 40, 1e-2), (Toy(1.5, 0.1), 60, 2e-2), (Toy(-0.3, 0.02), 30, 1e-3)):
        found = diagnose(toy, n, dt, 1.0).amplification
        h, (u, _) = Grid(n).h, discrete_steady(toy, Grid(n).x, Grid(n).h)
        for k, factor in enumerate(found):
            s, k2 = math.sin(k * h) / h, (2 * math.sin(k * h / 2) / h) ** 2
            roots = [np.roots([1, 1 + toy.eps * each * k2, s * s]) for each in u]
            assert factor == pytest.approx(np.abs(1 + dt * np.array(roots)).max(), rel=1e-9)


@pytest.mark.parametrize(("toy", "n", "eps"), [(1.5, 100, 0.01), (0.5, 60, 0.01), (1.3, 150, 0.05)])
def test_a_run_that_has_come_to_rest_where_nothing_grows_is_not_made_to_its_end(toy, n, eps):
    found, run = diagnose(Toy(toy, eps), n, 1e-3, 400.0), ftcs(Toy(toy, eps), n, 1e-3, 400.0)
    assert "as running it shows to t = 32: at rest there, and nothing grows" in found.reason
    assert found.blow_up is None
    assert run.stop is Stop.REACHED_END
    assert found.growth <= 0


def test_one_that_is_not_at_rest_is_made_to_its_end():
    """Slowly damped, eps u = 150: the distance falls like e^(-t/150)."""
    found = diagnose(Toy(1.5, 100.0), 20, 1e-4, 60.0)
    assert "as running it shows, which is cheaper" in found.reason
