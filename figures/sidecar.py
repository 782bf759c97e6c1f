"""The numbers beside each picture: how they are claimed, stored, and held to."""

import json
import math


def close(value, why, rtol=0.0, atol=0.0):
    """A number that a recomputation must meet within atol + rtol |value|, and why so closely."""
    value = float(value)
    return {"value": _rounded(value, atol + rtol * abs(value)), "rtol": rtol, "atol": atol, "why": why}


def within(value, low, high, why):
    """A number of which only an interval can be claimed, and why: a recomputation must fall into it."""
    value = float(value)
    return {"value": _rounded(value, 1e-2 * abs(value)), "low": low, "high": high, "why": why}


def same(value, why):
    """A text or a whole number that a recomputation must repeat."""
    return {"value": str(value) if isinstance(value, str) else value, "why": why}


def _rounded(value, slack):
    """To one digit more than is claimed: further digits are of this machine alone."""
    return round(value, 1 - math.floor(math.log10(slack))) if slack > 0 and math.isfinite(value) else value


def dumps(numbers):
    """The sidecar's text; finite numbers only."""
    return json.dumps(numbers, indent=1, allow_nan=False) + "\n"


def drift(stored, fresh):
    """Sentences, one for each number in which the ``fresh`` numbers have left the ``stored`` ones."""
    missing = [f"{name} is stored but no longer computed" for name in stored.keys() - fresh.keys()]
    extra = [f"{name} is computed but not stored" for name in fresh.keys() - stored.keys()]
    return sorted(missing + extra) + [
        sentence for name in stored if name in fresh and (sentence := _drift(name, stored[name], fresh[name]["value"]))
    ]


def _drift(name, claim, value):
    if "low" in claim:
        held, allowed = claim["low"] <= value <= claim["high"], f"in [{claim['low']:g}, {claim['high']:g}]"
    elif "rtol" in claim:
        slack = claim["atol"] + claim["rtol"] * abs(claim["value"])
        held, allowed = abs(value - claim["value"]) <= slack, f"{claim['value']!r} to within {slack:.2g}"
    else:
        held, allowed = value == claim["value"], repr(claim["value"])
    return "" if held else f"{name} is {value!r}, but must be {allowed} ({claim['why']})"
