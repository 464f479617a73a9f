"""What the report says about families of cases and about each reference code, put together from results."""

from dataclasses import dataclass
from pathlib import Path

from verification.figures import CaseFigures
from verification.judge import Outcome
from verification.result import CaseResult


@dataclass(frozen=True)
class Family:
    """The points of a case, or the one case."""

    name: str
    results: tuple[CaseResult, ...]
    charts: tuple[Path, ...] = ()

    @property
    def holds(self) -> bool:
        return all(result.holds for result in self.results)


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
        live = self.results[0].live.result
        return live.version or live.missing or live.objection

    @property
    def rows(self) -> list[tuple[CaseResult, Outcome]]:
        return [(result, outcome) for result in self.results for outcome in result.outcomes if outcome.observable.live]

    @property
    def shown(self) -> list[CaseResult]:
        """What the code was run for without a verdict."""
        return [result for result in self.results if not result.outcomes]


def families_of(results: list[CaseResult]) -> list[Family]:
    """Those first in which something does not hold, then by name."""
    found: dict[str, list[CaseResult]] = {}
    for result in results:
        found.setdefault(result.case.family, []).append(result)
    families = [Family(name, tuple(sorted(members, key=lambda result: result.case.name))) for name, members in found.items()]
    return sorted(families, key=lambda family: (family.holds, family.name))


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
        chapters.append(Chapter(members[0].live.result.code, tuple(members), _pictures(members, figures), charts))
    return chapters
