"""What all tests share: a time limit, the same examples each time, one thread, notebooks that count as slow."""

import faulthandler
import os
import signal

import pytest
from hypothesis import HealthCheck, settings
from patience import alarm

# Two processes run the tests, and the threads of their linear algebra would only get into each other's way.
for _library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{_library}_NUM_THREADS", "1")

# No test depends on chance: hypothesis draws the same examples each time. --hypothesis-profile=search draws new ones.
patient = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
settings.register_profile("same", derandomize=True, **patient)
settings.register_profile("search", derandomize=False, print_blob=True, **patient)
settings.load_profile("same")

# Seconds for each of setting up, the test itself and tidying up: far more than any takes, so that a slow machine is no
# failure and a test that hangs is one.
FAST, SLOW = 300, 900
_DYING = 1.2  # where not even the alarm is heard, in machine code, the process says where it is and ends
_told = []


def pytest_configure(config):
    """Keep the true stderr, which is somewhere else while a test runs."""
    _told.append(os.dup(2))


def pytest_collection_modifyitems(items):
    """A notebook run whole takes more than a few seconds."""
    for item in items:
        if item.path.suffix == ".ipynb":
            item.add_marker(pytest.mark.slow)


def _limited(item):
    """A step of a test, which fails when it takes too long."""
    seconds = SLOW if item.get_closest_marker("slow") else FAST

    def ring(*_):
        pytest.fail(f"not done within {seconds} s", pytrace=True)

    faulthandler.dump_traceback_later(_DYING * seconds, exit=True, file=_told[0])
    try:
        with alarm(seconds, ring):
            return (yield)
    finally:
        faulthandler.cancel_dump_traceback_later()


pytest_runtest_setup = pytest.hookimpl(wrapper=True)(lambda item: (yield from _limited(item)))
pytest_runtest_call = pytest.hookimpl(wrapper=True)(lambda item: (yield from _limited(item)))
pytest_runtest_teardown = pytest.hookimpl(wrapper=True)(lambda item: (yield from _limited(item)))


@pytest.fixture
def ctrl_c():
    """Ctrl-C is heard in this test and in what it starts, also where a shell runs the tests in the background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


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
