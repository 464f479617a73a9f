"""The planted faults themselves. Oracles: texts written here; for the manifest, the sources as they stand."""

import sys
from dataclasses import replace
from pathlib import Path

import pytest

from tests.mutation.__main__ import chosen, hunt
from tests.mutation.detectors import Detector, Result, first_reason, run_detector
from tests.mutation.manifest import ManifestError, Mutant, guarded, read_manifests

TEXT = "int a = b + c;\nint d = b + e;\n"
SIGN = Mutant("sign", "physics", "what", "a.cpp", "b + c", "b - c", ("gtest a A.*",))


def test_every_fault_has_its_place_in_the_sources_and_a_detector() -> None:
    mutants = read_manifests()
    assert len(mutants) >= 40
    assert {"physics", "integration", "halo", "migration", "home", "solids", "contact", "input", "output",
            "verdict"} <= {mutant.group for mutant in mutants}
    assert 8 <= len(chosen(mutants, quick=True, names=[])) <= 14
    for mutant in mutants:
        for text in mutant.caught_by:
            Detector(text).check()


def test_faults_sleep_behind_their_number() -> None:
    other = replace(SIGN, id="other", faulty="0")
    line = replace(SIGN, id="line", original="int d = b + e;", faulty="int d = 1;", kind="statement")
    assert guarded(TEXT, [SIGN, line, other]) == (
        f'#include "base/mutant.hpp"\nint a = (::mappm::mutant({other.number}) ? (0) : '
        f"((::mappm::mutant({SIGN.number}) ? (b - c) : (b + c))));\n"
        f"if (::mappm::mutant({line.number})) {{ int d = 1; }} else {{ int d = b + e; }}\n"
    )
    with pytest.raises(ManifestError, match="overlap"):
        guarded(TEXT, [SIGN, replace(SIGN, id="wider", original="a = b + c")])


@pytest.mark.parametrize(
    ("original", "within", "start"), [("b + c", "", 8), ("b", "d = b + e", 23), ("b", "", None), ("b", "b", None)]
)
def test_a_place_must_be_the_only_one(original: str, within: str, start: int | None) -> None:
    mutant = replace(SIGN, original=original, within=within)
    if start is None:
        with pytest.raises(ManifestError, match="sign: 'b' stands 2 times in a.cpp, not once"):
            mutant.span(TEXT)
    else:
        assert mutant.span(TEXT) == (start, start + len(original))
        assert mutant.planted(TEXT)[start:].startswith("b - c")


def test_a_manifest_that_fits_no_more_names_all_that_is_lost(tmp_path: Path) -> None:
    (tmp_path / "a.cpp").write_text(TEXT)
    entry = '[[mutant]]\nid = "{}"\nwhat = "w"\nfile = "{}"\noriginal = "{}"\nfaulty = ""\ncaught_by = ["d"]\n'
    manifest = tmp_path / "physics.toml"
    manifest.write_text(entry.format("one", "a.cpp", "gone") + entry.format("two", "b.cpp", "b")
                        + entry.format("three", "a.cpp", "c"))
    with pytest.raises(ManifestError) as caught:
        read_manifests(tmp_path, tmp_path)
    assert str(caught.value).splitlines() == ["one: 'gone' stands 0 times in a.cpp, not once; mend the entry",
                                              "two: b.cpp is missing; mend the entry"]
    manifest.write_text(entry.format("one", "a.cpp", "c") + 'colour = "red"\n')
    with pytest.raises(ManifestError, match="one: colour is unknown"):
        read_manifests(tmp_path, tmp_path)


def test_only_faults_that_exist_are_chosen() -> None:
    with pytest.raises(ManifestError, match="nothing: no such fault"):
        chosen([SIGN], quick=False, names=["nothing"])
    with pytest.raises(ManifestError, match="no fault is chosen"):
        chosen([SIGN], quick=True, names=[])


@pytest.mark.parametrize(
    ("kind", "output", "reason"),
    [
        ("bits", "first difference at step 4:\n  ab  P=1\n", "first difference at step 4:"),
        ("case", "x = 1 (reference 1, error 0 %, VALIDATED)\ny = 2 (reference 1, error 1 %, FAILED)\n",
         "y = 2 (reference 1, error 1 %, FAILED)"),
        ("gtest", "Note\na.cpp:3: Failure\nExpected equality\n", "a.cpp:3: Failure Expected equality"),
        ("pytest", "F\n>  assert a\nE       assert 1 == 2\n", "assert 1 == 2"),
        ("pytest", "E   SolverError: /opt/x/bin/python3 -m code run --scene /tmp/a1/scene.toml of 1/2\n",
         "SolverError: python3 -m code run --scene scene.toml of 1/2"),
        ("bits", "", "no message"),
    ],
)
def test_the_reason_is_the_telling_line(kind: str, output: str, reason: str) -> None:
    assert first_reason(kind, output) == reason


def test_a_fault_is_caught_by_a_failure_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    results = {"passes": Result(False, False, "", 1.0), "trouble": Result(False, True, "did not end", 1.0),
               "fails": Result(True, False, "wrong", 1.0)}
    monkeypatch.setattr("tests.mutation.__main__.run_detector", lambda detector, *_: results[detector.text])
    survivor = hunt(replace(SIGN, caught_by=("passes", "trouble")), results | {"trouble": results["passes"]})
    assert not survivor.caught
    assert survivor.message == "passes: passed; trouble: did not end"
    sound = results | {"fails": results["passes"]}  # as it ends without the fault
    outcome = hunt(replace(SIGN, caught_by=("passes", "fails")), sound)
    assert (outcome.detector, outcome.message, outcome.seconds) == ("fails", "wrong", 2.0)
    assert not hunt(replace(SIGN, caught_by=("fails",)), results).caught  # it fails without the fault, too


class Script(Detector):
    """A detector that runs the Python text of its last word."""

    def command(self, folder: Path) -> list[str]:
        return [sys.executable, "-c", self.text.split(" ", 1)[1]]


@pytest.mark.parametrize(
    ("script", "hang", "passed", "failed"),
    [
        ("pass", False, True, False),
        ("print('[  PASSED  ] 0 tests.')", False, False, False),
        ("raise SystemExit(1)", False, False, True),
        ("raise SystemExit(5)", False, False, False),  # pytest: no test of this name
        ("import os; os.abort()", False, False, True),
        ("import time; time.sleep(60)", False, False, False),
        ("import time; time.sleep(60)", True, False, True),
        ("import os; assert os.environ['MAPPM_MUTANT'] == '7'", False, True, False),
    ],
)
def test_how_a_detector_ends(tmp_path: Path, script: str, hang: bool, passed: bool, failed: bool) -> None:
    timeout = 0.5 if "sleep" in script else 60.0
    result = run_detector(Script(f"pytest {script}"), 7, tmp_path, timeout, hang)
    assert (result.passed, result.failed) == (passed, failed), result.message
