"""When a case holds, and how the judge then ends. Oracle: each of its parts must hold."""

import subprocess
import sys
import threading
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from verification.protocol.machine import ROOT
from verification.suite import runner
from verification.suite.manifest import find_case
from verification.suite.result import CaseResult, Exactness, run_with


@pytest.mark.parametrize(
    ("outcome", "defects", "equal", "holds"),
    [
        (True, (), None, True),
        (True, (), True, True),
        (False, (), True, False),
        (True, ("one PP too few",), True, False),
        (True, (), False, False),
    ],
)
def test_a_case_holds_with_all_parts(outcome: bool, defects: tuple[str, ...], equal: bool | None, holds: bool) -> None:
    outcomes = (SimpleNamespace(holds=True), SimpleNamespace(holds=outcome))
    matrix = None if equal is None else SimpleNamespace(equal=equal)
    result = CaseResult(SimpleNamespace(), "quick", {}, outcomes, (), Exactness(1, 1, defects), matrix)
    assert result.holds == holds


def test_a_scene_run_alone_is_asked_for_no_order(tmp_path: Path) -> None:
    case = find_case("shear_wave")
    assert any(observable.order for observable in case.observables)
    result = run_with(case, tmp_path, ("run.step_factor=1.0",))
    assert result.holds, "\n".join(result.lines)
    assert all(outcome.convergence_verdict == "" for outcome in result.outcomes)


def test_the_judge_ends_with_its_verdict(tmp_path: Path) -> None:
    # A fluid at rest is at rest; one in uniform motion is not, and the case says so.
    for velocity, code, verdict in (("[0,0]", 0, ", CORRECT"), ("[0.01,0]", 1, ", WRONG")):
        line = [sys.executable, "-m", "verification", "run", "rest", "--out", str(tmp_path), "--set", "run.steps=10",
                "--set", f"fluid.velocity={velocity}"]
        judged = subprocess.run(line, cwd=ROOT, capture_output=True, text=True)
        assert judged.returncode == code, judged.stderr
        assert verdict in judged.stdout


@pytest.mark.parametrize("jobs", [1, 2])
def test_as_many_runs_at_a_time_as_were_asked_for(jobs: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    running, most, lock = 0, 0, threading.Lock()

    def watched(*_: object) -> None:
        nonlocal running, most
        with lock:
            running += 1
            most = max(most, running)
        time.sleep(0.05)
        with lock:
            running -= 1

    monkeypatch.setattr(runner, "run", watched)
    chosen = runner.jobs_of(find_case("shear_wave"), "full")
    assert len(runner.run_jobs(chosen, tmp_path, runner.Options(), jobs)) == len(chosen) > 2
    assert most == jobs


def test_no_run_at_a_time_is_refused() -> None:
    line = [sys.executable, "-m", "verification", "run", "rest", "--jobs", "0"]
    refused = subprocess.run(line, cwd=ROOT, capture_output=True, text=True)
    assert refused.returncode != 0 and "--jobs 0: must be at least 1" in refused.stderr
