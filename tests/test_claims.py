"""Guards the ledger of claims: what each names exists, README agrees with it, and its command prints it."""

import ast
import json
import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from primer.__main__ import main
from primer.claims import VERDICTS, Claim, claims

ROOT = Path(__file__).parents[1]
LEDGER = claims()
LABELS = set((ROOT / "tests" / "paper_labels.txt").read_text(encoding="utf-8").split())
PLACES = {"Theorem", "Proposition", "Lemma 1", "Lemma 2", "Lemma 3", "Lemma of section 4", "Appendix 1"}
PLACES |= {"section 1", "section 2.1", "section 2.2", "section 4", "section 5", "A1.2", "A2.1", "A2.2.2"}
PLACES |= {"Figure 4", "Figure 5", "Figure 6"}
each = pytest.mark.parametrize("claim", LEDGER, ids=lambda c: f"{c.where} {c.says[:30]}")


def defined_in(file):
    tree = ast.parse((ROOT / "tests" / file).read_text(encoding="utf-8"))
    return {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}


@each
def test_a_claim_is_complete_and_names_what_exists(claim):
    assert isinstance(claim, Claim)
    assert all(part.strip() == part and part for part in (claim.where, claim.says, claim.computed))
    assert claim.verdict in VERDICTS
    label = re.fullmatch(r"\((.+)\)", claim.where)
    assert label.group(1) in LABELS if label else claim.where in PLACES
    assert claim.shown_by
    for name in claim.shown_by:
        if name.startswith("figures/"):
            assert (ROOT / name).is_file(), name
            assert Path(name).with_suffix(".json").name in os.listdir(ROOT / "figures")
        else:
            file, test = re.fullmatch(r"tests/(\w+\.py)::(test_\w+)", name).groups()
            assert test in defined_in(file), name


def test_what_is_corrected_or_sharpened_has_a_test():
    for claim in LEDGER:
        if claim.verdict != "confirmed":
            assert any(name.startswith("tests/") for name in claim.shown_by), claim


def test_no_claim_is_made_twice_and_every_part_of_the_paper_has_some():
    assert max(Counter((c.where, c.says) for c in LEDGER).values()) == 1
    assert {c.where for c in LEDGER} >= PLACES
    assert 40 <= len(LEDGER) <= 100


def test_the_list_of_corrections_and_the_ledger_agree():
    section = (ROOT / "notebooks" / "CORRECTIONS.md").read_text(encoding="utf-8")
    parts = dict(zip(("corrected", "sharpened"), re.split(r"\nSharpened", section), strict=True))
    for verdict, part in parts.items():
        ours = [c.where for c in LEDGER if c.verdict == verdict]
        bullets = [" ".join(bullet.split()) for bullet in part.split("\n- ")[1:]]
        for where in ours:
            assert any(re.search(rf"(?<!\w){re.escape(where)}(?!\w)", bullet) for bullet in bullets), where
        for bullet in bullets:
            assert any(where in bullet for where in ours), bullet


def run(capsys, *arguments):
    code = main(["claims", *arguments])
    return code, capsys.readouterr().out


def test_the_command_lists_filters_and_searches(capsys):
    code, out = run(capsys)
    assert code == 0
    assert f"{len(LEDGER)} claims: " in out
    assert all(claim.says in out and claim.computed in out for claim in LEDGER)
    _, out = run(capsys, "--verdict", "corrected", "--json")
    assert [Claim(**{**row, "shown_by": tuple(row["shown_by"])}) for row in json.loads(out)] == [
        claim for claim in LEDGER if claim.verdict == "corrected"
    ]
    _, out = run(capsys, "FACTOR A")
    assert out.startswith("(42b): corrected\n")
    assert out.endswith("1 claim: 0 confirmed, 1 corrected, 0 sharpened\n")
    assert run(capsys, "no such word") == (0, "0 claims: 0 confirmed, 0 corrected, 0 sharpened\n")


def test_bad_input_gets_one_sentence():
    with pytest.raises(ValueError, match="verdict must be one of confirmed, corrected, sharpened, got 'wrong'"):
        claims(verdict="wrong")
    with pytest.raises(TypeError, match="word must be text, got 3"):
        claims(3)


@pytest.mark.skipif(os.name != "posix", reason="head is a POSIX tool")
def test_a_reader_that_goes_away_is_no_traceback():
    pipe = f"{sys.executable} -m primer claims | head -1; exit ${{PIPESTATUS[0]}}"
    found = subprocess.run(["bash", "-c", pipe], capture_output=True, text=True, cwd=ROOT)
    assert found.stdout == f"{LEDGER[0].where}: {LEDGER[0].verdict}\n"
    assert found.stderr == ""
    assert found.returncode in (0, 141)  # 0 if all was written before head went
