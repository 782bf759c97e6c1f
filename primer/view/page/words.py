"""Mathtext of matplotlib as plain Unicode: what a page writes beside its pictures."""

import re

_NAMES = {
    "xi": "ξ", "lambda": "λ", "pi": "π", "phi": "φ", "mu": "μ", "theta": "θ", "infty": "∞", "to": "→", "propto": "∝",
    "sim": "~", "times": "×", "max": "max", "cos": "cos", "sin": "sin", "sqrt": "√", "partial": "∂", "alpha": "α",
    "beta": "β", "tau": "τ", "Gamma": "Γ", "leq": "≤", "geq": "≥", ",": " ", ";": " ", "|": "‖", "%": "%",
}  # fmt: skip
_SUPERSCRIPT = str.maketrans("0123456789-+/nx", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺ᐟⁿˣ")
_SUBSCRIPT = str.maketrans("0123456789x", "₀₁₂₃₄₅₆₇₈₉ₓ")


def plain(text):
    """``text`` without its dollar signs: $\\xi^{-2}$ as ξ⁻²."""
    return re.sub(r"\$(.*?)\$", lambda found: _math(found[1]), text, flags=re.S)


def _math(text):
    text = re.sub(r"\\(?:mathdefault|mathrm|text|mathit)\b", "", text)
    text = re.sub(r"\\([a-zA-Z]+|.)", lambda name: _NAMES.get(name[1], name[1]), text).replace("-", "\N{MINUS SIGN}")
    text = re.sub(r"\^(?:{([^{}]*)}|(.))", lambda found: _small(found, _SUPERSCRIPT), text)
    text = re.sub(r"_(?:{([^{}]*)}|(.))", lambda found: _small(found, _SUBSCRIPT), text)
    return text.replace("{", "").replace("}", "")


def _small(found, letters):
    return (found[1] or found[2]).replace("\N{MINUS SIGN}", "-").translate(letters)
