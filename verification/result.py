"""A case run and judged: every verdict there is on it."""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from verification.case import Case, Level
from verification.equivalence import Matrix, run_matrix
from verification.judge import Outcome, beside, judge
from verification.runner import Done, Job, cores, jobs_of, run_jobs
from verification.solver import Options, Run

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

    @property
    def holds(self) -> bool:
        exact = not self.exact.defects and (self.matrix is None or self.matrix.equal)
        return exact and all(outcome.holds for outcome in self.outcomes)

    @property
    def finest(self) -> Run:
        return self.runs[self.case.levels_of(self.tier)[-1].overrides]

    @property
    def lines(self) -> list[str]:
        lines = [outcome.line for outcome in self.outcomes]
        lines += [f"{label}: {outcome.line}" for label, outcome in self.beside]
        if self.matrix is not None:
            lines += self.matrix.lines
        return [*lines, self.exact.line] if self.exact.runs else lines


def exactness(runs: Runs) -> Exactness:
    samples, defects = 0, []
    for run in runs.values():
        series = run.series
        samples += len(series)
        for name, values in series.columns.items():
            if name.startswith("momentum_defect") and any(value != "0" for value in values):
                defects.append(f"{run.folder.name}: {name} at {sum(value != '0' for value in values)} samples")
            if name == "fluid_particles" and len(set(values)) > 1:
                defects.append(f"{run.folder.name}: the number of PPs changes")
    return Exactness(len(runs), samples, tuple(defects))


def judged(case: Case, tier: str, runs: Runs, matrix: Matrix | None = None) -> CaseResult:
    return CaseResult(
        case, tier, runs, tuple(judge(case, tier, runs)), tuple(beside(case, runs)), exactness(runs), matrix
    )


def run_case(case: Case, tier: str, out: Path, ranks: int = 1, done: Done | None = None, workers: int | None = None,
             say: Callable[[str], None] = print) -> CaseResult:
    """All that the manifest asks for, below out/NAME. `done` is told of every run that ends."""
    started = time.monotonic()

    def told(job: Job, share: float) -> None:
        left = (time.monotonic() - started) * (1 - share) / share
        say(f"{case.name}: {job.label}: done; {left:.0f} s to go")

    jobs = jobs_of(case, tier)
    runs = run_jobs(jobs, out, Options(ranks=ranks), workers or cores(), done or told)
    matrix = None
    if case.equivalence is not None:
        matrix = run_matrix(case.file, case.equivalence, out / case.name / "matrix", say)
    return judged(case, tier, {overrides: run for (_, overrides), run in runs.items()}, matrix)


def run_with(case: Case, out: Path, overrides: tuple[str, ...], ranks: int = 1) -> CaseResult:
    """The scene alone with overrides of the user: no levels, nothing varied, so the goals alone decide."""
    alone = replace(case, levels=(Level(overrides, "quick"),), vary=(), beside=(), equivalence=None, stalls="")
    runs = run_jobs([Job(alone, overrides)], out, Options(ranks=ranks), 1)
    return judged(alone, "quick", {overrides: run for (_, overrides), run in runs.items()})
