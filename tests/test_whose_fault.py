"""Guards the four computations of notebook 04: each is of its kind, and the stranger's mistake is the one it has."""

import numpy as np
import pytest

from primer import examine
from primer.scenes.whose_fault import SUSPECTS, stranger, strangers_state
from primer.view import PDEExplorer


@pytest.mark.parametrize(
    ("name", "kind"),
    [("a mixture that separates", "scheme"), ("two layers of water", "ill-posed"), ("a flame front", "unstable")],
)
def test_each_is_of_its_kind(name, kind):
    assert SUSPECTS[name].diagnose().kind == kind


def test_the_stranger_has_a_sign_wrong():
    """Growth 0.01 (4/h^2) of the sawtooth, to second order in n; with the sign mended nothing grows."""
    found = examine(stranger, strangers_state, dt=1e-4)
    assert found.kind == "ill-posed"
    assert found.exponent == pytest.approx(2, abs=0.01)
    np.testing.assert_allclose(found.growth, [0.01 * (n / np.pi) ** 2 for n in found.n], rtol=1e-2)

    def mended(u, dt):
        plus, minus = np.roll(u, 1, axis=-1), np.roll(u, -1, axis=-1)
        h = 2 * np.pi / u.shape[-1]
        return u - dt * ((minus - plus) / (2 * h) - 0.01 * (plus - 2 * u + minus) / h**2)

    assert examine(mended, strangers_state, dt=1e-4).kind == "stable"


def test_the_explorer_has_a_preset_for_each_with_its_equation_and_data():
    presets = {name: state for name, state in PDEExplorer.presets.items() if name.startswith("whose fault")}
    assert len(presets) == len(SUSPECTS) + 1
    for suspect, state in zip(SUSPECTS.values(), presets.values(), strict=False):
        assert f"pde={suspect.problem.text},at=" in state
        for field, data in suspect.problem.start:
            assert f"{field} = {data}" in state
    assert "pde=u_t = -u_x - 0.01*u_xx," in presets["whose fault: the stranger"]  # the wrong sign and all
