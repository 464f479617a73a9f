"""What several tests share."""

from pathlib import Path

from verification.protocol.run import Run
from verification.suite.judge import CORRECT, Outcome
from verification.suite.manifest import find_case
from verification.suite.result import run_with


def judged(name: str, folder: Path, *overrides: str) -> tuple[Run, dict[str, Outcome]]:
    """Runs the scene of a case alone, with overrides; its outcomes by the name of the observable, printed."""
    result = run_with(find_case(name), folder, overrides)
    print("\n".join(result.lines))
    return result.finest, {outcome.observable.name: outcome for outcome in result.outcomes}


def assert_correct(outcome: Outcome, goal: float) -> None:
    """The verdict of the manifest, whose goal may be no looser than the one the test states."""
    assert outcome.observable.goal <= goal
    assert outcome.verdict == CORRECT, outcome.line
