"""When a case holds, and how the judge then ends. Oracle: each of its parts must hold."""

import subprocess
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from support import ANY_CODE
from tiny_code import tiny

from verification.bits.conservation import Conservation
from verification.bits.equivalence import Matrix, Row
from verification.codes.code import find_code
from verification.protocol.machine import ROOT
from verification.report.report import Published, _result
from verification.store.export import export, import_into
from verification.store.laboratory import Laboratory
from verification.store.store import Store
from verification.suite import result, runner
from verification.suite.case import Case
from verification.suite.manifest import find_case, read_cases
from verification.suite.result import Bits, CaseResult, Exactness, Way, collect, look_up_bits, obtain_bits, run_case, run_with


@pytest.mark.parametrize(
    ("outcome", "defects", "equal", "faces", "holds"),
    [
        (True, (), None, None, True),
        (True, (), True, True, True),
        (False, (), True, True, False),
        (True, ("one PP too few",), True, True, False),
        (True, (), False, True, False),
        (True, (), True, False, False),
    ],
)
def test_a_case_holds_with_all_parts(outcome: bool, defects: tuple[str, ...], equal: bool | None, faces: bool | None,
                                     holds: bool) -> None:
    outcomes = (SimpleNamespace(holds=True), SimpleNamespace(holds=outcome))
    bits = None if equal is None else Bits(SimpleNamespace(equal=equal), SimpleNamespace(exact=faces), None)
    found = CaseResult(SimpleNamespace(), ANY_CODE, "quick", {}, outcomes, (), Exactness(1, 1, defects), bits)
    assert found.holds == holds


def test_a_scene_run_alone_is_asked_for_no_order(tmp_path: Path) -> None:
    case = find_case("shear_wave")
    assert any(observable.order for observable in case.observables)
    found = run_with(Laboratory(tmp_path), case, ("run.step_factor=1.0",), find_code("mappm"), Way())
    assert found.holds, "\n".join(found.lines)
    assert all(outcome.state == "" for outcome in found.outcomes)


def test_the_judge_ends_with_its_verdict(tmp_path: Path) -> None:
    # A fluid at rest is at rest; one in uniform motion is not, and the case says so, also when asked again.
    for velocity, code, verdict in (("[0,0]", 0, ", VALIDATED"), ("[0.01,0]", 1, ", FAILED"), ("[0.01,0]", 1, ", FAILED")):
        line = [sys.executable, "-m", "verification", "run", "rest", "--lab", str(tmp_path), "--set", "run.steps=10",
                "--set", f"fluid.velocity={velocity}"]
        judged = subprocess.run(line, cwd=ROOT, capture_output=True, text=True)
        assert judged.returncode == code, judged.stderr
        assert verdict in judged.stdout


@pytest.mark.parametrize("jobs", [1, 2])
def test_as_many_runs_at_a_time_as_were_asked_for(jobs: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    running, most, shares, lock = 0, 0, [], threading.Lock()

    def watched(*_: object) -> None:
        nonlocal running, most
        with lock:
            running += 1
            most = max(most, running)
        time.sleep(0.05)
        with lock:
            running -= 1

    monkeypatch.setattr(runner, "obtain", watched)
    monkeypatch.setattr(runner.os, "cpu_count", lambda: 4)
    chosen = runner.jobs_of(find_case("shear_wave"), "full", ANY_CODE)
    runner.perform(Laboratory(tmp_path), chosen, jobs, lambda job, share: shares.append(share))
    assert len(shares) == len(chosen) > 2 and shares == sorted(shares) and shares[-1] == pytest.approx(1.0)
    assert most == jobs


def test_no_run_at_a_time_is_refused() -> None:
    line = [sys.executable, "-m", "verification", "run", "rest", "--jobs", "0"]
    refused = subprocess.run(line, cwd=ROOT, capture_output=True, text=True)
    assert refused.returncode != 0 and "--jobs 0: must be at least 1" in refused.stderr

# --- equality of bits


EXACT = Conservation({10: 0, 20: 0}, {10: 0, 20: 0}, {0: 0, 10: 0, 20: 0}, {0: 0}, 12, 345)
ROWS = (Row("serial", "00ff", samples=3), Row("P=2", "00ff", samples=3))


def compared(monkeypatch: pytest.MonkeyPatch, *rows: Row, faces: Conservation = EXACT) -> None:
    """Stands for the runs that tell these rows and faces."""
    monkeypatch.setattr(result, "run_matrix", lambda *_: Matrix(rows))
    monkeypatch.setattr(result, "run", lambda *_: None)
    monkeypatch.setattr(result, "conservation", lambda _: faces)


def test_bits_are_found_again_as_they_were_compared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    laboratory, case, code = Laboratory(tmp_path), find_case("crossing_2d"), replace(ANY_CODE, numerics_version=2)
    compared(monkeypatch, *ROWS)
    first = obtain_bits(laboratory, case, code, print)
    compared(monkeypatch, Row("serial", "0000"))
    assert look_up_bits(laboratory, case, code) == obtain_bits(laboratory, case, code, print) == first
    assert first.matrix.equal and first.faces == EXACT
    others = (replace(case, equivalence=replace(case.equivalence, steps=7)), replace(case, base=("fluid.viscosity=3.0",)))
    assert look_up_bits(laboratory, case, replace(code, numerics_version=3)) is None
    assert [look_up_bits(laboratory, one, code) for one in others] == [None, None]


def test_a_matrix_with_a_variant_that_was_skipped_is_run_again_where_that_can_be_had(tmp_path: Path,
                                                                                     monkeypatch: pytest.MonkeyPatch) -> None:
    laboratory, case, code = Laboratory(tmp_path), find_case("crossing_2d"), replace(ANY_CODE, numerics_version=2)
    label = case.equivalence.variants[-1].label
    compared(monkeypatch, *ROWS, Row(label, skipped="not built"))
    first = obtain_bits(laboratory, case, code, print)
    assert first.matrix.rows[-1].skipped and look_up_bits(laboratory, case, code) == first
    compared(monkeypatch, *ROWS, Row(label, "0001", samples=2))
    monkeypatch.setattr(result, "obstacle", lambda variant: "not built")
    assert obtain_bits(laboratory, case, code, print) == first
    monkeypatch.setattr(result, "obstacle", lambda variant: "")
    assert not obtain_bits(laboratory, case, code, print).matrix.rows[-1].skipped


def test_bits_that_differ_are_kept_and_compared_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    laboratory, case, code = Laboratory(tmp_path), find_case("crossing_2d"), replace(ANY_CODE, numerics_version=2)
    compared(monkeypatch, *ROWS, Row("P=3", "0002", difference=5, samples=2))
    assert not obtain_bits(laboratory, case, code, print).matrix.equal
    assert not look_up_bits(laboratory, case, code).matrix.equal
    compared(monkeypatch, *ROWS)
    assert obtain_bits(laboratory, case, code, print).matrix.equal

# --- what is there, and what was published

MANIFEST = """
name = "drift"
[case]
purpose = "p"
tier = "quick"
cost = 1
[[case.observable]]
name = "end"
symbol = "u"
reference = 3.0
uncertainty = 0.0
source = "nobody at all"
goal = 0.01
since = 2026-11-22
[[case.level]]
set = ["fluid.spacing=0.5"]
[[case.level]]
set = ["fluid.spacing=0.25"]
tier = "full"
[box]
size = [1.0, 1.0]
[fluid]
density = 1.0
viscosity = 0.1
spacing = 0.5
velocity = [3.0, 0.0]
"""
MEASURE = """
from verification.measures.curve import Chart, Curve
from verification.measures.measures import Measures
from verification.protocol.quantity import Measured

MEASURES = Measures(
    observables={"end": lambda run: Measured(float(run.series["fluid_velocity_x"][-1]), 0.0)},
    charts=lambda run: [Chart("u", "t", "u", (Curve("u", run.series["time"], run.series["fluid_velocity_x"]),))],
)
"""


@pytest.fixture
def drift(tmp_path: Path) -> Case:
    folder = tmp_path / "drift"
    folder.mkdir()
    (folder / "case.toml").write_text(MANIFEST)
    (folder / "measure.py").write_text(MEASURE)
    return read_cases(folder / "case.toml")[0]


def test_a_result_collected_is_the_one_that_was_run(tmp_path: Path, drift: Case) -> None:
    laboratory, code = Laboratory(tmp_path / "runs"), tiny(tmp_path / "code", ("fluid", "exact-ledger", "digest"), 2)
    assert collect(laboratory, drift, "quick", code.code) is None
    found = run_case(laboratory, drift, "quick", code.code, Way(), print)
    assert collect(laboratory, drift, "quick", code.code) == found and found.holds and code.calls == 1
    assert found.exact == Exactness(1, 3, ()) and found.lines[-1].endswith("EXACT at 3 samples of 1 runs")
    assert collect(laboratory, drift, "full", code.code) is None


def test_what_was_set_by_hand_is_no_result_of_the_case(tmp_path: Path, drift: Case) -> None:
    laboratory, code = Laboratory(tmp_path / "runs"), tiny(tmp_path / "code", ("fluid", "exact-ledger", "digest"), 2).code
    assert not run_with(laboratory, drift, ("fluid.velocity=[4.0, 0.0]",), code, Way()).holds
    assert collect(laboratory, drift, "quick", code) is None


def test_the_report_takes_the_full_tier_here_or_as_published_before_the_quick_one(tmp_path: Path, drift: Case,
                                                                                  monkeypatch: pytest.MonkeyPatch) -> None:
    code = tiny(tmp_path / "code", ("fluid", "exact-ledger", "digest"), 2).code
    monkeypatch.setattr("verification.report.report.subject", lambda: code)
    here, elsewhere, shelf = Laboratory(tmp_path / "here"), Laboratory(tmp_path / "elsewhere"), Published(Store(":memory:"))
    assert _result(here, shelf, drift) is None
    run_case(here, drift, "quick", code, Way(), print)
    assert _result(here, shelf, drift).tier == "quick"
    run_case(elsewhere, drift, "full", code, Way(), print)
    export(elsewhere.store, tmp_path / "store.jsonl")
    import_into(shelf.store, tmp_path / "store.jsonl")
    published = _result(here, shelf, drift)
    assert (published.tier, len(published.outcomes[0].levels), published.charts) == ("full", 2, ())
    run_case(here, drift, "full", code, Way(), print)
    assert _result(here, shelf, drift).charts != ()
