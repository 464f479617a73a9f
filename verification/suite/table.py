"""Every code on every case that it can do: error and core-seconds at one resolution, that of the coarsest level."""

from dataclasses import dataclass

from verification.codes.code import Code, all_codes, find_code
from verification.measures.source import measure_id
from verification.protocol.errors import Beyond, CaseError, Killed, SolverError, last_line
from verification.protocol.machine import commit
from verification.store.export import without_folders
from verification.store.key import hash_of
from verification.store.laboratory import Laboratory
from verification.suite.ability import stated_alone
from verification.suite.case import Case
from verification.suite.judge import Outcome
from verification.suite.manifest import all_cases
from verification.suite.references import resolved
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


def _failure_key(job: Job) -> str:
    """Of a failure that may be gone with other sources or another measure."""
    return hash_of({"run": job.request.key, "sources": commit(), "measure": measure_id(job.case.file.parent)})[:24]


def _why_not(shelf: Shelf, job: Job) -> str:
    """The words with which the code refused or failed; empty where it did not."""
    return without_folders(shelf.store.refusal(job.request.key) or shelf.store.refusal(_failure_key(job)))


def missing_of_table(shelf: Shelf) -> list[Job]:
    """Runs that installed codes have not made or refused yet."""
    jobs, codes = [], table_codes()
    for case in table_cases():
        for code in codes:
            try:
                job = _job(case, code)
            except Beyond:
                continue
            if not code.missing and look_up(shelf, job) is None and not _why_not(shelf, job):
                jobs.append(job)
    return jobs


def make(laboratory: Laboratory, job: Job) -> str:
    """Returns why there is no result; empty where there is one. A scene that the code cannot do is remembered for good, and a failure
    as long as the sources are the same; one that was killed is tried again."""
    try:
        obtain(laboratory, job)
    except (Beyond, SolverError, CaseError) as error:
        words, key = last_line(str(error)), job.request.key if isinstance(error, Beyond) else _failure_key(job)
        if not isinstance(error, Killed):
            laboratory.store.enter_refusal(key, job.request.label, job.code.name, words)
        return words
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
        return Cell(code.title, why=_why_not(shelf, job) or "not run yet")
    (observable,) = resolved(job.case, None).observables
    return Cell(code.title, Outcome(observable, entry.found.values[observable.name]), entry.stored.cost.core_seconds)


def table(shelf: Shelf) -> list[TableRow]:
    """Rows in which some code but the first has a result."""
    codes = table_codes()
    rows = [TableRow(case, tuple(_cell(shelf, case, code) for code in codes)) for case in table_cases()]
    return [row for row in rows if any(cell.outcome for cell in row.cells[1:])]
