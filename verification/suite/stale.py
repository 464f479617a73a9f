"""Results of an older numerics version, for a report that shows them grey and never among the others."""

from dataclasses import dataclass, replace

from verification.suite.manifest import find_case
from verification.suite.result import CaseResult, collect
from verification.suite.runner import Shelf
from verification.suite.tier import subject


@dataclass(frozen=True)
class Stale:
    numerics: int
    result: CaseResult


def stale_of(shelf: Shelf, names: list[str]) -> list[Stale]:
    """Of the cases that have no result now, the newest that there is."""
    now = subject()
    older = sorted({run.numerics for run in shelf.store.runs(now.name) if run.numerics != now.numerics_version}, reverse=True)
    found = []
    for name in names:
        case = find_case(name)
        for numerics in older:
            code = replace(now, numerics_version=numerics)
            result = next((one for tier in ("full", "quick") if (one := collect(shelf, case, tier, code)) is not None), None)
            if result is not None:
                found.append(Stale(numerics, result))
                break
    return found
