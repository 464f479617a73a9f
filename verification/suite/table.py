"""Every code on every case that it can do: error and core-seconds at one resolution, that of the coarsest level."""

from dataclasses import dataclass

from verification.codes.code import Code, all_codes, find_code
from verification.protocol.errors import Beyond, CaseError, SolverError
from verification.store.laboratory import Laboratory
from verification.suite.ability import stated_alone
from verification.suite.case import Case
from verification.suite.judge import Outcome
from verification.suite.manifest import all_cases
from verification.suite.references import resolved
from verification.suite.refusals import remember, why_not
from verification.suite.runner import Job, Shelf, look_up, obtain

NOT_PEERS = ("exact", "mappm-reference")  # the dummy, and the same solver again


@dataclass(frozen=True)
class Cell:
    """One code on one case; `why` where it has no result."""

    code: str
    outcome: Outcome | None = None
    core_seconds: float = 0.0
    why: str = ""


@dataclass(frozen=True)
class TableRow:
    case: Case
    cells: tuple[Cell, ...]  # in the order of the codes


def table_codes() -> list[Code]:
    """MaPPM first, then the others by name, installed or not."""
    names = [name for name in all_codes() if name not in NOT_PEERS]
    return [find_code(name) for name in sorted(names, key=lambda name: (name != "mappm", name))]


def table_cases() -> list[Case]:
    """Of the quick tier, one point a family, held against what is no other code's result."""
    found: dict[str, Case] = {}
    for case in all_cases():
        if case.tier == "quick" and any(not observable.live for observable in case.observables):
            found.setdefault(case.family, case)
    return list(found.values())


def _job(case: Case, code: Code) -> Job:
    """On the coarsest level; all codes are asked the same. Throws Beyond."""
    return Job(stated_alone(case, code), case.levels_of("quick")[0].overrides, code)


def missing_of_table(shelf: Shelf) -> list[Job]:
    """Runs that installed codes have not made or refused yet."""
    jobs, codes = [], table_codes()
    for case in table_cases():
        for code in codes:
            try:
                job = _job(case, code)
            except Beyond:
                continue
            if not code.missing and look_up(shelf, job) is None and not why_not(shelf, job):
                jobs.append(job)
    return jobs


def make(laboratory: Laboratory, job: Job) -> str:
    """Returns why there is no result; empty where there is one."""
    try:
        obtain(laboratory, job)
    except (Beyond, SolverError, CaseError) as error:
        return remember(laboratory, job, error)
    return ""


def _cell(shelf: Shelf, case: Case, code: Code) -> Cell:
    if code.missing:
        return Cell(code.title, why=code.missing)
    try:
        job = _job(case, code)
    except Beyond as error:
        return Cell(code.title, why=str(error))
    entry = look_up(shelf, job)
    if entry is None:
        return Cell(code.title, why=why_not(shelf, job) or "not run yet")
    (observable,) = resolved(job.case, None).observables
    return Cell(code.title, Outcome(observable, entry.found.values[observable.name]), entry.stored.cost.core_seconds)


def table(shelf: Shelf) -> list[TableRow]:
    """Rows in which some code but the first has a result."""
    codes = table_codes()
    rows = [TableRow(case, tuple(_cell(shelf, case, code) for code in codes)) for case in table_cases()]
    return [row for row in rows if any(cell.outcome for cell in row.cells[1:])]
