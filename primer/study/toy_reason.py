"""The sentence that a diagnosis of the toy system gives as its reason."""

import math

from primer.study.kinds import Kind

_PUT_OFF = 1.1  # times as late: less is none


def said_of(kind, toy, n, dt, t_end, found, gentle, t_dip, growth, where, small=None):
    """The reason of a diagnosis: ``found`` and ``gentle`` are what becomes of the run and of one with a small step.

    ``t_dip`` is the first time with u <= 0, ``growth`` that of the steady state with this step, ``where`` the place
    where the equations are ill posed, and ``small`` the small step, if both were run.
    """
    source = "the seed" if found.seeded else "the smooth solution itself" if found.smooth else "round-off"
    digits = 3 if small is None else 2  # of a run: the last bit decides the third
    when = f"what grows from {source} is as large as u near t = {found.t_blow_up:.{digits}g}"
    if kind is Kind.SCHEME:
        lives = "a smaller one lives to the end" if small is None else f"dt = {small:.2g} lives twice as long or longer"
        if gentle.t_blow_up <= t_end:
            lives = f"a smaller one lives to about t = {gentle.t_blow_up:.3g}"
            lives += (
                ", and is lost to the equations, ill posed where u < 0" if gentle.t_first_negative is not None else ""
            )
        return f"The step dt = {dt:g} is too large for n = {n}, and {when}; {lives}."
    if kind is Kind.ILL_POSED:
        helps = "no smaller dt helps"
        if gentle.t_blow_up > _PUT_OFF * found.t_blow_up:
            helps = f"a smaller dt only puts it off, to about t = {gentle.t_blow_up:.{digits}g}"
        return (
            f"{where[0].upper()}{where[1:]}{',' * (',' in where)} the equations are ill posed, n = {n} points see it, "
            f"and {when}; {helps}."
        )
    if kind is Kind.HIDDEN:
        if growth <= 0:
            return f"The equations are ill posed {where}, but on n = {n} points nothing grows on the steady state."
        if small is not None:
            return (
                f"The equations are ill posed {where}, but on n = {n} points perturbations grow only by "
                f"e^({growth:.3g} t): nothing comes of it by the end, t = {t_end:g}."
            )
        if found.t_blow_up < math.inf:
            return (
                f"The equations are ill posed {where}, but on n = {n} points perturbations grow only by "
                f"e^({growth:.3g} t): {when}, after the end."
            )
        return (
            f"The equations are ill posed {where}, but on n = {n} points perturbations grow only by "
            f"e^({growth:.3g} t), so slowly that each step of theirs is lost in the last bit."
        )
    if kind is Kind.TRANSIENT:
        first = f"The steady state is well posed, but u dips below zero at t = {t_dip:.3g}"
        if found.t_blow_up <= t_end:
            return f"{first}, n = {n} points see that it is ill posed there, and {when}."
        return f"{first}; it recovers before anything on n = {n} points has grown enough."
    why = "the equations have no second derivative" if toy.eps == 0 else "u stays positive"
    return f"The equations are well posed, as {why}, and nothing on n = {n} points grows to matter."
