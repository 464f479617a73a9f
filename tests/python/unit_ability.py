"""What a code cannot do is SKIPPED with the reason, and never a pass. Oracles: cases written here, and the code of exact solutions."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from support import ANY_CODE

from verification.codes.code import Code, find_code
from verification.protocol.capability import CAPABILITIES, asked_by, lacking
from verification.protocol.errors import Beyond, CaseError
from verification.protocol.machine import ROOT
from verification.store.laboratory import Laboratory
from verification.suite import table
from verification.suite.ability import able
from verification.suite.case import Case
from verification.suite.judge import SKIPPED, VALIDATED, WITHIN_GOAL
from verification.suite.manifest import find_case, read_cases
from verification.suite.result import Way, collect, run_case

MANIFEST = """
name = "decay"
[case]
purpose = "p"
tier = "quick"
cost = 1
[[case.observable]]
name = "viscosity"
symbol = "nu"
reference = 1.0
uncertainty = 0.0
source = "what is given"
goal = 0.01
since = 2026-11-22
[[case.observable]]
name = "drag"
symbol = "F"
reference = 1.0
uncertainty = 0.0
source = "nobody at all"
goal = 0.01
since = 2026-11-22
needs = ["force-on-body"]
order = [1.0, 2.0]
extrapolated = 0.01
[[case.level]]
set = ["fluid.spacing=0.25"]
[[case.level]]
set = ["fluid.spacing=0.2"]
[[case.level]]
set = ["fluid.spacing=0.125"]
[[case.vary]]
source = "step"
sets = [["run.step_factor=0.5"]]
ratio = 2
[[case.beside]]
label = "classic"
set = ["fluid.method=classic"]
[case.equivalence]
steps = 10
every = 5
variants = ["serial", "P=2"]
[box]
size = [1.0, 1.0]
[fluid]
density = 1.0
viscosity = 0.01
spacing = 0.125
[fluid.wave]
amplitude = 0.1
direction = "y"
gradient = "x"
[run]
duration = 1.0
step_factor = 1.0
"""
BODY = '[[body]]\nshape = "disc"\nradius = 0.1\nmotion = "fixed"\nposition = [0.5, 0.5]\n'


def case_in(folder: Path, *changes: tuple[str, str]) -> Case:
    """The case `decay` of a folder of cases."""
    text = MANIFEST
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    file = folder / "decay" / "case.toml"
    file.parent.mkdir(parents=True)
    file.write_text(text)
    return read_cases(file)[0]


@pytest.fixture(scope="module")
def exact() -> Code:
    return find_code("exact")


def test_an_observable_that_is_beyond_a_code_is_skipped_with_the_reason(tmp_path: Path, exact: Code) -> None:
    viscosity, drag = able(case_in(tmp_path), exact).observables
    assert (viscosity.skipped, drag.skipped) == ("", "exact lacks force-on-body")


def test_the_knobs_of_a_method_are_asked_of_that_method_alone(tmp_path: Path, exact: Code) -> None:
    case, whole = case_in(tmp_path), frozenset(CAPABILITIES)
    asked = able(case, exact)
    assert (asked.vary, asked.beside, asked.equivalence) == ((), (), None)
    mappm = able(case, replace(ANY_CODE, name="mappm", capabilities=whole))
    assert mappm == case
    other = able(case, replace(ANY_CODE, capabilities=whole))
    assert (other.vary, other.beside, other.equivalence, other.levels) == ((), (), case.equivalence, case.levels)


def test_a_scene_that_is_too_much_is_beyond_a_code(tmp_path: Path, exact: Code) -> None:
    case = case_in(tmp_path, ("[run]", BODY + "[run]"))
    with pytest.raises(Beyond, match="^exact lacks fixed-body$"):
        able(case, exact)
    assert able(case, replace(exact, capabilities=exact.capabilities | {"fixed-body"}))


def test_needs_that_nobody_knows_are_an_error(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=r"observable\[1\].needs: 'force': unknown; known are fluid, 3d, walls"):
        case_in(tmp_path, ('"force-on-body"', '"force"'))


@pytest.mark.parametrize(("changes", "words"), [
    ({}, {"fluid"}), ({"box": {"size": [1, 1, 1]}}, {"fluid", "3d"}), ({"fluid": {"particles": False}}, set()),
    ({"body": [{"shape": "wall"}]}, {"fluid", "walls"}), ({"body": [{"shape": "disc"}]}, {"fluid", "free-body"}),
    ({"body": [{"shape": "disc", "motion": "moving"}]}, {"fluid", "moving-body"}),
    ({"body": [{"shape": "disc"}] * 2}, {"fluid", "free-body", "contact"}),
    ({"body": [{"shape": "disc"}] * 2, "contact": {"model": "none"}}, {"fluid", "free-body"}),
    ({"body": [{"shape": "disc"}, {"shape": "wall"}]}, {"fluid", "free-body", "contact", "walls"}),
    ({"body": [{"shape": "disc", "array": {"count": [1, 2]}}]}, {"fluid", "free-body", "contact"}),
    ({"body": [{"shape": "disc", "motion": "fixed"}] * 2}, {"fluid", "fixed-body"})])
def test_what_a_scene_asks_for_is_read_from_it(changes: dict, words: set[str]) -> None:
    assert asked_by({"box": {"size": [1, 1]}, "fluid": {}} | changes) == words
    assert lacking(frozenset(), words) == [word for word in CAPABILITIES if word in words] and lacking(words, words) == []


def test_what_was_skipped_neither_passes_nor_fails(tmp_path: Path, exact: Code) -> None:
    case, laboratory = able(case_in(tmp_path), exact), Laboratory(tmp_path / "runs")
    found = run_case(laboratory, case, "quick", exact, Way(), print)
    assert [outcome.verdict for outcome in found.outcomes] == [VALIDATED, SKIPPED, SKIPPED]  # the last at dx to 0
    assert found.holds and len(found.skipped) == 2
    for outcome in found.skipped:
        assert outcome.reason == "exact lacks force-on-body" and "SKIPPED: exact lacks force-on-body" in outcome.line
        assert VALIDATED not in outcome.line and outcome.state == ""
    assert collect(laboratory, case, "quick", exact).holds


def verification(folder: Path, *words: str) -> subprocess.CompletedProcess:
    environment = os.environ | {"MAPPM_CASES": str(folder)}
    line = [sys.executable, "-m", "verification", *words]
    return subprocess.run(line, cwd=ROOT, env=environment, capture_output=True, text=True)


@pytest.mark.parametrize(("changes", "status", "line"), [
    ((), 77, "F = nan (SKIPPED: exact lacks force-on-body)"),
    ((("reference = 1.0\nuncertainty = 0.0\nsource = \"what", "reference = 2.0\nuncertainty = 0.0\nsource = \"what"),), 1, "SKIPPED"),
    ((('needs = ["force-on-body"]\n', ""), ('name = "drag"', 'name = "viscosity"'), ("order = [1.0, 2.0]\nextrapolated = 0.01\n", "")),
     0, "VALIDATED"),
    ((("[run]", BODY + "[run]"),), 77, "SKIPPED: exact lacks fixed-body"),
    ((('gradient = "x"', 'gradient = "y"'),), 77, "SKIPPED: exact: ")])
def test_the_command_line_tells_a_skip_from_a_pass(tmp_path: Path, changes: tuple, status: int, line: str) -> None:
    case_in(tmp_path, *changes)
    done = verification(tmp_path, "run", "decay", "--code", "exact", "--lab", str(tmp_path / "runs"))
    assert (done.returncode, line in done.stdout) == (status, True), done.stdout + done.stderr


def test_a_code_that_is_not_installed_is_skipped(tmp_path: Path) -> None:
    case_in(tmp_path)
    absent = tmp_path / "absent.py"
    absent.write_text("""print('{"name": "absent", "version": "", "capabilities": ["fluid"], "missing": "install it"}')""")
    done = verification(tmp_path, "run", "decay", "--code", str(absent), "--lab", str(tmp_path / "runs"))
    assert (done.returncode, done.stdout) == (77, "SKIPPED: install it\n")

# --- the table of codes


def test_a_cell_of_the_table_has_a_result_or_a_reason(tmp_path: Path, exact: Code) -> None:
    laboratory, case = Laboratory(tmp_path / "runs"), case_in(tmp_path)
    assert table._cell(laboratory, case, exact).why == "not run yet"
    table.make(laboratory, table._job(case, exact))
    cell = table._cell(laboratory, case, exact)
    assert cell.outcome.verdict in (VALIDATED, WITHIN_GOAL) and cell.core_seconds > 0 and not cell.why
    assert table._cell(laboratory, find_case("cylinder_stokes.phi_0.2"), exact).why == "exact lacks fixed-body"
    assert table._cell(laboratory, case, replace(exact, missing="install it")).why == "install it"


def test_a_scene_that_a_code_refused_is_remembered_with_its_words(tmp_path: Path, exact: Code) -> None:
    laboratory, case = Laboratory(tmp_path / "runs"), case_in(tmp_path, ('gradient = "x"', 'gradient = "y"'))
    table.make(laboratory, table._job(case, exact))
    cell = table._cell(laboratory, case, exact)
    assert cell.outcome is None and "sound" in cell.why and laboratory.store.runs() == []


def test_an_observable_that_is_beyond_a_code_is_a_reason_in_the_table(tmp_path: Path, exact: Code) -> None:
    case = case_in(tmp_path)
    alone = replace(case, observables=case.observables[1:])
    with pytest.raises(Beyond, match="exact lacks force-on-body"):  # so that nothing is run for it
        table._job(alone, exact)
    cell = table._cell(Laboratory(tmp_path / "runs"), alone, exact)
    assert cell.outcome is None and cell.why == "exact lacks force-on-body"
