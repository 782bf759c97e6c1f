"""A diagnosis by trial: the run, with companions of smaller steps and finer grids; the linearisation says why."""

import math

import numpy as np

from primer.schemes.jacobian import DENSE, rates
from primer.schemes.limit import NEUTRAL, factor, largest_step
from primer.schemes.marching import grid_of
from primer.study.companions import BELOW, MOST, a_few, alive, finer, march, on_grid, short_waves
from primer.study.kinds import Diagnosis, Kind
from primer.study.waves import of_waves
from primer.study.where import frozen

_EARLIEST, _LATEST = 0.87, 1.26  # of a measured blow-up: what round-off elsewhere, or another order of sums, may change
_PUT_OFF = 1.5  # a blow-up that a smaller step puts off by this factor is the scheme's
_SOONER = 0.9  # and one that comes this much sooner on a finer grid is of the equations
_DENSE = 300  # unknowns up to which eigenvalues are looked at for each of a few states
_FINER, _FLAT, _FINEST = 1.25, 0.02, 10**5  # grids on which a bound of growth is looked for
_APART = 50.0  # growth of a perturbation over the run that is more than a front's becoming steeper
_AMPLIFIED = 10.0  # and that is too much where only the scheme lets it grow
_LITTLE = 1.0  # growth times the time of loss: too little for a loss that grew from small perturbations
_FILLED = 0.01  # a share of short waves in a state that is seen in it
_RISES = 0.2  # the power of n from which on growth is not bounded


def tried(problem, n, dt, t_end, seed, dtype, time):
    """The :class:`Diagnosis` of a run whose data are not uniform."""
    main = march(problem, n, dt, t_end, seed, dtype, time)
    lost = math.isfinite(main.t_lost)
    places = frozen(problem, n, *alive(main))
    growths, ns, own, bad, limit, length, amplification = _linear(problem, n, dt, main, time)
    rises = _rise(growths, ns)
    size = f"{', '.join(f'{g:.3g}' for g in growths)} on n = {', '.join(map(str, ns))}"
    about = {
        "n": n,
        "dt": dt,
        "t_end": t_end,
        "t": main.t_lost,
        "where": places.text + _since(main, places),
        "size": size,
        "growths": growths,
        "limit": limit,
        "bad": bad,
    }
    if lost:
        kind, reason, limit = _of_a_blow_up(problem, main, places, rises, bad, own, about, seed, dtype, time)
    else:
        kind, reason = _of_a_life(problem, main, places, rises, growths, about, seed, dtype, time)
    interval = (_EARLIEST * main.t_lost, _LATEST * main.t_lost) if lost else None
    seeded = bool(lost and seed is not None and _lives_without(problem, main, dtype, time))
    return Diagnosis(
        kind, interval, max(own, bad) if max(own, bad) > 0 else own, reason, seed, seeded, main.t_lost, growths, length,
        limit if kind is Kind.SCHEME else math.nan, places.text, True, amplification,
    )  # fmt: skip


def _since(main, places):
    """From when on, where it is not so from the beginning."""
    ill = places.ill.any(axis=1)
    return f", from about t = {alive(main)[1][np.argmax(ill)]:.2g} on" if ill.any() and not ill[0] else ""


def _linear(problem, n, dt, main, time):
    """(growths, grids, own growth, scheme's growth, limit, wavelength, amplification) about a few states visited."""
    chosen = a_few(main)
    lam = np.concatenate([rates(problem, n, state, t) for state, t in chosen])
    mine = lam.real > NEUTRAL * max(np.abs(lam).max(), 1e-300)
    by_step = np.log(np.maximum(np.abs(factor(time, dt * lam)), 1e-300)) / dt
    own, bad = float(by_step[mine].max(initial=-np.inf)), float(by_step[~mine].max(initial=0.0))
    limit = min(largest_step(rates(problem, n, state, t), time) for state, t in chosen)
    fields = len(problem.fields)
    grids = [n, 2 * n, 4 * n]
    if 4 * n * fields > _DENSE:  # the same law on coarser grids, where eigenvalues are quick
        top = min(n, DENSE // fields)
        grids = [max(top // 4, 8), max(top // 2, 16), top]
    found = []
    for m in grids:
        growth = [rates(problem, m, on_grid(state, m), t).real.max() for state, t in chosen]
        found.append(float(max(growth)))
    own = own if mine.any() else float(by_step.max())
    return tuple(found), grids, own, bad, limit, *of_waves(problem, n, dt, chosen, time)


def _rise(growths, ns):
    if not (growths[-1] > 0 and growths[-1] > 1e-6):
        return False
    if growths[-2] <= 0:
        return growths[-1] > 1.0
    return math.log(growths[-1] / growths[-2]) / math.log(ns[-1] / ns[-2]) >= _RISES


def _of_a_blow_up(problem, main, places, rises, bad, own, about, seed, dtype, time):
    """(kind, reason, the step that cures it) of a run that is lost."""
    n, dt, until = main.n, main.dt, max(about["t_end"], _PUT_OFF * main.t_lost)
    grid = grid_of(problem, n)
    limit = about["limit"]
    small = dt / 4
    if bad > 0 and 0 < limit < dt:
        small = min(small, BELOW * limit)
    if n * until / small > MOST:
        small = max(n * until / MOST, dt / 4)
    gentle = march(problem, n, small, until, seed, dtype, time)
    text = f"the run is lost near t = {main.t_lost:.3g}"
    if gentle.t_lost > _PUT_OFF * main.t_lost:
        cure = f"dt = {small:.3g} lives" + (
            " to the end" if gentle.t_lost > about["t_end"] else f" to t = {gentle.t_lost:.3g}"
        )
        best = limit if 0 < limit < dt else small
        if 0 < limit < dt:
            cure += f", and dt <= {limit:.3g} amplifies nothing that does not grow of itself"
        if limit == 0:
            cure += f"; with {time.name} no step amplifies nothing, only another scheme would"
            best = 0.0
        return Kind.SCHEME, f"The step dt = {dt:g} is too large for n = {n}: {text}, and {cure}.", best
    helps = "no smaller dt helps"
    if gentle.t_lost > 1.1 * main.t_lost:
        helps = f"a smaller dt only puts it off, to t = {gentle.t_lost:.3g}"
    fine = finer(problem, main, 2, small, _PUT_OFF * gentle.t_lost, seed, dtype, time)
    sooner = fine is not None and fine.t_lost < _SOONER * gentle.t_lost
    if places.ill.any() and (rises or sooner):
        return Kind.ILL_POSED, (
            f"The equations are ill posed {about['where']}: growth rises with the grid, {about['size']}, {text}, and "
            f"{helps}."
        ), math.nan  # fmt: skip
    if places.ill.any() and not rises:
        return Kind.UNDECIDED, (
            f"Frozen at a point the equations are ill posed {about['where']}, but on these grids growth does not rise, "
            f"{about['size']}; {text}, whatever the step."
        ), math.nan  # fmt: skip
    if rises:
        return Kind.UNSTABLE, f"{_looks_ill_posed(problem, main, about)}; {text}, and {helps}.", math.nan
    grown = max(about["growths"]) * main.t_lost
    if fine is not None and abs(fine.t_lost / gentle.t_lost - 1) < 0.25 and grown < _LITTLE:
        return Kind.UNDECIDED, (
            f"{text[0].upper()}{text[1:]}, on 2 n points and with a smaller dt near t = {fine.t_lost:.3g} too, though "
            f"on the states before nothing grows that would matter ({about['size']}): a front that no such grid "
            "resolves, or a solution that ends; a much finer grid, or differences against the wind, would tell."
        ), math.nan  # fmt: skip
    if fine is not None and abs(fine.t_lost / gentle.t_lost - 1) < 0.25:
        return Kind.UNSTABLE, (
            f"The equations are well posed at each point, and growth is bounded: {about['size']}; {text}, on 2 n "
            f"points and with a smaller dt near t = {fine.t_lost:.3g} too: the solution's own."
        ), math.nan  # fmt: skip
    other = "would take too long"
    if fine is not None:
        other = f"is lost near t = {fine.t_lost:.3g}" if math.isfinite(fine.t_lost) else "lives to the end"
        other += ": the solution is not resolved"
    return Kind.UNDECIDED, (
        f"{text[0].upper()}{text[1:]}, whatever the step; a grid of {2 * n} points (h = {grid.h / 2:.3g}) {other}."
    ), math.nan  # fmt: skip


def _of_a_life(problem, main, places, rises, growths, about, seed, dtype, time):
    """(kind, reason) of a run that reaches its end."""
    if places.ill.any() and rises and (short := short_waves(main)) > _FILLED:
        return Kind.ILL_POSED, (
            f"The equations are ill posed {about['where']}, growth rises with the grid, {about['size']}, and though "
            f"nothing is lost by t = {about['t_end']:g} the run has filled with waves of two to four spacings, "
            f"{100 * short:.2g} % of all: what it shows depends on its grid, whatever the step."
        )
    if places.ill.any() and (rises or _fails_finer(problem, main, about, seed, dtype, time)):
        if (not places.ill[-1].any() and places.ill[0].any()) or (places.ill.any() and not places.ill[[0, -1]].any()):
            first = main.t[int(np.argmax(places.ill.any(axis=1)))]
            return Kind.TRANSIENT, (
                f"On the way, from t = {first:.3g} on, the equations are ill posed {about['where']}; the run recovers "
                f"before anything on n = {about['n']} points has grown enough."
            )  # fmt: skip
        return Kind.HIDDEN, (
            f"The equations are ill posed {about['where']}, growth on finer grids rises, {about['size']}, but on n = "
            f"{about['n']} nothing comes of it by t = {about['t_end']:g}."
        )
    if places.ill.any():
        return Kind.CONVERGES, (
            f"Frozen at a point the equations are ill posed {about['where']}, but growth does not rise with the grid, "
            f"{about['size']}: freezing lies here, and the run reaches its end."
        )
    if rises and _bound_at(problem, main):
        return Kind.UNSTABLE, f"{_looks_ill_posed(problem, main, about)}; this run reaches its end."
    separates = _separation(problem, main, about["t_end"], seed, dtype, time)
    limit, bad = about["limit"], about["bad"]
    if separates > _AMPLIFIED and bad > 2 * max(growths[-1], 0.0) and bad * about["t_end"] > math.log(_APART):
        cure = f"dt <= {limit:.3g} would do" if 0 < limit < about["dt"] else "another scheme would do"
        return Kind.SCHEME, (
            f"The step dt = {about['dt']:g} is too large for n = {about['n']}: what does not grow of itself is "
            f"amplified like e^({bad:.3g} t), {_times(separates)} by the end, though nothing is lost by then; {cure}."
        )
    if separates > _APART:
        return Kind.UNSTABLE, (
            f"Nothing is ill posed and growth is bounded, {about['size']}, but perturbations have grown "
            f"{_times(separates)} by t = {about['t_end']:g}: the model's own."
        )
    return Kind.CONVERGES, (
        f"Nothing is ill posed, a perturbation is {separates:.2g} times as large at the end, and the run reaches it "
        f"(fastest growth {about['size']})."
    )


def _times(factor):
    return f"{factor:.2g} times" if math.isfinite(factor) else "beyond the fields themselves"


def _looks_ill_posed(problem, main, about):
    at = _bound_at(problem, main)
    text = f"The equations are well posed at each point, but these grids cannot tell: growth rises, {about['size']}"
    if at is None:
        return text
    return text + f", and is bounded, by {at[1]:.3g}, only from about n = {at[0]} on"


def _bound_at(problem, main):
    """(n, growth) from which on growth about the mean state no longer rises with the grid; None if it was not found."""
    state = main.states[0].mean(axis=1)
    n, last = main.n, _largest(problem, main.n, state)
    while n < _FINEST:
        finer = _largest(problem, round(_FINER * n), state)
        if 0 < finer <= (1 + _FLAT) * last:
            return n, finer
        n, last = round(_FINER * n), finer
    return None


def _largest(problem, n, state):
    return float(rates(problem, n, tuple(state)).real.max())


def _fails_finer(problem, main, about, seed, dtype, time):
    """Whether four times as many points, with steps as much smaller as a second derivative needs, are lost."""
    found = finer(problem, main, 4, main.dt / 16, about["t_end"], seed, dtype, time)
    return found is not None and math.isfinite(found.t_lost)


def _lives_without(problem, main, dtype, time):
    return not math.isfinite(march(problem, main.n, main.dt, 1.1 * main.t_lost, None, dtype, time).t_lost)


def _separation(problem, main, t_end, seed, dtype, time):
    """By what a perturbation of all waves has grown at the end of the run."""
    small = 1e-8
    if not hasattr(problem, "replace"):
        return math.nan
    noise = np.random.default_rng(0).standard_normal(main.states[0].shape) * small
    x = grid_of(problem, main.n).x
    fields = np.array(problem.initial(x)) + noise
    other = problem.replace(initial={f: row.tolist() for f, row in zip(problem.fields, fields, strict=True)})
    found = march(other, main.n, main.dt, t_end, seed, dtype, time)
    if math.isfinite(found.t_lost) or len(found.states) != len(main.states):
        return math.inf
    return float(np.abs(found.states[-1] - main.states[-1]).max() / np.abs(noise).max())
