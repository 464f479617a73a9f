"""Earlier reports: reports/published/history.json, an entry for each that was published."""

import json
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


def changes(history: list[dict], errors: dict[str, dict]) -> list[dict]:
    """Against the last entry: what is new, gone, or moved by more than its uncertainty (and by a tenth of its goal)."""
    if not history:
        return []
    before, rows = history[-1]["errors"], []
    for key in dict.fromkeys([*before, *errors]):
        old, new = before.get(key), errors.get(key)
        if old is None or new is None:
            rows.append({"key": key, "old": old, "new": new, "what": "new" if old is None else "no longer judged"})
        elif abs(new["error"] - old["error"]) > max(new["uncertainty"], 0.1 * new["goal"]):
            rows.append({"key": key, "old": old, "new": new, "what": "moved"})
    return rows
