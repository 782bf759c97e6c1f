"""What all tests share: notebooks count as slow, a process has one thread, measured times are said at the end."""

import os

import pytest

# Two processes run the tests, and the threads of their linear algebra would only get into each other's way.
for _library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{_library}_NUM_THREADS", "1")


def pytest_collection_modifyitems(items):
    """A notebook run whole takes more than a few seconds."""
    for item in items:
        if item.path.suffix == ".ipynb":
            item.add_marker(pytest.mark.slow)


@pytest.fixture
def measured(record_property):
    """``measured("a step takes 0.1 s")`` puts a sentence before the closing line; no test asserts a wall time."""
    return lambda sentence: record_property("measured", sentence)


def pytest_terminal_summary(terminalreporter):
    reports = [report for kind in ("passed", "failed") for report in terminalreporter.getreports(kind)]
    said = [said for report in reports for name, said in report.user_properties if name == "measured"]
    if said:
        terminalreporter.section("measured")
        terminalreporter.write_line("\n".join(said))
