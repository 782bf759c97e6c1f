"""Exercises of notebook 07, the CIDR theorem."""

from primer.exercises.answers import Feedback, check, choose, variant

# Laws at p = 0.2 C, phi = 0.55, I = 0.1 unless said otherwise, and what each fails; ``granular.violations`` has them.
_LAWS = (
    ("normality with rate dependence: Y = 2 mu(I) p - p^2/C(phi) and f = dY/dp", "the equality"),
    ("CIDR", "none"),
    ("CSSM", "(a)"),
    ("Y as in CIDR, and f that of CIDR plus 0.1/I", "(b)"),
    ("constant dilatancy: Y = (mu(I) + 0.05) p - p^2/C(phi) and f = 0.1 - 2 p/C(phi)", "the equality"),
    ("CIDR with the alpha and beta that Lemma 1 makes of a friction that falls with I", "(a)"),
)
_HINTS = {
    "none": "one of them does fail: work out the signs of Y_I and of f_p - I/(2p) f_I, and both sides of the equality.",
    "the equality": "work out Y_p - I/(2p) Y_I and f + I f_I: here they agree.",
    "(a)": "hypothesis (a) is Y_I > 0, and here Y does rise with I.",
    "(b)": "hypothesis (b) is f_p - I/(2p) f_I < 0, and here that is so.",
}


def _first(seed):
    return variant(
        "07_1",
        seed,
        A=(0.5, 0.3, 0.7),
        B=(0.4, 0.2, 0.3),
        Gamma=(2, 4, 5),
        t=(1.5, 2.5, 3.5),
        xi=((1, 2), (1, 3), (3, 2)),
    )


def ask_07_1(seed: int = 0) -> str:
    """The question: the determinant that the theorem turns on."""
    g = _first(seed)
    return (
        f"At a base state A = {g['A']}, B = C = {g['B']}, Gamma = {g['Gamma']} and t = tau/(2 ||D||) = {g['t']}. What "
        f"is det(M + N) at the wavevector with xi_1 = {g['xi'][0]}, xi_2 = {g['xi'][1]}?"
    )


def check_07_1(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is (e41) with (43b) and (42b), this with its factor A, to 2 in a thousand; a ``Feedback``."""
    g = _first(seed)
    A, B, Gamma, t = g["A"], g["B"], g["Gamma"], g["t"]
    p, q = g["xi"][0] ** 2, g["xi"][1] ** 2
    square = t / Gamma * ((1 + B) * p - (1 - B) * q) ** 2
    printed = t * (p + q) ** 2 + 4 / Gamma * p * q
    return check(
        answer,
        square + A * printed,
        "a square that may vanish, and a cross term that cannot as long as A > 0.",
        {
            "that is with (42b) as printed. Which factor do all its terms lack?": square + printed,
            "that is det N alone: det(M + N) has cross terms too, eq. (e41).": square,
            "that is the cross terms alone: add det N, eq. (43b).": A * printed,
            "t is tau/(2 ||D||), so that (43b) begins with t/Gamma, without another half.": square / 2 + A * printed,
        },
        "build M, eq. (e39), and N, eq. (new-formula-N), as matrices of numbers; take the determinant of the sum.",
        rtol=0.002,
    )


def _second(seed):
    return variant("07_2", seed, m=(0.3, 0.2, 0.25, 0.5), q=(0.5, 0.25, 0.75, 0.6))


def ask_07_2(seed: int = 0) -> str:
    """The question: Lemma 1 for a power law."""
    g = _second(seed)
    return (
        f"Let the friction law be mu(I) = 0.4 + {g['m']} I^{g['q']}. By Lemma 1, alpha(I) = 0.8 + a I^{g['q']}. What "
        "is the number a?"
    )


def check_07_2(answer: float, seed: int = 0) -> Feedback:
    """Whether ``answer`` is 4 m (1 + q)/(2 + 5 q), to one per cent; a ``Feedback``.

    From (5/2) I alpha' + alpha = 2 mu + 2 I mu', the equation in the proof of Lemma 1.
    """
    g = _second(seed)
    m, q = g["m"], g["q"]
    a = 4 * m * (1 + q) / (2 + 5 * q)
    return check(
        answer,
        a,
        "a power goes through Lemma 1 as a power; only its coefficient changes.",
        {
            "alpha = 2 mu only where mu does not depend on I.": 2 * m,
            "that is the coefficient in beta.": 2 * (a - m),
            "the right-hand side is 2 mu + 2 I mu': where is the second term?": 4 * m / (2 + 5 * q),
            "the left-hand side is (5/2) I alpha' + alpha: where is the first term?": 2 * m * (1 + q),
        },
        "put alpha = 0.8 + a I^q into (5/2) I alpha' + alpha = 2 mu + 2 I mu' and compare the powers of I.",
    )


def _third(seed):
    return variant("07_3", seed, law=_LAWS)["law"]


def ask_07_3(seed: int = 0) -> str:
    """The question: which hypothesis a law fails."""
    options = ", ".join(repr(option) for option in _HINTS)
    return (
        f"Which hypothesis of the theorem does this law fail at a typical state? {_third(seed)[0]}. Choose: {options}."
    )


def check_07_3(answer: str, seed: int = 0) -> Feedback:
    """Whether ``answer`` names what the law fails of (Cmu-well-posed-cond) and (ineq-for-thm); a ``Feedback``."""
    truth = _third(seed)[1]
    hints = {option: hint for option, hint in _HINTS.items() if option != truth}
    praise = "whether the law is then ill posed is another question: the hypotheses suffice, and not all are needed."
    return choose(answer, truth, praise, hints)
