"""The refusal of a reference: there is no answer to stand behind at that time."""


class PastHorizon(ArithmeticError):
    """There is no answer to stand behind at the time asked for; ``horizon`` is a time at which there is one.

    Where u < 0 eq. (toy-pde) is ill posed, and Hadamard's conditions (A2.1) fail, the first among them: it is not known
    whether there is a solution at all.

    >>> from primer import Toy, reference
    >>> try:
    ...     reference(Toy(0.5), 5.0)
    ... except PastHorizon as refusal:
    ...     print(f"{refusal.horizon:.4f}", reference(Toy(0.5), refusal.horizon).error < 1e-10)
    0.8259 [ True]
    """

    def __init__(self, message: str, horizon: float) -> None:
        super().__init__(message, horizon)
        self.horizon = horizon

    def __str__(self) -> str:
        return self.args[0]
