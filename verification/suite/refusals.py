"""Runs that a code would not do or that failed: remembered, so that they are not tried at every turn."""

from verification.measures.source import measure_id
from verification.protocol.errors import Beyond, CaseError, Killed, SolverError, last_line
from verification.protocol.machine import commit
from verification.store.export import without_folders
from verification.store.key import hash_of
from verification.store.laboratory import Laboratory
from verification.suite.runner import Job, Shelf


def _failure_key(job: Job) -> str:
    """Of a failure that may be gone with other sources, or, of a code that has one, with another numerics version; or with another
    measure."""
    sources = commit() if job.code.numerics_version is None else f"numerics version {job.code.numerics_version}"
    return hash_of({"run": job.request.key, "sources": sources, "measure": measure_id(job.case.file.parent)})[:24]


def why_not(shelf: Shelf, job: Job) -> str:
    """The words with which the code refused or failed; empty where it did not."""
    return without_folders(shelf.store.refusal(job.request.key) or shelf.store.refusal(_failure_key(job)))


def remember(laboratory: Laboratory, job: Job, error: Beyond | SolverError | CaseError) -> str:
    """Its last words, which it returns. A scene that the code cannot do is remembered for good, and a failure as long as the sources
    or the numerics version are the same; one that was killed is tried again. `store prune` forgets them all."""
    words, key = last_line(str(error)), job.request.key if isinstance(error, Beyond) else _failure_key(job)
    if not isinstance(error, Killed):
        laboratory.store.enter_refusal(key, job.request.label, job.code.name, words)
    return words
