"""Exercises of notebook 07 on the paper's proofs: Table 1, Lemma 2 and Lemma 3."""

from primer.exercises.answers import Feedback, check, variant


def _slopes(name, seed):
    return variant(
        name,
        seed,
        p=(0.2, 0.25, 0.4),
        I=(0.1, 0.3, 0.2),
        f=(0.15, -0.21, 0.25),
        p_slope=(0.3, 0.45, 0.2),
        I_slope=(0.4, 0.6, 0.5),
    )


def ask_07_5(seed: int = 0) -> str:
    """The question: an entry of the linearised momentum balance."""
    g = _slopes("07_5", seed)
    return (
        f"At a base state p = {g['p']}, I = {g['I']}, and the yield stress Y(p, phi, I) has the slopes Y_p = "
        f"{g['p_slope']} and Y_I = {g['I_slope'] * g['p']:g} there. psi = 0. By Table 1, what stands before the "
        "derivative of p along the first axis in the linearised momentum balance along that axis?"
    )


def check_07_5(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is 1 + B of (21a), with B = Y_p - I/(2p) Y_I, to 2 in a thousand; a ``Feedback``."""
    g = _slopes("07_5", seed)
    feels = g["I"] / 2 * g["I_slope"]
    B = g["p_slope"] - feels
    return check(
        answer,
        1 + B,
        "the stress feels the pressure three times: by itself, through Y, and through I.",
        {
            "that is B: the pressure itself, p in (12a), has a gradient as well.": B,
            "I = 2 d ||D||/sqrt(p/rho) falls as p rises: the row of I in Table 1 has a term in p.": 1 + g["p_slope"],
            "I falls as p rises: look at the sign.": 1 + g["p_slope"] + feels,
            "dI/dp = -I/(2p): where is the factor 1/2?": 1 + g["p_slope"] - 2 * feels,
            "that is 1 - B, of the second axis, eq. (21b).": 1 - B,
        },
        "linearise p + Y cos(2 psi) at psi = 0, where I depends on p too: dI/dp = -I/(2p).",
        rtol=0.002,
    )


def ask_07_6(seed: int = 0) -> str:
    """The question: an entry of the linearised flow rule."""
    g = _slopes("07_6", seed)
    return (
        f"At a base state I = {g['I']}, f = {g['f']}, and f(p, phi, I) has the slope f_I = {g['I_slope']}. By Table 1, "
        "what stands before the derivative of the first velocity along the first axis in the linearised flow rule?"
    )


def check_07_6(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is 1 + C of (21d), with C = f + I f_I, to 2 in a thousand; a ``Feedback``."""
    g = _slopes("07_6", seed)
    C = g["f"] + g["I"] * g["I_slope"]
    return check(
        answer,
        1 + C,
        "||D|| falls when the first axis is stretched, so f ||D|| on the right comes over with a plus.",
        {
            "that is C: div u itself has this derivative too.": C,
            "f depends on I, and I on ||D||: the last row of Table 1 has two lines.": 1 + g["f"],
            "the linearisation of ||D|| is minus D_11: look at the sign.": 1 - C,
            "f ||D|| is a product: its own f times the change of ||D|| is missing.": 1 + g["I"] * g["I_slope"],
            "the right-hand side is 2 f ||D||, and D_11 has a half: they cancel.": (1 + 2 * C, 1 + C / 2),
        },
        "linearise div u - 2 f ||D|| with the last two rows of Table 1, and D_11 = (d_1 u_1 - d_2 u_2)/2.",
        rtol=0.002,
    )


def _lemma_2(seed):
    return variant("07_7", seed, of=("beta", "alpha"), m=(0.7, 1.4, 0.35, 2.1, 2.8))


def ask_07_7(seed: int = 0) -> str:
    """The question: the constant in the proof of Lemma 2."""
    g = _lemma_2(seed)
    return (
        f"At some I a friction law has the slope mu'(I) = {g['m']}, and mu'' < 0 at all smaller I. What is the largest "
        f"number that the proof of Lemma 2 shows {g['of']}'(I) to exceed?"
    )


def check_07_7(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is 2/7 mu' for beta', or 8/7 mu' for alpha', to 2 in a thousand; a ``Feedback``."""
    g = _lemma_2(seed)
    m, beta, alpha = g["m"], g["m"] * 2 / 7, g["m"] * 8 / 7
    slips = {"the integral of s^(2/5) from 0 to 1 is 5/7.": (m * (24 / 25 - 2 / 5), m * (4 / 5 + 12 / 25))}
    if g["of"] == "beta":
        truth = beta
        slips |= {
            "that is the integral's part: -2/5 mu' comes to it.": m * 24 / 35,
            "that is the constant of alpha'.": alpha,
            "look at the sign of the first term, -2/5 mu'.": m * (24 / 35 + 2 / 5),
        }
    else:
        truth = alpha
        slips |= {
            "that is the first term alone.": m * 4 / 5,
            "that is the integral's part: 4/5 mu' comes to it.": m * 12 / 35,
            "that is the constant of beta'.": beta,
        }
    praise = "both constants are positive: 8/7 gives (a), and 2/7 makes (b) certain. They are attained as I -> 0."
    hint = f"write {g['of']}' as an integral of s^(2/5) mu'(sI) over s from 0 to 1, and use mu'(sI) > mu'(I)."
    return check(answer, truth, praise, slips, hint, rtol=0.002)


def _lemma_3(seed):
    return variant("07_8", seed, p=(0.2, 0.31, 0.47), alpha=(0.8, 0.9, 1.0), part=(0.6, 0.5, 0.7, 0.55))


def ask_07_8(seed: int = 0) -> str:
    """The question: the expansion in Lemma 3."""
    g = _lemma_3(seed)
    tau = round(g["alpha"] * g["p"] * g["part"], 6)
    return (
        f"In CIDR with C = z/(1 - z) and phi = phi_0 + eps z, a flow has p = {g['p']}, alpha(I) = {g['alpha']} and "
        f"||tau|| = {tau:g}. What is the limit of (phi - phi_0)/eps as eps -> 0 with these held?"
    )


def check_07_8(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is the Phi of (phi-of-tau-expn), eq. (35), to 2 in a thousand; a ``Feedback``."""
    g = _lemma_3(seed)
    p, alpha = g["p"], g["alpha"]
    tau = round(alpha * p * g["part"], 6)
    C = p * p / (alpha * p - tau)
    return check(
        answer,
        C / (1 + C),
        "it does not depend on eps, so that phi tends to phi_0: that is how the incompressible law comes back.",
        {
            "that is C(phi), by eq. (phi-of-tau): solve C = z/(1 - z) for z.": C,
            "that is 1 - z.": 1 / (1 + C),
            "z/(1 - z) = C has the inverse C/(1 + C): look at the sign.": C / (1 - C),
            "the yield condition is tau = alpha p - p^2/C: p stands there squared.": p / (alpha * p - tau + p),
            "p^2/C = alpha p - tau: look at the sign of tau.": p * p / (alpha * p + tau + p * p),
        },
        "the yield condition gives C(phi), eq. (phi-of-tau); then solve C = z/(1 - z) for z.",
        rtol=0.002,
    )
