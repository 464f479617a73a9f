"""A case run and judged: every verdict there is on it."""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from verification.bits.conservation import Conservation, conservation, defect_line, totals
from verification.bits.equivalence import Matrix, run_matrix
from verification.codes.mappm import Options, run
from verification.protocol.run import Run
from verification.suite.case import Case, Level
from verification.suite.judge import SKIPPED, Outcome, beside, judge
from verification.suite.references import LiveRun, resolved, run_live
from verification.suite.runner import Job, jobs_of, run_jobs

Runs = dict[tuple[str, ...], Run]


@dataclass(frozen=True)
class Exactness:
    """Mass and momentum as equalities of integers, at every sample of every run."""

    runs: int
    samples: int
    defects: tuple[str, ...]  # what does not hold

    @property
    def line(self) -> str:
        if self.defects:
            return "mass and momentum: NOT EXACT: " + "; ".join(self.defects)
        return f"mass and momentum: EXACT at {self.samples} samples of {self.runs} runs"


@dataclass(frozen=True)
class CaseResult:
    case: Case
    tier: str
    runs: Runs
    outcomes: tuple[Outcome, ...]
    beside: tuple[tuple[str, Outcome], ...]
    exact: Exactness
    matrix: Matrix | None = None
    faces: Conservation | None = None
    live: LiveRun | None = None

    @property
    def skipped(self) -> tuple[Outcome, ...]:
        return tuple(outcome for outcome in self.outcomes if outcome.verdict == SKIPPED)

    @property
    def holds(self) -> bool:
        exact = not self.exact.defects and (self.matrix is None or self.matrix.equal)
        exact = exact and (self.faces is None or self.faces.exact)
        return exact and all(outcome.holds for outcome in self.outcomes)

    @property
    def finest(self) -> Run:
        return self.runs[self.case.levels_of(self.tier)[-1].overrides]

    @property
    def lines(self) -> list[str]:
        lines = [outcome.line for outcome in self.outcomes]
        if self.live and not self.outcomes:
            lines += [f"{name} = {quantity.value:.6g}, {quantity.note} ({self.live.result.code}, shown, not judged)"
                      for name, quantity in self.live.result.quantities.items()]
        lines += [f"beside it, {label}: {outcome.observable.symbol} = {outcome.measured.value:.6g}, {outcome.error_text} from "
                  f"{outcome.observable.reference:g}, without a verdict" for label, outcome in self.beside]
        if self.matrix is not None:
            lines += self.matrix.lines
        if self.faces is not None:
            lines += self.faces.lines
        return [*lines, self.exact.line] if self.exact.runs else lines


def exactness(runs: Runs) -> Exactness:
    samples, defects = 0, []
    for finished in runs.values():
        momentum, particles = totals(finished)
        samples += len(momentum)
        for name, by_step in (("momentum - start - impulse", momentum), ("change of the number of PPs", particles)):
            if any(by_step.values()):
                defects.append(f"{finished.folder.name}: {defect_line(name, by_step)}")
    return Exactness(len(runs), samples, tuple(defects))


def run_bits(case: Case, out: Path, say: Callable[[str], None]) -> tuple[Matrix, Conservation]:
    """The equivalence matrix of a case, and the impulses over the faces between domains at every tenth step."""
    matrix = run_matrix(case.file, case.equivalence, out / case.name / "matrix", say)
    options = Options(ranks=4, steps=min(200, case.equivalence.steps), faces=True, overrides=("output.sample=10",))
    return matrix, conservation(run(case.file, out / case.name / "faces", options))


def judged(case: Case, tier: str, runs: Runs, bits: tuple[Matrix, Conservation] | None = None,
           live: LiveRun | None = None) -> CaseResult:
    known = resolved(case, live.result if live else None)
    outcomes, others = tuple(judge(known, tier, runs)), tuple(beside(known, runs))
    return CaseResult(known, tier, runs, outcomes, others, exactness(runs), *(bits or (None, None)), live)


def run_case(case: Case, tier: str, out: Path, ranks: int, jobs_at_a_time: int, say: Callable[[str], None]) -> CaseResult:
    """All that the manifest asks for, below out/NAME. `say` is told of every run that ends."""
    started = time.monotonic()

    def told(job: Job, share: float) -> None:
        left = (time.monotonic() - started) * (1 - share) / share
        say(f"{case.name}: {job.label}: done; {left:.0f} s to go")

    jobs = jobs_of(case, tier)
    runs = run_jobs(jobs, out, Options(ranks=ranks), jobs_at_a_time, told)
    bits = run_bits(case, out, say) if case.equivalence is not None else None
    own = {overrides: finished for (_, overrides), finished in runs.items()}
    return judged(case, tier, own, bits, run_live(case, tier, own, out) if case.live else None)


def run_with(case: Case, out: Path, overrides: tuple[str, ...], ranks: int = 1) -> CaseResult:
    """The scene alone with overrides of the user: no levels, nothing varied, so the goals alone decide."""
    overrides = case.base + overrides
    observables = tuple(replace(observable, order=None, extrapolated=None) for observable in case.observables)
    alone = replace(case, observables=observables, levels=(Level(overrides, "quick"),), vary=(), beside=(),
                    equivalence=None, stalls="")
    finished = run_jobs([Job(alone, overrides)], out, Options(ranks=ranks), 1)[case.name, overrides]
    runs = {overrides: finished}
    return judged(alone, "quick", runs, live=run_live(alone, "quick", runs, out) if case.live else None)
