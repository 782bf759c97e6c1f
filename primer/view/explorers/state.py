"""All that an explorer's controls say, as one text to copy."""

from primer.checks import shown


def defaults(controls):
    """Name -> value where nothing has been moved."""
    return {control.name: control.default for control in controls}


def write_state(controls, values):
    """A state as a text to copy: ``a=0.6,eps=0.01,n=64``."""
    return ",".join(f"{control.name}={control.text(values[control.name])}" for control in controls)


def read_state(controls, text):
    """Name -> value from such a text, of what it names.

    Raises
    ------
    ValueError    if it is not of this form, names what is not there, or names something twice
    """
    known, values = {control.name: control for control in controls}, {}
    for part in str(text).split(","):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not part.strip():
            continue
        if not equals or name not in known:
            raise ValueError(f"state must be NAME=VALUE parted by commas, of {', '.join(known)}, got {shown(part)}")
        if name in values:
            raise ValueError(f"state must say {name} once, got {shown(text)}")
        values[name] = known[name].parse(value)
    return values
