"""What several tests share."""

import importlib.util
from pathlib import Path
from types import ModuleType

from verification.codes.code import Code, find_code
from verification.protocol.run import Run
from verification.store.laboratory import Laboratory
from verification.suite.judge import Outcome
from verification.suite.manifest import find_case
from verification.suite.result import Way, run_with

ANY_CODE = Code("any", "Any", (), "1", frozenset({"fluid"}))  # for what only asks that there is one


def judged(name: str, folder: Path, *overrides: str) -> tuple[Run, dict[str, Outcome]]:
    """Runs the scene of a case alone, with overrides; its outcomes by the name of the observable, printed."""
    laboratory = Laboratory(folder)
    result = run_with(laboratory, find_case(name), overrides, find_code("mappm"), Way())
    print("\n".join(result.lines))
    return laboratory.run(result.finest.stored.key), {outcome.observable.name: outcome for outcome in result.outcomes}


def assert_holds(outcome: Outcome, goal: float) -> None:
    """By the manifest, whose goal may be no looser than the one the test states."""
    assert outcome.observable.goal <= goal
    assert outcome.holds, outcome.line


def measure_module(name: str) -> ModuleType:
    """measure.py of a case, with all that it does not export, too."""
    file = find_case(name).file.parent / "measure.py"
    spec = importlib.util.spec_from_file_location(f"whole_{name}", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
