"""What the report says about each reference code: the rows that are held against it, and its runs."""

from dataclasses import dataclass

from verification.report.chapters import Row, families_of, rows_of
from verification.suite.result import CaseResult


@dataclass(frozen=True)
class ReferenceCode:
    code: str
    results: tuple[CaseResult, ...]

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


def reference_codes(results: list[CaseResult]) -> list[ReferenceCode]:
    found: dict[str, list[CaseResult]] = {}
    for result in sorted(results, key=lambda result: result.case.name):
        if result.live is not None:
            found.setdefault(result.case.live.code, []).append(result)
    return [ReferenceCode(found[code][0].live.code, tuple(found[code])) for code in sorted(found, reverse=True)]
