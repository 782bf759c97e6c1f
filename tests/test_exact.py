"""Guards the scheme without round-off: against many digits on the whole grid, and the times at which it is lost."""

import math

import numpy as np
import pytest

import primer.study.exact as module
from primer import Toy, exact_march, ftcs
from primer.arithmetic import arithmetic
from primer.problems.toy import tendency
from primer.schemes.run import Stop

# N, digits, a second number of digits, and the time at which Dist passes 1: by this module, and on 400 points, to the
# same step, by ``ftcs`` in 250 digits on the whole grid, which takes a quarter of an hour.
TABLE = ((100, 126, 180, 92.388), (150, 140, 200, 24.691), (200, 150, 220, 12.985), (300, 180, 250, 7.112),
         (400, 250, 331, 4.967), (600, 280, 331, 3.539))  # fmt: skip


@pytest.mark.parametrize("n", [7, 24, 25])
@pytest.mark.parametrize(("a", "eps", "dt"), [(0.5, 0.01, 1e-3), (-1, 0.2, 7e-3), (0.3, 0.0, 1e-2), (40.0, 1e-7, 1e-2)])
def test_it_is_the_scheme_in_many_digits(n, a, eps, dt):
    ours = exact_march(Toy(a, eps), n, dt, 60 * dt, digits=40, record_every=7)
    many = ftcs(Toy(a, eps), n, dt, 60 * dt, digits=40, record_every=7)
    for mine, theirs in zip((*ours.final, ours.dist, ours.u_min), (*many.final, many.dist, many.u_min), strict=True):
        np.testing.assert_allclose(mine, theirs.astype(float), rtol=1e-14, atol=1e-15 * (1 + abs(a)))
    assert (ours.t.tolist(), ours.t_first_negative) == (many.t.tolist(), many.t_first_negative)
    np.testing.assert_array_equal(ours.x, many.x)


def test_its_last_digits_are_those_of_the_one_text_of_the_equation():
    """One step in 60 digits from the text of eq. (toy-pde), differences by hand, to 39 of 40 digits."""
    n, dt, toy = 10, 0.01, Toy(0.5, 0.03)
    exact = arithmetic(digits=60)
    h, x = exact.grid(n)
    u, v = (exact.array(f) for f in toy.initial(x))
    for _ in range(3):
        ahead, behind = np.roll((u, v), -1, axis=1), np.roll((u, v), 1, axis=1)
        u_x, v_x = (ahead - behind) / (2 * h)
        u_t, v_t = tendency(u, v, u_x, v_x, (ahead[1] - 2 * v + behind[1]) / h**2, toy.forcing(x), toy.eps)
        u, v = u + dt * u_t, v + dt * v_t
    asked = module.plan(n, dt, 3 * dt, None, (), None, 1e3, np.float64, None)
    numbers = module._Numbers(toy, asked, 40)
    numbers.advance(3, toy.steady(asked.grid.x)[0][:6], 1e6)
    c, s = dt / (2 * h), exact.number(toy.eps) * dt / h**2
    one = exact.number(2) ** numbers.bits
    assert max(abs(exact.number(int(z)) / one / s - w) for z, w in zip(numbers.U, u[:6], strict=True)) < 1e-39
    assert max(abs(exact.number(int(z)) / one / (s * c) - w) for z, w in zip(numbers.V, v[:6], strict=True)) < 1e-39


def lost(n, digits, t_end):
    """The time at which Dist passes 1: it begins at 1."""
    return exact_march(Toy(0.5), n, 1e-3, t_end, digits, blow_up_at=1.01)


def test_without_round_off_it_blows_up_too():
    """On 300 points at 7.1, whatever the digits, if they are enough."""
    runs = [lost(300, digits, 9.0) for digits in (180, 230)]
    assert [run.stop for run in runs] == 2 * [Stop.BLEW_UP]
    assert runs[0].t_stop == runs[1].t_stop == pytest.approx(7.11, abs=0.1)
    few = lost(300, 30, 9.0)  # here round-off is to blame
    assert 2.5 < few.t_stop < 6.5


@pytest.mark.slow
@pytest.mark.parametrize(("n", "digits", "more", "t"), TABLE)
def test_the_table_of_exact_blow_ups(n, digits, more, t):
    first, second = lost(n, digits, 1.2 * t), lost(n, more, 1.2 * t)
    assert first.t_stop == second.t_stop
    assert first.t_stop == pytest.approx(t, abs=0.002)


def test_the_finer_the_grid_the_sooner():
    times = [t for _, _, _, t in TABLE]
    assert times == sorted(times, reverse=True)
    assert all(t > 0.83 for t in times)  # the first u = 0


def test_the_fields_are_mirror_images_of_themselves():
    for n in (24, 25):
        u, v = exact_march(Toy(0.2, 0.05), n, t_end=2.0, digits=30).final
        j = -np.arange(n) % n
        np.testing.assert_array_equal(u, u[j])
        np.testing.assert_array_equal(v, -v[j])


def test_the_digits_chosen_are_enough():
    toy = Toy(-0.5, 0.05)
    chosen = exact_march(toy, 40, t_end=20.0)
    for digits in (128, 200):
        again = exact_march(toy, 40, t_end=20.0, digits=digits)
        assert chosen.t_stop == again.t_stop < 20
        assert chosen.stop is again.stop is Stop.BLEW_UP


def test_round_off_grows_no_faster_than_the_bound_by_which_digits_are_chosen(monkeypatch):
    """The difference of runs in 20 and in 60 digits stays below 1e-20 times what the rates add up to."""
    rates = []
    true_rate = module._rate
    monkeypatch.setattr(module, "_rate", lambda *of: rates.append(true_rate(*of)) or rates[-1])
    settings = {"n": 64, "dt": 1e-3, "t_end": 3.0, "record_every": 100, "blow_up_at": 1e6}
    few, many = (exact_march(Toy(-1.0, 0.02), digits=digits, **settings) for digits in (20, 60))
    apart = max(np.abs(f - g).max() for f, g in zip(few.final, many.final, strict=True))
    last = rates[len(rates) // 2 :]  # those of the second run, every 0.1
    growth = 0.1 * sum(map(max, zip(last[1:], last[:-1], strict=True)))
    assert few.stop is many.stop is Stop.REACHED_END
    assert 1e-14 < apart < 1e-18 * math.exp(growth)


def test_where_nothing_grows_it_comes_to_rest_on_the_floor():
    h = 2 * math.pi / 30
    run = exact_march(Toy(0.5), 30, 5e-3, 60.0)
    assert run.stop is Stop.REACHED_END
    assert run.dist[-1] == pytest.approx(h / math.sin(h) - 1, rel=1e-9)


def test_bad_input_gets_one_sentence(monkeypatch):
    for arguments, error, words in (
        ((3,), TypeError, "toy must be a Toy"),
        ((Toy(0.5), 100, 1e-3, 1.0, 1901), ValueError, "digits must be an integer .*1900"),
        ((Toy(0.5), 100, 1e-3, 1.0, 1), ValueError, "digits must be"),
        ((Toy(0.5), 100, 1e-3, 1.0, 30, None, 0), ValueError, "blow_up_at must be"),
        ((Toy(0.5), 3), ValueError, "n must be"),
    ):
        with pytest.raises(error, match=words):
            exact_march(*arguments)
    monkeypatch.setattr(module, "MOST_DIGITS", 64)
    with pytest.raises(
        ValueError, match=r"must be such that 64 digits are enough, got n = 200 and 20000 steps of 0\.001"
    ):
        exact_march(Toy(0.5), 200, t_end=20.0)
