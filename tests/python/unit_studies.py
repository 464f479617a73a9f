"""Studies: what a file may say, which runs follow from it, and that only missing runs are made.

Oracles: counts by hand, and the exact solutions of the code `exact`, whose error is nought.
"""

from pathlib import Path

import pytest

from verification.protocol.errors import CaseError
from verification.store.laboratory import Laboratory
from verification.studies.study import all_studies, find_study, lines_of, read_study, results_of, run_study, trials_of

FACTORIAL = """
[study]
purpose = "to see"

[[study.block]]
codes = ["exact"]

[study.block.factors]
N = [8, 16]
rcut_over_dx = [3, 3.5, 4]
"""
ONE_AT_A_TIME = FACTORIAL.replace("codes = ", 'design = "one at a time"\ncodes = ')
TWO_BLOCKS = FACTORIAL + """
[[study.block]]
name = "finer"
codes = ["exact", "mappm"]
factors = { N = [16, 32], rcut_over_dx = [3] }
"""


@pytest.fixture
def study_file(shear_wave: Path) -> Path:
    """Where a study of a copy of the shear wave may be written."""
    return shear_wave / "study_some.toml"


def test_factorial_and_one_at_a_time(study_file: Path) -> None:
    study_file.write_text(FACTORIAL)
    study = read_study(study_file)
    assert study.name == "shear_wave.some"
    assert len(study.runs) == 6 and ("exact", ("N=8", "rcut_over_dx=3.5")) in study.runs
    study_file.write_text(ONE_AT_A_TIME)
    assert [setting for _, setting in read_study(study_file).runs] == [(), ("N=8",), ("N=16",), ("rcut_over_dx=3",), ("rcut_over_dx=3.5",), ("rcut_over_dx=4",)]


def test_a_run_that_two_blocks_ask_for_is_made_once(study_file: Path) -> None:
    study_file.write_text(TWO_BLOCKS)
    runs = read_study(study_file).runs
    assert len(runs) == 6 + 3
    assert runs["exact", ("N=16", "rcut_over_dx=3")] == "" and runs["mappm", ("N=16", "rcut_over_dx=3")] == "finer"


def test_only_missing_runs_are_made(study_file: Path, tmp_path: Path) -> None:
    laboratory, said = Laboratory(tmp_path / "lab"), []
    study_file.write_text(FACTORIAL.replace("[8, 16]", "[8]").replace("[3, 3.5, 4]", "[3]"))
    run_study(laboratory, read_study(study_file), 1, said.append)
    assert len(said) == 1
    study_file.write_text(FACTORIAL.replace("[8, 16]", "[8]").replace("[3, 3.5, 4]", "[3, 4]"))
    more = find_study("shear_wave.some")
    run_study(laboratory, more, 1, said.append)
    assert len(said) == 2 and "rcut_over_dx=4" in said[1]
    results = results_of(laboratory, more)
    assert [result.setting for result in results] == [("N=8", "rcut_over_dx=3"), ("N=8", "rcut_over_dx=4")]
    assert all(abs(result.outcome.error) < 1e-9 for result in results)
    head, *rows = lines_of(more, results)
    assert "2 of 2 runs" in head and len(rows) == 2


def test_a_code_that_is_not_there_is_skipped(study_file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("verification.studies.study.find_code", lambda name: _missing(name))
    said: list[str] = []
    study_file.write_text(FACTORIAL.replace("exact", "lammps"))
    assert trials_of(read_study(study_file), said.append) == []
    assert "SKIPPED: install it" in said[0]


def _missing(name: str):
    from verification.codes.code import Code

    return Code(name, name, (), "", frozenset({"fluid"}), missing="install it")


@pytest.mark.parametrize("wrong, named", [
    (FACTORIAL.replace("N = [8, 16]", "N = 8"), "factors.N"),
    (FACTORIAL.replace("N = [8, 16]", "N = []"), "factors.N"),
    (FACTORIAL.replace("N = [8, 16]", "N = [8, 8]"), "stands twice"),
    (FACTORIAL.replace("N = [8, 16]", "M = [8]"), "M"),
    (FACTORIAL.replace("codes = ", "design = 'random'\ncodes = "), "study.block.design"),
    (FACTORIAL.replace("codes = ", "goal = 1\ncodes = "), "study.block.goal"),
    (FACTORIAL.replace("codes = ", "name = 1\ncodes = "), "study.block.name"),
    (FACTORIAL.replace('["exact"]', '"exact"'), "study.block.codes"),
    (FACTORIAL.partition("[study.block.factors]")[0], "study.block.factors"),
    (FACTORIAL.partition("[[study.block]]")[0], "study.block"),
    (FACTORIAL.replace("purpose", 'chart = "pie"\npurpose'), "study.chart"),
    (FACTORIAL.replace("purpose", 'observable = "drag"\npurpose'), "study.observable"),
    (FACTORIAL.replace("purpose", "goal = 1\npurpose"), "study.goal"),
    ("[other]\n", "[study]"),
    ("[study\n", "TOML"),
])
def test_wrong_files_are_refused_by_key(study_file: Path, wrong: str, named: str) -> None:
    study_file.write_text(wrong)
    with pytest.raises(CaseError, match=r"study_some\.toml|case\.toml") as refused:
        read_study(study_file)
    assert named in str(refused.value)


def test_all_studies_of_the_tree_can_be_read() -> None:
    found = [read_study(file) for file in all_studies()]
    assert found and all(study.runs and study.purpose for study in found)


def test_an_unknown_study_is_refused() -> None:
    with pytest.raises(CaseError, match="no such study; known are"):
        find_study("shear_wave.none")
