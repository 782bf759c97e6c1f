"""Which tests guard which line: a pytest plugin that watches, and the choice made from what it saw."""

import signal
import time
from pathlib import Path

import pytest
from mutants import ROOT

#: What writes machine code runs once for each equation in a process: it is guarded by whatever runs its caller.
CALLER = dict.fromkeys(
    ("kernel.py", "watch.py", "slope.py", "pointwise.py", "passes.py", "writer.py", "compiled.py"), "block.py"
) | {"lines_kernel.py": "lines_block.py"}

HOUSE = (
    "test_dataclasses_are_frozen",
    "test_what_is_left_out_is_the_same_everywhere",
    "test_what_is_left_out_and_what_is_fixed_is_what_was_released",
)  # what they see happened when the modules were imported


class Watch:
    """A pytest plugin: what each test runs, and how long it takes. Those that fail, or last too long, are left out."""

    def __init__(self, longest):
        import coverage

        self.cov, self.seconds, self.left_out = coverage.Coverage(data_file=None, source=["primer"]), {}, set()
        self.longest = longest
        signal.signal(signal.SIGALRM, lambda *_: pytest.skip("too long"))  # hypothesis passes it on at once
        self.cov.start()

    def pytest_runtest_logstart(self, nodeid):
        self.cov.switch_context(nodeid)
        self.seconds[nodeid] = time.perf_counter()
        signal.setitimer(signal.ITIMER_REAL, self.longest)

    def pytest_runtest_logreport(self, report):
        if not report.passed:
            self.left_out.add(report.nodeid)

    def pytest_runtest_logfinish(self, nodeid):
        signal.setitimer(signal.ITIMER_REAL, 0)
        self.seconds[nodeid] = time.perf_counter() - self.seconds[nodeid]
        self.cov.switch_context("")

    def known(self, before):
        """``before`` with what was seen in place of what it says of the same tests."""
        self.cov.stop()
        lines, data = before["lines"], self.cov.get_data()
        for tests in (tests for of_file in lines.values() for tests in of_file.values()):
            tests[:] = [test for test in tests if test not in self.seconds]
        for path in data.measured_files():
            of_file = lines.setdefault(Path(path).relative_to(ROOT).as_posix(), {})
            for line, tests in data.contexts_by_lineno(path).items():
                of_file.setdefault(str(line), []).extend(test for test in tests if test and test not in self.left_out)
        seconds = before["seconds"] | self.seconds
        return {"seconds": {test: seconds[test] for test in seconds if test not in self.left_out}, "lines": lines}


def guards(known, file, first, last, cap):
    """The tests to run, in three helpings: a few of those of the changed lines, the rest of them, those of the file.

    For compiled lines, which are not seen, they are those of the caller and what runs them uncompiled; for constants
    alone those of the folder.
    """
    folder, name = file.rsplit("/", 1)
    near = known["lines"].get(f"{folder}/{CALLER.get(name, name)}", {})
    if sum(map(bool, near.values())) < 3:
        files = [lines for other, lines in known["lines"].items() if other.startswith(folder)]
        near = {f"{n} {k}": tests for n, lines in enumerate(files) for k, tests in lines.items()}
    elif name in CALLER:
        plain = known["lines"].get(file, {})
        near = {f"caller {k}": tests for k, tests in near.items()} | plain
    by_file = {test for tests in near.values() for test in tests}
    by_file |= {test for test in known["seconds"] if test.endswith(HOUSE)}
    by_line = {test for k in range(first, last + 1) for test in near.get(str(k), ())}
    chosen, spent = [], 0.0
    for test in sorted(by_line, key=known["seconds"].get) + sorted(by_file - by_line, key=known["seconds"].get):
        spent += known["seconds"][test]
        if spent <= cap or not chosen:
            chosen.append(test)
    few = min(20, len(by_line))
    return chosen[:few], chosen[few : len(by_line)], chosen[max(few, len(by_line)) :]
