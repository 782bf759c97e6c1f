"""Do the tests notice? Spoil the package one small change at a time and count the changes that some test catches.

    python tests/mutation map [tests]              which test runs which line, and for how long: all, or these anew
    python tests/mutation run --sample 60 --seed 1 a random sample of so many mutants from each folder
    python tests/mutation score                    the share caught by folder, its 95 % interval, and the survivors
    python tests/mutation check --sample 2         the tests of so many mutants, but nothing is changed: none may fail

A mutant is never written to disk: each is a fork of a process that has imported the libraries but not ``primer``, and
an import hook hands it the changed module. It meets the tests that run the changed line, quickest first, then the
others that run its file, until one fails or their usual times add up to ``--cap`` seconds.

Survivors listed in harmless.txt, with the reason, change nothing that a test could see. The mutation score is the share
caught of all others. An entry holds until its file is edited, which renumbers the mutants.
"""

import argparse
import importlib
import json
import math
import os
import random
import resource
import signal
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

from guards import Watch, guards
from mutants import ROOT, Spoil, mutants


def face(known, file, number, first, last, cap):
    """In a fork: run the tests against one mutant. Exit 1 if one fails, 0 if none does; an alarm ends what hangs."""
    import pytest

    helpings = guards(known, file, first, last, cap)
    longest = int(60 + 5 * sum(known["seconds"][test] for tests in helpings for test in tests))
    signal.alarm(longest)
    resource.setrlimit(resource.RLIMIT_CPU, (longest, longest))  # some tests set alarms of their own
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    os.dup2(1, 2)
    sys.meta_path.insert(0, Spoil(file, number))
    options = [
        "-x",
        "-o",
        "addopts=-q",
        "-p",
        "no:cacheprovider",
        "-p",
        "_hypothesis_pytestplugin",
        "--hypothesis-seed=0",
    ]
    caught = any(pytest.main([*options, *tests]) != 0 for tests in helpings if tests)
    os._exit(caught)


def run(known, out, chosen):
    """Try the sample's mutants that ``out`` does not have yet (with --again, its survivors) and add a line for each."""
    for library in (
        "hypothesis",
        "matplotlib.figure",
        "mpmath",
        "llvmlite.binding",
        "pytest",
        "scipy.optimize",
        "sympy",
    ):
        importlib.import_module(library)  # once, for all forks
    sys.dont_write_bytecode = False  # or every fork would compile the tests anew
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    results = list(map(json.loads, out.open())) if out.exists() else []
    if chosen.again:
        keep = [r for r in results if r["how"] != "survives"]
        todo = [r["mutant"] for r in results if r["how"] == "survives"]
        out.write_text("".join(json.dumps(r) + "\n" for r in keep))
    else:
        done, todo = {tuple(r["mutant"][:2]) for r in results}, []
        for folder in chosen.folders:
            every = list(mutants(folder))
            sample = random.Random(f"{chosen.seed} {folder}").sample(every, min(chosen.sample, len(every)))
            todo += [mutant for mutant in sample if mutant[:2] not in done]
        if chosen.action == "check":
            todo = [(file, -1, *rest) for file, _, *rest in todo]
        random.Random(chosen.seed).shuffle(todo)
    running = {}
    for mutant in todo + [None] * chosen.jobs:
        if len(running) == chosen.jobs or (mutant is None and running):
            pid, status = os.wait()
            how = "hangs" if os.WIFSIGNALED(status) else "caught" if os.waitstatus_to_exitcode(status) else "survives"
            with out.open("a") as lines:
                print(json.dumps({"mutant": running.pop(pid), "how": how}), file=lines)
        if mutant is not None:
            pid = os.fork()
            if pid == 0:
                face(known, *mutant[:4], chosen.cap)
            running[pid] = mutant


def share(k, n):
    """k of n, with Wilson's 95 % interval."""
    if n == 0:
        return "none"
    z = 1.96
    middle, half = (k + z * z / 2) / (n + z * z), z * math.sqrt(k * (n - k) / n + z * z / 4) / (n + z * z)
    return f"{k}/{n} = {k / n:.1%} [{middle - half:.1%}, {middle + half:.1%}]"


def entry(mutant):
    """How harmless.txt names a mutant: it holds until that line of code is edited."""
    file, _, line, _, what, column = mutant
    code = (ROOT / file).read_text("utf-8").splitlines()[line - 1].strip()
    return f"{file}  {code}  [{column}: {what.splitlines()[0]}]"


def score(out):
    listed = (ROOT / "tests/mutation/harmless.txt").read_text("utf-8").splitlines()
    listed = {line.rsplit("]  # ", 1)[0] + "]" for line in listed}
    by_folder = defaultdict(list)
    for result in map(json.loads, out.open()):
        by_folder[result["mutant"][0].split("/")[1]].append(result)
    counts = {folder: sum(1 for _ in mutants(folder)) for folder in by_folder}
    left = [r["mutant"] for results in by_folder.values() for r in results if r["how"] == "survives"]
    harmless = {tuple(mutant) for mutant in left if entry(mutant) in listed}
    for title, left_out in (("caught of all", set()), ("caught of those that change something", harmless)):
        print(title)
        mean = variance = 0.0
        for folder, results in sorted(by_folder.items()):
            kept = [r for r in results if tuple(r["mutant"]) not in left_out]
            caught, weight = sum(r["how"] != "survives" for r in kept), counts[folder] / sum(counts.values())
            print(f"  {folder:9}{counts[folder]:6}  {share(caught, len(kept))}")
            mean += weight * caught / len(kept)
            near = (caught + 2) / (len(kept) + 4)  # so that a folder without survivors is not taken for certain
            variance += weight**2 * near * (1 - near) / (len(kept) + 4)
        print(f"  weighted by folder {mean:.1%} +- {1.96 * math.sqrt(variance):.1%}")
    for mutant in sorted(left):
        if tuple(mutant) not in harmless:
            print(f"line {mutant[2]} of {entry(mutant)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("action", choices=("map", "run", "score", "check"))
    parser.add_argument("tests", nargs="*")
    parser.add_argument(
        "--folders", nargs="*", default=["equations", "problems", "schemes", "analysis", "granular", "study"]
    )
    parser.add_argument("--sample", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cap", type=float, default=20)
    parser.add_argument("--longest", type=float, default=5, help="seconds after which map leaves a test out")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--again", action="store_true", help="only the survivors, after new tests or with a larger cap")
    parser.add_argument("--map", type=Path, default=ROOT / "build/mutation-map.json")
    parser.add_argument("--results", type=Path, default=ROOT / "build/mutation-results.jsonl")
    chosen = parser.parse_args()
    chosen.map.parent.mkdir(exist_ok=True)
    os.chdir(ROOT)
    sys.path[:0] = [str(ROOT), str(ROOT / "tests")]
    known = json.loads(chosen.map.read_text()) if chosen.map.exists() else {"seconds": {}, "lines": {}}
    if chosen.action == "map":
        import pytest

        watch = Watch(chosen.longest)
        options = ["-o", "addopts=-q", "-p", "no:cacheprovider", "--hypothesis-seed=0"]
        pytest.main([*options, *chosen.tests], plugins=[watch])
        chosen.map.write_text(json.dumps(watch.known(known)))
    elif chosen.action == "run":
        run(known, chosen.results, chosen)
    elif chosen.action == "check":
        with tempfile.TemporaryDirectory() as folder:
            run(known, Path(folder) / "results", chosen)
            found = [json.loads(line) for line in (Path(folder) / "results").open()]
        wrong = [f"{r['mutant'][0]}:{r['mutant'][2]} {r['how']}" for r in found if r["how"] != "survives"]
        print(f"{len(found) - len(wrong)} of {len(found)} survive, as nothing was changed", *wrong, sep="\n")
        sys.exit(bool(wrong))
    else:
        score(chosen.results)


if __name__ == "__main__":
    main()
