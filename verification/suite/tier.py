"""Runs what is missing of a tier."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from verification.codes.code import Code, find_code
from verification.protocol.errors import Beyond, CaseError, SolverError
from verification.protocol.machine import cores
from verification.store.laboratory import Laboratory, Request
from verification.suite.case import Case
from verification.suite.manifest import all_cases, find_case
from verification.suite.parameters import scene_of
from verification.suite.progress import Progress, time_left
from verification.suite.result import finish, obtain_bits
from verification.suite.runner import Job, jobs_of, look_up, perform, workers_of
from verification.suite.table import make, missing_of_table

SHOWN = "gas_solid_small"  # the scene of the long run that the report shows
SHOWN_STEPS = {"quick": 4_000, "full": 30_000}
SHOWN_RANKS = 2
LEFT_OUT = ("gas_solid_paper",)  # an experiment of its own

Say = Callable[..., None]


def subject() -> Code:
    """The code that the report is about."""
    return find_code("mappm")


def cases_of(tier: str) -> list[Case]:
    return [case for case in all_cases() if case.judged and case.family not in LEFT_OUT and (tier == "full" or case.tier == "quick")]


def shown_request(tier: str) -> Request:
    """The long run: on any number of cores it is the same."""
    case = find_case(SHOWN)
    return Request(subject(), scene_of(case, case.base), f"{SHOWN}: shown", SHOWN_STEPS[tier], cores=SHOWN_RANKS, field=True)


def _with_time(say: Say, words: Callable[[Job], str]) -> Callable[[Job, float], None]:
    left = time_left()
    return lambda job, share: say(words(job), left(share))


def _references(laboratory: Laboratory, cases: list[Case], tier: str, code: Code, say: Say) -> None:
    """Several at a time."""
    with workers_of(cores()) as pool:
        futures = {case.name: pool.submit(finish, laboratory, case, tier, code) for case in cases}
        for done, (name, future) in enumerate(futures.items(), start=1):
            future.result()
            say(f"{done} of {len(futures)}, last {name}")


def _table(laboratory: Laboratory, say: Say) -> None:
    jobs = missing_of_table(laboratory)
    with workers_of(cores()) as pool:
        for done, (job, future) in enumerate([(job, pool.submit(make, laboratory, job)) for job in jobs], start=1):
            future.result()
            say(f"{done} of {len(jobs)}, last {job.code.name} on {job.case.name}")


class Tried:
    """Stages of a tier: one that fails is kept for the end, and those that follow do what they can."""

    def __init__(self, progress: Progress) -> None:
        self.progress, self.failures = progress, []

    @contextmanager
    def stage(self, title: str) -> Iterator[Say]:
        with self.progress.stage(title) as say:
            try:
                yield say
            except (SolverError, CaseError, Beyond) as error:
                self.failures.append(f"{title}: {error}")


def make_tier(laboratory: Laboratory, tier: str) -> list[str]:
    """Returns what failed, in words; all else is made. Throws StoreError."""
    cases, code = cases_of(tier), subject()
    with_bits = [case for case in cases if case.equivalence is not None]
    tried = Tried(Progress(stages=4 + len(with_bits)))
    jobs = {case.name: jobs_of(case, tier, code) for case in cases}
    count = sum(map(len, jobs.values()))
    with tried.stage(f"{count} runs of {len(cases)} cases") as say:
        perform(laboratory, [job for some in jobs.values() for job in some], cores(),
                _with_time(say, lambda job: f"last {job.case.name}"))
    with tried.stage("reference codes") as say:
        ready = [case for case in cases if case.live and all(look_up(laboratory, job) for job in jobs[case.name])]
        _references(laboratory, ready, tier, code, say)
    for case in with_bits:
        with tried.stage(f"bits of {case.name}") as say:
            obtain_bits(laboratory, case, code, say)
    with tried.stage(f"{SHOWN}, {SHOWN_STEPS[tier]} steps on {SHOWN_RANKS} processes"):
        shown = shown_request(tier)
        laboratory.obtain(shown, folder_too=not laboratory.store.has_files(shown.key))  # an import brings no series and no field
    with tried.stage("other codes on the same cases") as say:
        _table(laboratory, say)
    return tried.failures
