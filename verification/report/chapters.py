"""The report in chapters by physics: cases in families, families in sections, and the rows of their tables."""

from collections import Counter
from dataclasses import dataclass
from functools import cached_property

from verification.report.figure import Figure
from verification.suite.case import CHAPTERS, OTHER
from verification.suite.judge import SKIPPED, VERDICTS, Outcome
from verification.suite.result import CaseResult, Exactness

ABOUT = {
    "rest and bits": "What is not to change at all: a fluid at rest, and every bit of a run, however it is computed.",
    "waves and decay": "The fluid alone, without a wall or a body, against exact solutions: viscosity, sound, vortices.",
    "walls": "Flow between walls that stand or slide, against series, tables and spectral solutions.",
    "drag on fixed bodies": "The force on discs and spheres that are held in a flow, one in a periodic cell or several.",
    "moving bodies": "Bodies that are led through the fluid, or turn in it.",
    "falling bodies": "Bodies that are let go: how fast they end up, and how they get there.",
    "contact": "Solids that touch. LIGGGHTS has the same law: agreement with it shows programming, with closed forms physics.",
    "the gas-solid system": "What the method is for: many discs in a gas, as in the paper.",
    OTHER: "What belongs to none of these.",
}


@dataclass(frozen=True)
class Family:
    """The points of a case, or the one case."""

    name: str
    results: tuple[CaseResult, ...]
    charts: tuple[Figure, ...] = ()

    @property
    def holds(self) -> bool:
        return all(result.holds for result in self.results)

    @property
    def exact(self) -> Exactness:
        """Of all points together."""
        parts = [result.exact for result in self.results]
        defects = tuple(defect for part in parts for defect in part.defects)
        return Exactness(sum(part.runs for part in parts), sum(part.samples for part in parts), defects)

    @cached_property
    def drawn(self) -> tuple[str, ...]:
        """Names of the cases that get pictures: of many points the furthest that do not hold, or the furthest of all."""
        if len(self.results) <= LISTED:
            return tuple(result.case.name for result in self.results)
        by_distance = sorted(self.results, key=lambda result: -max(map(_distance, result.outcomes), default=0.0))
        failed = [result for result in by_distance if not result.holds][:LISTED]
        return tuple(result.case.name for result in failed or by_distance[:1])


LISTED = 3  # points of a family that are listed one by one in tables of all cases, and that have pictures


@dataclass(frozen=True)
class Row:
    """One observable of a case, or of many points of a family by the one that is the furthest from its reference."""

    name: str  # of the case, or of the family
    result: CaseResult
    outcome: Outcome
    points: int = 1  # that it stands for

    @property
    def tier(self) -> str:
        return tier_of(self.result)


def tier_of(result: CaseResult) -> str:
    """Of what was run; quick where the full tier would add nothing."""
    case = result.case
    return result.tier if case.tier == "full" or case.levels_of("full") != case.levels_of("quick") else "quick"


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
class Section:
    """Families that stand together: those of one section of the manifests, or one family by itself."""

    name: str
    families: tuple[Family, ...]

    @property
    def results(self) -> tuple[CaseResult, ...]:
        return tuple(result for family in self.families for result in family.results)

    @property
    def id(self) -> str:
        """The name of its case where it has one alone, as the links of tables say."""
        if len(self.results) == 1:
            return self.results[0].case.name
        return self.name if len(self.families) == 1 else self.name.replace(" ", "_")

    @property
    def holds(self) -> bool:
        return all(family.holds for family in self.families)

    @property
    def verdicts(self) -> dict[str, int]:
        """How many of each it holds."""
        found = Counter(outcome.verdict for result in self.results for outcome in result.outcomes)
        bits = Counter(result.matrix.verdict.partition(":")[0] for result in self.results if result.matrix)
        return {verdict: found[verdict] for verdict in VERDICTS if found[verdict]} | bits


@dataclass(frozen=True)
class Chapter:
    name: str
    sections: tuple[Section, ...]

    @property
    def id(self) -> str:
        return "chapter_" + self.name.replace(" ", "_").replace("-", "_")

    @property
    def about(self) -> str:
        return ABOUT[self.name]

    @property
    def families(self) -> list[Family]:
        return [family for section in self.sections for family in section.families]

    @property
    def results(self) -> list[CaseResult]:
        return [result for section in self.sections for result in section.results]

    @property
    def rows(self) -> list[Row]:
        """What does not hold first."""
        return sorted(rows_of(self.families), key=lambda row: row.outcome.holds)

    @property
    def failed(self) -> int:
        """Cases that do not hold."""
        return sum(not result.holds for result in self.results)


def chapters_of(families: list[Family]) -> list[Chapter]:
    """In the order of CHAPTERS; within one, what does not hold stands first."""
    found: dict[str, dict[str, list[Family]]] = {name: {} for name in CHAPTERS}
    for family in families:
        case = family.results[0].case
        found[case.chapter].setdefault(case.section or family.name, []).append(family)
    return [Chapter(name, tuple(Section(title, tuple(members)) for title, members in sections.items()))
            for name, sections in found.items() if sections]
