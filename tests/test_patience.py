"""Guards the tests from hanging: whatever does not end is failed in words, and the others are run."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from patience import alarm

TESTS = Path(__file__).parent
posix = pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="knows no alarms")

HANGING = """
import pytest, time

@pytest.fixture
def never():
    time.sleep(1000)

def test_python():
    while True:
        pass

def test_one_that_catches():
    while True:
        try:
            time.sleep(1000)
        except Exception:
            pass

def test_fixture(never):
    pass

def test_good():
    pass
"""
DEAF = "\ndef test_machine_code():\n    sum(range(10**15))\n"


class Rung(Exception):
    """The alarm rang."""


def ring(*_):
    raise Rung


def suite(folder, tests, *options):
    """The outcome of these tests under this folder's conftest, with limits of a second."""
    shutil.copy(TESTS / "patience.py", folder)
    conftest, replaced = re.subn(
        r"^FAST, SLOW = .*", "FAST, SLOW = 1, 2", (TESTS / "conftest.py").read_text(), flags=re.M
    )
    assert replaced == 1
    (folder / "conftest.py").write_text(conftest)
    (folder / "pytest.ini").write_text("[pytest]\nmarkers = slow\n")
    (folder / "test_some.py").write_text(tests)
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-p", "no:nbval", *options]
    env = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, env=env, timeout=240)


@posix
@pytest.mark.slow
def test_what_hangs_fails_and_the_rest_is_run(tmp_path):
    found = suite(tmp_path, HANGING)
    assert found.returncode == 1
    assert "2 failed, 1 passed, 1 error" in found.stdout
    assert found.stdout.count("Failed: not done within 1 s") >= 3


@pytest.mark.slow
def test_what_hangs_in_machine_code_says_where(tmp_path):
    found = suite(tmp_path, DEAF)
    assert found.returncode not in (0, 5)
    assert "Timeout" in found.stderr
    assert "test_machine_code" in found.stderr


def sleep_through(inner):
    """Through an alarm that says nothing, until one does."""
    with inner:
        time.sleep(0.15)
    time.sleep(60)


@posix
def test_an_alarm_within_another_leaves_it_set():
    with pytest.raises(Rung), alarm(0.2, ring):
        sleep_through(alarm(0.1, lambda *_: None))
    with pytest.raises(Rung), alarm(0.1, ring), alarm(60, lambda *_: None):  # the outer one rings sooner
        time.sleep(60)
    with alarm(60, ring):
        before = signal.getitimer(signal.ITIMER_REAL)[0]
        with alarm(30, ring):
            pass
        assert before - 30 < signal.getitimer(signal.ITIMER_REAL)[0] <= before
