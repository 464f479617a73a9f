"""What several tests share."""

from pathlib import Path

from verification.case import find_case
from verification.judge import CORRECT, Outcome, run_and_judge
from verification.solver import Options, Run


def judged(name: str, folder: Path, *overrides: str) -> tuple[Run, dict[str, Outcome]]:
    """Runs a case with overrides; its outcomes by the name of the observable, printed."""
    finished, outcomes = run_and_judge(find_case(name), folder, Options(overrides=overrides))
    for outcome in outcomes:
        print(outcome.line)
    return finished, {outcome.observable.name: outcome for outcome in outcomes}


def assert_correct(outcome: Outcome, goal: float) -> None:
    """The verdict of the manifest, whose goal may be no looser than the one the test states."""
    assert outcome.observable.goal <= goal
    assert outcome.verdict == CORRECT, outcome.line
