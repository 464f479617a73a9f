"""Verdicts: what a run measured against the reference of its manifest."""

from dataclasses import dataclass
from pathlib import Path

from verification.case import Case, CaseError, Observable
from verification.observables import OBSERVABLES, Measured
from verification.solver import DEFAULT, Options, Run, run

CORRECT, WRONG, OPEN = "CORRECT", "WRONG", "NOT ACCEPTED"


@dataclass(frozen=True)
class Outcome:
    observable: Observable
    measured: Measured

    @property
    def error(self) -> float:
        """Relative to the reference; absolute where the reference is zero."""
        difference = self.measured.value - self.observable.reference
        return difference / self.observable.reference if self.observable.reference else difference

    @property
    def verdict(self) -> str:
        """CORRECT within the goal, which no noise can widen; NOT ACCEPTED where the figure is not one yet."""
        if self.measured.objection:
            return OPEN
        return CORRECT if abs(self.error) <= self.observable.goal else WRONG

    @property
    def error_text(self) -> str:
        return f"{100 * self.error:+.2f} %" if self.observable.reference else f"{self.error:.2g}"

    @property
    def line(self) -> str:
        observable, measured = self.observable, self.measured
        verdict = self.verdict + (f": {measured.objection}" if measured.objection else "")
        return (
            f"{observable.symbol} = {measured.value:.6g} +- {measured.uncertainty:.2g} (reference "
            f"{observable.reference:g} +- {observable.uncertainty:g}, error {self.error_text}, {verdict})"
        )


def judge(case: Case, finished: Run) -> list[Outcome]:
    """Throws CaseError where the manifest names an observable that does not exist."""
    outcomes = []
    for observable in case.observables:
        if observable.name not in OBSERVABLES:
            raise CaseError(
                f"{case.file}: case.observable.name = {observable.name!r}: unknown; known are {', '.join(OBSERVABLES)}"
            )
        outcomes.append(Outcome(observable, OBSERVABLES[observable.name](finished)))
    return outcomes


def run_and_judge(case: Case, out: Path, options: Options = DEFAULT) -> tuple[Run, list[Outcome]]:
    finished = run(case.file, out, options)
    return finished, judge(case, finished)
