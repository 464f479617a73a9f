"""What the report says about families of cases and about each reference code, put together from results."""

from dataclasses import dataclass
from pathlib import Path

from verification.report.figures import CaseFigures
from verification.suite.judge import SKIPPED, Outcome
from verification.suite.result import CaseResult, Exactness


@dataclass(frozen=True)
class Family:
    """The points of a case, or the one case."""

    name: str
    results: tuple[CaseResult, ...]
    charts: tuple[Path, ...] = ()

    @property
    def holds(self) -> bool:
        return all(result.holds for result in self.results)

    @property
    def exact(self) -> Exactness:
        """Of all points together."""
        parts = [result.exact for result in self.results]
        defects = tuple(defect for part in parts for defect in part.defects)
        return Exactness(sum(part.runs for part in parts), sum(part.samples for part in parts), defects)


LISTED = 3  # points of a family that are listed one by one in tables of all cases


@dataclass(frozen=True)
class Row:
    """One observable of a case, or of many points of a family by the one that is the furthest from its reference."""

    name: str  # of the case, or of the family
    result: CaseResult
    outcome: Outcome
    points: int = 1  # that it stands for


def _distance(outcome: Outcome) -> float:
    return abs(outcome.error) / (outcome.observable.goal or 1.0)


def _rows_of(family: Family) -> list[Row]:
    pairs = [(result, outcome) for result in family.results for outcome in result.outcomes]
    if len(family.results) <= LISTED:
        return [Row(result.case.name, result, outcome) for result, outcome in pairs]
    rows, alike = [], {}
    for result, outcome in pairs:
        if outcome.holds and outcome.verdict != SKIPPED:
            alike.setdefault((outcome.observable.against, outcome.verdict, outcome.state), []).append((result, outcome))
        else:
            rows.append(Row(result.case.name, result, outcome))
    for members in alike.values():
        result, outcome = max(members, key=lambda member: _distance(member[1]))
        rows.append(Row(family.name if len(members) > 1 else result.case.name, result, outcome, len(members)))
    return rows


def rows_of(families: list[Family]) -> list[Row]:
    """Of tables and charts of all cases: what does not hold, and what was skipped, always stands by itself."""
    return [row for family in families for row in _rows_of(family)]


def families_of(results: list[CaseResult]) -> list[Family]:
    """Those first in which something does not hold, then by name."""
    found: dict[str, list[CaseResult]] = {}
    for result in results:
        found.setdefault(result.case.family, []).append(result)
    families = [Family(name, tuple(sorted(members, key=lambda result: result.case.name))) for name, members in found.items()]
    return sorted(families, key=lambda family: (family.holds, family.name))


@dataclass(frozen=True)
class Chapter:
    """One reference code."""

    code: str
    results: tuple[CaseResult, ...]
    pictures: tuple[Path, ...]  # the field from both codes, one of each family
    charts: tuple[Path, ...]

    @property
    def id(self) -> str:
        return self.results[0].case.live.code

    @property
    def version(self) -> str:
        live = self.results[0].live
        return live.version or live.missing or live.objection

    @property
    def rows(self) -> list[Row]:
        return [row for row in rows_of(families_of(list(self.results))) if row.outcome.observable.live]

    @property
    def shown(self) -> list[CaseResult]:
        """What the code was run for without a verdict."""
        return [result for result in self.results if not result.outcomes]


def _pictures(results: list[CaseResult], figures: dict[str, CaseFigures]) -> tuple[Path, ...]:
    first = {}
    for result in results:
        if (picture := figures[result.case.name].beside) is not None:
            first.setdefault(result.case.family, picture)
    return tuple(first.values())


def chapters_of(results: list[CaseResult], figures: dict[str, CaseFigures], families: list[Family]) -> list[Chapter]:
    found: dict[str, list[CaseResult]] = {}
    for result in sorted(results, key=lambda result: result.case.name):
        if result.live is not None:
            found.setdefault(result.case.live.code, []).append(result)
    chapters = []
    for code in sorted(found, reverse=True):
        members = found[code]
        named = {result.case.family for result in members}
        charts = tuple(chart for family in families if family.name in named for chart in family.charts)
        chapters.append(Chapter(members[0].live.code, tuple(members), _pictures(members, figures), charts))
    return chapters
