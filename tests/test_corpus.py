r"""Guards the language and the verdict on equations in the words of their sources, in LaTeX and in plain text.

Second route: for each equation the growth rates at some wavenumbers, from its dispersion relation in closed form, and
the kind of its short waves, all worked out by hand from the equation and not by this package.
"""

# ruff: noqa: E501  # one line an equation
import numpy as np
import pytest

from primer import PDEError, growth_rates, verdict

W, I, U = "well-posed", "ill-posed", "undecided"
sqrt = lambda z: np.sqrt(complex(z))  # noqa: E731

# name: (equations, at and parameters, rates(k) as a list, kind); k is a number, or a pair (k, l)
CORPUS = {
    "heat": (r"\frac{\partial u}{\partial t} = \alpha \frac{\partial^2 u}{\partial x^2}", {"alpha": 2}, lambda k: [-2 * k * k], W),
    "backward heat": ("∂u/∂t = -∂²u/∂x²", {}, lambda k: [k * k], I),
    "advection": (r"\partial_t u + c\,\partial_x u = 0", {"c": 3}, lambda k: [-3j * k], W),
    "advection-diffusion": ("u_t + c u_x = D u_xx", {"c": 1, "D": 0.5}, lambda k: [-1j * k - 0.5 * k * k], W),
    "wave equation": (r"\frac{\partial^2 u}{\partial t^2} = c^2 \frac{\partial^2 u}{\partial x^2}", {"c": 2}, lambda k: [2j * k, -2j * k], W),
    "Laplace, marched": (r"u_{tt} + u_{xx} = 0", {}, lambda k: [k, -k], I),
    "Klein-Gordon": ("u_tt - u_xx + m² u = 0", {"m": 2}, lambda k: [1j * sqrt(k * k + 4), -1j * sqrt(k * k + 4)], W),
    "telegrapher": ("u_tt + 2a u_t = c² u_xx", {"a": 1, "c": 1}, lambda k: [-1 + sqrt(1 - k * k), -1 - sqrt(1 - k * k)], W),
    "sine-Gordon": (r"\phi_{tt} - \phi_{xx} + \sin(\phi) = 0", {"phi": 0}, lambda k: [1j * sqrt(1 + k * k), -1j * sqrt(1 + k * k)], W),
    "Burgers": (r"u_t + u u_x = \nu u_{xx}", {"u": 2, "u_x": 0, "nu": 0.1}, lambda k: [-2j * k - 0.1 * k * k], W),
    "inviscid Burgers": ("∂_t u + ∂_x(u²/2) = 0", {"u": 2, "u_x": 0.5}, lambda k: [-2j * k - 0.5], W),
    "Korteweg-de Vries": (r"\partial_t \phi + \partial_x^3 \phi - 6\,\phi\,\partial_x \phi = 0", {"phi": 1, "phi_x": 0}, lambda k: [1j * k**3 + 6j * k], W),
    "modified KdV": ("u_t + 6u^2 u_x + u_xxx = 0", {"u": 1, "u_x": 0}, lambda k: [1j * k**3 - 6j * k], W),
    "KdV-Burgers": ("u_t + u u_x - ν u_xx + μ u_xxx = 0", {"u": 0, "u_x": 0, "nu": 1, "mu": 2}, lambda k: [-k * k + 2j * k**3], W),
    "BBM": ("u_t + u_x + u u_x - u_xxt = 0", {"u": 0, "u_x": 0}, lambda k: [-1j * k / (1 + k * k)], W),
    "Kuramoto-Sivashinsky": (r"u_t + u_{xx} + u_{xxxx} + \frac{1}{2} u_x^2 = 0", {"u_x": 0}, lambda k: [k**2 - k**4], W),
    "Kawahara": ("u_t + u u_x + u_xxx - u_xxxxx = 0", {"u": 0, "u_x": 0}, lambda k: [1j * k**3 + 1j * k**5], W),
    "Swift-Hohenberg": (r"\frac{\partial u}{\partial t} = r u - \left(1 + \partial_{xx}\right)", {}, None, None),
    "Swift-Hohenberg, expanded": ("u_t = r u - u - 2u_xx - u_xxxx - u^3", {"r": 0.3, "u": 0}, lambda k: [0.3 - (1 - k * k) ** 2], W),
    "Cahn-Hilliard": (r"\frac{\partial c}{\partial t} = D \nabla^2 \left( c^3 - c - \gamma \nabla^2 c \right)", {"c": 0, "D": 2, "gamma": 0.1, "uniform": True}, lambda k: [2 * (k * k - 0.1 * k**4)], W),
    "Cahn-Hilliard without interfaces": ("c_t = lap(c^3 - c)", {"c": 0, "uniform": True}, lambda k: [k * k], I),
    "Allen-Cahn": ("∂u/∂t = ε² ∂²u/∂x² + u - u³", {"eps": 0.5, "u": 1}, lambda k: [-0.25 * k * k - 2], W),
    "Fisher-KPP": (r"\frac{\partial u}{\partial t} - D \frac{\partial^2 u}{\partial x^2} = r u (1-u)", {}, None, None),
    "Fisher-KPP, with a sign": (r"\frac{\partial u}{\partial t} - D \frac{\partial^2 u}{\partial x^2} = r u \cdot (1-u)", {"D": 1, "r": 2, "u": 0}, lambda k: [2 - k * k], W),
    "porous medium": (r"u_t = \Delta(u^m)", {"u": 1, "m": 3, "uniform": True}, lambda k: [-3 * k * k], W),
    "porous medium, backward": (r"u_t = \nabla \cdot (u^{m-1} \nabla u)", {"u": -1, "m": 2, "uniform": True}, lambda k: [k * k], I),
    "Perona-Malik": (r"u_t = \partial_x \left( \frac{u_x}{1 + u_x^2} \right)", {"u_x": 2, "u_xx": 0}, lambda k: [-(1 - 4) / 25 * -1 * -k * k], I),
    "total variation": ("u_t = (u_x/sqrt(ε + u_x²))_x", {"eps": 1, "u_x": 0, "u_xx": 0}, lambda k: [-k * k], W),
    "p-Laplacian": ("u_t = (|u_x|^(p-2) u_x)_x", {"p": 4, "u_x": 2, "u_xx": 0}, lambda k: [-12 * k * k], W),
    "thin film": (r"h_t + \left( h^3 h_{xxx} \right)_x = 0", {"h": 2, "uniform": True}, lambda k: [-8 * k**4], W),
    "thin film, the other sign": ("h_t = (h³ h_xxx)_x", {"h": 2, "uniform": True}, lambda k: [8 * k**4], I),
    "lubrication with gravity": (r"3\mu h_t = \rho g (h^3 h_x)_x", {"h": 1, "mu": 1, "rho": 3, "g": 2, "uniform": True}, lambda k: [-2 * k * k], W),
    "good Boussinesq": ("u_tt = u_xx - u_xxxx + (u²)_xx", {"u": 0, "uniform": True}, lambda k: [1j * sqrt(k**2 + k**4), -1j * sqrt(k**2 + k**4)], W),
    "bad Boussinesq": ("u_tt = u_xx + u_xxxx + (u²)_xx", {"u": 0, "uniform": True}, lambda k: [sqrt(k**4 - k**2), -sqrt(k**4 - k**2)], I),
    "improved Boussinesq": ("u_tt - u_xx - u_xxtt = (u^2)_xx", {"u": 0, "uniform": True}, lambda k: [1j * k / np.sqrt(1 + k * k), -1j * k / np.sqrt(1 + k * k)], W),
    "Schrödinger": (r"i\hbar \frac{\partial \psi}{\partial t} = -\frac{\hbar^2}{2m} \frac{\partial^2 \psi}{\partial x^2} + V \psi", {"hbar": 1, "m": 0.5, "V": 3}, lambda k: [-1j * (k * k + 3)], W),
    "Ginzburg-Landau, real": (r"\partial_t A = \mu A + \partial_{xx} A - A^3", {"A": 0, "mu": 0.5}, lambda k: [0.5 - k * k], W),
    "complex diffusion": ("A_t = (1 + i b) A_xx + A", {"b": 2}, lambda k: [1 - (1 + 2j) * k * k], W),
    "beam": (r"\rho A_0 w_{tt} + E J w_{xxxx} = 0", {"rho": 1, "A_0": 1, "E": 4, "J": 1}, lambda k: [2j * k * k, -2j * k * k], W),
    "damped beam": ("w_tt + w_xxxx = η w_xxt", {"eta": 2}, lambda k: [-k * k, -k * k], W),
    "Cattaneo": (r"\tau T_{tt} + T_t = \kappa T_{xx}", {"tau": 1, "kappa": 1}, lambda k: [(-1 + sqrt(1 - 4 * k * k)) / 2, (-1 - sqrt(1 - 4 * k * k)) / 2], W),
    "pseudo-parabolic": (r"u_t = \Delta u + \beta \Delta u_t", {"beta": 1}, lambda k: [-k * k / (1 + k * k)], W),
    "pseudo-parabolic, bracketed": (r"u_t = \Delta u + \beta \Delta(u_t)", {"beta": 1}, lambda k: [-k * k / (1 + k * k)], W),
    "Camassa-Holm": ("u_t - u_xxt + 3u u_x = 2u_x u_xx + u u_xxx", {"u": 1, "uniform": True}, lambda k: [(-3j * k - 1j * k**3) / (1 + k * k)], W),
    "shallow water": (r"\partial_t h + \partial_x (h u) = 0, \quad \partial_t (h u) + \partial_x \left( h u^2 + \tfrac{1}{2} g h^2 \right) = 0", {"h": 1, "u": 0, "g": 4, "uniform": True}, lambda k: [2j * k, -2j * k], W),
    "p-system": ("v_t - u_x = 0; u_t + p(v)_x = 0", {"v": 2, "v_x": 0, "p": "1/v"}, lambda k: [0.5j * k, -0.5j * k], W),
    "p-system, van der Waals": ("v_t = u_x, u_t = (v - v³)_x", {"v": 0, "v_x": 0}, lambda k: [1j * k, -1j * k], W),
    "p-system, elliptic": ("v_t = u_x, u_t = (v - v³)_x", {"v": 1, "v_x": 0}, lambda k: [np.sqrt(2) * k, -np.sqrt(2) * k], I),
    "isentropic gas": (r"\rho_t + (\rho u)_x = 0; \rho (u_t + u u_x) = -K (\rho^\gamma)_x", {"rho": 1, "u": 0, "K": 2, "gamma": 2, "uniform": True}, None, None),
    "isentropic gas, with a sign": (r"\rho_t + (\rho u)_x = 0; \rho \cdot (u_t + u u_x) + (K \rho^\gamma)_x = 0", {"rho": 1, "u": 0, "K": 2, "gamma": 2, "uniform": True}, lambda k: [2j * k, -2j * k], W),
    "linear acoustics": (r"p_t + K u_x = 0 \\ \rho u_t + p_x = 0", {"K": 4, "rho": 1}, lambda k: [2j * k, -2j * k], W),
    "Maxwell in a line": ("dE/dt = c² dB/dx; dB/dt = dE/dx", {"c": 3}, lambda k: [3j * k, -3j * k], W),
    "Cauchy-Riemann": (r"\partial_t u = \partial_x v, \partial_t v = -\partial_x u", {}, lambda k: [k, -k], I),
    "FitzHugh-Nagumo": ("v_t = v_xx + v - v³/3 - w; w_t = ε (v + a - b w)", {"v": 1, "epsilon": 0, "a": 0.7, "b": 0.8}, lambda k: [-k * k, 0], W),
    "FitzHugh-Nagumo, with a sign": ("v_t = v_xx + v - v³/3 - w; w_t = ε*(v + a - b w)", {"v": 1, "epsilon": 0, "a": 0.7, "b": 0.8}, lambda k: [-k * k, 0], W),
    "Keller-Segel": (r"u_t = D u_{xx} - \chi (u v_x)_x, v_t = v_{xx} - v + u", {"D": 1, "chi": 1, "u": 4, "uniform": True}, lambda k: [-(k * k) - 0.5 + np.sqrt(0.25 + 4 * k * k), -(k * k) - 0.5 - np.sqrt(0.25 + 4 * k * k)], W),
    "cross-diffusion": ("u_t = u_xx + 2v_xx; v_t = 2u_xx + v_xx", {}, lambda k: [-3 * k * k, k * k], I),
    "Gray-Scott": ("u_t = D_u u_xx - u v^2 + F (1 - u); v_t = D_v v_xx + u v^2 - (F + k) v", {"D_u": 2, "D_v": 1, "F": 0.1, "k": 0.2, "u": 1, "v": 0}, lambda k: [-2 * k * k - 0.1, -k * k - 0.3], W),
    "Gray-Scott, with signs": ("u_t = Du*u_xx - u v^2 + F*(1 - u); v_t = Dv*v_xx + u v^2 - (F + k) v", {"Du": 2, "Dv": 1, "F": 0.1, "k": 0.2, "u": 1, "v": 0}, lambda k: [-2 * k * k - 0.1, -k * k - 0.3], W),
    "two-fluid, equal pressures": ("a_t + (a u)_x = 0; u_t + u u_x = -p_x; -a_t + ((1 - a) w)_x = 0; w_t + w w_x = -p_x", {"a": 0.5, "u": 1, "w": -1, "uniform": True}, lambda k: [k, -k], I),
    "pressureless gas": (r"\rho_t + (\rho u)_x = 0, u_t + u u_x = 0", {"rho": 1, "u": 0.25, "uniform": True}, lambda k: [-0.25j * k, -0.25j * k], W),
    "traffic, with a velocity": ("ρ_t + (ρ V(ρ))_x = 0", {"rho": 0.25, "rho_x": 0, "V": "1 - rho"}, lambda k: [-0.5j * k], W),
    "Black-Scholes": (r"\frac{\partial V}{\partial t} + \frac12 \sigma^2 S^2 \frac{\partial^2 V}{\partial S^2} + r S \frac{\partial V}{\partial S} - r V = 0", {"space": "S", "S": 1, "sigma": 2, "r": 0.5}, lambda k: [2 * k * k - 0.5j * k + 0.5], I),
    "Black-Scholes, time to expiry": (r"\frac{\partial V}{\partial \tau} = \frac12 \sigma^2 S^2 \frac{\partial^2 V}{\partial S^2} + r S \frac{\partial V}{\partial S} - r V", {"space": "S", "time": "tau", "S": 1, "sigma": 2, "r": 0.5}, lambda k: [-2 * k * k + 0.5j * k - 0.5], W),
    "Fokker-Planck": (r"\frac{\partial p}{\partial t} = -\frac{\partial}{\partial x}\left[ \mu(x) p \right] + \frac{\partial^2}{\partial x^2}\left[ D p \right]", {"mu": "-x", "x": 0, "D": 2}, lambda k: [1 - 2 * k * k], W),
    "radial diffusion": ("c_t = c_rr + 2/r c_r", {}, None, None),
    "radial diffusion, with a sign": ("c_t = c_rr + 2/r*c_r", {"space": "r", "r": 2}, lambda k: [-k * k + 1j * k], W),
    "lateral heat equation": ("u_xx = u_t", {"space": "t", "time": "x"}, lambda k: [sqrt(1j * k), -sqrt(1j * k)], I),
    "boundary layer in x": (r"c_x = c_{yy}", {"time": "x"}, lambda k: [-k * k], W),
    # two space variables
    "heat in the plane": (r"u_t = \kappa \nabla^2 u + 0 u_y", {"kappa": 2}, lambda k: [-2 * (k[0] ** 2 + k[1] ** 2)], W),
    "anisotropic": (r"u_t = \partial_x^2 u - \partial_y^2 u", {}, lambda k: [k[1] ** 2 - k[0] ** 2], I),
    "Kadomtsev-Petviashvili": (r"\partial_x \left( \partial_t u + 6 u \partial_x u + \partial_x^3 u \right) + 3 \sigma \partial_y^2 u = 0", {"u": 0, "sigma": 1, "uniform": True}, lambda k: [1j * k[0] ** 3 - 3j * k[1] ** 2 / k[0]], W),
    "vorticity": (r"\omega_t + \psi_y \omega_x - \psi_x \omega_y = \nu \Delta \omega, \quad \Delta \psi = -\omega", {"nu": 2, "psi_y": 1, "psi_x": 0, "omega_x": 0, "omega_y": 0}, lambda k: [-1j * k[0] - 2 * (k[0] ** 2 + k[1] ** 2)], W),
    "Stokes": (r"u_t = -p_x + \nu \nabla^2 u; v_t = -p_y + \nu \nabla^2 v; u_x + v_y = 0", {"nu": 2}, lambda k: [-2 * (k[0] ** 2 + k[1] ** 2)], W),
    "Navier-Stokes at rest": (r"\rho (\partial_t u) = -\partial_x p + \mu \Delta u; \rho (\partial_t v) = -\partial_y p + \mu \Delta v; \partial_x u + \partial_y v = 0", {"rho": 2, "mu": 4}, lambda k: [-2 * (k[0] ** 2 + k[1] ** 2)], W),
    "acoustics in the plane": (r"p_t + K\,\mathrm{div}(u, v) = 0; u_t = -p_x; v_t = -p_y", {"K": 4}, lambda k: [2j * np.hypot(*k), -2j * np.hypot(*k), 0], W),
    "rotating shallow water": ("u_t - f v = -g η_x; v_t + f u = -g η_y; η_t + H div(u, v) = 0", {"f": 3, "g": 1, "H": 1}, lambda k: [1j * np.sqrt(9 + k[0] ** 2 + k[1] ** 2), -1j * np.sqrt(9 + k[0] ** 2 + k[1] ** 2), 0], W),
    "Zakharov-Kuznetsov": (r"u_t + u u_x + \partial_x \Delta u = 0", {"u": 1, "u_x": 0, "space": "x, y"}, lambda k: [-1j * k[0] + 1j * k[0] * (k[0] ** 2 + k[1] ** 2)], W),
    "plate": (r"w_{tt} + D \Delta^2 w = 0", {"D": 4, "space": "x, y"}, lambda k: [2j * (k[0] ** 2 + k[1] ** 2), -2j * (k[0] ** 2 + k[1] ** 2)], W),
    "Poisson-Nernst-Planck": (r"c_t = \nabla\cdot(\nabla c + c \nabla \phi), \Delta \phi = c_0 - c", {"c": 2, "c_0": 2, "uniform": True, "space": "x, z"}, lambda k: [-(k[0] ** 2) - k[1] ** 2 - 2], W),
}  # fmt: skip
REFUSED = [name for name, (_, _, rates, _) in CORPUS.items() if rates is None]


def asked(values):
    """Keyword arguments of a call: numbers go into ``at``, for a text does not say what is a parameter."""
    options = {
        name: value for name, value in values.items() if name in ("uniform", "space", "time") or isinstance(value, str)
    }
    return {"at": {name: value for name, value in values.items() if name not in options}, **options}


@pytest.mark.parametrize("name", [name for name in CORPUS if name not in REFUSED])
def test_an_equation_in_the_words_of_its_source(name):
    text, values, rates, kind = CORPUS[name]
    arguments = asked(values)
    found = verdict(text, **arguments)
    assert found.kind == kind, found.reason
    for k in (0.7, 1.9, -3.1):
        try:
            expected, computed = rates(k), growth_rates(text, k, **arguments)
        except (TypeError, ValueError):
            point = np.array([k, 1.3])
            expected, computed = rates(point), growth_rates(text, point, **arguments)
        assert np.sort_complex(np.round(computed, 6)) == pytest.approx(
            np.sort_complex(np.round(np.array(expected, complex), 6)), abs=2e-6
        )


@pytest.mark.parametrize("name", REFUSED)
def test_what_its_source_leaves_to_the_reader_is_asked_for(name):
    """u (1 - u) might be a function of 1 - u, 2/r c_r might be 2/(r c_r), and an operator needs what it works on."""
    text, values, _, _ = CORPUS[name]
    with pytest.raises(PDEError, match=r"two ways|could be|works on|not a known function"):
        verdict(text, **asked(values))


def test_the_corpus_is_large():
    assert len(CORPUS) - len(REFUSED) >= 60
