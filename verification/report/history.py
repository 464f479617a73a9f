"""Earlier reports: reports/published/history.json, an entry for each that was published."""

import json
import math
from pathlib import Path

from verification.suite.judge import SKIPPED
from verification.suite.result import CaseResult


def errors_of(results: list[CaseResult]) -> dict[str, dict]:
    """{"case: symbol": {error, goal, uncertainty, value, verdict}}, relative as in the verdicts."""
    return {
        f"{result.case.name}: {outcome.observable.against}": {
            "value": outcome.measured.value,
            "error": outcome.error,
            "uncertainty": outcome.uncertainty,
            "goal": outcome.observable.goal,
            "verdict": outcome.verdict,
        }
        for result in results
        for outcome in result.outcomes
        if outcome.verdict != SKIPPED
    }


def read_history(file: Path) -> list[dict]:
    """Entries {date, commit, tier, errors}, the oldest first; none where the file is missing."""
    return json.loads(file.read_text()) if file.exists() else []


ROUNDING = 1e-9  # of a measure; the runs themselves have none


def _distance(row: dict) -> float:
    """By how much it moved, in goals; infinite for what is new or gone."""
    if row["what"] != "moved":
        return math.inf
    return abs(row["new"]["error"] - row["old"]["error"]) / (row["new"]["goal"] or 1.0)


def changes(history: list[dict], errors: dict[str, dict]) -> list[dict]:
    """Against the last entry: what is new, gone, or moved at all, as runs are exact to the bit; those that moved most for their goal
    first."""
    if not history:
        return []
    before, rows = history[-1]["errors"], []
    for key in dict.fromkeys([*before, *errors]):
        old, new = before.get(key), errors.get(key)
        if old is None or new is None:
            rows.append({"key": key, "old": old, "new": new, "what": "new" if old is None else "no longer judged"})
        elif not math.isclose(new["value"], old["value"], rel_tol=ROUNDING):
            rows.append({"key": key, "old": old, "new": new, "what": "moved"})
    return sorted(rows, key=_distance, reverse=True)
