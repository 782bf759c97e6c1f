"""Guards the reference: every public thing says what it is, with its equation and an example that runs as shown."""

import doctest
import importlib
import inspect
import re
from pathlib import Path

import pytest

import primer
import primer.granular

ROOT = Path(__file__).parents[1]
PACKAGE = Path(primer.__file__).parent
MODULES = [
    ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__")
    for path in sorted(PACKAGE.rglob("*.py"))
    if ">>>" in path.read_text(encoding="utf-8")
]
LABELS = (ROOT / "tests" / "paper_labels.txt").read_text(encoding="utf-8").split()
# A label of the paper, a place in it, or a source with its year.
SOURCE = re.compile(
    "|".join(re.escape(f"({label})") for label in LABELS)
    + r"|\b[Ss]ections? \d|\bA[12]\.\d|\bFigures? \d|\bLemma|\bTheorem|\bAppendix|\(\d{4}\)|\b(18|19|20)\d\d\b"
)


def text_of(name):
    """The docstring of a public name; that of its module for a constant."""
    value = getattr(primer, name)
    if inspect.isclass(value) or inspect.isroutine(value):
        return value.__doc__
    return importlib.import_module(f"primer.{primer._HOME[name]}").__doc__


@pytest.mark.parametrize("module", MODULES)
def test_examples_print_what_they_say(module):
    result = doctest.testmod(importlib.import_module(module))
    assert result.attempted
    assert not result.failed


@pytest.mark.parametrize("name", primer.__all__)
def test_each_public_name_has_an_example_and_a_source(name):
    text = text_of(name)
    examples = doctest.DocTestParser().get_examples(text)
    if not inspect.isclass(getattr(primer, name)):  # a result is shown by what gives it
        assert any(re.search(rf"\b{name}\b", each.source) for each in examples)
    assert any(each.want for each in examples)
    assert SOURCE.search(text), name


def public_things():
    """(name, thing) for what the rooms define: functions and classes, and the classes' own functions."""
    for path in sorted(PACKAGE.rglob("*.py")):
        room = path.relative_to(PACKAGE).parts[0]
        if room not in ("equations", "problems", "schemes", "analysis", "granular", "study") or path.stem == "__init__":
            continue
        module = importlib.import_module(".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts))
        for name, thing in vars(module).items():
            if name.startswith("_") or getattr(thing, "__module__", None) != module.__name__:
                continue
            if inspect.isclass(thing) or inspect.isfunction(thing):
                yield f"{module.__name__}.{name}", thing
            if inspect.isclass(thing):
                for part, value in vars(thing).items():
                    if not part.startswith("_") and isinstance(value, property) | inspect.isfunction(value):
                        yield f"{module.__name__}.{name}.{part}", value


def test_every_public_thing_of_the_rooms_says_what_it_is():
    things = dict(public_things())
    assert len(things) > 200
    silent = [name for name, thing in things.items() if not (thing.__doc__ or "").strip()]
    assert not silent


@pytest.mark.parametrize("name", primer.granular.__all__)
def test_granular_names_cite_their_equation(name):
    value = getattr(primer.granular, name)
    if inspect.isclass(value) or inspect.isfunction(value):
        assert SOURCE.search(value.__doc__), name
