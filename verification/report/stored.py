"""Results of single cases that are kept for the report: reports/published/full.json, an entry a case.

The full tier takes longer than a night; case by case it is run when there is time.
"""

import fcntl
import json
import math
import os
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

from verification.protocol.machine import ROOT
from verification.protocol.quantity import COVERAGE, Measured
from verification.suite.case import Observable
from verification.suite.judge import SKIPPED, Outcome
from verification.suite.manifest import all_cases
from verification.suite.result import CaseResult, Exactness

PUBLISHED = ROOT / "reports" / "published"
FULL = PUBLISHED / "full.json"


def finite(value):
    """NaN and infinity have no JSON."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _row(outcome: Outcome) -> dict:
    """As the report shows it, so that the file can be read by itself; and the numbers behind it, u_num absolute."""
    observable, known = outcome.observable, outcome.verdict != SKIPPED
    numbers = {"measured": outcome.measured.value, "reference": observable.reference, "u_ref": observable.uncertainty,
               "u_num": outcome.u_num * outcome.scale, "goal": observable.goal}
    return {
        "numbers": {name: finite(value) for name, value in numbers.items()},
        "symbol": observable.against,
        "measured": f"{outcome.measured.value:.6g}",
        "reference": f"{observable.reference:.6g} +- {observable.uncertainty:.2g}" if known else "",
        "source": observable.source,
        "error": outcome.error_text if known else "",
        "u_num": outcome.in_words(outcome.u_num) if outcome.sources and known else "",
        "u_ref": outcome.in_words(outcome.u_ref) if known else "",
        "k_u_val": outcome.in_words(COVERAGE * outcome.uncertainty) if known and not outcome.by_goal_alone else "",
        "goal": outcome.in_words(observable.goal) if known else "",
        "order": outcome.order_text if known and len(outcome.levels) > 2 else "",
        "verdict": outcome.verdict,
        "convergence": outcome.convergence_verdict,
        "reason": outcome.reason,
    }


def entry_of(result: CaseResult) -> dict:
    record = next(iter(result.runs.values())).record if result.runs else {"commit": ""}
    live = result.live.result if result.live else None
    return {
        "date": f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC",
        "commit": record["commit"],
        "tier": result.tier,
        "code": f"{live.code} {live.version}" if live else "",
        "command": f"python3 -m verification run {result.case.name} --tier {result.tier}",
        "rows": [_row(outcome) for outcome in result.outcomes],
    }


def _outcome_of(row: dict) -> Outcome:
    numbers = {name: math.nan if value is None else value for name, value in row["numbers"].items()}
    observable = Observable(row["symbol"], row["symbol"], numbers["reference"], numbers["u_ref"], row["source"], numbers["goal"])
    return Outcome(observable, Measured(numbers["measured"], 0.0), {"stored": numbers["u_num"]})


def stored_families(entries: dict[str, dict]) -> list[list[CaseResult]]:
    """The cases of the file that there still are, by families, each with its finest level and without its runs."""
    families: dict[str, list[CaseResult]] = {}
    for case in all_cases():
        if case.name in entries:
            outcomes = tuple(_outcome_of(row) for row in entries[case.name]["rows"])
            result = CaseResult(case, entries[case.name]["tier"], {}, outcomes, (), Exactness(0, 0, ()))
            families.setdefault(case.family, []).append(result)
    return list(families.values())


@contextmanager
def _alone_in(folder: Path) -> Iterator[None]:
    """One process at a time."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def store(result: CaseResult, file: Path = FULL) -> None:
    """Adds the result, in place of an earlier one of the same case. Several processes may store at a time."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with _alone_in(file.parent):
        known = json.loads(file.read_text()) if file.exists() else {}
        known[result.case.name] = entry_of(result)
        whole = file.with_suffix(".part")
        whole.write_text(json.dumps(dict(sorted(known.items())), indent=1) + "\n")
        whole.replace(file)
